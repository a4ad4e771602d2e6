//! Damping ratios of the model's modes from measured frequency responses, each with its standard deviation: half-power widths
//! and circles. They are what [`crate::identify`] may take beside the energies.
//!
//! Half-power: the mean over the pairs of sensor and drive that show the mode, the scatter between them as deviation (neighbours
//! and noise spoil each pair differently), and what a viscous peak errs by theory, `1.5 zeta^2` of itself. Circle: the pair
//! that shows the mode best, the deviation by leaving out every eighth line in turn,
//! and by the change over half of the lines, which shows the neighbours.
//!
//! Modes that were extracted are looked at one by one, the others taken off (`isolated`): the deviation is then that by leaving
//! out lines.

use super::circle_fit::circle_fit;
use super::extracted_mode::ExtractedMode;
use super::half_power::{self, HalfPower};
use super::isolated::{Isolated, isolated};
use super::responses::FrequencyResponses;
use crate::math::statistics::{mean, standard_deviation};
use crate::measurement::MeasuredRatio;
use crate::structure::modes::Modes;
use faer::c64;

/// Relative distance within which a peak belongs to a mode of the model.
pub(super) const SAME_MODE: f64 = 0.05;
/// Least number of lines within a half-power band that show its width.
const LEAST_INSIDE: usize = 3;
/// Part of the strongest response at a resonance below which a pair does not show the mode.
const SEEN: f64 = 0.2;
/// Relative deviation of a half-power ratio that only one pair shows.
const ALONE: f64 = 0.05;
/// Half-width of the lines of a circle in half-power half-widths.
const REACH: f64 = 2.5;
/// Least number of lines of a circle.
const LEAST_LINES: usize = 5;
/// Groups of lines that are left out in turn.
const GROUPS: usize = 8;

/// Half-power ratio of every mode whose peak has three lines within its half-power band; `modes` are those that were extracted
/// from the responses, if any.
pub fn half_power_ratios(model: &Modes, responses: &FrequencyResponses, modes: &[ExtractedMode]) -> Vec<MeasuredRatio> {
    let ratio = |&omega: &f64| {
        let own = own(responses, modes, omega).and_then(|own| own.half_power());
        own.or_else(|| half_power_ratio(responses, omega))
    };
    model.omega.iter().filter_map(ratio).collect()
}

/// The extracted mode next to a frequency, on its own.
fn own(responses: &FrequencyResponses, modes: &[ExtractedMode], omega: f64) -> Option<Isolated> {
    let distance = |r: &usize| (modes[*r].pole.norm() - omega).abs();
    let near = (0..modes.len()).filter(|r| distance(r) < SAME_MODE * omega);
    let r = near.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some(isolated(responses, modes, r))
}

impl Isolated {
    /// Half-power ratio.
    fn half_power(&self) -> Option<MeasuredRatio> {
        let found = |omega: &[f64], response: &[c64]| {
            let peak = half_power::highest(omega, response)?;
            let half = peak.damping_ratio() * peak.omega_peak;
            let inside = omega.iter().filter(|&w| (w - peak.omega_peak).abs() < half).count();
            (inside >= LEAST_INSIDE).then(|| (peak.omega_peak, peak.damping_ratio()))
        };
        let lines: Vec<usize> = (0..self.omega.len()).collect();
        let ratio = self.jackknifed(&lines, &found)?;
        Some(MeasuredRatio { deviation: ratio.deviation.hypot(1.5 * ratio.ratio.powi(3)), ..ratio })
    }

    /// Ratio of the circle.
    fn circle(&self) -> Option<MeasuredRatio> {
        let limit = REACH * self.pole.re.abs();
        let lines: Vec<usize> =
            (0..self.omega.len()).filter(|&k| (self.omega[k] - self.pole.im).abs() < limit).collect();
        let fitted = |omega: &[f64], response: &[c64]| {
            let circle = circle_fit(omega, response).ok()?;
            (circle.damping_ratio > 0.0).then_some((circle.omega, circle.damping_ratio))
        };
        if lines.len() < LEAST_LINES { None } else { self.jackknifed(&lines, &fitted) }
    }

    /// What a method says of these lines, and how far it moves by leaving out every eighth in turn.
    fn jackknifed(
        &self,
        lines: &[usize],
        method: &dyn Fn(&[f64], &[c64]) -> Option<(f64, f64)>,
    ) -> Option<MeasuredRatio> {
        let estimate = |kept: &[usize]| {
            let (w, h): (Vec<f64>, Vec<c64>) = kept.iter().map(|&k| (self.omega[k], self.response[k])).unzip();
            method(&w, &h)
        };
        let (omega, ratio) = estimate(lines)?;
        let parts: Vec<f64> = without_each_group(lines).iter().filter_map(|kept| Some(estimate(kept)?.1)).collect();
        Some(MeasuredRatio { omega, ratio, deviation: jackknife(&parts) })
    }
}

/// The lines without every eighth, each in turn.
fn without_each_group(lines: &[usize]) -> Vec<Vec<usize>> {
    let without = |group: usize| (0..lines.len()).filter(|i| i % GROUPS != group).map(|i| lines[i]).collect();
    (0..GROUPS.min(lines.len())).map(without).collect()
}

/// Standard deviation of an estimate from those with one group left out each.
fn jackknife(parts: &[f64]) -> f64 {
    let (centre, groups) = (mean(parts), parts.len() as f64);
    (parts.iter().map(|z| (z - centre).powi(2)).sum::<f64>() * (groups - 1.0) / groups).sqrt()
}

fn half_power_ratio(responses: &FrequencyResponses, omega: f64) -> Option<MeasuredRatio> {
    let peaks: Vec<HalfPower> =
        pairs(responses, omega).into_iter().filter_map(|pair| peak(responses, pair, omega)).collect();
    let ratios: Vec<f64> = peaks.iter().map(HalfPower::damping_ratio).collect();
    let ratio = mean(&ratios);
    let scatter = match ratios.len() {
        0 => return None,
        1 => ALONE * ratio,
        _ => standard_deviation(&ratios),
    };
    let omega = mean(&peaks.iter().map(|p| p.omega_peak).collect::<Vec<f64>>());
    Some(MeasuredRatio { omega, ratio, deviation: scatter.hypot(1.5 * ratio.powi(3)) })
}

/// Pairs of sensor and drive that show the resonance, the strongest first.
fn pairs(responses: &FrequencyResponses, omega: f64) -> Vec<(usize, usize)> {
    let near = |w: f64| (w - omega).abs();
    let lines = 0..responses.omega.len();
    let Some(line) = lines.min_by(|&a, &b| near(responses.omega[a]).total_cmp(&near(responses.omega[b]))) else {
        return Vec::new();
    };
    let h = &responses.values[line];
    let mut pairs: Vec<(usize, usize)> = (0..h.nrows())
        .flat_map(|i| (0..h.ncols()).map(move |j| (i, j)))
        .filter(|&p| h[p].norm() > SEEN * h.norm_max())
        .collect();
    pairs.sort_by(|a, b| h[*b].norm().total_cmp(&h[*a].norm()));
    pairs
}

fn peak(responses: &FrequencyResponses, (sensor, drive): (usize, usize), omega: f64) -> Option<HalfPower> {
    let distance = |p: &HalfPower| (p.omega_peak - omega).abs();
    let peaks = half_power::peaks(&responses.omega, &responses.series(sensor, drive));
    let peak = peaks.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let half = peak.damping_ratio() * peak.omega_peak;
    let inside = responses.omega.iter().filter(|&w| (w - peak.omega_peak).abs() < half).count();
    (inside >= LEAST_INSIDE && distance(&peak) < SAME_MODE * omega).then_some(peak)
}

/// Circle-fit ratio of every mode with five lines or more around its peak; `modes` as for [`half_power_ratios`].
pub fn circle_ratios(model: &Modes, responses: &FrequencyResponses, modes: &[ExtractedMode]) -> Vec<MeasuredRatio> {
    let ratio = |&omega: &f64| {
        let own = own(responses, modes, omega).and_then(|own| own.circle());
        own.or_else(|| circle_ratio(responses, omega))
    };
    model.omega.iter().filter_map(ratio).collect()
}

fn circle_ratio(responses: &FrequencyResponses, omega: f64) -> Option<MeasuredRatio> {
    let pair = *pairs(responses, omega).first()?;
    let peak = peak(responses, pair, omega)?;
    let within = |reach: f64| -> Vec<usize> {
        let limit = reach * peak.damping_ratio() * peak.omega_peak;
        (0..responses.omega.len()).filter(|&k| (responses.omega[k] - peak.omega_peak).abs() < limit).collect()
    };
    let circle = |lines: &[usize]| {
        let (w, h): (Vec<f64>, Vec<_>) = lines.iter().map(|&k| (responses.omega[k], responses.values[k][pair])).unzip();
        circle_fit(&w, &h).ok()
    };
    let lines = within(REACH);
    if lines.len() < LEAST_LINES {
        return None;
    }
    let whole = circle(&lines)?;
    // Other modes are not constant over the lines: what that does shows over fewer of them.
    let narrow = circle(&within(0.5 * REACH)).map_or(0.0, |c| c.damping_ratio - whole.damping_ratio);
    let groups = without_each_group(&lines);
    let parts: Vec<f64> = groups.iter().filter_map(|kept| circle(kept)).map(|circle| circle.damping_ratio).collect();
    let ratio = whole.damping_ratio;
    let usable = ratio > 0.0 && parts.len() == groups.len() && (whole.omega - omega).abs() < SAME_MODE * omega;
    usable.then(|| MeasuredRatio { omega: whole.omega, ratio, deviation: jackknife(&parts).hypot(narrow) })
}

//! Whether a transient has died out.
//!
//! Two signs. Near the driving frequency a transient changes the harmonics: those of the first third and of the last,
//! and of both halves, are compared, `|Y_last / z - Y_first|` against its deviation and against what matters.
//! `z = F_last / F_first` is what the force does meanwhile: a frequency that is slightly off turns all channels alike, and
//! a level that drifts slowly (shakers warm up) scales them alike. Neither is a transient: harmonics fitted to the whole
//! record are means, whose ratio to the force stays what it was. A force that starts or ends within the record is found
//! first (`ramps`). Away from the driving frequency a transient does not repeat from period to period and dies out: the scatter between
//! periods is larger in the first half than in the second.
//!
//! The parts compared are whole periods and begin at the same phase, so that harmonics above those fitted change both
//! alike.

use super::finding::{Finding, Flag};
use super::fit::HarmonicFit;
use super::fundamentals::fundamentals;
use super::noise::Lag;
use super::record::Record;
use super::signal::references;
use crate::math::statistics::median;
use faer::c64;
use std::f64::consts::SQRT_2;
use std::ops::Range;

/// Change of an amplitude over the record, relative, that matters. A structure at 1 % damping that rings down by this
/// much in ten periods gives back 0.3 % of the energy of the record; below that noise and sensors decide.
pub(super) const SETTLED: f64 = 2e-3;

/// Probability that noise alone passes for a drift in one comparison: a run has some twenty.
const DRIFT_BY_CHANCE: f64 = 1e-5;

/// Deviations by which the scatter must fall from the first half to the second.
const FALL_DEVIATIONS: f64 = 5.0;

/// Change of the force over the record up to which the response follows it in proportion: beyond it laws that depend on
/// the amplitude bend the mean.
const LEVEL_DRIFT: f64 = 0.02;

/// Blocks of either half whose scatter is compared by the median, so that a single spike decides nothing.
const BLOCKS: usize = 3;

/// Fewest differences in a block.
const FEWEST_IN_BLOCK: usize = 24;

/// Variance of the median over that of the mean, of normal variables.
const MEDIAN_PENALTY: f64 = 1.571;

/// Variance of a mean of squared differences over that of independent ones: neighbours share a sample each.
const SHARED: f64 = 1.5;

/// A change found in a channel.
struct Drift {
    channel: usize,
    relative: f64,
    explained: f64,
}

/// The finding that a transient has not died out, for the channel that shows it most.
pub(super) fn not_settled(record: &Record, fit: &HarmonicFit) -> Option<Finding> {
    if let Some(ramps) = super::ramps::find(record, fit) {
        return Some(Finding::of_record(Flag::NotSettled, ramps.reason(fit)));
    }
    let name = |c: usize| fit.channels[c].channel.to_string();
    let drifts =
        [(3, "third"), (2, "half")].into_iter().filter_map(|(parts, word)| Some((drift(record, fit, parts)?, word)));
    if let Some((drift, part)) = drifts.max_by(|a, b| a.0.relative.total_cmp(&b.0.relative)) {
        let found = finding(format!(
            "{} changes by {:.2} % from the first {part} of the record to the last (noise explains {:.2} %)",
            name(drift.channel),
            100.0 * drift.relative,
            100.0 * drift.explained
        ));
        return Some(found.of_share(drift.relative));
    }
    let (channel, relative) = fall(record, fit)?;
    let found = finding(format!(
        "{} has a part that does not repeat, of {:.2} % in the first half of the record, and dies out",
        name(channel),
        100.0 * relative
    ));
    Some(found.of_share(relative))
}

fn finding(what: String) -> Finding {
    Finding::of_record(Flag::NotSettled, format!("{what}: a transient is still there, record later"))
}

/// Ranges of samples of the first and the last of `parts` parts of the record, whole periods that begin at one phase.
fn ends(time: &[f64], period: f64, parts: usize) -> Option<[Range<usize>; 2]> {
    let first = time[0];
    let step = (time[time.len() - 1] - first) / (time.len() - 1) as f64;
    let periods = (time[time.len() - 1] - first + step) / period + 1e-9;
    let length = (periods / parts as f64).floor();
    if length < 1.0 {
        return None;
    }
    // A hundredth of a step of tolerance: a sample at the end of a period belongs to the next, whatever rounding says.
    let index = |periods: f64| time.partition_point(|t| *t < first + periods * period - 0.01 * step);
    let late = (periods - length).floor();
    Some([index(0.0)..index(length), index(late)..index(late + length)])
}

/// The largest change of a fundamental between the ends of the record that is significant and matters.
fn drift(record: &Record, fit: &HarmonicFit, parts: usize) -> Option<Drift> {
    let [first, last] = ends(record.time(), fit.period(), parts)?;
    let (first, last) = (fundamentals(record, fit, first)?, fundamentals(record, fit, last)?);
    let variance = |c: usize| {
        fit.channels[c].noise.powi(2) * (first.unit_variance + last.unit_variance) + first.cut[c] + last.cut[c]
    };
    let (before, after) = (&first.fundamentals, &last.fundamentals);
    let (change_of_force, turn_variance) = common_change(fit, before, after, variance);
    let freedom = (record.len() - 2 * fit.harmonics() - 2) as f64;
    // Quantile of F(2, freedom), times two: both parts of a complex number against an estimated variance.
    let limit = freedom * (DRIFT_BY_CHANCE.powf(-2.0 / freedom) - 1.0);
    let references = references(fit);
    let drifts = (0..before.len()).filter_map(|c| {
        let change = after[c] / change_of_force - before[c];
        let own = variance(c);
        // Along the channel's own direction lies the change of amplitude, across it the turn: both as uncertain as what
        // is known of the force.
        let size = before[c].re.hypot(before[c].im);
        let along = if size > 0.0 { before[c] / size } else { c64::new(1.0, 0.0) };
        let split = change * along.conj();
        let across = own + size * size * turn_variance;
        let significant = (split.re.powi(2) + split.im.powi(2)) / across > limit;
        let amplitude = SQRT_2 * references[c];
        let relative = split.re.hypot(split.im) / amplitude;
        let explained = (own + across).sqrt() / amplitude;
        (significant && relative > SETTLED).then_some(Drift { channel: c, relative, explained })
    });
    drifts.max_by(|a, b| a.relative.total_cmp(&b.relative))
}

/// Ratio of the forces after to before (without a force: the turn of all channels), and its variance.
fn common_change(fit: &HarmonicFit, before: &[c64], after: &[c64], variance: impl Fn(usize) -> f64) -> (c64, f64) {
    let forces: Vec<usize> = fit.force_channels().into_iter().filter(|&c| fit.channels[c].noise > 0.0).collect();
    let used = if forces.is_empty() { (0..before.len()).collect() } else { forces.clone() };
    let (mut product, mut information) = (c64::new(0.0, 0.0), 0.0);
    for c in used {
        let variance = variance(c);
        if variance > 0.0 {
            product += before[c].conj() * after[c] / variance;
            information += before[c].norm_sqr() / variance;
        }
    }
    if information <= 0.0 || product.norm_sqr() == 0.0 {
        return (c64::new(1.0, 0.0), 0.0);
    }
    let ratio = product.norm() / information;
    let follows = !forces.is_empty() && (ratio - 1.0).abs() < LEVEL_DRIFT;
    (product / product.norm() * if follows { ratio } else { 1.0 }, 1.0 / information)
}

/// The channel whose scatter between periods falls most, with the amplitude of what dies out over its own.
fn fall(record: &Record, fit: &HarmonicFit) -> Option<(usize, f64)> {
    let lag = Lag::new(record.time(), fit.period())?;
    let references = references(fit);
    let middle = record.time()[0] + 0.5 * (record.duration() - fit.period());
    let falls = (0..fit.channels.len()).filter(|&c| references[c] > 0.0).filter_map(|c| {
        let (mut early, mut late) = (Vec::new(), Vec::new());
        lag.each(
            record.samples(c),
            |n, d| if record.time()[n] < middle { early.push(d * d) } else { late.push(d * d) },
        );
        let (early, early_deviation) = scatter(&early)?;
        let (late, late_deviation) = scatter(&late)?;
        let fallen = (early / late).ln() / early_deviation.hypot(late_deviation);
        let relative = (early - late).max(0.0).sqrt() / references[c];
        (fallen > FALL_DEVIATIONS && relative > SETTLED).then_some((c, relative))
    });
    falls.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Median over blocks of the mean squared difference, and its relative deviation.
fn scatter(squares: &[f64]) -> Option<(f64, f64)> {
    let size = squares.len() / BLOCKS;
    if size < FEWEST_IN_BLOCK {
        return None;
    }
    let means: Vec<f64> = squares.chunks_exact(size).map(|block| block.iter().sum::<f64>() / size as f64).collect();
    let deviation = (2.0 * SHARED * MEDIAN_PENALTY / (size * BLOCKS) as f64).sqrt();
    Some((median(&means), deviation))
}

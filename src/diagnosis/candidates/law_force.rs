//! The force that an effect would have at the motion of every run, and the error of a channel that fits best.

use super::friction::friction;
use super::identified_force::{LawFit, PlaceData};
use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::location::Spot;
use crate::effects::{ChannelLaw, Effect, Kind, Law, Motion, Sampling, Source, State};
use dashpot_numerics::dot;
use faer::c64;

/// Secant steps to the mean of a motion, and the share of it below which it rests.
const SECANTS: usize = 8;
const AT_REST: f64 = 1e-6;
/// Bounds of the gain of a channel: beyond a wrong range or sensitivity it is no channel of this motion.
pub(crate) const GAINS: [f64; 2] = [0.05, 20.0];
/// Delays that are tried: up to half the longest period, beyond which a channel is as well early; in steps of half a radian at the
/// highest frequency, within the basin of attraction, half a turn, from which Newton's method arrives; no more than so many either way.
const OF_LONGEST_PERIOD: f64 = 0.5;
const COARSE_PHASE: f64 = 0.5;
const MOST_DELAYS: f64 = 500.0;

impl PlaceData {
    /// Harmonics of the force of `source`, an effect that acts here, at the motion of every run, `[run][harmonic]`, N (of a
    /// channel its relative error); `None` of an effect that cannot act here.
    pub(crate) fn forces_of(&self, source: &Source) -> Option<Vec<Vec<c64>>> {
        let p = &source.parameters;
        let force_in_run: Box<dyn Fn(usize, usize) -> Vec<c64>> = match (source.effect.kind(), &self.spot) {
            (Kind::Relative(law), Spot::Leg(_)) => match friction(source.effect) {
                Some(friction) => Box::new(move |r, order| self.held(friction, p, r, order)),
                None => Box::new(move |r, order| self.law_force(law, p, r, order)),
            },
            (Kind::Channel(law), Spot::Response(_) | Spot::Force(_)) => {
                Box::new(move |r, order| self.channel_error(law, p[0], r, order))
            }
            _ => return None,
        };
        Some(self.forces.iter().enumerate().map(|(r, forces)| force_in_run(r, forces.len())).collect())
    }

    /// Harmonics of the force of a law at the motion of run `r` and the mean that its own mean force gives it there, which no
    /// accelerometer records.
    pub(super) fn law_force(&self, law: &dyn Law, p: &[f64], r: usize, order: usize) -> Vec<c64> {
        let motion = &self.motions[r];
        if law.description().odd || self.static_compliance == 0.0 {
            return self.at_motion(law, p, motion, order);
        }
        let motion = about_its_mean(law, p, motion, &self.sampling, self.static_compliance);
        self.at_motion(law, p, &motion, order)
    }

    pub(super) fn at_motion(&self, law: &dyn Law, p: &[f64], motion: &Motion, order: usize) -> Vec<c64> {
        if law.dynamic_stiffness(p, motion.omega).is_some() {
            let force_at_harmonic = |(i, d): (usize, &c64)| {
                law.dynamic_stiffness(p, (i + 1) as f64 * motion.omega).unwrap_or(c64::new(0.0, 0.0)) * d
            };
            return motion.harmonics.iter().enumerate().map(force_at_harmonic).collect();
        }
        let mut samples = vec![0.0; motion.len()];
        law.force(p, motion, &mut samples);
        let mut harmonics = vec![c64::new(0.0, 0.0); order];
        self.sampling.analyse(&samples, &mut harmonics);
        harmonics
    }

    /// Relative error of this channel by a law of parameter `p` at the harmonics of run `r`.
    pub(super) fn channel_error(&self, law: &dyn ChannelLaw, p: f64, r: usize, order: usize) -> Vec<c64> {
        let force = matches!(self.spot, Spot::Force(_));
        let value = |h: usize, t: c64| if force || h == 1 { 1.0 - 1.0 / t } else { t - 1.0 };
        (1..=order).map(|h| value(h, law.transfer(p, h as f64 * self.motions[r].omega))).collect()
    }

    /// Fits the error `effect` of this channel; `None` if its value is out of range.
    pub(super) fn fit_channel(&self, effect: Effect, law: &dyn ChannelLaw) -> Option<LawFit> {
        // What a factor does to what is read is linear in its inverse.
        let parameter = |x: f64| if law.turns_phase() { x } else { x.recip() };
        let misfit = |x: f64| -> f64 {
            let rows = self.rows(1.0, |r, order| self.channel_error(law, parameter(x), r, order));
            dot(&rows, &rows)
        };
        let step = law.small_step(self.range.omega.max(1e-3));
        let mut x = if law.turns_phase() { self.coarse_delay(law) } else { law.neutral().recip() };
        for _ in 0..12 {
            // Newton's method by differences: the misfit is nearly quadratic in the only variable.
            let (low, mid, high) = (misfit(x - step), misfit(x), misfit(x + step));
            let curvature = (high - 2.0 * mid + low) / (step * step);
            if curvature <= 0.0 {
                break;
            }
            let change = -(high - low) / (2.0 * step) / curvature;
            x += change;
            if !law.turns_phase() {
                x = x.clamp(GAINS[1].recip(), GAINS[0].recip());
            }
        }
        let p = parameter(x);
        let at_a_bound = !law.turns_phase() && (p <= GAINS[0] || p >= GAINS[1]);
        if !p.is_finite() || at_a_bound || !effect.parameters()[0].allows(p) {
            return None;
        }
        let source = Source { effect, place: self.spot.place(), state: State::Known, parameters: vec![p] };
        Some(LawFit { source, misfit: misfit(x) })
    }

    /// The delay, to a fraction of the shortest period, that leaves least of the free errors of this channel at the fundamentals: a
    /// delay of a period or more has many local minima.
    fn coarse_delay(&self, law: &dyn ChannelLaw) -> f64 {
        let omegas = || self.motions.iter().map(|motion| motion.omega);
        let (slowest, fastest) = (omegas().fold(f64::INFINITY, f64::min), omegas().fold(0.0, f64::max));
        let (longest, step) = (OF_LONGEST_PERIOD * std::f64::consts::TAU / slowest, COARSE_PHASE / fastest);
        let count = (longest / step).clamp(0.0, MOST_DELAYS);
        let left = |p: f64| -> f64 {
            let of_run = |(r, forces): (usize, &Vec<FreeForce>)| {
                let error = self.channel_error(law, p, r, 1).first().copied();
                let pair = forces.first().zip(error);
                pair.map_or(0.0, |(free, error)| free.weight * (free.value - error).norm_sqr())
            };
            self.forces.iter().enumerate().map(of_run).sum()
        };
        let near_first = (0..=count as i32).flat_map(|k| [f64::from(k) * step, -f64::from(k) * step]);
        let scored = near_first.map(|p| (left(p), p));
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(law.neutral(), |(_, p)| p)
    }
}

/// `motion` about the mean `D_0 = -C_0 F_0(D_0)` that a structure of static compliance `C_0` (m/N) takes under the mean force of the
/// law.
fn about_its_mean(law: &dyn Law, p: &[f64], motion: &Motion, sampling: &Sampling, compliance: f64) -> Motion {
    let mut motion = motion.clone();
    let mut samples = vec![0.0; motion.len()];
    let mut rest = |motion: &mut Motion, mean: f64| {
        motion.mean = mean;
        sampling.refresh(motion);
        law.force(p, motion, &mut samples);
        mean + compliance * samples.iter().sum::<f64>() / samples.len() as f64
    };
    let mut before = (0.0, rest(&mut motion, 0.0));
    let mut mean = -before.1;
    for _ in 0..SECANTS {
        let now = rest(&mut motion, mean);
        let slope = (now - before.1) / (mean - before.0);
        // Where the law is softer than the structure it has no mean to rest at: the last one tried is as good as any.
        if !slope.is_finite() || slope <= 0.0 || now.abs() < AT_REST * mean.abs() {
            break;
        }
        before = (mean, now);
        mean -= now / slope;
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic spring under `d = D_0 + a cos`: `D_0 = -C k (a^2 / 2 + D_0^2)`, a quadratic equation.
    #[test]
    fn a_spring_stiffer_in_one_direction_rests_beside_the_middle() {
        let (k, a, compliance) = (8e6, 4e-3, 1e-5);
        let Some(law) = Effect::QuadraticStiffness.law() else { panic!("a law") };
        let sampling = Sampling::new(64);
        let motion = sampling.motion(80.0, 0.0, &[c64::new(0.0, a)]);
        let found = about_its_mean(law, &[k], &motion, &sampling, compliance);
        let share = compliance * k;
        let exact = ((1.0 - 2.0 * (share * a).powi(2)).sqrt() - 1.0) / (2.0 * share);
        assert!((found.mean / exact - 1.0).abs() < 1e-5, "{} {exact}", found.mean);
        assert!((found.displacement[0] - motion.displacement[0] - found.mean).abs() < 1e-15);
    }
}

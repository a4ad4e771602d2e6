//! The force that an effect would have at the motion of every run, and the error of a channel that fits best.

use super::friction::friction;
use super::identified_force::{LawFit, PlaceData};
use crate::diagnosis::localisation::location::Spot;
use crate::effects::{ChannelLaw, Effect, Kind, Source, State};
use dashpot_numerics::dot;
use faer::c64;

/// Bounds of the gain of a channel while it is searched.
pub(crate) const GAINS: [f64; 2] = [0.5, 2.0];

impl PlaceData {
    /// Harmonics of the force of `source`, an effect that acts here, at the motion of every run, `[run][harmonic]`, N (of a
    /// channel its relative error); `None` of an effect that cannot act here.
    pub(crate) fn forces_of(&self, source: &Source) -> Option<Vec<Vec<c64>>> {
        let p = &source.parameters;
        let of: Box<dyn Fn(usize, usize) -> Vec<c64>> = match (source.effect.kind(), &self.spot) {
            (Kind::Relative(law), Spot::Leg(_)) => match friction(source.effect) {
                Some(friction) => Box::new(move |r, order| self.held(friction, p, r, order)),
                None => Box::new(move |r, order| self.law_force(law, p, &self.motions[r], order)),
            },
            (Kind::Channel(law), Spot::Response(_) | Spot::Force(_)) => {
                Box::new(move |r, order| self.channel_error(law, p[0], r, order))
            }
            _ => return None,
        };
        Some(self.forces.iter().enumerate().map(|(r, forces)| of(r, forces.len())).collect())
    }

    /// Relative error of this channel by a law of parameter `p` at the harmonics of run `r`.
    pub(super) fn channel_error(&self, law: &dyn ChannelLaw, p: f64, r: usize, order: usize) -> Vec<c64> {
        let force = matches!(self.spot, Spot::Force(_));
        let value = |h: usize, t: c64| if force || h == 1 { 1.0 - 1.0 / t } else { t - 1.0 };
        (1..=order).map(|h| value(h, law.transfer(p, h as f64 * self.motions[r].omega))).collect()
    }

    /// Fits the error `effect` of this channel; `None` if its value is out of range.
    pub(super) fn fit_channel(&self, effect: Effect, law: &dyn ChannelLaw) -> Option<LawFit> {
        let misfit = |p: f64| -> f64 {
            let rows = self.rows(1.0, |r, order| self.channel_error(law, p, r, order));
            dot(&rows, &rows)
        };
        let step = law.small_step(self.range.omega.max(1e-3));
        let mut p = law.neutral();
        for _ in 0..12 {
            // Newton's method by differences: the misfit is nearly quadratic in the only parameter.
            let (low, mid, high) = (misfit(p - step), misfit(p), misfit(p + step));
            let curvature = (high - 2.0 * mid + low) / (step * step);
            if curvature <= 0.0 {
                break;
            }
            let change = -(high - low) / (2.0 * step) / curvature;
            p += change;
            if !law.turns_phase() {
                p = p.clamp(GAINS[0], GAINS[1]);
            }
        }
        let at_a_bound = !law.turns_phase() && (p <= GAINS[0] || p >= GAINS[1]);
        if !p.is_finite() || at_a_bound || !effect.parameters()[0].allows(p) {
            return None;
        }
        let source = Source { effect, place: self.spot.place(), state: State::Known, parameters: vec![p] };
        Some(LawFit { source, misfit: misfit(p) })
    }
}

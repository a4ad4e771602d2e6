//! The force that an effect would have at the motion of every run.

use super::friction::slides;
use super::identified_force::PlaceData;
use crate::diagnosis::localisation::location::Spot;
use crate::effects::{ChannelLaw, Source, effect::Kind};
use faer::c64;

impl PlaceData {
    /// Harmonics of the force of `source`, an effect that acts here, at the motion of every run, `[run][harmonic]`, N (of a
    /// channel its relative error); `None` of an effect that cannot act here.
    pub fn forces_of(&self, source: &Source) -> Option<Vec<Vec<c64>>> {
        let p = &source.parameters;
        let of: Box<dyn Fn(usize, usize) -> Vec<c64>> = match (source.effect.kind(), &self.spot) {
            (Kind::Relative(_), Spot::Leg(_)) if slides(source.effect) => {
                Box::new(|r, order| self.friction(source.effect, p, r, order))
            }
            (Kind::Relative(law), Spot::Leg(_)) => {
                Box::new(move |r, order| self.law_force(law, p, &self.motions[r], order))
            }
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
        let value = |t: c64| if force { 1.0 - 1.0 / t } else { t - 1.0 };
        (1..=order).map(|h| value(law.transfer(p, h as f64 * self.motions[r].omega))).collect()
    }
}

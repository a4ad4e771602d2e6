//! Damping of the followed modes, which laws of the whole structure state in one proportion.

use super::data::Records;
use crate::effects::{Kind, Place};

impl Records<'_> {
    /// Modes whose damping by laws of the whole structure is corrected each by itself: no structure damps its modes in just the
    /// proportion that these laws state. One mode alone is damped by their size.
    pub(super) fn damped(&self) -> usize {
        let whole = self.known.iter().any(|source| source.place == Place::Whole(None));
        if whole && self.kept > 1 { self.kept } else { 0 }
    }

    /// Corrections of sizes: of the known sources and of the damping of modes.
    pub(super) fn sizes(&self) -> usize {
        self.known.len() + self.damped()
    }

    /// Damping that laws of the whole structure give the modes whose damping is corrected, 1/s, their sizes multiplied by factors of
    /// these logarithms.
    pub(super) fn modal_damping(&self, logarithms: &[f64]) -> Vec<f64> {
        let damping_at = |omega: f64| {
            let laws = self.known.iter().zip(logarithms).filter(|(source, _)| source.place == Place::Whole(None));
            let damping = laws.map(|(source, v)| match source.effect.kind() {
                Kind::Whole(law) => {
                    v.exp() * law.factor(source.coefficient(), omega).im * law.basis().of_mode(omega * omega) / omega
                }
                Kind::Relative(_) | Kind::Channel(_) => 0.0,
            });
            damping.sum::<f64>()
        };
        self.modes.omega[..self.damped()].iter().map(|&omega| damping_at(omega.max(f64::MIN_POSITIVE))).collect()
    }
}

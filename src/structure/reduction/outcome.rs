//! How a structure was reduced, and how well.

use super::mode_check::ModeCheck;
use super::request::{ReductionMethod, Wanted};
use crate::structure::error::six_digits;

/// How a structure was reduced, and how well.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduction {
    /// What was asked.
    pub wanted: Wanted,
    /// Degrees of freedom of the whole model.
    pub from_dofs: usize,
    /// Physical degrees of freedom that were kept; they come first.
    pub kept: usize,
    /// Fixed-interface modes that follow them.
    pub fixed_interface_modes: usize,
    /// Modes in the band, ascending.
    pub modes: Vec<ModeCheck>,
    /// `T^T M r` for a base that moves by 1 m in x, y and z: one value a reduced degree of freedom, kg.
    pub base_loads: [Vec<f64>; 3],
}

impl Reduction {
    /// The mode in the band whose frequency is off most.
    pub fn worst(&self) -> Option<&ModeCheck> {
        self.modes.iter().max_by(|a, b| a.frequency_error().abs().total_cmp(&b.frequency_error().abs()))
    }

    /// The reduction and its error, in one sentence.
    pub fn sentence(&self) -> String {
        let Wanted { method, up_to_hz, band_hz, .. } = self.wanted;
        let [up_to_hz, band_hz] = [up_to_hz, band_hz].map(six_digits);
        let modes = match method {
            ReductionMethod::Guyan => String::new(),
            ReductionMethod::CraigBampton => {
                format!(" and {} fixed-interface modes up to {up_to_hz} Hz", self.fixed_interface_modes)
            }
        };
        let error = self.worst().map_or_else(
            || format!("the model has no mode up to {band_hz} Hz"),
            |worst| {
                let (count, percent) = (self.modes.len(), 100.0 * worst.frequency_error().abs());
                format!("frequencies of the {count} modes up to {band_hz} Hz are off by {percent:.2e} % at most (at {:.5} Hz)", worst.full_hz)
            },
        );
        let (method, from, kept) = (method.name(), self.from_dofs, self.kept);
        format!("reduced by {method} from {from} degrees of freedom to {kept}{modes}; {error}")
    }
}

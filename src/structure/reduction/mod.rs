//! A large sparse model reduced to the degrees of freedom of interest.
//!
//! ```text
//! x = T q,   T = [ I    0  ]  kept DOFs b         M_r = T^T M T,   K_r = T^T K T
//!                [ Psi  Phi]  inner DOFs i
//! Guyan:          Psi = -K_ii^-1 K_ib,                                   no Phi
//! Craig-Bampton:  Psi = -K_ii^-1 K_ib less its part in Phi,  Phi: modes of (K_ii, M_ii) up to a frequency
//! ```
//!
//! R. J. Guyan, AIAA J. 3 (1965) 380; R. R. Craig and M. C. C. Bampton, AIAA J. 6 (1968) 1313. Where the kept DOFs
//! leave rigid motions free, `K_ii` is singular: those motions are among `Phi`, and `Psi` is found with `K_ii + s M_ii` in steps.
//! The error is told on the modes in the band: the whole model's, by block Lanczos, against those of the reduced one.

mod check;
mod mode_check;
mod pencil;
mod reduce;

pub use mode_check::ModeCheck;
pub use reduce::reduce;

use super::error::six_digits;
use dashpot_numerics::SparseSymmetric;

/// Mass and stiffness of a whole model, n x n.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseSystem {
    /// Mass, kg.
    pub mass: SparseSymmetric,
    /// Stiffness, N/m.
    pub stiffness: SparseSymmetric,
}

/// Ways to reduce a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Static condensation.
    Guyan,
    /// Static condensation and fixed-interface modes.
    CraigBampton,
}

impl Method {
    /// Name in project files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Guyan => "guyan",
            Self::CraigBampton => "craig-bampton",
        }
    }

    /// The method of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Guyan, Self::CraigBampton].into_iter().find(|method| method.name() == name)
    }
}

/// What is asked of a reduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// Method.
    pub method: Method,
    /// Fixed-interface modes are kept up to this frequency, Hz.
    pub up_to_hz: f64,
    /// The error is told on the modes up to this frequency, Hz.
    pub band_hz: f64,
    /// Largest relative error of a frequency in the band; more fixed-interface modes are kept where it is larger.
    pub error: f64,
}

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
            Method::Guyan => String::new(),
            Method::CraigBampton => {
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

#[cfg(test)]
mod tests;

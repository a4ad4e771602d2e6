//! The model to be reduced, and what is asked of the reduction.

use dashpot_numerics::SparseSymmetric;

/// Mass and stiffness of a whole model, n x n.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SparseSystem {
    /// Mass, kg.
    pub mass: SparseSymmetric,
    /// Stiffness, N/m.
    pub stiffness: SparseSymmetric,
}

/// Ways to reduce a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReductionMethod {
    /// Static condensation.
    Guyan,
    /// Static condensation and fixed-interface modes.
    CraigBampton,
}

impl ReductionMethod {
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
    pub method: ReductionMethod,
    /// Fixed-interface modes are kept up to this frequency, Hz.
    pub up_to_hz: f64,
    /// The error is told on the modes up to this frequency, Hz.
    pub band_hz: f64,
    /// Largest relative error of a frequency in the band; more fixed-interface modes are kept where it is larger.
    pub error: f64,
}

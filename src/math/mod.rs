//! Numerical kernels that know nothing of structures.

pub(crate) mod bootstrap;
pub(crate) mod decimation;
pub mod eigen;
pub(crate) mod fill;
pub(crate) mod fractional_delay;
pub(crate) mod hermitian;
pub mod least_squares;
pub mod nnls;
pub(crate) mod numerals;
pub(crate) mod spectrum;
pub(crate) mod statistics;
pub mod subsets;
pub(crate) mod zero_phase;

/// Greatest number that is a physical quantity in SI units: beyond it stand marks of other programs and slips of the pen, whose squares and
/// products overflow.
pub(crate) const GREATEST: f64 = 1e30;

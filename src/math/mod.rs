//! Numerical kernels that know nothing of structures.

pub mod bootstrap;
pub mod eigen;
pub mod fill;
pub mod hermitian;
pub mod least_squares;
pub mod nnls;
pub mod numerals;
pub mod spectrum;
pub mod statistics;
pub mod subsets;

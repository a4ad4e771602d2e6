//! Frequency responses on all lines of a test, for methods that read resonance curves: the lines that become runs are chosen for
//! what they say of damping, too few to show the width of a peak.

use faer::c64;

/// Functions on common lines, corrected for the known errors of their channels.
#[derive(Debug, Clone, PartialEq)]
pub struct WholeFunctions {
    /// Circular frequencies, rad/s, ascending and positive.
    pub omega: Vec<f64>,
    /// The functions; as long as `omega`.
    pub functions: Vec<WholeFunction>,
}

/// The receptance between two DOFs.
#[derive(Debug, Clone, PartialEq)]
pub struct WholeFunction {
    /// DOF row of the response.
    pub response: usize,
    /// DOF row of the force.
    pub reference: usize,
    /// Receptance, m/N (rad, N m at rotations).
    pub receptance: Vec<c64>,
    /// Standard deviation of its real part, and of its imaginary part.
    pub deviation: Vec<f64>,
}

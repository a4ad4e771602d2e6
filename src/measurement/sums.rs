//! Sums over all samples that the normal matrix of the harmonic fit is made of.

/// Sums over all samples that the normal matrix is made of.
#[derive(Debug, Clone)]
pub(super) struct Sums {
    /// Sum of `s`.
    pub(super) s: f64,
    /// Sum of its square.
    pub(super) s_squared: f64,
    /// Sums of `cos(k theta)`, k = 0..2H.
    pub(super) cos: Vec<f64>,
    /// Sums of `sin(k theta)`, k = 0..2H.
    pub(super) sin: Vec<f64>,
    /// Sums of `s cos(k theta)`, k = 0..H.
    pub(super) s_cos: Vec<f64>,
    /// Sums of `s sin(k theta)`, k = 0..H.
    pub(super) s_sin: Vec<f64>,
}

impl Sums {
    /// All zero, for harmonics up to H.
    pub(super) fn zero(harmonics: usize) -> Self {
        let (twice, once) = (vec![0.0; 2 * harmonics + 1], vec![0.0; harmonics + 1]);
        Self { s: 0.0, s_squared: 0.0, cos: twice.clone(), sin: twice, s_cos: once.clone(), s_sin: once }
    }
}

//! What a forward computation gives back: the response, how it was found, and why it was not.

use crate::effects::Leg;
use faer::{Mat, c64};

/// How a response was reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// No nonlinear source: solved directly.
    Linear,
    /// Converged to the tolerance, and enough harmonics.
    Converged,
    /// Converged, but the truncation error is above the tolerance at the most harmonics allowed.
    HarmonicsExhausted,
    /// More harmonics did not converge; the result is that of fewer.
    FellBack,
}

/// One attempt on the way to a response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvergenceStep {
    /// Harmonics.
    pub harmonics: usize,
    /// What was tried.
    pub attempt: Attempt,
    /// Newton steps.
    pub steps: usize,
    /// Relative residual at the end.
    pub residual: f64,
    /// Whether it converged.
    pub converged: bool,
}

/// A way to reach a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attempt {
    /// Newton's method from the start.
    Newton,
    /// The force raised in steps, Newton's method at each.
    Level,
    /// The force followed by arc length through turning points.
    Arc,
}

/// Force of one source at one relative motion.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceForce {
    /// Index in the list of sources.
    pub source: usize,
    /// Where it acts.
    pub leg: Leg,
    /// Static force, N.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1..=H, N.
    pub harmonics: Vec<c64>,
}

/// A periodic response of all degrees of freedom.
#[derive(Debug, Clone)]
pub struct Response {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Static displacement of every DOF, m.
    pub mean: Vec<f64>,
    /// Complex amplitudes of displacement, m: n rows, column `h - 1` is harmonic `h`.
    pub harmonics: Mat<c64>,
    /// How it was reached.
    pub status: Status,
    /// Estimated error (m) of each harmonic by truncation of the series, largest over all DOFs; 0 for linear models.
    pub truncation: Vec<f64>,
    /// The same for every DOF (m, rad for rotations): n rows, column `h - 1` is harmonic `h`.
    pub truncation_by_dof: Mat<f64>,
    /// Forces of all sources between single DOFs.
    pub forces: Vec<SourceForce>,
    /// Attempts in order.
    pub history: Vec<ConvergenceStep>,
    /// Number of nonlinear legs.
    pub(crate) legs: usize,
    /// Coefficients of the nonlinear leg forces, `2 H + 1` a leg, then the forces of modes at resonance.
    pub(crate) unknowns: Vec<f64>,
    /// Order and unknowns of the solution with fewer harmonics, where the response is extrapolated from both.
    pub(crate) coarse: Option<(usize, Vec<f64>)>,
    /// Harmonics before extrapolation.
    pub(crate) raw: Option<Mat<c64>>,
}

impl Response {
    /// A start near a motion: displacement amplitudes (m, n x H) with `2 H + 1` coefficients of force for every nonlinear
    /// relative motion, in the order of the sources.
    pub(crate) fn near(omega: f64, harmonics: Mat<c64>, unknowns: Vec<f64>) -> Self {
        Self {
            omega,
            mean: vec![0.0; harmonics.nrows()],
            status: Status::Converged,
            truncation: vec![0.0; harmonics.ncols()],
            truncation_by_dof: Mat::zeros(harmonics.nrows(), harmonics.ncols()),
            forces: Vec::new(),
            history: Vec::new(),
            legs: unknowns.len() / (2 * harmonics.ncols() + 1),
            harmonics,
            unknowns,
            coarse: None,
            raw: None,
        }
    }

    /// Complex displacement amplitude (m) of row `dof` at harmonic `h >= 1`; 0 beyond the harmonics.
    pub fn amplitude(&self, dof: usize, h: usize) -> c64 {
        if h >= 1 && h <= self.harmonics.ncols() { self.harmonics[(dof, h - 1)] } else { c64::new(0.0, 0.0) }
    }

    /// The same response with the estimated truncation error (m) of every DOF and harmonic, n x H.
    #[must_use]
    pub(crate) fn with_truncation(self, by_dof: Mat<f64>) -> Self {
        let largest = |h: usize| by_dof.col_as_slice(h).iter().fold(0.0_f64, |m, &e| m.max(e));
        Self { truncation: (0..by_dof.ncols()).map(largest).collect(), truncation_by_dof: by_dof, ..self }
    }

    /// Estimated truncation error (m) of row `dof` at harmonic `h >= 1`; 0 beyond the harmonics.
    pub fn truncation_at(&self, dof: usize, h: usize) -> f64 {
        let known = h >= 1 && h <= self.truncation_by_dof.ncols() && dof < self.truncation_by_dof.nrows();
        if known { self.truncation_by_dof[(dof, h - 1)] } else { 0.0 }
    }

    /// Displacements of all DOFs as solved, before extrapolation, harmonics 0..=H.
    pub(crate) fn displacements(&self) -> Vec<Vec<c64>> {
        let amplitudes = self.raw.as_ref().unwrap_or(&self.harmonics);
        let mean = self.mean.iter().map(|&x| c64::new(x, 0.0)).collect();
        std::iter::once(mean).chain((0..self.order()).map(|h| amplitudes.col_as_slice(h).to_vec())).collect()
    }

    /// Number of harmonics.
    pub fn order(&self) -> usize {
        self.harmonics.ncols()
    }

    /// Displacement (m) and velocity (m/s) of every DOF at time `t` (s).
    pub fn state_at(&self, t: f64) -> (Vec<f64>, Vec<f64>) {
        let mut displacement = self.mean.clone();
        let mut velocity = vec![0.0; displacement.len()];
        for h in 1..=self.order() {
            let w = h as f64 * self.omega;
            let (sin, cos) = (w * t).sin_cos();
            for (dof, x) in self.harmonics.col_as_slice(h - 1).iter().enumerate() {
                displacement[dof] += x.re * cos - x.im * sin;
                velocity[dof] -= w * (x.re * sin + x.im * cos);
            }
        }
        (displacement, velocity)
    }
}

//! A relative motion with a nonlinear law, and what the law answers there.

use super::fourier::{Fourier, add_amplitude, amplitude};
use crate::effects::{Law, Leg, Manner};

/// Share by which a friction force is drawn to zero where the motion leaves it free (mean force in full stick, two
/// frictions on one leg).
pub(crate) const SLACK: f64 = 1e-9;

/// One relative motion with a nonlinear law.
#[derive(Clone)]
pub(crate) struct NonlinearLeg {
    /// Index of the source in the list given.
    pub source: usize,
    pub leg: Leg,
    pub parameters: Vec<f64>,
    pub law: &'static dyn Law,
    /// Velocity weight `r` of the clamp, N s/m.
    pub weight: f64,
    /// Flexibility of the spring in series with the slider, m/N, where an elastic slider is so stiff that it is taken as
    /// friction behind a spring; the leg's motion is that of the slider then. Zero otherwise.
    pub flexibility: f64,
}

impl NonlinearLeg {
    /// How the law is asked. A slider behind a spring is asked as the friction of the slider alone.
    pub(crate) fn manner(&self) -> Manner {
        if self.flexibility > 0.0 { Manner::SetValued } else { self.law.manner(&self.parameters) }
    }

    /// Whether the force may answer a larger motion in more than one way (stiffness laws fold the response).
    pub(crate) fn folds(&self) -> bool {
        self.law.description().folds
    }

    /// Whether the opposite motion is answered by the opposite force.
    pub(crate) fn is_odd(&self) -> bool {
        self.law.description().odd
    }

    /// Whether the law looks at the leg's own force.
    pub(crate) fn takes_force(&self) -> bool {
        matches!(self.manner(), Manner::SetValued | Manner::Steep)
    }
}

/// `Phi` of one leg with its derivatives.
pub(crate) struct LawEvaluation {
    /// Coefficients of `Phi`, `2 H + 1`.
    pub value: Vec<f64>,
    /// Derivative by the coefficients of the own force, row by row; `None` is zero.
    pub by_force: Option<Vec<f64>>,
    /// Derivative by the coefficients of the relative motion, row by row.
    pub by_motion: Vec<f64>,
}

/// Adds `T_v Omega`: a slope by the velocity seen as one by the displacement coefficients.
pub(crate) fn add_velocity_columns(by_motion: &mut [f64], by_velocity: &[f64], omega: f64, fourier: &Fourier) {
    let width = fourier.width();
    for row in fourier.rows() {
        for h in fourier.partners(row.div_ceil(2)) {
            let w = h as f64 * omega;
            by_motion[row * width + 2 * h - 1] -= w * by_velocity[row * width + 2 * h];
            by_motion[row * width + 2 * h] += w * by_velocity[row * width + 2 * h - 1];
        }
    }
}

/// Coefficients with another number of harmonics: cut, or filled with zeros.
pub(crate) fn resized(coefficients: &[f64], harmonics: usize) -> Vec<f64> {
    let mut result = vec![0.0; 2 * harmonics + 1];
    for h in 0..=harmonics {
        add_amplitude(&mut result, h, amplitude(coefficients, h));
    }
    result
}

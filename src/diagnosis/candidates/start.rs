//! Where a periodic response is searched from: the motion that was measured. Nonlinear laws may answer one force in more
//! than one way; the branch that the data show is the one next to the measured motion.

use crate::effects::{Leg, Sampling, Source};
use crate::response::harmonic_balance::{Response, add_amplitude};
use faer::{Mat, c64};
use std::sync::Arc;

/// Samples a period.
const SAMPLES: usize = 256;

/// Displacement amplitudes (m) of all DOFs in every run: n rows, column `h - 1` is harmonic `h`.
pub(crate) type Fields = Vec<Mat<c64>>;

/// A set of effects with its score before it is fitted on the response.
#[derive(Debug, Clone)]
pub(crate) struct UnfittedSet {
    pub effects: Vec<Source>,
    pub score: f64,
    /// Motion that the data show if the effects are right.
    pub(crate) fields: Arc<Fields>,
}

/// A start for a model of `sources` at circular frequency `omega` (rad/s): the forces of their laws on the motion
/// `field`; none where no law needs a start.
pub(crate) fn start(sources: &[Source], omega: f64, field: &Mat<c64>) -> Option<Response> {
    let sampling = Sampling::new(SAMPLES);
    let mut unknowns: Vec<f64> = Vec::new();
    for source in sources.iter().filter(|s| !s.effect.is_linear()) {
        let Some(law) = source.effect.law() else { continue };
        for leg in source.place.legs() {
            let motion = sampling.motion(omega, 0.0, &relative(field, leg));
            let mut force = vec![0.0; motion.len()];
            law.force(&source.parameters, &motion, &mut force);
            let mut harmonics = vec![c64::new(0.0, 0.0); field.ncols()];
            let mean = sampling.analyse(&force, &mut harmonics);
            let mut coefficients = vec![0.0; 2 * field.ncols() + 1];
            add_amplitude(&mut coefficients, 0, c64::new(mean, 0.0));
            harmonics.iter().enumerate().for_each(|(i, f)| add_amplitude(&mut coefficients, i + 1, *f));
            unknowns.extend(coefficients);
        }
    }
    let usable = !unknowns.is_empty() && unknowns.iter().all(|u: &f64| u.is_finite());
    usable.then(|| Response::near(omega, field.clone(), unknowns))
}

/// Relative displacement of a leg, one value a harmonic.
pub(crate) fn relative(field: &Mat<c64>, leg: Leg) -> Vec<c64> {
    (0..field.ncols()).map(|h| leg.relative(|i| field[(i, h)])).collect()
}

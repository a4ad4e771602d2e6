//! One run at one number of harmonics: the condensed system, its tables, and the way from unknowns to displacements.

use super::condense::Condensed;
use super::error::ResponseError;
use super::excitation::Excitation;
use super::fourier::Fourier;
use super::model::RunModel;
use super::newton::Balance;
use super::nonlinear_leg::{NonlinearLeg, resized};
use super::outcome::Response;
use crate::effects::Source;
use faer::c64;
use std::sync::Arc;

/// Samples of a period for a number of harmonics: kinks of friction and gaps alias as `1 / N^2`.
pub(crate) fn samples_for(condensed: &Condensed) -> usize {
    let sharp = condensed.legs.iter().any(NonlinearLeg::takes_force);
    let factor = if sharp { 32 } else { 16 };
    (factor * (condensed.harmonics + 1)).next_power_of_two().max(128)
}

/// Condensed system and tables of one run at a number of harmonics.
pub(crate) struct Prepared {
    pub condensed: Condensed,
    pub fourier: Arc<Fourier>,
}

impl Prepared {
    pub(crate) fn new(
        run: &RunModel,
        sources: &[Source],
        excitation: &Excitation,
        harmonics: usize,
    ) -> Result<Self, ResponseError> {
        let condensed = Condensed::new(|h| run.compliance(h), sources, excitation, harmonics)?;
        let fourier = run.table(harmonics, samples_for(&condensed));
        Ok(Self { condensed, fourier })
    }

    pub(crate) fn balance(&self) -> Balance<'_> {
        Balance { condensed: &self.condensed, fourier: &self.fourier }
    }

    /// Displacements of all DOFs per harmonic, 0 first, under the kept forces `u`.
    pub(crate) fn displacements(&self, run: &RunModel, excitation: &Excitation, u: &[f64]) -> Vec<Vec<c64>> {
        let of_harmonic = |h: usize| self.condensed.displacements(run.compliance(h), h, run.len(), excitation, u);
        (0..=self.condensed.harmonics).map(of_harmonic).collect()
    }

    /// The unknowns of a response nearby: leg forces cut or filled with zeros, those of what is at resonance from its motion.
    pub(crate) fn adapt(&self, run: &RunModel, start: &Response) -> Vec<f64> {
        let condensed = &self.condensed;
        let mut u = vec![0.0; condensed.size()];
        let (given, width) = (2 * start.order() + 1, condensed.width());
        let common = start.legs.min(condensed.legs.len());
        for (target, part) in u.chunks_exact_mut(width).zip(start.unknowns.chunks_exact(given)).take(common) {
            target.copy_from_slice(&resized(part, condensed.harmonics));
        }
        let amplitudes = start.raw.as_ref().unwrap_or(&start.harmonics);
        for h in 1..=condensed.harmonics.min(start.order()) {
            let (x, stiffness) = (amplitudes.col_as_slice(h - 1), &condensed.systems[h].resonant);
            let modes = run.compliance(h).resonant.iter().map(|mode| mode.motion(x));
            let legs = condensed.kept_linear(h).map(|(_, leg)| leg.relative(|i| x[i]));
            for (r, (motion, z)) in modes.chain(legs).zip(stiffness).enumerate() {
                condensed.add(&mut u, h, condensed.legs.len() + r, *z * motion);
            }
        }
        u
    }
}

//! What could be explained at most: how little free forces leave, whatever their law.

use crate::diagnosis::localisation::free_force::Placing;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::reference_model::ReferenceModel;

/// Least squared residual that free forces leave.
pub(crate) struct Reach {
    pub single: f64,
    pub pair: f64,
}

impl ReferenceModel<'_> {
    /// How little free forces at one place, or at two, leave of the squared residual.
    pub(crate) fn reach(&self) -> Result<Reach, DiagnosisError> {
        let view = self.view(None)?;
        let least = |placings: Vec<Placing>| placings.first().map_or(f64::INFINITY, |p| p.chi_square);
        Ok(Reach { single: least(view.screen.singles()), pair: least(view.screen.pairs(1)) })
    }
}

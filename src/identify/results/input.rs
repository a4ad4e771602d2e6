//! What the results of an identification are computed from.

use crate::balance::{Expanded, Measured};
use crate::effects::Source;
use crate::structure::Structure;
use faer::Mat;

/// What the results are computed from.
pub(crate) struct ResultsInput<'a> {
    pub structure: &'a Structure,
    pub runs: &'a [(Measured, Expanded)],
    /// Known and accepted sources at their values.
    pub acting: &'a [Source],
    /// Accepted columns at unit coefficient.
    pub columns: Vec<Source>,
    /// Covariance of the coefficients of `columns`.
    pub covariance: &'a Mat<f64>,
}

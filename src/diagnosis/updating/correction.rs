//! What a model states wrongly, as it is told and taken over.

use super::parameters::{Updating, UpdatingParameter};

/// A correction of what the model states.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    /// What is corrected.
    pub parameter: UpdatingParameter,
    /// Factor on it.
    pub factor: f64,
    /// Standard deviation of the factor.
    pub deviation: f64,
}

/// The `updating` parameters at the factors of `corrections`, those without one at nothing.
pub(crate) fn with_corrections(mut updating: Updating, corrections: &[Correction]) -> Updating {
    for (parameter, value) in updating.parameters.iter().zip(&mut updating.values) {
        let stated = corrections.iter().find(|c| c.parameter == *parameter);
        *value = stated.map_or(0.0, |c| c.factor.ln());
    }
    updating
}

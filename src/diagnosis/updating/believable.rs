//! Corrections that no model needs: what is found beside them is not known to be what is missing.

use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::diagnosis::updating::scales::Scales;
use crate::structure::Part;

/// Largest logarithms of corrections that are believed, three of the widest prior deviations: of the size of a known source or the
/// damping of a mode (a factor of 4.5), and of a stiffness or mass (1.2).
const BELIEVED_SIZE: f64 = 3.0 * Scales::GREATEST.known;
const BELIEVED: f64 = 3.0 * Scales::GREATEST.model;

impl Updating {
    /// Whether no parameter is beyond all that models are wrong by.
    pub(crate) fn is_believable(&self) -> bool {
        self.parameters.iter().zip(&self.values).all(|(parameter, v)| match parameter {
            UpdatingParameter::Known(_) | UpdatingParameter::Structure(Part::ModeDamping(_)) => v.abs() < BELIEVED_SIZE,
            // A clamp may be as soft as it likes.
            UpdatingParameter::Structure(Part::Support(_)) => true,
            UpdatingParameter::Structure(_) => v.abs() < BELIEVED,
            _ => true,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::HeldDof;

    #[test]
    fn corrections_beyond_three_prior_deviations_are_not_believed() {
        let believed = |part: Part, factor: f64| {
            let parameters = vec![UpdatingParameter::Structure(Part::Mass), UpdatingParameter::Structure(part)];
            Updating { parameters, values: vec![0.05, factor.ln()], ..Updating::default() }.is_believable()
        };
        assert!(believed(Part::ModeDamping(0), 2.7) && believed(Part::ModeDamping(0), 0.3));
        assert!(!believed(Part::ModeDamping(0), 17.3) && !believed(Part::ModeDamping(0), 0.1));
        assert!(believed(Part::Stiffness, 1.1) && !believed(Part::Stiffness, 1.3));
        assert!(believed(Part::Support(HeldDof { element: 0, dof: 1 }), 0.05));
    }
}

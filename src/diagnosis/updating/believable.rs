//! Corrections that no model needs: what is found beside them is not known to be what is missing.

use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::diagnosis::updating::scales::Scales;
use crate::structure::Part;

/// Largest logarithm of a correction that is believed, of the size of a known source or the damping of a mode: three of the widest
/// prior deviations, a factor of 4.5.
const BELIEVED: f64 = 3.0 * Scales::GREATEST.known;

impl Updating {
    /// Whether no parameter of damping is beyond all that models are wrong by.
    pub(crate) fn is_believable(&self) -> bool {
        self.parameters.iter().zip(&self.values).all(|(parameter, v)| match parameter {
            UpdatingParameter::Known(_) | UpdatingParameter::Structure(Part::ModeDamping(_)) => v.abs() < BELIEVED,
            // A clamp may be as soft as it likes, and an effect is found as well beside a part that is 30 % off.
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
        assert!(believed(Part::Stiffness, 1.3));
        assert!(believed(Part::Support(HeldDof { element: 0, dof: 1 }), 0.05));
    }
}

//! Corrections that no model needs: what is found beside them is not known to be what is missing.

use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::diagnosis::updating::scales::Scales;
use crate::structure::Part;

/// Largest logarithm of a correction that is plausible, of the size of a known source or the damping of a mode: three of the widest
/// prior deviations, a factor of 4.5.
const PLAUSIBLE: f64 = 3.0 * Scales::GREATEST.known;

impl Updating {
    /// Whether no parameter of damping is beyond all that models are wrong by.
    pub(crate) fn is_plausible(&self) -> bool {
        let in_band =
            |mode: usize| self.parameters.contains(&UpdatingParameter::Structure(Part::ModeDampingPerOctave(mode)));
        self.parameters.iter().zip(&self.values).all(|(parameter, v)| match parameter {
            // Of a mode that higher harmonics alone show its resonance may be told wrongly, by which little of the response hangs.
            UpdatingParameter::Structure(Part::ModeDamping(mode)) => v.abs() < PLAUSIBLE || !in_band(*mode),
            UpdatingParameter::Structure(Part::ModeDampingPerOctave(_)) => v.abs() < PLAUSIBLE,
            // Less of a known source may be what an effect takes over that was stated by it at small amplitudes.
            UpdatingParameter::Known(_) => *v < PLAUSIBLE,
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
    fn corrections_beyond_three_prior_deviations_are_not_plausible() {
        let is_plausible = |parameter: UpdatingParameter, factor: f64| {
            let octave = UpdatingParameter::Structure(Part::ModeDampingPerOctave(0));
            let parameters = vec![octave, UpdatingParameter::Structure(Part::Mass), parameter];
            Updating { parameters, values: vec![0.0, 0.05, factor.ln()], ..Updating::default() }.is_plausible()
        };
        let plausible = |part: Part, factor: f64| is_plausible(UpdatingParameter::Structure(part), factor);
        assert!(is_plausible(UpdatingParameter::Known(0), 0.19) && !is_plausible(UpdatingParameter::Known(0), 5.0));
        assert!(plausible(Part::ModeDamping(0), 2.7) && plausible(Part::ModeDamping(0), 0.3));
        assert!(!plausible(Part::ModeDamping(0), 17.3) && !plausible(Part::ModeDamping(0), 0.1));
        assert!(plausible(Part::ModeDamping(1), 17.3));
        assert!(plausible(Part::Stiffness, 1.3));
        assert!(plausible(Part::Support(HeldDof { element: 0, dof: 1 }), 0.05));
    }
}

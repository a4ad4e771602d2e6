//! Steps of the updating parameters towards a linear fit, no longer than its derivatives hold.

use super::parameters::{Updating, UpdatingParameter};
use crate::structure::Part;

/// Largest change of a logarithm in one step: of a stiffness or mass, and of a support or the size of a known source, which are
/// known less well and move the response less.
const LONGEST: f64 = 0.05;
const LONGEST_OF_SIZE: f64 = 0.2;

impl Updating {
    /// These values moved to `target`, none by more than the longest step; what is not of the model returns to nothing.
    pub(crate) fn towards(&self, target: &[f64]) -> Self {
        let moved = |(k, (from, to)): (usize, (&f64, &f64))| {
            let longest = match &self.parameters[k] {
                parameter if !parameter.is_of_model() => return 0.0,
                UpdatingParameter::Known(_)
                | UpdatingParameter::Structure(
                    Part::Support(_) | Part::ModeDamping(_) | Part::ModeDampingPerOctave(_),
                ) => LONGEST_OF_SIZE,
                _ => LONGEST,
            };
            from + (to - from).clamp(-longest, longest)
        };
        let values = self.values.iter().zip(target).enumerate().map(moved).collect();
        Self { values, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::HeldDof;

    #[test]
    fn a_step_is_as_long_as_what_it_changes_allows() {
        let parameters = vec![
            UpdatingParameter::Structure(Part::Stiffness),
            UpdatingParameter::Structure(Part::Support(HeldDof { element: 0, dof: 1 })),
            UpdatingParameter::Known(0),
            UpdatingParameter::Gain("acc@1".into()),
        ];
        let updating = Updating { parameters, values: vec![0.01, 0.0, 0.1, 0.02], ..Updating::default() };
        let moved = updating.towards(&[1.0, -1.0, 0.15, 0.5]).values;
        let expected = [0.06, -0.2, 0.15, 0.0];
        assert!(moved.iter().zip(expected).all(|(m, e)| (m - e).abs() < 1e-15), "{moved:?}");
    }
}

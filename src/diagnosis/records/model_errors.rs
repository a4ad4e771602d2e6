//! Masses and springs of a set that are errors of the model and no missing effect: one of them stands for the many that a model
//! states a little wrongly. Where it corrects a part of the structure it is told as that, else not at all.

use super::fitted::FittedRecords;
use super::part_directions::PART;
use super::search::factors_of;
use super::suggestions::added;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::diagnosis::updating::part_error::{part_of, size_of};
use crate::effects::{Constant, Place, Source};
use crate::math::statistics::root_mean_square;
use crate::structure::{Part, Structure};

/// Relative size of an added spring or mass up to which it may stand for errors of many: some times that of the shapes, within limits;
/// of a spring where there is none a share of that, relative to all that hold its DOF.
const ERRORS: f64 = 6.0;
const TOGETHER: [f64; 2] = [0.03, 0.25];
const SLIGHT: f64 = 0.2;
/// The same where every spring and mass is corrected by itself, five times what one may plausibly be off: there it stands for no other.
const OF_PART: f64 = 5.0 * PART;

/// Masses and springs that are errors of the model.
pub(super) struct ModelErrors {
    /// As they were found.
    pub sources: Vec<Source>,
    /// What they correct of a part, where they do.
    pub corrections: Vec<Correction>,
}

impl ModelErrors {
    /// Of the effects of a fit.
    pub(super) fn of(structure: &Structure, fit: &FittedRecords) -> Self {
        let mut errors = Self { sources: Vec::new(), corrections: Vec::new() };
        let shapes: Vec<f64> = fit.shapes.iter().flatten().copied().collect();
        let mut together = (ERRORS * root_mean_square(&shapes)).clamp(TOGETHER[0], TOGETHER[1]);
        if !fit.parts.is_empty() && structure.elements().is_empty() {
            together = together.min(OF_PART);
        }
        for added in added(fit) {
            let all = if added.source.effect.adds_to(Constant::Mass) { fit.mass } else { fit.stiffness };
            let deviation = added.deviations.first().copied();
            let correction = correction(structure, &added.source, deviation, all.exp());
            let correction = correction.filter(|c| c.factor < 1.0 + together);
            if correction.is_some() || is_slight(structure, &added.source, together) {
                errors.sources.push(added.source);
                errors.corrections.extend(correction);
            }
        }
        errors
    }

    /// Whether an effect is one of them.
    pub(super) fn holds(&self, source: &Source) -> bool {
        self.sources.iter().any(|s| s.is_same(source))
    }

    /// Factors on the parts of the structure.
    pub(super) fn factors(&self) -> Vec<(Part, f64)> {
        factors_of(&self.corrections)
    }
}

/// What a spring or mass changes of the one that is there, of which `all` is the factor on all stiffness or mass.
fn correction(structure: &Structure, source: &Source, deviation: Option<f64>, all: f64) -> Option<Correction> {
    // The entries of the stiffness matrix of a beam are no springs.
    let part = part_of(source).filter(|_| source.effect.adds_to(Constant::Mass) || structure.elements().is_empty())?;
    let own = all * size_of(structure, part);
    let change = source.parameters[0] / own;
    let deviation = deviation? / own;
    let parameter = UpdatingParameter::Structure(part);
    (own > 0.0 && change > -1.0).then_some(Correction { parameter, factor: 1.0 + change, deviation })
}

/// Whether an effect is a mass or spring that takes away, or is less than the share `together` of what is there.
fn is_slight(structure: &Structure, source: &Source, together: f64) -> bool {
    let (matrix, share) = match (source.effect.constant(), structure.matrices()) {
        (Some(Constant::Mass), Some(matrices)) => (&matrices.mass, together),
        (Some(Constant::Stiffness), Some(matrices)) => (&matrices.stiffness, SLIGHT * together),
        _ => return false,
    };
    let Place::Dofs(dofs) = &source.place else { return false };
    let own = dofs.iter().map(|&dof| matrix[(dof, dof)]).fold(f64::INFINITY, f64::min);
    source.parameters[0] < share * own
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::Effect;
    use crate::structure::chain::ChainParameters;

    /// A chain of two masses with springs of 500 N/m to the ground and 1000 N/m between them.
    fn judged(effect: Effect, dofs: &[usize], value: f64) -> (bool, Option<f64>) {
        let (masses, ground_stiffness) = (vec![1.0, 2.0], vec![500.0, 0.0]);
        let chain = ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1000.0] }.build(&[]).unwrap();
        let source = Source::known(effect, Place::Dofs(dofs.to_vec()), &[value]);
        let factor = correction(&chain, &source, Some(1.0), 1.0).map(|c| c.factor).filter(|f| *f < 1.25);
        (factor.is_some() || is_slight(&chain, &source, 0.25), factor)
    }

    #[test]
    fn small_masses_and_springs_are_errors_of_the_model() {
        assert_eq!(judged(Effect::Stiffness, &[0, 1], -100.0), (true, Some(0.9)));
        assert_eq!(judged(Effect::Stiffness, &[0, 1], 400.0), (false, None));
        assert_eq!(judged(Effect::Mass, &[1], 0.4), (true, Some(1.2)));
        assert_eq!(judged(Effect::Mass, &[1], 1.0), (false, None));
        // Between two DOFs there is no mass that it could correct.
        assert_eq!(judged(Effect::Mass, &[0, 1], 0.1), (true, None));
        assert_eq!(judged(Effect::Mass, &[0, 1], 0.6), (false, None));
        // Where there is no spring, one that is small beside those that hold the DOF.
        assert_eq!(judged(Effect::Stiffness, &[1], 30.0), (true, None));
        assert_eq!(judged(Effect::Stiffness, &[1], 300.0), (false, None));
        assert_eq!(judged(Effect::Viscous, &[0], 1e-3), (false, None));
    }
}

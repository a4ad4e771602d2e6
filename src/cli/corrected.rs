//! Corrections of what the model states, as JSON and in words.

use super::source_json;
use super::table::{number, with_deviation};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::display::findings;
use crate::effects::Place;
use crate::exchange::Project;
use crate::session::validation::problem;
use crate::structure::{HeldDof, Part, Structure};
use serde_json::{Map, Value, json};

/// Change below which a correction is not worth a line.
const LITTLE: f64 = 1e-3;

/// A correction of what the model states: `what`, its place or mode, and the factor on it.
pub(super) fn correction(project: &Project, correction: &Correction) -> Value {
    let mut map = Map::new();
    let dofs = |dofs: &[usize]| json!(Place::Dofs(dofs.to_vec()).written(&project.structure).dofs);
    let elements = |range: &[usize; 2]| json!(range.map(|element| element + 1));
    let (what, key, place) = match &correction.parameter {
        UpdatingParameter::Structure(part) => match part {
            Part::Stiffness => ("stiffness", "", Value::Null),
            Part::Mass => ("mass", "", Value::Null),
            Part::Mode(mode) => ("mode", "mode", json!(mode + 1)),
            Part::ModeCoupling(pair) => ("mode_coupling", "modes", json!(pair.map(|mode| mode + 1))),
            Part::ModeDamping(mode) => ("mode_damping", "mode", json!(mode + 1)),
            Part::ModeDampingPerOctave(mode) => ("mode_damping_per_octave", "mode", json!(mode + 1)),
            Part::GroundSpring(dof) => ("spring", "dofs", dofs(&[*dof])),
            Part::Coupling(pair) => ("spring", "dofs", dofs(pair)),
            Part::PointMass(dof) => ("point_mass", "dofs", dofs(&[*dof])),
            Part::ElementStiffness(range) => ("element_stiffness", "elements", elements(range)),
            Part::ElementMass(range) => ("element_mass", "elements", elements(range)),
            Part::Support(held) => {
                if let Some(k) = project.structure.stiffness_at(*held).filter(|_| correction.factor < 1.0) {
                    map.insert("spring".into(), json!(k * correction.factor / (1.0 - correction.factor)));
                }
                ("support", "node", json!(project.structure.held_node(*held)))
            }
        },
        UpdatingParameter::Known(index) => {
            if let Some(source) = problem(project).known().get(*index) {
                map.extend(source_json::of_effect(source, &project.structure));
            }
            ("source", "", Value::Null)
        }
        UpdatingParameter::Gain(channel) | UpdatingParameter::ForceGain(channel) => ("gain", "channel", json!(channel)),
        UpdatingParameter::Delay(channel) => ("delay", "channel", json!(channel)),
        UpdatingParameter::Session(session) => ("session", "session", json!(session + 1)),
    };
    map.insert("what".into(), json!(what));
    if !key.is_empty() {
        map.insert(key.into(), place);
    }
    map.insert("factor".into(), json!(correction.factor));
    map.insert("standard_deviation".into(), json!(correction.deviation));
    Value::Object(map)
}

/// A correction in words.
pub(super) fn corrected(project: &Project, correction: &Correction) -> String {
    let what = findings::corrected(&project.structure, &problem(project).known(), &correction.parameter);
    let spring = match correction.parameter {
        UpdatingParameter::Structure(Part::Support(held)) => spring_of(&project.structure, held, correction.factor),
        _ => None,
    };
    let spring = spring.unwrap_or_default();
    format!("  {what}{spring}: times {}", with_deviation(correction.factor, correction.deviation))
}

/// Whether a correction is more than its deviation and [`LITTLE`], or no number.
pub(super) fn is_telling(correction: &Correction) -> bool {
    let change = (correction.factor - 1.0).abs();
    let is_little = change <= LITTLE || change <= correction.deviation;
    !is_little
}

/// Corrections in words, a line each: those that are more than their deviation and [`LITTLE`]; the others are counted in one line.
pub(super) fn listed(project: &Project, corrections: &[Correction]) -> String {
    let counts = |c: &&Correction| is_telling(c);
    let mut lines: String = corrections.iter().filter(counts).map(|c| corrected(project, c) + "\n").collect();
    let others = corrections.iter().filter(|c| !counts(c)).count();
    if others > 0 {
        let more = if lines.is_empty() { "" } else { " more" };
        let are = if others == 1 { "correction is" } else { "corrections are" };
        lines.push_str(&format!("  {others}{more} {are} within the deviation, or within 0.1 %, of what is stated\n"));
    }
    lines
}

/// The spring that a support is which gives way.
fn spring_of(structure: &Structure, held: HeldDof, factor: f64) -> Option<String> {
    let unit = if held.dof % 2 == 1 { "N m/rad" } else { "N/m" };
    let stiffness = structure.stiffness_at(held).filter(|_| factor < 1.0)?;
    Some(format!(" (a spring of {} {unit})", number(stiffness * factor / (1.0 - factor))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_correction_within_its_deviation_or_a_thousandth_is_not_told() {
        let told = |factor: f64, deviation: f64| {
            is_telling(&Correction { parameter: UpdatingParameter::Structure(Part::Mass), factor, deviation })
        };
        assert!(told(1.02, 0.01) && told(0.9, 0.05) && told(1.0011, 0.0));
        assert!(!told(1.02, 0.03) && !told(1.0, 0.02) && !told(1.0009, 1e-6));
        // What is no number is shown, not counted among what is little.
        assert!(told(f64::NAN, 0.1));
    }
}

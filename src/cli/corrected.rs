//! Corrections of what the model states, as JSON and in words.

use super::source_words::{labels, named, title};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::Place;
use crate::exchange::Project;
use crate::session::validation::problem;
use crate::structure::{HeldDof, Part, Structure};
use serde_json::{Map, Value, json};

/// A correction of what the model states: `what`, its place or mode, and the factor on it.
pub(super) fn correction(project: &Project, correction: &Correction) -> Value {
    let mut map = Map::new();
    let dofs = |dofs: &[usize]| json!(labels(&project.structure, &Place::Dofs(dofs.to_vec())));
    let elements = |range: &[usize; 2]| json!(range.map(|element| element + 1));
    let (what, key, place) = match &correction.parameter {
        UpdatingParameter::Structure(part) => match part {
            Part::Stiffness => ("stiffness", "", Value::Null),
            Part::Mass => ("mass", "", Value::Null),
            Part::Mode(mode) => ("mode", "mode", json!(mode + 1)),
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
                map.extend(named(&project.structure, source));
            }
            ("source", "", Value::Null)
        }
        UpdatingParameter::Gain(channel) => ("gain", "channel", json!(channel)),
        UpdatingParameter::Delay(channel) => ("delay", "channel", json!(channel)),
        UpdatingParameter::Shape { mode, channel } => {
            map.insert("channel".into(), json!(channel));
            ("shape", "mode", json!(mode + 1))
        }
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
    let structure = &project.structure;
    let what = match &correction.parameter {
        UpdatingParameter::Structure(part) => part_in_words(structure, *part, correction.factor),
        UpdatingParameter::Known(index) => {
            problem(project).known().get(*index).map_or_else(String::new, |s| title(structure, s))
        }
        UpdatingParameter::Gain(channel) => format!("gain of {channel}"),
        UpdatingParameter::Delay(channel) => format!("delay of {channel}"),
        UpdatingParameter::Shape { mode, channel } => format!("shape of mode {} at {channel}", mode + 1),
        UpdatingParameter::Session(session) => format!("stiffness of session {}", session + 1),
    };
    format!("  {what}: times {:.4} +- {:.4}", correction.factor, correction.deviation)
}

/// A part of the model in words; `factor` is that on it.
fn part_in_words(structure: &Structure, part: Part, factor: f64) -> String {
    let place = |dofs: &[usize]| labels(structure, &Place::Dofs(dofs.to_vec())).join(" - ");
    let elements = |[first, last]: [usize; 2]| {
        if first == last { format!("element {}", first + 1) } else { format!("elements {} to {}", first + 1, last + 1) }
    };
    match part {
        Part::Stiffness => "all stiffness".to_owned(),
        Part::Mass => "all mass".to_owned(),
        Part::Mode(mode) => format!("stiffness of mode {}", mode + 1),
        Part::GroundSpring(dof) => format!("spring at {}", place(&[dof])),
        Part::Coupling(pair) => format!("spring at {}", place(&pair)),
        Part::PointMass(dof) => format!("mass at {}", place(&[dof])),
        Part::ElementStiffness(range) => format!("stiffness of {}", elements(range)),
        Part::ElementMass(range) => format!("mass of {}", elements(range)),
        Part::Support(held) => support(structure, held, factor),
    }
}

/// A support in words, with the spring that it is.
fn support(structure: &Structure, held: HeldDof, factor: f64) -> String {
    let node = structure.held_node(held).unwrap_or_default();
    let unit = if held.dof % 2 == 1 { "N m/rad" } else { "N/m" };
    match structure.stiffness_at(held).filter(|_| factor < 1.0) {
        Some(k) => format!("support at node {node} (a spring of {:.3e} {unit})", k * factor / (1.0 - factor)),
        None => format!("support at node {node}"),
    }
}

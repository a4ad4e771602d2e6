//! Sources and corrections of a model in words and in JSON.

use crate::diagnosis::diagnose::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Place, Source};
use crate::exchange::Project;
use crate::session::validation::problem;
use crate::structure::{Part, Structure};
use serde_json::{Map, Value, json};

/// Labels of the DOFs of a place; none for the whole structure and channels.
pub(super) fn labels(structure: &Structure, place: &Place) -> Vec<String> {
    match place {
        Place::Dofs(dofs) => dofs.iter().map(|&dof| structure.label(dof).to_owned()).collect(),
        Place::Whole(_) | Place::Channel(_) => Vec::new(),
    }
}

/// Effect and place: `dofs`, or `channel` for an error of one.
pub(super) fn named(structure: &Structure, source: &Source) -> Map<String, Value> {
    let mut map = Map::new();
    map.insert("effect".into(), json!(source.effect.name()));
    match &source.place {
        Place::Channel(channel) => map.insert("channel".into(), json!(channel)),
        place => map.insert("dofs".into(), json!(labels(structure, place))),
    };
    map
}

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
        },
        UpdatingParameter::Known(index) => {
            if let Some(source) = problem(project).known().get(*index) {
                map.extend(named(&project.structure, source));
            }
            ("source", "", Value::Null)
        }
        UpdatingParameter::Gain(channel) => ("gain", "channel", json!(channel)),
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
    let structure = &project.structure;
    let what = match &correction.parameter {
        UpdatingParameter::Structure(part) => part_in_words(structure, *part),
        UpdatingParameter::Known(index) => {
            problem(project).known().get(*index).map_or_else(String::new, |s| title(structure, s))
        }
        UpdatingParameter::Gain(channel) => format!("gain of {channel}"),
        UpdatingParameter::Delay(channel) => format!("delay of {channel}"),
        UpdatingParameter::Session(session) => format!("stiffness of session {}", session + 1),
    };
    format!("  {what}: times {:.4} +- {:.4}", correction.factor, correction.deviation)
}

fn part_in_words(structure: &Structure, part: Part) -> String {
    let at = |dofs: &[usize]| labels(structure, &Place::Dofs(dofs.to_vec())).join(" - ");
    let elements = |[first, last]: [usize; 2]| {
        if first == last { format!("element {}", first + 1) } else { format!("elements {} to {}", first + 1, last + 1) }
    };
    match part {
        Part::Stiffness => "all stiffness".to_owned(),
        Part::Mass => "all mass".to_owned(),
        Part::Mode(mode) => format!("stiffness of mode {}", mode + 1),
        Part::GroundSpring(dof) => format!("spring at {}", at(&[dof])),
        Part::Coupling(pair) => format!("spring at {}", at(&pair)),
        Part::PointMass(dof) => format!("mass at {}", at(&[dof])),
        Part::ElementStiffness(range) => format!("stiffness of {}", elements(range)),
        Part::ElementMass(range) => format!("mass of {}", elements(range)),
    }
}

/// Effect and place in words.
pub(super) fn title(structure: &Structure, source: &Source) -> String {
    let place = match &source.place {
        Place::Channel(channel) => format!("of {channel}"),
        Place::Whole(_) => "of the whole structure".to_owned(),
        place @ Place::Dofs(_) => format!("at {}", labels(structure, place).join(" - ")),
    };
    format!("{} {place}", source.effect.title())
}

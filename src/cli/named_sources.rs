//! Effects at their places in the JSON of diagnoses.

use crate::diagnosis::result::Added;
use crate::effects::{Place, Source};
use crate::structure::Structure;
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

pub(super) fn with_values(structure: &Structure, added: &Added) -> Map<String, Value> {
    let mut map = named(structure, &added.source);
    let by_name = |values: &[f64]| -> Value {
        let list = added.source.effect.parameters().iter().zip(values);
        // JSON knows no infinity: a parameter that the data do not fix has no deviation.
        Value::Object(list.map(|(p, v)| (p.name.to_owned(), json!(v.is_finite().then_some(*v)))).collect())
    };
    map.insert("parameters".into(), by_name(&added.source.parameters));
    map.insert("standard_deviation".into(), by_name(&added.deviations));
    map
}

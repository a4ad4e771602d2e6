//! Sources in JSON, in the words of the project file.

use crate::diagnosis::result::Added;
use crate::effects::{Effect, Source, WrittenPlace};
use crate::identify::Estimate;
use crate::structure::Structure;
use serde_json::{Map, Value, json};

/// `{"law": ..., "dofs": [...]}`, with `channel` in place of `dofs` for effects of the measuring chain.
pub(super) fn of_law(source: &Source, structure: &Structure) -> Map<String, Value> {
    named("law", source, structure)
}

/// `{"effect": ..., "dofs": [...]}`: the same with the key of diagnoses.
pub(super) fn of_effect(source: &Source, structure: &Structure) -> Map<String, Value> {
    named("effect", source, structure)
}

fn named(key: &str, source: &Source, structure: &Structure) -> Map<String, Value> {
    let WrittenPlace { dofs, elements, channel } = source.place.written(structure);
    let mut map = Map::from_iter([(key.to_owned(), json!(source.effect.name()))]);
    match channel {
        Some(channel) => map.insert("channel".into(), json!(channel)),
        None => map.insert("dofs".into(), json!(dofs)),
    };
    map.extend(elements.map(|range| ("elements".to_owned(), json!(range))));
    map
}

/// An effect of a diagnosis with its values and their deviations.
pub(super) fn added(added: &Added, structure: &Structure) -> Map<String, Value> {
    let mut map = of_effect(&added.source, structure);
    // JSON knows no infinity: a parameter that the data do not fix has no deviation.
    let finite = |values: &[f64]| by_name(added.source.effect, values.iter().map(|v| v.is_finite().then_some(*v)));
    map.insert("parameters".into(), finite(&added.source.parameters));
    map.insert("standard_deviation".into(), finite(&added.deviations));
    map
}

/// The source with its values, deviations and share of the energy.
pub(super) fn estimate(estimate: &Estimate, sources: &[Source], structure: &Structure) -> Value {
    let source = sources[estimate.source].with_coefficient(estimate.coefficient);
    let mut map = of_law(&source, structure);
    map.insert("parameters".into(), parameters(&source));
    let mut deviations = Map::new();
    if let Some(k) = source.effect.coefficient() {
        deviations.insert(source.effect.parameters()[k].name.to_owned(), json!(estimate.deviation));
    }
    map.insert("standard_deviation".into(), Value::Object(deviations));
    map.insert("energy_percent".into(), json!(estimate.energy_percent));
    map.insert("state".into(), json!(source.state));
    Value::Object(map)
}

/// The parameters of a source by name.
pub(super) fn parameters(source: &Source) -> Value {
    by_name(source.effect, source.parameters.iter().map(|v| Some(*v)))
}

fn by_name(effect: Effect, values: impl Iterator<Item = Option<f64>>) -> Value {
    Value::Object(effect.parameters().iter().zip(values).map(|(p, v)| (p.name.to_owned(), json!(v))).collect())
}

//! A source in JSON, in the words of the project file.

use crate::effects::{Place, Source};
use crate::identify::Estimate;
use crate::structure::Structure;
use serde_json::{Map, Value, json};

/// `{"law": ..., "dofs": [...]}`, with `channel` in place of `dofs` for effects of the measuring chain.
pub(super) fn place(source: &Source, structure: &Structure) -> Map<String, Value> {
    let mut map = Map::new();
    map.insert("law".into(), json!(source.effect.name()));
    match &source.place {
        Place::Dofs(dofs) => {
            let labels: Vec<&str> = dofs.iter().map(|&dof| structure.label(dof)).collect();
            map.insert("dofs".into(), json!(labels));
        }
        Place::Whole(elements) => {
            map.insert("dofs".into(), json!([]));
            if let Some([first, last]) = elements {
                map.insert("elements".into(), json!([first + 1, last + 1]));
            }
        }
        Place::Channel(name) => {
            map.insert("channel".into(), json!(name));
        }
    }
    map
}

/// The source with its values, deviations and share of the energy.
pub(super) fn estimate(estimate: &Estimate, sources: &[Source], structure: &Structure) -> Value {
    let source = sources[estimate.source].with_coefficient(estimate.coefficient);
    let mut map = place(&source, structure);
    let parameters = source.effect.parameters();
    let values: Map<String, Value> =
        parameters.iter().zip(&source.parameters).map(|(p, v)| (p.name.to_owned(), json!(v))).collect();
    map.insert("parameters".into(), Value::Object(values));
    let mut deviations = Map::new();
    if let Some(k) = source.effect.coefficient() {
        deviations.insert(parameters[k].name.to_owned(), json!(estimate.deviation));
    }
    map.insert("standard_deviation".into(), Value::Object(deviations));
    map.insert("energy_percent".into(), json!(estimate.energy_percent));
    map.insert("state".into(), json!(source.state));
    Value::Object(map)
}

//! One JSON document: the words of `identify --json`, with every matrix.

use super::files::Export;
use super::identified::Identified;
use crate::effects::State;
use faer::Mat;
use serde_json::{Map, Value, json};
use std::path::Path;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let mut export = Export::default();
    let document = document(identified);
    export.add(path.to_owned(), format!("{document:#}\n"));
    export
}

fn document(identified: &Identified) -> Value {
    let labels: Vec<&str> = identified.structure.dofs().iter().map(|dof| dof.label.as_str()).collect();
    let mut matrix = Map::new();
    matrix.insert("dofs".into(), json!(labels));
    matrix.insert("viscous".into(), rows(identified.viscous));
    matrix.insert("equivalent".into(), rows(identified.equivalent));
    for (effect, values) in identified.others {
        matrix.insert(effect.name().into(), rows(values));
    }
    let energy: Vec<Value> = labels
        .iter()
        .zip(identified.energy_percent)
        .map(|(dof, percent)| json!({"dof": dof, "percent": percent}))
        .collect();
    let modes: Vec<Value> = identified
        .modes
        .iter()
        .enumerate()
        .map(|(i, mode)| {
            json!({"mode": i + 1, "frequency_hz": mode.frequency_hz, "damping_ratio": mode.damping_ratio,
                   "standard_deviation": mode.deviation})
        })
        .collect();
    json!({"title": identified.title, "sources": sources(identified), "matrix": matrix, "energy_percent": energy,
           "modes": modes})
}

fn rows(values: &Mat<f64>) -> Value {
    let row = |i: usize| (0..values.ncols()).map(|j| values[(i, j)]).collect::<Vec<_>>();
    json!((0..values.nrows()).map(row).collect::<Vec<_>>())
}

fn sources(identified: &Identified) -> Vec<Value> {
    identified
        .sources
        .iter()
        .map(|found| {
            let names = found.source.effect.parameters().iter().map(|p| p.name);
            let values: Map<String, Value> =
                names.clone().zip(&found.source.parameters).map(|(n, v)| (n.into(), json!(v))).collect();
            let deviations: Map<String, Value> =
                names.zip(&found.deviation).map(|(n, v)| (n.into(), json!(v))).collect();
            json!({"law": found.source.effect.name(), "dofs": found.source.place.written(identified.structure).dofs,
                   "place": found.source.place.exported(identified.structure),
                   "known": found.source.state == State::Known, "parameters": values,
                   "standard_deviation": deviations, "energy_percent": found.energy_percent})
        })
        .collect()
}

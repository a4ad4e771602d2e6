//! Comma-separated values: the viscous matrix with DOF labels, and tables of sources, energy and other laws beside it.

use super::files::{Export, beside};
use super::identified::Identified;
use crate::structure::Structure;
use faer::Mat;
use std::path::Path;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let mut export = Export::default();
    export.add(path.to_owned(), matrix(identified.viscous, identified.structure));
    export.add(beside(path, "sources"), sources(identified));
    export.add(beside(path, "energy"), energy(identified));
    export.add(beside(path, "equivalent"), matrix(identified.equivalent, identified.structure));
    for (effect, values) in identified.others {
        export.add(beside(path, effect.name()), matrix(values, identified.structure));
    }
    export
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// Header row and first column are DOF labels; numbers are the shortest that read back the same.
fn matrix(values: &Mat<f64>, structure: &Structure) -> String {
    let labels: Vec<String> = structure.dofs().iter().map(|dof| quoted(&dof.label)).collect();
    let mut text = format!("dof,{}\n", labels.join(","));
    for (i, label) in labels.iter().enumerate() {
        text.push_str(label);
        for j in 0..values.ncols() {
            text.push_str(&format!(",{}", values[(i, j)]));
        }
        text.push('\n');
    }
    text
}

fn sources(identified: &Identified) -> String {
    let mut text = String::from("law,place,state,parameter,value,standard_deviation,unit,energy_percent\n");
    for found in identified.sources {
        let place = quoted(&found.source.place.exported(identified.structure));
        let state = if found.source.state == crate::effects::State::Known { "known" } else { "identified" };
        for (k, parameter) in found.source.effect.parameters().iter().enumerate() {
            text.push_str(&format!(
                "{},{place},{state},{},{},{},{},{}\n",
                found.source.effect,
                parameter.name,
                found.source.parameters[k],
                found.deviation.get(k).copied().unwrap_or(0.0),
                parameter.unit,
                found.energy_percent
            ));
        }
    }
    text
}

fn energy(identified: &Identified) -> String {
    let mut text = String::from("dof,energy_percent\n");
    for (dof, percent) in identified.structure.dofs().iter().zip(identified.energy_percent) {
        text.push_str(&format!("{},{percent}\n", quoted(&dof.label)));
    }
    text
}

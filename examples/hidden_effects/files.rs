//! Projects as folders, so that what is judged is what a user has: files.

use super::suite::{Hidden, file};
use dashpot::effects::{Place, Source};
use dashpot::exchange::atomic::write_atomically;
use dashpot::exchange::matrices::write_tables;
use dashpot::exchange::records::write_record;
use dashpot::measurement::Record;
use dashpot::structure::Structure;
use dashpot::structure::imported::ImportedParameters;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// A project to be written.
pub(crate) struct Written {
    /// Structure of the model, which the known sources act on.
    pub model: Structure,
    /// Its table in the project file.
    pub structure_toml: String,
    /// Its matrices, where they are written beside it.
    pub matrices: Option<ImportedParameters>,
    pub known: Vec<Source>,
    /// Structure that the records were made of.
    pub recorded: Structure,
    pub records: Vec<Record>,
    pub omegas: Vec<f64>,
    /// Levels of force, where the project names them.
    pub levels: Option<Vec<i64>>,
    /// Kind of the runs; steady without it.
    pub kind: Option<&'static str>,
    /// What no analysis reads.
    pub truth: Value,
}

impl From<Hidden> for Written {
    fn from(project: Hidden) -> Self {
        let hidden: Vec<Value> = project.truth.iter().map(|s| document(s, &project.structure)).collect();
        Self {
            truth: json!({"hidden": hidden}),
            recorded: project.structure.clone(),
            model: project.structure,
            structure_toml: project.structure_toml,
            matrices: None,
            known: project.known,
            records: project.records,
            omegas: project.omegas,
            levels: None,
            kind: None,
        }
    }
}

impl Written {
    /// Writes `project.toml`, the records, matrices, and `truth.json`.
    pub(crate) fn write(&self, folder: &Path, title: &str) {
        std::fs::create_dir_all(folder).unwrap();
        let mut text = format!("[project]\nformat = 1\ntitle = \"{title}\"\n\n[structure]\n{}\n", self.structure_toml);
        self.known.iter().for_each(|source| text.push_str(&table(source, &self.model)));
        if let Some(matrices) = &self.matrices {
            // Without lines: what is coupled is to be found in the stiffness.
            write_tables(&ImportedParameters { lines: Vec::new(), ..matrices.clone() }, folder).unwrap();
            std::fs::remove_file(folder.join("lines.csv")).unwrap();
        }
        for (r, (record, omega)) in self.records.iter().zip(&self.omegas).enumerate() {
            let name = file(r);
            let _ = match self.kind {
                Some(kind) => writeln!(text, "[[run]]\nfile = \"{name}\"\nkind = \"{kind}\""),
                None => writeln!(text, "[[run]]\nfile = \"{name}\"\nfrequency = {:?}", omega / std::f64::consts::TAU),
            };
            if let Some(levels) = &self.levels {
                let _ = writeln!(text, "level = {}", levels[r]);
            }
            text.push('\n');
            write_record(&folder.join(name), record, &self.recorded, Some(7)).unwrap();
        }
        write_atomically(&folder.join("truth.json"), format!("{:#}\n", self.truth).as_bytes()).unwrap();
        write_atomically(&folder.join("project.toml"), text.as_bytes()).unwrap();
    }
}

/// A known source as its table.
fn table(source: &Source, model: &Structure) -> String {
    let mut text = format!("[[source]]\nlaw = \"{}\"\nstate = \"known\"\n", source.effect.name());
    if let Place::Dofs(dofs) = &source.place {
        let _ = writeln!(text, "dofs = {:?}", labels(model, dofs));
    }
    for (parameter, value) in source.effect.parameters().iter().zip(&source.parameters) {
        let _ = writeln!(text, "{} = {value:?}", parameter.name);
    }
    text + "\n"
}

/// An effect in the words of `diagnose --json`.
pub(crate) fn document(source: &Source, structure: &Structure) -> Value {
    let parameters = source.effect.parameters().iter().zip(&source.parameters);
    let parameters: Map<String, Value> = parameters.map(|(p, v)| (p.name.to_string(), json!(v))).collect();
    let mut map = json!({"effect": source.effect.name(), "parameters": parameters});
    match &source.place {
        Place::Channel(channel) => map["channel"] = json!(channel),
        Place::Dofs(dofs) => map["dofs"] = json!(labels(structure, dofs)),
        Place::Whole(_) => map["dofs"] = json!([]),
    }
    map
}

fn labels(structure: &Structure, dofs: &[usize]) -> Vec<String> {
    dofs.iter().map(|&dof| structure.label(dof).to_string()).collect()
}

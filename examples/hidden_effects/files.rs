//! Projects as folders, so that what is judged is what a user has: files.

use super::suite::{Hidden, file};
use dashpot::effects::{Place, Source};
use dashpot::exchange::atomic::write_atomically;
use dashpot::exchange::records::write_record;
use dashpot::structure::Structure;
use std::fmt::Write as _;
use std::path::Path;

/// Writes `project.toml`, the records, and `truth.json`, which no analysis reads.
pub fn write(folder: &Path, title: &str, project: &Hidden) {
    std::fs::create_dir_all(folder).unwrap();
    let mut text = format!("[project]\nformat = 1\ntitle = \"{title}\"\n\n[structure]\n{}\n", project.structure_toml);
    for source in &project.known {
        let _ = writeln!(text, "[[source]]\nlaw = \"{}\"\nstate = \"known\"", source.effect.name());
        if let Place::Dofs(dofs) = &source.place {
            let _ = writeln!(text, "dofs = {:?}", labels(&project.structure, dofs));
        }
        for (parameter, value) in source.effect.parameters().iter().zip(&source.parameters) {
            let _ = writeln!(text, "{} = {value:?}", parameter.name);
        }
        text.push('\n');
    }
    for (r, (record, omega)) in project.records.iter().zip(&project.omegas).enumerate() {
        let name = file(r);
        let _ = writeln!(text, "[[run]]\nfile = \"{name}\"\nfrequency = {:?}\n", omega / std::f64::consts::TAU);
        write_record(&folder.join(name), record, &project.structure, Some(7)).unwrap();
    }
    write_atomically(&folder.join("truth.json"), serde_json::to_string(&project.truth).unwrap().as_bytes()).unwrap();
    write_atomically(&folder.join("project.toml"), text.as_bytes()).unwrap();
}

fn labels(structure: &Structure, dofs: &[usize]) -> Vec<String> {
    dofs.iter().map(|&dof| structure.label(dof).to_string()).collect()
}

/// What is hidden in a folder.
pub fn truth(folder: &Path) -> Vec<Source> {
    serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap()
}

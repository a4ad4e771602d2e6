//! Modes and operating shapes among the files of an import: reference data, `[[modes]]` of the project.

use super::error::Result;
use super::request::{Imported, Request};
use super::text::named;
use crate::exchange::frf::has_shapes;
use crate::exchange::project::plan;
use dashpot_datafiles::{Kind, open};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The files with modes or operating shapes.
pub(super) fn files(request: &Request) -> Vec<PathBuf> {
    request.files.iter().filter(|file| has_shapes(file)).cloned().collect()
}

/// The request without files that hold shapes and no measurement, where others remain.
pub(super) fn without(request: &Request) -> Cow<'_, Request> {
    let measures = |file: &Path| {
        let measured = |kind: Kind| matches!(kind, Kind::Time | Kind::Frf | Kind::Spectrum);
        !has_shapes(file) || open(file).is_ok_and(|file| file.contents().sets.iter().any(|set| measured(set.kind)))
    };
    let kept: Vec<PathBuf> = request.files.iter().filter(|file| measures(file)).cloned().collect();
    if kept.is_empty() || kept.len() == request.files.len() {
        return Cow::Borrowed(request);
    }
    Cow::Owned(Request { files: kept, ..request.clone() })
}

/// Adds the shapes of `files` to an imported project at `out`. One whose DOFs the project does not have is told and left out.
pub(super) fn add(mut imported: Imported, files: &[PathBuf], out: &Path) -> Result<Imported> {
    for file in files {
        let name = named(file, out)?;
        let table = format!("[[modes]]\nfile = {}\n\n", toml::Value::from(name.as_str()));
        match plan(&format!("{}{table}", imported.text()), out) {
            Ok(plan) => {
                imported.tables.push_str(&table);
                let count = plan.reference_shapes.iter().filter(|shape| shape.name.starts_with(&name)).count();
                imported.summary.push_str(&format!(
                    "{}: {count} modes or operating shapes stand beside ours in `dashpot methods`\n",
                    file.display()
                ));
            }
            Err(error) => imported.remarks.push(format!("its modes are not added: {}", error.problem)),
        }
    }
    Ok(imported)
}

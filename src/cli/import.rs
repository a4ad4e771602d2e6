//! `dashpot import`: a project out of laboratory files where they lie.

use super::arguments_import::Import;
use crate::control::Control;
use crate::exchange::atomic::write_atomically;
use crate::exchange::frf::Form;
use crate::exchange::importing::files::{listed, may_be_measurement};
use crate::exchange::importing::{Kept, Request, import, proposal};
use crate::exchange::project::file::Label;
use crate::exchange::project::frf::FrfTable;
use crate::exchange::project::{TableProblem, frf_template, template};
use anyhow::{Context, ensure};
use dashpot_datafiles::Pairing;
use std::path::{Path, PathBuf};

pub(super) fn run(arguments: &Import) -> anyhow::Result<String> {
    let request = request(arguments)?;
    let out = project_file(arguments, &request)?;
    if arguments.propose {
        return Ok(proposal(&request, &out, &Control::unattended())?);
    }
    let imported = import(&request, &out, &Control::unattended())?;
    imported.remarks.iter().for_each(|remark| eprintln!("{remark}"));
    let text = imported.text();
    write_atomically(&out, text.as_bytes())
        .with_context(|| format!("{}: the project cannot be written", out.display()))?;
    Ok(imported.summary)
}

/// What the arguments and their template ask for.
fn request(arguments: &Import) -> anyhow::Result<Request> {
    let found = Request::of(measurements(&arguments.files)?);
    ensure!(
        !found.files.is_empty(),
        "{}: is a finite-element model; give the measurements together with it",
        arguments.files[0].display()
    );
    let mut request = Request {
        files: found.files,
        names: Vec::new(),
        channels: None,
        kept: None,
        sampling_hz: arguments.sampling_hz,
        mass: arguments.mass.clone().or(found.mass),
        stiffness: arguments.stiffness.clone().or(found.stiffness),
        nodes: arguments.nodes.clone().or(found.nodes),
        form: arguments.form.as_deref().and_then(Form::from_word),
        step_hz: arguments.step_hz,
        columns: arguments.columns.as_deref().and_then(Pairing::from_word),
        scale: arguments.scale,
        averages: arguments.averages.map(|averages| averages as usize),
        responses: arguments.responses.clone(),
        references: arguments.references.clone(),
        frf: None,
    };
    let Some(path) = &arguments.map else { return Ok(request) };
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("{name}: the template cannot be read"))?;
    request.kept = Kept::of(&text, path);
    match (frf_template(&text, &name)?, template(&text, &name)) {
        (Some(table), _) => responses_template(&mut request, table),
        (None, Ok(channels)) => request.channels = Some(channels),
        // A model alone: the mapping is proposed.
        (None, Err(error)) if request.kept.is_some() && matches!(*error.problem, TableProblem::Empty { .. }) => {}
        (None, Err(error)) => return Err(error.into()),
    }
    Ok(request)
}

/// The files, and those of folders that may be measurements or part of a model; what is passed over is said.
fn measurements(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let named = |file: &PathBuf| paths.contains(file) || may_be_measurement(file);
    let (files, others): (Vec<_>, Vec<_>) = listed(paths)?.into_iter().partition(named);
    ensure!(!files.is_empty(), "{}: the folder has no file of measurements", paths[0].display());
    if !others.is_empty() {
        let names: Vec<_> =
            others.iter().filter_map(|file| file.file_name()).map(|name| name.to_string_lossy()).collect();
        eprintln!("passed over, no measurements: {}", names.join(", "));
    }
    Ok(files)
}

/// What a `[[frf]]` of a template says where the arguments do not.
fn responses_template(request: &mut Request, table: FrfTable) {
    let labels = |list: &[Label]| list.iter().map(|label| label.0.clone()).collect::<Vec<_>>();
    request.form = request.form.or(table.form);
    request.scale = request.scale.or(table.scale);
    request.columns = request.columns.or(table.columns);
    request.step_hz = request.step_hz.or(table.step_hz);
    request.averages = request.averages.or(table.averages);
    if request.responses.is_empty() {
        request.responses = labels(&table.responses);
    }
    if request.references.is_empty() {
        request.references = labels(&table.references);
    }
    request.frf = Some(Box::new(table));
}

/// The project to write: `--out`, else the name of the first file in this folder, where nothing may be yet.
fn project_file(arguments: &Import, request: &Request) -> anyhow::Result<PathBuf> {
    if let Some(out) = &arguments.out {
        return Ok(out.clone());
    }
    let stem = request.files[0].file_stem().unwrap_or_default();
    let out = Path::new(stem).with_extension("toml");
    ensure!(
        arguments.propose || !out.exists(),
        "{}: is there already; name the project to write by --out",
        out.display()
    );
    Ok(out)
}

//! `dashpot import`: a project out of laboratory files where they lie. What a file holds says what is made of it: time records
//! become runs by a mapping of their channels, frequency responses `[[frf]]`, stepped-sine tables `[[harmonics]]`.

use super::arguments_import::Import;
use super::{import_model, import_records, import_responses, import_stepped};
use crate::exchange::atomic::write_atomically;
use crate::exchange::frf::Form;
use crate::exchange::mapping::stepped;
use crate::exchange::project::file::Label;
use crate::exchange::project::frf_template;
use crate::exchange::project::relocate::{canonical, renamed};
use anyhow::{Context, ensure};
use dashpot_datafiles::open;
use std::path::{Path, PathBuf};

pub(super) fn run(arguments: &Import) -> anyhow::Result<String> {
    if let Some(with_template) = responses_template(arguments)? {
        return import_responses::run(&with_template);
    }
    if arguments.map.is_none() {
        if import_responses::has_responses(arguments)? {
            return import_responses::run(arguments);
        }
        if let Some(table) = stepped(&open(&arguments.files[0])?) {
            return import_stepped::run(arguments, &table);
        }
    }
    import_records::run(arguments)
}

/// The arguments with the `[[frf]]` of the template; none where there is none in it.
fn responses_template(arguments: &Import) -> anyhow::Result<Option<Import>> {
    let Some(path) = &arguments.map else { return Ok(None) };
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("{name}: the template cannot be read"))?;
    let Some(table) = frf_template(&text, &name)? else { return Ok(None) };
    let labels = |list: &[Label]| list.iter().map(|label| label.0.clone()).collect::<Vec<_>>();
    let mut all = arguments.clone();
    let word = |form: Form| Form::WORDS[form as usize].to_owned();
    all.form = all.form.or(table.form.map(word));
    all.scale = all.scale.or(table.scale);
    all.columns = all.columns.or(table.columns.map(|columns| columns.word().to_owned()));
    all.step_hz = all.step_hz.or(table.step_hz);
    all.averages = all.averages.or(table.averages.and_then(|averages| u32::try_from(averages).ok()));
    if all.responses.is_empty() {
        all.responses = labels(&table.responses);
    }
    if all.references.is_empty() {
        all.references = labels(&table.references);
    }
    all.frf = Some(Box::new(table));
    Ok(Some(all))
}

/// The project to write: `--out`, else the name of the first file in this folder, where nothing may be yet.
pub(super) fn project_file(arguments: &Import) -> anyhow::Result<PathBuf> {
    if let Some(out) = &arguments.out {
        return Ok(out.clone());
    }
    let stem = arguments.files[0].file_stem().unwrap_or_default();
    let out = Path::new(stem).with_extension("toml");
    ensure!(
        arguments.propose || !out.exists(),
        "{}: is there already; name the project to write by --out",
        out.display()
    );
    Ok(out)
}

/// Writes the project.
pub(super) fn write(out: &Path, text: &str) -> anyhow::Result<()> {
    write_atomically(out, text.as_bytes()).with_context(|| format!("{}: the project cannot be written", out.display()))
}

/// Head of a project with the structure of the model that is given, else with `own`, and candidates.
pub(super) fn head(arguments: &Import, out: &Path, own: &str, up_to_hz: f64) -> anyhow::Result<String> {
    let title = arguments.files[0].file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let structure = import_model::structure(arguments, out, up_to_hz)?.unwrap_or_else(|| own.to_owned());
    Ok(format!(
        "[project]\nformat = 1\ntitle = {}\n\n{structure}\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\n",
        toml::Value::from(title)
    ))
}

/// `[structure]` of measured points.
pub(super) fn points(labels: &[String]) -> String {
    let quoted: Vec<String> = labels.iter().map(|label| toml::Value::from(label.as_str()).to_string()).collect();
    format!("[structure]\nkind = \"points\"\ndofs = [{}]\n", quoted.join(", "))
}

/// Lines of a comment.
pub(super) fn comment(text: &str) -> String {
    let mut out = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() && line.chars().count() + word.chars().count() > 116 {
            out.push_str(&format!("# {line}\n"));
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    if !line.is_empty() {
        out.push_str(&format!("# {line}\n"));
    }
    out
}

/// Name of a file as the project at `out` refers to it.
pub(super) fn named(file: &Path, out: &Path) -> anyhow::Result<String> {
    if file.is_absolute() {
        return Ok(file.display().to_string());
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    let to = canonical(folder).with_context(|| format!("{}: the folder is not there", folder.display()))?;
    let here = canonical(file.parent().unwrap_or(Path::new("")))?;
    let name = file.file_name().with_context(|| format!("{}: names no file", file.display()))?.to_string_lossy();
    Ok(renamed(&name, &here, &to))
}

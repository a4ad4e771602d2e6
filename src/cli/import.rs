//! `dashpot import`: a project out of laboratory files where they lie. What a file holds says what is made of it: time records
//! become runs by a mapping of their channels, frequency responses `[[frf]]`, stepped-sine tables `[[harmonics]]`.

use super::arguments_import::Import;
use super::{import_records, import_responses, import_stepped};
use crate::exchange::frf::Form;
use crate::exchange::mapping::stepped;
use crate::exchange::project::frf_template;
use crate::exchange::project::label::Label;
use anyhow::Context;
use dashpot_datafiles::open;

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

//! Tables `[[frf]]`: measured frequency responses as runs.

use super::error::{ProjectError, TableProblem};
use super::label::Label;
use super::lines::Lines;
use super::reader::{Origin, Table};
use crate::exchange::frf::{Form, FrfSource};
use crate::measurement::frf::Selection;
use dashpot_datafiles::Pairing;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;

/// Lines that are used unless the project says otherwise: enough for many modes, few enough to stay fast.
const USUAL_LINES: usize = 96;
/// Most lines that may be asked for.
const MOST_LINES: usize = 100_000;
/// Most averages.
const MOST_AVERAGES: usize = 1_000_000;

/// Table `[[frf]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrfTable {
    /// Universal File, or another with complex values over a frequency; relative to the project.
    pub file: String,
    /// Files of the same test, on the same frequencies, whose functions belong to those of `file`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub further_files: Vec<String>,
    /// What the functions relate; from their units where it is left out.
    pub form: Option<Form>,
    /// Factor from the file's numbers to SI, or on top of its units.
    pub scale: Option<f64>,
    /// Number of averages.
    pub averages: Option<usize>,
    /// Whether responses and references are exchanged.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub reciprocity: bool,
    /// Band, Hz.
    pub band: Option<[f64; 2]>,
    /// Most lines that become runs.
    pub lines: Option<usize>,
    /// Key `use`.
    #[serde(rename = "use", skip_serializing_if = "Clone::clone")]
    pub enabled: bool,
    /// Labels of the responses in the order of the columns of an array.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<Label>,
    /// Labels of the references in the order of the columns of an array.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<Label>,
    /// Step of the frequencies from 0 Hz on, Hz, where the file does not say them.
    pub step_hz: Option<f64>,
    /// How the columns are parts of complex numbers two by two, where their names do not say it.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "word", deserialize_with = "pairing")]
    pub columns: Option<Pairing>,
    /// DOFs of the file, such as `12:+Z`, and their labels in the structure.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub dofs: BTreeMap<String, Label>,
    /// The same of the DOFs where forces act, where these are elsewhere than the sensors of that name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub reference_dofs: BTreeMap<String, Label>,
}

impl FrfTable {
    /// All functions of a file as it says itself.
    pub fn of(file: String) -> Self {
        Self {
            file,
            further_files: Vec::new(),
            form: None,
            scale: None,
            averages: None,
            reciprocity: false,
            band: None,
            lines: None,
            enabled: true,
            responses: Vec::new(),
            references: Vec::new(),
            step_hz: None,
            columns: None,
            dofs: BTreeMap::new(),
            reference_dofs: BTreeMap::new(),
        }
    }
}

/// Reads every `[[frf]]`.
pub(super) fn parse(root: &Table<'_>, lines: &mut Lines) -> Result<Vec<FrfTable>, ProjectError> {
    let mut tables = Vec::new();
    for table in root.tables("frf", "[[frf]]")? {
        tables.push(one(&table, table.need("file", "file = \"hammer.uff\"", table.text("file")?)?)?);
        lines.note(&table);
    }
    Ok(tables)
}

fn one(table: &Table<'_>, file: String) -> Result<FrfTable, ProjectError> {
    table.only_in::<FrfTable>(&[])?;
    let scale = table.number("scale")?;
    if scale == Some(0.0) {
        let problem = TableProblem::OutOfRange { key: "scale".into(), value: "0".into(), range: "other than zero" };
        return Err(table.error("scale", problem));
    }
    Ok(FrfTable {
        file,
        further_files: table.texts("further_files")?.unwrap_or_default(),
        form: table.word("form", &Form::WORDS, Form::from_word)?,
        scale,
        averages: table.count("averages", 1, MOST_AVERAGES, "between 1 and 1000000")?,
        reciprocity: table.flag("reciprocity")?.unwrap_or(false),
        band: band(table)?,
        lines: table.count("lines", 1, MOST_LINES, "between 1 and 100000")?,
        enabled: table.flag("use")?.unwrap_or(true),
        dofs: dofs(table, "dofs", "[frf.dofs]")?,
        reference_dofs: dofs(table, "reference_dofs", "[frf.reference_dofs]")?,
        responses: table.labels("responses")?.unwrap_or_default().into_iter().map(Label).collect(),
        references: table.labels("references")?.unwrap_or_default().into_iter().map(Label).collect(),
        step_hz: step(table)?,
        columns: table.word("columns", &Pairing::WORDS, Pairing::from_word)?,
    })
}

#[expect(clippy::ref_option, clippy::trivially_copy_pass_by_ref, reason = "serde passes references to fields")]
fn word<S: Serializer>(columns: &Option<Pairing>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(columns.map_or("", Pairing::word))
}

fn pairing<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Pairing>, D::Error> {
    Ok(Pairing::from_word(&String::deserialize(deserializer)?))
}

/// The first `[[frf]]` of a template, as TOML text and as it reads; its `file` may be left out. None where the template has
/// `[[channel]]` tables instead.
///
/// # Errors
/// [`ProjectError`] with the line of what is wrong.
pub fn frf_template(text: &str, name: &str) -> Result<Option<FrfTable>, ProjectError> {
    let origin = Origin { file: name, text };
    let document = origin.document()?;
    let root = Table::root(origin, document.get_ref());
    let Some(first) = root.tables("frf", "[[frf]]")?.into_iter().next() else { return Ok(None) };
    one(&first, first.text("file")?.unwrap_or_default()).map(Some)
}

fn step(table: &Table<'_>) -> Result<Option<f64>, ProjectError> {
    let step = table.number("step_hz")?;
    match step.filter(|step| *step <= 0.0) {
        Some(value) => {
            let problem =
                TableProblem::OutOfRange { key: "step_hz".into(), value: value.to_string(), range: "above 0 Hz" };
            Err(table.error("step_hz", problem))
        }
        None => Ok(step),
    }
}

fn band(table: &Table<'_>) -> Result<Option<[f64; 2]>, ProjectError> {
    let Some(numbers) = table.numbers("band")? else { return Ok(None) };
    match <[f64; 2]>::try_from(numbers.as_slice()) {
        Ok(band) if band[0] >= 0.0 && band[1] > band[0] => Ok(Some(band)),
        _ => {
            let value = format!("{numbers:?}");
            let range = "two ascending frequencies in Hz, such as [5, 400]";
            Err(table.error("band", TableProblem::OutOfRange { key: "band".into(), value, range }))
        }
    }
}

/// DOFs of a file and their labels in the structure, a table at `key` called `title`.
pub(super) fn dofs(
    table: &Table<'_>,
    key: &'static str,
    title: &'static str,
) -> Result<BTreeMap<String, Label>, ProjectError> {
    let Some(map) = table.table(key, title)? else { return Ok(BTreeMap::new()) };
    let mut dofs = BTreeMap::new();
    for key in map.keys() {
        if let Some(label) = map.label(key)? {
            dofs.insert(key.to_string(), Label(label));
        }
    }
    Ok(dofs)
}

impl FrfTable {
    /// Its files, as they are named from the project.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        std::iter::once(&self.file).chain(&self.further_files)
    }

    /// How its files are to be read.
    pub fn source(&self) -> FrfSource {
        let plain =
            |dofs: &BTreeMap<String, Label>| dofs.iter().map(|(name, label)| (name.clone(), label.0.clone())).collect();
        FrfSource {
            form: self.form,
            scale: self.scale,
            averages: self.averages,
            reciprocity: self.reciprocity,
            dofs: plain(&self.dofs),
            reference_dofs: plain(&self.reference_dofs),
            responses: self.responses.iter().map(|label| label.0.clone()).collect(),
            references: self.references.iter().map(|label| label.0.clone()).collect(),
            step_hz: self.step_hz,
            columns: self.columns,
            before: 0,
        }
    }

    /// Which lines become runs.
    pub fn selection(&self) -> Selection {
        Selection { band: self.band.unwrap_or([0.0, f64::INFINITY]), most: self.lines.unwrap_or(USUAL_LINES) }
    }
}

//! Frequency responses out of files that are no Universal Files: complex channels over a frequency (MAT, HDF5, TDMS, tables).
//!
//! Response and reference of a channel are told, in this order, by `responses` and `references` of the project (columns of
//! an array, all responses to the first reference first), by what the file says of the channel, by its name.

use super::checks::{drop_zero, same_frequencies};
use super::coherences::{attach, coherences};
use super::error::FrfProblem;
use super::names::{pair_in_name, place_of_name, response_in_name};
use super::source::FrfSource;
use super::units::{Form, is_bare, motion_of_unit, ratio_of_unit};
use crate::control::Control;
use crate::measurement::frf::{FrequencyResponse, ResponseSet};
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use dashpot_datafiles::{DataFile, Kind, Values, open, open_paired};
use faer::c64;
use std::path::Path;

/// The functions of a file on their common frequencies, and what the file has to note.
pub(super) fn read(
    path: &Path,
    name: &str,
    source: &FrfSource,
    structure: &Structure,
    control: &Control,
) -> Result<(ResponseSet, Vec<String>), FrfProblem> {
    let file = match source.columns {
        Some(pairing) => open_paired(path, pairing),
        None => open(path),
    };
    let file = file.map_err(|error| data(&error))?;
    let places = functions(&file, source.step_hz.is_some());
    if places.is_empty() {
        return Err(FrfProblem::NoResponses);
    }
    let mut set = ResponseSet {
        name: name.to_string(),
        frequencies_hz: Vec::new(),
        functions: Vec::new(),
        averages: source.averages,
    };
    for (k, &at) in places.iter().enumerate() {
        if control.check().is_err() {
            break;
        }
        let frequencies = frequencies(&file, at, source.step_hz)?;
        if set.frequencies_hz.is_empty() {
            set.frequencies_hz = frequencies;
        } else if !same_frequencies(&set.frequencies_hz, &frequencies) {
            return Err(FrfProblem::channel(
                &file,
                at,
                "its frequencies are not those before it; put it into a file of its own",
            ));
        }
        let function = function(&file, at, k, source, structure)?;
        let twice = |f: &FrequencyResponse| f.response == function.response && f.reference == function.reference;
        if set.functions.iter().any(twice) {
            let what = format!("{} over {} is there already; keep one of them", function.response, function.reference);
            return Err(FrfProblem::channel(&file, at, &what));
        }
        set.functions.push(function);
    }
    for (at, values) in coherences(&file, &places).map_err(|error| data(&error))? {
        attach(&mut set, &file, &places, at, values)?;
    }
    drop_zero(&mut set);
    let notes = file.contents().notes.iter().map(|note| format!("{name}: {note}")).collect();
    Ok((set, notes))
}

fn data(error: &dashpot_datafiles::Error) -> FrfProblem {
    let place = error.place.as_ref().map_or_else(String::new, |place| format!("{place}: "));
    FrfProblem::Data(format!("{place}{}", error.problem))
}

/// Set and channel of every function; of complex columns without frequencies too where their step is `given`.
fn functions(file: &DataFile, given: bool) -> Vec<(usize, usize)> {
    let wanted = |kind: Kind| kind == Kind::Frf || given && kind == Kind::Table;
    let sets = file.contents().sets.iter().enumerate().filter(|(_, set)| wanted(set.kind));
    sets.flat_map(|(s, set)| {
        let complex = set.channels.iter().enumerate().filter(|(_, channel)| channel.complex && channel.count > 0);
        complex.map(move |(c, _)| (s, c))
    })
    .collect()
}

fn frequencies(file: &DataFile, at: (usize, usize), step_hz: Option<f64>) -> Result<Vec<f64>, FrfProblem> {
    let unit = file.contents().sets[at.0].axis_unit.trim();
    let scale = match unit.to_lowercase().as_str() {
        "" | "hz" | "1/s" => 1.0,
        "khz" => 1e3,
        "rad/s" => 1.0 / std::f64::consts::TAU,
        _ => {
            return Err(FrfProblem::channel(
                file,
                at,
                &format!("its abscissa is in \"{unit}\"; export over frequency in Hz"),
            ));
        }
    };
    let count = file.contents().sets[at.0].channels[at.1].count;
    let axis = if let Some(axis) = file.axis(at.0, at.1).map_err(|error| data(&error))? {
        axis
    } else {
        let missing = "the file does not say its frequencies; add `step_hz` to its [[frf]], or save them beside it";
        let step = step_hz.ok_or_else(|| FrfProblem::channel(file, at, missing))?;
        (0..count).map(|i| step * i as f64).collect()
    };
    let axis: Vec<f64> = axis.into_iter().map(|f| f * scale).collect();
    if axis.iter().any(|f| !f.is_finite()) || axis.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(FrfProblem::channel(
            file,
            at,
            "its frequencies do not increase; export over ascending frequencies",
        ));
    }
    Ok(axis)
}

/// Function number `k` of the file.
fn function(
    file: &DataFile,
    at: (usize, usize),
    k: usize,
    source: &FrfSource,
    structure: &Structure,
) -> Result<FrequencyResponse, FrfProblem> {
    let entry = &file.contents().sets[at.0].channels[at.1];
    let pair = pair(file, at, k, source)?;
    let [response, reference] = if source.reciprocity { [&pair[1], &pair[0]] } else { [&pair[0], &pair[1]] };
    let find = |name: &str, of_force: bool| {
        let plain = name.split_once('@').map_or(name, |(_, label)| label).trim();
        let named = source.names(of_force, &[name.trim(), plain]);
        place_of_name(name, named, structure).map_err(|what| FrfProblem::channel(file, at, &what))
    };
    let ((response, sign), (reference, other)) = (find(response, false)?, find(reference, true)?);
    let spoken = Form::spoken(&entry.name).or_else(|| Form::spoken(&file.contents().sets[at.0].name));
    let (form, scale) = form(source, spoken, &entry.unit).map_err(|what| FrfProblem::channel(file, at, &what))?;
    if form.is_inverse() && response != reference {
        let what =
            "force over motion between different DOFs is not the inverse of a response; export motion over force";
        return Err(FrfProblem::channel(file, at, what));
    }
    let values = match file.read(at.0, at.1).map_err(|error| data(&error))? {
        Values::Complex(values) => values,
        Values::Real(values) => values.into_iter().map(|re| [re, 0.0]).collect(),
    };
    if values.iter().flatten().any(|part| !part.is_finite()) {
        return Err(FrfProblem::channel(file, at, "has values that are no numbers; export it again or leave it out"));
    }
    let factor = scale * sign * other;
    let value = |[re, im]: [f64; 2]| {
        let value = c64::new(re, im) * factor;
        if form.is_inverse() { c64::new(1.0, 0.0) / value } else { value }
    };
    let channel = |quantity, dof: usize| Channel { quantity, dof, label: structure.label(dof).to_string() };
    Ok(FrequencyResponse {
        response: channel(form.quantity(), response),
        reference: channel(Quantity::Force, reference),
        values: values.into_iter().map(value).collect(),
        coherence: None,
    })
}

/// Names of response and reference.
fn pair(file: &DataFile, at: (usize, usize), k: usize, source: &FrfSource) -> Result<[String; 2], FrfProblem> {
    let entry = &file.contents().sets[at.0].channels[at.1];
    if let Some(listed) = source.listed(k).map_err(|what| FrfProblem::channel(file, at, &what))? {
        return Ok(listed);
    }
    if let (Some(response), Some(reference)) = (entry.attribute("response"), entry.attribute("reference")) {
        return Ok([response.to_owned(), reference.to_owned()]);
    }
    if let Some(pair) = pair_in_name(&entry.name) {
        return Ok(pair);
    }
    match (&source.references[..], response_in_name(&entry.name)) {
        ([reference], Some(response)) => Ok([response, reference.clone()]),
        _ => Err(FrfProblem::channel(
            file,
            at,
            "neither its name nor the file says its DOFs; add `responses = [...]` and `references = [...]` to the [[frf]]",
        )),
    }
}

/// Form and factor to SI: from the project, else from the unit, else from a word of the name.
fn form(source: &FrfSource, spoken: Option<Form>, unit: &str) -> Result<(Form, f64), String> {
    let bare = is_bare(unit);
    match (source.form.or(spoken.filter(|_| bare)), source.scale) {
        (Some(form), Some(scale)) => Ok((form, scale)),
        (Some(form), None) if bare => Ok((form, 1.0)),
        // The unit of the motion alone: the force is taken in N.
        (Some(form), scale) if motion_of_unit(unit).is_some_and(|(quantity, _)| Form::of(quantity) == Some(form)) => {
            Ok((form, motion_of_unit(unit).map_or(1.0, |(_, to_si)| to_si) * scale.unwrap_or(1.0)))
        }
        (None, _) if bare => {
            Err("the file says no unit; add `form`, such as form = \"accelerance\" (of import: --form \
                                  accelerance), and `scale` where it is not SI"
                .to_owned())
        }
        (form, scale) => {
            let ratio = ratio_of_unit(unit)?;
            if form.is_some_and(|form| form != ratio.form) {
                return Err(format!(
                    "its unit is that of another form ({:?}); correct `form` (of import: --form), or give `scale` (--scale) too",
                    ratio.form
                ));
            }
            Ok((ratio.form, ratio.to_si * scale.unwrap_or(1.0)))
        }
    }
}

//! Import of frequency responses: a project with `[[frf]]`, its DOFs those of the file or of a model.

use super::error::{ImportError, Result};
use super::model::{Point, head, model, places};
use super::request::{Imported, Request};
use super::text::{comment, named, points as points_structure};
use crate::control::Control;
use crate::exchange::frf::{Form, pair_in_name, plain_place, response_in_name};
use crate::exchange::project::frf::FrfTable;
use crate::exchange::project::plan;
use dashpot_datafiles::{Channel, Contents, DataFile, Format, Kind, Set, Values, open, open_paired};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Whether a file among them has frequency responses.
pub(super) fn has_responses(request: &Request) -> Result<bool> {
    for file in &request.files {
        if functions(opened(request, file)?.contents(), request).next().is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Opens a file, its columns two by two where that is said.
fn opened(request: &Request, file: &Path) -> Result<DataFile, dashpot_datafiles::Error> {
    match request.columns {
        Some(pairing) => open_paired(file, pairing),
        None => open(file),
    }
}

/// The functions of a file; complex columns without frequencies too where their step is given.
fn functions<'a>(contents: &'a Contents, request: &Request) -> impl Iterator<Item = &'a Channel> {
    contents.sets.iter().flat_map(|set| of_set(set, request))
}

fn of_set<'a>(set: &'a Set, request: &Request) -> impl Iterator<Item = &'a Channel> + use<'a> {
    let wanted = set.kind == Kind::Frf || request.step_hz.is_some() && set.kind == Kind::Table;
    set.channels.iter().filter(move |channel| wanted && channel.complex && channel.count > 0)
}

/// The project of frequency responses.
pub(super) fn import(request: &Request, out: &Path, control: &Control) -> Result<Imported> {
    let Found { head, tables, summary, assumed } = project(request, out)?;
    let project =
        plan(&format!("{head}{tables}"), out).and_then(|plan| plan.load(control)).map_err(ImportError::Unwritten)?;
    let assumed = assumed.iter().map(|what| format!("assumed: {what}\n")).collect::<String>();
    let runs = project.runs.len();
    let summary = format!("{assumed}{summary}, {runs} runs of one line each, are in {}\n", out.display());
    Ok(Imported { head, tables, summary, remarks: project.remarks })
}

/// The functions of files as they would be imported.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Functions {
    /// Number of functions.
    pub count: usize,
    /// DOFs as the files call them, and their labels in the project.
    pub dofs: Vec<(String, String)>,
    /// Labels of the responses in the order of the functions, where neither names nor files say them.
    pub responses: Vec<String>,
    /// Labels of the references then.
    pub references: Vec<String>,
    /// What was assumed.
    pub assumed: Vec<String>,
}

/// What the functions of the files are, and where.
pub(super) fn look(request: &Request) -> Result<Functions> {
    let read = said(request)?;
    let (labels, _) = labelled(request, &read.points)?;
    let dofs = read.points.iter().map(|(name, _)| name.clone()).zip(labels).collect();
    let own = |one: &Measured| (one.responses.clone(), one.references.clone());
    let (responses, references) = read.measured.first().map(own).unwrap_or_default();
    Ok(Functions { count: read.count, dofs, responses, references, assumed: read.assumed })
}

/// A project and what is in it.
struct Found {
    head: String,
    tables: String,
    summary: String,
    assumed: Vec<String>,
}

/// A file with responses and the labels of its functions in order, where names and file do not say them.
struct Measured {
    path: PathBuf,
    responses: Vec<String>,
    references: Vec<String>,
}

/// What the files say of their functions.
struct Said {
    count: usize,
    highest_hz: f64,
    points: Vec<(String, Point)>,
    measured: Vec<Measured>,
    assumed: Vec<String>,
}

fn said(request: &Request) -> Result<Said> {
    let files: Vec<DataFile> = request.files.iter().map(|file| opened(request, file)).collect::<Result<_, _>>()?;
    let (measured, assumed) = measured(request, &files)?;
    let (mut names, mut highest_hz, mut count) = (Vec::new(), 0.0_f64, 0);
    for file in &files {
        for channel in functions(file.contents(), request) {
            count += 1;
            let step = channel.axis.step().or(request.step_hz).unwrap_or(0.0);
            highest_hz = highest_hz.max(step * channel.count as f64);
            names.extend(pair(file, channel).into_iter().flatten());
        }
    }
    if measured.iter().any(|one| !one.responses.is_empty()) {
        names = measured.iter().flat_map(|one| one.responses.iter().chain(&one.references)).cloned().collect();
    }
    Ok(Said { count, highest_hz, points: points(&names, &files)?, measured, assumed })
}

fn project(request: &Request, out: &Path) -> Result<Found> {
    let Said { count, highest_hz, points, measured, mut assumed } = said(request)?;
    assumed.extend(nowhere(request, &points).map(|name| {
        format!("the file says no place of its reference {name}: it is taken to act at the first response; correct it under [frf.dofs]")
    }));
    let (labels, dofs) = labelled(request, &points)?;
    let up_to = if highest_hz > 0.0 { 2.0 * highest_hz } else { 2000.0 };
    let head = head(request, out, &points_structure(&labels), up_to)?;
    let mut tables = String::new();
    for what in &assumed {
        tables.push_str(&comment(&format!("Assumed: {what}.")));
    }
    for one in &measured {
        tables.push_str(&table(request, &named(&one.path, out)?, one, &dofs));
    }
    Ok(Found { head, tables, summary: format!("{count} functions at {} DOFs", points.len()), assumed })
}

/// Labels of the DOFs, and those of the file that are called otherwise in the project.
fn labelled(request: &Request, points: &[(String, Point)]) -> Result<(Vec<String>, BTreeMap<String, String>)> {
    let own: Vec<String> = points.iter().map(|(_, point)| format!("{}{}", point.node, point.direction)).collect();
    let (mut labels, names): (Vec<String>, Vec<&String>) = match model(request)? {
        Some(model) => {
            let unsaid = points.iter().filter(|(name, _)| template_label(request, name).is_none() && !is_nowhere(name));
            let wanted: Vec<Point> = unsaid.map(|(_, point)| point.clone()).collect();
            let mut found = places(&wanted, &model)?.into_iter();
            let label = |(name, _): &(String, Point)| match template_label(request, name) {
                Some(_) => String::new(),
                None if is_nowhere(name) => String::new(),
                None => found.next().unwrap_or_default(),
            };
            (points.iter().map(label).collect(), own.iter().collect())
        }
        None => (own.clone(), points.iter().map(|(name, _)| name).collect()),
    };
    // What a template says of a DOF goes first.
    for (label, (name, _)) in labels.iter_mut().zip(points) {
        if let Some(said) = template_label(request, name) {
            said.trim_start_matches('-').clone_into(label);
        }
    }
    let first = labels.iter().zip(points).find(|(_, (name, _))| !is_nowhere(name)).map(|(label, _)| label.clone());
    if let Some(first) = first {
        let unplaced: Vec<&String> = nowhere(request, points).collect();
        for (label, _) in labels.iter_mut().zip(points).filter(|(_, (name, _))| unplaced.contains(&name)) {
            label.clone_from(&first);
        }
    }
    let other = labels.iter().zip(names).zip(points).filter(|((label, name), _)| label != name);
    let dofs = other.map(|((label, _), (name, _))| (name.clone(), label.clone())).collect();
    let mut once: Vec<String> = Vec::new();
    for label in labels {
        if !once.contains(&label) {
            once.push(label);
        }
    }
    Ok((once, dofs))
}

/// Whether a DOF of a file is none: node 0, as scanning vibrometers call the channel of the force.
fn is_nowhere(name: &str) -> bool {
    name == "0:S"
}

/// DOFs of the files that are none and that no template places.
fn nowhere<'a>(request: &'a Request, points: &'a [(String, Point)]) -> impl Iterator<Item = &'a String> {
    points.iter().map(|(name, _)| name).filter(|name| is_nowhere(name) && template_label(request, name).is_none())
}

/// The label that a template gives a DOF, `-` in front of it where it is reversed.
fn template_label<'a>(request: &'a Request, name: &str) -> Option<&'a str> {
    request.frf.as_ref()?.dofs.get(name).map(|label| label.0.as_str())
}

/// The files with responses; DOFs as they are given, else numbered in order where neither names nor files say them.
fn measured(request: &Request, files: &[DataFile]) -> Result<(Vec<Measured>, Vec<String>)> {
    let counts: Vec<usize> = files.iter().map(|file| functions(file.contents(), request).count()).collect();
    let named =
        files.iter().all(|file| functions(file.contents(), request).all(|channel| pair(file, channel).is_some()));
    let total: usize = counts.iter().sum();
    let mut assumed = Vec::new();
    let (mut responses, mut references) = (request.responses.clone(), request.references.clone());
    if !named && responses.is_empty() {
        let (numbers, how) = numbered(request, files, &counts);
        responses = numbers;
        if references.is_empty() {
            references = vec![responses[0].clone()];
        }
        if references.len() != 1 {
            let problem =
                "neither names nor file say the DOFs of the functions; give them by --responses and --references";
            return Err(ImportError::of(&request.files[0], problem));
        }
        assumed.push(format!("{how}, all driven at {}", references[0]));
    }
    // One list for all files one after the other, or the same list for each.
    let in_turn = references.len() == 1 && responses.len() == total && files.len() > 1;
    let mut from = 0;
    let mut measured = Vec::new();
    for (file, count) in files.iter().zip(counts).filter(|(_, count)| *count > 0) {
        let own = if in_turn { responses[from..from + count].to_vec() } else { responses.clone() };
        from += count;
        measured.push(Measured { path: file.path().to_owned(), responses: own, references: references.clone() });
    }
    Ok((measured, assumed))
}

/// Labels of responses whose references nothing says: by the numbers in the names of the functions, of their sets, of the
/// files, else in their order; and how that is said.
fn numbered(request: &Request, files: &[DataFile], counts: &[usize]) -> (Vec<String>, String) {
    let functions = |file| functions_with_sets(file, request);
    let label = |name: &str| {
        let label: String = response_in_name(name)?.chars().filter(char::is_ascii_alphanumeric).collect();
        Some(label.to_lowercase()).filter(|label| place_like(label))
    };
    let by_name: Vec<Option<String>> =
        files.iter().flat_map(functions).map(|(_, channel)| label(&channel.name)).collect();
    let by_set: Vec<Option<String>> = files.iter().flat_map(functions).map(|(set, _)| label(set)).collect();
    let one_each = counts.iter().all(|count| *count < 2);
    let measured = files.iter().zip(counts).filter(|(_, count)| **count > 0);
    let by_file: Vec<Option<String>> = measured
        .map(|(file, _)| label(&file.path().file_stem().unwrap_or_default().to_string_lossy()).filter(|_| one_each))
        .collect();
    let whose = [(by_name, "names"), (by_set, "sets"), (by_file, "files")];
    for (labels, whose) in whose {
        let mut seen: Vec<&String> = labels.iter().flatten().collect();
        seen.sort_unstable();
        seen.dedup();
        if !labels.is_empty() && seen.len() == labels.len() {
            let labels: Vec<String> = labels.into_iter().flatten().collect();
            let how = format!("the responses are at {} by the numbers in their {whose}", labels.join(", "));
            return (labels, how);
        }
    }
    let total = counts.iter().sum::<usize>();
    let how = format!("neither names nor file say the DOFs: the responses are numbered 1 to {total} in their order");
    ((1..=total).map(|number| number.to_string()).collect(), how)
}

/// Whether a text is a number with a direction or without.
fn place_like(text: &str) -> bool {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    end > 0 && matches!(&text[end..], "" | "x" | "y" | "z" | "rx" | "ry" | "rz")
}

/// The functions of a file with the names of their sets.
fn functions_with_sets<'a>(file: &'a DataFile, request: &'a Request) -> impl Iterator<Item = (&'a str, &'a Channel)> {
    let sets = file.contents().sets.iter();
    sets.flat_map(move |set| of_set(set, request).map(move |channel| (set.name.as_str(), channel)))
}

/// The `[[frf]]` of a file.
fn table(request: &Request, file: &str, measured: &Measured, dofs: &BTreeMap<String, String>) -> String {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let list = |labels: &[String]| labels.iter().map(|label| quoted(label)).collect::<Vec<_>>().join(", ");
    let mut text = format!("[[frf]]\nfile = {}\n", quoted(file));
    if let Some(form) = request.form {
        text.push_str(&format!("form = {}\n", quoted(Form::WORDS[form as usize])));
    }
    if let Some(scale) = request.scale {
        text.push_str(&format!("scale = {scale:?}\n"));
    }
    if let Some(columns) = request.columns {
        text.push_str(&format!("columns = {}\n", quoted(columns.word())));
    }
    if let Some(template) = &request.frf {
        text.push_str(&of_template(template));
    }
    match request.averages {
        Some(averages) => text.push_str(&format!("averages = {averages}\n")),
        None => text.push_str("# averages = 8                    # with the coherences it gives the deviations\n"),
    }
    if let Some(step) = request.step_hz {
        text.push_str(&format!("step_hz = {step:?}\n"));
    }
    for (key, labels) in [("responses", &measured.responses), ("references", &measured.references)] {
        if !labels.is_empty() {
            text.push_str(&format!("{key} = [{}]\n", list(labels)));
        }
    }
    let mut dofs = dofs.clone();
    for (name, label) in request.frf.iter().flat_map(|template| &template.dofs) {
        dofs.insert(name.clone(), label.0.clone());
    }
    if !dofs.is_empty() {
        text.push_str("\n[frf.dofs]\n");
        dofs.iter().for_each(|(name, label)| text.push_str(&format!("{} = {}\n", quoted(name), quoted(label))));
    }
    text + "\n"
}

/// What only a template says.
fn of_template(template: &FrfTable) -> String {
    let mut text = String::new();
    if template.reciprocity {
        text.push_str("reciprocity = true\n");
    }
    if let Some([from, to]) = template.band {
        text.push_str(&format!("band = [{from:?}, {to:?}]\n"));
    }
    if let Some(lines) = template.lines {
        text.push_str(&format!("lines = {lines}\n"));
    }
    text
}

/// Names of response and reference of a function. Universal Files state them; elsewhere the name of the channel may.
fn pair(file: &DataFile, channel: &Channel) -> Option<[String; 2]> {
    match (channel.attribute("response"), channel.attribute("reference")) {
        // Node 0 is no point: its entity alone is there, or nothing.
        (Some(response), reference)
            if file.contents().format == Format::Uff
                && response.contains(':')
                && reference.is_none_or(|reference| !reference.contains(':')) =>
        {
            Some([response.to_owned(), "0:S".to_owned()])
        }
        (Some(response), Some(reference)) => Some([response.to_owned(), reference.to_owned()]),
        _ if file.contents().format == Format::Uff => None,
        _ => pair_in_name(&channel.name),
    }
}

/// The points that the names stand for, each once, by the name of its positive direction.
fn points(names: &[String], files: &[DataFile]) -> Result<Vec<(String, Point)>> {
    let mut positions: BTreeMap<String, [f64; 3]> = BTreeMap::new();
    for file in files {
        positions_in(file, &mut positions)?;
    }
    let mut points: Vec<(String, Point)> = Vec::new();
    for name in names {
        // `ENTITY 12:+Z`, `acc@12`: what stands in front is no part of the place.
        let plain = plain_place(name.rsplit('@').next().unwrap_or_default());
        let plain = plain.rsplit(' ').next().unwrap_or_default().trim_start_matches('-').replace(":-", ":+");
        let digits = plain.find(|c: char| !c.is_ascii_digit()).unwrap_or(plain.len());
        let direction: String =
            plain[digits..].chars().filter(char::is_ascii_alphabetic).collect::<String>().to_lowercase();
        let node = if digits > 0 { plain[..digits].to_owned() } else { plain.clone() };
        let direction = if digits > 0 { direction } else { String::new() };
        let position = positions.get(&node).copied();
        if points.iter().all(|(known, _)| *known != plain) {
            points.push((plain, Point { node, direction, position }));
        }
    }
    Ok(points)
}

/// Nodes of a file with their positions.
fn positions_in(file: &DataFile, positions: &mut BTreeMap<String, [f64; 3]>) -> Result<()> {
    for (s, set) in file.contents().sets.iter().enumerate().filter(|(_, set)| set.kind == Kind::Geometry) {
        let column = |name: &str| -> Result<Option<Vec<f64>>> {
            let Some(c) = set.channels.iter().position(|channel| channel.name == name) else { return Ok(None) };
            match file.read(s, c)? {
                Values::Real(values) => Ok(Some(values)),
                Values::Complex(_) => Ok(None),
            }
        };
        if let (Some(node), Some(x), Some(y), Some(z)) = (column("node")?, column("x")?, column("y")?, column("z")?) {
            for (i, node) in node.iter().enumerate() {
                positions.insert(format!("{node}"), [x[i], y[i], z[i]]);
            }
        }
    }
    Ok(())
}

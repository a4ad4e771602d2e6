//! Import of frequency responses: a project with `[[frf]]`, its DOFs those of the file or of a model.

use super::error::{ImportError, Result};
use super::functions::{Labelled, Measured, functions, measured, opened, pair, together};
use super::kept::Kept;
use super::model::{MATERIAL, Point, head, model, places};
use super::numbers::{Taken, along_the_only_axis, of_numbers, said_of_axis};
use super::request::{Imported, Request};
use super::text::{comment, named, points as points_structure};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::diagnose::place_of_force;
use crate::effects::{Effect, Place, Source, State};
use crate::exchange::Project;
use crate::exchange::frf::{Form, plain_place};
use crate::exchange::project::frf::FrfTable;
use crate::exchange::project::plan;
use crate::math::numerals::counted;
use crate::structure::Structure;
use dashpot_datafiles::{DataFile, Kind, Values};
use std::collections::BTreeMap;
use std::path::Path;

/// Whether a file among them has frequency responses.
pub(super) fn has_responses(request: &Request) -> Result<bool> {
    for file in &request.files {
        if functions(opened(request, file)?.contents(), request).next().is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The project of frequency responses.
pub(super) fn import(request: &Request, out: &Path, control: &Control) -> Result<Imported> {
    let found = project(request, out)?;
    let loaded = found.loaded(out, control)?;
    let by_modes = if found.guessed { driven(&loaded, control) } else { None };
    let Some(at) = by_modes else { return Ok(found.told(&loaded, out)) };
    let mut found = project(&Request { references: vec![at.clone()], ..request.clone() }, out)?;
    found
        .assumed
        .push(format!("by the modes of the model the force acts at DOF {at}; say by --references where it does not"));
    let loaded = found.loaded(out, control)?;
    Ok(found.told(&loaded, out))
}

/// Loss factor of the structure while the place of the force is looked for, which does not depend on it.
const STAND_IN: f64 = 0.01;

/// Label of the DOF at which the only force of functions fits the modes of the model, where there is a model and it does.
fn driven(project: &Project, control: &Control) -> Option<String> {
    let structure = &project.structure;
    structure.matrices()?;
    let whole = Source::candidate(Effect::STAND_IN, Place::Whole(None)).with_coefficient(STAND_IN);
    let sources = [Source { state: State::Known, ..whole }];
    let problem = Problem { structure, sources: &sources, runs: &project.runs };
    // What cannot be compared says nothing of the place.
    place_of_force(&problem, control).ok().flatten().map(|dof| at_node(structure, dof))
}

/// The name of a DOF by its node and axis, such as `10z`, which no number of a DOF can be taken for; else its label.
fn at_node(structure: &Structure, dof: usize) -> String {
    let node = &structure.nodes()[structure.dofs()[dof].node].label;
    let names = ["x", "y", "z"].map(|axis| format!("{node}{axis}"));
    let own = names.into_iter().find(|name| structure.dof(name) == Some(dof));
    own.unwrap_or_else(|| structure.label(dof).to_owned())
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
    guessed: bool,
}

impl Found {
    /// Tables of the measurements under what was assumed.
    fn tables(&self) -> String {
        let comments = self.assumed.iter().map(|what| comment(&format!("Assumed: {what}."))).collect::<String>();
        comments + &self.tables
    }

    fn loaded(&self, out: &Path, control: &Control) -> Result<Project> {
        let text = format!("{}{}", self.head, self.tables());
        plan(&text, out).and_then(|plan| plan.load(control)).map_err(ImportError::Unwritten)
    }

    fn told(self, loaded: &Project, out: &Path) -> Imported {
        let assumed = self.assumed.iter().map(|what| format!("assumed: {what}\n")).collect::<String>();
        let runs = counted(loaded.runs.len(), "run");
        let summary = format!("{assumed}{}, {runs} of one line each, are in {}\n", self.summary, out.display());
        Imported { tables: self.tables(), head: self.head, summary, remarks: loaded.remarks.clone() }
    }
}

/// What the files say of their functions.
struct Said {
    count: usize,
    highest_hz: f64,
    points: Vec<(String, Point)>,
    measured: Vec<Measured>,
    assumed: Vec<String>,
    /// Whether the place of the force is a guess.
    guessed: bool,
}

fn said(request: &Request) -> Result<Said> {
    let files: Vec<DataFile> = request.files.iter().map(|file| opened(request, file)).collect::<Result<_, _>>()?;
    let Labelled { mut measured, mut assumed, guessed } = measured(request, &files)?;
    let (mut names, mut highest_hz, mut count) = (Vec::new(), 0.0_f64, 0);
    for file in &files {
        for channel in functions(file.contents(), request) {
            count += 1;
            let step = channel.axis.step().or(request.step_hz).unwrap_or(0.0);
            highest_hz = highest_hz.max(step * channel.count as f64);
            names.extend(pair(file, channel).into_iter().flatten());
        }
    }
    if let Some(kept) = request.kept.as_ref().filter(|_| request.responses.is_empty()) {
        assumed.extend(at_nodes(&mut measured, &kept.structure()?));
    }
    if measured.iter().any(|one| !one.responses.is_empty()) {
        names = measured.iter().flat_map(|one| one.responses.iter().chain(&one.references)).cloned().collect();
    }
    let points = points(&names, &files)?;
    Ok(Said { count, highest_hz, points, measured: together(measured, &files, request), assumed, guessed })
}

/// The numbers of lists as the DOFs of a beam that they stand for, and how that is said.
fn at_nodes(measured: &mut [Measured], on: &Structure) -> Option<String> {
    let labels = || measured.iter().flat_map(|one| one.responses.iter().chain(&one.references));
    let taken = of_numbers(on, &labels().cloned().collect::<Vec<_>>());
    for one in measured {
        for label in one.responses.iter_mut().chain(&mut one.references) {
            if let Some(taken) = taken.iter().find(|taken| taken.number == *label) {
                label.clone_from(&taken.label);
            }
        }
    }
    said_of_numbers(&taken)
}

/// How numbers are taken, of the first with the number of the others.
fn said_of_numbers(taken: &[Taken]) -> Option<String> {
    let (first, others) = taken.split_first()?;
    Some(if others.is_empty() {
        first.how.clone()
    } else {
        format!("{}, and {} more likewise", first.how, others.len())
    })
}

/// How the points of the files are taken that are called otherwise in the project, and that no template places.
fn said_of_labels(
    request: &Request,
    on: &Structure,
    points: &[(String, Point)],
    dofs: &BTreeMap<String, String>,
) -> Option<String> {
    let own: Vec<String> = points.iter().map(|(_, point)| format!("{}{}", point.node, point.direction)).collect();
    if let Some(said) = said_of_numbers(&of_numbers(on, &own)) {
        return Some(said);
    }
    let plain = |name: &String| name.replace(":+", "").to_lowercase();
    let mut moved = dofs
        .iter()
        .filter(|(name, label)| plain(name) != **label && !is_nowhere(name) && template_label(request, name).is_none());
    let (name, label) = moved.next()?;
    let more = match moved.count() {
        0 => String::new(),
        more => format!(", and {more} more likewise"),
    };
    Some(said_of_axis(name, label) + &more)
}

fn project(request: &Request, out: &Path) -> Result<Found> {
    let Said { count, highest_hz, points, measured, mut assumed, guessed } = said(request)?;
    assumed.extend(nowhere(request, &points).map(|name| {
        format!("the file says no place of its reference {name}: it is taken to act at the first response; correct it under [frf.dofs]")
    }));
    let (labels, dofs) = labelled(request, &points)?;
    if let Some(kept) = &request.kept {
        assumed.extend(said_of_labels(request, &kept.structure()?, &points, &dofs));
    }
    let up_to = if highest_hz > 0.0 { 2.0 * highest_hz } else { 2000.0 };
    let head = head(request, out, &points_structure(&labels), up_to)?;
    let mut tables =
        if request.has_model() && !head.contains("[[source]]") { MATERIAL.to_owned() } else { String::new() };
    for one in &measured {
        let further = one.further.iter().map(|file| named(file, out)).collect::<Result<Vec<_>>>()?;
        tables.push_str(&table(request, &named(&one.path, out)?, &further, one, &dofs));
    }
    let summary = format!("{} at {}", counted(count, "function"), counted(points.len(), "DOF"));
    Ok(Found { head, tables, summary, assumed, guessed })
}

/// Labels of the DOFs, and those of the file that are called otherwise in the project.
fn labelled(request: &Request, points: &[(String, Point)]) -> Result<(Vec<String>, BTreeMap<String, String>)> {
    let own: Vec<String> = points.iter().map(|(_, point)| format!("{}{}", point.node, point.direction)).collect();
    let (mut labels, names): (Vec<String>, Vec<&String>) = if let Some(model) = model(request)? {
        let unsaid = points.iter().filter(|(name, _)| template_label(request, name).is_none() && !is_nowhere(name));
        let wanted: Vec<Point> = unsaid.map(|(_, point)| point.clone()).collect();
        let mut found = places(&wanted, &model)?.into_iter();
        let label = |(name, _): &(String, Point)| match template_label(request, name) {
            Some(_) => String::new(),
            None if is_nowhere(name) => String::new(),
            None => found.next().unwrap_or_default(),
        };
        (points.iter().map(label).collect(), own.iter().collect())
    } else {
        let kept = request.kept.as_ref().map(Kept::structure).transpose()?;
        let only = kept.map(|structure| {
            let numbers = of_numbers(&structure, &own).into_iter().map(|taken| (taken.number, taken.label));
            along_the_only_axis(&structure, &own).into_iter().chain(numbers).collect::<BTreeMap<_, _>>()
        });
        let only = only.unwrap_or_default();
        let label = |own: &String| only.get(own).unwrap_or(own).clone();
        (own.iter().map(label).collect(), points.iter().map(|(name, _)| name).collect())
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

/// The `[[frf]]` of a file.
fn table(
    request: &Request,
    file: &str,
    further: &[String],
    measured: &Measured,
    dofs: &BTreeMap<String, String>,
) -> String {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let list = |labels: &[String]| labels.iter().map(|label| quoted(label)).collect::<Vec<_>>().join(", ");
    let mut text = format!("[[frf]]\nfile = {}\n", quoted(file));
    if !further.is_empty() {
        text.push_str(&format!("further_files = [{}]\n", list(further)));
    }
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
    let of_forces = request.frf.iter().flat_map(|template| &template.reference_dofs);
    let of_forces: BTreeMap<String, String> = of_forces.map(|(name, label)| (name.clone(), label.0.clone())).collect();
    for (title, dofs) in [("dofs", dofs), ("reference_dofs", of_forces)] {
        if !dofs.is_empty() {
            text.push_str(&format!("\n[frf.{title}]\n"));
            dofs.iter().for_each(|(name, label)| text.push_str(&format!("{} = {}\n", quoted(name), quoted(label))));
        }
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
        // `3:S` is a point without a direction.
        let direction = if digits > 0 && direction != "s" { direction } else { String::new() };
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

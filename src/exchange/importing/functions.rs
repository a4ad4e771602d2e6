//! The functions of measurement files and where they were measured: response and reference by what the request says, by what
//! the file says, by names of functions, sets and files.

use super::driving_point::driving_point;
use super::error::{ImportError, Result};
use super::request::Request;
use crate::exchange::frf::{pair_in_name, response_in_name};
use dashpot_datafiles::{Channel, Contents, DataFile, Format, Kind, Set, open, open_paired};
use std::path::{Path, PathBuf};

/// Opens a file, its columns two by two where that is said.
pub(super) fn opened(request: &Request, file: &Path) -> Result<DataFile, dashpot_datafiles::Error> {
    match request.columns {
        Some(pairing) => open_paired(file, pairing),
        None => open(file),
    }
}

/// The functions of a file; complex columns without frequencies too where their step is given.
pub(super) fn functions<'a>(contents: &'a Contents, request: &Request) -> impl Iterator<Item = &'a Channel> {
    contents.sets.iter().flat_map(|set| of_set(set, request))
}

fn of_set<'a>(set: &'a Set, request: &Request) -> impl Iterator<Item = &'a Channel> + use<'a> {
    let wanted = is_wanted(set, request);
    set.channels.iter().filter(move |channel| wanted && has_values(channel))
}

/// Whether channel `channel` of a set is a function.
fn is_function(set: &Set, channel: usize, request: &Request) -> bool {
    is_wanted(set, request) && has_values(&set.channels[channel])
}

fn is_wanted(set: &Set, request: &Request) -> bool {
    set.kind == Kind::Frf || request.step_hz.is_some() && set.kind == Kind::Table
}

fn has_values(channel: &Channel) -> bool {
    channel.complex && channel.count > 0
}

/// A file with responses and the labels of its functions in order, where names and file do not say them.
pub(super) struct Measured {
    pub path: PathBuf,
    /// Files of the same test with further responses to the same reference.
    pub further: Vec<PathBuf>,
    pub responses: Vec<String>,
    pub references: Vec<String>,
}

/// The files with responses, what was assumed of them, and whether the place of the force is no more than a guess.
pub(super) struct Labelled {
    pub measured: Vec<Measured>,
    pub assumed: Vec<String>,
    pub guessed: bool,
}

impl Labelled {
    fn of(measured: Vec<Measured>, how: String) -> Self {
        Self { measured, assumed: vec![how], guessed: false }
    }
}

/// The files with responses; DOFs as they are given, else numbered in order where neither names nor files say them.
pub(super) fn measured(request: &Request, files: &[DataFile]) -> Result<Labelled> {
    let counts: Vec<usize> = files.iter().map(|file| functions(file.contents(), request).count()).collect();
    let named =
        files.iter().all(|file| functions(file.contents(), request).all(|channel| pair(file, channel).is_some()));
    let total: usize = counts.iter().sum();
    let (mut assumed, mut guessed) = (Vec::new(), false);
    let (mut responses, mut references) = (request.responses.clone(), request.references.clone());
    if !named && responses.is_empty() && references.is_empty() {
        let measured = by_names_of_files(files, &counts);
        if !measured.is_empty() {
            let said = |one: &Measured| format!("{} over {}", one.responses[0], one.references[0]);
            let said: Vec<String> = measured.iter().map(said).collect();
            let how = format!("by the names of the files the functions are {}", said.join(", "));
            return Ok(Labelled::of(measured, how));
        }
    }
    if !named
        && responses.is_empty()
        && references.is_empty()
        && let Some((measured, how)) = of_matrix(request, files)
    {
        return Ok(Labelled::of(vec![measured], how));
    }
    if !named && responses.is_empty() {
        let (numbers, how) = numbered(request, files, &counts);
        responses = numbers;
        let mut why = String::new();
        if references.is_empty() {
            let force = force(request, files, &responses)?;
            (references, why, guessed) = (vec![force.at], force.why, force.guessed);
        }
        if references.len() != 1 {
            let problem =
                "neither names nor file say the DOFs of the functions; give them by --responses and --references";
            return Err(ImportError::of(&request.files[0], problem));
        }
        let asked = if guessed {
            ", a guess: several points, or none, have the signs of a driving point; say by --references which it is"
        } else {
            ""
        };
        assumed.push(format!("{how}{why}, all driven at {}{asked}", references[0]));
    }
    // One list for all files one after the other, or the same list for each.
    let in_turn = references.len() == 1 && responses.len() == total && files.len() > 1;
    let mut from = 0;
    let mut measured = Vec::new();
    for (file, count) in files.iter().zip(counts).filter(|(_, count)| *count > 0) {
        let own = if in_turn { responses[from..from + count].to_vec() } else { responses.clone() };
        from += count;
        let (path, further) = (file.path().to_owned(), Vec::new());
        measured.push(Measured { path, further, responses: own, references: references.clone() });
    }
    Ok(Labelled { measured, assumed, guessed })
}

/// Where the only force of functions acts.
struct Force {
    at: String,
    why: String,
    guessed: bool,
}

/// Where the force acts that no pair of names says: where the file says it of every function, else at the response with the
/// signs of a driving point, else at the first one, which is a guess.
fn force(request: &Request, files: &[DataFile], responses: &[String]) -> Result<Force> {
    let all = || files.iter().flat_map(|file| functions(file.contents(), request));
    let stated: Option<Vec<&str>> = all().map(|channel| channel.attribute("reference")).collect();
    if let Some([first, others @ ..]) = stated.as_deref()
        && others.iter().all(|other| other == first)
        && let Some(at) = label_in(first)
    {
        return Ok(Force { at, why: String::new(), guessed: false });
    }
    let driven = driving_point(files, |set, channel| is_function(set, channel, request))?;
    let why = if driven.is_some() { ", of which one has the signs of a driving point" } else { "" }.to_owned();
    Ok(Force { at: responses[driven.unwrap_or(0)].clone(), why, guessed: driven.is_none() && responses.len() > 1 })
}

/// Label of the place in a name, such as `2z` of `Point_02Z`.
fn label_in(name: &str) -> Option<String> {
    let label: String = response_in_name(name)?.chars().filter(char::is_ascii_alphanumeric).collect();
    let digits = label.find(|c: char| !c.is_ascii_digit()).unwrap_or(label.len());
    let node = label[..digits].trim_start_matches('0');
    let label = format!("{}{}", if node.is_empty() { "0" } else { node }, label[digits..].to_lowercase());
    Some(label).filter(|label| place_like(label))
}

/// The same with files of one test together: those with responses to the same single reference on the same frequencies. Each
/// line then is one run of all sensors, not one of a sensor alone.
pub(super) fn together(measured: Vec<Measured>, files: &[DataFile], request: &Request) -> Vec<Measured> {
    let mut tests: Vec<(Measured, Option<Layout>)> = Vec::new();
    for one in measured {
        let file = files.iter().find(|file| file.path() == one.path);
        let layout = file.and_then(|file| layout(&one, file, request));
        let same = |(_, known): &&mut (Measured, Option<Layout>)| match (known, &layout) {
            (Some(known), Some(layout)) => known.takes(layout),
            _ => false,
        };
        match (tests.iter_mut().find(same), layout) {
            (Some((test, Some(known))), Some(layout)) => {
                test.further.push(one.path);
                test.responses.extend(one.responses);
                known.responses.extend(layout.responses);
            }
            (_, layout) => tests.push((one, layout)),
        }
    }
    tests.into_iter().map(|(test, _)| test).collect()
}

/// What decides whether files are one test.
struct Layout {
    reference: String,
    responses: Vec<String>,
    frequencies: Vec<f64>,
    /// Whether lists name the DOFs.
    listed: bool,
}

impl Layout {
    fn takes(&self, other: &Self) -> bool {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * a.abs().max(1e-9);
        self.reference == other.reference
            && self.listed == other.listed
            && self.frequencies.len() == other.frequencies.len()
            && self.frequencies.iter().zip(&other.frequencies).all(near)
            && other.responses.iter().all(|response| !self.responses.contains(response))
    }
}

/// The layout of a file with responses to one reference; none where it has several, or frequencies that it does not say.
fn layout(one: &Measured, file: &DataFile, request: &Request) -> Option<Layout> {
    let listed = !one.responses.is_empty();
    let pairs: Vec<[String; 2]> = match &one.references[..] {
        [reference] if listed => one.responses.iter().map(|response| [response.clone(), reference.clone()]).collect(),
        _ if listed => return None,
        _ => functions(file.contents(), request).map(|channel| pair(file, channel)).collect::<Option<_>>()?,
    };
    let reference = pairs.first()?[1].clone();
    let alone = pairs.iter().all(|pair| pair[1] == reference);
    let sets = file.contents().sets.iter().enumerate();
    let (set, channel) = sets.into_iter().find_map(|(s, set)| {
        let wanted = of_set(set, request).next()?;
        Some((s, set.channels.iter().position(|channel| std::ptr::eq(channel, wanted))?))
    })?;
    let frequencies = file.axis(set, channel).ok()??;
    let responses = pairs.into_iter().map(|[response, _]| response).collect();
    alone.then_some(Layout { reference, responses, frequencies, listed })
}

/// Files of one function each whose names hold response and reference, such as `H_7z_19z.csv`; none where one has not.
fn by_names_of_files(files: &[DataFile], counts: &[usize]) -> Vec<Measured> {
    let own = |file: &DataFile| {
        let stem = file.path().file_stem()?.to_string_lossy().into_owned();
        let [response, reference] = pair_in_name(&stem)?.map(|place| place.to_lowercase());
        // Other names hold two numbers too: dates, counts.
        let directed = |place: &str| place_like(place) && !place.ends_with(|c: char| c.is_ascii_digit());
        let word = stem.split(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or_default().to_lowercase();
        let function =
            ["h", "frf", "tf"].contains(&word.as_str()) && [&response, &reference].iter().all(|p| place_like(p));
        (function || directed(&response) && directed(&reference)).then(|| Measured {
            path: file.path().to_owned(),
            further: Vec::new(),
            responses: vec![response],
            references: vec![reference],
        })
    };
    let functions = files.iter().zip(counts).filter(|(_, count)| **count > 0);
    let found: Option<Vec<Measured>> = functions.map(|(file, count)| own(file).filter(|_| *count == 1)).collect();
    found.unwrap_or_default()
}

/// Responses and references of one file whose functions are named as elements of a matrix of one figure each, `H11`, `H21`,
/// `H12`, ...: all responses to the first reference first, a driving point among them. None where the names are others.
fn of_matrix(request: &Request, files: &[DataFile]) -> Option<(Measured, String)> {
    let [file] = files else { return None };
    let pairs: Vec<[String; 2]> =
        functions(file.contents(), request).map(|channel| element(&channel.name)).collect::<Option<_>>()?;
    let (responses, references) = (each_once(&pairs, 0), each_once(&pairs, 1));
    let all = references.iter().flat_map(|reference| responses.iter().map(move |response| [response, reference]));
    let in_order = pairs.iter().map(|[response, reference]| [response, reference]).eq(all);
    let driven = pairs.iter().any(|[response, reference]| response == reference);
    let how = format!(
        "by their names, elements of a matrix, the functions are {} over {}",
        responses.join(", "),
        references.join(", ")
    );
    let (path, further) = (file.path().to_owned(), Vec::new());
    (in_order && driven).then_some((Measured { path, further, responses, references }, how))
}

/// The labels on one side of pairs, each once, in their order.
fn each_once(pairs: &[[String; 2]], side: usize) -> Vec<String> {
    let mut labels: Vec<String> = Vec::new();
    for pair in pairs {
        if !labels.contains(&pair[side]) {
            labels.push(pair[side].clone());
        }
    }
    labels
}

/// Row and column of an element of a matrix such as `H21`; of more figures they could not be told.
fn element(name: &str) -> Option<[String; 2]> {
    let digits = name.find(|c: char| c.is_ascii_digit())?;
    let (word, figures) = name.split_at(digits);
    let word = word.trim_end_matches(['_', ' ']).to_lowercase();
    let two = figures.len() == 2 && figures.chars().all(|c| matches!(c, '1'..='9'));
    (["h", "frf", "tf"].contains(&word.as_str()) && two).then(|| [0, 1].map(|i| figures[i..=i].to_owned()))
}

/// Labels of responses whose references nothing says: by the numbers in the names of the functions, of their sets, of the
/// files, else in their order; and how that is said.
fn numbered(request: &Request, files: &[DataFile], counts: &[usize]) -> (Vec<String>, String) {
    let functions = |file| functions_with_sets(file, request);
    let by_name: Vec<Option<String>> =
        files.iter().flat_map(functions).map(|(_, channel)| label_in(&channel.name)).collect();
    let by_set: Vec<Option<String>> = files.iter().flat_map(functions).map(|(set, _)| label_in(set)).collect();
    let one_each = counts.iter().all(|count| *count < 2);
    let measured = files.iter().zip(counts).filter(|(_, count)| **count > 0);
    let by_file: Vec<Option<String>> = measured
        .map(|(file, _)| label_in(&file.path().file_stem().unwrap_or_default().to_string_lossy()).filter(|_| one_each))
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

/// Names of response and reference of a function. Universal Files state them; elsewhere the name of the channel may.
pub(super) fn pair(file: &DataFile, channel: &Channel) -> Option<[String; 2]> {
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

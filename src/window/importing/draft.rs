//! Files that were read, and what is decided of them so far.

use super::preview::Preview;
use crate::exchange::frf::Form;
use crate::exchange::importing::files::{listed, may_be_measurement};
use crate::exchange::importing::{Functions, Holds, Request, look};
use crate::exchange::mapping::{ChannelTable, Proposal};
use crate::measurement::Quantity;
use crate::window::background::cache::Cache;
use dashpot_datafiles::{DataFile, Kind, open};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The project that is open while files are imported.
#[derive(Debug, Clone, Default)]
pub struct OpenProject {
    /// Its file, where it has one.
    pub path: Option<PathBuf>,
    /// Labels of its DOFs.
    pub dofs: Vec<String>,
    /// How it reads its channels.
    pub channels: Vec<ChannelTable>,
}

/// A file that was opened, or why it cannot be.
#[derive(Debug, Clone)]
pub struct Opened {
    /// Its name without folders.
    pub name: String,
    /// What is in it.
    pub file: Result<Arc<DataFile>, String>,
}

/// A channel of the files and what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelRow {
    /// Whether it is imported.
    pub used: bool,
    /// What it is.
    pub table: ChannelTable,
    /// What was assumed, or why nothing is proposed.
    pub note: String,
}

/// A DOF of frequency responses and its label.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceRow {
    /// As the files call it.
    pub name: String,
    /// Label in the project.
    pub label: String,
    /// Whether it is measured against the direction of the DOF.
    pub reversed: bool,
}

/// What is decided of the measurements.
#[derive(Debug, Clone, PartialEq)]
pub enum Decided {
    /// Channels of records.
    Channels(Vec<ChannelRow>),
    /// Frequency responses.
    Responses(Responses),
    /// A stepped-sine table: in words, and what was assumed.
    Stepped(String, Vec<String>),
    /// Nothing can be imported, for the reason.
    Nothing(String),
}

/// Frequency responses and where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Responses {
    /// Number of functions.
    pub count: usize,
    /// DOFs that the files name.
    pub places: Vec<PlaceRow>,
    /// Labels of the responses in the order of the functions, with commas, where the files name none.
    #[allow(clippy::struct_field_names, reason = "what they are called")]
    pub responses: String,
    /// Labels of the references then.
    pub references: String,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// What they relate; as their units say where it is none.
    pub form: Option<Form>,
    /// Averages, 0 where they are not known.
    pub averages: usize,
}

/// Files on their way into a project.
#[derive(Debug)]
pub struct Draft {
    /// Files as they were opened.
    pub files: Vec<Opened>,
    /// What is asked for so far.
    pub request: Request,
    /// What is decided.
    pub decided: Decided,
    /// As it was proposed.
    pub proposed: Decided,
    /// Whether the files do not say the time between samples.
    pub needs_sampling: bool,
    /// The open project.
    pub open: Option<OpenProject>,
    /// Whether the measurements go into the open project.
    pub into: bool,
    /// Name of the project that is made otherwise.
    pub target: String,
    /// Channel that is drawn: file, set, channel.
    pub looked_at: Option<(usize, usize, usize)>,
    /// Sets whose channels are listed: file, set.
    pub unfolded: BTreeSet<(usize, usize)>,
    /// Its plot.
    pub preview: Cache<(usize, usize, usize), Preview>,
    /// Whether the mapping of the open project says all of the files.
    pub fits: bool,
}

impl Draft {
    /// Reads what the files at `paths` hold; those of a finite-element model are taken as such.
    ///
    /// # Errors
    /// One line, where nothing can be read at all.
    pub fn of(paths: &[PathBuf], open: Option<OpenProject>) -> Result<Self, String> {
        let files = listed(paths).map_err(|e| e.to_string())?;
        let mut request = Request::of(files);
        if request.files.is_empty() {
            return Err("There is no measurement among these files; give one together with the model.".to_owned());
        }
        request.files.retain(|file| !paths.iter().any(|path| path.is_dir()) || may_be_measurement(file));
        if request.files.is_empty() {
            return Err(format!("{}: the folder has no file of measurements", paths[0].display()));
        }
        Self::by(request, open)
    }

    /// Reads the files of a request.
    ///
    /// # Errors
    /// One line, where no file can be read.
    pub fn by(mut request: Request, project: Option<OpenProject>) -> Result<Self, String> {
        let files: Vec<Opened> = request.files.iter().map(|path| opened(path)).collect();
        if let (true, Some(Err(error))) = (files.iter().all(|file| file.file.is_err()), files.first().map(|f| &f.file))
        {
            return Err(error.clone());
        }
        let fits = project.as_ref().is_some_and(|project| fitting(&files, &project.channels));
        if fits && request.channels.is_none() {
            request.channels = project.as_ref().map(|project| project.channels.clone());
        }
        let (decided, needs_sampling) = match look(&request) {
            Ok(holds) => decided(holds),
            Err(error) => (Decided::Nothing(error.to_string()), false),
        };
        let looked_at = first_channel(&files);
        let unfolded = looked_at.map(|(file, set, _)| (file, set)).into_iter().collect();
        let target = free_name(&request.files[0]).display().to_string();
        let mut draft = Self {
            files,
            request,
            proposed: decided.clone(),
            decided,
            needs_sampling,
            into: false,
            open: project,
            target,
            looked_at,
            unfolded,
            preview: Cache::of_last("Drawing a channel"),
            fits,
        };
        draft.into = draft.open.is_some() && draft.request.mass.is_none() && draft.unknown_dof().is_none();
        draft.fits &= draft.into && !draft.needs_sampling;
        Ok(draft)
    }

    /// Whether the measurements go into the open project.
    pub fn into_open(&self) -> bool {
        self.into && self.open.is_some()
    }
}

fn opened(path: &Path) -> Opened {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
    Opened { name, file: open(path).map(Arc::new).map_err(|e| e.to_string()) }
}

/// Whether every file has every channel of a mapping.
fn fitting(files: &[Opened], channels: &[ChannelTable]) -> bool {
    let has = |file: &Opened, table: &ChannelTable| {
        let Ok(file) = &file.file else { return false };
        let sets = file.contents().sets.iter().filter(|set| table.set.as_ref().is_none_or(|name| *name == set.name));
        sets.flat_map(|set| &set.channels).any(|channel| channel.name == table.name)
    };
    !channels.is_empty() && files.iter().all(|file| channels.iter().all(|table| has(file, table)))
}

/// The first channel that has values: of what was measured, before geometry and tables.
fn first_channel(files: &[Opened]) -> Option<(usize, usize, usize)> {
    let first = |wanted: &dyn Fn(Kind) -> bool| {
        files.iter().enumerate().find_map(|(f, opened)| {
            let sets = &opened.file.as_ref().ok()?.contents().sets;
            let channel_of_set = |(s, set): (usize, &dashpot_datafiles::Set)| {
                set.channels.iter().position(|channel| channel.count > 1).map(|c| (f, s, c))
            };
            sets.iter().enumerate().filter(|(_, set)| wanted(set.kind)).find_map(channel_of_set)
        })
    };
    first(&|kind| matches!(kind, Kind::Time | Kind::Frf)).or_else(|| first(&|_| true))
}

/// A name beside a file that is not taken.
fn free_name(file: &Path) -> PathBuf {
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let first = file.with_extension("toml");
    let stem = file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let numbered = (2..1000).map(|k| file.with_file_name(format!("{stem}-{k}.toml")));
    std::iter::once(first.clone()).chain(numbered).find(|path| !path.exists()).unwrap_or(first)
}

fn decided(holds: Holds) -> (Decided, bool) {
    match holds {
        Holds::Records(proposal) => {
            let needs = proposal.needs_sampling;
            (Decided::Channels(rows(proposal)), needs)
        }
        Holds::Responses(functions) => (Decided::Responses(responses(functions)), false),
        Holds::Stepped(table) => (Decided::Stepped(table.words(), table.assumed), false),
    }
}

/// Rows of the channels: mapped, in the unit of a sensor, not mapped.
fn rows(proposal: Proposal) -> Vec<ChannelRow> {
    let assumed = |table: &ChannelTable| {
        let own = proposal.assumed.iter().filter(|(name, _)| *name == table.channel()).map(|(_, what)| what.as_str());
        own.collect::<Vec<_>>().join("; ")
    };
    // Without any motion or force that is told, what moves in the unit of its sensor is taken.
    let alone = proposal.channels.is_empty();
    let mapped = proposal.channels.iter().map(|table| (true, table));
    let uncalibrated = proposal.uncalibrated.iter().map(|table| (alone, table));
    let row = |(used, table): (bool, &ChannelTable)| ChannelRow { used, table: table.clone(), note: assumed(table) };
    let mut rows: Vec<ChannelRow> = mapped.chain(uncalibrated).map(row).collect();
    rows.extend(proposal.left.iter().map(|(name, why)| ChannelRow {
        used: false,
        table: ChannelTable {
            name: name.clone(),
            set: None,
            quantity: Quantity::Acceleration,
            dof: String::new(),
            unit: None,
            sign: None,
            factor: None,
            delay: None,
            optional: false,
        },
        note: why.to_string(),
    }));
    rows
}

fn responses(functions: Functions) -> Responses {
    let Functions { count, dofs, responses, references, assumed } = functions;
    let unnamed = !responses.is_empty();
    let place = |(name, label)| PlaceRow { name, label, reversed: false };
    let places = if unnamed { Vec::new() } else { dofs.into_iter().map(place).collect() };
    let (responses, references) = (responses.join(", "), references.join(", "));
    Responses { count, places, responses, references, assumed, form: None, averages: 0 }
}

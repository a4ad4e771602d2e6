//! Two states of a structure, to be held against each other: two projects, or two sessions of one.

use crate::control::Control;
use crate::effects::State;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::identify::Measurements;
use crate::identify::change::{Change, ChangeError, Condition, change};
use crate::structure::Structure;
use std::path::PathBuf;

/// What a project is held against.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Against {
    /// The project of an earlier state.
    Project(PathBuf),
    /// Its own runs of two sessions, the earlier first.
    Sessions([String; 2]),
}

/// What changed, with the names that it takes to say it.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Titles of the first and the second state.
    pub titles: [String; 2],
    /// Structure of the first state, whose DOFs the sources act on.
    pub structure: Structure,
    /// What changed.
    pub change: Change,
}

/// The first and the second state of a project.
///
/// # Errors
/// One line: the other project cannot be read, or a session has no runs.
pub fn states(project: &Project, against: &Against, control: &Control) -> Result<[Project; 2], String> {
    match against {
        Against::Project(path) => Ok([load(path, control).map_err(|e| e.to_string())?, project.clone()]),
        Against::Sessions([first, second]) => Ok([of_session(project, first)?, of_session(project, second)?]),
    }
}

/// Identifies both states and says what changed; long work.
///
/// # Errors
/// As [`change`].
pub fn compare(mut states: [Project; 2], control: &Control) -> Result<Compared, ChangeError> {
    // A truth that is kept beside the result is no part of it.
    states.iter_mut().for_each(|p| p.sources.retain(|s| s.state != State::Reference));
    let change = change([condition(&states[0]), condition(&states[1])], control)?;
    let titles = [&states[0], &states[1]].map(|p| p.title.clone());
    let [first, _] = states;
    Ok(Compared { titles, structure: first.structure, change })
}

fn condition(project: &Project) -> Condition<'_> {
    let measured = Measurements { runs: &project.runs, transient_runs: &project.transient_runs, ratios: &[] };
    Condition { structure: &project.structure, sources: &project.sources, measured, settings: &project.settings }
}

/// Names of the sessions of a project's runs, in the order of the runs.
pub fn sessions(project: &Project) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in project.runs.iter().filter_map(|r| r.session.as_ref()) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

fn of_session(project: &Project, name: &str) -> Result<Project, String> {
    let mut part = project.clone();
    part.title = format!("{}, session {name}", project.title);
    part.runs.retain(|r| r.session.as_deref() == Some(name));
    part.transient_runs.clear();
    if part.runs.is_empty() {
        let names = sessions(project);
        let known =
            if names.is_empty() { "none: add session = \"...\" to its runs".to_owned() } else { names.join(", ") };
        return Err(format!("no run is of session \"{name}\"; the project has {known}"));
    }
    Ok(part)
}

//! Command scripts: a JSON list of commands, with `"undo"` and `"redo"` as words of their own.

use super::command::Command;
use super::refusal::Refusal;
use super::session::Session;
use serde::{Deserialize, Serialize};

/// One line of a script.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ScriptStep {
    /// Back or forth in the history.
    History(Move),
    /// A change of the document.
    Change(Box<Command>),
}

/// A move in the history.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Move {
    Undo,
    Redo,
}

/// A script that cannot be played.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ScriptError {
    #[error("step {step} of the script is no command: {reason}")]
    NotACommand { step: usize, reason: String },
    #[error("the script is not a JSON list of commands: line {line}: {reason}")]
    NotAList { line: usize, reason: String },
    #[error("step {step} of the script ({label}) was refused: {reason}")]
    Refused { step: usize, label: String, reason: Box<Refusal> },
    #[error("step {step} of the script: there is nothing to {what}")]
    NothingThere { step: usize, what: &'static str },
}

/// Reads a script.
///
/// # Errors
/// [`ScriptError`] with the number of the step, from 1.
pub fn parse(text: &str) -> Result<Vec<ScriptStep>, ScriptError> {
    let values: Vec<serde_json::Value> = serde_json::from_str(text)
        .map_err(|error| ScriptError::NotAList { line: error.line(), reason: error.to_string() })?;
    values.into_iter().enumerate().map(|(index, value)| step(index + 1, value)).collect()
}

/// A word is a move, an object a command: the reason of what is wrong is then that of the one meant.
fn step(step: usize, value: serde_json::Value) -> Result<ScriptStep, ScriptError> {
    let wrong = |error: serde_json::Error| ScriptError::NotACommand { step, reason: error.to_string() };
    if value.is_string() {
        return Ok(ScriptStep::History(serde_json::from_value(value).map_err(wrong)?));
    }
    Ok(ScriptStep::Change(Box::new(serde_json::from_value(value).map_err(wrong)?)))
}

/// Plays a script and returns the labels of what was done.
///
/// # Errors
/// [`ScriptError`] at the first step that is refused; what was done before it stays done.
pub fn play(session: &mut Session, script: &[ScriptStep]) -> Result<Vec<String>, ScriptError> {
    script.iter().enumerate().map(|(index, step)| play_step(session, index + 1, step)).collect()
}

fn play_step(session: &mut Session, step: usize, what: &ScriptStep) -> Result<String, ScriptError> {
    let moved = |label: Option<String>, what: &'static str| match label {
        Some(label) => Ok(format!("{what} {label}")),
        None => Err(ScriptError::NothingThere { step, what }),
    };
    match what {
        ScriptStep::History(Move::Undo) => moved(session.undo(), "undo"),
        ScriptStep::History(Move::Redo) => moved(session.redo(), "redo"),
        ScriptStep::Change(command) => {
            let label = command.label();
            let refused = |reason| ScriptError::Refused { step, label: label.clone(), reason: Box::new(reason) };
            session.apply(command).map_err(refused)?;
            Ok(label)
        }
    }
}

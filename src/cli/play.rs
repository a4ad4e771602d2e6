//! `dashpot run`: the commands of a script, one after the other, as clicks in the window would do them.

use super::arguments::Run;
use crate::session::Session;
use crate::session::save::text_after;
use crate::session::script::{parse, play};
use anyhow::Context;

/// Plays the script on the project; what was done goes to standard error, the project to `--out` or to standard output.
pub(super) fn run(arguments: &Run) -> anyhow::Result<String> {
    let script = || arguments.script.display().to_string();
    let text = std::fs::read_to_string(&arguments.script).with_context(|| format!("{}: cannot be read", script()))?;
    let steps = parse(&text).with_context(script)?;
    let mut session = Session::open(&arguments.file)?;
    let labels = play(&mut session, &steps).with_context(script)?;
    for (number, label) in labels.iter().enumerate() {
        eprintln!("{} {label}", number + 1);
    }
    let Some(out) = &arguments.out else { return Ok(text_after(session.document().file(), Some(&arguments.file))?) };
    session.save_as(out)?;
    Ok(String::new())
}

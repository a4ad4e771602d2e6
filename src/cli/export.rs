//! `dashpot export`: identified matrices and sources in the format of another program.

use super::arguments::Export;
use super::identify::identified;
use crate::exchange::export::write_outcome;

pub(super) fn run(arguments: &Export) -> anyhow::Result<String> {
    let (project, outcome) = identified(&arguments.file, None)?;
    let written = write_outcome(&project, &outcome, arguments.to, &arguments.out)?;
    for warning in &written.warnings {
        eprintln!("warning: {warning}");
    }
    Ok(written.paths.iter().map(|path| format!("{}\n", path.display())).collect())
}

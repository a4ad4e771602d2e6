//! Frequency responses of a project, read and made runs of.

use super::error::{ProjectError, TableProblem};
use super::plan::Plan;
use crate::control::Control;
use crate::exchange::frf::read_test;
use crate::measurement::frf::ChosenRuns;
use std::path::Path;

impl Plan {
    /// Reads the frequency responses of table number `index` and makes runs of their most informative lines.
    ///
    /// # Errors
    /// [`ProjectError`] with the line of the table, the file and the set.
    pub fn frf(&self, index: usize, control: &Control) -> Result<ChosenRuns, ProjectError> {
        let table = &self.file.frf[index];
        let wrong = |problem| self.error(self.lines.of("[[frf]]", index, ""), problem);
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let files: Vec<&String> = table.files().collect();
        if let Some(missing) = files.iter().find(|file| !folder.join(file).is_file()) {
            return Err(wrong(TableProblem::NoRecord { file: (*missing).clone() }));
        }
        let (set, faults) = read_test(folder, &files, &table.source(), &self.structure, control)
            .map_err(|error| wrong(TableProblem::Frf(Box::new(error))))?;
        let mut chosen = set.runs(table.selection(), table.enabled, &self.corrections());
        if chosen.runs.is_empty() {
            return Err(wrong(TableProblem::NoLines { file: table.file.clone() }));
        }
        chosen.remarks.extend(faults);
        Ok(chosen)
    }
}

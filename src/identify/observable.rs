//! Which columns the sensors see at all, and whether anything was put in.

use super::error::IdentifyError;
use super::problem::Problem;
use super::state::IdentificationState;
use crate::balance::energy::is_observable;

impl Problem<'_> {
    /// Leaves out columns whose motion is not known in every run.
    pub(super) fn drop_unobservable(&mut self, state: &IdentificationState) -> Result<(), IdentifyError> {
        let method = self.expander.method();
        for source in self.known.iter().filter(|s| s.effect.dissipates() && !is_observable(s, &state.runs, method)) {
            let name = source.phrase(self.structure);
            self.warnings.push(format!(
                "{name} is known, but its motion is not measured, so its energy is not subtracted in full"
            ));
        }
        let keep: Vec<bool> = self.columns.iter().map(|c| is_observable(c, &state.runs, method)).collect();
        if keep.iter().all(|k| *k) {
            return check_input(state);
        }
        if let Some(&j) = self.forced.iter().find(|&&j| !keep[j]) {
            let source_name = self.columns[j].phrase(self.structure);
            let reason = "its motion is not measured in every run".to_string();
            return Err(IdentifyError::ForcedImpossible { source_name, reason });
        }
        let left_out = keep.iter().filter(|k| !**k).count();
        self.warnings.push(format!("{left_out} candidates are left out: their motion is not measured in every run"));
        let forced: Vec<usize> = self.forced.iter().map(|&j| self.column_source[j]).collect();
        let mut flags = keep.iter();
        self.columns.retain(|_| *flags.next().unwrap_or(&false));
        let mut flags = keep.iter();
        self.column_source.retain(|_| *flags.next().unwrap_or(&false));
        self.forced = (0..self.columns.len()).filter(|&j| forced.contains(&self.column_source[j])).collect();
        self.windows.retain(&keep);
        if self.columns.is_empty() {
            return Err(IdentifyError::NoCandidates);
        }
        check_input(state)
    }
}

fn check_input(state: &IdentificationState) -> Result<(), IdentifyError> {
    let steady = &state.equation.input[..state.runs.len()];
    if !steady.is_empty() && steady.iter().all(|&e| e <= 0.0) { Err(IdentifyError::NoInput) } else { Ok(()) }
}

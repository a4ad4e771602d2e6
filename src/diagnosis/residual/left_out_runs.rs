//! Data without the runs that do not fit the others.

use super::data::Data;

/// Fewest runs that stay.
const FEWEST: usize = 6;
/// Of how many runs one may be left out beside others.
const ONE_IN: usize = 8;

impl Data {
    /// The same without the runs of these numbers of the project.
    pub(crate) fn without_runs(&self, numbers: &[usize]) -> Self {
        let kept: Vec<usize> = (0..self.runs.len()).filter(|&r| !numbers.contains(&self.runs[r].index)).collect();
        let runs = kept.iter().map(|&r| self.runs[r].clone()).collect();
        let sessions = kept.iter().filter_map(|&r| self.sessions.get(r).copied()).collect();
        let left_out = self.left_out + self.runs.len() - kept.len();
        Self { runs, left_out, sessions, ..self.clone() }
    }

    /// Whether so many `more` runs may be left out: of a few one, of many one in eight.
    pub(crate) fn may_leave_out(&self, more: usize) -> bool {
        let (all, left_out) = (self.runs.len() + self.left_out, self.left_out + more);
        !self.per_unit_force && self.runs.len() >= FEWEST + more && (left_out == 1 || ONE_IN * left_out <= all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::residual::data::RunData;

    #[test]
    fn of_few_runs_one_may_be_left_out_and_of_many_one_in_eight() {
        let run = |index: usize| RunData {
            index,
            omega: 1.0,
            harmonics: 0,
            forces: Vec::new(),
            responses: Vec::new(),
            alive: Vec::new(),
            on_moving_base: false,
        };
        let all = Data { runs: (10..26).map(run).collect(), sessions: (0..16).collect(), ..Data::default() };
        let less = all.without_runs(&[11, 13]);
        assert_eq!((less.runs[1].index, less.sessions[1], less.runs.len(), less.left_out), (12, 2, 14, 2));
        let may = [&all, &all.without_runs(&[11]), &less].map(|data| data.may_leave_out(1));
        assert_eq!((may, all.may_leave_out(2), all.may_leave_out(3)), ([true, true, false], true, false));
        assert!(!Data { runs: (0..6).map(run).collect(), ..Data::default() }.may_leave_out(1));
    }
}

//! Windows of records that are not steady as rows beside those of the steady runs: raw for what is told of energies, whitened
//! by their covariance for the solution.

use super::error::IdentifyError;
use super::system::System;
use crate::balance::EnergyEquation;
use crate::balance::windows::{WindowRows, window_rows};
use crate::control::Control;
use crate::effects::Source;
use crate::math::fill::filled;
use crate::measurement::TransientRun;
use crate::structure::Structure;
use faer::Mat;

/// Relative error that the energies are taken to have where the noise of the steady runs is not known.
const UNKNOWN: f64 = 0.01;
/// Groups of neighbouring windows that a record is left out in, one at a time.
const GROUPS: usize = 5;

/// Rows of all records in use.
#[derive(Debug, Clone, Default)]
pub(crate) struct WindowColumns {
    /// Index of each record among the runs that are not steady.
    pub record: Vec<usize>,
    /// Its rows.
    pub rows: Vec<WindowRows>,
    whitened: Vec<(Mat<f64>, Vec<f64>)>,
}

impl WindowColumns {
    /// Of every record that is enabled.
    pub(super) fn new(
        structure: &Structure,
        known: &[Source],
        columns: &[Source],
        runs: &[TransientRun],
        control: &Control,
    ) -> Result<Self, IdentifyError> {
        let record: Vec<usize> = (0..runs.len()).filter(|&r| runs[r].enabled).collect();
        let used: Vec<&TransientRun> = record.iter().map(|&r| &runs[r]).collect();
        let rows = window_rows(structure, known, columns, &used, control)?;
        Ok(Self { record, whitened: rows.iter().map(WindowRows::whitened).collect(), rows })
    }

    /// Number of windows.
    pub(super) fn len(&self) -> usize {
        self.rows.iter().map(WindowRows::len).sum()
    }

    /// Whether no record is used.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Keeps some of the columns.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        let kept: Vec<usize> = (0..keep.len()).filter(|&j| keep[j]).collect();
        let part = |g: &Mat<f64>| Mat::from_fn(g.nrows(), kept.len(), |i, j| g[(i, kept[j])]);
        self.rows.iter_mut().for_each(|rows| rows.g = part(&rows.g));
        self.whitened.iter_mut().for_each(|(a, _)| *a = part(a));
    }

    /// The energies of the windows behind those of the steady runs.
    pub(super) fn behind(&self, equation: EnergyEquation) -> EnergyEquation {
        if self.is_empty() {
            return equation;
        }
        let EnergyEquation { g, mut e, mut input } = equation;
        let steady = e.len();
        let (mut matrices, mut place) = (Vec::new(), Vec::new());
        for (k, rows) in self.rows.iter().enumerate() {
            e.extend(&rows.e);
            input.extend(&rows.input);
            matrices.push(&rows.g);
            place.extend((0..rows.len()).map(|i| (k, i)));
        }
        let columns = matrices.first().map_or(g.ncols(), |first| first.ncols());
        let entry = |i: usize, j: usize| match i.checked_sub(steady) {
            None => g[(i, j)],
            Some(at) => matrices[place[at].0][(place[at].1, j)],
        };
        EnergyEquation { g: filled(e.len(), columns, entry), e, input }
    }

    /// Energy of known source number `source` in every window, J.
    pub(super) fn known(&self, source: usize) -> impl Iterator<Item = f64> + '_ {
        self.rows.iter().flat_map(move |rows| (0..rows.len()).map(move |i| rows.known[(i, source)]))
    }

    /// The system with the whitened rows of the columns of `set` behind its own.
    pub(super) fn append(&self, system: System, set: &[usize]) -> System {
        if self.is_empty() {
            return system;
        }
        let factor = if system.deviation.is_some() { 1.0 } else { UNKNOWN };
        let first = system.rows();
        let mut next = system.run.last().map_or(0, |r| r + 1);
        let mut extended = System { a: Mat::new(), ..system };
        let mut place = Vec::new();
        for (k, (_, b)) in self.whitened.iter().enumerate() {
            for (i, value) in b.iter().enumerate() {
                extended.b.push(factor * value);
                extended.run.push(next + i * GROUPS / b.len());
                place.push((k, i));
                if let Some(deviations) = &mut extended.deviation {
                    deviations.push(1.0);
                }
            }
            next += GROUPS;
        }
        extended.a = filled(extended.b.len(), set.len(), |i, j| match i.checked_sub(first) {
            None => system.a[(i, j)],
            Some(at) => factor * self.whitened[place[at].0].0[(place[at].1, set[j])],
        });
        extended
    }
}

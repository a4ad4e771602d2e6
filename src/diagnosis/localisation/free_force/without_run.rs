//! The same places seen from all runs but one, or with one run misread by a factor.

use super::{Cell, OnceLock, Placing, Screen, c64};

impl Screen {
    /// What all runs but number `run` say of the places.
    pub(crate) fn without_run(&self, run: usize) -> Self {
        let mut cells = self.cells.clone();
        cells.remove(run);
        self.of_cells(cells, self.reference.clone(), 0)
    }

    /// The same places where the fundamentals of the channels of `spots` are misread in number `run` by one free factor, which is the last
    /// of the parameters; its higher harmonics count for nothing. None where it has no fundamentals.
    pub(crate) fn with_run_misread(&self, run: usize, spots: &[usize]) -> Option<Self> {
        let mut cells = self.cells.clone();
        cells[run].truncate(1);
        let cell = cells[run].first_mut()?;
        let zero = c64::new(0.0, 0.0);
        let mut column = vec![zero; cell.residual.len()];
        for &spot in spots {
            column.iter_mut().zip(&cell.columns[spot]).for_each(|(sum, a)| *sum += a);
        }
        cell.slopes.resize(self.reference.len(), vec![zero; column.len()]);
        cell.slopes.push(column);
        cell.gram = OnceLock::new();
        let reference = self.reference.iter().copied().chain([0.0]).collect();
        Some(self.of_cells(cells, reference, 1))
    }

    fn of_cells(&self, cells: Vec<Vec<Cell>>, reference: Vec<f64>, without_prior: usize) -> Self {
        let spots = self.spots.clone();
        let mut other = Self { spots, cells, reference, common: OnceLock::new(), without_prior, misfit: 1.0 };
        other.adjust();
        other
    }

    /// The last of the common parameters beside free forces at the spots of `placing`.
    pub(crate) fn last_parameter(&self, placing: &Placing) -> Option<f64> {
        self.freed(&placing.spots)?.change.last().copied()
    }

    /// The place that leaves least.
    pub(crate) fn best_place(&self) -> Placing {
        let none = Placing { spots: Vec::new(), chi_square: f64::INFINITY };
        self.singles().into_iter().next().unwrap_or(none)
    }

    /// No place: what the parameters alone leave.
    pub(crate) fn no_place(&self) -> Placing {
        Placing { spots: Vec::new(), chi_square: self.nothing() }
    }

    /// Number of real data.
    pub(crate) fn count(&self) -> usize {
        self.cells.iter().flatten().map(|cell| 2 * cell.residual.len()).sum()
    }
}

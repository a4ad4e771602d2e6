//! Which of the unknowns a Newton step solves for: all, or those of odd or of even harmonics.

use super::condense::Condensed;

/// Unknowns that are solved for together.
pub(crate) struct UnknownSubset {
    /// Their indices, rising.
    pub indices: Vec<usize>,
    /// Number of each unknown among them; [`DROPPED`] for the others.
    pub slot: Vec<usize>,
    /// Coefficients of a leg among them.
    pub rows: Vec<usize>,
    /// Harmonics among them, from 1.
    pub orders: Vec<usize>,
    /// Whether the mean is among them.
    pub mean: bool,
}

/// No number.
pub(crate) const DROPPED: usize = usize::MAX;

impl UnknownSubset {
    /// All unknowns.
    pub(crate) fn all(condensed: &Condensed) -> Self {
        Self::of(condensed, |_| true)
    }

    /// Those of odd harmonics.
    pub(crate) fn odd(condensed: &Condensed) -> Self {
        Self::of(condensed, |h| h % 2 == 1)
    }

    /// Those of even harmonics and the mean.
    pub(crate) fn even(condensed: &Condensed) -> Self {
        Self::of(condensed, |h| h.is_multiple_of(2))
    }

    fn of(condensed: &Condensed, takes: impl Fn(usize) -> bool) -> Self {
        let (mean, width) = (takes(0), condensed.width());
        let orders: Vec<usize> = (1..=condensed.harmonics).filter(|&h| takes(h)).collect();
        let pairs = orders.iter().flat_map(|&h| (0..condensed.systems[h].count()).map(move |j| (h, j)));
        let mut indices: Vec<usize> = pairs.flat_map(|(h, j)| [0, 1].map(|k| condensed.index(h, j) + k)).collect();
        if mean {
            indices.extend((0..condensed.legs.len()).map(|j| j * width));
        }
        indices.sort_unstable();
        let mut slot = vec![DROPPED; condensed.size()];
        indices.iter().enumerate().for_each(|(number, &k)| slot[k] = number);
        let harmonics = orders.iter().flat_map(|&h| [2 * h - 1, 2 * h]);
        let rows = mean.then_some(0).into_iter().chain(harmonics).collect();
        Self { indices, slot, rows, orders, mean }
    }

    /// Largest of these entries.
    pub(crate) fn largest(&self, values: &[f64]) -> f64 {
        self.indices.iter().fold(0.0_f64, |m, &k| m.max(values[k].abs()))
    }
}

//! Which columns of a set belong to one complex channel.

use super::words::{Part, Said, Scale, said};
use crate::contents::Set;
use crate::units::{is_unit, reference_of_decibel};

/// Words of names of a force.
const FORCE: &[&str] = &["force", "kraft", "load", "hammer", "forza", "effort", "excitation"];
/// Units of a force.
const FORCE_UNITS: &[&str] = &["n", "kn", "mn", "lbf", "lb", "kgf", "newton"];

/// How a column is read as a part of a complex number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    RealImaginary,
    MagnitudePhase,
}

/// Two columns that are one complex channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    pub columns: [usize; 2],
    pub form: Form,
}

/// The names of a set taken apart; none for columns that are complex.
pub(super) fn names(set: &Set) -> Vec<Said> {
    let taken_apart = |c: &crate::contents::Channel| if c.complex { Said::default() } else { said(&c.name) };
    set.channels.iter().map(taken_apart).collect()
}

/// Pairs by their names, in the order of their first columns.
pub(super) fn by_name(set: &Set, names: &[Said]) -> Vec<Pair> {
    let mut search = Search { set, names, taken: vec![false; names.len()], pairs: Vec::new() };
    search.all(Part::Real, Part::Imaginary, Form::RealImaginary);
    // Amplitudes beside a force are a stepped-sine test, no responses per unit force.
    if !set.channels.iter().zip(names).any(|(channel, said)| is_force(&channel.name, &channel.unit, said)) {
        search.all(Part::Magnitude, Part::Phase, Form::MagnitudePhase);
        search.phases_of_plain_columns();
    }
    search.pairs.sort_by_key(|pair| pair.columns[0].min(pair.columns[1]));
    search.pairs
}

/// Columns two by two, whatever they are called.
pub(super) fn in_turn(columns: &[usize], form: Form) -> Vec<Pair> {
    columns.chunks_exact(2).map(|two| Pair { columns: [two[0], two[1]], form }).collect()
}

fn is_force(name: &str, unit: &str, said: &Said) -> bool {
    let unit = said.unit.as_deref().unwrap_or(unit).trim().to_lowercase();
    let word = name.to_lowercase();
    let word = word.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
    let bare = unit.is_empty() && !name.contains('/') && FORCE.contains(&word);
    said.part != Some(Part::Phase) && (FORCE_UNITS.contains(&unit.as_str()) || bare)
}

struct Search<'a> {
    set: &'a Set,
    names: &'a [Said],
    taken: Vec<bool>,
    pairs: Vec<Pair>,
}

impl Search<'_> {
    /// Pairs all columns of one part with those of the other: of the same name first, then of the same name without words
    /// for responses.
    fn all(&mut self, first: Part, second: Part, form: Form) {
        for key in [|said: &Said| said.stem.clone(), |said: &Said| said.core.clone()] {
            for i in 0..self.names.len() {
                if !self.free(i, Some(first)) {
                    continue;
                }
                let wanted = key(&self.names[i]);
                let alike =
                    |j: &usize| self.free(*j, Some(second)) && key(&self.names[*j]) == wanted && self.fits(i, *j);
                // Re, Im, Re, Im as well as Re, Re, Im, Im: the next behind, else the nearest in front.
                let behind = (i + 1..self.names.len()).find(alike);
                if let Some(j) = behind.or_else(|| (0..i).rev().find(alike)) {
                    self.take(i, j, form);
                }
            }
        }
    }

    /// Phases beside columns whose names do not say that they are magnitudes: `H11`, `Phase H11`; `FRF [dB]`, `Phase`.
    fn phases_of_plain_columns(&mut self) {
        for key in [|said: &Said| said.stem.clone(), |said: &Said| said.core.clone()] {
            for j in 0..self.names.len() {
                if !self.free(j, Some(Part::Phase)) {
                    continue;
                }
                let wanted = key(&self.names[j]);
                let named = |i: &usize| {
                    self.free(*i, None) && !wanted.is_empty() && key(&self.names[*i]) == wanted && self.fits(*i, j)
                };
                let before = (0..j).rev().find(named).or_else(|| (j + 1..self.names.len()).find(named));
                let beside = || {
                    let i = j.checked_sub(1)?;
                    (wanted.is_empty() && self.free(i, None) && self.fits(i, j) && self.is_response(i)).then_some(i)
                };
                if let Some(i) = before.or_else(beside) {
                    self.take(i, j, Form::MagnitudePhase);
                }
            }
        }
    }

    fn free(&self, i: usize, part: Option<Part>) -> bool {
        !self.taken[i] && !self.set.channels[i].complex && !self.names[i].coherence && self.names[i].part == part
    }

    fn fits(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.set.channels[i], &self.set.channels[j]);
        a.count == b.count && a.count > 0
    }

    /// Whether a column without a word for its part may be the magnitude of a response.
    fn is_response(&self, i: usize) -> bool {
        let (channel, said) = (&self.set.channels[i], &self.names[i]);
        let unit = said.unit.as_deref().unwrap_or(&channel.unit);
        let ratio = unit.contains('/') && is_unit(unit) && unit.to_lowercase().contains(['n', 'k', 'l']);
        ratio || reference_of_decibel(unit).is_some() || said.scale == Some(Scale::Decibel) || said.core != said.stem
    }

    fn take(&mut self, i: usize, j: usize, form: Form) {
        (self.taken[i], self.taken[j]) = (true, true);
        self.pairs.push(Pair { columns: [i, j], form });
    }
}

//! What is told of a fit, so that the error that is promised is the one that comparing the project shows once it is done.
//!
//! A search varies all stiffness and that of every mode at once, which say much the same, and a shift of every record, which no
//! project states. What is told must do without: the fit is made again with all stiffness alone, with modes alone and with
//! neither, each beside the known sources that moved, and the plainest that leaves as little stands for all of it.

use super::compare::started_from;
use super::data::RecordError;
use super::evidence::{information, misfit, parameters, scale};
use super::fitted::FittedRecords;
use super::problem::{FitProblem, Free, modes};
use super::search::Search;
use crate::diagnosis::diagnose::Added;
use crate::effects::Source;

/// Deviations from 0 at which a correction of a known source and of a mode is kept.
const MOVED: [f64; 2] = [4.0, 2.0];
/// Least change of a known source, of a mode and of all mass that is told.
const LEAST: [f64; 3] = [0.01, 1e-4, 3e-3];
/// Steps of the fits.
const ITERATIONS: usize = 6;

impl Search<'_> {
    /// `fit` with the corrections that can be told, without shifts; its effects fitted beside them.
    pub fn told(&self, fit: &FittedRecords) -> Result<FittedRecords, RecordError> {
        let (sources, count) = (self.records.known.len(), modes(self.records));
        let first = parameters(fit);
        let wide = scale(fit).sqrt();
        let moved = |j: usize| {
            let deviation = fit.deviations.get(first + 1 + j).copied().unwrap_or(f64::INFINITY) * wide;
            fit.known[j].abs() > (MOVED[0] * deviation).max(LEAST[0])
        };
        let known: Vec<bool> = (0..sources).map(moved).collect();
        let heavier = fit.deviations.get(first + 1 + sources + count).copied().unwrap_or(f64::INFINITY) * wide;
        let mass = fit.mass.abs() > (MOVED[0] * heavier).max(LEAST[2]);
        let mask = |stiffness: bool, modes: bool| {
            let sizes = known.iter().copied().chain(vec![modes; count]);
            std::iter::once(stiffness).chain(sizes).chain([mass]).collect::<Vec<bool>>()
        };
        let dominant = self.dominant();
        let mut all =
            vec![(mask(false, false), 0.0, false), (mask(true, false), fit.stiffness + fit.modes[dominant], false)];
        if count > 0 {
            all.push((mask(false, true), 0.0, true));
        }
        let mut found: Option<(FittedRecords, usize)> = None;
        for (mask, stiffness, by_mode) in all {
            let mut start = fit.clone();
            start.stiffness = stiffness;
            start.known.iter_mut().zip(&known).filter(|(_, moved)| !**moved).for_each(|(v, _)| *v = 0.0);
            start.modes.iter_mut().for_each(|v| *v = if by_mode { *v + fit.stiffness } else { 0.0 });
            start.mass = if mass { fit.mass } else { 0.0 };
            start.shifts.fill(0.0);
            let mut next = self.fit(&start, mask.clone())?;
            let mut free = mask;
            if by_mode {
                free = self.kept_modes(&mut next, free, sources);
                next = self.fit(&next, free.clone())?;
            }
            let count = free.iter().filter(|f| **f).count();
            if found.as_ref().is_none_or(|best| is_plainer((&next, count), (&best.0, best.1))) {
                found = Some((next, count));
            }
        }
        Ok(found.map_or_else(|| fit.clone(), |(fit, _)| fit))
    }

    fn fit(&self, start: &FittedRecords, corrections: Vec<bool>) -> Result<FittedRecords, RecordError> {
        let free = Free { corrections, shifts: false };
        match (FitProblem { records: self.records, free, share: 1.0, control: self.control }).improve(start, ITERATIONS)
        {
            // A start without its corrections may run away: then it is no rival.
            Err(RecordError::Model { .. }) => Ok(FittedRecords { chi_square: f64::INFINITY, ..start.clone() }),
            other => other,
        }
    }

    /// Modes that moved; the others are put back.
    fn kept_modes(&self, fit: &mut FittedRecords, mut free: Vec<bool>, sources: usize) -> Vec<bool> {
        let first = parameters(fit) + 1 + sources;
        let wide = scale(fit).sqrt();
        for r in 0..modes(self.records) {
            let deviation = fit.deviations.get(first + r).copied().unwrap_or(f64::INFINITY) * wide;
            if fit.modes[r].abs() <= (MOVED[1] * deviation).max(LEAST[1]) {
                fit.modes[r] = 0.0;
                free[1 + sources + r] = false;
            }
        }
        free
    }

    /// The mode that is nearest to the highest peak of the first record.
    fn dominant(&self) -> usize {
        let omega = std::f64::consts::TAU * self.records.list[0].dominant_hz;
        let off = |r: &usize| (self.records.modes.omega[*r] - omega).abs();
        (0..self.records.kept).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// What comparing the project shows with the corrections of `told` and these effects.
    pub fn promised(&self, told: &FittedRecords, effects: &[Source]) -> Result<f64, RecordError> {
        let start = FittedRecords {
            stiffness: told.stiffness,
            known: told.known.clone(),
            modes: told.modes.clone(),
            mass: told.mass,
            initial: told.initial.clone(),
            ..FittedRecords::start(self.plain, effects)
        };
        match started_from(self.plain, start, self.control).and_then(|fit| fit.error(self.plain, 0.0, 1.0)) {
            Err(RecordError::Model { .. }) => Ok(f64::INFINITY),
            other => other,
        }
    }
}

/// Whether the first of two fits, each with its number of corrections, has more evidence.
fn is_plainer((new, count): (&FittedRecords, usize), (old, other): (&FittedRecords, usize)) -> bool {
    let unit = scale(if misfit(new) < misfit(old) { new } else { old });
    let worth = |fit: &FittedRecords, n: usize| fit.chi_square / unit + fit.prior + n as f64 * information(fit, unit);
    worth(new, count) < worth(old, other)
}

/// The effects of a fit with their deviations, those of `told` where they are its own.
pub(super) fn added_as_told(told: &[Added], added: &Added) -> Added {
    told.iter().find(|t| t.source.is_same(&added.source)).unwrap_or(added).clone()
}

//! The model corrected, without any effect. Lightly damped resonances that are off by more than their width leave a
//! residual of many valleys, so the descent starts from the best of a row of shifts of all natural frequencies too.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::SEARCH;
use crate::diagnosis::selection::fitted_model::{Refit, starts_of};
use crate::diagnosis::selection::search::Base;
use crate::diagnosis::updating::parameters::{Knob, Tuning};
use crate::response::harmonic_balance::Settings;

/// Largest relative shift of the natural frequencies that is tried.
const WIDEST: f64 = 0.04;
/// Shifts on either side; fewer where known sources are nonlinear, each of whose responses takes many steps.
const SHIFTS: [i32; 2] = [32, 8];
/// Squared residual per datum below which the model is in the right valley already.
const NEAR: f64 = 30.0;
/// Most steps of the descent.
const STEPS: usize = 60;

impl Base<'_> {
    /// The corrections `free` fitted without effects.
    pub fn bare(&self, free: &Tuning, settings: &Settings) -> Result<Refit, DiagnosisError> {
        let bench = self.bench();
        let starts = starts_of(self.predictions.clone());
        let here = bench.refit(&[], free, STEPS, settings, &starts)?;
        if here.chi_square < NEAR * self.count() as f64 {
            return Ok(here);
        }
        let Some(shifted) = self.best_shift(free)? else { return Ok(here) };
        let there = bench.refit(&[], &shifted, STEPS, settings, &starts)?;
        let cost = |r: &Refit| r.chi_square + r.tuning_cost;
        Ok(if cost(&there) < cost(&here) { there } else { here })
    }

    /// The corrections with the shift of all natural frequencies that fits best; none if that is no shift.
    fn best_shift(&self, free: &Tuning) -> Result<Option<Tuning>, DiagnosisError> {
        let many = self.predictor.known().iter().all(|s| s.effect.is_linear());
        let count = SHIFTS[usize::from(!many)];
        let shifted = |k: i32| {
            let shift = WIDEST * f64::from(k) / f64::from(count);
            let value = |(knob, v): (&Knob, &f64)| match knob {
                Knob::Stiffness => v + shift,
                Knob::Mass => v - shift,
                _ => *v,
            };
            free.with(&free.knobs.iter().zip(&free.values).map(value).collect::<Vec<_>>())
        };
        let misfit = |tuning: &Tuning| -> Result<f64, DiagnosisError> {
            let predictor = self.predictor.tuned(tuning)?;
            let bench = crate::diagnosis::selection::fitted_model::Bench { predictor: &predictor, ..self.bench() };
            let residual = bench.residual(&bench.predict(&[], &SEARCH, &[])?);
            Ok(residual.iter().map(|r| r * r).sum())
        };
        let all: Vec<Tuning> = (-count..=count).map(shifted).collect();
        let misfits = self.control.map(all.len(), |k| misfit(&all[k]));
        let misfits = misfits.into_iter().collect::<Result<Vec<f64>, _>>()?;
        let best = (0..all.len()).min_by(|&a, &b| misfits[a].total_cmp(&misfits[b]));
        Ok(best.filter(|&k| k != count as usize).map(|k| all[k].clone()))
    }
}

//! Effects, updating parameters of the model and the relative stiffness of each run fitted together on the response itself:
//!
//! ```text
//! min over theta, u, s of |L^-1 (y - yhat(theta, m(u), s))|^2 + |u|^2 + |s / s_s|^2
//! ```
//!
//! by Levenberg and Marquardt's method, with the response of the updated model at every step. Near a light resonance the
//! response bends so much with what the model states wrongly that a fit of the effects with the updating parameters
//! eliminated linearly, and these moved afterwards, creeps along a valley; together they arrive in a few steps. Gains and delays of
//! channels and the factor on the response of a run are linear and stay eliminated.

use crate::diagnosis::residual::data::{DiagnosisError, RunData, if_possible};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::selection::estimator::{Estimator, Starts, starts_of};
use crate::diagnosis::selection::fit_problem::{run_slopes, unknowns_of};
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::levenberg_marquardt::{Residual, descend};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::diagnosis::updating::parameters::Updating;
use crate::diagnosis::updating::scales::Scales;
use crate::effects::{Kind, Source};
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::Unknown;
use faer::{Mat, c64};

/// Step of a variable of a channel for derivatives by differences.
const STEP: f64 = 1e-4;
/// Prior deviations, as the search has them or wider, in one natural unit of an updating parameter or a shift: steps are limited in
/// such units. How far the response may be followed does not depend on how sure the data are of a parameter.
const UNIT: f64 = 3.0;
/// Gain of the squared residual, in units of what is left per datum, below which a fit has arrived: a quarter of the evidence to
/// which a model is settled, in rounds of which every one starts from where the last one ended.
const ENOUGH: f64 = 0.5;

/// Where a joint fit ended.
pub(super) struct JointFit {
    /// Effects with their parameters.
    pub effects: Vec<Source>,
    /// Updating parameters and shifts of the runs; those of channels at nothing.
    pub updating: Updating,
    /// Responses there.
    pub starts: Starts,
}

impl ReferenceModel<'_> {
    /// Fits `effects`, the updating parameters of the model and the stiffness of each run together, in at most `steps` steps,
    /// with responses that start from `starts`, so far as the squared residual may get below `most`.
    pub(super) fn joint_fit(
        &self,
        effects: &[Source],
        starts: &Starts,
        settings: &Settings,
        steps: usize,
        most: f64,
    ) -> Result<JointFit, DiagnosisError> {
        let (variables, mut start) = Variables::new(effects);
        let updating = self.linearisation.updating.of_model();
        let of_model: Vec<usize> = (0..updating.len()).filter(|&k| updating.parameters[k].is_of_model()).collect();
        let units = natural_units(&updating, &of_model, self.data.runs.len());
        let standardised = updating.standardised();
        let shift = |r: usize| updating.shifts.get(r).copied().unwrap_or(0.0) / updating.scales.shift;
        let of_runs = (0..self.data.runs.len()).map(shift);
        let own = of_model.iter().map(|&k| standardised[k]).chain(of_runs);
        start.extend(own.zip(&units).map(|(deviations, unit)| deviations / unit));
        let noise = self.noise.of_channels(&self.linearisation);
        let (starts, settings) = (starts.clone(), *settings);
        let mut problem = Joint {
            reference: self,
            variables: &variables,
            updating,
            of_model,
            units,
            noise,
            settings,
            most,
            starts,
            last: None,
        };
        let descent = descend(&mut problem, &start, steps)?;
        let trial = problem.trial(&descent.theta)?;
        Ok(JointFit {
            effects: problem.effects(&descent.theta),
            updating: problem.updating_at(&descent.theta),
            starts: starts_of(trial.predictions),
        })
    }
}

/// Prior deviations in the natural unit of each updating parameter `of_model`, then of the shift of each of `runs`.
fn natural_units(updating: &Updating, of_model: &[usize], runs: usize) -> Vec<f64> {
    let search = updating.with_scales(Scales::SEARCH);
    let wider = |searched: f64, own: f64| UNIT * (searched / own).max(1.0);
    let mut units: Vec<f64> = of_model.iter().map(|&k| wider(search.prior(k), updating.prior(k))).collect();
    units.extend(vec![wider(search.scales.shift, updating.scales.shift); runs]);
    units
}

/// The model at one point.
struct Trial {
    at: Vec<f64>,
    predictor: Predictor,
    predictions: Vec<RunPrediction>,
}

/// The residual as a function of the variables of the effects, the updating parameters of the model and the shifts of the
/// runs, the latter two in their natural units.
struct Joint<'a, 'b> {
    reference: &'a ReferenceModel<'b>,
    variables: &'a Variables,
    /// Updating parameters at the start.
    updating: Updating,
    /// Numbers of those of the model.
    of_model: Vec<usize>,
    /// Prior deviations in the natural unit of each of those, then of each shift.
    units: Vec<f64>,
    /// Noise, what is linear eliminated.
    noise: NoiseModel,
    settings: Settings,
    /// Squared residual above which it is of no interest.
    most: f64,
    /// Responses at the last point that was accepted.
    starts: Starts,
    last: Option<Trial>,
}

impl Joint<'_, '_> {
    fn effects(&self, at: &[f64]) -> Vec<Source> {
        self.variables.effects(&at[..self.variables.len()])
    }

    /// The updating parameters, then the shifts at a point.
    fn split<'x>(&self, at: &'x [f64]) -> (&'x [f64], &'x [f64]) {
        at[self.variables.len()..].split_at(self.of_model.len())
    }

    fn updating_at(&self, at: &[f64]) -> Updating {
        let (of_model, shifts) = self.split(at);
        let (units, of_shifts) = self.units.split_at(self.of_model.len());
        let mut u = self.updating.standardised();
        self.of_model.iter().zip(of_model).zip(units).for_each(|((&k, x), unit)| u[k] = x * unit);
        let shifts = shifts.iter().zip(of_shifts).map(|(x, unit)| x * unit * self.updating.scales.shift).collect();
        Updating { shifts, ..self.updating.at(&u) }
    }

    fn estimator<'x>(&'x self, predictor: &'x Predictor) -> Estimator<'x> {
        Estimator { predictor, noise: &self.noise, ..self.reference.estimator() }
    }

    fn compute(&self, at: &[f64]) -> Result<Trial, DiagnosisError> {
        let predictor = self.reference.predictor.updated(&self.updating_at(at))?;
        let predictions = self.estimator(&predictor).predict(&self.effects(at), &self.settings, &self.starts)?;
        Ok(Trial { at: at.to_vec(), predictor, predictions })
    }

    fn trial(&mut self, at: &[f64]) -> Result<Trial, DiagnosisError> {
        match self.last.take().filter(|trial| trial.at == at) {
            Some(trial) => Ok(trial),
            None => self.compute(at),
        }
    }

    /// Whitened residual of predictions, then the standardised updating parameters and shifts.
    fn rows(&self, trial: &Trial) -> Vec<f64> {
        let estimator = self.estimator(&trial.predictor);
        let mut rows = estimator.residual(&trial.predictions);
        rows.extend(trial.at[self.variables.len()..].iter().zip(&self.units).map(|(x, unit)| x * unit));
        rows
    }

    /// What the response is differentiated by: for every variable of an effect, every updating parameter, and the stiffness.
    fn unknowns(&self, effects: &[Source], predictor: &Predictor, run: &RunData) -> Vec<Vec<(Unknown, f64)>> {
        let mut sums = unknowns_of(effects, predictor.known().len());
        sums.extend(self.of_model.iter().map(|&k| self.updating.unknowns(k, predictor.known(), run)));
        sums.push(vec![(Unknown::Stiffness, 1.0)]);
        sums
    }

    /// Derivatives of what is differentiated by the variables, the stiffness last.
    fn factors(&self, at: &[f64]) -> Vec<f64> {
        let mut factors = self.variables.slopes(&at[..self.variables.len()]);
        factors.extend(self.of_model.iter().zip(&self.units).map(|(&k, unit)| unit * self.updating.prior(k)));
        factors.extend(self.units.get(self.of_model.len()).map(|unit| unit * self.updating.scales.shift));
        factors
    }

    /// A column by differences.
    fn difference(&self, at: &[f64], k: usize, residual: &[f64]) -> Result<Vec<f64>, DiagnosisError> {
        let mut moved = at.to_vec();
        moved[k] += STEP;
        let after = self.rows(&self.compute(&moved)?);
        Ok(after.iter().zip(residual).map(|(a, b)| (a - b) / STEP).collect())
    }

    /// Whitened derivatives of the data by all variables at a trial, what belongs to channels not yet eliminated.
    fn data_columns(&self, trial: &Trial, effects: &[Source]) -> Result<Vec<Vec<f64>>, DiagnosisError> {
        let (factors, estimator) = (self.factors(&trial.at), self.estimator(&trial.predictor));
        let common = factors.len() - 1;
        let acts = |k: usize, r: usize| {
            let of_model = k.checked_sub(self.variables.len()).and_then(|k| self.of_model.get(k));
            of_model.is_none_or(|&k| self.updating.acts_in(k, r))
        };
        // Whitened rows of one run, with the number of their column.
        let rows_of = |r: usize| -> Result<Vec<(usize, Vec<f64>)>, DiagnosisError> {
            estimator.control.check()?;
            let run = &estimator.data.runs[r];
            let sums = self.unknowns(effects, &trial.predictor, run);
            let slopes = run_slopes(&trial.predictor, r, run, effects, &trial.predictions[r], &sums);
            let slopes = slopes.iter().flatten().zip(&factors).enumerate().filter(|(k, _)| acts(*k, r));
            let row = |(k, (slope, factor)): (usize, (&Vec<Vec<c64>>, &f64))| {
                let mut own = Vec::new();
                estimator.whitened(r, &mut own, |c, h| -slope[c][h - 1] * *factor);
                (if k < common { k } else { common + r }, own)
            };
            Ok(slopes.map(row).collect())
        };
        let mut columns: Vec<Vec<f64>> = vec![vec![0.0; estimator.count()]; trial.at.len()];
        let mut at = 0;
        for (r, rows) in estimator.control.map(estimator.data.runs.len(), rows_of).into_iter().enumerate() {
            for (column, own) in rows? {
                columns[column][at..at + own.len()].copy_from_slice(&own);
            }
            at += self.noise.runs[r].len();
        }
        Ok(columns)
    }
}

impl Residual for Joint<'_, '_> {
    type Error = DiagnosisError;

    fn is_late(&self) -> bool {
        self.reference.control.is_late()
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        self.variables.bounds()
    }

    fn enough(&self) -> f64 {
        ENOUGH
    }

    fn most(&self) -> f64 {
        self.most
    }

    fn residual(&mut self, at: &[f64]) -> Result<Vec<f64>, DiagnosisError> {
        let Some(trial) = if_possible(self.compute(at))? else { return Ok(vec![f64::INFINITY]) };
        let rows = self.rows(&trial);
        self.last = Some(trial);
        Ok(rows)
    }

    fn jacobian(&mut self, at: &[f64], residual: &[f64]) -> Result<Mat<f64>, DiagnosisError> {
        let trial = self.trial(at)?;
        self.starts = trial.predictions.iter().map(|p| p.found.then(|| p.response.clone())).collect();
        let effects = self.effects(at);
        let mut columns = self.data_columns(&trial, &effects)?;
        let own = self.variables.len();
        let of_channel = effects
            .iter()
            .flat_map(|e| vec![matches!(e.effect.kind(), Kind::Channel(_)); e.parameters.len()])
            .collect::<Vec<bool>>();
        for (k, column) in columns.iter_mut().enumerate() {
            if of_channel.get(k) == Some(&true) {
                *column = self.difference(at, k, residual)?;
                continue;
            }
            *column = self.noise.updating.column(std::mem::take(column));
            column.extend((own..at.len()).map(|j| if j == k { self.units[k - own] } else { 0.0 }));
        }
        self.last = Some(trial);
        Ok(Mat::from_fn(residual.len(), at.len(), |i, k| columns[k][i]))
    }
}

#[cfg(test)]
mod tests;

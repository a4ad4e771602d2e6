//! The model with its updating parameters moved to where the data ask for them, and linearised there.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::selection::fit_problem::run_slopes;
use crate::diagnosis::selection::fitted_model::{Refit, Starts};
use crate::diagnosis::selection::search::Base;
use crate::diagnosis::updating::noise_model::{Linearisation, NoiseModel, of_channel};
use crate::diagnosis::updating::parameters::{Scales, Updating, UpdatingParameter};
use crate::effects::Source;
use crate::response::sensitivity::Unknown;
use crate::structure::Part;
use faer::c64;
use std::sync::Arc;

/// Steps of the fit of the updating parameters alone.
const STEPS: usize = 8;
/// Largest change of a logarithm in one step.
const LONGEST: f64 = 0.05;
/// Gain of the squared residual per datum below which the fit has arrived.
const ARRIVED: f64 = 1e-3;
/// Rounds in which scales and effects are fitted in turn.
const ROUNDS: usize = 3;
/// Steps of the effects in each.
const REFITTED: usize = 4;
/// Share of its squared residual to which a step must bring the best place.
const FALLING: f64 = 0.9;
/// Prior deviations by which parameters may still move where they have arrived.
const STILL: f64 = 0.3;
/// Squared residual per datum of the best place from which on the model is far off: shifts of all frequencies are tried.
const FAR: f64 = 20.0;
/// Logarithms of the factors on all stiffness that are tried.
const SHIFTS: [f64; 8] = [-0.06, -0.04, -0.025, -0.012, 0.012, 0.025, 0.04, 0.06];
/// Shares of a step that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];
/// Steps of the model whose runs do not differ.
const STRICT_STEPS: usize = 4;
/// Bounds of the factor by which the measured motion may differ from the predicted one where derivatives are corrected
/// for it.
const FIELD: [f64; 2] = [0.02, 50.0];

impl<'a> Base<'a> {
    /// The model with its updating parameters at `updating`, linearised beside `effects`, whose responses start from
    /// `starts`.
    ///
    /// Where the model is far off, its derivatives `-A dZ X` are taken at the measured motion rather than at its own
    /// (`X` times the factor that fits the sensors best): for a single mode the relation is then exact however far off.
    pub fn updated(
        &self,
        updating: &Updating,
        effects: &[Source],
        starts: &Starts,
    ) -> Result<Base<'a>, DiagnosisError> {
        let predictor = Arc::new(self.predictor.updated(updating)?);
        let mut base = Base { predictor, predictions: Vec::new(), ..self.shallow() };
        base.predictions = base.bench().predict(&[], &FINAL, &[])?;
        let predictions = if effects.is_empty() {
            base.predictions.clone()
        } else {
            base.bench().predict(effects, &FINAL, starts)?
        };
        base.linearisation = Arc::new(base.linearised(updating, effects, &predictions));
        base.noise = Arc::new(base.noise_of(effects, &predictions)?);
        Ok(base)
    }

    fn linearised(&self, updating: &Updating, effects: &[Source], predictions: &[RunPrediction]) -> Linearisation {
        let known = self.predictor.known();
        let mut sums: Vec<Vec<(Unknown, f64)>> = (0..updating.len()).map(|k| updating.unknowns(k, known)).collect();
        sums.push(vec![(Unknown::Stiffness, 1.0)]);
        let of_run = |r: usize| {
            let (run, prediction) = (&self.data.runs[r], &predictions[r]);
            let zero = || vec![vec![c64::new(0.0, 0.0); run.harmonics]; run.responses.len()];
            let mut slopes = run_slopes(&self.predictor, r, run, effects, prediction, &sums)
                .unwrap_or_else(|| vec![zero(); sums.len()]);
            let factor = scaled_factors(run, prediction).first().copied().unwrap_or(c64::new(1.0, 0.0));
            let size = factor.norm();
            if size > 0.0 && size.is_finite() {
                let factor = factor * (size.clamp(FIELD[0], FIELD[1]) / size);
                slopes.iter_mut().flatten().for_each(|channel| channel[0] *= factor);
            }
            let stiffness = slopes.pop().unwrap_or_else(zero);
            for (slope, parameter) in slopes.iter_mut().zip(&updating.parameters) {
                if !parameter.is_of_model() {
                    *slope = of_channel(parameter, run);
                }
            }
            (slopes, stiffness)
        };
        let (common, stiffness) = self.control.map(self.data.runs.len(), of_run).into_iter().unzip();
        Linearisation { updating: updating.clone(), common, stiffness }
    }

    /// The updating parameters that fit the measurement beside `effects` with the prediction of this base; standardised.
    fn solved(&self, effects: &[Source], starts: &Starts) -> Result<(Vec<f64>, f64), DiagnosisError> {
        let predictions = self.predictions_with(effects, starts)?;
        let rows = self.bench().at_reference(&predictions);
        let u = self.noise.updating.solve(&rows);
        Ok((u, square(&self.bench().residual(&predictions))))
    }

    fn predictions_with(&self, effects: &[Source], starts: &Starts) -> Result<Vec<RunPrediction>, DiagnosisError> {
        if effects.is_empty() { Ok(self.predictions.clone()) } else { self.bench().predict(effects, &FINAL, starts) }
    }

    /// The model whose updating parameters fit the measurement best without any effect.
    pub fn bare(&self) -> Result<Base<'a>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let mut updating = Updating::all(stated, known, self.data);
        let mut best: Option<(f64, Base<'a>)> = None;
        for step in 0..STEPS {
            let base = self.updated(&updating, &[], &Vec::new())?;
            let rows = base.bench().at_reference(&base.predictions);
            let here = square(&rows);
            let misfit = (here / self.count() as f64).max(1.0);
            let target = updating.at(&base.noise.updating.solve_with_misfit(&rows, misfit)).values;
            let least = best.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
            if here < least {
                best = Some((here, base));
            }
            if step > 2 && least - here < ARRIVED * least {
                break;
            }
            updating = towards(&updating, &target);
        }
        match best {
            Some((_, base)) => Ok(base),
            None => self.updated(&updating, &[], &Vec::new()),
        }
    }

    /// This model with the scales that are most likely without any effect, and its evidence: of the scales that are
    /// estimated, and of none for what differs from run to run, the better.
    pub fn likely(&self) -> Result<(Base<'a>, f64), DiagnosisError> {
        let estimated = self.with_likely_scales(None)?.0;
        let mut strict =
            self.with_scales(Scales { shift: Scales::LEAST.shift, response: Scales::LEAST.response, ..Scales::SEARCH });
        for _ in 0..STRICT_STEPS {
            strict = strict.moved_to(&[], &Vec::new())?;
        }
        let evidence = |base: &Base| square(&base.bench().residual(&base.predictions)) + base.noise.cost();
        let (loose, tight) = (evidence(&estimated), evidence(&strict));
        Ok(if tight < loose { (strict, tight) } else { (estimated, loose) })
    }

    /// The model with the updating parameters that fit best beside a free force at the best place, whatever its law: so
    /// they do not stand in for what is missing.
    pub fn localised(&self) -> Result<Base<'a>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let all = Updating::all(stated, known, self.data);
        let mut here = self.seen(&all)?;
        let noise = FAR * self.count() as f64;
        if here.least > noise {
            for shift in SHIFTS {
                let there = self.seen(&shifted(&all, shift))?;
                here = if there.least < here.least { there } else { here };
            }
        }
        for _ in 0..STEPS {
            let updating = here.base.linearisation.updating.clone();
            let target = updating.at(&here.target).values;
            let moved = here.target.iter().zip(updating.standardised()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if moved < STILL {
                break;
            }
            let mut better = None;
            for share in SHARES {
                let part: Vec<f64> = updating.values.iter().zip(&target).map(|(v, t)| v + share * (t - v)).collect();
                let there = self.seen(&towards(&updating, &part))?;
                if there.least < FALLING * here.least {
                    better = Some(there);
                    break;
                }
            }
            let Some(next) = better else { break };
            here = next;
        }
        Ok(here.base)
    }

    /// The model at `updating` with what its best place leaves.
    fn seen(&self, updating: &Updating) -> Result<Seen<'a>, DiagnosisError> {
        let base = self.updated(updating, &[], &Vec::new())?;
        let view = base.view(None)?;
        let best = view.screen.singles().into_iter().next();
        let (least, target) = match best {
            Some(best) => (best.chi_square, view.screen.updated(&best.spots)),
            None => (f64::INFINITY, updating.standardised()),
        };
        drop(view);
        Ok(Seen { base, least, target })
    }

    /// The model moved to the updating parameters that fit best beside `effects`.
    pub fn moved_to(&self, effects: &[Source], starts: &Starts) -> Result<Base<'a>, DiagnosisError> {
        let (u, _) = self.solved(effects, starts)?;
        let updating = &self.linearisation.updating;
        self.updated(&towards(updating, &updating.at(&u).values), effects, starts)
    }

    /// The same model with other scales of the priors.
    pub fn with_scales(&self, scales: Scales) -> Base<'a> {
        let updating = self.linearisation.updating.with_scales(scales);
        let linearisation = Linearisation { updating, ..(*self.linearisation).clone() };
        let noise = NoiseModel::new(self.noise.runs.clone(), self.data, &linearisation);
        Base {
            linearisation: Arc::new(linearisation),
            noise: Arc::new(noise),
            predictions: self.predictions.clone(),
            ..self.shallow()
        }
    }

    /// The model with the scales that are most likely beside the effects of `refit` (none: the model alone), and the
    /// effects fitted with them.
    pub fn with_likely_scales(&self, refit: Option<&Refit>) -> Result<(Base<'a>, Option<Refit>), DiagnosisError> {
        let (mut base, mut fitted) = (self.with_scales(self.linearisation.updating.scales), refit.cloned());
        for _ in 0..ROUNDS {
            let predictions = match &fitted {
                Some(refit) => base.bench().predict(&refit.effects, &FINAL, &refit.starts)?,
                None => base.predictions.clone(),
            };
            for _ in 0..ROUNDS {
                base = base.with_scales(base.noise.scales(&base.bench().at_reference(&predictions)));
            }
            let Some(refit) = &fitted else { break };
            fitted = Some(base.bench().refit(&refit.effects, REFITTED, &FINAL, &refit.starts)?);
        }
        Ok((base, fitted))
    }

    /// How far `moved_to` would move the parameters of the model, in prior deviations.
    pub fn distance(&self, effects: &[Source], starts: &Starts) -> Result<f64, DiagnosisError> {
        let (u, _) = self.solved(effects, starts)?;
        let here = self.linearisation.updating.standardised();
        Ok(u.iter().zip(&here).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    }
}

/// A model whose places were looked at.
struct Seen<'a> {
    base: Base<'a>,
    /// Squared residual that a free force at the best place leaves.
    least: f64,
    /// Standardised updating parameters that fit beside it.
    target: Vec<f64>,
}

/// The parameters with all stiffness and with it all natural frequencies shifted.
fn shifted(all: &Updating, shift: f64) -> Updating {
    let value = |(parameter, v): (&UpdatingParameter, &f64)| match parameter {
        UpdatingParameter::Structure(Part::Stiffness) => v + shift,
        _ => *v,
    };
    let values = all.parameters.iter().zip(&all.values).map(value).collect();
    Updating { values, ..all.clone() }
}

/// The values of `updating` moved to `target`, none by more than the longest step.
fn towards(updating: &Updating, target: &[f64]) -> Updating {
    let moved = |(k, (from, to)): (usize, (&f64, &f64))| {
        if updating.parameters[k].is_of_model() { from + (to - from).clamp(-LONGEST, LONGEST) } else { *to }
    };
    let values = updating.values.iter().zip(target).enumerate().map(moved).collect();
    Updating { values, ..updating.clone() }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum()
}

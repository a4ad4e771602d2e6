//! Energies of a `points` problem as data, and effects fitted to them.

use super::measured_runs::MeasuredRuns;
use super::uncertainty::{Multiples, Uncertainty};
use crate::diagnosis::points::energies::{PointsEnergy, energies};
use crate::diagnosis::residual::data::{DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::prediction::transfer;
use crate::diagnosis::result::Added;
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::levenberg_marquardt::{Residual, descend};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Effect, Leg, Place, Range, Source, State};
use crate::math::statistics::root_mean_square;
use crate::structure::Structure;
use dashpot_numerics::transposed_product;
use faer::{Mat, c64};
use std::convert::Infallible;

/// Allowance for what no model matches, relative to the energy of the run.
const ALLOWANCE: f64 = 5e-4;
/// Step of derivatives by the logarithm of a gain and by a phase.
const STEP: f64 = 1e-4;
/// Step of a variable for derivatives by differences.
const DIFFERENCE: f64 = 1e-5;
/// Samples a period: laws with memory take 1e-4 of their energy wrongly, far less than records tell.
const SAMPLES: usize = 256;
/// The same of the shapes of a grid, which are far apart.
const ROUGH: usize = 128;

/// Energies of the used runs as data.
pub(crate) struct Balance<'a> {
    pub structure: &'a Structure,
    pub known: Vec<Source>,
    runs: MeasuredRuns<'a>,
    uncertainty: Option<Uncertainty>,
    multiples: Multiples,
    /// Input less what is known, J.
    pub missing: Vec<f64>,
    pub input: Vec<f64>,
    pub deviation: Vec<f64>,
}

/// One column: a source of unit scale and its energies.
pub(crate) struct Column {
    pub source: Source,
    /// Energy over the deviation, one a run.
    pub weighted: Vec<f64>,
}

/// A set fitted in all its parameters.
#[derive(Clone)]
pub(crate) struct Fitted {
    pub added: Vec<Added>,
    pub chi_square: f64,
    pub parameters: usize,
    pub error: f64,
    pub held_out: f64,
}

impl<'a> Balance<'a> {
    pub(crate) fn new(problem: &'a Problem, effects: &[Source]) -> Result<Self, DiagnosisError> {
        let data = crate::diagnosis::residual::data::Data::new(problem)?;
        let used = |e: &PointsEnergy| data.runs.iter().any(|r| r.index == e.index);
        let plain: Vec<PointsEnergy> = energies(problem, &[])?.into_iter().filter(used).collect();
        let noisy: Vec<PointsEnergy> = energies(problem, effects)?.into_iter().filter(used).collect();
        let deviation = noisy.iter().map(|e| e.deviation.hypot(ALLOWANCE * e.input).max(f64::MIN_POSITIVE));
        Ok(Self {
            structure: problem.structure,
            known: problem.known(),
            missing: plain.iter().map(|e| e.input - e.taken).collect(),
            input: plain.iter().map(|e| e.input).collect(),
            deviation: deviation.collect(),
            runs: MeasuredRuns::new(problem.structure, data.runs),
            uncertainty: None,
            multiples: Multiples::TRIED[0],
        })
    }

    /// The same with all that is uncertain of the model and the channels, its scales times `multiples`.
    #[must_use]
    pub(crate) fn with_uncertainty(self, multiples: Multiples) -> Self {
        let uncertain = if multiples.is_exact() { Vec::new() } else { self.uncertain() };
        let uncertainty = Some(Uncertainty::new(uncertain, &self.over_deviations(&self.input), multiples));
        Self { uncertainty, multiples, ..self }
    }

    /// The same of records freed of the errors of channels among `effects`, with the effects that are left.
    fn mended(&self, effects: &[Source]) -> (Balance<'a>, Vec<Source>) {
        let (faults, others): (Vec<Source>, Vec<Source>) = effects.iter().cloned().partition(is_fault);
        let runs = self.freed_of(&faults);
        let input = runs.input();
        let scaled = |(d, (new, old)): (&f64, (&f64, &f64))| if *old == 0.0 { *d } else { d * (new / old).abs() };
        let mended = Balance {
            structure: self.structure,
            known: self.known.clone(),
            missing: self.left_of_known(&runs),
            deviation: self.deviation.iter().zip(input.iter().zip(&self.input)).map(scaled).collect(),
            input,
            runs,
            uncertainty: None,
            multiples: self.multiples,
        };
        (mended.with_uncertainty(self.multiples), others)
    }

    /// Sizes of known sources, gains and phases of channels with the derivative of the energy that is left by each, over its
    /// deviation.
    fn uncertain(&self) -> Vec<(UpdatingParameter, Vec<f64>)> {
        let known =
            |(k, source)| (UpdatingParameter::Known(k), self.over_deviations(&self.runs.energies(source, SAMPLES)));
        let mut uncertain: Vec<_> = self.known.iter().enumerate().map(known).collect();
        let omega = self.mean_omega();
        for name in self.channel_names() {
            let by = |effect, value| {
                let place = Place::Channel(name.clone());
                let source = Source { effect, place, state: State::Known, parameters: vec![value] };
                let left = self.left(&[source]);
                let change: Vec<f64> = left.iter().zip(&self.missing).map(|(a, b)| (b - a) / STEP).collect();
                self.over_deviations(&change)
            };
            uncertain.push((UpdatingParameter::Gain(name.clone()), by(Effect::CHANNEL_GAIN, 1.0 + STEP)));
            uncertain.push((UpdatingParameter::Delay(name.clone()), by(Effect::CHANNEL_DELAY, STEP / omega)));
        }
        uncertain
    }

    fn over_deviations(&self, energies: &[f64]) -> Vec<f64> {
        energies.iter().zip(&self.deviation).map(|(e, d)| e / d).collect()
    }

    /// What the uncertainty costs in evidence.
    pub(crate) fn cost(&self) -> f64 {
        self.uncertainty.as_ref().map_or(0.0, |u| u.log_determinant)
    }

    /// Energies of unit covariance.
    fn whitened(&self, energies: &[f64]) -> Vec<f64> {
        let rows = self.over_deviations(energies);
        self.uncertainty.as_ref().map_or_else(|| rows.clone(), |u| u.whitened(&rows))
    }

    /// Corrections of known sources beside `effects`: of records freed of the errors of channels among them.
    pub(crate) fn corrections(&self, effects: &[Source]) -> Vec<Correction> {
        if effects.iter().any(is_fault) {
            let (mended, others) = self.mended(effects);
            return mended.corrections(&others);
        }
        let rows = self.over_deviations(&self.left(effects));
        self.uncertainty.as_ref().map_or_else(Vec::new, |u| u.corrections(&rows))
    }

    /// Arithmetic mean of the circular frequencies, rad/s.
    pub(crate) fn mean_omega(&self) -> f64 {
        self.runs.list.iter().map(|r| r.omega).sum::<f64>() / self.runs.list.len().max(1) as f64
    }

    /// Names of all channels, each once.
    pub(crate) fn channel_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for channel in self.runs.list.iter().flat_map(|r| r.forces.iter().chain(&r.responses)) {
            if !names.contains(&channel.name) {
                names.push(channel.name.clone());
            }
        }
        names
    }

    pub(crate) fn weighted(&self) -> Vec<f64> {
        self.whitened(&self.missing)
    }

    /// The shapes of a grid of every law at every place with the energies that they take out, J.
    pub(crate) fn shapes(&self) -> Vec<(Source, Vec<f64>)> {
        let ground = (0..self.structure.len()).map(|dof| vec![dof]);
        let pairs = self.structure.neighbours().into_iter().map(|pair| pair.to_vec());
        let mut shapes = Vec::new();
        for dofs in ground.chain(pairs) {
            let Some(range) = self.range(&dofs) else { continue };
            for effect in Effect::ALL.into_iter().filter(|e| e.law().is_some() && e.dissipates()) {
                for parameters in effect.shapes(&range) {
                    let source = Source { effect, place: Place::Dofs(dofs.clone()), state: State::Known, parameters };
                    let energies = self.runs.energies(&source, ROUGH);
                    if energies.iter().any(|e| *e > 0.0) {
                        shapes.push((source, energies));
                    }
                }
            }
        }
        shapes
    }

    /// Columns of `shapes`.
    pub(crate) fn columns(&self, shapes: &[(Source, Vec<f64>)]) -> Vec<Column> {
        let column = |(source, energies): &(Source, Vec<f64>)| {
            let weighted = self.whitened(energies);
            weighted.iter().all(|w| w.is_finite()).then(|| Column { source: source.clone(), weighted })
        };
        shapes.iter().filter_map(column).collect()
    }

    /// Range of the motion at a place; none where nothing moves.
    fn range(&self, dofs: &[usize]) -> Option<Range> {
        let leg = Leg { first: dofs[0], second: dofs.get(1).copied() };
        let range = Range::of(&self.runs.sampled(leg, SAMPLES));
        (range.displacement > 0.0).then_some(range)
    }

    /// Energy that is left over in each run with `effects`. Errors of channels are taken out of the record first.
    fn left(&self, effects: &[Source]) -> Vec<f64> {
        let faulty = effects.iter().any(is_fault).then(|| self.freed_of(effects));
        let (runs, mut left) = match &faulty {
            Some(runs) => (runs, self.left_of_known(runs)),
            None => (&self.runs, self.missing.clone()),
        };
        for effect in effects.iter().filter(|e| e.effect.law().is_some()) {
            left.iter_mut().zip(runs.energies(effect, SAMPLES)).for_each(|(l, e)| *l -= e);
        }
        left
    }

    /// Energy that known sources leave over in each of `runs`, J.
    fn left_of_known(&self, runs: &MeasuredRuns) -> Vec<f64> {
        let mut left = runs.input();
        for source in &self.known {
            left.iter_mut().zip(runs.energies(source, SAMPLES)).for_each(|(l, e)| *l -= e);
        }
        left
    }

    /// The runs freed of the errors of channels among `effects`.
    fn freed_of(&self, effects: &[Source]) -> MeasuredRuns<'a> {
        MeasuredRuns::new(self.structure, self.runs.list.iter().map(|run| corrected(run, effects)).collect())
    }

    /// Errors of every channel, from a small one.
    pub(crate) fn faults(&self) -> Vec<Source> {
        let omega = self.mean_omega();
        let fault = |name: &String, effect, value| {
            let place = Place::Channel(name.clone());
            Source { effect, place, state: State::Known, parameters: vec![value] }
        };
        let both =
            |name: &String| [fault(name, Effect::CHANNEL_DELAY, 1e-3 / omega), fault(name, Effect::CHANNEL_GAIN, 1.02)];
        self.channel_names().iter().flat_map(both).collect()
    }

    /// Relative error per run with `effects` and the corrections of known sources beside them, as comparing shows it with both.
    pub(crate) fn errors(&self, effects: &[Source]) -> Vec<f64> {
        if effects.iter().any(is_fault) {
            let (mended, others) = self.mended(effects);
            return mended.errors(&others);
        }
        let mut left = self.left(effects);
        for correction in self.corrections(effects) {
            let UpdatingParameter::Known(k) = correction.parameter else { continue };
            let taken = self.runs.energies(&self.known[k], SAMPLES);
            left.iter_mut().zip(taken).for_each(|(l, e)| *l -= (correction.factor - 1.0) * e);
        }
        left.iter().zip(&self.input).map(|(l, e)| if *e == 0.0 { 1.0 } else { (l / e).abs() }).collect()
    }

    pub(crate) fn fit(&self, effects: &[Source]) -> Fitted {
        let (variables, start) = Variables::new(effects);
        let Ok(descent) = descend(&mut OnEnergy { balance: self, variables: &variables }, &start, 20);
        let found = variables.effects(&descent.theta);
        let slopes = variables.slopes(&descent.theta);
        let mut deviations = descent.deviations().into_iter().zip(slopes).map(|(d, s)| d * s.abs());
        let added = found.iter().map(|source| {
            let own = deviations.by_ref().take(source.parameters.len()).collect();
            Added { source: source.clone(), deviations: own }
        });
        let added = added.collect();
        let error = root_mean_square(&self.errors(&found));
        let held_out = self.held_out(&found, &descent.jacobian);
        Fitted { added, chi_square: descent.chi_square, parameters: variables.len(), error, held_out }
    }

    /// Error of each run by the linearised fit without it: the residual over one less its leverage.
    fn held_out(&self, effects: &[Source], jacobian: &Mat<f64>) -> f64 {
        let n = jacobian.ncols();
        let normal = transposed_product(jacobian.as_ref(), jacobian.as_ref());
        let identity = Mat::<f64>::identity(n, n);
        let Ok(inverse) = crate::math::least_squares::solve_symmetric(normal.as_ref(), identity.as_ref()) else {
            return root_mean_square(&self.errors(effects));
        };
        let errors = self.errors(effects);
        let errors: Vec<f64> = (0..errors.len())
            .map(|r| {
                let row = |i: usize, k: usize| jacobian[(r, i)] * inverse[(i, k)] * jacobian[(r, k)];
                let leverage: f64 = (0..n).map(|i| (0..n).map(|k| row(i, k)).sum::<f64>()).sum();
                errors[r] / (1.0 - leverage.min(0.9))
            })
            .collect();
        root_mean_square(&errors)
    }
}

/// Weighted difference of energies as a function of the variables.
struct OnEnergy<'a> {
    balance: &'a Balance<'a>,
    variables: &'a Variables,
}

impl Residual for OnEnergy<'_> {
    type Error = Infallible;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        let left = self.balance.left(&self.variables.effects(theta));
        Ok(self.balance.whitened(&left))
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let effects = self.variables.effects(theta);
        let faulty = effects.iter().any(is_fault);
        let owners = effects.iter().enumerate().flat_map(|(j, effect)| vec![j; effect.parameters.len()]);
        let before: Vec<Vec<f64>> = if faulty {
            Vec::new()
        } else {
            effects.iter().map(|effect| self.balance.runs.energies(effect, SAMPLES)).collect()
        };
        let mut jacobian = Mat::zeros(at.len(), theta.len());
        for (k, owner) in owners.enumerate() {
            let mut moved = theta.to_vec();
            moved[k] += DIFFERENCE;
            let change: Vec<f64> = if faulty {
                let Ok(after) = self.residual(&moved);
                after.iter().zip(at).map(|(a, b)| a - b).collect()
            } else {
                // Energies add up: those of the other effects stay.
                let after = self.balance.runs.energies(&self.variables.effects(&moved)[owner], SAMPLES);
                self.balance.whitened(&before[owner].iter().zip(&after).map(|(b, a)| b - a).collect::<Vec<_>>())
            };
            change.iter().enumerate().for_each(|(r, c)| jacobian[(r, k)] = c / DIFFERENCE);
        }
        Ok(jacobian)
    }
}

/// Whether an effect is an error of a channel.
fn is_fault(effect: &Source) -> bool {
    matches!(effect.place, Place::Channel(_))
}

/// The run freed of the errors of channels among `effects`.
fn corrected(run: &RunData, effects: &[Source]) -> RunData {
    let mut run = run.clone();
    let omega = run.omega;
    for channel in run.forces.iter_mut().chain(&mut run.responses) {
        let name = channel.name.clone();
        let free = |(i, y): (usize, &mut c64)| *y /= transfer(effects, &name, (i + 1) as f64 * omega);
        channel.measured.iter_mut().enumerate().for_each(free);
    }
    run
}

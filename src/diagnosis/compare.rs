//! Predicted against measured amplitude of every channel, run and harmonic.
//!
//! Error of a channel in a run: `|Y - Y_model| / max(|Y|, largest |Y| of that quantity in the run / 20)`, vectors over
//! the harmonics. Error of all: root mean square over the used runs and channels. The noise floor is the same measure of
//! the residual that noise and truncation alone would leave.

use crate::control::Control;
use crate::diagnosis::points::energies::{PointsEnergy, energies, where_all_is_measured};
use crate::diagnosis::residual::branch::nearest;
use crate::diagnosis::residual::breakdown::{Group, by_channel, by_harmonic, by_level};
use crate::diagnosis::residual::comparison::{ChannelComparison, HarmonicComparison, RunComparison};
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData, is_used, size};
use crate::diagnosis::residual::energy_balance::energy_error;
use crate::diagnosis::residual::levels::Levels;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::residual::transfers::transfers;
use crate::diagnosis::residual::whiteness::{Left, Whiteness, numbered, whiteness};
use crate::diagnosis::residual::whitening::Whitening;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use faer::c64;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The model against the measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Root mean square relative error over used runs and channels.
    pub error: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// Root mean square of the energy errors of the used runs.
    pub energy_error: f64,
    /// Every run that the model predicts, in the order of the project.
    pub runs: Vec<RunComparison>,
    /// Runs for which the model has no response, with the reason; the errors are those of the others.
    pub unpredicted: Vec<Unpredicted>,
    /// By the level of the force: the labels of the runs, or the amplitude of the force where they have none.
    pub levels: Vec<Group>,
    /// By channel; none for `points`.
    pub channels: Vec<Group>,
    /// By harmonic; none for `points`.
    pub harmonics: Vec<Group>,
    /// Whether what is left depends on anything; none for `points`.
    pub whiteness: Vec<Whiteness>,
}

/// A run for which the model has no response.
#[derive(Debug, Clone, PartialEq)]
pub struct Unpredicted {
    /// Number of the run.
    pub index: usize,
    /// Why, in one sentence.
    pub reason: String,
}

/// Sorts the runs that were compared from those for which there is no response.
///
/// # Errors
/// Where no run that is used has one: why the first has none.
fn predicted<T>(
    compared: Vec<(usize, Result<(RunComparison, T), DiagnosisError>)>,
) -> Result<(Vec<RunComparison>, Vec<T>, Vec<Unpredicted>), DiagnosisError> {
    let (mut runs, mut left, mut unpredicted, mut first) = (Vec::new(), Vec::new(), Vec::new(), None);
    for (index, one) in compared {
        match one {
            Ok((run, own)) => {
                runs.push(run);
                left.push(own);
            }
            Err(DiagnosisError::Response { file, reason }) => {
                unpredicted.push(Unpredicted { index, reason: reason.to_string() });
                first.get_or_insert(DiagnosisError::Response { file, reason });
            }
            Err(error) => return Err(error),
        }
    }
    match first.filter(|_| runs.iter().all(|run| !run.used)) {
        Some(error) => Err(error),
        None => Ok((runs, left, unpredicted)),
    }
}

/// Compares the model of `problem`, with `effects` added to its known sources, with the measurement.
///
/// ```
/// use dashpot::{control::Control, diagnosis::{Problem, compare}, exchange::project::load};
///
/// let control = Control::unattended();
/// let project = load("sample-data/five-masses-cubic/project.toml".as_ref(), &control)?;
/// let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
/// let comparison = compare(&problem, &[], &control)?;
/// for run in &comparison.runs {
///     println!("{}: {:.1} %, energy {:.1} %", project.runs[run.index].file, 100.0 * run.error, 100.0 * run.energy_error);
/// }
/// assert!(comparison.error > 2.0 * comparison.noise_floor); // a spring that hardens is missing
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(problem: &Problem, effects: &[Source], control: &Control) -> Result<Comparison, DiagnosisError> {
    if problem.structure.matrices().is_none() {
        return of_energies(problem, &energies(problem, effects)?);
    }
    Data::new(problem)?;
    let data = Data::every(problem)?;
    let predictor = Predictor::new(problem.structure, problem.known(), &data)?;
    let levels = Levels::new(problem, &data);
    let frequencies = numbered(&data.runs.iter().map(|run| run.omega).collect::<Vec<f64>>(), SAME_FREQUENCY);
    let names = data.channel_names();
    let done = AtomicUsize::new(0);
    let compare_run = |r: usize| -> Result<(RunComparison, Vec<Left>), DiagnosisError> {
        control.check()?;
        let run = &data.runs[r];
        let failed = |reason| DiagnosisError::of_response(problem.runs[run.index].file.clone(), reason);
        let (prediction, branch) = nearest(&predictor, r, run, effects, control).map_err(failed)?;
        let transfers = transfers(&predictor, r, run, effects, control).map_err(failed)?;
        let noise = Whitening::new(run, &transfers, &prediction.truncation);
        let used = is_used(&problem.runs[run.index]);
        let sources = predictor.sources(effects);
        let energy = where_all_is_measured(problem, run.index, &sources)
            .map_or_else(|| energy_error(problem.structure, &sources, run, &prediction), |energy| energy.error());
        let mut left = Vec::new();
        if used {
            add_left(&mut left, run, &prediction, &noise, ([frequencies[r], levels.numbers[r]], &names[0]));
        }
        control.report((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / data.runs.len() as f64);
        Ok((RunComparison { branch, ..of_run(run, &prediction, &noise, used, energy) }, left))
    };
    let numbers = data.runs.iter().map(|run| run.index);
    let (runs, left, unpredicted) = predicted(numbers.zip(control.map(data.runs.len(), compare_run)).collect())?;
    Ok(Comparison { whiteness: whiteness(&left.concat()), unpredicted, ..summary(runs, &levels) })
}

/// Runs whose frequencies differ by less than this share are of one frequency.
const SAME_FREQUENCY: f64 = 1e-3;
/// Adds the whitened residuals of a run, turned by the phase of the model.
fn add_left(
    left: &mut Vec<Left>,
    run: &RunData,
    prediction: &RunPrediction,
    noise: &Whitening,
    ([frequency, level], names): ([usize; 2], &[String]),
) {
    for h in 1..=run.harmonics {
        let values = noise.apply(h, |c| run.responses[c].measured[h - 1] - prediction.channels[c][h - 1]);
        for (&c, value) in run.alive.iter().zip(values) {
            let model = prediction.channels[c][h - 1];
            let turn = if model.norm() > 0.0 { model.conj() / model.norm() } else { c64::new(1.0, 0.0) };
            let channel = names.iter().position(|name| *name == run.responses[c].name).unwrap_or(0);
            left.push(Left { groups: [frequency, level, channel, h], value: value * turn });
        }
    }
}

fn of_run(run: &RunData, prediction: &RunPrediction, noise: &Whitening, used: bool, energy: f64) -> RunComparison {
    let channels: Vec<ChannelComparison> = run
        .responses
        .iter()
        .enumerate()
        .map(|(c, channel)| {
            let model = &prediction.channels[c];
            let difference: Vec<c64> = channel.measured.iter().zip(model).map(|(y, m)| y - m).collect();
            let residual = |k: usize, h: usize| run.responses[k].measured[h - 1] - prediction.channels[k][h - 1];
            let floor = noise.expected_given(c, residual).sqrt();
            let scale = run.scale(c);
            let relative = |x: f64| if scale > 0.0 { x / scale } else { 0.0 };
            let harmonic = |(i, (&measured, &model)): (usize, (&c64, &c64))| HarmonicComparison {
                harmonic: i + 1,
                measured,
                model,
                deviation: noise.deviation(c, i + 1),
            };
            ChannelComparison {
                channel: channel.name.clone(),
                dof: channel.dof,
                error: relative(size(&difference)),
                noise_floor: relative(floor),
                scale,
                harmonics: channel.measured.iter().zip(model).enumerate().map(harmonic).collect(),
            }
        })
        .collect();
    let errors: Vec<f64> = channels.iter().map(|c| c.error).collect();
    let floors: Vec<f64> = channels.iter().map(|c| c.noise_floor).collect();
    let (error, noise_floor) = (root_mean_square(&errors), root_mean_square(&floors));
    RunComparison { index: run.index, used, error, noise_floor, branch: None, energy_error: energy, channels }
}

fn summary(runs: Vec<RunComparison>, levels: &Levels) -> Comparison {
    let used = || runs.iter().filter(|run| run.used);
    let overall = |value: fn(&ChannelComparison) -> f64| -> f64 {
        let values: Vec<f64> = used().flat_map(|run| run.channels.iter().map(value)).collect();
        root_mean_square(&values)
    };
    let (error, noise_floor) = (overall(|c| c.error), overall(|c| c.noise_floor));
    let energies: Vec<f64> = used().map(|run| run.energy_error).collect();
    let energy_error = root_mean_square(&energies);
    let (channels, harmonics) = (by_channel(&runs), by_harmonic(&runs));
    let levels = by_level(&runs, |run| levels.names[run.index].clone());
    let (whiteness, unpredicted) = (Vec::new(), Vec::new());
    Comparison { error, noise_floor, energy_error, runs, unpredicted, levels, channels, harmonics, whiteness }
}

/// For `points`: errors are those of the energy.
fn of_energies(problem: &Problem, energies: &[PointsEnergy]) -> Result<Comparison, DiagnosisError> {
    let levels = Levels::new(problem, &Data::every(problem)?);
    let mut runs = Vec::with_capacity(energies.len());
    let (mut errors, mut floors) = (Vec::new(), Vec::new());
    for energy in energies {
        let error = energy.error();
        let used = is_used(&problem.runs[energy.index]);
        if used {
            errors.push(error);
            floors.push(energy.noise());
        }
        let (noise_floor, channels) = (energy.noise(), Vec::new());
        let energy_error = error;
        runs.push(RunComparison {
            index: energy.index,
            used,
            error,
            noise_floor,
            branch: None,
            energy_error,
            channels,
        });
    }
    let error = root_mean_square(&errors);
    let levels = by_level(&runs, |run| levels.names[run.index].clone());
    let (noise_floor, channels, harmonics) = (root_mean_square(&floors), Vec::new(), Vec::new());
    let (whiteness, unpredicted, energy_error) = (Vec::new(), Vec::new(), error);
    Ok(Comparison { error, noise_floor, energy_error, runs, unpredicted, levels, channels, harmonics, whiteness })
}

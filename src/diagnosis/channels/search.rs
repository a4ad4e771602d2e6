//! Which fault of which channel explains what the shapes of the motion say, one after the other.

use super::cells::{Cells, cells};
use super::common::common;
use super::fault::{ChannelFault, Fault, known_factor};
use super::places;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::structure::Structure;
use crate::structure::lowest_modes::LowestModes;
use crate::structure::modes::Modes;

/// Most faults; where more channels are wrong it is the model.
const MOST: usize = 6;
/// Own error from which on a channel is looked at.
const WRONG: f64 = 0.22;
/// Own error up to which a channel is mended, and that over its own error before.
const MENDED: f64 = 0.35;
const FALLS: f64 = 0.35;
/// Share of the frequencies that must show it.
const EVERYWHERE: f64 = 0.85;
/// Least frequencies at which the channels move enough, unless what is left of the error is less than `CLEAR`.
const FREQUENCIES: usize = 2;
const CLEAR: f64 = 0.1;
/// Own error up to which a channel is put to another DOF.
const FITS: f64 = 0.15;
/// DOFs up to which all modes are computed, and how far beyond the highest frequency they are above that.
const SMALL: usize = 200;
const BEYOND: f64 = 1.3;
/// Largest spread of a factor over the frequencies, natural logarithm.
const SPREAD: f64 = 0.2;
/// The same of a factor that is none of a known misreading, and the least of it: a spring or mass that is missing at the sensor, or a
/// sensor elsewhere, changes the shapes of the modes each by its own factor.
const EVEN: f64 = 0.04;
const NO_GAIN: f64 = 0.2;

/// The faults of the channels of `data`, the plainest first; none where the structure has no modes.
pub(crate) fn find(predictor: &Predictor, data: &Data, predictions: &[RunPrediction]) -> Vec<ChannelFault> {
    let Some(modes) = modes(predictor.structure(), data) else { return Vec::new() };
    let (names, cells) = cells(predictor.structure(), &modes, data, predictions);
    let dofs = dofs(data, &names);
    let forces = &data.channel_names()[1];
    let all = || data.runs.iter().flat_map(|run| &run.forces);
    let driven: Vec<usize> =
        forces.iter().map(|name| all().find(|force| force.name == *name).map_or(0, |force| force.dof)).collect();
    Search::new(predictor.structure(), &modes, names, dofs, cells).all_faults(forces, &driven)
}

/// The DOF at which the only force of all runs fits the motion best, where it fits it well.
pub(crate) fn place_of_force(predictor: &Predictor, data: &Data, predictions: &[RunPrediction]) -> Option<usize> {
    let [_, forces] = data.channel_names();
    let [_] = &forces[..] else { return None };
    let structure = predictor.structure();
    let modes = modes(structure, data)?;
    let (_, cells) = cells(structure, &modes, data, predictions);
    let said = data.runs.first()?.forces.first()?.dof;
    places::best_of_force(said, structure, &modes, &cells)
}

/// DOF of each response channel; 0 where there is none of that name.
fn dofs(data: &Data, names: &[String]) -> Vec<usize> {
    let responses = || data.runs.iter().flat_map(|run| &run.responses);
    let dof_of = |name: &String| responses().find(|channel| channel.name == *name).map_or(0, |channel| channel.dof);
    names.iter().map(dof_of).collect()
}

/// Modes up to the highest frequency that was measured.
fn modes(structure: &Structure, data: &Data) -> Option<Modes> {
    modes_up_to(structure, data.runs.iter().map(|run| run.omega).fold(0.0, f64::max))
}

/// Modes up to a frequency (rad/s) and a little beyond; all of a small structure.
pub(super) fn modes_up_to(structure: &Structure, highest: f64) -> Option<Modes> {
    let large = structure.matrices().filter(|_| structure.len() > SMALL);
    let lowest = large.and_then(|matrices| LowestModes::new(matrices, BEYOND * highest, 1).ok().flatten());
    lowest.map(|lowest| lowest.modes).or_else(|| structure.modes().ok())
}

/// Channels by number, and what is wrong with them.
#[derive(Debug, Clone, Copy)]
struct Hypothesis {
    fault: Fault,
    channels: [usize; 2],
}

pub(super) struct Search<'a> {
    structure: &'a Structure,
    modes: &'a Modes,
    names: Vec<String>,
    /// DOFs of the channels as they are found.
    dofs: Vec<usize>,
    cells: Vec<Cells>,
    faults: Vec<ChannelFault>,
    /// Whether factors are named that are none of a known misreading.
    any_gain: bool,
}

/// Errors of the channels under a hypothesis.
struct Errors {
    /// `[run][channel]`.
    cells: Vec<Vec<f64>>,
}

impl<'a> Search<'a> {
    /// For channels with these names, at these DOFs.
    pub(super) fn new(
        structure: &'a Structure,
        modes: &'a Modes,
        names: Vec<String>,
        dofs: Vec<usize>,
        cells: Vec<Cells>,
    ) -> Self {
        Self { structure, modes, names, dofs, cells, faults: Vec::new(), any_gain: false }
    }

    /// Names factors that are none of a known misreading too: for data from which no law of a gain is estimated.
    pub(super) fn knows_any_gain(&mut self) {
        self.any_gain = true;
    }

    /// All faults, the plainest first; the names of the forces and the DOFs at which they are said to act.
    pub(super) fn all_faults(mut self, forces: &[String], driven: &[usize]) -> Vec<ChannelFault> {
        // A channel that is wrong for itself may hide what all have in common, and the other way round.
        let shared = self.take_common(forces);
        while self.faults.len() < MOST && self.step() {}
        if !shared {
            self.take_common(forces);
        }
        self.faults.extend(places::of_force(forces, driven, self.structure, self.modes, &self.cells));
        self.faults
    }

    /// Finds what all motions or the force read wrongly and mends it; whether there was that.
    fn take_common(&mut self, forces: &[String]) -> bool {
        let Some(fault) = common(&self.names, forces, &self.cells) else { return false };
        if let Fault::Common(factor) = fault.fault {
            // It is the motion that is scaled, also where the force is wrong.
            let by = if fault.channels[0].starts_with("force@") { 1.0 / factor } else { factor };
            self.cells.iter_mut().flat_map(|cells| &mut cells.measured).for_each(|value| *value /= by);
        }
        self.faults.push(fault);
        true
    }

    /// Finds the best fault and mends it; whether there was one.
    fn step(&mut self) -> bool {
        let before = self.errors(None);
        let suspects: Vec<usize> = (0..self.names.len()).filter(|&c| self.own(&before, &[c]) > WRONG).collect();
        let mut hypotheses: Vec<Hypothesis> = Vec::new();
        for &c in &suspects {
            hypotheses.push(Hypothesis { fault: Fault::Factor(-1.0), channels: [c, c] });
            hypotheses.extend(self.factor(c).map(|f| Hypothesis { fault: Fault::Factor(f), channels: [c, c] }));
        }
        for (i, &a) in suspects.iter().enumerate() {
            let alike = |b: &&usize| word(&self.names[a]) == word(&self.names[**b]);
            hypotheses.extend(
                suspects[i + 1..]
                    .iter()
                    .filter(alike)
                    .map(|&b| Hypothesis { fault: Fault::Exchanged, channels: [a, b] }),
            );
        }
        // A channel that reads wrongly is sooner told than one that was put elsewhere, which has all DOFs to choose from.
        let best = self.best(&hypotheses, &before).or_else(|| {
            let elsewhere: Vec<Hypothesis> = suspects.iter().filter_map(|&c| self.elsewhere(c)).collect();
            self.best(&elsewhere, &before)
        });
        let Some((hypothesis, fault)) = best else { return false };
        if let Fault::Elsewhere(dof) = hypothesis.fault {
            self.dofs[hypothesis.channels[0]] = dof;
        }
        for cells in &mut self.cells {
            *cells = transformed(cells, &hypothesis, self.modes);
        }
        self.faults.push(fault);
        true
    }

    /// The hypothesis that leaves least, of those that are accepted.
    fn best(&self, hypotheses: &[Hypothesis], before: &Errors) -> Option<(Hypothesis, ChannelFault)> {
        let judged = hypotheses.iter().filter_map(|hypothesis| {
            let after = self.errors(Some(hypothesis));
            Some((*hypothesis, self.judged(hypothesis, before, &after)?))
        });
        judged.min_by(|(_, a), (_, b)| a.error_after.total_cmp(&b.error_after))
    }

    /// That a channel is at the DOF where it fits best.
    fn elsewhere(&self, channel: usize) -> Option<Hypothesis> {
        let at = [channel, self.dofs[channel]];
        let dof = places::of_sensor(&self.cells, self.modes, self.structure, at, &self.dofs)?;
        Some(Hypothesis { fault: Fault::Elsewhere(dof), channels: [channel, channel] })
    }

    fn errors(&self, hypothesis: Option<&Hypothesis>) -> Errors {
        let cost = |cells: &Cells| {
            let own = hypothesis.map(|hypothesis| transformed(cells, hypothesis, self.modes));
            let cells = own.as_ref().unwrap_or(cells);
            let fit = cells.fitted(&cells.measured, None);
            (0..fit.len()).map(|c| cells.error(c, cells.measured[c], fit[c])).collect()
        };
        Errors { cells: self.cells.iter().map(cost).collect() }
    }

    /// Mean over the frequencies of the error of some channels where they move; 0 where they nowhere do.
    fn own(&self, errors: &Errors, channels: &[usize]) -> f64 {
        mean(&self.by_frequency(errors, channels).into_iter().flatten().collect::<Vec<f64>>())
    }

    /// Mean error of some channels at every frequency at which they move.
    fn by_frequency(&self, errors: &Errors, channels: &[usize]) -> Vec<Option<f64>> {
        let count = self.cells.iter().map(|cells| cells.frequency + 1).max().unwrap_or(0);
        let mut at: Vec<Vec<f64>> = vec![Vec::new(); count];
        for (cells, errors) in self.cells.iter().zip(&errors.cells) {
            for (i, c) in cells.channels.iter().enumerate() {
                if channels.contains(c) && cells.moves[i] {
                    at[cells.frequency].push(errors[i]);
                }
            }
        }
        at.iter().map(|values| (!values.is_empty()).then(|| mean(values))).collect()
    }

    /// The factor by which a channel differs from what the others say of it, if it is one of a known misreading, or plain at
    /// frequencies enough where any gain is named.
    fn factor(&self, channel: usize) -> Option<f64> {
        let (mut ratios, mut frequencies) = (Vec::new(), Vec::new());
        for cells in &self.cells {
            let Some(i) = cells.channels.iter().position(|&c| c == channel).filter(|&i| cells.moves[i]) else {
                continue;
            };
            let fit = cells.fitted(&cells.measured, Some(i))[i];
            if fit.norm() > 0.0 && cells.measured[i].norm() > 0.0 {
                ratios.push(cells.measured[i] / fit);
                frequencies.push(cells.frequency);
            }
        }
        if ratios.is_empty() {
            return None;
        }
        let logs: Vec<f64> = ratios.iter().map(|z| z.norm().ln()).collect();
        let middle = median(&logs);
        let spread = median(&logs.iter().map(|log| (log - middle).abs()).collect::<Vec<f64>>());
        let cosines: Vec<f64> = ratios.iter().map(|z| z.re / z.norm()).collect();
        let sign = if median(&cosines) < 0.0 { -1.0 } else { 1.0 };
        frequencies.sort_unstable();
        frequencies.dedup();
        let known = known_factor(&self.names[channel], middle.exp()).filter(|_| spread < SPREAD);
        let plain = self.any_gain && frequencies.len() >= places::FEWEST && spread < EVEN && middle.abs() > NO_GAIN;
        known.or(plain.then(|| middle.exp())).map(|factor| sign * factor)
    }

    /// Names of the channels of a fault; of one that is elsewhere its name there too.
    fn names_of(&self, hypothesis: &Hypothesis, channels: &[usize]) -> Vec<String> {
        let mut names: Vec<String> = channels.iter().map(|&c| self.names[c].clone()).collect();
        if let Fault::Elsewhere(dof) = hypothesis.fault {
            names.push(places::renamed(&names[0], self.structure.label(dof)));
        }
        names
    }

    /// The fault, if mending it brings its channels down to a fraction everywhere, and the others with them.
    fn judged(&self, hypothesis: &Hypothesis, before: &Errors, after: &Errors) -> Option<ChannelFault> {
        let mut channels = hypothesis.channels.to_vec();
        channels.dedup();
        let own_error = [before, after].map(|errors| self.own(errors, &channels));
        let elsewhere = matches!(hypothesis.fault, Fault::Elsewhere(_));
        let mended = if elsewhere { FITS } else { MENDED };
        if own_error[1] > mended || own_error[1] > FALLS * own_error[0] {
            return None;
        }
        let [was, is] = [before, after].map(|errors| self.by_frequency(errors, &channels));
        let pairs: Vec<(f64, f64)> = was.into_iter().zip(is).filter_map(|(a, b)| Some((a?, b?))).collect();
        let shown = pairs.iter().filter(|(was, is)| is < was).count();
        let enough = if elsewhere {
            pairs.len() >= places::FEWEST
        } else {
            pairs.len() >= FREQUENCIES || (pairs.len() == 1 && own_error[1] < CLEAR)
        };
        if !enough || (shown as f64) < EVERYWHERE * pairs.len() as f64 {
            return None;
        }
        let all = |errors: &Errors| mean(&errors.cells.iter().flatten().copied().collect::<Vec<f64>>());
        let (error_before, error_after) = (all(before), all(after));
        (error_after < error_before).then(|| ChannelFault {
            fault: hypothesis.fault,
            channels: self.names_of(hypothesis, &channels),
            error_before,
            error_after,
            own_error,
            frequencies: [shown, pairs.len()],
        })
    }
}

/// A run without the fault.
fn transformed(cells: &Cells, hypothesis: &Hypothesis, modes: &Modes) -> Cells {
    let mut cells = cells.clone();
    let position = |channel: usize| cells.channels.iter().position(|&c| c == channel);
    match (hypothesis.fault, hypothesis.channels.map(position)) {
        (Fault::Factor(factor), [Some(i), _]) => cells.measured[i] /= factor,
        (Fault::Exchanged, [Some(i), Some(j)]) => cells.measured.swap(i, j),
        (Fault::Elsewhere(dof), [Some(i), _]) => cells.put(i, dof, modes),
        _ => {}
    }
    cells
}

fn word(name: &str) -> &str {
    name.split('@').next().unwrap_or_default()
}

fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

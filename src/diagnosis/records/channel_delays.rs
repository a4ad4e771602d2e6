//! Delays of channels: filters, converters that sample one channel after the other, vibrometers, generators that hold each value for
//! a step.
//!
//! ```text
//! y_c(t) = y_model,c(t - tau_0 - tau_c),     d y_c / d tau = - y'_model,c
//! ```
//!
//! `tau_0` is the delay of all motions behind the forces, `tau_c` of one sensor. They are found to first order beside the best fit of whole
//! records, all of its corrections and effects free, one by one as long as they explain much of what is left: a delay turns the phase in
//! proportion to the frequency, which no stiffness, mass or damping does, while a missing effect may resemble one. The search is then
//! made again on the records without them, and has to leave less.

use super::data::{RecordData, RecordDiagnosisError, Records};
use super::evidence::{AGREES, GAIN, information, misfit, scale};
use super::fitted::FittedRecords;
use super::normal_equations::{Left, Normal, RecordDerivatives, solve};
use super::problem::{FitProblem, Free};
use super::search::Search;
use super::steps::Steps;
use super::variables::scales;
use crate::control::Control;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::math::fractional_delay::shifted;
use crate::measurement::{Channel, ChannelCorrection, Quantity};
use faer::Mat;

/// Share of the squared residual that a delay takes away at least, and of a sampling step that it is at least: what is less may be the
/// error of any model.
const WORTH: f64 = 0.2;
const LEAST: f64 = 0.02;
/// Sampling steps below which delays have settled.
const SETTLED: f64 = 0.005;
/// Times that delays are asked for beside a fit, and rounds and steps of the fit without them.
const ROUNDS: usize = 4;
const REFITTING: [usize; 2] = [1, 4];
/// Sampling steps over which a slope is taken on either side.
const SLOPE: f64 = 0.05;
/// Damping of a step that is solved to first order: none, but for variables that the records do not show.
const REGULAR: f64 = 1e-9;

/// A delay that is asked for: of all motions, or of one sensor.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Late {
    Motions,
    Sensor(usize),
}

impl Search<'_> {
    /// Delays that whole records ask for beside the best `fit` of them; none where they explain little.
    pub(super) fn delays(&self, fit: &FittedRecords) -> Result<Vec<ChannelCorrection>, RecordDiagnosisError> {
        if misfit(fit) < self.records.agreement(AGREES) || self.control.is_late() {
            return Ok(Vec::new());
        }
        let (mut records, mut fit) = (self.whole().clone(), fit.clone());
        let (mut known, mut all) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let (late, more) = delays_beside(&records, &fit, &known, self.control)?;
            let is_settled = late.len() == known.len() && more.iter().all(|shift| shift.abs() < SETTLED);
            if is_settled || self.control.is_late() {
                break;
            }
            let more = corrections(&records, &late, &more);
            records.list.iter_mut().for_each(|record| record.take_out(&more));
            (known, all) = (late, added(all, more));
            let problem =
                FitProblem { records: &records, free: Free::all(&records), share: 1.0, control: self.control };
            fit = problem.chord_fit(&fit, REFITTING)?;
        }
        Ok(all)
    }
}

/// Delays, to first order, that records ask for beside a fit of them, those that are `known` to be there first, in sampling steps.
fn delays_beside(
    records: &Records,
    fit: &FittedRecords,
    known: &[Late],
    control: &Control,
) -> Result<(Vec<Late>, Vec<f64>), RecordDiagnosisError> {
    let asked = asked(records);
    let problem = FitProblem { records, free: Free::all(records), share: 1.0, control };
    let normal = problem.with_delays(fit, &asked, longest_step(records))?;
    let unit = scale(fit);
    let size = normal.gradient.len() - asked.len();
    let mut chosen: Vec<usize> = (0..asked.len()).filter(|&k| known.contains(&asked[k])).collect();
    let (mut gain, mut shifts) = gain_of(&normal, size, &chosen).unwrap_or_default();
    while let Some((more, next, own)) = best_of(&normal, size, &chosen) {
        let demanded = (GAIN + information(fit, unit)) * unit;
        let late = own.last().is_some_and(|shift| shift.abs() > LEAST);
        if more - gain < demanded.max(WORTH * fit.chi_square) || !late {
            break;
        }
        chosen.push(next);
        (gain, shifts) = (more, own);
    }
    Ok((chosen.into_iter().map(|k| asked[k]).collect(), shifts))
}

/// The longest sampling step of some records, s, in which delays are counted.
fn longest_step(records: &Records) -> f64 {
    records.list.iter().map(|r| r.step).fold(0.0, f64::max)
}

/// Delays that records can show: of all motions where forces are measured, of single sensors where there are several.
fn asked(records: &Records) -> Vec<Late> {
    let driven = records.list.iter().any(|r| !r.forces.is_empty());
    let count = records.sensors();
    let sensors = if count > 1 { count } else { 0 };
    driven.then_some(Late::Motions).into_iter().chain((0..sensors).map(Late::Sensor)).collect()
}

impl FitProblem<'_> {
    /// The normal equations at a fit, those of the delays that are `asked` for, in sampling steps of `step` s, behind all others.
    fn with_delays(&self, at: &FittedRecords, asked: &[Late], step: f64) -> Result<Normal, RecordDiagnosisError> {
        let (scales, unit) = (scales(&at.effects), scale(at));
        let bare = self.assembled(at, unit, Vec::new());
        let size = bare.gradient.len();
        let mut normal = Normal {
            matrix: Mat::zeros(size + asked.len(), size + asked.len()),
            gradient: bare.gradient.into_iter().chain(vec![0.0; asked.len()]).collect(),
            left: bare.left,
        };
        normal.matrix.submatrix_mut(0, 0, size, size).copy_from(&bare.matrix);
        // The prior deviation of a delay is one sampling step.
        (size..size + asked.len()).for_each(|k| normal.matrix[(k, k)] = unit);
        let parts = self.control.map(self.records.list.len(), |r| {
            let mut derivatives = self.derivatives(at, &scales, r, Steps::Fine)?;
            self.add_delays(&mut derivatives, r, asked, step, size);
            Ok(derivatives.products(1.0))
        });
        for part in parts.into_iter().collect::<Result<Vec<_>, RecordDiagnosisError>>()? {
            normal.add(&part);
        }
        Ok(normal)
    }

    /// Adds the derivatives of record `r` by the delays, the first of which has the number `first` among the variables.
    fn add_delays(&self, derivatives: &mut RecordDerivatives, r: usize, asked: &[Late], step: f64, first: usize) {
        let record = &self.records.list[r];
        let count = derivatives.count;
        for (c, (columns, left)) in derivatives.channels.iter_mut().zip(&derivatives.left).enumerate() {
            let by_delay = by_delay(record, c, left, step);
            let shows = |late: &Late| match late {
                Late::Motions => !record.forces.is_empty(),
                Late::Sensor(sensor) => self.records.sensor(record, c) == *sensor,
            };
            let own = asked.iter().enumerate().filter(|(_, late)| shows(late));
            columns.extend(own.map(|(k, _)| (count + k, by_delay.clone())));
        }
        derivatives.unknowns.extend((0..asked.len()).map(|k| (count + k, first + k, 1.0)));
        derivatives.count += asked.len();
    }
}

/// Derivative of a channel of a record, of which a model leaves `left` over the noise, by a delay in steps of `step` s, over the noise.
fn by_delay(record: &RecordData, c: usize, left: &[f64], step: f64) -> Vec<f64> {
    let sigma = &record.sigma[c];
    let model: Vec<f64> =
        record.samples[c].iter().zip(left).zip(sigma).map(|((y, left), sigma)| y - left * sigma).collect();
    // Differences of neighbours would miss half of the slope of what is fast.
    let [before, after] = [-SLOPE, SLOPE].map(|shift| shifted(&model, shift));
    let slope = |n: usize| (after[n] - before[n]) / (2.0 * SLOPE * record.step);
    (0..model.len()).map(|n| -step * slope(n) / sigma[n]).collect()
}

/// What is taken away to first order with the variables before `first` and these delays, and the delays.
fn gain_of(normal: &Normal, first: usize, delays: &[usize]) -> Option<(f64, Vec<f64>)> {
    let kept: Vec<usize> = (0..first).chain(delays.iter().map(|k| first + k)).collect();
    let restricted = Normal {
        matrix: Mat::from_fn(kept.len(), kept.len(), |i, j| normal.matrix[(kept[i], kept[j])]),
        gradient: kept.iter().map(|&k| normal.gradient[k]).collect(),
        left: Left::default(),
    };
    let step = solve(&restricted, REGULAR)?;
    Some((step.expected_gain, step.change[first..].to_vec()))
}

/// The delay that takes away most beside those that are `chosen`: what all then take away, its number, and all of them.
fn best_of(normal: &Normal, first: usize, chosen: &[usize]) -> Option<(f64, usize, Vec<f64>)> {
    let others = (0..normal.gradient.len() - first).filter(|k| !chosen.contains(k));
    let with = |k: usize| {
        let delays: Vec<usize> = chosen.iter().copied().chain([k]).collect();
        gain_of(normal, first, &delays).map(|(gain, own)| (gain, k, own))
    };
    others.filter_map(with).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Delays, in sampling steps, as those of channels; one of all motions as its opposite of the forces.
fn corrections(records: &Records, late: &[Late], shifts: &[f64]) -> Vec<ChannelCorrection> {
    let step = longest_step(records);
    let mut list: Vec<ChannelCorrection> = Vec::new();
    for (late, shift) in late.iter().zip(shifts) {
        let (channels, delay) = match late {
            Late::Sensor(sensor) => (vec![records.sensors[*sensor].clone()], step * shift),
            Late::Motions => (forces(records), -step * shift),
        };
        list.extend(channels.into_iter().map(|channel| ChannelCorrection { channel, delay, gain: 1.0 }));
    }
    list
}

/// Channels of force that differ.
fn forces(records: &Records) -> Vec<Channel> {
    let mut list: Vec<Channel> = Vec::new();
    for record in &records.list {
        for channel in record.run.force_channels().into_iter().map(|c| &record.run.channels()[c]) {
            if !list.iter().any(|c| c.dof == channel.dof) {
                list.push(channel.clone());
            }
        }
    }
    list
}

/// Delays that are known, with more of them.
pub(super) fn added(mut known: Vec<ChannelCorrection>, more: Vec<ChannelCorrection>) -> Vec<ChannelCorrection> {
    for correction in more {
        match known.iter_mut().find(|own| own.channel == correction.channel) {
            Some(own) => own.delay += correction.delay,
            None => known.push(correction),
        }
    }
    known
}

/// Delays as faults of channels; errors of the best model of the records with them and without.
pub(super) fn as_faults(delays: &[ChannelCorrection], [before, after]: [f64; 2]) -> Vec<ChannelFault> {
    let fault = |delay: &ChannelCorrection| ChannelFault {
        fault: Fault::Late(delay.delay),
        channels: vec![delay.channel.to_string()],
        error_before: before,
        error_after: after,
        own_error: [before, after],
        frequencies: [0, 0],
    };
    delays.iter().map(fault).collect()
}

impl RecordData {
    /// Takes delays out of its channels as it holds them.
    fn take_out(&mut self, delays: &[ChannelCorrection]) {
        let (step, force_step) = (self.step, self.force_step());
        for ChannelCorrection { channel, delay, .. } in delays {
            let of_channel = |c: &Channel| c.quantity == channel.quantity && c.dof == channel.dof;
            for (_, list) in self.channels.iter().zip(&mut self.samples).filter(|(c, _)| of_channel(c)) {
                *list = shifted(list, delay / step).into_owned();
            }
            let is_force = channel.quantity == Quantity::Force;
            for (_, list) in self.drives.iter().zip(&mut self.forces).filter(|(d, _)| is_force && **d == channel.dof) {
                *list = shifted(list, delay / force_step).into_owned();
            }
        }
    }
}

impl<'a> Records<'a> {
    /// The same records without the delays of their channels.
    pub(super) fn without_delays(&self, delays: &[ChannelCorrection]) -> Result<Records<'a>, RecordDiagnosisError> {
        let runs: Vec<_> = self.list.iter().map(|record| record.run.without_errors(delays)).collect();
        let mut records = Records::new(self.structure, &self.known, &runs)?;
        records.list.iter_mut().zip(&self.list).for_each(|(own, record)| own.index = record.index);
        Ok(records)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{three_masses, whole};
    use crate::common::runs::decay;
    use crate::effects::Effect;

    const STEP: f64 = 1e-3;

    /// Displacements of three masses that ring in two modes, damped in proportion to their mass by 0.3/s; the last sensor is late by `late` s.
    fn ringing(late: f64) -> Vec<Vec<f64>> {
        let modes = three_masses([1.0; 3]).modes().unwrap();
        let sample = |dof: usize, n: usize| {
            let t = STEP * n as f64 - if dof == 2 { late } else { 0.0 };
            let mode = |r: usize| {
                let damped = (modes.omega[r].powi(2) - 0.15_f64.powi(2)).sqrt();
                1e-3 * modes.shapes[(dof, r)] * (-0.15 * t).exp() * (damped * t).cos()
            };
            let noise = 1e-7 * (12.9 * n as f64 + 78.2 * dof as f64).sin();
            mode(0) + mode(1) + noise
        };
        (0..3).map(|dof| (0..2000).map(|n| sample(dof, n)).collect()).collect()
    }

    /// Against the difference of two records of a sensor that is earlier and later, where the model is the record.
    #[test]
    fn the_derivative_by_a_delay_is_that_of_later_records() {
        let (structure, run) = (three_masses([1.0; 3]), decay(STEP, ringing(0.0)));
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let record = &records.list[0];
        let samples = &record.samples[2];
        let derivative = by_delay(record, 2, &vec![0.0; samples.len()], record.step);
        let [later, earlier] = [0.05, -0.05].map(|late| ringing(late * STEP).swap_remove(2));
        let largest = derivative.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        for n in 10..samples.len() - 10 {
            let difference = (later[n] - earlier[n]) / 0.1 / record.sigma[2][n];
            assert!((derivative[n] - difference).abs() < 0.05 * largest, "{n}: {} {difference}", derivative[n]);
        }
    }

    /// A third of a sampling step of one sensor, beside the model as it is.
    #[test]
    fn a_late_sensor_is_told_with_its_delay() {
        let structure = three_masses([1.0; 3]);
        let known = [whole(Effect::MassProportional, 0.3)];
        let (run, control) = (decay(STEP, ringing(STEP / 3.0)), Control::unattended());
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.whole();
        let problem = FitProblem { records: whole, free: Free::all(whole), share: 1.0, control: &control };
        let fit = problem.improve(&FittedRecords::start(whole, &[]), 20).unwrap();
        let delays = search.delays(&fit).unwrap();
        let [ChannelCorrection { channel, delay, .. }] = &delays[..] else { panic!("{delays:?}") };
        assert!(channel.dof == 2 && (delay / (STEP / 3.0) - 1.0).abs() < 0.02, "{delays:?}");
    }
}

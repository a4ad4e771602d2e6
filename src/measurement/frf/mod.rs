//! Measured frequency responses as runs: each chosen line is a steady-state run under a unit force.
//!
//! `H(omega) = Y / F`, `F = 1 N` at the reference, `Y` the displacement, velocity or acceleration at each response.
//! A line holds no amplitude: laws whose damping depends on it cannot be told from such runs
//! ([`Run::per_unit_force`](super::Run::per_unit_force)).

pub(crate) mod lines;
pub(crate) mod variance;
mod whole;

use super::channel::Channel;
use super::fit::{ChannelFit, HarmonicFit};
use super::run::{ChannelCorrection, Run};
use faer::{Mat, c64};
use lines::Density;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Least standard deviation over the modulus: coherences of 1 and written digits promise more than transducers hold.
const LEAST_DEVIATION: f64 = 1e-4;

/// Least squared modulus of a value over that of its noise, `2 var`, for a line to say anything: noise alone, whose squared
/// modulus is distributed exponentially, comes that far on one line of twenty thousand.
const ABOVE_NOISE: f64 = 10.0;

/// One measured function, SI units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrequencyResponse {
    /// What responds: displacement, velocity or acceleration at a DOF.
    pub response: Channel,
    /// The force at the reference.
    pub reference: Channel,
    /// Response per newton, one value a frequency.
    pub values: Vec<c64>,
    /// Coherence, one value a frequency, where it was measured.
    pub coherence: Option<Vec<f64>>,
}

/// Functions on common frequencies.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ResponseSet {
    /// Name in messages and in the names of runs.
    pub name: String,
    /// Frequencies, Hz, ascending and positive.
    pub frequencies_hz: Vec<f64>,
    /// The functions; `values` and `coherence` as long as `frequencies_hz`.
    pub functions: Vec<FrequencyResponse>,
    /// Number of averages, where it is known.
    pub averages: Option<usize>,
}

/// Which lines become runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Band, Hz.
    pub band: [f64; 2],
    /// Most lines, all references together.
    pub most: usize,
}

/// The runs of a set, and in words which they are.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenRuns {
    /// One run a chosen line and reference.
    pub runs: Vec<Run>,
    /// Which lines were chosen of how many, and where the deviations come from.
    pub remarks: Vec<String>,
}

impl ResponseSet {
    /// Makes the runs of the most informative lines, corrected for the known errors of their channels.
    pub(crate) fn runs(&self, selection: Selection, enabled: bool, corrections: &[ChannelCorrection]) -> ChosenRuns {
        let variances = self.variances();
        let references = self.references();
        let densities: Vec<Density> =
            references.iter().map(|members| self.density(members, &variances, selection.band)).collect();
        let chosen = lines::choose(&densities, selection.most);
        let whole = Arc::new(self.whole(selection.band, &variances, corrections));
        let mut runs = Vec::new();
        for (members, lines) in references.iter().zip(&chosen) {
            for &line in lines {
                let run = self.run(members, line, &variances, enabled, corrections);
                runs.push(Run { functions: Some(whole.clone()), ..run });
            }
        }
        let remarks = self.remarks(&references, &chosen);
        ChosenRuns { runs, remarks }
    }

    /// Functions of each reference, in the order of their first appearance.
    fn references(&self) -> Vec<Vec<usize>> {
        let mut references: Vec<Vec<usize>> = Vec::new();
        for (i, function) in self.functions.iter().enumerate() {
            let same = |members: &&mut Vec<usize>| self.functions[members[0]].reference == function.reference;
            match references.iter_mut().find(same) {
                Some(members) => members.push(i),
                None => references.push(vec![i]),
            }
        }
        references
    }

    /// Variance of the real (and of the imaginary) part of each value of each function.
    fn variances(&self) -> Vec<Vec<f64>> {
        let coherence = |function: &FrequencyResponse| {
            let averages = self.averages.filter(|averages| *averages > 1)?;
            Some(variance::from_coherence(&function.values, function.coherence.as_ref()?, averages))
        };
        let known: Vec<Option<Vec<f64>>> = self.functions.iter().map(coherence).collect();
        let unknown = self.functions.iter().zip(&known).filter(|(_, known)| known.is_none());
        let share = variance::noise_share(&unknown.map(|(function, _)| &function.values[..]).collect::<Vec<_>>());
        let of_function = |(function, known): (&FrequencyResponse, Option<Vec<f64>>)| {
            let measured = known.unwrap_or_else(|| variance::from_scatter(&function.values, share));
            let least = function.values.iter().map(|h| 0.5 * LEAST_DEVIATION.powi(2) * square(*h));
            measured.into_iter().zip(least).map(|(variance, least)| variance.max(least)).collect()
        };
        self.functions.iter().zip(known).map(of_function).collect()
    }

    /// How much each line of a reference says of damping.
    fn density(&self, members: &[usize], variances: &[Vec<f64>], band: [f64; 2]) -> Density {
        let value = |line: usize| {
            let omega = TAU * self.frequencies_hz[line];
            if !(band[0]..=band[1]).contains(&self.frequencies_hz[line]) {
                return 0.0;
            }
            let (mut signal, mut size) = (0.0, 0.0);
            for &i in members {
                let function = &self.functions[i];
                let square = square(function.values[line]);
                let derivatives = function.response.quantity.derivatives().unwrap_or(0);
                signal += if variances[i][line] > 0.0 { square / variances[i][line] } else { 0.0 };
                size += square / omega.powi(2 * derivatives);
            }
            let information = omega * omega * signal * size / members.len() as f64;
            if information.is_finite() { information } else { 0.0 }
        };
        // What is noise looks large as a displacement at low frequencies.
        let stands_out = |line: usize| {
            let above = |&i: &usize| square(self.functions[i].values[line]) > ABOVE_NOISE * 2.0 * variances[i][line];
            members.iter().any(above)
        };
        let lines = 0..self.frequencies_hz.len();
        Density { information: lines.clone().map(value).collect(), stands_out: lines.map(stands_out).collect() }
    }

    fn run(
        &self,
        members: &[usize],
        line: usize,
        variances: &[Vec<f64>],
        enabled: bool,
        corrections: &[ChannelCorrection],
    ) -> Run {
        let frequency_hz = self.frequencies_hz[line];
        let reference = self.functions[members[0]].reference.clone();
        let name = format!("{} {reference} {frequency_hz} Hz", self.name);
        let mut channels = vec![channel(reference, c64::new(1.0, 0.0), 0.0)];
        channels.extend(members.iter().map(|&i| {
            let function = &self.functions[i];
            channel(function.response.clone(), function.values[line], variances[i][line])
        }));
        let fit = HarmonicFit { omega: TAU * frequency_hz, omega_deviation: 0.0, channels };
        Run { per_unit_force: true, ..Run::from_harmonics(name, None, enabled, fit, corrections) }
    }

    /// Which lines were chosen, and where deviations come from.
    fn remarks(&self, references: &[Vec<usize>], chosen: &[Vec<usize>]) -> Vec<String> {
        let mut remarks = Vec::new();
        let count: usize = chosen.iter().map(Vec::len).sum();
        let mut all: Vec<usize> = chosen.iter().flatten().copied().collect();
        all.sort_unstable();
        let groups = lines::groups(&all);
        let words: Vec<String> = groups.iter().map(|&(first, last, n)| self.band_in_words(first, last, n)).collect();
        remarks.push(format!(
            "{}: {count} of {} lines are used, those that say most of damping: {}",
            self.name,
            references.len() * self.frequencies_hz.len(),
            words.join(", ")
        ));
        let without = self.functions.iter().filter(|function| function.coherence.is_none()).count();
        let averages = self.averages.unwrap_or(0);
        if averages < 2 {
            remarks.push(format!(
                "{}: the number of averages is not known, so deviations come from the scatter about a smooth curve; \
                 give `averages`",
                self.name
            ));
        } else if without > 0 {
            remarks.push(format!(
                "{}: {without} of {} functions have no coherence; their deviations come from the scatter about a \
                 smooth curve",
                self.name,
                self.functions.len()
            ));
        }
        remarks
    }

    fn band_in_words(&self, first: usize, last: usize, count: usize) -> String {
        let [from, to] = [first, last].map(|line| self.frequencies_hz[line]);
        if first == last { format!("{from:.5} Hz ({count})") } else { format!("{from:.5} to {to:.5} Hz ({count})") }
    }
}

/// A channel with one harmonic.
fn channel(channel: Channel, value: c64, variance: f64) -> ChannelFit {
    let mut covariance = Mat::zeros(2, 2);
    covariance[(0, 0)] = variance;
    covariance[(1, 1)] = variance;
    ChannelFit { channel, offset: 0.0, slope: 0.0, amplitudes: vec![value], covariance, noise: variance.sqrt() }
}

fn square(h: c64) -> f64 {
    h.re * h.re + h.im * h.im
}

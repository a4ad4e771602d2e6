//! What the motions of a run have in common against the model: one complex factor on all of them; and what one of them has beside that.
//!
//! Every run may have one of its own in the search (level of the force, discrepancy), which laboratories report at some tenths of
//! a per cent. Its scale is estimated; where it comes out far beyond that it hides what should be told: a measuring chain, or a law.

use crate::diagnosis::channels::chain::{Explained, Ratio, explained, explained_of_one};
use crate::diagnosis::channels::fault::{ChannelFault, Fault};
use crate::diagnosis::residual::data::{DiagnosisError, RunData};
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::result::CommonFactor;
use crate::diagnosis::selection::conclusion::TOLERATED;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use faer::c64;
use std::f64::consts::TAU;

/// Scale of the factors from which on they are looked at: seven times that of laboratories.
const LARGE: f64 = 0.02;
/// Angle, root mean square over the frequencies, rad, from which on what a model leaves is not that it is out of tune.
const TURNED: f64 = 0.03;
/// That angle over how much single runs scatter about the mean of their frequency.
const STEADY: f64 = 2.0;
/// Runs whose frequencies differ by less, natural logarithm, are of one mode.
const ONE_MODE: f64 = 0.1;
/// Share of the measured motion that a channel moves by in the model to be compared with the others.
const MOVES: f64 = 0.3;
/// Runs at a frequency from which on their mean is one.
const FEWEST: usize = 2;

impl ReferenceModel<'_> {
    /// The measuring chain that explains the factors on the motions of all runs beside the corrections and the effects of a fit, if
    /// they are large.
    pub(super) fn chain_fault_beside(&self, fit: Option<&FittedModel>) -> Result<Option<ChannelFault>, DiagnosisError> {
        if self.data.chain_mended || self.control.is_late() {
            return Ok(None);
        }
        let left = fit.map_or(0.0, |fit| fit.chi_square / self.count() as f64);
        let (of_all, of_one) = (self.is_far_from_chains(), left > TOLERATED);
        let predictions = match fit {
            Some(fit) if of_all || of_one => self.estimator().predict(&fit.effects, &FINAL, &fit.starts)?,
            _ => self.predictions.clone(),
        };
        let shared = of_all.then(|| explained(&self.ratios(&predictions))).flatten().map(|found| self.fault_of(&found));
        Ok(shared.or_else(|| of_one.then(|| self.fault_of_one(&predictions)).flatten()))
    }

    /// The channel whose ratio to the others a chain of its own explains best.
    fn fault_of_one(&self, predictions: &[RunPrediction]) -> Option<ChannelFault> {
        let [names, _] = self.data.channel_names();
        let explained = |name: &String| Some((name.clone(), explained_of_one(&self.ratios_of(name, predictions))?));
        let share = |found: &Explained| found.error[1] / found.error[0];
        let all = names.iter().filter_map(explained);
        let (name, found) = all.min_by(|(_, a), (_, b)| share(a).total_cmp(&share(b)))?;
        Some(fault(&found, vec![name]))
    }

    /// Measured over predicted motion of a channel over the same of the others, of every run in which it moves.
    fn ratios_of(&self, name: &str, predictions: &[RunPrediction]) -> Vec<Ratio> {
        let ratio = |(run, prediction): (&RunData, &RunPrediction)| {
            let own = *run.alive.iter().find(|&&c| run.responses[c].name == name)?;
            let first = |c: usize| (run.responses[c].measured[0], prediction.channels[c][0]);
            let (mut product, mut square) = (c64::new(0.0, 0.0), 0.0);
            for &c in run.alive.iter().filter(|&&c| c != own) {
                let ((y, m), weight) = (first(c), run.scale(c).powi(-2));
                product += m.conj() * y * weight;
                square += m.norm_sqr() * weight;
            }
            let (y, m) = first(own);
            let moves = m.norm() > MOVES * run.scale(own) && square > 0.0;
            moves.then(|| (run.omega, y / m / (product / square)))
        };
        self.data.runs.iter().zip(predictions).filter_map(ratio).collect()
    }

    /// The factors that all motions have in common, by frequency, where they are turned there by more than chains and models out of
    /// tune turn them.
    pub(super) fn common_factors(&self, predictions: &[RunPrediction]) -> Vec<CommonFactor> {
        if !self.is_far_from_chains() {
            return Vec::new();
        }
        let groups = by_mode(&self.ratios(predictions));
        if is_turned(&groups) { groups.iter().map(|group| factor(group)).collect() } else { Vec::new() }
    }

    fn is_far_from_chains(&self) -> bool {
        self.linearisation.updating.scales.response > LARGE
    }

    /// Measured over predicted motion of every run.
    fn ratios(&self, predictions: &[RunPrediction]) -> Vec<Ratio> {
        let pairs = self.data.runs.iter().zip(predictions);
        pairs.filter_map(|(run, p)| Some((run.omega, *scaled_factors(run, p).first()?))).collect()
    }

    fn fault_of(&self, found: &Explained) -> ChannelFault {
        let [motions, forces] = self.data.channel_names();
        fault(found, if found.of_force { forces } else { motions })
    }
}

fn fault(found: &Explained, channels: Vec<String>) -> ChannelFault {
    ChannelFault {
        fault: Fault::Chain(found.fault),
        channels,
        error_before: found.error[0],
        error_after: found.error[1],
        own_error: found.error,
        frequencies: found.shown,
    }
}

/// Runs by frequency, the lowest first.
fn by_mode(ratios: &[Ratio]) -> Vec<Vec<Ratio>> {
    let mut sorted = ratios.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut groups: Vec<Vec<Ratio>> = Vec::new();
    for ratio in sorted {
        match groups.last_mut() {
            Some(group) if (ratio.0 / group[0].0).ln() < ONE_MODE => group.push(ratio),
            _ => groups.push(vec![ratio]),
        }
    }
    groups.retain(|group| group.len() >= FEWEST);
    groups
}

/// Whether the mean of each group is turned by more than its runs scatter.
fn is_turned(groups: &[Vec<Ratio>]) -> bool {
    let (mut angles, mut scatter, mut count) = (0.0, 0.0, 0.0);
    for group in groups {
        let middle = mean(group);
        angles += middle.arg().powi(2) * group.len() as f64;
        scatter += group.iter().map(|(_, rho)| (rho / middle).arg().powi(2)).sum::<f64>();
        count += group.len() as f64;
    }
    count > 0.0 && (angles / count).sqrt() > TURNED && angles > STEADY.powi(2) * scatter
}

fn mean(group: &[Ratio]) -> c64 {
    group.iter().map(|(_, rho)| *rho).sum::<c64>() / group.len() as f64
}

fn factor(group: &[Ratio]) -> CommonFactor {
    let middle = mean(group);
    let omega = group.iter().map(|(w, _)| *w).sum::<f64>() / group.len() as f64;
    CommonFactor { frequency_hz: omega / TAU, gain: middle.norm(), lead_deg: middle.arg().to_degrees() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(by: f64) -> c64 {
        c64::new(by.cos(), by.sin())
    }

    /// Two modes with three runs each.
    fn runs(angle: impl Fn(f64) -> f64) -> Vec<Vec<Ratio>> {
        by_mode(&[9.8, 10.0, 10.2, 39.0, 40.0, 41.0].map(|w| (w, turned(angle(w)))))
    }

    #[test]
    fn angles_that_a_mode_has_in_common_are_told_and_those_forth_and_back_are_not() {
        assert_eq!(runs(|_| 0.1).iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
        assert!(is_turned(&runs(|w| 2.0 / w)));
        assert!(!is_turned(&runs(|w| 0.05 / w)), "as good as chains are");
        // A wrong damping or frequency: forth and back about each resonance.
        assert!(!is_turned(&runs(|w| if w < 20.0 { w - 10.0 } else { 0.2 * (w - 40.0) })));
        let told = factor(&runs(|w| 2.0 / w)[0]);
        assert!((told.lead_deg - 11.46).abs() < 0.02 && (told.gain - 1.0).abs() < 1e-3, "{told:?}");
    }
}

//! What the motions of a run have in common against the model: one complex factor on all of them.
//!
//! Every run may have one of its own in the search (level of the force, discrepancy), which laboratories report at some tenths of
//! a per cent. Its scale is estimated; where it comes out far beyond that it hides what should be told: a measuring chain, or a law.

use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::RunPrediction;
use crate::diagnosis::result::CommonFactor;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use faer::c64;
use std::f64::consts::TAU;

/// Circular frequency of a run, rad/s, and its measured over its predicted motion.
type Ratio = (f64, c64);

/// Scale of the factors from which on they are looked at: seven times that of laboratories.
const LARGE: f64 = 0.02;
/// Angle, root mean square over the frequencies, rad, from which on what a model leaves is not that it is out of tune.
const TURNED: f64 = 0.03;
/// That angle over how much single runs scatter about the mean of their frequency.
const STEADY: f64 = 2.0;
/// Runs whose frequencies differ by less, natural logarithm, are of one mode.
const ONE_MODE: f64 = 0.1;
/// Runs at a frequency from which on their mean is one.
const FEWEST: usize = 2;

impl ReferenceModel<'_> {
    /// The factors that all motions have in common, by frequency, where they are turned there by more than chains and models out of
    /// tune turn them.
    pub(super) fn common_factors(&self, predictions: &[RunPrediction]) -> Vec<CommonFactor> {
        if self.linearisation.updating.scales.response < LARGE {
            return Vec::new();
        }
        let groups = by_mode(&self.ratios(predictions));
        if is_turned(&groups) { groups.iter().map(|group| factor(group)).collect() } else { Vec::new() }
    }

    /// Measured over predicted motion of every run.
    fn ratios(&self, predictions: &[RunPrediction]) -> Vec<Ratio> {
        let pairs = self.data.runs.iter().zip(predictions);
        pairs.filter_map(|(run, p)| Some((run.omega, *scaled_factors(run, p).first()?))).collect()
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

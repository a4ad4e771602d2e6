//! A fault of all motions at once, or of the force: no shape shows it, but the size of the motion against the force does.
//!
//! `z_rc = X_rc / X_model,rc` of the channels that move. Missing damping and a detuned model change it too, though never by the
//! same factor on and beside the resonances of several modes: the medians of `ln |z|` must agree from frequency to frequency.

use super::cells::Cells;
use super::fault::{ChannelFault, Fault, known_unit};
use super::search::{mean, median, word};

/// Largest distance of a frequency's median from the factor, natural logarithm, and largest median distance of all runs.
const WITHIN: f64 = 0.35;
const SPREAD: f64 = 0.2;
/// Largest distance of the factor from 1 where only the sign is wrong.
const UNCHANGED: f64 = 0.3;
/// Cosine of the phase of a run below which it is reversed.
const REVERSED: f64 = -0.5;
/// Error up to which it is mended, and that over the error before.
const MENDED: f64 = 0.35;
const FALLS: f64 = 0.35;
/// Error up to which one frequency is enough.
const CLEAR: f64 = 0.1;

/// The fault; `channels` are the names of the response channels, `forces` those of the force channels.
pub(super) fn common(channels: &[String], forces: &[String], cells: &[Cells]) -> Option<ChannelFault> {
    let seen: Vec<Seen> = cells.iter().filter_map(Seen::of).collect();
    let logs: Vec<f64> = seen.iter().map(|run| run.log).collect();
    let middle = median(&logs);
    let spread = median(&logs.iter().map(|log| (log - middle).abs()).collect::<Vec<f64>>());
    let groups = seen.iter().map(|run| run.frequency + 1).max()?;
    let at = |f: usize, of: fn(&Seen) -> f64| {
        let values: Vec<f64> = seen.iter().filter(|run| run.frequency == f).map(of).collect();
        (!values.is_empty()).then(|| median(&values))
    };
    let frequencies: Vec<usize> = (0..groups).filter(|&f| at(f, |run| run.log).is_some()).collect();
    let reversed = frequencies.iter().all(|&f| at(f, |run| run.cosine).is_some_and(|cosine| cosine < REVERSED));
    let sign = if reversed { -1.0 } else { 1.0 };
    let (names, factor) = named(channels, forces, sign, middle)?;
    // A force that reads too large makes every motion look too small.
    let of_motion = if names[0].starts_with("force@") { 1.0 / factor } else { factor };
    let same = |&f: &usize| at(f, |run| run.log).is_some_and(|log| (log - of_motion.abs().ln()).abs() < WITHIN);
    if spread > SPREAD || !frequencies.iter().all(same) {
        return None;
    }
    let error = |factor: f64| mean(&cells.iter().map(|cells| cells.error_with(factor)).collect::<Vec<f64>>());
    let (error_before, error_after) = (error(1.0), error(of_motion));
    let most = if frequencies.len() > 1 { MENDED } else { CLEAR };
    (error_after < most && error_after < FALLS * error_before).then_some(ChannelFault {
        fault: Fault::Common(factor),
        channels: names,
        error_before,
        error_after,
        own_error: [error_before, error_after],
        frequencies: [frequencies.len(), frequencies.len()],
    })
}

/// The channels that are misread, and their factor: of the motions where they have one unit, else of the force.
fn named(channels: &[String], forces: &[String], sign: f64, middle: f64) -> Option<(Vec<String>, f64)> {
    let one_quantity = channels.windows(2).all(|pair| word(&pair[0]) == word(&pair[1]));
    if middle.abs() < UNCHANGED {
        // One cable of the force is turned sooner than those of all sensors.
        let whose = if forces.len() == 1 { forces } else { channels };
        return (sign < 0.0 && !whose.is_empty()).then(|| (whose.to_vec(), -1.0));
    }
    let of = |names: &[String], seen: f64| Some((names.to_vec(), sign * known_unit(names.first()?, seen)?));
    let motions = if one_quantity { of(channels, middle.exp()) } else { None };
    motions.or_else(|| of(forces, (-middle).exp()))
}

/// What a run says.
struct Seen {
    frequency: usize,
    /// Median of `ln |z|`.
    log: f64,
    /// Median cosine of the phase.
    cosine: f64,
}

impl Seen {
    fn of(cells: &Cells) -> Option<Self> {
        let ratios: Vec<_> = cells.ratios().into_iter().map(|(_, z)| z).filter(|z| z.norm() > 0.0).collect();
        let of = |value: fn(&faer::c64) -> f64| median(&ratios.iter().map(value).collect::<Vec<f64>>());
        let (log, cosine) = (of(|z| z.norm().ln()), of(|z| z.re / z.norm()));
        (!ratios.is_empty()).then_some(Self { frequency: cells.frequency, log, cosine })
    }
}

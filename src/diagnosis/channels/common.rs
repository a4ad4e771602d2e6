//! A fault of all motions at once, or of the force: no shape shows it, but the size of the motion against the force does.
//!
//! `z_rc = X_rc / X_model,rc` of the channels that move. Missing damping and a detuned model change it too, though never by the
//! same factor on and beside the resonances of several modes: most runs must agree, at several frequencies.

use super::cells::Cells;
use super::fault::{ChannelFault, Fault, known_unit, quantity_of};
use crate::math::statistics::median;

/// Largest distance of a run from the factor, natural logarithm.
const WITHIN: f64 = 0.35;
/// Share of the runs that must show the factor: a detuned model hides it next to its resonances.
const SHARE: f64 = 0.6;
/// Fewest frequencies at which it must show.
const FREQUENCIES: usize = 2;
/// Largest distance of the factor from 1 where only the sign is wrong.
const UNCHANGED: f64 = 0.3;
/// Cosine of the phase of a run below which it is reversed.
const REVERSED: f64 = -0.5;
/// Error up to which it is mended, and that over the error before.
const MENDED: f64 = 0.35;
const FALLS: f64 = 0.35;

/// The fault; `channels` are the names of the response channels, `forces` those of the force channels.
pub(super) fn common(channels: &[String], forces: &[String], cells: &[Cells]) -> Option<ChannelFault> {
    let seen: Vec<Seen> = cells.iter().filter_map(Seen::of).collect();
    let middle = median(&seen.iter().map(|run| run.log).collect::<Vec<f64>>());
    let most = |holds: &dyn Fn(&Seen) -> bool| {
        let runs: Vec<usize> = seen.iter().filter(|run| holds(run)).map(|run| run.frequency).collect();
        let mut frequencies = runs.clone();
        frequencies.sort_unstable();
        frequencies.dedup();
        (runs.len() as f64 >= SHARE * seen.len() as f64).then_some(frequencies.len())
    };
    let sign = if most(&|run| run.cosine < REVERSED).is_some() { -1.0 } else { 1.0 };
    let (names, factor) = named(channels, forces, sign, middle)?;
    // A force that reads too large makes every motion look too small.
    let of_motion: f64 = if names[0].starts_with("force@") { 1.0 / factor } else { factor };
    let same = |run: &Seen| (run.log - of_motion.abs().ln()).abs() < WITHIN && sign * run.cosine > -REVERSED;
    let shown = most(&same).filter(|frequencies| *frequencies >= FREQUENCIES)?;
    let error = |factor: f64| median(&cells.iter().map(|cells| cells.error_with(factor)).collect::<Vec<f64>>());
    let (error_before, error_after) = (error(1.0), error(of_motion));
    (error_after < MENDED && error_after < FALLS * error_before).then_some(ChannelFault {
        fault: Fault::Common(factor),
        channels: names,
        error_before,
        error_after,
        own_error: [error_before, error_after],
        frequencies: [shown, cells.iter().map(|cells| cells.frequency + 1).max().unwrap_or(0)],
    })
}

/// The channels that are misread, and their factor: of the motions where they have one unit, else of the force.
fn named(channels: &[String], forces: &[String], sign: f64, middle: f64) -> Option<(Vec<String>, f64)> {
    let one_quantity = channels.windows(2).all(|pair| quantity_of(&pair[0]) == quantity_of(&pair[1]));
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

//! A fault that all motions have in common, or the force: no shape shows it, but the modal masses do.
//!
//! Next to mode j, with a shape of modal mass 1, the modal amplitude q under the modal force `f = sum of phi_j F` has
//!
//! ```text
//! f / q = w_j^2 - w^2 + 2 i zeta w_j w,        d Re(f / q) / d(w^2) = -1
//! ```
//!
//! whatever frequency and damping of the mode are: a model out of tune or without its damping changes the intercept and the
//! imaginary part, and the slope as little as its mass is wrong. Where all motions read s times too large, and the force t times,
//! the slope is `-t / s`. D. J. Ewins, *Modal Testing*, 2nd edition, 4.3 (inverse receptance of one mode).

use super::cells::{Cells, NextToMode};
use super::fault::{ChannelFault, Fault, known_unit, quantity_of};
use crate::math::statistics::median;
use crate::measurement::Quantity;
use crate::measurement::channel::STANDARD_GRAVITY;

/// Largest distance of the apparent mass of a mode from that of all, natural logarithm.
const WITHIN: f64 = 0.3;
/// Share of the modes that must show it, and how many where there are several.
const SHARE: f64 = 0.6;
const MODES: usize = 2;
/// Runs at different frequencies from which on one mode alone is accepted.
const ALONE: usize = 3;
/// Largest relative error of its mass by the factor of the misreading then. A strong nonlinear spring or friction next to a mode changes
/// the slope too, by any factor, where masses of models are right to some per cent.
const ALONE_WITHIN: f64 = 0.1;
/// Least relative spread of the squared frequencies of the runs next to a mode.
const APART: f64 = 1e-3;
/// Largest relative distance of the frequency of the mode by its line from that of the model.
const FOUND: f64 = 0.15;
/// Distance of the mass from 1 up to which only its sign may be wrong.
const UNCHANGED: f64 = 0.3;
/// Largest scatter of the points about their line, over their spread along it.
const SCATTER: f64 = 0.35;

/// What all motions, or the force, read: `channels` are the names of the response channels, `forces` those of the forces.
pub(super) fn common(channels: &[String], forces: &[String], cells: &[Cells]) -> Option<ChannelFault> {
    let runs: Vec<NextToMode> = cells.iter().filter_map(Cells::next_to_mode).collect();
    let masses = masses(&runs);
    let enough = masses.len() >= MODES || masses.iter().any(|(_, runs)| *runs >= ALONE);
    if !enough {
        return None;
    }
    let negative = masses.iter().filter(|(mass, _)| *mass < 0.0).count();
    let sign = if 2 * negative > masses.len() { -1.0 } else { 1.0 };
    let logs: Vec<f64> = masses.iter().filter(|(mass, _)| sign * mass > 0.0).map(|(mass, _)| mass.abs().ln()).collect();
    let middle = median(&logs);
    let shown = logs.iter().filter(|log| (*log - middle).abs() < WITHIN).count();
    if (shown as f64) < SHARE * masses.len() as f64 {
        return None;
    }
    // A hammer that roves is one channel, whatever the places it is named by.
    let one_force =
        forces.len() == 1 || cells.iter().filter_map(|cell| cell.nearest.as_ref()).all(|n| n.alone.is_some());
    let (names, factor) = named(channels, forces, one_force, sign, middle)?;
    let mended = if names[0].starts_with("force@") { factor } else { 1.0 / factor };
    let error = |by: f64| {
        let relative_error = |mass: f64| (mass / by - 1.0).abs() / (mass / by).abs().max(1.0);
        median(&masses.iter().map(|(mass, _)| relative_error(*mass)).collect::<Vec<f64>>())
    };
    let (error_before, error_after) = (error(1.0), error(mended));
    if !is_accepted(masses.len(), error_after) {
        return None;
    }
    Some(ChannelFault {
        fault: Fault::Common(factor),
        channels: names,
        error_before,
        error_after,
        own_error: [error_before, error_after],
        frequencies: [shown, masses.len()],
    })
}

/// Whether so many modes say a factor that leaves an error of their masses.
fn is_accepted(modes: usize, error_after: f64) -> bool {
    modes >= MODES || error_after <= ALONE_WITHIN
}

/// The channels that are misread, and their factor: of the motions where they have one unit, else of the forces, which are `one_force`
/// where they act one at a time. A factor that either may have is that of one force rather than of several sensors, but for that of
/// g, which all accelerometers of a system share and forces in kgf hardly have.
fn named(
    channels: &[String],
    forces: &[String],
    one_force: bool,
    sign: f64,
    middle: f64,
) -> Option<(Vec<String>, f64)> {
    if middle.abs() < UNCHANGED {
        // One cable of the force is turned sooner than those of all sensors.
        let whose = if one_force && !forces.is_empty() { forces } else { channels };
        return (sign < 0.0 && !whose.is_empty()).then(|| (whose.to_vec(), -1.0));
    }
    let one_quantity = channels.windows(2).all(|pair| quantity_of(&pair[0]) == quantity_of(&pair[1]));
    let misread_as = |names: &[String], seen: f64| Some((names.to_vec(), sign * known_unit(names.first()?, seen)?));
    let motions = if one_quantity { misread_as(channels, (-middle).exp()) } else { None };
    let force = misread_as(forces, middle.exp());
    let is_of_g = |(names, factor): &(Vec<String>, f64)| {
        quantity_of(&names[0]) == Some(Quantity::Acceleration) && is_gravity(factor.abs())
    };
    let sooner_force = one_force && channels.len() > 1 && !motions.as_ref().is_some_and(is_of_g);
    if sooner_force { force.or(motions) } else { motions.or(force) }
}

/// Whether a factor is that of g on m/s^2, one way or the other.
fn is_gravity(factor: f64) -> bool {
    [STANDARD_GRAVITY, 1.0 / STANDARD_GRAVITY].contains(&factor)
}

/// Apparent modal mass of every mode with runs on a line about it, and the number of these.
fn masses(runs: &[NextToMode]) -> Vec<(f64, usize)> {
    let runs: Vec<&NextToMode> = runs.iter().collect();
    by_mode(&runs).into_iter().map(|(_, found)| found).collect()
}

/// The same with the number of each mode.
pub(super) fn by_mode(runs: &[&NextToMode]) -> Vec<(usize, (f64, usize))> {
    let mut modes: Vec<usize> = runs.iter().map(|run| run.mode).collect();
    modes.sort_unstable();
    modes.dedup();
    let of_mode = |mode: usize| mass(&runs.iter().filter(|run| run.mode == mode).copied().collect::<Vec<_>>());
    modes.into_iter().filter_map(|mode| Some((mode, of_mode(mode)?))).collect()
}

/// Modal mass by the slope over the runs next to a mode, and their number.
fn mass(runs: &[&NextToMode]) -> Option<(f64, usize)> {
    let n = runs.len() as f64;
    let x: Vec<f64> = runs.iter().map(|run| run.omega.powi(2)).collect();
    let y: Vec<f64> = runs.iter().map(|run| run.stiffness).collect();
    let (middle, height) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let spread: f64 = x.iter().map(|x| (x - middle).powi(2)).sum();
    if runs.len() < 2 || (spread / n).sqrt() < APART * middle {
        return None;
    }
    let slope = x.iter().zip(&y).map(|(x, y)| (x - middle) * (y - height)).sum::<f64>() / spread;
    // Where the line crosses zero is the mode.
    let found = (middle - height / slope).max(0.0).sqrt() / runs[0].omega_mode - 1.0;
    let left: f64 = x.iter().zip(&y).map(|(x, y)| (y - height - slope * (x - middle)).powi(2)).sum();
    let line = left <= SCATTER.powi(2) * slope * slope * spread;
    (slope != 0.0 && line && found.abs() < FOUND).then_some((-slope, runs.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs next to modes of unit mass, out of tune by 1 %, whose force reads `times` too large.
    fn runs(times: f64) -> Vec<NextToMode> {
        let about = |(mode, omega_mode): (usize, f64)| {
            [0.98, 1.0, 1.02].map(|share| {
                let (own, omega) = (1.01 * omega_mode, share * omega_mode);
                NextToMode { mode, omega_mode, omega, stiffness: times * (own * own - omega * omega) }
            })
        };
        [(0, 60.0), (1, 390.0)].into_iter().flat_map(about).collect()
    }

    #[test]
    fn the_mass_of_a_mode_is_told_whatever_its_frequency() {
        for times in [1.0, -1.0, 9.806_65, 1.0 / 9.806_65] {
            for (mass, count) in masses(&runs(times)) {
                assert!((mass / times - 1.0).abs() < 1e-9 && count == 3, "{mass} {times}");
            }
        }
        // One run a mode, or runs at one frequency, say nothing.
        assert!(masses(&runs(1.0)[..1]).is_empty());
    }

    /// A Bouc-Wen joint under an isolated building showed a mass of 2.56, which is no 3.28 of feet.
    #[test]
    fn one_mode_alone_must_fit_its_factor() {
        assert!(is_accepted(1, 0.03) && !is_accepted(1, 0.22) && is_accepted(2, 0.22));
    }

    #[test]
    fn motions_of_one_unit_go_before_the_force() {
        let names = |list: &[&str]| list.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let (motions, force) = (names(&["acc@3", "acc@5"]), names(&["force@5"]));
        let g = 9.806_65_f64;
        assert_eq!(named(&motions, &force, true, 1.0, g.ln()), Some((motions.clone(), 1.0 / g)));
        assert_eq!(named(&motions, &force, true, -1.0, 0.02), Some((force.clone(), -1.0)));
        assert_eq!(named(&motions, &force, true, 1.0, 0.02), None);
        assert_eq!(named(&motions, &force, true, 1.0, 4.448_f64.ln()).map(|found| found.0), Some(force.clone()));
        assert_eq!(named(&motions, &[], true, 1.0, 2.0_f64.ln()), None);
        // A thousandth may be that of either: of one force rather than of all sensors, but not of several forces.
        let of_either = |one_force| named(&motions, &force, one_force, 1.0, 1e3_f64.ln()).map(|found| found.0);
        assert_eq!(of_either(true), Some(force.clone()));
        assert_eq!(of_either(false), Some(motions.clone()));
        assert_eq!(named(&motions, &force, false, -1.0, 0.02).map(|found| found.0), Some(motions.clone()));
    }
}

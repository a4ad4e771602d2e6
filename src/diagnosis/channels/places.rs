//! A sensor or a force that is at another DOF than is said: the one that fits best there.
//!
//! A sensor is told by the ratios of the shape: what the other channels say of the motion at every other DOF is compared with
//! what it reads. A force is told next to the modes, where the modal amplitude q under a force F at the DOF k is
//!
//! ```text
//! phi_k F / q = w_j^2 - w^2 + 2 i zeta w_j w,        d Re(F / q) / d(w^2) = -1 / phi_k,j
//! ```
//!
//! so that the slope of `F / q` is the shape of mode j where the force truly acts, whatever frequency and damping of the mode are.
//! The shapes of several modes tell one DOF from the others. D. J. Ewins, *Modal Testing*, 2nd edition, 4.3.

use super::cells::{Cells, NextToForce};
use super::common::by_mode;
use super::fault::{ChannelFault, Fault};
use crate::math::statistics::mean;
use crate::structure::Structure;
use crate::structure::modes::Modes;

/// Error of a place from which on another is looked for, and up to which the other is accepted, relative.
const MISPLACED: f64 = 0.3;
const FITS: f64 = 0.15;
/// The error at the other place over that at the one that is said.
const FALLS: f64 = 0.35;
/// Fewest modes or frequencies: few shapes fit some DOF by chance.
pub(super) const FEWEST: usize = 3;
/// Share of them that must show it.
const EVERYWHERE: f64 = 0.85;
/// A shape below this share of the largest of its mode is no measure of an error.
const SMALL: f64 = 0.1;

/// The DOFs of the same direction as `dof`.
fn alike(structure: &Structure, dof: usize) -> impl Iterator<Item = usize> + '_ {
    let direction = structure.dofs()[dof].direction;
    (0..structure.len()).filter(move |&other| other != dof && structure.dofs()[other].direction == direction)
}

/// The DOF at which channel number `channel`, said to be at `dof`, fits best by what the others say of the motion: of those of
/// its direction at which none of `taken` is.
pub(super) fn of_sensor(
    cells: &[Cells],
    modes: &Modes,
    structure: &Structure,
    [channel, dof]: [usize; 2],
    taken: &[usize],
) -> Option<usize> {
    let mut runs = Vec::new();
    for cells in cells {
        if let Some(i) = cells.channels.iter().position(|&c| c == channel) {
            runs.push((cells, i, cells.free_amplitudes(&cells.measured, Some(i))));
        }
    }
    let error = |place: usize| {
        let errors: Vec<f64> =
            runs.iter().filter_map(|(cells, i, free)| cells.error_at(*i, place, free, modes)).collect();
        if errors.is_empty() { f64::INFINITY } else { errors.iter().sum::<f64>() / errors.len() as f64 }
    };
    let free = alike(structure, dof).filter(|place| !taken.contains(place));
    free.map(|place| (place, error(place))).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// The force that fits the motion at another DOF than is said, the plainest of all: `names` are those of the forces, `dofs`
/// where they are said to act.
pub(super) fn of_force(
    names: &[String],
    dofs: &[usize],
    structure: &Structure,
    modes: &Modes,
    cells: &[Cells],
) -> Option<ChannelFault> {
    let runs: Vec<NextToForce> = cells.iter().filter_map(Cells::next_to_force).collect();
    let of_one = |force: usize| moved(&names[force], dofs[force], &shape(&runs, force), structure, modes);
    let all = (0..names.len()).filter_map(of_one);
    all.max_by(|a, b| (a.error_before - a.error_after).total_cmp(&(b.error_before - b.error_after)))
}

/// Shapes of the modes where force number `force` acts, by their numbers.
fn shape(runs: &[NextToForce], force: usize) -> Vec<(usize, f64)> {
    let own: Vec<_> = runs.iter().filter(|run| run.force == force).map(|run| &run.run).collect();
    by_mode(&own).into_iter().map(|(mode, (inverse, _))| (mode, 1.0 / inverse)).collect()
}

/// The DOF of the direction of `said` at which the only force fits best, where it fits well.
pub(super) fn best_of_force(said: usize, structure: &Structure, modes: &Modes, cells: &[Cells]) -> Option<usize> {
    let runs: Vec<NextToForce> = cells.iter().filter_map(Cells::next_to_force).collect();
    let shape = shape(&runs, 0);
    let all = alike(structure, said).chain([said]);
    let error = |place: usize| mean(&errors(&shape, place, structure, modes));
    let best = all.map(|place| (place, error(place))).min_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|(_, error)| shape.len() >= FEWEST && *error < FITS).map(|(place, _)| place)
}

/// The fault of a force said to act at `dof`, where the shapes of the modes, number and value each, say another DOF.
fn moved(name: &str, dof: usize, shape: &[(usize, f64)], structure: &Structure, modes: &Modes) -> Option<ChannelFault> {
    if shape.len() < FEWEST {
        return None;
    }
    let before = errors(shape, dof, structure, modes);
    let all = alike(structure, dof).map(|place| (place, errors(shape, place, structure, modes)));
    let (place, after) = all.min_by(|a, b| mean(&a.1).total_cmp(&mean(&b.1)))?;
    let (error_before, error_after) = (mean(&before), mean(&after));
    let shown = before.iter().zip(&after).filter(|(was, is)| is < was).count();
    let plain = error_before > MISPLACED && error_after < FITS && error_after < FALLS * error_before;
    (plain && shown as f64 >= EVERYWHERE * shape.len() as f64).then(|| ChannelFault {
        fault: Fault::Elsewhere(place),
        channels: vec![name.to_owned(), renamed(name, structure.label(place))],
        error_before,
        error_after,
        own_error: [error_before, error_after],
        frequencies: [shown, shape.len()],
    })
}

/// Relative errors of the shapes at a DOF against those of the model.
fn errors(shape: &[(usize, f64)], dof: usize, structure: &Structure, modes: &Modes) -> Vec<f64> {
    let error = |&(mode, seen): &(usize, f64)| {
        let largest = alike(structure, dof).chain([dof]).map(|d| modes.shapes[(d, mode)].abs()).fold(0.0, f64::max);
        let own = modes.shapes[(dof, mode)];
        (seen - own).abs() / seen.abs().max(own.abs()).max(SMALL * largest)
    };
    shape.iter().map(error).collect()
}

/// The name of a channel at another label.
pub(super) fn renamed(name: &str, label: &str) -> String {
    format!("{}@{label}", name.split('@').next().unwrap_or_default())
}

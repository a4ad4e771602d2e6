//! The frequency responses of a project on all lines of their files, all references by all responses.

use super::responses::{FrequencyResponses, SAME_LINE};
use crate::math::fill::{filled, filled_complex};
use crate::measurement::{Run, WholeFunction, WholeFunctions};
use faer::Mat;
use std::sync::Arc;

impl FrequencyResponses {
    /// From the functions that the enabled runs are lines of, on all their lines; else from the enabled runs with one exciter.
    /// `None` without either.
    pub fn from_runs(runs: &[Run]) -> Option<Self> {
        whole(runs).or_else(|| Self::from_steady(runs))
    }
}

/// The functions between two DOFs, by force, then by response.
type Pairs<'a> = Vec<(usize, Vec<&'a WholeFunction>)>;

/// The matrix of the functions that these runs are lines of; `None` where they are of none. Several files belong together
/// where they have the same lines, those of the largest go first. A force with fewer responses than others is left out where
/// the matrix is larger without it.
fn whole(runs: &[Run]) -> Option<FrequencyResponses> {
    let mut sets: Vec<&Arc<WholeFunctions>> = Vec::new();
    for set in runs.iter().filter(|run| run.enabled).filter_map(|run| run.functions.as_ref()) {
        if !sets.iter().any(|known| Arc::ptr_eq(known, set)) {
            sets.push(set);
        }
    }
    let main = *sets.iter().max_by_key(|set| set.functions.len() * set.omega.len())?;
    let alike = |set: &&&Arc<WholeFunctions>| same_lines(&set.omega, &main.omega);
    let functions: Vec<&WholeFunction> = sets.iter().filter(alike).flat_map(|set| &set.functions).collect();
    let drives = largest(by_force(&functions));
    let sensors: Vec<usize> = common(&drives);
    let found = matrix(&main.omega, &sensors, &drives);
    // By reciprocity: a roving hammer has one sensor and many forces, whose shapes are those of the places that it hit.
    Some(if found.drives.len() > found.sensors.len() { transposed(found) } else { found })
}

fn same_lines(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME_LINE * b)
}

/// The functions of every force, the force with most first; of two between the same DOFs the first.
fn by_force<'a>(functions: &[&'a WholeFunction]) -> Pairs<'a> {
    let mut forces: Pairs<'a> = Vec::new();
    for &function in functions {
        let at = forces.iter().position(|(force, _)| *force == function.reference).unwrap_or_else(|| {
            forces.push((function.reference, Vec::new()));
            forces.len() - 1
        });
        if !forces[at].1.iter().any(|known| known.response == function.response) {
            forces[at].1.push(function);
        }
    }
    forces.sort_by_key(|(_, list)| std::cmp::Reverse(list.len()));
    forces
}

/// The forces whose common responses make the largest matrix.
fn largest(mut forces: Pairs<'_>) -> Pairs<'_> {
    let size = |count: usize| count * common(&forces[..count]).len();
    let best = (1..=forces.len()).max_by_key(|&count| (size(count), std::cmp::Reverse(count))).unwrap_or(0);
    forces.truncate(best);
    forces.sort_by_key(|(force, _)| *force);
    forces
}

/// DOFs of the responses that all forces have, ascending.
fn common(forces: &[(usize, Vec<&WholeFunction>)]) -> Vec<usize> {
    let Some((_, first)) = forces.first() else { return Vec::new() };
    let everywhere = |dof: &usize| forces.iter().all(|(_, list)| list.iter().any(|one| one.response == *dof));
    let mut dofs: Vec<usize> = first.iter().map(|one| one.response).filter(everywhere).collect();
    dofs.sort_unstable();
    dofs
}

fn matrix(omega: &[f64], sensors: &[usize], forces: &Pairs<'_>) -> FrequencyResponses {
    let places_of_sensors = |list: &Vec<&WholeFunction>| -> Vec<usize> {
        sensors.iter().filter_map(|dof| list.iter().position(|one| one.response == *dof)).collect()
    };
    let places: Vec<Vec<usize>> = forces.iter().map(|(_, list)| places_of_sensors(list)).collect();
    let function = |i: usize, j: usize| forces[j].1[places[j][i]];
    let (rows, columns) = (sensors.len(), forces.len());
    let lines = 0..omega.len();
    let value = |k: usize| filled_complex(rows, columns, |i, j| function(i, j).receptance[k]);
    let deviation = |k: usize| filled(rows, columns, |i, j| function(i, j).deviation[k]);
    FrequencyResponses {
        omega: omega.to_vec(),
        sensors: sensors.to_vec(),
        drives: forces.iter().map(|(force, _)| *force).collect(),
        values: lines.clone().map(value).collect(),
        deviations: lines.map(deviation).collect(),
    }
}

fn transposed(found: FrequencyResponses) -> FrequencyResponses {
    FrequencyResponses {
        omega: found.omega,
        sensors: found.drives,
        drives: found.sensors,
        values: found.values.iter().map(|h| h.transpose().to_owned()).collect(),
        deviations: found.deviations.iter().map(|d: &Mat<f64>| d.transpose().to_owned()).collect(),
    }
}

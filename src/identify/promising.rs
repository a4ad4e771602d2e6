//! The most promising of very many columns: non-negative least squares over all of them by column generation. Each round adds
//! the columns along which the residual falls fastest and lets go of those that have become useless; where no column is left
//! along which it falls, the solution is that of all columns (Karush-Kuhn-Tucker conditions; Lawson and Hanson, 1974).

use super::{IdentifyError, system::System};
use crate::math::nnls::nnls;

/// Columns up to which all are taken.
pub(super) const MANY: usize = 200;
/// Columns that a round adds.
const ADDED: usize = 20;
/// Most rounds.
const ROUNDS: usize = 40;
/// Cosine from which on two columns are alike: of those one a round is enough.
const ALIKE: f64 = 0.995;
/// Share of the residual by which a round must lower it.
const PROGRESS: f64 = 1e-4;

/// Numbers of the columns, ascending; `forced` ones are among them.
pub(super) fn promising(system: &System, forced: &[usize]) -> Result<Vec<usize>, IdentifyError> {
    let n = system.a.ncols();
    if n <= MANY {
        return Ok((0..n).collect());
    }
    let norms: Vec<f64> = (0..n).map(|j| system.a.col(j).norm_l2()).collect();
    let mut chosen: Vec<usize> = forced.to_vec();
    let mut residual = system.b.clone();
    let mut size = f64::INFINITY;
    let mut dropped: Vec<usize> = Vec::new();
    for _ in 0..ROUNDS {
        let added = steepest(system, &norms, &residual, &chosen, ADDED.min(MANY - chosen.len()));
        if added.is_empty() {
            break;
        }
        chosen.extend(added);
        let solution = non_negative(system, &chosen)?;
        residual.copy_from_slice(&system.b);
        for (&j, c) in chosen.iter().zip(&solution).filter(|(_, c)| **c > 0.0) {
            residual.iter_mut().zip(system.a.col(j).iter()).for_each(|(r, x)| *r -= c * x);
        }
        let useful = |(j, c): (&usize, &f64)| *c > 0.0 || forced.contains(j);
        let (kept, useless): (Vec<_>, Vec<_>) = chosen.iter().zip(&solution).partition(|&(j, c)| useful((j, c)));
        dropped.extend(useless.into_iter().map(|(j, _)| *j));
        chosen = kept.into_iter().map(|(j, _)| *j).collect();
        let left = residual.iter().map(|r| r * r).sum::<f64>();
        if left > (1.0 - PROGRESS) * size || chosen.len() >= MANY {
            break;
        }
        size = left;
    }
    // What was nearly as good stands beside the solution, the last first, for the search of sets.
    dropped.reverse();
    dropped.extend(steepest(system, &norms, &system.b, &chosen, MANY));
    for j in dropped {
        if chosen.len() < MANY && !chosen.contains(&j) {
            chosen.push(j);
        }
    }
    chosen.sort_unstable();
    Ok(chosen)
}

/// The columns along which the residual falls fastest, of those that are alike the best one.
fn steepest(system: &System, norms: &[f64], residual: &[f64], chosen: &[usize], most: usize) -> Vec<usize> {
    let a = &system.a;
    let gain = |j: usize| a.col(j).iter().zip(residual).map(|(x, r)| x * r).sum::<f64>() / norms[j];
    let mut is_chosen = vec![false; norms.len()];
    chosen.iter().for_each(|&j| is_chosen[j] = true);
    let open = (0..norms.len()).filter(|&j| !is_chosen[j] && norms[j] > 0.0);
    let mut order: Vec<(f64, usize)> = open.map(|j| (gain(j), j)).filter(|(gain, _)| *gain > 0.0).collect();
    order.sort_by(|x, y| y.0.total_cmp(&x.0));
    let cosine = |i: usize, j: usize| {
        a.col(i).iter().zip(a.col(j).iter()).map(|(x, y)| x * y).sum::<f64>() / norms[i] / norms[j]
    };
    let mut best: Vec<usize> = Vec::new();
    for &(_, j) in order.iter().take(8 * most) {
        if best.len() == most {
            break;
        }
        // In a list that is as long as the whole choice, alike columns are alternatives.
        if most == MANY || best.iter().all(|&i| cosine(i, j) < ALIKE) {
            best.push(j);
        }
    }
    best
}

/// Non-negative least squares on some of the columns.
pub(super) fn non_negative(system: &System, columns: &[usize]) -> Result<Vec<f64>, IdentifyError> {
    let (a, b) = system.compressed(columns);
    Ok(nnls(a.as_ref(), &b)?.solution)
}

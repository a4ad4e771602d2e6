//! The most promising of very many columns: those that explain most of what the best so far leave, in rounds.

use super::{IdentifyError, system::System};
use crate::math::nnls::nnls;

/// Columns up to which all are taken.
pub(super) const MANY: usize = 200;
/// Rounds in which they are chosen.
const ROUNDS: usize = 10;

/// Numbers of the columns, ascending; `forced` ones are among them.
pub(super) fn promising(system: &System, forced: &[usize]) -> Result<Vec<usize>, IdentifyError> {
    let (a, b) = (&system.a, &system.b);
    let n = a.ncols();
    if n <= MANY {
        return Ok((0..n).collect());
    }
    let norms: Vec<f64> = (0..n).map(|j| a.col(j).norm_l2()).collect();
    let mut is_chosen = vec![false; n];
    let mut chosen: Vec<usize> = forced.to_vec();
    forced.iter().for_each(|&j| is_chosen[j] = true);
    let mut residual = b.clone();
    while chosen.len() < MANY {
        let gain = |j: usize| a.col(j).iter().zip(&residual).map(|(x, r)| x * r).sum::<f64>() / norms[j];
        let mut order: Vec<(f64, usize)> =
            (0..n).filter(|&j| !is_chosen[j] && norms[j] > 0.0).map(|j| (gain(j), j)).collect();
        order.sort_by(|x, y| y.0.total_cmp(&x.0));
        if order.is_empty() {
            break;
        }
        let best = order.iter().take(MANY / ROUNDS).map(|(_, j)| *j);
        chosen.extend(best);
        chosen.iter().for_each(|&j| is_chosen[j] = true);
        let solution = non_negative(system, &chosen)?;
        residual.copy_from_slice(b);
        for (&j, c) in chosen.iter().zip(&solution).filter(|(_, c)| **c > 0.0) {
            residual.iter_mut().zip(a.col(j).iter()).for_each(|(r, x)| *r -= c * x);
        }
    }
    chosen.sort_unstable();
    Ok(chosen)
}

/// Non-negative least squares on some of the columns.
pub(super) fn non_negative(system: &System, columns: &[usize]) -> Result<Vec<f64>, IdentifyError> {
    let (a, b) = system.compressed(columns);
    Ok(nnls(a.as_ref(), &b)?.solution)
}

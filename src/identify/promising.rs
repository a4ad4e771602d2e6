//! The most promising of very many columns: those of the non-negative least squares solution over all of them, and those that
//! come nearest to entering it.
//!
//! Column generation: solve on a few columns, look which of all others the residual asks for most (`a_j^T r / |a_j|`), let
//! those in and those with no part in the solution out, until none is asked for. The solution then is that over all columns
//! (Karush, Kuhn and Tucker). Columns of neighbouring places are nearly parallel: taken by their gain once and kept, they
//! would crowd out the places that matter less.

use super::{IdentifyError, system::System};
use crate::math::nnls::nnls;
use dashpot_numerics::transposed_product;
use faer::{Mat, MatRef};

/// Columns up to which all are taken.
pub(super) const MANY: usize = 200;
/// Columns that are let in at once.
const ENTERING: usize = 20;
/// Most rounds; each lowers the residual.
const ROUNDS: usize = 60;
/// Gain, as a share of |b|, below which no column is asked for.
const SETTLED: f64 = 1e-7;

/// Numbers of the columns, ascending; `forced` ones are among them.
pub(super) fn promising(system: &System, forced: &[usize]) -> Result<Vec<usize>, IdentifyError> {
    let (a, b) = (&system.a, &system.b);
    let n = a.ncols();
    if n <= MANY {
        return Ok((0..n).collect());
    }
    let norms: Vec<f64> = (0..n).map(|j| a.col(j).norm_l2()).collect();
    let least = SETTLED * b.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut kept: Vec<usize> = forced.to_vec();
    let mut order = by_gain(a, b, &norms, &kept);
    for _ in 0..ROUNDS {
        let asked = order.iter().take_while(|(gain, _)| *gain > least).take(ENTERING);
        let tried: Vec<usize> = kept.iter().copied().chain(asked.map(|(_, j)| *j)).collect();
        if tried.len() == kept.len() || tried.len() > MANY {
            break;
        }
        let solution = non_negative(system, &tried)?;
        kept = tried.iter().zip(&solution).filter(|(j, c)| **c > 0.0 || forced.contains(j)).map(|(j, _)| *j).collect();
        let used = tried.iter().zip(&solution).filter(|(_, c)| **c > 0.0);
        let mut residual = b.clone();
        for (&j, c) in used {
            residual.iter_mut().zip(a.col(j).iter()).for_each(|(r, x)| *r -= c * x);
        }
        order = by_gain(a, &residual, &norms, &kept);
    }
    kept.extend(order.iter().map(|(_, j)| *j).take(MANY.saturating_sub(kept.len())));
    kept.sort_unstable();
    Ok(kept)
}

/// Columns that are not `kept`, those that the residual asks for most first, with their gain.
fn by_gain(a: &Mat<f64>, residual: &[f64], norms: &[f64], kept: &[usize]) -> Vec<(f64, usize)> {
    let residual = MatRef::from_column_major_slice(residual, residual.len(), 1);
    let products = transposed_product(a.as_ref(), residual);
    let mut is_kept = vec![false; norms.len()];
    kept.iter().for_each(|&j| is_kept[j] = true);
    let free = (0..norms.len()).filter(|&j| !is_kept[j] && norms[j] > 0.0);
    let mut order: Vec<(f64, usize)> = free.map(|j| (products[(j, 0)] / norms[j], j)).collect();
    order.sort_by(|x, y| y.0.total_cmp(&x.0));
    order
}

/// Non-negative least squares on some of the columns.
pub(super) fn non_negative(system: &System, columns: &[usize]) -> Result<Vec<f64>, IdentifyError> {
    let (a, b) = system.compressed(columns);
    Ok(nnls(a.as_ref(), &b)?.solution)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// Bumps of 900 neighbouring places, so wide that neighbours are nearly parallel; three are in the data.
    #[test]
    fn true_columns_are_among_them() {
        let (rows, n, truth) = (120, 900, [(140, 3.0), (150, 1.0), (610, 0.05)]);
        let bump = |i: usize, j: usize| (-((7.5 * i as f64 - j as f64) / 40.0).powi(2)).exp();
        let a = Mat::from_fn(rows, n, bump);
        let b = (0..rows).map(|i| truth.iter().map(|&(j, c)| c * bump(i, j)).sum()).collect();
        let system = System { a, b, run: (0..rows).collect(), deviation: None };
        let chosen = promising(&system, &[7]).unwrap();
        assert_eq!(chosen.len(), MANY);
        assert!(truth.iter().all(|(j, _)| chosen.contains(j)) && chosen.contains(&7));
        assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
    }
}

//! The most promising of very many columns: those of the best sets by exchange over all of them with the columns that are most
//! like them, then those that explain most of what the best so far leave, in rounds.

use super::error::IdentifyError;
use super::exchange::Exchange;
use super::system::System;
use crate::math::nnls::nnls;
use dashpot_numerics::with_columns;

/// Columns up to which all are taken.
pub(super) const MANY: usize = 200;
/// Rounds in which they are chosen.
const ROUNDS: usize = 10;
/// Largest set that is looked for by exchange.
const LARGEST: usize = 10;
/// Columns like each of its columns that are taken with it.
const ALIKE: usize = 8;

/// Numbers of the columns, ascending; `forced` ones are among them.
pub(super) fn promising(system: &System, forced: &[usize]) -> Result<Vec<usize>, IdentifyError> {
    let a = &system.a;
    let n = a.ncols();
    if n <= MANY {
        return Ok((0..n).collect());
    }
    let norms: Vec<f64> = (0..n).map(|j| a.col(j).norm_l2()).collect();
    let mut is_chosen = vec![false; n];
    let mut chosen: Vec<usize> = Vec::new();
    for j in forced.iter().copied().chain(by_exchange(system, forced)) {
        if !std::mem::replace(&mut is_chosen[j], true) {
            chosen.push(j);
        }
    }
    let mut residual = left_by(system, &chosen)?;
    while chosen.len() < MANY {
        let along = with_columns(a, &residual);
        let gain = |j: usize| along[j] / norms[j];
        let mut order: Vec<(f64, usize)> =
            (0..n).filter(|&j| !is_chosen[j] && norms[j] > 0.0).map(|j| (gain(j), j)).collect();
        order.sort_by(|x, y| y.0.total_cmp(&x.0));
        if order.is_empty() {
            break;
        }
        let best = order.iter().take(MANY / ROUNDS).map(|(_, j)| *j);
        chosen.extend(best);
        chosen.iter().for_each(|&j| is_chosen[j] = true);
        residual = left_by(system, &chosen)?;
    }
    chosen.sort_unstable();
    Ok(chosen)
}

/// The columns of the sets by exchange, and those like the columns of the largest.
fn by_exchange(system: &System, forced: &[usize]) -> Vec<usize> {
    let mut exchange = Exchange::new(system);
    let sets = exchange.sets(forced, LARGEST.min(system.rows() / 2));
    let largest = sets.last().cloned().unwrap_or_default();
    let alike: Vec<usize> = largest.iter().flat_map(|&j| exchange.alike(j, ALIKE)).collect();
    sets.into_iter().flatten().chain(alike).collect()
}

/// What non-negative least squares on some of the columns leave of the right-hand side.
fn left_by(system: &System, columns: &[usize]) -> Result<Vec<f64>, IdentifyError> {
    let mut residual = system.b.clone();
    let solution = if columns.is_empty() { Vec::new() } else { non_negative(system, columns)? };
    for (&j, c) in columns.iter().zip(&solution).filter(|(_, c)| **c > 0.0) {
        residual.iter_mut().zip(system.a.col(j).iter()).for_each(|(r, x)| *r -= c * x);
    }
    Ok(residual)
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
    use faer::Mat;

    const TRUTH: [(usize, f64); 4] = [(140, 3.0), (175, 1.0), (610, 0.05), (611, 0.02)];

    /// Bumps of 900 neighbouring places, so wide that neighbours are nearly parallel; the true ones are in the data.
    fn bumps() -> System {
        let (rows, n) = (120, 900);
        let bump = |i: usize, j: usize| (-((7.5 * i as f64 - j as f64) / 40.0).powi(2)).exp();
        let a = Mat::from_fn(rows, n, bump);
        let b = (0..rows).map(|i| TRUTH.iter().map(|&(j, c)| c * bump(i, j)).sum()).collect();
        System { a, b, run: (0..rows).collect(), deviation: None }
    }

    #[test]
    fn no_single_exchange_makes_a_set_better() {
        let system = bumps();
        let sets = Exchange::new(&system).sets(&[], 3);
        let residual = |set: &[usize]| {
            let c = non_negative(&system, set).unwrap();
            system.chi_square(set, &c)
        };
        for set in &sets {
            let found = residual(set);
            for place in 0..set.len() {
                let mut other = set.clone();
                for j in (0..900).step_by(3) {
                    other[place] = j;
                    assert!(found <= residual(&other) * (1.0 + 1e-6) + 1e-12, "{set:?} {other:?}");
                }
            }
        }
        assert!(sets[2].iter().any(|j| (600..622).contains(j)), "{:?}", sets[2]);
    }

    #[test]
    fn true_columns_are_among_the_promising_and_forced_ones_stay() {
        let system = bumps();
        let chosen = promising(&system, &[7]).unwrap();
        assert!(chosen.len() >= MANY && chosen.windows(2).all(|pair| pair[0] < pair[1]) && chosen.contains(&7));
        assert!(TRUTH.iter().all(|(j, _)| chosen.contains(j)), "{chosen:?}");
    }
}

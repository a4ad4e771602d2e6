//! Every set looked at: what branch and bound is measured against.

use super::problem::{Ranking, SubsetError, SubsetProblem, combinations};
use super::unit_problem::{Best, Unit};
use crate::control::Control;

/// Looks at every set.
///
/// # Errors
/// [`SubsetError`] for values that are not finite, forced columns that do not exist, an impossible size, or cancellation.
pub fn exhaustive(problem: &SubsetProblem<'_>, control: &Control) -> Result<Ranking, SubsetError> {
    let unit = Unit::new(problem)?;
    let free = unit.free();
    let mut best = Best::new(problem.keep);
    let mut picks: Vec<usize> = (0..unit.chosen).collect();
    let total = combinations(free.len(), unit.chosen);
    let mut nodes = 0_u64;
    if free.len() < unit.chosen {
        return Ok(best.finish(&unit, true, 0));
    }
    loop {
        if nodes.is_multiple_of(256) {
            control.check()?;
            control.report(nodes as f64 / total);
        }
        nodes += 1;
        let chosen: Vec<usize> = picks.iter().map(|&p| free[p]).collect();
        unit.try_set(&chosen, &mut best)?;
        if !next_combination(&mut picks, free.len()) {
            return Ok(best.finish(&unit, true, nodes));
        }
    }
}

/// Next combination in lexicographic order; false after the last.
fn next_combination(picks: &mut [usize], n: usize) -> bool {
    let k = picks.len();
    let Some(i) = (0..k).rev().find(|&i| picks[i] < n - k + i) else {
        return false;
    };
    picks[i] += 1;
    for j in i + 1..k {
        picks[j] = picks[j - 1] + 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn combinations_come_once_and_all() {
        let mut picks = vec![0, 1, 2];
        let mut seen = vec![picks.clone()];
        while next_combination(&mut picks, 6) {
            seen.push(picks.clone());
        }
        seen.dedup();
        assert_eq!(seen.len() as f64, combinations(6, 3));
        assert_eq!(combinations(180, 5), 1_488_847_536.0);
        assert!(!next_combination(&mut [], 4));
    }
}

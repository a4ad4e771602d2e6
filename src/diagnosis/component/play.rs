//! Play (backlash): the way after a reversal over which a component gives hardly any force.
//!
//! ```text
//! w = |d(n) - d(r)|   from the turn r of the displacement to where the force, of either sign, leaves |f| < share max|f| again
//! ```
//!
//! A spring of stiffness `k` passes that band on a way `2 share F / k`, with play on that way and the play. The same is read from
//! the measured loop and from the one that the best law gives: the difference is play.

use crate::balance::loops::Loop;
use crate::math::statistics::median;

/// Share of the largest force that is hardly any.
const SHARE: f64 = 0.15;
/// Least amplitude of a turn, as a share of the largest displacement.
const LARGE: f64 = 0.5;
/// Fewest reversals that tell.
const FEWEST: usize = 3;
/// Least play, as a share of the amplitude, and over the way of a law without it.
const LEAST: [f64; 2] = [0.05, 3.0];

/// Ways (m) over which the measured force and that of a law stay small after a reversal, where the first shows play.
pub(super) fn play(one: &Loop, law: &[f64]) -> Option<[f64; 2]> {
    let (measured, model) = (small_way(one, &one.force)?, small_way(one, law)?);
    let shown = measured - model > LEAST[0] * largest(&one.d) && measured > LEAST[1] * model;
    shown.then_some([measured, model])
}

/// Median way after a large reversal over which a force stays small.
fn small_way(one: &Loop, force: &[f64]) -> Option<f64> {
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    let centred: Vec<f64> = force.iter().map(|f| f - mean).collect();
    let (least, band) = (LARGE * largest(&one.d), SHARE * largest(&centred));
    let turns: Vec<usize> =
        (1..one.v.len()).filter(|&n| one.v[n] * one.v[n - 1] < 0.0 && one.d[n].abs() > least).collect();
    let way = |pair: &[usize]| {
        let first = (pair[0]..pair[1]).find(|&n| centred[n].abs() < band)?;
        let last = (first..pair[1]).find(|&n| centred[n].abs() >= band)?;
        Some((one.d[last] - one.d[first]).abs())
    };
    let ways: Vec<f64> = turns.windows(2).filter_map(way).collect();
    (ways.len() >= FEWEST).then(|| median(&ways))
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}

//! The memory of a law where a record begins. What happened before is not recorded, but the initial state goes on backwards: over a period
//! of the strongest mode that the law sees, each mode at its amplitude,
//!
//! ```text
//! d(-tau) = Re sum_k w_k V_k z_k e^(-i omega_k tau)
//! ```
//!
//! the law is led from rest along that motion. After a full turn between the same ends, hysteresis has forgotten what was before (Madelung's
//! rules), and a spring in series with a dashpot has relaxed towards its cycle. A record that begins with all modes at rest, as that of a
//! release does, begins on the first loading curve. Derivatives follow the states, not the frequencies of that period.

use super::system::LinearSystem;
use super::view::View;
use dashpot_numerics::dot;
use std::f64::consts::TAU;

/// Instants of the period.
const INSTANTS: usize = 48;
/// Speeds of the modes at the start over their amplitudes, summed, up to which a motion begins at rest, all modes at their ends.
const AT_REST: f64 = 0.1;

/// What the law sees of the present state `z` at instants before it, in their order, with the time between them, s; none of a motion that
/// begins at rest.
pub(super) fn earlier_views(system: &LinearSystem, view: &View, z: &[f64]) -> (Vec<View>, f64) {
    let count = system.lambda.len();
    let size = |k: usize| view.displacement[k].hypot(view.displacement[count + k]) * z[k].hypot(z[count + k]);
    let swings = (0..count).filter(|&k| system.lambda[k].im > 0.0 && size(k) > 0.0);
    let Some(strongest) = swings.max_by(|&a, &b| size(a).total_cmp(&size(b))) else {
        return (Vec::new(), f64::INFINITY);
    };
    let [mut speeds, mut amplitudes] = [0.0; 2];
    for k in 0..count {
        let (row, state) = ([view.velocity[k], view.velocity[count + k]], [z[k], z[count + k]]);
        speeds += dot(&row, &state).abs();
        amplitudes += row[0].hypot(row[1]) * state[0].hypot(state[1]);
    }
    if speeds < AT_REST * amplitudes {
        return (Vec::new(), f64::INFINITY);
    }
    let step = TAU / system.lambda[strongest].im / INSTANTS as f64;
    let earlier = |n: usize| turned(system, view, step * (INSTANTS - n) as f64);
    ((0..INSTANTS).map(earlier).collect(), step)
}

/// The displacement that is seen of a state `time` s before it.
fn turned(system: &LinearSystem, view: &View, time: f64) -> View {
    let count = system.lambda.len();
    let mut displacement = view.displacement.clone();
    for k in 0..count {
        let (sin, cos) = (system.lambda[k].im * time).sin_cos();
        let (a, b) = (displacement[k], displacement[count + k]);
        (displacement[k], displacement[count + k]) = (a * cos - b * sin, a * sin + b * cos);
    }
    View { displacement, velocity: view.velocity.clone(), acceleration: view.acceleration.clone() }
}

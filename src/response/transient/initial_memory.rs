//! The memory of a law where a record begins. What happened before is not recorded, but the initial state goes on backwards: over a period
//! of the strongest mode that the law sees, each mode at its amplitude,
//!
//! ```text
//! d(-tau) = Re sum_k w_k V_k z_k e^(-i omega_k tau)
//! ```
//!
//! the law is led from rest along that motion. After a full turn between the same ends, hysteresis has forgotten what was before (Madelung's
//! rules), and a spring in series with a dashpot has relaxed towards its cycle. A record that begins at rest aside, as one of a release does,
//! begins on the first loading curve.

use super::system::LinearSystem;
use super::view::View;
use dashpot_numerics::dot;
use std::f64::consts::TAU;

/// Instants of the period.
const INSTANTS: usize = 48;
/// Speed at the start over the greatest of the period up to which a motion that is at its end, within this share, begins at rest.
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
    let step = TAU / system.lambda[strongest].im / INSTANTS as f64;
    let earlier = |n: usize| turned(system, view, step * (INSTANTS - n) as f64);
    let views: Vec<View> = (0..INSTANTS).map(earlier).collect();
    let greatest = |row: &dyn Fn(&View) -> f64| views.iter().map(|view| row(view).abs()).fold(0.0, f64::max);
    let (displacement, velocity) = (|v: &View| dot(&v.displacement, z), |v: &View| dot(&v.velocity, z));
    let rests = velocity(view).abs() < AT_REST * greatest(&velocity);
    if rests && displacement(view).abs() > (1.0 - AT_REST) * greatest(&displacement) {
        return (Vec::new(), f64::INFINITY);
    }
    (views, step)
}

/// What is seen of a state, as seen from `time` s later on.
fn turned(system: &LinearSystem, view: &View, time: f64) -> View {
    let count = system.lambda.len();
    let turn = |row: &[f64]| {
        let mut turned = row.to_vec();
        for k in 0..count {
            let (sin, cos) = (system.lambda[k].im * time).sin_cos();
            let (a, b) = (row[k], row[count + k]);
            (turned[k], turned[count + k]) = (a * cos - b * sin, a * sin + b * cos);
        }
        turned
    };
    View {
        displacement: turn(&view.displacement),
        velocity: turn(&view.velocity),
        acceleration: view.acceleration.clone(),
    }
}

//! Stribeck friction: `F = (force + (static_force - force) exp(-|d'| / velocity)) sgn(d')`, 0 at rest.
//!
//! As a set of forces at rest: any within `+-static_force`, and the smooth part
//! `g(v) = (force - static_force) (1 - exp(-|v| / velocity)) sgn v`. The energy is `static_force` times the way travelled,
//! exactly, less the smooth part by the trapezoidal rule.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::law::{Point, Variable};
use crate::effects::limits::{CLOSE, Limit, alike};
use crate::effects::memoryless::{MemorylessLaw, sign};
use crate::effects::motion::Motion;
use crate::effects::parameter::Parameter;
use crate::effects::range::geometric;
use crate::effects::set_valued::SetValued;
use crate::effects::symbol::{Mark, Tone};
use crate::effects::turning::total_variation;

/// Share of the greatest speed at which friction has fallen as if at once: a hundredth of what the harmonics of a response resolve.
const SUDDEN: f64 = 1e-3;

/// Friction that falls from a static to a sliding force with speed.
#[derive(Debug)]
pub(crate) struct Stribeck;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    folds: true,
    shapes: |range| {
        let velocities = geometric(0.02 * range.velocity, 0.8 * range.velocity, 5);
        velocities.into_iter().flat_map(|v| [1.3, 2.0, 4.0].map(|s| vec![1.0, s, v])).collect()
    },
    // Friction that would fall at speeds far beyond those that were reached has not begun to.
    limits: &[
        Limit { law: Effect::Coulomb, holds: |p, _| alike(p[1], p[0]), parameters: |p| vec![p[0]] },
        Limit { law: Effect::Coulomb, holds: |p, range| p[2] > range.velocity / CLOSE, parameters: |p| vec![p[1]] },
        // Nor do motions tell friction that has fallen at speeds far below theirs.
        Limit { law: Effect::Coulomb, holds: |p, range| p[2] < SUDDEN * range.velocity, parameters: |p| vec![p[0]] },
    ],
    // What a series of few harmonics leaves of a jump looks like friction that rises from rest.
    disguised: |p| p[1] <= p[0],
    symbol: &[Mark::Pads(-0.5, 0.5, Tone::Faint), Mark::Line(&[(-0.3, -9.0), (0.0, -7.0), (0.3, -9.0)])],
    example: &[0.3, 0.6, 0.05],
    ..Description::new(
        "Stribeck friction",
        "F(|d'|) sgn(d')",
        "Friction that falls from a static to a sliding force with speed: lubricated contacts.",
        &[
            Parameter::shape("force", "N", "F_c", 1.0),
            Parameter::shape("static_force", "N", "F_s", 1.5),
            Parameter::shape("velocity", "m/s", "v_s", 0.01).above(0.0),
        ],
    )
};

/// What is left of the static force at velocity `v`, from 1 at rest to 0.
fn decay(p: &[f64], v: f64) -> f64 {
    let speeds = v.abs() / p[2];
    // Beyond, nothing is left of the exponential, which takes long to say so.
    if speeds < 40.0 { (-speeds).exp() } else { 0.0 }
}

impl MemorylessLaw for Stribeck {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        let excess = (p[1] - p[0]) * decay(p, v);
        let moving = if v == 0.0 { 0.0 } else { 1.0 };
        Point { force: (p[0] + excess) * sign(v), by_displacement: 0.0, by_velocity: -excess / p[2] * moving }
    }

    fn by_parameter(&self, p: &[f64], k: usize, _d: f64, v: f64) -> f64 {
        let decay = decay(p, v);
        match k {
            0 => (1.0 - decay) * sign(v),
            1 => decay * sign(v),
            _ => (p[1] - p[0]) * decay * v / (p[2] * p[2]),
        }
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        let fall = |v: &f64| -(-v.abs() / p[2]).exp_m1() * v.abs();
        let lost: f64 = motion.velocity.iter().map(fall).sum::<f64>() * motion.step();
        Some(p[1] * total_variation(motion) - (p[1] - p[0]) * lost)
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        Some(self)
    }
}

impl SetValued for Stribeck {
    fn bounds(&self, p: &[f64]) -> [f64; 2] {
        let bound = p[1].max(0.0);
        [-bound, bound]
    }

    fn bounds_by(&self, _p: &[f64], k: usize) -> [f64; 2] {
        if k == 1 { [-1.0, 1.0] } else { [0.0; 2] }
    }

    fn has_smooth_part(&self) -> bool {
        true
    }

    fn smooth_part(&self, p: &[f64], v: f64) -> [f64; 2] {
        let decay = decay(p, v);
        [(p[0] - p[1]) * (1.0 - decay) * v.signum(), (p[0] - p[1]) * decay / p[2]]
    }

    fn smooth_part_by(&self, p: &[f64], k: usize, v: f64) -> f64 {
        let decay = decay(p, v);
        match k {
            0 => (1.0 - decay) * v.signum(),
            1 => (decay - 1.0) * v.signum(),
            _ => (p[1] - p[0]) * decay * v / (p[2] * p[2]),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::effects::range::Range;
    use crate::effects::{Effect, Place, Source};

    /// Friction that has fallen at a ten thousandth of the speeds that were reached is dry friction with its sliding force.
    #[test]
    fn friction_that_has_fallen_at_once_is_dry_friction() {
        let source = |velocity: f64| Source::known(Effect::Stribeck, Place::Dofs(vec![0]), &[0.6, 0.8, velocity]);
        let range = Range { displacement: 1e-3, least: 1e-3, velocity: 0.1, omega: 100.0 };
        let simpler = source(1e-5).simpler(&range).unwrap();
        assert_eq!((simpler.effect, simpler.parameters), (Effect::Coulomb, vec![0.6]));
        assert!(source(0.02).simpler(&range).is_none() && source(1e-5).simpler(&Range::UNKNOWN).is_none());
        // Each simpler law once: with the sliding force and with the static one.
        let forces: Vec<f64> = source(0.02).limits().map(|law| law.parameters[0]).collect();
        assert_eq!(forces, [0.6, 0.8]);
    }
}

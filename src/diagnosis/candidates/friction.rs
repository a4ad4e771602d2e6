//! Friction seen from the data. A joint that hardly slides moves by little more than the noise, and the law of its motion,
//! `sgn d'`, is lost there. The force of the joint and its motion together are not: friction holds where
//!
//! ```text
//! F = g(v) + clamp(F - g(v) + r v, -bound, bound)        any r > 0
//! ```
//!
//! (Alart and Curnier 1991), with `g` the falling part of Stribeck's law. With `r` of the size of the structure's own
//! impedance, noise of the motion counts no more than that of the force, and a stuck joint agrees with every bound above
//! its force.

use crate::effects::{Effect, SetValued};

/// Sizes of friction that are tried, over the forces of the runs.
const SIZES: usize = 8;

/// The law of `effect` as friction whose force is set-valued at rest between opposite bounds, without a spring before it.
pub(crate) fn friction(effect: Effect) -> Option<&'static dyn SetValued> {
    let law = effect.law()?;
    let unit = vec![1.0; law.parameters().len()];
    let friction = law.set_valued().filter(|_| law.series_stiffness(&unit).is_none())?;
    let [low, high] = friction.bounds(&unit);
    (low == -high).then_some(friction)
}

/// Sizes (N) of friction worth trying for fundamentals of force of these `amplitudes`: those of runs that slide have
/// `4 / pi` of the friction, those of runs that stick have less.
pub(crate) fn sizes(mut amplitudes: Vec<f64>) -> Vec<f64> {
    amplitudes.retain(|a| a.is_finite() && *a > 0.0);
    amplitudes.sort_by(f64::total_cmp);
    let last = amplitudes.len().saturating_sub(1);
    let mut sizes: Vec<f64> = (0..SIZES.min(amplitudes.len()))
        .map(|k| amplitudes[last * (k + 1) / SIZES.min(amplitudes.len())] * std::f64::consts::FRAC_PI_4)
        .collect();
    sizes.dedup();
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Sampling;
    use faer::c64;

    #[test]
    fn friction_holds_its_own_force() {
        let motion = Sampling::new(64).motion(3.0, 0.0, &[c64::new(0.2, 0.0)]);
        for (effect, p) in [(Effect::Coulomb, vec![2.0]), (Effect::Stribeck, vec![2.0, 3.0, 0.1])] {
            let mut force = vec![0.0; motion.len()];
            let (Some(law), Some(friction)) = (effect.law(), friction(effect)) else {
                panic!("{effect:?} is friction")
            };
            law.force(&p, &motion, &mut force);
            // Where the joint turns, any force up to the bound is its force.
            let moving = |n: &usize| motion.velocity[*n].abs() > 1e-9;
            for n in (0..64).filter(moving) {
                let held = friction.held(&p, force[n], motion.velocity[n], 50.0);
                assert!((held - force[n]).abs() < 1e-9, "{effect:?} {n}: {held} {}", force[n]);
            }
        }
    }

    #[test]
    fn a_stuck_joint_agrees_with_every_bound_above_its_force() {
        let Some(friction) = friction(Effect::Coulomb) else { panic!("Coulomb friction is friction") };
        for force in [-3.0, 0.0, 1.5, 3.0] {
            assert_eq!(friction.held(&[3.5], force, 0.0, 10.0), force);
        }
        assert_ne!(friction.held(&[2.0], 3.0, 0.0, 10.0), 3.0);
    }

    #[test]
    fn springs_dashpots_and_sliders_behind_springs_are_no_friction() {
        for effect in
            [Effect::Viscous, Effect::Stiffness, Effect::ElasticSlider, Effect::Iwan, Effect::MassProportional]
        {
            assert!(friction(effect).is_none(), "{effect:?}");
        }
    }

    #[test]
    fn sizes_rise_to_that_of_the_largest_force() {
        let found = sizes(vec![3.0, 1.0, 2.0, f64::NAN]);
        assert_eq!(found.len(), 3);
        assert!((found[2] - 0.75 * std::f64::consts::PI).abs() < 1e-12);
    }
}

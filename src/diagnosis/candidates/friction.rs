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

use crate::effects::{Effect, Motion};

/// Sizes of friction that are tried, over the forces of the runs.
const SIZES: usize = 8;

/// Whether `effect` is friction whose force is set-valued at rest.
pub(crate) fn slides(effect: Effect) -> bool {
    matches!(effect, Effect::Coulomb | Effect::Stribeck)
}

/// The right side above at the samples of a period: `force` (N) of the joint and its `motion`, friction `effect` of the
/// parameters `p`, `r` in N s/m.
pub(crate) fn held(effect: Effect, p: &[f64], force: &[f64], motion: &Motion, r: f64) -> Vec<f64> {
    let bound = p[usize::from(effect == Effect::Stribeck)].max(0.0);
    let falling = |v: f64| {
        if effect == Effect::Stribeck { (p[1] - p[0]) * (-v.abs() / p[2]).exp_m1() * v.signum() } else { 0.0 }
    };
    let at = |(f, v): (&f64, &f64)| {
        let g = falling(*v);
        g + (f - g + r * v).clamp(-bound, bound)
    };
    force.iter().zip(&motion.velocity).map(at).collect()
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
            if let Some(law) = effect.law() {
                law.force(&p, &motion, &mut force);
            }
            let held = held(effect, &p, &force, &motion, 50.0);
            // Where the joint turns, any force up to the bound is its force.
            let moving = |n: &usize| motion.velocity[*n].abs() > 1e-9;
            for n in (0..64).filter(moving) {
                assert!((held[n] - force[n]).abs() < 1e-9, "{effect:?} {n}: {} {}", held[n], force[n]);
            }
        }
    }

    #[test]
    fn a_stuck_joint_agrees_with_every_bound_above_its_force() {
        let still = Sampling::new(32).motion(3.0, 0.0, &[c64::new(0.0, 0.0)]);
        let force: Vec<f64> = (0..32).map(|n| f64::from(n % 7) - 3.0).collect();
        assert_eq!(held(Effect::Coulomb, &[3.5], &force, &still, 10.0), force);
        assert!(held(Effect::Coulomb, &[2.0], &force, &still, 10.0) != force);
    }

    #[test]
    fn sizes_rise_to_that_of_the_largest_force() {
        let found = sizes(vec![3.0, 1.0, 2.0, f64::NAN]);
        assert_eq!(found.len(), 3);
        assert!((found[2] - 0.75 * std::f64::consts::PI).abs() < 1e-12);
    }
}

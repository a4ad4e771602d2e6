//! The force of a component whose displacement is imposed.
//!
//! ```text
//! F(t) = m d'' + sum_j f_j(d, d', states)
//! ```
//!
//! Laws with memory are marched in steps of a sixteenth of a sample, from rest where the record starts.

use super::loading::Loading;
use crate::effects::{Constant, Source};

/// Steps of the laws a sample.
const FINE: usize = 16;

/// Why a component cannot be moved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ComponentForceError {
    #[error("law `{law}` has no force in time: a component of it cannot be moved; give another")]
    NoTimeDomain { law: &'static str },
}

/// Displacement (m) and force (N) at every sample.
///
/// # Errors
/// [`ComponentForceError::NoTimeDomain`] for laws that are defined harmonic by harmonic.
pub fn component_force(
    sources: &[Source],
    mass: f64,
    loading: &Loading,
    rate_hz: f64,
    samples: usize,
) -> Result<(Vec<f64>, Vec<f64>), ComponentForceError> {
    let duration = samples as f64 / rate_hz;
    let step = 1.0 / (rate_hz * FINE as f64);
    let motion: Vec<[f64; 3]> =
        (0..samples * FINE).map(|n| loading.imposed(n as f64 * step, duration).unwrap_or_default()).collect();
    let mut force: Vec<f64> = motion.iter().step_by(FINE).map(|[_, _, a]| mass * a).collect();
    for source in sources {
        let own =
            along(source, &motion, step).ok_or(ComponentForceError::NoTimeDomain { law: source.effect.name() })?;
        force.iter_mut().zip(own).for_each(|(f, own)| *f += own);
    }
    Ok((motion.iter().step_by(FINE).map(|[d, _, _]| *d).collect(), force))
}

/// Force of one source at every sample.
fn along(source: &Source, motion: &[[f64; 3]], step: f64) -> Option<Vec<f64>> {
    let (law, p) = (source.effect.law()?, &source.parameters);
    let linear = source.effect.constant().and_then(|constant| match constant {
        Constant::Stiffness => Some(0),
        Constant::Viscous => Some(1),
        Constant::Mass => Some(2),
        Constant::Hysteretic => None,
    });
    if let Some(along) = linear {
        return Some(motion.iter().step_by(FINE).map(|x| source.coefficient() * x[along]).collect());
    }
    if law.point(p, 0.0, 1.0).is_some() {
        return Some(
            motion.iter().step_by(FINE).map(|[d, v, _]| law.point(p, *d, *v).unwrap_or_default().force).collect(),
        );
    }
    let mut memory = law.memory(p)?;
    let all: Vec<f64> = motion.iter().map(|[d, _, _]| memory.advance(*d, step)).collect();
    Some(all.into_iter().step_by(FINE).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::{Effect, Place};

    const CYCLES: Loading = Loading::Cycles { amplitude_m: 0.01, frequency_hz: 2.0, ramp_s: 0.5 };

    /// Velocity and acceleration against differences of the displacement.
    #[test]
    fn the_imposed_motion_is_its_own_derivative() {
        for time in [0.1, 0.3, 0.7, 1.2, 1.9] {
            let imposed = |t: f64| CYCLES.imposed(t, 2.0).unwrap();
            let width = 1e-5;
            let by = |k: usize| (imposed(time + width)[k] - imposed(time - width)[k]) / (2.0 * width);
            let here = imposed(time);
            assert!((by(0) - here[1]).abs() < 1e-6 && (by(1) - here[2]).abs() < 1e-4, "{time}");
        }
    }

    /// The energy that a cycle of friction takes is four times force times amplitude, that of a dashpot `pi c w A^2`.
    #[test]
    fn a_cycle_takes_the_energy_of_its_laws() {
        let at_dof = |effect, value: f64| Source::known(effect, Place::Dofs(vec![0]), &[value]);
        let (rate, steady) = (2000.0, 1000..2000);
        let energy = |source: Source| {
            let (d, f) = component_force(&[source], 0.0, &CYCLES, rate, 3000).unwrap();
            steady.clone().map(|n| 0.5 * (f[n] + f[n + 1]) * (d[n + 1] - d[n])).sum::<f64>()
        };
        let omega = std::f64::consts::TAU * 2.0;
        assert!((energy(at_dof(Effect::Coulomb, 3.0)) / (4.0 * 3.0 * 0.01) - 1.0).abs() < 0.01);
        assert!(
            (energy(at_dof(Effect::Viscous, 5.0)) / (std::f64::consts::PI * 5.0 * omega * 1e-4) - 1.0).abs() < 1e-3
        );
    }
}

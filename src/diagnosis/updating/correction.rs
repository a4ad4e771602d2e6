//! What a model states wrongly, as it is told and taken over.

use super::parameters::{Updating, UpdatingParameter};
use crate::structure::Part;

/// Deviations within which two factors are the same.
const SAME: f64 = 2.0;

/// A correction of what the model states.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    /// What is corrected.
    pub parameter: UpdatingParameter,
    /// Factor on it.
    pub factor: f64,
    /// Standard deviation of the factor.
    pub deviation: f64,
}

/// Factor on the force that a force channel reads, where all mass and all stiffness are off by the same factor `k`: `k M x'' + k K x = u`
/// is `M x'' + K x = u / k`. `None` where they are not, within their deviations.
pub(crate) fn as_force_gain(corrections: &[Correction]) -> Option<Correction> {
    let find = |part: Part| corrections.iter().find(|c| c.parameter == UpdatingParameter::Structure(part));
    let is_mode = |c: &&Correction| matches!(c.parameter, UpdatingParameter::Structure(Part::Mode(_)));
    let mass = find(Part::Mass)?;
    let stiffness: Vec<&Correction> = match find(Part::Stiffness) {
        Some(all) => vec![all],
        None => corrections.iter().filter(is_mode).collect(),
    };
    let alike = |c: &&Correction| (c.factor - mass.factor).abs() < SAME * c.deviation.hypot(mass.deviation);
    // One mode of many says nothing of the others.
    let all = stiffness.len() > usize::from(find(Part::Stiffness).is_none()) && stiffness.iter().all(alike);
    all.then(|| Correction { parameter: UpdatingParameter::ForceGain(String::new()), ..mass.clone() })
}

/// The `updating` parameters at the factors of `corrections`, those without one at nothing.
pub(crate) fn with_corrections(mut updating: Updating, corrections: &[Correction]) -> Updating {
    for k in 0..updating.len() {
        let stated = corrections.iter().find(|c| c.parameter == updating.parameters[k]);
        updating.values[k] = stated.map_or(0.0, |c| updating.value_of(k, c.factor));
    }
    updating
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn all_mass_and_all_stiffness_by_one_factor_are_a_gain_of_the_force() {
        let part = |part: Part, factor: f64| Correction {
            parameter: UpdatingParameter::Structure(part),
            factor,
            deviation: 0.001,
        };
        let both = [part(Part::Stiffness, 0.99), part(Part::Mass, 0.9901)];
        let gain = as_force_gain(&both).unwrap();
        assert!(gain.factor == 0.9901 && gain.deviation == 0.001);
        let modes = [part(Part::Mode(0), 0.99), part(Part::Mode(1), 0.9895), part(Part::Mass, 0.99)];
        assert!(as_force_gain(&modes).is_some());
        // One mode of many, mass alone, and factors that differ are errors of the model.
        assert!(as_force_gain(&modes[1..]).is_none());
        assert!(as_force_gain(&both[1..]).is_none());
        assert!(as_force_gain(&[part(Part::Stiffness, 0.98), part(Part::Mass, 0.99)]).is_none());
    }
}

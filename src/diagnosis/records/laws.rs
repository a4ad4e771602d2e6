//! Laws that are looked for in records.

use super::data::Records;
use crate::effects::Effect;
use crate::measurement::Quantity;
use crate::response::transient::has_force_in_time;

/// Laws that have a force in time. Friction that differs to either side only where the structure may drift and a sensor shows it: elsewhere
/// its offset moves the place of rest alone, which no sensor tells from its zero, and then stands for whatever else is wrong.
pub(super) fn laws_seen_in(records: &Records) -> Vec<Effect> {
    let drifts = may_drift(records);
    let rests_aside =
        |effect: &Effect| effect.law().is_some_and(|law| law.set_valued().is_some()) && !effect.description().odd;
    Effect::ALL.into_iter().filter(|effect| has_force_in_time(*effect) && (drifts || !rests_aside(effect))).collect()
}

/// Whether a constant force sets the structure in motion as a whole, and a sensor shows that: of displacement or velocity, for the zero of
/// an accelerometer is not known.
fn may_drift(records: &Records) -> bool {
    let sees = |quantity: Quantity| matches!(quantity, Quantity::Displacement | Quantity::Velocity);
    let seen = records.list.iter().any(|record| record.channels.iter().any(|channel| sees(channel.quantity)));
    seen && records.modes.omega.first() == Some(&0.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::laws_seen_in;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;

    fn laws(ground_stiffness: &[f64]) -> Vec<Effect> {
        let structure = chain(&[2.0, 1.0], ground_stiffness, &[1500.0]);
        let wave = |n: usize| (0.06 * n as f64).sin();
        let run = decay(1e-3, vec![(0..2000).map(wave).collect(), (0..2000).map(wave).collect()]);
        laws_seen_in(&Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap())
    }

    #[test]
    fn laws_without_a_force_in_time_or_with_an_offset_are_not_looked_for() {
        let laws = laws(&[800.0, 0.0]);
        let missing =
            [Effect::AsymmetricCoulomb, Effect::Hysteretic, Effect::Fractional, Effect::LossFactor, Effect::Gain];
        assert!(missing.iter().all(|effect| !laws.contains(effect)));
        let looked_for = [Effect::Coulomb, Effect::Iwan, Effect::Dahl, Effect::Maxwell, Effect::Power, Effect::Mass];
        assert!(looked_for.iter().all(|effect| laws.contains(effect)));
    }

    /// A free slide drifts under the offset of its friction: the force that holds it in place tells the offset.
    #[test]
    fn an_offset_is_looked_for_where_the_structure_may_drift() {
        assert!(laws(&[0.0, 0.0]).contains(&Effect::AsymmetricCoulomb));
    }
}

//! Laws that are looked for in records.

use crate::effects::Effect;
use crate::response::transient::has_force_in_time;
use std::sync::LazyLock;

/// Laws that have a force in time, but friction that differs to either side: its offset only moves the place of rest, which
/// accelerometers do not see, and then stands for whatever else is wrong.
pub(super) static LAWS: LazyLock<Vec<Effect>> = LazyLock::new(|| {
    let rests_aside =
        |effect: &Effect| effect.law().is_some_and(|law| law.set_valued().is_some()) && !effect.description().odd;
    Effect::ALL.into_iter().filter(|effect| has_force_in_time(*effect) && !rests_aside(effect)).collect()
});

#[cfg(test)]
mod tests {
    use super::LAWS;
    use crate::effects::Effect;

    #[test]
    fn laws_without_a_force_in_time_or_with_an_offset_are_not_looked_for() {
        let missing =
            [Effect::AsymmetricCoulomb, Effect::Hysteretic, Effect::Fractional, Effect::LossFactor, Effect::Gain];
        assert!(missing.iter().all(|effect| !LAWS.contains(effect)));
        let looked_for = [Effect::Coulomb, Effect::Iwan, Effect::Dahl, Effect::Maxwell, Effect::Power, Effect::Mass];
        assert!(looked_for.iter().all(|effect| LAWS.contains(effect)));
        assert_eq!(LAWS.len(), 18);
    }
}

//! Damping of the whole structure that would be added, taken over by the corrections of the damping of modes: where a law is stated
//! already, both say the same of the modes in the band.
//!
//! ```text
//! f'_r = f_r (1 + d_r / c_r),      d_r, c_r = Im g(omega_r) b_r,      b_r = 1 (on M) or omega_r^2 (on K)
//! ```
//!
//! with the factor `f_r` on the damping of mode `r`, of which the added law gives `d_r` and the known ones give `c_r`.

use super::parameters::{Updating, UpdatingParameter};
use crate::effects::{Basis, Kind, Place, Source};
use crate::structure::{Part, Structure};

/// Most by which a factor grows: beyond, the damping of a mode is none that is stated.
const MOST: f64 = 20.0;

/// What a law of the whole structure gives a mode of natural circular frequency `omega` (rad/s): its modal damping times `omega`,
/// rad^2/s^2; none of other sources.
fn of_mode(source: &Source, omega: f64) -> Option<f64> {
    let (Kind::Whole(law), Place::Whole(None)) = (source.effect.kind(), &source.place) else { return None };
    let size = match law.basis() {
        Basis::Mass => 1.0,
        Basis::Stiffness => omega * omega,
    };
    Some(law.factor(source.parameters[0], omega).im * size)
}

impl Updating {
    /// These parameters with the laws of the whole structure `effects` taken over by the damping of modes, of which those of the
    /// sources `known` give some; none where another effect is among them, or no damping of modes is corrected.
    pub(crate) fn absorbing_damping(
        &self,
        structure: &Structure,
        known: &[Source],
        effects: &[Source],
    ) -> Option<Self> {
        let modes = structure.modes().ok()?;
        let known = self.known(known);
        let mut absorbed = self.clone();
        let mut any = false;
        for (value, parameter) in absorbed.values.iter_mut().zip(&self.parameters) {
            let UpdatingParameter::Structure(Part::ModeDamping(mode)) = parameter else { continue };
            let omega = *modes.omega.get(*mode)?;
            let stated: f64 = known.iter().filter_map(|source| of_mode(source, omega)).sum();
            let added = effects.iter().map(|source| of_mode(source, omega)).sum::<Option<f64>>()?;
            if stated <= 0.0 {
                return None;
            }
            *value += (added / stated).clamp(0.0, MOST).ln_1p();
            any = true;
        }
        (any && !effects.is_empty()).then_some(absorbed)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::Effect;
    use crate::structure::chain::ChainParameters;

    /// With the corrected modes the known law gives what both laws gave before.
    #[test]
    fn the_damping_of_modes_takes_over_what_a_law_adds_to_another() {
        let (masses, ground_stiffness) = (vec![1.0, 2.0], vec![500.0, 0.0]);
        let chain = ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1000.0] }.build(&[]).unwrap();
        let whole = |effect: Effect, value: f64| Source::known(effect, Place::Whole(None), &[value]);
        let (stated, added) = (whole(Effect::LossFactor, 0.01), whole(Effect::MassProportional, 0.3));
        let parts = [Part::Stiffness, Part::ModeDamping(0), Part::ModeDamping(1)];
        let parameters = parts.map(UpdatingParameter::Structure).to_vec();
        let updating = Updating { parameters, values: vec![0.01, 0.5_f64.ln(), 0.0], ..Updating::default() };
        let (known, effects) = (std::slice::from_ref(&stated), std::slice::from_ref(&added));
        let absorbed = updating.absorbing_damping(&chain, known, effects).unwrap();
        for (mode, factor) in [(0, 0.5), (1, 1.0)] {
            let omega = chain.modes().unwrap().omega[mode];
            // Mass: 2 zeta omega = alpha; loss factor: 2 zeta omega = eta omega.
            let both = factor * (0.3 + 0.01 * omega);
            let corrected = absorbed.values[mode + 1].exp() * 0.01 * omega;
            assert!((corrected / both - 1.0).abs() < 1e-9, "{corrected} {both}");
        }
        assert_eq!(absorbed.values[0], 0.01);
        let dashpot = Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[1.0]);
        assert!(updating.absorbing_damping(&chain, known, &[dashpot]).is_none());
        assert!(updating.absorbing_damping(&chain, &[], effects).is_none());
    }
}

//! What the damping of all modes has in common is the size of the law that states it: the one is taken for the other as far as their
//! priors say.
//!
//! Adding `d` to the logarithm of the size and taking it from those of all modes in the band changes no response there, so that only
//! the priors `v^2 / s^2` hold the two:
//!
//! ```text
//! d = (sum v_r / s_r^2 - v / s^2) / (sum 1 / s_r^2 + 1 / s^2)
//! ```

use super::parameters::{Updating, UpdatingParameter};
use crate::effects::{Place, Source};
use crate::structure::Part;

impl Updating {
    /// These parameters, the common factor of the damping of modes shared with the size of the only law of the whole structure among
    /// `known` as is likeliest; as they are where there is another, or the damping of no mode is corrected.
    #[must_use]
    pub(crate) fn with_common_damping_shared(&self, known: &[Source]) -> Self {
        let of_whole = |source: &Source| matches!(source.place, Place::Whole(_));
        let is_mode = |k: usize| matches!(self.parameters[k], UpdatingParameter::Structure(Part::ModeDamping(_)));
        let is_size =
            |k: usize| matches!(self.parameters[k], UpdatingParameter::Known(j) if known.get(j).is_some_and(of_whole));
        let modes: Vec<usize> = (0..self.len()).filter(|&k| is_mode(k)).collect();
        let sizes: Vec<usize> = (0..self.len()).filter(|&k| is_size(k)).collect();
        let ([size], false) = (sizes.as_slice(), modes.is_empty()) else { return self.clone() };
        let weight = |k: usize| self.prior(k).powi(-2);
        let excess: f64 = modes.iter().map(|&k| self.values[k] * weight(k)).sum();
        let all: f64 = modes.iter().map(|&k| weight(k)).sum::<f64>() + weight(*size);
        let common = (excess - self.values[*size] * weight(*size)) / all;
        let mut shared = self.clone();
        shared.values[*size] += common;
        modes.iter().for_each(|&k| shared.values[k] -= common);
        shared
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::three_masses;
    use crate::effects::Effect;
    use crate::response::harmonic_balance::{Excitation, ForwardModel, Settings};
    use faer::c64;

    fn updating(values: &[f64]) -> Updating {
        let mode = |r: usize| UpdatingParameter::Structure(Part::ModeDamping(r));
        let parameters = vec![UpdatingParameter::Known(0), mode(0), mode(1), mode(2)];
        Updating { parameters, values: values.to_vec(), ..Updating::default() }
    }

    fn known() -> Vec<Source> {
        vec![Source::known(Effect::LossFactor, Place::Whole(None), &[0.02])]
    }

    /// The priors are least where the factor is shared, and the damping of every mode is what it was.
    #[test]
    fn a_factor_of_all_modes_is_shared_as_is_likeliest() {
        let stated = updating(&[-0.3, 0.3, 0.3, 0.35]);
        let shared = stated.with_common_damping_shared(&known());
        let cost = |u: &Updating| u.standardised().iter().map(|v| v * v).sum::<f64>();
        for by in [-0.01, 0.01] {
            let mut moved = shared.clone();
            moved.values[0] += by;
            moved.values[1..].iter_mut().for_each(|v| *v -= by);
            assert!(cost(&moved) > cost(&shared), "{by}");
        }
        for (k, value) in shared.values.iter().enumerate().skip(1) {
            assert!((value + shared.values[0] - stated.values[k] - stated.values[0]).abs() < 1e-12);
        }
        assert!(shared.values[1].abs() < 0.05, "{:?}", shared.values);
    }

    /// Receptances of the corrected model before and after, all modes being in the band.
    #[test]
    fn what_is_shared_changes_no_response() {
        let structure = three_masses([1.0; 3]);
        let stated = updating(&[-0.3, 0.3, 0.3, 0.35]);
        let response = |updating: &Updating| {
            let (corrected, sources) = (updating.structure(&structure), updating.known(&known()));
            let model = ForwardModel::new(&corrected, &sources).unwrap();
            let excitation = Excitation::sine(60.0, 2, c64::new(1.0, 0.0));
            model
                .at(60.0)
                .respond(&sources, &excitation, &Settings::default(), None, &crate::control::Control::unattended())
                .unwrap()
                .amplitude(0, 1)
        };
        let (before, after) = (response(&stated), response(&stated.with_common_damping_shared(&known())));
        assert!((before - after).norm() < 1e-9 * before.norm());
    }

    #[test]
    fn two_laws_or_none_keep_what_they_have() {
        let stated = updating(&[-0.3, 0.3, 0.3, 0.35]);
        assert_eq!(stated.with_common_damping_shared(&[]), stated);
        let two = Updating { parameters: vec![UpdatingParameter::Known(0), UpdatingParameter::Known(1)], ..stated };
        let laws = [known(), known()].concat();
        assert_eq!(two.with_common_damping_shared(&laws), two);
    }
}

//! Corrections alone, begun from where those beside an effect ended.
//!
//! A model that is far off loses the phase of a record, and its corrections may stop short of what they could explain where those beside
//! an effect do not. What a law that is alike at all amplitudes does to every mode is a damping ratio and a frequency: its corrections
//! begin with both, to first order
//!
//! ```text
//! d ln omega_r^2 = p_r^2 Re Z(omega_r) / omega_r^2,    d ln c_r = ln(1 + p_r^2 Im Z(omega_r) / (omega_r c_r)),    p_r = phi_r^T b
//! ```

use super::data::RecordDiagnosisError;
use super::fitted::FittedRecords;
use super::search::Search;
use crate::effects::{Law, Source};
use faer::c64;
use std::f64::consts::PI;

/// Rounds and steps of the fit.
const ROUNDS: [usize; 2] = [4, 4];
/// Amplitude, m, at which a law is asked for the energy of a cycle, and the share by which that of twice the amplitude may differ from
/// four times as much.
const AMPLITUDE: f64 = 1e-3;
const ALIKE: f64 = 0.2;

impl Search<'_> {
    /// The fit of whole records without the effects of `fit`; `None` where these are none that corrections could stand for, or are masses
    /// or springs, for which [`super::single_change`] speaks.
    pub(super) fn corrections_alone(&self, fit: &FittedRecords) -> Result<Option<FittedRecords>, RecordDiagnosisError> {
        let Some(start) = self.absorbed(fit) else { return Ok(None) };
        match self.fit(self.levels.len() - 1, &start, 1.0, ROUNDS) {
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => Ok(None),
            other => other.map(Some),
        }
    }

    /// `fit` with what its effects do to the followed modes in its corrections.
    fn absorbed(&self, fit: &FittedRecords) -> Option<FittedRecords> {
        let mut start = FittedRecords { effects: Vec::new(), ..fit.clone() };
        let stated = self.records.modal_damping(&fit.known);
        for source in &fit.effects {
            let law = source.effect.law().filter(|_| !source.effect.is_mass_or_spring())?;
            for (r, &omega) in self.records.modes.omega[..self.records.kept].iter().enumerate() {
                let z = equivalent_stiffness(law, &source.parameters, omega)?;
                let square = self.square_along(source, r);
                if omega > 0.0 {
                    start.modes[r] += (square * z.re / omega.powi(2)).max(-0.5).ln_1p();
                }
                if let (Some(damping), Some(own)) = (start.damping.get_mut(r), stated.get(r).filter(|c| **c > 0.0)) {
                    *damping += (square * z.im / (omega * own * damping.exp())).max(0.0).ln_1p();
                }
            }
        }
        Some(start)
    }

    /// Squared relative motion of mode `r` along a source, summed over its legs, 1/kg.
    fn square_along(&self, source: &Source, r: usize) -> f64 {
        let along = |i: usize| self.records.modes.shapes[(i, r)];
        source.place.legs().into_iter().map(|leg| leg.relative(along).powi(2)).sum()
    }
}

/// Complex stiffness of a law, N/m, at a circular frequency; `None` where it depends on the amplitude.
fn equivalent_stiffness(law: &dyn Law, parameters: &[f64], omega: f64) -> Option<c64> {
    if let Some(z) = law.dynamic_stiffness(parameters, omega) {
        return Some(z);
    }
    let energy = |amplitude: f64| law.energy_per_cycle(parameters, amplitude, omega);
    let (once, twice) = (energy(AMPLITUDE)?, energy(2.0 * AMPLITUDE)?);
    let is_alike = once > 0.0 && (twice / (4.0 * once) - 1.0).abs() < ALIKE;
    is_alike.then(|| c64::new(0.0, once / (PI * AMPLITUDE * AMPLITUDE)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{chain, oscillator, source, whole};
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;

    /// A dashpot is viscous damping at every mode, an asymmetric one with two coefficients the mean of both; dry friction is neither.
    #[test]
    fn laws_that_are_alike_at_all_amplitudes_have_a_complex_stiffness() {
        let stiffness = |effect: Effect, parameters: &[f64]| {
            equivalent_stiffness(effect.law().unwrap(), parameters, 20.0).map(|z| [z.re, z.im])
        };
        assert_eq!(stiffness(Effect::Viscous, &[3.0]), Some([0.0, 60.0]));
        let asymmetric = stiffness(Effect::AsymmetricViscous, &[2.0, 4.0]).unwrap();
        assert!(asymmetric[0] == 0.0 && (asymmetric[1] - 60.0).abs() < 1e-9, "{asymmetric:?}");
        assert_eq!(stiffness(Effect::Coulomb, &[3.0]), None);
        assert_eq!(stiffness(Effect::CubicStiffness, &[3.0]), None);
    }

    /// A dashpot adds `c p_r^2` to the `alpha` that mass-proportional damping gives every mode.
    #[test]
    fn a_dashpot_becomes_damping_of_the_modes() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let modes = structure.modes().unwrap();
        let swing = |n: usize, r: usize| (-2e-3 * n as f64).exp() * (5e-3 * modes.omega[r] * n as f64).cos();
        let wave = |n: usize, dof: usize| (0..2).map(|r| 1e-2 * modes.shapes[(dof, r)] * swing(n, r)).sum();
        let run = decay(5e-3, (0..2).map(|dof| (0..2000).map(|n| wave(n, dof)).collect()).collect());
        let known = [whole(Effect::MassProportional, 0.5)];
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let fit = FittedRecords::start(&records, &[source(Effect::Viscous, &[1], &[0.3])]);
        let start = search.absorbed(&fit).unwrap();
        assert_eq!(start.damping.len(), 2);
        for r in 0..2 {
            let factor = 1.0 + 0.3 * modes.shapes[(1, r)].powi(2) / 0.5;
            assert!((start.damping[r].exp() / factor - 1.0).abs() < 1e-9 && start.modes[r] == 0.0, "{r}: {factor}");
        }
    }

    /// A Maxwell element becomes stiffness of the mode; a spring is left to the search for single changes.
    #[test]
    fn a_spring_in_series_with_a_dashpot_becomes_stiffness_of_the_mode() {
        let structure = oscillator(2.0, 800.0);
        let wave = |n: usize| 1e-2 * (-1e-2 * n as f64).exp() * (0.2 * n as f64).cos();
        let run = decay(1e-2, vec![(0..400).map(wave).collect()]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        // k i w c / (k + i w c) with k = 40 N/m and w c = 40 N/m: 20 (1 + i) N/m beside 800 N/m.
        let fit = FittedRecords::start(&records, &[source(Effect::Maxwell, &[0], &[40.0, 2.0])]);
        let start = search.absorbed(&fit).unwrap();
        assert!(start.effects.is_empty() && (start.modes[0] - 0.025_f64.ln_1p()).abs() < 1e-9, "{:?}", start.modes);
        let spring = FittedRecords::start(&records, &[source(Effect::Stiffness, &[0], &[40.0])]);
        assert!(search.absorbed(&spring).is_none());
    }
}

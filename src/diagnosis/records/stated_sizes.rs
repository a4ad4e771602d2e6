//! Effects that are one more of what is stated: a dashpot beside a known one, a mass or a spring of a model of a single shape. Within what is
//! believed of the stated size they correct it; beyond that all that is more is told as the effect. Records tell the sum alone.

use super::data::RecordDiagnosisError;
use super::evidence::{evidence, scale};
use super::fitted::FittedRecords;
use super::problem::cost_of_size;
use super::search::Search;
use crate::diagnosis::updating::detuning::LIKELY_SIZE;
use crate::effects::{Constant, Leg, Source};

/// Logarithm of the factor on all mass or all stiffness that is plausible without looking for an effect.
const LIKELY_PART: f64 = 0.2;

impl Search<'_> {
    /// Puts what a known source is more than stated on the last effect of a fit where that is one more of it: the same model, of which
    /// nothing stated is corrected.
    pub(super) fn put_on_effect(&self, fit: &mut FittedRecords) {
        let Some(k) = fit.effects.last().and_then(|last| self.known_beside(last)) else { return };
        let more = self.records.known[k].parameters[0] * fit.known[k].exp_m1();
        if let Some([value]) = fit.effects.last_mut().map(|last| last.parameters.as_mut_slice())
            && *value + more > 0.0
        {
            *value += more;
            fit.prior -= cost_of_size(fit.known[k]);
            fit.known[k] = 0.0;
        }
    }

    /// Number of the known source of the same law at the same place; none of a law of several parameters.
    fn known_beside(&self, effect: &Source) -> Option<usize> {
        let same = |known: &Source| known.is_same(effect) && known.parameters.len() == 1;
        self.records.known.iter().position(same)
    }

    /// A fit without its last effect where that corrects what is stated, within what is plausible of it: one more of a source that is known at
    /// its place, or, of a single shape, a mass or a spring, which are all mass and all stiffness.
    pub(super) fn as_correction(
        &self,
        level: usize,
        fit: &FittedRecords,
    ) -> Result<Option<FittedRecords>, RecordDiagnosisError> {
        let Some(start) = self.with_last_as_correction(fit) else { return Ok(None) };
        let corrected = self.freed(level, &start)?;
        let unit = scale(fit);
        let is_plainer = |other: &FittedRecords| evidence(other, unit) < evidence(fit, unit) && is_believed(other);
        Ok(corrected.filter(is_plainer))
    }

    /// Where such a fit begins; `None` where the last effect corrects nothing that is stated, or more than is plausible.
    fn with_last_as_correction(&self, fit: &FittedRecords) -> Option<FittedRecords> {
        let (last, others) = fit.effects.split_last()?;
        let mut start = FittedRecords { effects: others.to_vec(), ..fit.clone() };
        let &[value] = last.parameters.as_slice() else { return None };
        let more = |of: f64| (value / of).ln_1p();
        match (self.known_beside(last), last.effect.constant()) {
            (Some(k), _) => start.known[k] += more(self.records.known[k].parameters[0] * fit.known[k].exp()),
            (None, Some(constant @ (Constant::Mass | Constant::Stiffness))) if self.records.has_one_shape() => {
                let modes = &self.records.modes;
                let along = |leg: Leg| leg.relative(|i| modes.shapes[(i, 0)]).powi(2);
                let square: f64 = last.place.legs().into_iter().map(along).sum();
                let own = if constant == Constant::Mass {
                    fit.mass.exp()
                } else {
                    modes.omega[0].powi(2) * fit.stiffness.exp()
                };
                let all = if constant == Constant::Mass { &mut start.mass } else { &mut start.stiffness };
                *all += more(own / square);
            }
            _ => return None,
        }
        is_believed(&start).then_some(start)
    }
}

/// Whether known sources, all mass and all stiffness are off by no more than is plausible without looking for an effect.
fn is_believed(fit: &FittedRecords) -> bool {
    fit.known.iter().all(|v| v.abs() < LIKELY_SIZE) && [fit.mass, fit.stiffness].iter().all(|v| v.abs() < LIKELY_PART)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{oscillator, source};
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;

    /// Calls `look` with a search beside a known dashpot of 2 N s/m and a fit with this effect and half as much again of the known one.
    fn beside_a_dashpot(effect: Source, look: impl Fn(&Search, FittedRecords)) {
        let structure = oscillator(1.0, 400.0);
        let wave = |n: usize| 1e-2 * (-1e-2 * n as f64).exp() * (0.2 * n as f64).cos();
        let run = decay(1e-2, vec![(0..400).map(wave).collect()]);
        let known = [source(Effect::Viscous, &[0], &[2.0])];
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let start = FittedRecords::start(search.whole(), &[effect]);
        look(&search, FittedRecords { known: vec![1.5_f64.ln()], prior: 9.0, ..start });
    }

    /// 3 N s/m of the known dashpot and 0.5 N s/m of one beside it are 2 N s/m as stated and 1.5 N s/m more.
    #[test]
    fn what_is_more_than_stated_is_put_on_the_effect() {
        beside_a_dashpot(source(Effect::Viscous, &[0], &[0.5]), |search, mut fit| {
            search.put_on_effect(&mut fit);
            assert!((fit.effects[0].parameters[0] - 1.5).abs() < 1e-12 && fit.known == [0.0], "{fit:?}");
            assert!((fit.prior - (9.0 - (1.5_f64.ln() / 0.15).powi(2))).abs() < 1e-9, "{}", fit.prior);
        });
        // Friction is none of it.
        beside_a_dashpot(source(Effect::Coulomb, &[0], &[0.5]), |search, mut fit| {
            let before = fit.clone();
            search.put_on_effect(&mut fit);
            assert_eq!(fit, before);
        });
    }

    /// Up to 1.65 times its size is a correction of what is stated, more is an effect.
    #[test]
    fn a_little_more_of_what_is_stated_corrects_it() {
        beside_a_dashpot(source(Effect::Viscous, &[0], &[0.2]), |search, fit| {
            let start = search.with_last_as_correction(&fit).unwrap();
            assert!(start.effects.is_empty() && (start.known[0] - 1.6_f64.ln()).abs() < 1e-12, "{:?}", start.known);
        });
        beside_a_dashpot(source(Effect::Viscous, &[0], &[0.5]), |search, fit| {
            assert!(search.with_last_as_correction(&fit).is_none());
        });
    }
}

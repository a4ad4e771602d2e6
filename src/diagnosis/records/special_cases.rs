//! Laws of several parameters that are told as a simpler one: on the motion of their fit they are that one, or the records do not know one of
//! their sizes.

use super::data::RecordDiagnosisError;
use super::evidence::{evidence, scale};
use super::fit_motion::FitMotion;
use super::fitted::FittedRecords;
use super::search::{Search, add_begun};
use super::suggestions::last_deviations;
use crate::effects::{Range, Source};

/// Evidence up to which a fit may be behind the best to be looked at: one that may still be told.
const BEHIND: f64 = 40.0;
/// Deviations that a size must be from zero to be known.
const KNOWN: f64 = 2.0;
/// Evidence by which the simpler law may be behind: what the law is preferred for that it knows nothing of.
const ALIKE: f64 = 9.0;
/// Rounds and steps of a fit of the simpler law.
const ROUNDS: [usize; 2] = [2, 6];

impl Search<'_> {
    /// Fits of whole records, best first, with the simpler law in place of one that is none but it.
    pub(super) fn told_as_special_cases(
        &self,
        level: usize,
        found: Vec<FittedRecords>,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some(best) = found.first().filter(|_| !self.control.is_late()) else { return Ok(found) };
        let unit = scale(best);
        let last = evidence(best, unit) + BEHIND;
        let simpler = |k: usize| match &found[k] {
            fit if evidence(fit, unit) < last => self.as_special_case(level, fit, unit),
            _ => None,
        };
        let fits = self.control.map(found.len(), simpler);
        self.control.check()?;
        if fits.iter().all(Option::is_none) {
            return Ok(found);
        }
        let (mut kept, mut plainer) = (Vec::new(), Vec::new());
        for (fit, simple) in found.into_iter().zip(fits) {
            if simple.is_some() { plainer.push(simple) } else { kept.push(fit) }
        }
        add_begun(&mut kept, plainer);
        Ok(self.sorted(level, kept))
    }

    /// A fit with the simpler law in place of its last; `None` where that is a law of its own.
    fn as_special_case(&self, level: usize, fit: &FittedRecords, unit: f64) -> Option<FittedRecords> {
        let law = fit.effects.last().filter(|law| law.effect.limits().next().is_some())?;
        let leg = *law.place.legs().first()?;
        let motion = FitMotion::new(&self.levels[level], fit, self.control).ok()?;
        let all_but = law.simpler(&motion.range(leg).unwrap_or(Range::UNKNOWN));
        let wide = KNOWN * unit.sqrt();
        let deviations = last_deviations(fit);
        let unknown = law.effect.scaled().iter().any(|&k| law.parameters[k].abs() < wide * deviations[k]);
        let limits: Vec<Source> = match all_but {
            Some(_) => all_but.into_iter().collect(),
            None if unknown => law.limits().collect(),
            None => return None,
        };
        let is_allowed = |s: &Source| {
            let inside = s.parameters.iter().zip(s.effect.parameters()).all(|(v, p)| p.allows(*v));
            inside && self.laws.contains(&s.effect) && !fit.effects.iter().chain(self.excluded).any(|e| e.is_same(s))
        };
        let in_place = |limit: Source| {
            let of_its_force = self.with_equal_force(law, limit.clone(), leg, &motion, level).unwrap_or(limit);
            let mut start = fit.clone();
            start.effects.pop();
            start.effects.push(of_its_force);
            self.fit(level, &start, 1.0, ROUNDS).ok()
        };
        let fits = limits.into_iter().filter(is_allowed).filter_map(in_place);
        let simple = fits.min_by(|a, b| a.chi_square.total_cmp(&b.chi_square))?;
        (evidence(&simple, unit) < evidence(fit, unit) + ALIKE).then_some(simple)
    }
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

    /// What is told of a ring-down beside a dashpot of 3 N s/m where a fit ended at this law.
    fn told(effect: Effect, parameters: &[f64]) -> Source {
        let structure = oscillator(2.0, 800.0);
        let (rate, omega) = (0.75, (400.0_f64 - 0.75 * 0.75).sqrt());
        let wave = |n: usize| {
            let t = 1e-2 * n as f64;
            1e-2 * (-rate * t).exp() * (omega * t).cos() + 2e-5 * (12.9898 * n as f64).sin()
        };
        let run = decay(1e-2, vec![(0..400).map(wave).collect()]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let level = search.levels.len() - 1;
        let start = FittedRecords::start(&search.levels[level], &[source(effect, &[0], parameters)]);
        let fit = search.quiet(level, &start).unwrap();
        search.told_as_special_cases(level, vec![fit]).unwrap()[0].effects[0].clone()
    }

    /// A dashpot of two coefficients that are nearly the same is told as one of one; one whose coefficients differ is told as it is.
    #[test]
    fn a_law_that_is_all_but_a_simpler_one_is_told_as_that() {
        let plain = told(Effect::AsymmetricViscous, &[3.0, 3.0]);
        assert_eq!(plain.effect, Effect::Viscous);
        assert!((plain.parameters[0] - 3.0).abs() < 0.1, "{plain:?}");
    }

    /// A spring in series that is so stiff that the record does not show it is none.
    #[test]
    fn a_size_that_the_record_does_not_know_is_none() {
        assert_eq!(told(Effect::Maxwell, &[4e5, 3.0]).effect, Effect::Viscous);
    }
}

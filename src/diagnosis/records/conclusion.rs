//! What is said at the end of a search: steps, corrections, suggestions with their errors, the verdict.

use super::data::{RecordDiagnosisError, Records};
use super::evidence::{AGREES, misfit, scale};
use super::fitted::FittedRecords;
use super::model_errors::ModelErrors;
use super::probability::likeliest_first;
use super::problem::beyond_priors;
use super::search::{Search, SetsBySize};
use super::stated_fit::added_as_stated;
use super::suggestions::{added, corrections, corrections_of_parts, suggestions, words};
use crate::diagnosis::result::{Added, Diagnosis, Step, Suggestion, TestErrors, Verdict};
use crate::diagnosis::updating::correction::Correction;
use crate::math::statistics::standard_deviation;
use crate::structure::Part;

/// Error of the stated fit from which on the phase may be lost over the whole record, and the share of it that parts of the record
/// leave at most where it is.
const PHASE_LOST: [f64; 2] = [0.08, 0.7];
/// Share of the predicted error that is left at most, errors of the test taken out, where they are stated: they make half of its square.
const OF_THE_TEST: f64 = 0.7;
/// Predicted error with corrected parts over that without from which on they are stated.
const BETTER: f64 = 0.8;
/// Rounds and steps of a fit beside a part that was corrected.
const REFITTING: [usize; 2] = [2, 4];
/// Probability up to which a suggestion is stated as its fit stands, without what it predicts.
const UNLIKELY: f64 = 1e-3;
/// Probability of a suggestion from which on a test that would tell it from the first is named.
const OPEN: f64 = 0.05;
/// Misfit of the corrections that a project can state over that at which a model agrees, from which on the model is not explained by
/// them, whatever it leaves where errors of the test are free: twice the noise.
const STATED: f64 = 4.0;

impl Search<'_> {
    /// Fills `diagnosis` with what was found; masses and springs that leave no less than corrections of the model do are none, where
    /// these agree with the records.
    pub(super) fn conclude(&self, by_size: &SetsBySize, diagnosis: &mut Diagnosis) -> Result<(), RecordDiagnosisError> {
        let before = diagnosis.clone();
        self.conclude_found(by_size, diagnosis)?;
        let bare = by_size.earlier.iter().rev().find(|(_, fit)| fit.effects.is_empty());
        let is_needless = |fit: &FittedRecords| is_needless(&diagnosis.steps) && !self.is_plainer(by_size, fit);
        let Some((level, bare)) = bare.filter(|(_, fit)| is_needless(fit) && !self.control.is_late()) else {
            return Ok(());
        };
        let corrected = self.corrected_whole(&self.carried(bare, *level, self.levels.len() - 1)?)?;
        let (mut detuned, stated) = (before, self.stated_fit(&corrected)?);
        let error = self.predicted_error(&stated, &stated.effects)?;
        self.conclude_stated(&stated, error, misfit(&corrected), std::slice::from_ref(&corrected), &mut detuned)?;
        if detuned.verdict != Verdict::Unexplained {
            *diagnosis = detuned;
        }
        Ok(())
    }

    /// The same, whatever corrections alone leave.
    fn conclude_found(&self, by_size: &SetsBySize, diagnosis: &mut Diagnosis) -> Result<(), RecordDiagnosisError> {
        let late = self.control.is_late();
        let mut last: Vec<FittedRecords> = by_size.last.iter().map(without_void).collect();
        if late {
            last = self.plausible(last)?;
        }
        last = likeliest_first(last, late);
        let Some(best) = last.first() else {
            diagnosis.verdict = Verdict::Unexplained;
            return Ok(());
        };
        for (level, fit) in &by_size.earlier {
            let step = self.step(fit, *level)?;
            // Corrections that only please the weights of the fit are no step.
            let worth = |s: &Step| !s.added.is_empty() || s.error < diagnosis.error_before;
            diagnosis.steps.extend(step.filter(worth));
        }
        diagnosis.suggestions = suggestions(self.records, &last, late)?;
        let corrections = corrections_of_parts(self.records, best);
        // Where time is up the parts are stated as the fit has them, whatever else could stand for them.
        let stated = if late && !corrections.is_empty() { None } else { Some(self.stated_fit(best)?) };
        if let Some(stated) = stated.as_ref().filter(|_| corrections.is_empty()) {
            return self.conclude_with(stated, self.predicted_error(stated, &stated.effects)?, &last, diagnosis);
        }
        // The parts of the structure as the fit has them, where that leaves clearly less than corrections of all of it or of modes.
        let structure = self.structure_with(&factors(&corrections));
        let (plain, records) = (self.plain.on(&structure)?, self.records.on(&structure)?);
        let search = Search::new(&records, &plain, self.excluded, self.stated, self.supports, self.control);
        let fits: Vec<FittedRecords> = last.iter().map(|fit| beside_parts(fit, &records)).collect();
        let beside_parts = search.stated_fit(&fits[0])?;
        let left = search.predicted_error(&beside_parts, &beside_parts.effects)?;
        if let Some(stated) = stated {
            let before = self.predicted_error(&stated, &stated.effects)?;
            if left > BETTER * before {
                return self.conclude_with(&stated, before, &last, diagnosis);
            }
        }
        diagnosis.corrections.extend(corrections.into_iter().map(|(_, c)| c));
        search.conclude_with(&beside_parts, left, &fits, diagnosis)
    }

    /// The fits of a search whose time was up: without the corrections that are no more than their priors allow, of which nobody was asked
    /// what else they stand for, unless these take away much of the error.
    fn plausible(&self, fits: Vec<FittedRecords>) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let lean: Vec<FittedRecords> = fits.iter().map(beyond_priors).collect();
        let (Some(best), Some(first)) = (fits.first(), lean.first()) else { return Ok(fits) };
        let keeps = self.predicted_error_with_parts(best)? < BETTER * self.predicted_error_with_parts(first)?;
        Ok(if keeps { fits } else { lean })
    }

    /// What comparing the project shows with all corrections of `fit` and its effects.
    fn predicted_error_with_parts(&self, fit: &FittedRecords) -> Result<f64, RecordDiagnosisError> {
        let structure = self.structure_with(&factors(&corrections_of_parts(self.records, fit)));
        let (plain, records) = (self.plain.on(&structure)?, self.records.on(&structure)?);
        let search = Search::new(&records, &plain, self.excluded, self.stated, self.supports, self.control);
        search.predicted_error(&beside_parts(fit, &records), &fit.effects)
    }

    /// Concludes with a stated fit, with the error that it predicts, masses and springs that are errors of the model made corrections of
    /// it.
    fn conclude_with(
        &self,
        stated: &FittedRecords,
        error: f64,
        found: &[FittedRecords],
        diagnosis: &mut Diagnosis,
    ) -> Result<(), RecordDiagnosisError> {
        let model_errors = ModelErrors::of(self.records.structure, stated);
        if model_errors.sources.is_empty() {
            return self.conclude_stated(stated, error, misfit(stated), found, diagnosis);
        }
        // What a spring or mass changes of a part is made a number of the structure, and the rest is fitted beside it.
        let without = |fit: &FittedRecords| {
            let mut fit = fit.clone();
            fit.effects.retain(|e| !model_errors.holds(e));
            fit
        };
        diagnosis.suggestions.retain(|s| !model_errors.holds(&s.added.source));
        let structure = self.records.structure.with_factors(&model_errors.factors());
        let (plain, records) = (self.plain.on(&structure)?, self.records.on(&structure)?);
        let search = Search::new(&records, &plain, self.excluded, self.stated, self.supports, self.control);
        let fits: Vec<FittedRecords> = found.iter().map(without).collect();
        let corrected = search.stated_fit(&search.corrected_whole(&fits[0])?)?;
        model_errors.corrections.iter().for_each(|more| correct(&mut diagnosis.corrections, more));
        let left = if corrected.effects.is_empty() { misfit(stated) } else { misfit(&corrected) };
        let error = search.predicted_error(&corrected, &corrected.effects)?;
        search.conclude_stated(&corrected, error, left, &fits, diagnosis)
    }

    /// A fit on whole records, with deviations of its own.
    fn corrected_whole(&self, fit: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        self.fit(self.levels.len() - 1, fit, 1.0, REFITTING)
    }

    /// Reports a stated fit, with the error that it predicts; `left` is the misfit by which it is judged, `fits` are the sets of the last
    /// size.
    fn conclude_stated(
        &self,
        stated: &FittedRecords,
        error: f64,
        left: f64,
        fits: &[FittedRecords],
        diagnosis: &mut Diagnosis,
    ) -> Result<(), RecordDiagnosisError> {
        diagnosis.steps.push(Step { added: added(stated), error, misfit: misfit(stated) });
        diagnosis.corrections.extend(corrections(self.records, stated));
        diagnosis.test_errors = self.test_errors(stated, error)?;
        if stated.effects.is_empty() {
            diagnosis.suggestions.clear();
            diagnosis.verdict = match left {
                left if left.max(misfit(stated) / STATED) > self.records.agreement(AGREES) => Verdict::Unexplained,
                _ if diagnosis.corrections.is_empty() => Verdict::Adequate,
                _ => Verdict::Detuned,
            };
            return Ok(());
        }
        let late = self.control.is_late();
        for suggestion in diagnosis.suggestions.iter_mut().filter(|s| s.probability > UNLIKELY || !late) {
            self.complete(suggestion, stated, error, fits)?;
        }
        let words = self.words_on_all(stated, error, diagnosis)?;
        if let Some(first) = diagnosis.suggestions.first_mut() {
            first.evidence.extend(words);
        }
        if self.is_open(diagnosis) {
            diagnosis.next_test = self.next_tests(fits)?;
        }
        widen(diagnosis);
        without_unknown(diagnosis);
        if diagnosis.suggestions.is_empty() {
            diagnosis.verdict = Verdict::Unexplained;
            return Ok(());
        }
        let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
        diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
        Ok(())
    }

    /// Whether other effects than those that are stated are still likely, and there is time to say what would tell them apart.
    fn is_open(&self, diagnosis: &Diagnosis) -> bool {
        let sure = diagnosis.suggestions.first().map_or(1.0, |s| s.probability);
        let open = diagnosis.suggestions.iter().filter(|s| s.probability > OPEN).count();
        sure < 1.0 - OPEN && open > 1 && !self.control.is_late()
    }

    /// A set of a shorter level on the whole records; none where it runs away there.
    fn step(&self, fit: &FittedRecords, level: usize) -> Result<Option<Step>, RecordDiagnosisError> {
        let whole = self.levels.len() - 1;
        let on_whole = self.carried(fit, level, whole).and_then(|fit| self.quiet(whole, &fit));
        let stated = |fit: &FittedRecords| self.quiet(whole, &fit.stated(self.records))?.error(self.records, 0.0, 1.0);
        match on_whole.and_then(|fit| Ok((stated(&fit)?, fit))) {
            Ok((error, fit)) => Ok(Some(Step { added: added(&fit), error, misfit: misfit(&fit) })),
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => Ok(None),
            Err(other) => Err(other),
        }
    }

    /// Parameters, errors and words of a suggestion as they stand beside the stated fit.
    fn complete(
        &self,
        suggestion: &mut Suggestion,
        stated: &FittedRecords,
        error: f64,
        fits: &[FittedRecords],
    ) -> Result<(), RecordDiagnosisError> {
        let has = |f: &&FittedRecords| f.effects.iter().any(|e| e.is_same(&suggestion.added.source));
        let likely = suggestion.probability > UNLIKELY;
        if let Some(fit) = fits.iter().find(has).filter(|_| likely && !self.control.is_late()) {
            suggestion.held_out_error_after = self.held_out(self.levels.len() - 1, fit)?;
        }
        suggestion.added = added_as_stated(&added(stated), &suggestion.added);
        // A member of the set is added with the set.
        let in_set = stated.effects.iter().any(|e| e.is_same(&suggestion.added.source));
        suggestion.error_after =
            if in_set { error } else { self.predicted_error(stated, std::slice::from_ref(&suggestion.added.source))? };
        suggestion.evidence = words(&suggestion.added.source, suggestion.error_after);
        Ok(())
    }

    /// What errors of the test - frequencies of each record, zeros, gains - add to the predicted `error`; `None` where that is little.
    fn test_errors(&self, stated: &FittedRecords, error: f64) -> Result<Option<TestErrors>, RecordDiagnosisError> {
        if stated.shifts.len() < 2 {
            return Ok(None);
        }
        let error_left = stated.error(self.records, 0.0, 1.0)?;
        // A shift is that of the stiffness.
        let frequency_scatter = 0.5 * standard_deviation(&stated.shifts);
        Ok((error_left < OF_THE_TEST * error).then_some(TestErrors { frequency_scatter, error_left }))
    }

    /// What is said of all effects of the stated fit together.
    fn words_on_all(
        &self,
        stated: &FittedRecords,
        error: f64,
        diagnosis: &Diagnosis,
    ) -> Result<Vec<String>, RecordDiagnosisError> {
        let mut words = Vec::new();
        let floor = diagnosis.noise_floor.max(f64::MIN_POSITIVE);
        let count = stated.effects.len();
        if count > 1 {
            words.push(format!("With all {count} effects the error is {:.2} %.", 100.0 * error));
        }
        let whole = self.levels.len() - 1;
        let test = diagnosis.test_errors;
        words.extend(test.map(|t| {
            format!(
                "Of that {:.2} % is left where every record has frequencies of its own, which differ by {:.3} %, and every sensor a gain.",
                100.0 * t.error_left,
                100.0 * t.frequency_scatter
            )
        }));
        if test.is_none() && error > PHASE_LOST[0] && whole > 0 {
            let parts = self.carried(stated, whole, 0).and_then(|fit| self.quiet(0, &fit))?;
            let left = parts.error(&self.levels[0], 0.0, 1.0)?;
            if left < PHASE_LOST[1] * error {
                words.push(format!(
                    "Over parts of some periods, each with a start of its own, all of it leaves {:.2} %: much of what is left of the whole record is phase that is lost on the way.",
                    100.0 * left
                ));
            }
        }
        if misfit(stated) > self.records.agreement(AGREES) && error > floor {
            let error = test.map_or(error, |t| t.error_left);
            words.push(format!(
                "That is {:.1} times the noise: the records hold more than these laws give, and no law here at any place gives it.",
                error / floor
            ));
        }
        Ok(words)
    }
}

fn factors(corrections: &[(Part, Correction)]) -> Vec<(Part, f64)> {
    corrections.iter().map(|(part, c)| (*part, c.factor)).collect()
}

/// A fit where its parts are those of the structure of `records`.
fn beside_parts(fit: &FittedRecords, records: &Records) -> FittedRecords {
    FittedRecords { parts: vec![0.0; records.parts.len()], ..fit.clone() }
}

/// A fit without the effects that later ones have left no size worth telling, where any other is left.
fn without_void(fit: &FittedRecords) -> FittedRecords {
    let wide = scale(fit).sqrt();
    let (mut kept, mut deviations, mut first) = (Vec::new(), Vec::new(), 0);
    for effect in &fit.effects {
        let own = &fit.deviations[first..first + effect.parameters.len()];
        first += effect.parameters.len();
        if effect.effect.scaled().iter().any(|&k| effect.parameters[k].abs() > wide * own[k]) {
            kept.push(effect.clone());
            deviations.extend_from_slice(own);
        }
    }
    if kept.is_empty() || kept.len() == fit.effects.len() {
        return fit.clone();
    }
    deviations.extend_from_slice(&fit.deviations[first..]);
    FittedRecords { effects: kept, deviations, ..fit.clone() }
}

/// Adds a correction, to that of the same part where there is one.
fn correct(corrections: &mut Vec<Correction>, more: &Correction) {
    let Some(own) = corrections.iter_mut().find(|c| c.parameter == more.parameter) else {
        corrections.push(more.clone());
        return;
    };
    own.deviation = (own.deviation * more.factor).hypot(more.deviation * own.factor);
    own.factor *= more.factor;
}

/// Whether no size of an effect is as large as its deviation: the data do not know that it is there.
fn is_unknown(added: &Added) -> bool {
    let source = &added.source;
    source.effect.scaled().iter().all(|&k| source.parameters[k].abs() < added.deviations[k])
}

/// Takes back suggestions of which the data know no size, as a search leaves them whose time was up, and the steps that hold nothing
/// else.
fn without_unknown(diagnosis: &mut Diagnosis) {
    diagnosis.suggestions.retain(|s| !is_unknown(&s.added));
    let empty = |step: &Step| !step.added.is_empty() && step.added.iter().all(is_unknown);
    while diagnosis.steps.len() > 1 && diagnosis.steps.last().is_some_and(empty) {
        diagnosis.steps.pop();
    }
}

/// Widens the deviations of the stated fit by what is left beyond noise: any share of what the effects take away may be theirs.
fn widen(diagnosis: &mut Diagnosis) {
    let Some(before) = diagnosis.steps.first().map(|s| s.misfit.max(1.0)) else { return };
    let share = |misfit: f64| ((misfit - 1.0).max(0.0) / before).sqrt().min(1.0);
    let wider = |added: &mut Added, share: f64| {
        let values = added.source.parameters.iter();
        added.deviations.iter_mut().zip(values).for_each(|(d, p)| *d = d.hypot(share * p));
    };
    let last = diagnosis.steps.last().map_or(0.0, |s| share(s.misfit));
    for step in &mut diagnosis.steps {
        let own = share(step.misfit);
        step.added.iter_mut().for_each(|added| wider(added, own));
    }
    diagnosis.suggestions.iter_mut().for_each(|s| wider(&mut s.added, last));
}

/// Whether the last step tells masses and springs alone, and leaves no less than an earlier one without effects.
fn is_needless(steps: &[Step]) -> bool {
    let without = steps.iter().filter(|step| step.added.is_empty());
    let corrected = without.map(|step| step.error).fold(f64::INFINITY, f64::min);
    steps.last().is_some_and(|stated| {
        let alone = stated.added.iter().all(|added| added.source.effect.is_mass_or_spring());
        !stated.added.is_empty() && alone && stated.error >= corrected
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Effect, Place, Source};

    /// A mass that leaves as much as corrections do is needless; a dashpot is not, nor a mass that leaves less.
    #[test]
    fn masses_that_leave_no_less_than_corrections_are_needless() {
        let step = |effect: Option<Effect>, error: f64| {
            let source = |effect| Source::known(effect, Place::Dofs(vec![0]), &[1.0]);
            let added = effect.map(|effect| Added { source: source(effect), deviations: vec![0.1] });
            Step { added: added.into_iter().collect(), error, misfit: 1.0 }
        };
        let stated =
            |effect: Effect, error: f64| is_needless(&[step(None, 0.6), step(None, 0.013), step(Some(effect), error)]);
        assert!(stated(Effect::Mass, 0.0145) && stated(Effect::Stiffness, 0.0145));
        assert!(!stated(Effect::Mass, 0.009) && !stated(Effect::Viscous, 0.0145));
        assert!(!is_needless(&[step(None, 0.6)]));
    }

    #[test]
    fn an_effect_smaller_than_its_deviation_is_unknown() {
        let added = |c: f64, deviation: f64| Added {
            source: Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[c]),
            deviations: vec![deviation],
        };
        assert!(is_unknown(&added(2.0, 100.0)));
        assert!(!is_unknown(&added(2.0, 0.1)));
        // Nothing is said of a deviation that could not be computed.
        assert!(!is_unknown(&added(2.0, f64::NAN)));
    }
}

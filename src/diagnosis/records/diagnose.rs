//! What the model lacks in its records: place before law, laws fitted on the record itself, sets grown effect by effect.
//!
//! 1. The model as it is, then corrected (stiffness, sizes of known sources, a shift a record).
//! 2. Places by a free force ([`super::localisation`]); every law at those that matter, from a small grid of shapes, on short
//!    parts; the best on longer parts and at last on whole records.
//! 3. What is left of a fit is coloured: differences of its squared residual are divided by its misfit and by the number of
//!    samples over which it stays alike, so that many samples of one error do not count as many.
//! 4. An effect is kept if it also predicts the last part of each record from a fit on the rest.

use super::compare::{floors, started};
use super::data::{RecordError, Records};
use super::evidence::{evidence, misfit, scale};
use super::fit::FittedRecords;
use super::search::Search;
use super::telling::{added, corrections, last_deviations, suggestions, words};
use super::told::added_as_told;
use crate::control::Control;
use crate::diagnosis::diagnose::{Diagnosis, Early, Step, Verdict};
use crate::effects::Source;
use crate::math::statistics::root_mean_square;

/// Misfit (squared residual over noise) up to which a model agrees.
const AGREES: f64 = 1.15;
/// Squared corrections over their prior deviations beyond which an effect that makes them needless is looked for.
const PLAUSIBLE: f64 = 16.0;
/// Most effects of a set.
const MOST_EFFECTS: usize = 3;
/// Share of each record that is fitted when the rest is to be predicted.
const LEARNT: f64 = 0.6;
/// Gain of evidence from which on an effect is kept, and the share of the error that it must take away; from [`DECISIVE`] on it
/// need not predict the rest of the records better: there a frequency that follows the amplitude, found with the next effect,
/// still loses the phase.
const GAIN: f64 = 12.0;
const WORTH: f64 = 0.15;
const DECISIVE: f64 = 0.25;
/// Steps of a fit with one effect less.
const PRUNING: usize = 6;
/// Deviations from zero that the force of an effect must have.
const SURE: f64 = 3.0;

/// Finds what the model of `records` lacks; effects `excluded` are not suggested.
///
/// # Errors
/// [`RecordError`]: models that cannot be predicted, a search that was stopped.
pub fn diagnose_records(
    records: &Records,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, RecordError> {
    let plain = records;
    let bare = started(records, &[], control)?;
    let floors: Vec<f64> = records.list.iter().flat_map(|r| floors(r, &r.sigma)).collect();
    let records = &records.weighted(&bare);
    let search = Search { records, plain, excluded, control };
    let bare = search.quiet(&bare, 1.0)?;
    let before = bare.error(records, 0.0, 1.0)?;
    let mut diagnosis = Diagnosis {
        error_before: before,
        noise_floor: root_mean_square(&floors),
        verdict: Verdict::Adequate,
        suggestions: Vec::new(),
        steps: vec![Step { added: Vec::new(), error: before, misfit: misfit(&bare) }],
        next_test: Vec::new(),
        corrections: Vec::new(),
        channel_faults: Vec::new(),
        complete: true,
    };
    if misfit(&bare) < AGREES {
        return Ok(diagnosis);
    }
    let corrected = search.corrected(&bare)?;
    let mut rungs = vec![vec![corrected]];
    loop {
        let best = &rungs[rungs.len() - 1][0];
        if agrees(best) || best.effects.len() >= MOST_EFFECTS || control.is_late() {
            break;
        }
        control.report(0.3 * rungs.len() as f64);
        let mut found = search.extended(best, &bare)?;
        let Some(top) = found.first_mut() else { break };
        if !search.is_better(top, best)? {
            break;
        }
        *top = search.pruned(top)?;
        early(&suggestions(records, &found)?);
        rungs.push(found);
    }
    search.conclude(&rungs, &mut diagnosis)?;
    diagnosis.complete = control.is_complete();
    control.report(1.0);
    Ok(diagnosis)
}

impl Search<'_> {
    /// Whether a fit is better than the one before by evidence, by its error and by what it predicts.
    fn is_better(&self, new: &FittedRecords, old: &FittedRecords) -> Result<bool, RecordError> {
        let scale = scale(new);
        let gain = evidence(old, scale) - evidence(new, scale);
        let worth = 1.0 - (new.chi_square / old.chi_square).sqrt();
        if !stands_out(new) {
            return Ok(false);
        }
        if gain < GAIN {
            return Ok(false);
        }
        // Both leave no more than noise: what is known of the corrections decides.
        if misfit(old) < AGREES {
            return Ok(true);
        }
        if worth < WORTH {
            return Ok(false);
        }
        Ok(misfit(new) < AGREES || worth > DECISIVE || self.held_out(new)? < self.held_out(old)?)
    }

    /// A fit without those of its earlier effects that the last one has made needless.
    fn pruned(&self, fit: &FittedRecords) -> Result<FittedRecords, RecordError> {
        let mut best = fit.clone();
        for k in (0..fit.effects.len().saturating_sub(1)).rev() {
            let mut fewer = best.clone();
            fewer.effects.remove(k);
            let refitted = match self.fit(&fewer, 1.0, PRUNING) {
                Err(RecordError::Model { .. } | RecordError::Singular) => continue,
                other => other?,
            };
            let unit = scale(&best);
            if evidence(&refitted, unit) < evidence(&best, unit) {
                best = refitted;
            }
        }
        Ok(best)
    }

    /// Error on the last part of each record of a fit on the rest.
    fn held_out(&self, fit: &FittedRecords) -> Result<f64, RecordError> {
        match self.fit(fit, LEARNT, 5).and_then(|learnt| learnt.error(self.records, LEARNT, 1.0)) {
            Ok(error) => Ok(error),
            Err(RecordError::Model { .. } | RecordError::Singular) => Ok(f64::INFINITY),
            Err(other) => Err(other),
        }
    }

    fn conclude(&self, rungs: &[Vec<FittedRecords>], diagnosis: &mut Diagnosis) -> Result<(), RecordError> {
        let top = &rungs[rungs.len() - 1];
        let told = self.told(&top[0])?;
        for (k, rung) in rungs.iter().enumerate() {
            let fit = if k + 1 == rungs.len() { &told } else { &rung[0] };
            let error = fit.error(self.records, 0.0, 1.0)?;
            // Corrections that only please the weights of the fit are no step.
            if k > 0 || rungs.len() == 1 || error < diagnosis.error_before {
                diagnosis.steps.push(Step { added: added(fit), error, misfit: misfit(fit) });
            }
        }
        diagnosis.corrections = corrections(self.records, &told);
        if top[0].effects.is_empty() {
            diagnosis.verdict = if misfit(&told) > AGREES {
                Verdict::Unexplained
            } else if diagnosis.corrections.is_empty() {
                Verdict::Adequate
            } else {
                Verdict::Detuned
            };
            return Ok(());
        }
        diagnosis.suggestions = suggestions(self.records, top)?;
        let own = added(&told);
        for suggestion in &mut diagnosis.suggestions {
            let has = |f: &&FittedRecords| f.effects.iter().any(|e| e.is_same(&suggestion.added.source));
            if let Some(fit) = top.iter().find(has) {
                suggestion.held_out_error_after = self.held_out(fit)?;
            }
            suggestion.added = added_as_told(&own, &suggestion.added);
            suggestion.error_after = self.promised(&told, std::slice::from_ref(&suggestion.added.source))?;
            suggestion.evidence = words(&suggestion.added.source, suggestion.error_after);
        }
        if let Some(first) = diagnosis.suggestions.first_mut() {
            let error = told.error(self.plain, 0.0, 1.0)?;
            if told.effects.len() > 1 {
                let all = format!("With all {} effects the error is {:.2} %.", told.effects.len(), 100.0 * error);
                first.evidence.push(all);
            }
            if misfit(&told) > AGREES {
                let floor = diagnosis.noise_floor.max(f64::MIN_POSITIVE);
                let rest = format!(
                    "That is {:.1} times the noise: the records hold more than these laws give, and no law here at any place gives it.",
                    error / floor
                );
                first.evidence.push(rest);
            }
        }
        let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
        diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
        Ok(())
    }
}

/// Whether a fit leaves no more than noise, and that with corrections that can be.
fn agrees(fit: &FittedRecords) -> bool {
    misfit(fit) < AGREES && fit.prior < PLAUSIBLE
}

/// Whether the force of the last effect is more than its deviation allows it to be by chance.
fn stands_out(fit: &FittedRecords) -> bool {
    let (Some(effect), wide) = (fit.effects.last(), scale(fit).sqrt()) else { return false };
    let deviations = last_deviations(fit);
    let sizes = effect.effect.scaled().iter();
    sizes.map(|&k| effect.parameters[k].abs() / (wide * deviations[k])).any(|ratio| ratio > SURE)
}

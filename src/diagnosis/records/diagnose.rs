//! What the model lacks in its records: place before law, laws fitted on the record itself, sets grown effect by effect.
//!
//! 1. The model as it is, then corrected (stiffness, sizes of known sources, a shift a record).
//! 2. Places by a free force ([`super::localisation`]); every law at those that matter, from where the measured motion wants it,
//!    on short parts of the records with initial states of their own (`parts`); the best on longer parts and at last on
//!    whole records.
//! 3. What is left of a fit is coloured: differences of its squared residual are divided by its misfit and by the number of
//!    samples over which it stays alike, so that many samples of one error do not count as many.
//! 4. An effect is kept if it also predicts the last part of each record from a fit on the rest.

use super::backward_elimination::WITHOUT;
use super::channel_delays;
use super::compare::{noise_floor, started};
use super::data::{RecordDiagnosisError, Records};
use super::evidence::{AGREES, GAIN, evidence, misfit, scale};
use super::fitted::FittedRecords;
use super::problem::{corrected_by, is_strained};
use super::search::{FEW_MODES, GROWING, Search, SetsBySize, factors_of};
use super::suggestions::{last_deviations, suggestions};
use crate::control::Control;
use crate::diagnosis::result::{Diagnosis, Early, Step};
use crate::effects::Source;
use crate::measurement::{ChannelCorrection, TransientRun};

/// Times that delays of channels are taken out, and the share of the error that may be left then: a search costs as much as the first.
const DELAYS: usize = 2;
const WITHOUT_DELAYS: f64 = 0.8;
/// Squared corrections over their prior deviations beyond which an effect that makes them needless is looked for: of all, and of each
/// where they are many.
const PLAUSIBLE: [f64; 2] = [16.0, 3.0];
/// Misfit of a set of effects from which on no further one is looked for: what it could explain is no more than models are wrong by.
const ENOUGH: f64 = 2.0;
/// Most effects of a set.
const MOST_EFFECTS: usize = 3;
/// Share of each record that is fitted when the rest is to be predicted.
const LEARNT: f64 = 0.6;
/// Share of the error that an effect must take away to be kept; from [`DECISIVE`] on it need not predict the rest of the records better:
/// there a frequency that follows the amplitude, found with the next effect, still loses the phase.
const WORTH: f64 = 0.15;
/// Gain of evidence by which an effect must make corrections needless, where both leave no more than noise.
const NEEDLESS: f64 = 40.0;
/// The same of a mass or spring, which any error of the model's own masses and springs resembles.
const WORTH_OF_CONSTANT: f64 = 0.5;
const DECISIVE: f64 = 0.25;
/// Share of the error of a set, of records of few modes, that decides by itself.
const GREAT: f64 = 0.3;
/// Rounds and steps of a fit on a part of the records.
const LEARNING: [usize; 2] = [2, 3];
/// Deviations from zero that the force of an effect must have.
const SURE: f64 = 3.0;
/// Deviations that it must be on whole records not to be taken back, and rounds and steps of the fit without it.
const VANISHED: f64 = 2.0;
/// Squared residual without an effect over that with it from which on it is something, however much is left: three quarters of the error.
const MUCH: f64 = 16.0;

/// Finds what the model of `records` lacks; effects `excluded` are not suggested. Delays of channels that it shows are taken out, and the
/// search is made again.
///
/// # Errors
/// [`RecordDiagnosisError`]: models that cannot be predicted, a search that was stopped.
pub fn diagnose_records(
    records: &Records,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, RecordDiagnosisError> {
    let (mut diagnosis, mut asked) = searched(records, excluded, control, early)?;
    let (stated, before) = (diagnosis.steps[0].clone(), left(&diagnosis));
    let mut delays = Vec::new();
    for _ in 0..DELAYS {
        if asked.is_empty() || control.is_late() {
            break;
        }
        let all = channel_delays::added(delays.clone(), asked);
        let found = records.without_delays(&all).and_then(|records| searched(&records, excluded, control, early));
        let (without, more) = match found {
            // What was found before stands.
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => break,
            other => other?,
        };
        if left(&without) > WITHOUT_DELAYS * left(&diagnosis) {
            break;
        }
        (diagnosis, asked, delays) = (without, more, all);
    }
    if !delays.is_empty() {
        let faults = channel_delays::as_faults(&delays, [before, left(&diagnosis)]);
        diagnosis.follows(stated, faults);
    }
    diagnosis.complete = control.is_complete();
    control.report(1.0);
    Ok(diagnosis)
}

/// Error that a diagnosis leaves.
fn left(diagnosis: &Diagnosis) -> f64 {
    diagnosis.steps.last().map_or(diagnosis.error_before, |step| step.error)
}

/// What is found in records as they are read, with the delays that their channels show beside it.
fn searched(
    records: &Records,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<(Diagnosis, Vec<ChannelCorrection>), RecordDiagnosisError> {
    let bare = started(records, &[], control)?;
    // Both as comparing the project shows them: one error and one noise floor of a record, whoever asks.
    let (before, noise_floor) = (bare.error(records, 0.0, 1.0)?, noise_floor(records, &bare)?);
    let weighted = records.weighted(&bare.residual);
    let search = Search::new(&weighted, records, excluded, records.structure, &[], control);
    let bare = search.quiet(search.levels.len() - 1, &bare)?;
    let stated = Step { added: Vec::new(), error: before, misfit: misfit(&bare) };
    let mut diagnosis = Diagnosis::adequate(stated, noise_floor);
    if misfit(&bare) < weighted.agreement(AGREES) {
        return Ok((diagnosis, Vec::new()));
    }
    let supports = search.giving_way(&bare)?;
    let delays = if supports.is_empty() {
        search.explain(&bare, &mut diagnosis, early)?
    } else {
        let structure = records.structure.with_factors(&factors_of(&supports));
        // More modes may be seen then.
        let runs: Vec<TransientRun> = records.list.iter().map(|r| r.run.clone()).collect();
        let held = Records::new(&structure, &records.known, &runs)?;
        let bare = started(&held, &[], control)?;
        let weighted = held.weighted(&bare.residual);
        let search = Search::new(&weighted, &held, excluded, records.structure, &supports, control);
        diagnosis.corrections.clone_from(&supports);
        let bare = search.quiet(search.levels.len() - 1, &bare)?;
        search.explain(&bare, &mut diagnosis, early)?
    };
    Ok((diagnosis, delays))
}

/// How the model as it is agrees with the records.
///
/// # Errors
/// As [`diagnose_records`].
pub(crate) fn agreement_with_records(records: &Records, control: &Control) -> Result<Step, RecordDiagnosisError> {
    let bare = started(records, &[], control)?;
    Ok(Step { added: Vec::new(), error: bare.error(records, 0.0, 1.0)?, misfit: misfit(&bare) })
}

impl Search<'_> {
    /// Searches beside `bare`, the model on whole records, and concludes; delays of channels that the best fit asks for.
    fn explain(
        &self,
        bare: &FittedRecords,
        diagnosis: &mut Diagnosis,
        early: &Early,
    ) -> Result<Vec<ChannelCorrection>, RecordDiagnosisError> {
        let by_size = self.selected_forward(bare, early)?;
        self.conclude(&by_size, diagnosis)?;
        match by_size.last.first().map_or(Ok(Vec::new()), |best| self.delays(best)) {
            // What was found stands whether or not delays can be asked for beside it.
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => Ok(Vec::new()),
            other => other,
        }
    }

    /// Effects added on the shortest parts on which the model shows that it lacks one, until no more is found; what was found carried
    /// on to the whole records.
    fn selected_forward(&self, bare: &FittedRecords, early: &Early) -> Result<SetsBySize, RecordDiagnosisError> {
        let whole = self.levels.len() - 1;
        let bare = self.carried(bare, whole, 0)?;
        let mut by_size = SetsBySize { earlier: Vec::new(), last: vec![self.updated_model(&bare)?] };
        let mut level = 0;
        loop {
            let found_none = by_size.last.first().is_some_and(|f| f.effects.is_empty());
            if level < GROWING || found_none || (level == whole && whole == GROWING) {
                self.grow(level, &bare, &mut by_size, early)?;
            }
            self.control.report(0.9 * (level + 1) as f64 / (whole + 1) as f64);
            if level == whole {
                break;
            }
            let next = if level + 1 < GROWING { level + 1 } else { self.next_level(level, &by_size.last) };
            by_size.last = self.lengthened(&by_size.last, level, next)?;
            level = next;
        }
        // What short parts showed may be nothing on the whole.
        let vanished = by_size.last.first().filter(|f| f.effects.len() == 1 && !is_sure(f, VANISHED));
        if let Some(best) = vanished
            && let Some((level, without)) = by_size.earlier.iter().rfind(|(_, f)| f.effects.is_empty())
        {
            let start = self.carried(without, *level, whole)?;
            let without = self.fit(whole, &start, 1.0, WITHOUT)?;
            if !takes_much(best, &without) {
                by_size = SetsBySize { earlier: Vec::new(), last: vec![without] };
            }
        }
        if let Some(fewer) = self.without_constant(&by_size)? {
            by_size = fewer;
        }
        if let Some(best) = by_size.last.first().filter(|f| !f.effects.is_empty() && !self.control.is_late())
            && let Some(alone) = self.corrections_alone(best)?
            && !self.is_better(whole, best, &alone)?
        {
            by_size = SetsBySize { earlier: Vec::new(), last: vec![alone] };
        }
        if let Some(corrected) = by_size.last.first().filter(|f| f.effects.is_empty()).cloned() {
            let single = self.single_changes(&corrected)?;
            if !single.is_empty() {
                by_size = SetsBySize { earlier: vec![(whole, corrected)], last: single };
            }
        }
        Ok(by_size)
    }

    /// Adds effects on the parts of a level while they are better.
    fn grow(
        &self,
        level: usize,
        bare: &FittedRecords,
        by_size: &mut SetsBySize,
        early: &Early,
    ) -> Result<(), RecordDiagnosisError> {
        while let Some(best) = by_size.last.first() {
            if self.agrees(best) || best.effects.len() >= MOST_EFFECTS || self.control.is_late() {
                break;
            }
            let mut found = self.beside_candidates(level, &by_size.last, bare)?;
            let Some(better) = self.first_better(level, &found, best)? else { break };
            let mut top = self.pruned(level, &found.remove(better))?;
            let corrected = self.as_correction(level, &top)?;
            // Nothing was added then: another turn would find the same.
            let is_correction = corrected.is_some();
            top = corrected.unwrap_or(top);
            found.insert(0, top);
            if is_correction {
                by_size.last = found;
                break;
            }
            early(&suggestions(&self.levels[level], &found, self.control.is_late())?);
            by_size.earlier.push((level, best.clone()));
            by_size.last = found;
        }
        Ok(())
    }

    /// Number of the first of `found` that is better than `old`; of those behind a mass or spring, which must take away more, that with
    /// the first other law.
    fn first_better(
        &self,
        level: usize,
        found: &[FittedRecords],
        old: &FittedRecords,
    ) -> Result<Option<usize>, RecordDiagnosisError> {
        let other = found.iter().position(|f| !f.adds_constant());
        for k in std::iter::once(0).chain(other.filter(|k| *k > 0)) {
            if found.get(k).map_or(Ok(false), |f| self.is_better(level, f, old))? {
                return Ok(Some(k));
            }
        }
        Ok(None)
    }

    fn agrees(&self, fit: &FittedRecords) -> bool {
        agrees(fit, self.records.agreement(AGREES))
    }

    /// Whether a fit is better than the one before by evidence, by its error and by what it predicts.
    fn is_better(&self, level: usize, new: &FittedRecords, old: &FittedRecords) -> Result<bool, RecordDiagnosisError> {
        let scale = scale(new);
        let gain = evidence(old, scale) - evidence(new, scale);
        let worth = 1.0 - (new.chi_square / old.chi_square).sqrt();
        // On short parts the force and the spring of a slider may be uncertain each while what they do together is not.
        if level + 1 == self.levels.len() && !stands_out(new) && !takes_much(new, old) {
            return Ok(false);
        }
        // Corrections beyond what is plausible are what an effect does, where it explains as much with corrections that may be.
        let constant = new.adds_constant();
        if misfit(old) < AGREES && is_strained(old) && !is_strained(new) && !constant && gain > 0.0 {
            return Ok(true);
        }
        // In the few amplitudes of short parts samples are so alike that a great part of the error of a set must do.
        let great = self.records.kept <= FEW_MODES && !old.effects.is_empty() && worth > GREAT;
        if gain < GAIN && !great {
            return Ok(false);
        }
        // Both leave no more than noise: what is known of the corrections decides, where they tell much. A mass or spring would be one
        // of them.
        if misfit(old) < AGREES {
            return Ok(!constant && gain > NEEDLESS);
        }
        if worth < if constant { WORTH_OF_CONSTANT } else { WORTH } {
            return Ok(false);
        }
        Ok(misfit(new) < AGREES || worth > DECISIVE || self.held_out(level, new)? < self.held_out(level, old)?)
    }

    /// Error on the last part of each record of a fit on the rest.
    pub(super) fn held_out(&self, level: usize, fit: &FittedRecords) -> Result<f64, RecordDiagnosisError> {
        let learnt = self.fit(level, fit, LEARNT, LEARNING);
        match learnt.and_then(|learnt| learnt.error(&self.levels[level], LEARNT, 1.0)) {
            Ok(error) => Ok(error),
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => Ok(f64::INFINITY),
            Err(other) => Err(other),
        }
    }
}

/// Whether a fit leaves no more than noise, of which a model without effects leaves up to `least`, and that with corrections that can
/// be.
fn agrees(fit: &FittedRecords, least: f64) -> bool {
    let count = 2 + fit.known.len() + fit.damping.len() + fit.modes.len() + fit.parts.len();
    let enough = if fit.effects.is_empty() { least } else { ENOUGH.max(least) };
    let plausible = corrected_by(fit) < PLAUSIBLE[0].max(PLAUSIBLE[1] * count as f64);
    misfit(fit) < enough && plausible && (!fit.effects.is_empty() || !is_strained(fit))
}

/// Whether the force of the last effect is more than its deviation allows it to be by chance.
fn stands_out(fit: &FittedRecords) -> bool {
    is_sure(fit, SURE)
}

/// Whether a fit leaves so much less than one `without` its effect that this is something, whatever its deviation beside what is left.
fn takes_much(fit: &FittedRecords, without: &FittedRecords) -> bool {
    MUCH * fit.chi_square < without.chi_square
}

/// Whether it is more than so many deviations.
fn is_sure(fit: &FittedRecords, least: f64) -> bool {
    let (Some(effect), wide) = (fit.effects.last(), scale(fit).sqrt()) else { return false };
    let deviations = last_deviations(fit);
    let sizes = effect.effect.scaled().iter();
    sizes.map(|&k| effect.parameters[k].abs() / (wide * deviations[k])).any(|ratio| ratio > least)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A known dashpot of twice its size is no correction of the model, whatever else is left: something is missing there.
    #[test]
    fn a_known_source_far_off_does_not_agree() {
        let noise = FittedRecords { count: 100, ..FittedRecords::of_effects(Vec::new(), 100.0) };
        let with = |factor: f64| FittedRecords { known: vec![factor.ln(); 1], ..noise.clone() };
        let agrees = |fit: &FittedRecords| agrees(fit, AGREES);
        assert!(agrees(&with(1.2)));
        // Of many corrections one such size was hidden by the others.
        let many = |factor: f64| FittedRecords { parts: vec![0.0; 12], ..with(factor) };
        assert!(agrees(&many(1.2)) && !agrees(&many(2.2)));
    }
}

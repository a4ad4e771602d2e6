//! From where a search ended to what is said: suggestions with their probabilities, steps, what cannot be told apart.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::FINAL;
use crate::diagnosis::result::{Added, Diagnosis, Step, Suggestion, Verdict};
use crate::diagnosis::selection::estimator::Estimator;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::next_test::{next_test, pinning_test};
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search_result::{
    FittedSets, SearchResult, explains_by_scatter, leaves_much, same_set,
};
use crate::diagnosis::selection::sentences::sentences;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::diagnosis::updating::scales::Scales;
use crate::effects::Source;
use crate::math::numerals::significant;
use crate::math::statistics::sum_of_squares;

/// Difference of the scaled squared residual within which two suggestions cannot be told apart.
const ALIKE: f64 = 9.0;
/// Probability from which on the next best set is worth a test of its own.
const WORTH_A_TEST: f64 = 1e-3;
/// Squared residual per datum that a model may leave which is only detuned.
pub(crate) const TOLERATED: f64 = 4.0;
/// What the probability of a law is multiplied by where it leaves more than that: of the laboratory projects of the
/// development seeds for which that was so, a third had the law that was told.
pub(crate) const UNTRUSTED: f64 = 0.35;
/// Share of the squared residual of corrections alone below which a law is trusted that leaves more than that: sensors may be so
/// quiet that no model of a real structure agrees with them. Of 152 development projects three ended below this share (1e-4 to
/// 2e-3) with less than a tenth of the response left, all three with the law that was told; all others with such a misfit left more
/// than a tenth, and are doubted for that.
const TAKEN: f64 = 5e-3;
/// Squared residual per datum from which on no law of the library gives what is missing.
pub(super) const UNEXPLAINED: f64 = 100.0;
/// Share of an error within which another is the same.
const SAME_ERROR: f64 = 0.01;
/// Most suggestions.
const MOST: usize = 8;
/// The same where time is up.
const FEW: usize = 2;

/// Share of the stated model's error that corrections may leave which do not agree with the data to the noise and are told as all
/// there is.
const MOST_LEFT: f64 = 0.5;

/// Where a search ended, with what it was made on.
pub(crate) struct Outcome<'a> {
    pub reference: ReferenceModel<'a>,
    pub found: SearchResult,
}

impl Outcome<'_> {
    /// Fills in what was found.
    pub(crate) fn conclude(&self, mut diagnosis: Diagnosis) -> Result<Diagnosis, DiagnosisError> {
        let reference = &self.reference;
        let by_size = &self.found.by_size;
        let Some(top) = by_size.last().map(FittedSets::without_needless) else {
            return self.conclude_without_effects(diagnosis);
        };
        let best = &top.fits[0];
        let quiet = ReferenceModel { noise: top.noise.clone(), ..reference.clone() };
        let predictions = quiet.estimator().predict(&best.effects, &FINAL, &best.starts)?;
        diagnosis.noise_floor = quiet.noise_floor(&best.effects, &predictions);
        diagnosis.corrections = corrections(&quiet);
        let told = self.as_told(&quiet, best)?;
        let best = told.as_ref().unwrap_or(best);
        let misfit = best.chi_square / reference.count().max(1) as f64;
        let errors = [best.error, diagnosis.noise_floor];
        let leaves = |judged: fn(f64, f64) -> bool| quiet.leaves(judged, errors, &best.effects, &best.starts);
        let scattered = self.found.updated && leaves(explains_by_scatter)?;
        let doubtful = !quiet.linearisation.updating.is_plausible() || leaves(leaves_much)?;
        let left = misfit > UNEXPLAINED || (misfit > TOLERATED && misfit > TAKEN * self.found.without);
        let trust = if left || doubtful { UNTRUSTED } else { 1.0 };
        let weights: Vec<f64> = top.probabilities.iter().map(|p| p * trust).collect();
        let ordered = order(&quiet.estimator(), best, &by_size[0])?;
        for set in &ordered {
            let misfit = set.chi_square / reference.count().max(1) as f64;
            diagnosis.steps.push(Step { added: added(set, top.scale), error: set.error, misfit });
        }
        let structure = quiet.of_structure()?;
        let alike_runs = Estimator { predictor: &structure, ..quiet.estimator() };
        let mut final_set = added(ordered.last().unwrap_or(best), top.scale);
        let helps =
            |item: &Added| ordered.iter().position(|set| set.effects.iter().any(|effect| effect.is_same(&item.source)));
        final_set.sort_by_key(helps);
        for item in &final_set {
            let alone = alone(&quiet.estimator(), &item.source, best, &by_size[0])?;
            let probability = containing(&top.fits, &weights, &item.source);
            let evidence = sentences(&quiet, item, best, diagnosis.error_before, alone.error)?;
            diagnosis.suggestions.push(Suggestion {
                added: item.clone(),
                // Beside corrections, which were fitted with all of them, a set is added whole.
                error_after: if self.found.updated { best.error } else { alone.error },
                held_out_error_after: alike_runs.held_out_error(&alone)?,
                probability,
                evidence,
                indistinguishable_from: alike(&top.fits, best, &item.source, top.scale),
            });
        }
        alternatives(&alike_runs, &top, &weights, &mut diagnosis)?;
        // Corrections are those beside the best set: it is what can be added, and comes first.
        let is_alternative = |s: &Suggestion| !best.effects.iter().any(|effect| effect.is_same(&s.added.source));
        let alternative_then_probability = |a: &Suggestion, b: &Suggestion| {
            is_alternative(a).cmp(&is_alternative(b)).then(b.probability.total_cmp(&a.probability))
        };
        diagnosis.suggestions.sort_by(alternative_then_probability);
        // Nothing is ambiguous where the next best has next to no probability: then the size is what is least certain.
        let second = top.fits.get(1).filter(|_| weights.get(1).is_some_and(|w| *w > WORTH_A_TEST));
        diagnosis.next_test = match second {
            _ if quiet.control.is_late() => None,
            Some(second) => next_test(&quiet, &best.effects, &second.effects)?,
            None => pinning_test(&quiet, best)?,
        }
        .into_iter()
        .collect();
        let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability > 0.5);
        diagnosis.verdict = if misfit > UNEXPLAINED || scattered {
            Verdict::Unexplained
        } else if sure {
            Verdict::Missing
        } else {
            Verdict::Undecided
        };
        Ok(diagnosis)
    }

    /// The best fit with the error of the model as it is told, where that is not the one that it was found with.
    fn as_told(&self, quiet: &ReferenceModel, best: &FittedModel) -> Result<Option<FittedModel>, DiagnosisError> {
        let is_near = |error: f64| (error - best.error).abs() <= SAME_ERROR * best.error;
        if !self.found.updated || is_near(quiet.error_of_followed(&best.effects, &best.starts)?) {
            return Ok(None);
        }
        let error = quiet.error_of_structure(&best.effects, &best.starts)?;
        Ok((!is_near(error)).then(|| FittedModel { error, ..best.clone() }))
    }

    /// The same where no effect was found: corrections alone, if they are an answer.
    fn conclude_without_effects(&self, mut diagnosis: Diagnosis) -> Result<Diagnosis, DiagnosisError> {
        let reference = &self.reference;
        let estimator = reference.estimator();
        let misfit = sum_of_squares(&estimator.residual(&reference.predictions)) / reference.count().max(1) as f64;
        let error = reference.error_of_structure(&[], &Vec::new())?;
        // That corrections are all is no answer of a search whose time was up before laws were fitted, nor where they leave most
        // of the error beyond the noise.
        let helps = !self.found.updated || error < MOST_LEFT * diagnosis.error_before;
        let told = self.found.agrees || (helps && reference.control.is_complete());
        let errors = [error, diagnosis.noise_floor];
        let scattered = self.found.updated && reference.leaves(explains_by_scatter, errors, &[], &Vec::new())?;
        // Nor corrections of damping that no model needs: they stand in for what is missing.
        let plausible = reference.linearisation.updating.is_plausible();
        // Nor where all motions together are turned against it by what is no scatter of runs.
        diagnosis.common_factors = reference.common_factors(&reference.predictions);
        let enough = misfit < TOLERATED && told && !scattered && plausible && diagnosis.common_factors.is_empty();
        diagnosis.verdict = match (self.found.updated, enough) {
            (true, true) => Verdict::Detuned,
            (false, true) => Verdict::Adequate,
            (_, false) => Verdict::Unexplained,
        };
        // Corrections that explain nothing and raise the error have followed what they cannot be.
        if self.found.updated && (enough || error < diagnosis.error_before) {
            diagnosis.corrections = corrections(reference);
            diagnosis.steps.push(Step { added: Vec::new(), error, misfit });
        }
        Ok(diagnosis)
    }
}

/// Suggestions of fits that are not finished: for somebody who waits.
pub(crate) fn early(reference: &ReferenceModel, fits: &[FittedModel]) -> Vec<Suggestion> {
    let scale = scale_of(fits, reference.count());
    let weights = reference.probabilities(fits);
    let suggestion = |(fit, &probability): (&FittedModel, &f64)| {
        let added = added(fit, scale).pop()?;
        let evidence = vec![added.source.effect.sentence().to_string()];
        let (error_after, held_out_error_after) = (fit.error, fit.error);
        let indistinguishable_from = Vec::new();
        Some(Suggestion { added, error_after, held_out_error_after, probability, evidence, indistinguishable_from })
    };
    fits.iter().zip(&weights).take(MOST).filter_map(suggestion).collect()
}

/// The effects of the best set in the order in which they help, each prefix fitted.
fn order(estimator: &Estimator, best: &FittedModel, first: &FittedSets) -> Result<Vec<FittedModel>, DiagnosisError> {
    if best.effects.len() == 1 {
        return Ok(vec![best.clone()]);
    }
    let mut rest = best.effects.clone();
    let mut chain: Vec<FittedModel> = Vec::new();
    let mut chosen: Vec<Source> = Vec::new();
    while rest.len() > 1 {
        let mut options = Vec::new();
        for k in 0..rest.len() {
            let set: Vec<Source> = chosen.iter().chain(std::iter::once(&rest[k])).cloned().collect();
            let known = first.fits.iter().find(|r| same_set(&r.effects, &set));
            options.push(known.map_or_else(|| estimator.fit(&set, 8, &FINAL, &[]), |r| Ok(r.clone()))?);
        }
        let k = (0..rest.len()).min_by(|&a, &b| options[a].chi_square.total_cmp(&options[b].chi_square));
        let k = k.unwrap_or(0);
        chosen.push(rest.remove(k));
        chain.push(options.swap_remove(k));
    }
    chain.push(best.clone());
    Ok(chain)
}

fn alone(
    estimator: &Estimator,
    source: &Source,
    best: &FittedModel,
    first: &FittedSets,
) -> Result<FittedModel, DiagnosisError> {
    let set = std::slice::from_ref(source);
    if same_set(&best.effects, set) {
        return Ok(best.clone());
    }
    match first.fits.iter().find(|r| same_set(&r.effects, set)) {
        Some(fit) => estimator.fit(&fit.effects, 3, &FINAL, &fit.starts),
        None => estimator.fit(set, 8, &FINAL, &[]),
    }
}

/// Suggestions beyond the best set: what else was fitted at the same number of effects.
fn alternatives(
    estimator: &Estimator,
    top: &FittedSets,
    weights: &[f64],
    diagnosis: &mut Diagnosis,
) -> Result<(), DiagnosisError> {
    for fit in top.fits.iter().skip(1) {
        // Each takes as long as all runs take to be predicted.
        let most = if estimator.control.is_late() { FEW } else { MOST };
        for item in added(fit, top.scale) {
            let listed = diagnosis.suggestions.iter().any(|s| s.added.source.is_same(&item.source));
            if listed || diagnosis.suggestions.len() >= most {
                continue;
            }
            diagnosis.suggestions.push(Suggestion {
                error_after: fit.error,
                held_out_error_after: estimator.held_out_error(fit)?,
                probability: containing(&top.fits, weights, &item.source),
                evidence: vec![format!(
                    "With it the error would be {} % instead of {} %.",
                    significant(100.0 * fit.error, 3),
                    significant(100.0 * diagnosis.error_before, 3)
                )],
                indistinguishable_from: Vec::new(),
                added: item,
            });
        }
    }
    Ok(())
}

/// Corrections of what the model states, at the values of `reference`, with the deviations that hold where nothing is known
/// better than laboratories know it: scales that are estimated from few runs may be too small.
pub(crate) fn corrections(reference: &ReferenceModel) -> Vec<Correction> {
    let updating = &reference.linearisation.updating;
    let told = reference.with_scales(updating.scales.at_least(&Scales::SEARCH));
    let variances = told.noise.updating.variances();
    let correction = |(k, parameter): (usize, &UpdatingParameter)| {
        let deviation = told.linearisation.updating.prior(k) * variances.get(k)?.sqrt();
        let factor = updating.factor(k);
        parameter.is_stated().then(|| Correction {
            parameter: parameter.clone(),
            factor,
            deviation: deviation * factor * updating.relative_slope(k),
        })
    };
    updating.parameters.iter().enumerate().filter_map(correction).collect()
}

/// The effects of a fit; what the model leaves beyond the noise widens their deviations.
fn added(fit: &FittedModel, scale: f64) -> Vec<Added> {
    let widened = |d: &Vec<f64>| d.iter().map(|d| d * scale.max(1.0).sqrt()).collect();
    let pairs = fit.effects.iter().zip(&fit.deviations);
    pairs.map(|(source, deviations)| Added { source: source.clone(), deviations: widened(deviations) }).collect()
}

/// Probability of all sets that contain an effect at a place.
fn containing(fits: &[FittedModel], weights: &[f64], source: &Source) -> f64 {
    let with = fits.iter().zip(weights).filter(|(r, _)| r.effects.iter().any(|e| e.is_same(source)));
    with.map(|(_, w)| w).sum::<f64>().min(1.0)
}

/// Effects that in place of `source` leave a residual that differs by no more than noise.
fn alike(fits: &[FittedModel], best: &FittedModel, source: &Source, scale: f64) -> Vec<Source> {
    let others: Vec<&Source> = best.effects.iter().filter(|e| !e.is_same(source)).collect();
    let near = fits.iter().filter(|r| (r.chi_square - best.chi_square) / scale < ALIKE);
    let mut found: Vec<Source> = Vec::new();
    for fit in near {
        let fresh: Vec<&Source> = fit.effects.iter().filter(|e| !others.iter().any(|o| o.is_same(e))).collect();
        if let [other] = fresh[..]
            && !other.is_same(source)
            && !found.iter().any(|f| f.is_same(other))
        {
            found.push(other.clone());
        }
    }
    found
}

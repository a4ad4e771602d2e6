//! Suggestions and corrections of the model made of fits, with their probabilities and deviations.

use super::data::{RecordDiagnosisError, Records};
use super::evidence::{evidence, misfit, parameters, scale};
use super::fitted::FittedRecords;
use super::probability::probabilities;
use super::problem::modes;
use crate::diagnosis::result::{Added, Suggestion};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::structure::Part;

/// Ratio up to which the squared residual of a law of fewer parameters may be larger than that of another at its place, which then is
/// not suggested: where the residual is noise, and where it is an error of the model, which more parameters absorb.
const PLAIN: [f64; 2] = [1.1, 1.3];
/// Misfit from which on what is left is no noise.
const MODEL_ERROR: f64 = 1.5;
/// Share to which forces and motions are known at best.
const KNOWN: f64 = 0.005;
/// Difference of evidence within which effects cannot be told apart.
const ALIKE: f64 = 9.0;
/// Most suggestions; those that are as good as excluded stand among the first few only.
const MOST: usize = 8;
const FEW: usize = 3;
const NEVER: f64 = 1e-9;

/// The effects of a fit with deviations as wide as what it leaves demands, and as the scale of forces and motions at a place is
/// known: no sensor is there, and shapes at the sensors are wrong by what was found of them.
pub(super) fn added(fit: &FittedRecords) -> Vec<Added> {
    let wide = scale(fit).sqrt();
    let shapes: Vec<f64> = fit.shapes.iter().flatten().copied().collect();
    let known = root_mean_square(&shapes).max(KNOWN);
    let mut at = 0;
    let with_deviations = |source: &Source| {
        let mut deviations: Vec<f64> =
            fit.deviations[at..at + source.parameters.len()].iter().map(|d| d * wide).collect();
        let exponent = source.effect.parameters().iter().position(|p| p.name == "exponent");
        let exponent = exponent.map_or(1.0, |k| source.parameters[k]);
        for (k, parameter) in source.effect.parameters().iter().enumerate() {
            let share = known * parameter.powers_of_scale(exponent);
            deviations[k] = deviations[k].hypot(share * source.parameters[k]);
        }
        at += source.parameters.len();
        Added { source: source.clone(), deviations }
    };
    fit.effects.iter().map(with_deviations).collect()
}

/// Suggestions of the fits of one size, best first, of a search that was `cut_off` or not.
pub(super) fn suggestions(
    records: &Records,
    found: &[FittedRecords],
    cut_off: bool,
) -> Result<Vec<Suggestion>, RecordDiagnosisError> {
    let Some(best) = found.first() else { return Ok(Vec::new()) };
    let unit = scale(best);
    let weights = probabilities(found, cut_off);
    let mut list: Vec<Suggestion> = Vec::new();
    for (fit, weight) in found.iter().zip(&weights) {
        let error = fit.error(records, 0.0, 1.0)?;
        for added in added(fit) {
            if let Some(known) = list.iter_mut().find(|s| s.added.source.is_same(&added.source)) {
                known.probability = (known.probability + weight).min(1.0);
                continue;
            }
            if list.len() >= MOST || (list.len() >= FEW && *weight < NEVER) {
                continue;
            }
            let alike = |other: &&FittedRecords| (other.chi_square - fit.chi_square).abs() / unit < ALIKE;
            let others = found.iter().filter(alike).filter_map(|f| f.effects.last());
            let indistinguishable_from =
                others.filter(|o| !fit.effects.iter().any(|e| e.is_same(o))).cloned().collect();
            let words = words(&added.source, error);
            list.push(Suggestion {
                added,
                error_after: error,
                held_out_error_after: error,
                probability: *weight,
                evidence: words,
                indistinguishable_from,
            });
        }
    }
    Ok(list)
}

/// What is said of an effect with which this error is left.
pub(super) fn words(source: &Source, error: f64) -> Vec<String> {
    let left = format!("With it the error of the records is {:.2} %.", 100.0 * error);
    vec![source.effect.sentence().to_string(), left]
}

/// Deviations of the parameters of the last effect.
pub(super) fn last_deviations(fit: &FittedRecords) -> Vec<f64> {
    let count = fit.effects.last().map_or(0, |e| e.parameters.len());
    let end = parameters(fit);
    fit.deviations[end - count..end].to_vec()
}

/// Corrections of a fit that a project can state ([`Search::stated_fit`](super::search::Search)), with their deviations.
pub(super) fn corrections(records: &Records, fit: &FittedRecords) -> Vec<Correction> {
    let wide = scale(fit).sqrt();
    let first = parameters(fit);
    let modes = modes(records);
    let sizes = fit.known.iter().chain(&fit.damping);
    let values = std::iter::once(fit.stiffness).chain(sizes.copied()).chain(fit.modes.iter().take(modes).copied());
    let values = values.chain([fit.mass]);
    let names = std::iter::once(UpdatingParameter::Structure(Part::Stiffness))
        .chain((0..records.known.len()).map(UpdatingParameter::Known))
        .chain((0..fit.damping.len()).map(|r| UpdatingParameter::Structure(Part::ModeDamping(r))))
        .chain((0..modes).map(|r| UpdatingParameter::Structure(Part::Mode(r))))
        .chain([UpdatingParameter::Structure(Part::Mass)]);
    let correction = |(k, (v, parameter)): (usize, (f64, UpdatingParameter))| {
        let deviation = fit.deviations.get(first + k).copied().unwrap_or(f64::NAN) * wide;
        (v != 0.0).then(|| Correction { parameter, factor: v.exp(), deviation: deviation * v.exp() })
    };
    values.zip(names).enumerate().filter_map(correction).collect()
}

/// Corrections of the parts of the structure that a fit moved along their directions.
pub(super) fn corrections_of_parts(records: &Records, fit: &FittedRecords) -> Vec<(Part, Correction)> {
    let wide = scale(fit).sqrt();
    let first = parameters(fit) + 2 + records.sizes() + modes(records);
    let own = |k: usize| fit.deviations.get(first + k).map_or(1.0, |d| (d * wide).min(1.0));
    let own: Vec<f64> = (0..fit.parts.len()).map(own).collect();
    let parts = records.parts.logarithms(&fit.parts).into_iter().zip(records.parts.deviations(&own));
    let correction = |((part, v), deviation): ((Part, f64), f64)| {
        let parameter = UpdatingParameter::Structure(part);
        (part, Correction { parameter, factor: v.exp(), deviation: deviation * v.exp() })
    };
    parts.map(correction).filter(|(_, c)| c.factor != 1.0).collect()
}

/// Takes out the fits whose last law has more parameters than another at the same place that leaves all but as little, with as little
/// corrected; where what is left is noise only those for which the evidence does not speak all the same.
pub(super) fn keep_parsimonious(found: &mut Vec<FittedRecords>) {
    let unit = found.iter().map(scale).fold(f64::INFINITY, f64::min);
    let cost = |f: &FittedRecords| f.chi_square + unit * f.prior;
    let simple: Vec<(f64, f64, Source)> =
        found.iter().filter_map(|f| Some((cost(f), evidence(f, unit), f.effects.last()?.clone()))).collect();
    let needless = |fit: &FittedRecords| {
        let Some(own) = fit.effects.last() else { return false };
        let wrong = usize::from(misfit(fit) > MODEL_ERROR);
        let plainer = |(left, worth, other): &(f64, f64, Source)| {
            other.place.is_same(&own.place)
                && other.parameters.len() < own.parameters.len()
                && *left <= PLAIN[wrong] * cost(fit)
                && (wrong == 1 || *worth <= evidence(fit, unit))
        };
        simple.iter().any(plainer)
    };
    found.retain(|fit| !needless(fit));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Effect, Place};
    use std::sync::Arc;

    /// Of 4000 samples, what is left as large in each.
    fn fit(effect: Effect, chi_square: f64) -> FittedRecords {
        let parameters = vec![1.0; effect.parameters().len()];
        let effects = vec![Source::known(effect, Place::Dofs(vec![0]), &parameters)];
        let residual = Arc::new(vec![vec![vec![(chi_square / 4000.0).sqrt(); 4000]]]);
        FittedRecords { residual, count: 4000, ..FittedRecords::of_effects(effects, chi_square) }
    }

    /// A power law is told beside the drag that it contains where the evidence speaks for it, though it leaves hardly less; not where
    /// it does not, nor where what is left is an error of the model.
    #[test]
    fn laws_of_more_parameters_are_told_where_the_evidence_speaks_for_them() {
        let told = |chi_squares: [f64; 2]| {
            let mut found = vec![fit(Effect::Power, chi_squares[0]), fit(Effect::Quadratic, chi_squares[1])];
            keep_parsimonious(&mut found);
            found.iter().map(|f| f.effects[0].effect).collect::<Vec<_>>()
        };
        assert_eq!(told([4000.0, 4100.0]), [Effect::Power, Effect::Quadratic]);
        assert_eq!(told([4000.0, 4010.0]), [Effect::Quadratic]);
        assert_eq!(told([12_000.0, 12_300.0]), [Effect::Quadratic]);
    }
}

//! From the fits of a search on energies to what is said.

use super::balance::{Balance, Fitted};
use super::evidence::{agrees, beside};
use crate::diagnosis::result::{Added, Diagnosis, Step, Suggestion, Verdict};
use crate::diagnosis::selection::conclusion::{TOLERATED, UNTRUSTED};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::Source;
use crate::math::statistics::{evidence_weights, root_mean_square, sum_of_squares};

/// Difference of the squared residual within which two suggestions cannot be told apart.
const ALIKE: f64 = 9.0;
/// Most suggestions.
const MOST: usize = 8;

/// The answer of a search that ended with these fits, one list a number of effects.
pub(super) fn conclude(balance: &Balance, by_size: &[Vec<Fitted>]) -> Diagnosis {
    let mut diagnosis = as_stated(balance);
    let by_size = lowering(by_size, diagnosis.error_before);
    match (by_size.first(), by_size.last()) {
        (Some(first), Some(top)) => {
            let set: Vec<Source> = top[0].added.iter().map(|added| added.source.clone()).collect();
            diagnosis.corrections = balance.corrections(&set);
            for added in &top[0].added {
                correct(&mut diagnosis.corrections, balance, added);
            }
            if set.iter().all(|source| known(balance, source).is_some()) {
                diagnosis.steps.push(Step { added: Vec::new(), ..step(balance, &top[0]) });
                diagnosis.verdict = Verdict::Detuned;
            } else {
                diagnosis.steps.extend(by_size.iter().map(|fitted_sets| step(balance, &fitted_sets[0])));
                suggest(&mut diagnosis, balance, first, top);
            }
        }
        _ => without_effects(&mut diagnosis, balance),
    }
    diagnosis
}

/// The fits up to the last number of effects whose best set leaves a smaller error than the model as it is, `before`: weighed by its
/// noise a set may fit better and leave more energy all the same, which explains nothing.
fn lowering(by_size: &[Vec<Fitted>], before: f64) -> &[Vec<Fitted>] {
    let lowers = |fits: &Vec<Fitted>| fits[0].error < before;
    &by_size[..by_size.iter().rposition(lowers).map_or(0, |k| k + 1)]
}

/// Number of the known source of which `source` is more: linear sources of one law and place add up.
fn known(balance: &Balance, source: &Source) -> Option<usize> {
    balance
        .known
        .iter()
        .position(|known| known.effect.is_linear() && known.parameters.len() == 1 && known.is_same(source))
}

/// Takes `added` as a correction of the known source of which it is more, if there is one of one size.
fn correct(corrections: &mut Vec<Correction>, balance: &Balance, added: &Added) {
    let Some(k) = known(balance, &added.source) else { return };
    let (Some(&stated), Some(&more)) = (balance.known[k].parameters.first(), added.source.parameters.first()) else {
        return;
    };
    let deviation = added.deviations.first().map_or(0.0, |d| d / stated);
    let parameter = UpdatingParameter::Known(k);
    match corrections.iter_mut().find(|c| c.parameter == parameter) {
        Some(known) => {
            known.factor += more / stated;
            known.deviation = known.deviation.hypot(deviation);
        }
        None => corrections.push(Correction { parameter, factor: 1.0 + more / stated, deviation }),
    }
}

fn step(balance: &Balance, fit: &Fitted) -> Step {
    Step { added: fit.added.clone(), error: fit.error, misfit: fit.chi_square / balance.missing.len() as f64 }
}

/// What is said of the model as it is.
fn as_stated(balance: &Balance) -> Diagnosis {
    let relative = |values: &[f64]| {
        let over = |(v, e): (&f64, &f64)| if *e == 0.0 { 1.0 } else { (v / e).abs() };
        root_mean_square(&values.iter().zip(&balance.input).map(over).collect::<Vec<_>>())
    };
    let (before, misfit) =
        (relative(&balance.missing), sum_of_squares(&balance.weighted()) / balance.missing.len() as f64);
    Diagnosis::adequate(Step { added: Vec::new(), error: before, misfit }, relative(&balance.deviation))
}

/// The verdict where no effect has the evidence.
fn without_effects(diagnosis: &mut Diagnosis, balance: &Balance) {
    let (n, left) = (balance.missing.len(), sum_of_squares(&balance.weighted()));
    let error = root_mean_square(&balance.errors(&[]));
    if error < diagnosis.error_before {
        diagnosis.corrections = balance.corrections(&[]);
    }
    diagnosis.verdict = match (agrees(left, n, 0), diagnosis.corrections.is_empty()) {
        (true, true) => Verdict::Adequate,
        (true, false) => Verdict::Detuned,
        (false, _) => Verdict::Unexplained,
    };
    if !diagnosis.corrections.is_empty() {
        diagnosis.steps.push(Step { added: Vec::new(), error, misfit: left / n as f64 });
    }
}

/// The effects of the best sets with their probabilities, and the verdict.
fn suggest(diagnosis: &mut Diagnosis, balance: &Balance, first: &[Fitted], top: &[Fitted]) {
    let n = balance.missing.len();
    // What even the best leaves beyond the noise is no noise that could tell the others apart.
    let scale = (top[0].chi_square / n.saturating_sub(top[0].parameters).max(1) as f64).max(1.0);
    let weights = evidence_weights(&top.iter().map(|f| beside(f, &top[0], n, scale)).collect::<Vec<_>>());
    let trust = if top[0].chi_square > TOLERATED * n as f64 { UNTRUSTED } else { 1.0 };
    for (fit, added) in top.iter().flat_map(|fit| fit.added.iter().map(move |added| (fit, added))) {
        let listed = diagnosis.suggestions.iter().any(|s| s.added.source.is_same(&added.source));
        if listed || known(balance, &added.source).is_some() || diagnosis.suggestions.len() >= MOST {
            continue;
        }
        let with = top.iter().zip(&weights).filter(|(f, _)| contains(f, &added.source));
        let probability = trust * with.map(|(_, w)| w).sum::<f64>().min(1.0);
        // Beside corrections the set is added as a whole.
        let of_set = (!diagnosis.corrections.is_empty() && contains(&top[0], &added.source)).then_some(&top[0]);
        let alone = first.iter().find(|f| contains(f, &added.source)).unwrap_or(fit);
        let told = of_set.unwrap_or(alone);
        diagnosis.suggestions.push(Suggestion {
            added: added.clone(),
            error_after: told.error,
            held_out_error_after: told.held_out,
            probability,
            evidence: sentences(added, diagnosis.error_before, alone.error),
            indistinguishable_from: alike(top, &added.source),
        });
    }
    let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
    diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
}

fn contains(fit: &Fitted, source: &Source) -> bool {
    fit.added.iter().any(|a| a.source.is_same(source))
}

fn alike(top: &[Fitted], source: &Source) -> Vec<Source> {
    let mut found: Vec<Source> = Vec::new();
    for fit in top.iter().filter(|f| f.chi_square - top[0].chi_square < ALIKE) {
        let fresh: Vec<&Source> = fit.added.iter().map(|a| &a.source).filter(|s| !contains(&top[0], s)).collect();
        if let [other] = fresh[..]
            && contains(&top[0], source)
            && !contains(fit, source)
            && !found.iter().any(|f| f.is_same(other))
        {
            found.push(other.clone());
        }
    }
    found
}

fn sentences(added: &Added, before: f64, after: f64) -> Vec<String> {
    let [before, after] = [before, after].map(|error| 100.0 * error);
    let change = if after < before {
        format!("The error of the energy falls from {before:.3} % to {after:.3} %.")
    } else {
        format!("Alone it would raise the error of the energy from {before:.3} % to {after:.3} %.")
    };
    vec![
        added.source.effect.sentence().to_string(),
        crate::diagnosis::selection::sentences::values(&added.source, &added.deviations),
        change,
        "Without mass and stiffness only the energy of each run can be compared.".to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_that_leave_more_than_the_model_as_it_is_are_not_told() {
        let fit =
            |error: f64| vec![Fitted { added: Vec::new(), chi_square: 1.0, parameters: 1, error, held_out: error }];
        let told = |errors: &[f64]| {
            let by_size: Vec<Vec<Fitted>> = errors.iter().map(|e| fit(*e)).collect();
            lowering(&by_size, 0.2).len()
        };
        assert_eq!([told(&[0.3, 0.4]), told(&[0.1, 0.4]), told(&[0.3, 0.1]), told(&[])], [0, 1, 2, 0]);
    }
}

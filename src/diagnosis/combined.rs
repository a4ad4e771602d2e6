//! What steady runs and records that are not steady say together of what a model lacks. Both are measured independently, so that what
//! they say of the same effect multiplies (Bayes):
//!
//! ```text
//! p(e | runs, records)  ~  p(e | runs) p(e | records)
//! ```
//!
//! An effect that one of the searches did not name has a small probability there, `UNNAMED`: its search may have passed it over.
//! Sizes, corrections and errors are those of the search to which the likeliest effect belongs; what the other one finds is said.

use crate::diagnosis::result::{Diagnosis, Suggestion, Verdict};
use crate::effects::Source;

/// Probability of an effect in a search that does not name it.
const UNNAMED: f64 = 0.01;
/// Probability from which on the first suggestion is told as missing.
const SURE: f64 = 0.5;

/// Joins what a search in steady runs and one in records found; either alone where the other one suggests nothing.
pub(crate) fn combined(steady: Diagnosis, records: Diagnosis) -> Diagnosis {
    if records.suggestions.is_empty() {
        return Diagnosis { complete: steady.complete && records.complete, ..steady };
    }
    if steady.suggestions.is_empty() {
        return Diagnosis { complete: steady.complete && records.complete, ..records };
    }
    let probability_in = |found: &Diagnosis, source: &Source| {
        let own = found.suggestions.iter().find(|s| s.added.source.is_same(source));
        own.map_or(UNNAMED, |s| s.probability.max(UNNAMED))
    };
    let joint = |source: &Source| probability_in(&steady, source) * probability_in(&records, source);
    let mut sources: Vec<Source> = Vec::new();
    for suggestion in steady.suggestions.iter().chain(&records.suggestions) {
        if !sources.iter().any(|s| s.is_same(&suggestion.added.source)) {
            sources.push(suggestion.added.source.clone());
        }
    }
    let sum: f64 = sources.iter().map(&joint).sum();
    // Effects of a set do not exclude each other: as many as the larger set holds share the probability.
    let count = [&steady, &records].map(|d| d.steps.last().map_or(1, |s| s.added.len().max(1)));
    let together = count[0].max(count[1]) as f64;
    let probabilities: Vec<f64> = sources.iter().map(|s| (together * joint(s) / sum).min(1.0)).collect();
    let first = sources.iter().max_by(|a, b| joint(a).total_cmp(&joint(b)));
    let by_records = first.is_some_and(|first| probability_in(&records, first) > probability_in(&steady, first));
    let (mut base, other, name) =
        if by_records { (records, steady, "steady runs") } else { (steady, records, "records") };
    let foreign: Vec<Suggestion> = other
        .suggestions
        .iter()
        .filter(|s| !base.suggestions.iter().any(|own| own.added.source.is_same(&s.added.source)))
        .cloned()
        .collect();
    for suggestion in &mut base.suggestions {
        let same = other.suggestions.iter().find(|s| s.added.source.is_same(&suggestion.added.source));
        suggestion.evidence.push(said(name, same));
    }
    base.suggestions.extend(foreign.into_iter().map(|mut s| {
        s.evidence.push(format!("Only the {name} name it."));
        s
    }));
    for suggestion in &mut base.suggestions {
        let at = sources.iter().position(|s| s.is_same(&suggestion.added.source));
        suggestion.probability = at.map_or(0.0, |k| probabilities[k]);
    }
    base.suggestions.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let sure = base.suggestions.first().is_some_and(|s| s.probability >= SURE);
    base.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
    base.next_test.extend(other.next_test);
    base.complete &= other.complete;
    base
}

/// What the other search says of an effect.
fn said(name: &str, found: Option<&Suggestion>) -> String {
    let Some(found) = found else { return format!("The {name} do not name it.") };
    let list = found.added.source.effect.parameters().iter().zip(&found.added.source.parameters);
    let sizes: Vec<String> = list
        .zip(&found.added.deviations)
        .map(|((p, value), deviation)| format!("{} {value:.3e} +- {deviation:.1e} {}", p.name, p.unit))
        .map(|words| words.trim_end().to_owned())
        .collect();
    format!("The {name} alone give it {:.0} % and find {}.", 100.0 * found.probability, sizes.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::result::{Added, Step};
    use crate::effects::{Effect, Place};

    fn found(list: &[(Effect, usize, f64)]) -> Diagnosis {
        let added = |effect, dof: usize| Added {
            source: Source::known(effect, Place::Dofs(vec![dof]), &[1.0]),
            deviations: vec![0.1],
        };
        let suggestion = |&(effect, dof, probability): &(Effect, usize, f64)| Suggestion {
            added: added(effect, dof),
            error_after: 0.1,
            held_out_error_after: 0.1,
            probability,
            evidence: Vec::new(),
            indistinguishable_from: Vec::new(),
        };
        let first = list.iter().map(|(effect, dof, _)| added(*effect, *dof)).take(1).collect();
        let step = Step { added: first, error: 0.1, misfit: 1.0 };
        Diagnosis {
            error_before: 0.5,
            verdict: if list.is_empty() { Verdict::Adequate } else { Verdict::Undecided },
            suggestions: list.iter().map(suggestion).collect(),
            ..Diagnosis::adequate(step, 0.01)
        }
    }

    /// Runs cannot tell two laws apart, records not two places: together they name one.
    #[test]
    fn what_neither_tells_alone_both_tell_together() {
        let runs = found(&[(Effect::Viscous, 3, 0.5), (Effect::Quadratic, 3, 0.5)]);
        let records = found(&[(Effect::Quadratic, 2, 0.55), (Effect::Quadratic, 3, 0.45)]);
        let both = combined(runs, records);
        let first = &both.suggestions[0];
        let wanted = Source::known(Effect::Quadratic, Place::Dofs(vec![3]), &[1.0]);
        assert!(first.added.source.is_same(&wanted), "{:?}", first.added.source);
        assert!(first.probability > 0.9 && both.verdict == Verdict::Missing, "{}", first.probability);
        let sum: f64 = both.suggestions.iter().map(|s| s.probability).sum();
        assert!((sum - 1.0).abs() < 1e-12 && both.suggestions.len() == 3);
        assert!(first.evidence.iter().any(|words| words.starts_with("The records alone give it 45 %")));
    }

    #[test]
    fn who_sees_nothing_says_nothing() {
        let runs = found(&[(Effect::Coulomb, 1, 0.8)]);
        assert_eq!(combined(runs.clone(), found(&[])), runs);
        assert_eq!(combined(found(&[]), runs.clone()), runs);
    }
}

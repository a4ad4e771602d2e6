//! What changed between two states, in a sentence.

use super::format;
use crate::identify::change::{Change, SourceChange};
use crate::structure::Structure;

/// What a reader takes away: which sources changed and by how much, or that none did.
pub(crate) fn sentence(structure: &Structure, found: &Change) -> String {
    let source_in_words = |s: &SourceChange| {
        let name = s.source.title(structure);
        let by = format::with_deviation(s.coefficient.difference, s.coefficient.deviation, unit(s));
        let sign = if s.coefficient.difference > 0.0 { "+" } else { "" };
        let share = relative(s).map_or_else(String::new, |r| format!(" ({r})"));
        format!("{name}: {sign}{by}{share}")
    };
    let changed: Vec<String> = found.changed().map(source_in_words).collect();
    let together = found.chance.map_or_else(String::new, |p| {
        format!(" Probability that noise alone makes all these differences: {}.", chance(p))
    });
    match changed.len() {
        0 if found.sources.is_empty() => "No source was identified in either state.".to_owned(),
        0 => format!("No source changed by more than noise makes.{together}"),
        _ => format!("Changed: {}.{together}", changed.join("; ")),
    }
}

/// The difference as a share of the first value, where there is one.
pub(crate) fn relative(s: &SourceChange) -> Option<String> {
    let [first, _] = s.coefficient.values;
    let known = first > 3.0 * s.coefficient.deviations[0];
    known.then(|| {
        let percent = 100.0 * s.coefficient.difference / first;
        format!("{}{} %", if percent > 0.0 { "+" } else { "" }, format::significant(percent, 3))
    })
}

/// Unit of the coefficient.
pub(crate) fn unit(s: &SourceChange) -> &'static str {
    s.source.effect.coefficient().map_or("", |k| s.source.effect.parameters()[k].unit)
}

/// A probability of chance: `0.23`, `3e-5`, `< 1e-12`.
pub(crate) fn chance(p: f64) -> String {
    if p < 1e-12 { "< 1e-12".to_owned() } else { format::significant(p, 2).replace('−', "-") }
}

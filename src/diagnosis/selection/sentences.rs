//! The sentences an engineer would say for a suggestion.

use crate::diagnosis::candidates::fingerprint::fingerprint;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::result::Added;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::{Place, Source};
use crate::math::numerals::{significant, with_deviation};

/// The sentences for an effect of the set `best`.
pub(crate) fn sentences(
    reference: &ReferenceModel,
    added: &Added,
    best: &FittedModel,
    before: f64,
    after: f64,
) -> Result<Vec<String>, DiagnosisError> {
    let source = &added.source;
    let mut said = vec![source.effect.sentence().to_string(), values(source, &added.deviations)];
    let percent = |share: f64| significant(100.0 * share, 3);
    let on = if reference.data.chosen { " on the runs that were searched" } else { "" };
    said.push(format!("With it alone the error{on} goes from {} % to {} %.", percent(before), percent(after)));
    // Of a set the error told is that of the effect alone, and there is no fit of it to ask.
    if after > before && best.effects.len() == 1 {
        let left = reference.error_beside_jumps(&best.effects, &best.starts)?;
        if left < before {
            said.push(format!(
                "Without the runs that may lie beyond a jump, one in eight, it leaves {} %.",
                percent(left)
            ));
        }
    }
    match &source.place {
        Place::Dofs(_) => {
            if let Some(data) = reference.place_data(best, source)?
                && let Some(found) = fingerprint(&data)
            {
                said.extend(found.sentences());
            }
        }
        Place::Channel(channel) => {
            said.push(format!("All other channels agree with the model once {channel} is corrected."));
        }
        Place::Whole(_) => said.push("It acts on every mode; no single place explains it.".to_string()),
    }
    Ok(said)
}

/// Parameters with their deviations and units.
pub(crate) fn values(source: &Source, deviations: &[f64]) -> String {
    let list = source.effect.parameters().iter().zip(&source.parameters).zip(deviations);
    let each: Vec<String> = list
        .map(|((p, value), d)| format!("{} = {} {}", p.name, with_deviation(*value, *d), p.unit).trim_end().to_string())
        .collect();
    format!("Fitted on the response: {}.", each.join(", "))
}

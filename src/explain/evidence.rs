//! Fingerprints that need no model of the law, and the sentences an engineer would say.

use super::data::ExplainError;
use super::search::Base;
use crate::effects::{Place, Source};

/// The sentences for an effect that was fitted.
pub(crate) fn sentences(
    base: &Base,
    source: &Source,
    deviations: &[f64],
    before: f64,
    after: f64,
) -> Result<Vec<String>, ExplainError> {
    let mut said = vec![source.effect.sentence().to_string(), values(source, deviations)];
    said.push(format!("The error falls from {:.3} % to {:.3} %.", 100.0 * before, 100.0 * after));
    if let Place::Dofs(dofs) = &source.place {
        let labels: Vec<&str> = dofs.iter().map(|&d| base.predictor.structure().label(d)).collect();
        said.push(format!("A force at DOF {} explains the residual of all channels at once.", labels.join(" - ")));
    }
    Ok(said)
}

/// Parameters with their deviations and units.
fn values(source: &Source, deviations: &[f64]) -> String {
    let list = source.effect.parameters().iter().zip(&source.parameters).zip(deviations);
    let each: Vec<String> = list
        .map(|((p, value), d)| format!("{} = {value:.4e} +- {d:.1e} {}", p.name, p.unit).trim_end().to_string())
        .collect();
    format!("Fitted on the response: {}.", each.join(", "))
}

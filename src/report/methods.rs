//! The methods that were used for a report, each with its source.

use super::content::Content;
use super::page::Page;
use super::section::Section;
use crate::balance::Expansion;
use crate::diagnosis::Diagnosis;
use crate::session::validation::{has_records, is_component};

const EWINS: &str =
    "D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed., Research Studies Press, 2000";
const FRISWELL: &str =
    "M. I. Friswell, J. E. Mottershead, Finite Element Model Updating in Structural Dynamics, Kluwer, 1995";
const KRACK: &str = "M. Krack, J. Gross, Harmonic Balance for Nonlinear Vibration Problems, Springer, 2019";
const CAMERON: &str = "T. M. Cameron, J. H. Griffin, An alternating frequency/time domain method for calculating the \
                       steady-state response of nonlinear dynamic systems, J. Appl. Mech. 56, 1989";
const MASRI: &str = "S. F. Masri, T. K. Caughey, A nonparametric identification technique for nonlinear dynamic problems, J. Appl. Mech. 46, 1979";
const PRANDINA: &str = "M. Prandina, Spatial Damping Identification, PhD thesis, University of Liverpool, 2010";
const LAWSON: &str = "C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, Prentice-Hall, 1974";
const CALLAHAN: &str =
    "J. O'Callahan, P. Avitabile, R. Riemer, System equivalent reduction expansion process (SEREP), IMAC VII, 1989";
const BALMES: &str = "E. Balmès, Review and evaluation of shape expansion methods, IMAC XVIII, 2000";
const SCHWARZ: &str = "G. Schwarz, Estimating the dimension of a model, Ann. Statist. 6, 1978";
const YAO: &str = "Y. Yao, A. Vehtari, D. Simpson, A. Gelman, Using stacking to average Bayesian predictive distributions, \
                   Bayesian Analysis 13, 2018";

/// A method: a sentence, and its sources.
type Method = (&'static str, &'static [&'static str]);

/// Adds the chapter.
pub(super) fn chapter(page: &mut Page, content: &Content<'_>) {
    page.chapter(Section::Methods, "Methods and references");
    let mut references: Vec<&str> = Vec::new();
    for (sentence, sources) in used(content) {
        let number = |source: &&'static str| {
            let at = references.iter().position(|known| known == source).unwrap_or_else(|| {
                references.push(source);
                references.len() - 1
            });
            format!("[{}]", at + 1)
        };
        let numbers: Vec<String> = sources.iter().map(number).collect();
        page.sentence(&format!("{sentence} {}.", numbers.join(", ")));
    }
    page.section("References");
    references.iter().enumerate().for_each(|(k, text)| page.sentence(&format!("[{}] {text}.", k + 1)));
}

/// The methods that the results of this report rest on.
fn used(content: &Content<'_>) -> Vec<Method> {
    let mut list = measurements(content);
    if content.outcome.is_ok() {
        list.extend(identification(content));
    }
    if content.comparison.is_ok() || content.records.as_ref().is_some_and(Result::is_ok) {
        list.extend(comparison(content));
    }
    if let Some(Ok(found)) = &content.diagnosis {
        list.extend(search(content, found));
    }
    list
}

fn measurements(content: &Content<'_>) -> Vec<Method> {
    let p = content.project;
    let mut list: Vec<Method> = Vec::new();
    if p.runs.iter().any(|run| run.record.is_some()) {
        list.push((
            "Harmonics of steady records: least squares over the whole record at the frequency of excitation, with the \
             covariance of every amplitude from what the fit leaves",
            &[EWINS],
        ));
    }
    if p.runs.iter().any(|run| run.per_unit_force) {
        list.push(("Frequency responses, taken line by line as motion under a unit force", &[EWINS]));
    }
    if has_records(p) && !is_component(p) {
        list.push((
            "Records that are not steady: the energy equation over windows of the record, with the difference of stored energy \
             at their ends",
            &[PRANDINA],
        ));
    }
    if is_component(p) {
        list.push(("Loops of a component: the work of force on displacement over a cycle", &[PRANDINA]));
    }
    list
}

fn identification(content: &Content<'_>) -> Vec<Method> {
    let p = content.project;
    let mut list: Vec<Method> = vec![
        ("Energy equation: over a period the work of the exciter is what the sources take out", &[PRANDINA]),
        (
            "Choice of sources by the angle between measured energies and the cone of their columns; coefficients by \
             non-negative least squares",
            &[PRANDINA, LAWSON],
        ),
    ];
    if !p.runs.is_empty() && p.structure.matrices().is_some() {
        list.extend(expansion(p.settings.expansion));
    }
    if content.outcome.as_ref().is_ok_and(|outcome| !outcome.results.modes.is_empty()) {
        list.push((
            "Damping ratios: eigenvalues of the damped model, with the half-power values beside them",
            &[EWINS],
        ));
    }
    list
}

fn expansion(method: Expansion) -> Option<Method> {
    match method {
        Expansion::None => None,
        Expansion::SingleMode | Expansion::Modes => {
            Some(("Motion at all degrees of freedom: least squares on mode shapes", &[CALLAHAN]))
        }
        Expansion::Auto | Expansion::Dynamic => Some((
            "Motion at all degrees of freedom: what fits the sensors within their noise and the dynamic stiffness of the model \
             within its error (minimum dynamic residual)",
            &[BALMES],
        )),
    }
}

fn comparison(content: &Content<'_>) -> Vec<Method> {
    let p = content.compared();
    if has_records(p) && p.runs.is_empty() {
        return vec![("Response of the model to the recorded excitation: step by step in time", &[KRACK])];
    }
    let is_bent = |s: &crate::effects::Source| s.state == crate::effects::State::Known && !s.effect.is_linear();
    if p.sources.iter().any(is_bent) {
        return vec![(
            "Response of the model: harmonic balance, its forces evaluated over one period, continuation through folds",
            &[KRACK, CAMERON],
        )];
    }
    vec![("Response of the model: its dynamic stiffness at the frequency of every run", &[EWINS])]
}

fn search(content: &Content<'_>, found: &Diagnosis) -> Vec<Method> {
    let mut list: Vec<Method> = vec![(
        "What is missing: a force without a law at every place first, then laws at the best places, fitted on the response \
         beside errors of the model, of gains and delays of channels and of frequencies",
        &[FRISWELL, KRACK],
    )];
    if !found.suggestions.is_empty() {
        list.push((
            "Probabilities: evidence by the Bayesian information criterion and predictions of runs that are left out of the \
             fit, by the Bayesian bootstrap",
            &[SCHWARZ, YAO],
        ));
    }
    if !found.corrections.is_empty() {
        list.push(("Corrections of the model: updating of parameters with weights for what is usual", &[FRISWELL]));
    }
    if !content.forces.is_empty() {
        list.push(("Missing force over displacement and velocity at its place", &[MASRI]));
    }
    list
}

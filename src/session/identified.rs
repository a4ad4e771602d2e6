//! Takes over what `identify` finds: sources that were sought become known at their coefficients, so that a model whose
//! damping was still to be found can be compared with the measurement.

use crate::control::Control;
use crate::diagnosis::diagnose::lacks_width;
use crate::effects::{Source, State};
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::session::validation::problem;

/// Makes the sources that `outcome` found known in `project` and the others that were sought inactive; a source that is
/// known there already gets the coefficient on top of its own. Gives what was taken over.
pub fn take_over(project: &mut Project, outcome: &Outcome) -> Vec<Source> {
    let taken: Vec<Source> = found(&project.sources, outcome)
        .map(|(k, coefficient)| Source { state: State::Known, ..project.sources[k].with_coefficient(coefficient) })
        .collect();
    project.sources.iter_mut().filter(|s| s.state.is_sought()).for_each(|s| s.state = State::Off);
    for source in &taken {
        let there = project.sources.iter_mut().find(|s| s.state == State::Known && s.is_same(source));
        match (there, source.effect.coefficient()) {
            (Some(there), Some(k)) => there.parameters[k] += source.parameters[k],
            _ => project.sources.push(source.clone()),
        }
    }
    taken
}

/// The sources that were sought and found, by their place in the list, with their coefficients.
pub(crate) fn found<'a>(sources: &'a [Source], outcome: &'a Outcome) -> impl Iterator<Item = (usize, f64)> + 'a {
    let sought = |k: usize| sources.get(k).is_some_and(|source| source.state.is_sought());
    let found = outcome.sources.iter().filter(move |e| e.coefficient > 0.0 && sought(e.source));
    found.map(|e| (e.source, e.coefficient))
}

/// Whether a project states no damping at all, asks for it, and has runs within the width of a resonance: of what else its model
/// lacks nothing can be said before that is identified.
pub fn lacks_damping(project: &Project, control: &Control) -> bool {
    let damps = |source: &Source| source.effect.dissipates();
    let sought = project.sources.iter().any(|source| source.state.is_sought() && damps(source));
    let problem = problem(project);
    let known = problem.known().iter().any(damps);
    !known && sought && project.structure.matrices().is_some() && lacks_width(&problem, control).unwrap_or(false)
}

//! Takes over what `identify` finds: sources that were sought become known at their coefficients, so that a model whose
//! damping was still to be found can be compared with the measurement.

use crate::control::Control;
use crate::diagnosis::diagnose::lacks_width;
use crate::effects::{Source, State};
use crate::exchange::Project;
use crate::identify::{Estimate, Outcome};
use crate::session::validation::problem;

/// Makes the sources that `outcome` found known in `project`, as `known` says, and the others that were sought inactive. Gives what was
/// taken over.
pub fn take_over(project: &mut Project, outcome: &Outcome) -> Vec<Source> {
    let found = found(&project.sources, outcome);
    for (k, source) in known(&project.sources, &found) {
        project.sources[k] = source;
    }
    project.sources.iter_mut().filter(|s| s.state.is_sought()).for_each(|s| s.state = State::Off);
    found
}

/// The sources that were sought and found, at their coefficients.
pub(crate) fn found(sources: &[Source], outcome: &Outcome) -> Vec<Source> {
    let found = outcome.sources.iter().filter(|e| e.coefficient > 0.0);
    let known = |e: &Estimate| {
        let source = sources.get(e.source).filter(|source| source.state.is_sought())?;
        Some(Source { state: State::Known, ..source.with_coefficient(e.coefficient) })
    };
    found.filter_map(known).collect()
}

/// Where in `sources` something changes when those `found` become known, and to what: each that was sought is known, or off where a
/// known source there gets the coefficient on top of its own.
pub(crate) fn known(sources: &[Source], found: &[Source]) -> Vec<(usize, Source)> {
    let mut changes = Vec::new();
    for source in found {
        let place = |is: fn(State) -> bool| sources.iter().position(|s| is(s.state) && s.is_same(source));
        let Some(sought) = place(State::is_sought) else { continue };
        match place(|state| state == State::Known).zip(source.effect.coefficient()) {
            Some((own, k)) => {
                let mut sum = sources[own].clone();
                sum.parameters[k] += source.parameters[k];
                changes.extend([(sought, Source { state: State::Off, ..sources[sought].clone() }), (own, sum)]);
            }
            None => changes.push((sought, source.clone())),
        }
    }
    changes
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

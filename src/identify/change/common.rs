//! The sources that two states have in common, by law and labels of the place.

use super::condition::{ChangeError, Condition, NAMES};
use crate::effects::{Place, Source, State};
use crate::identify::outcome::Outcome;
use crate::structure::Structure;

/// A source that a state accepted, in the DOFs of both.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shared {
    /// In each state.
    pub sources: [Source; 2],
    /// Which accepted it.
    pub accepted: [bool; 2],
}

/// All sources that were sought and accepted in one state or in both, in the order of the first.
///
/// # Errors
/// A place that the other structure lacks.
pub(super) fn accepted_by_either(
    states: &[Condition<'_>; 2],
    outcomes: &[Outcome; 2],
) -> Result<Vec<Shared>, ChangeError> {
    let mut all: Vec<Shared> = Vec::new();
    for (k, outcome) in outcomes.iter().enumerate() {
        let other = 1 - k;
        for estimate in &outcome.accepted_step().sources {
            let source = &states[k].sources[estimate.source];
            if let Some(known) = all.iter_mut().find(|s| s.sources[k].is_same(source)) {
                known.accepted[k] = true;
                continue;
            }
            let place = moved(&source.place, states[k].structure, states[other].structure, NAMES[other])?;
            let there = Source { place, ..source.clone() };
            let mut accepted = [false; 2];
            accepted[k] = true;
            let sources = if k == 0 { [source.clone(), there] } else { [there, source.clone()] };
            all.push(Shared { sources, accepted });
        }
    }
    Ok(all)
}

/// A place of one structure in another, by the labels of its DOFs.
fn moved(place: &Place, from: &Structure, to: &Structure, state: &'static str) -> Result<Place, ChangeError> {
    let Place::Dofs(dofs) = place else { return Ok(place.clone()) };
    let find = |&dof: &usize| {
        let label = from.label(dof);
        to.dof(label).ok_or_else(|| ChangeError::NoDof { state, label: label.to_owned() })
    };
    Ok(Place::Dofs(dofs.iter().map(find).collect::<Result<_, _>>()?))
}

/// The known sources of a state, and those given as forced in place of all that were sought.
pub(super) fn with_forced<'a>(sources: &[Source], forced: impl Iterator<Item = &'a Source>) -> Vec<Source> {
    let kept = sources.iter().filter(|s| !s.state.is_sought()).cloned();
    kept.chain(forced.map(|s| Source { state: State::Forced, ..s.clone() })).collect()
}

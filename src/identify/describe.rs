//! A source in words for messages.

use crate::effects::{Place, Source};
use crate::structure::Structure;

/// A source in words, such as `viscous at 3` or `coulomb between 1 and 2`.
pub(crate) fn describe(source: &Source, structure: &Structure) -> String {
    let label = |&dof: &usize| structure.dofs().get(dof).map_or("?", |d| d.label.as_str());
    match &source.place {
        Place::Dofs(dofs) => {
            let labels: Vec<&str> = dofs.iter().map(label).collect();
            match labels.as_slice() {
                [one] => format!("{} at {one}", source.effect),
                [first, second] => format!("{} between {first} and {second}", source.effect),
                _ => format!("{} along {}", source.effect, labels.join(", ")),
            }
        }
        Place::Whole(None) => source.effect.to_string(),
        Place::Whole(Some([first, last])) => format!("{} of elements {} to {}", source.effect, first + 1, last + 1),
        Place::Channel(name) => format!("{} of {name}", source.effect),
    }
}

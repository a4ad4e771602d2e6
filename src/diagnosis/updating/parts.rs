//! Parts of a structure whose stiffness and mass a model may state wrongly.

use crate::structure::{Part, Structure, StructureKind};

/// Groups of elements of a beam whose stiffness and mass are updated each on its own.
const ELEMENT_GROUPS: usize = 12;
/// Springs and masses of imported matrices that are updated one by one; above, modes are.
const MOST_SPRINGS: usize = 40;
/// Modes in the band that are updated where neither elements nor springs are known.
const MOST_MODES: usize = 8;
/// Logarithm of a frequency ratio within which a mode counts as in the band of a run.
const NEAR_BAND: f64 = 0.35;

/// Parts of a structure that are wrong independently of each other, as far as its kind shows them.
pub(crate) fn parts(structure: &Structure, omegas: &[f64]) -> Vec<Part> {
    let mut parts = vec![Part::Stiffness, Part::Mass];
    let chain = structure.elements().is_empty() && structure.kind() == StructureKind::Chain;
    parts.extend(structure.lumped().iter().filter(|_| !chain).map(|&row| Part::PointMass(row)));
    let count = structure.elements().len();
    if count > 0 {
        let groups = ELEMENT_GROUPS.min(count);
        let range = |g: usize| [g * count / groups, (g + 1) * count / groups - 1];
        parts.extend((0..groups).map(|g| Part::ElementStiffness(range(g))));
        parts.extend((0..groups).map(|g| Part::ElementMass(range(g))));
        parts.extend(structure.supports().into_iter().map(Part::Support));
        return parts;
    }
    let springs = structure.springs(MOST_SPRINGS);
    if springs.is_empty() || (structure.kind() != StructureKind::Chain && structure.len() > MOST_SPRINGS) {
        parts.extend(modes_in_band(structure, omegas).into_iter().map(Part::Mode));
    } else {
        parts.extend(springs);
        parts.extend((0..structure.len()).map(Part::PointMass));
    }
    parts
}

/// Modes whose frequencies the runs come near to.
fn modes_in_band(structure: &Structure, omegas: &[f64]) -> Vec<usize> {
    let Ok(modes) = structure.modes() else { return Vec::new() };
    let near = |w: f64| omegas.iter().any(|&o| w > 0.0 && (o / w).ln().abs() < NEAR_BAND);
    (0..modes.len()).filter(|&r| near(modes.omega[r])).take(MOST_MODES).collect()
}

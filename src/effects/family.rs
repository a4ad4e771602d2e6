//! Families of candidates: each translation, each DOF, each pair, one chain.

use super::effect::Effect;
use super::kind::Kind;
use super::place::Place;
use super::source::Source;
use crate::structure::Structure;
use serde::{Deserialize, Serialize};

/// Where a family of candidates of one law is looked for: `where` of `[[candidates]]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Each translation to the ground.
    EachTranslation,
    /// Each DOF to the ground, rotations included.
    EachDof,
    /// Between each translation and the next of the same direction.
    EachPair,
    /// One source over all translations of a direction.
    Chain,
}

impl Family {
    /// All families, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::EachTranslation, Self::EachDof, Self::EachPair, Self::Chain];

    /// Name in project files, such as `each-translation`.
    pub fn name(self) -> &'static str {
        match self {
            Self::EachTranslation => "each-translation",
            Self::EachDof => "each-dof",
            Self::EachPair => "each-pair",
            Self::Chain => "chain",
        }
    }

    /// The family of that name in project files.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|family| family.name() == name)
    }

    /// The places of the family on `structure`.
    pub fn places(self, structure: &Structure) -> Vec<Place> {
        let rows = tracks(structure);
        let dofs: Vec<Vec<usize>> = match self {
            Self::EachDof => structure.in_space().into_iter().map(|dof| vec![dof]).collect(),
            Self::EachTranslation => {
                let mut all: Vec<usize> = rows.concat();
                all.sort_unstable();
                all.into_iter().map(|dof| vec![dof]).collect()
            }
            Self::EachPair => rows.iter().flat_map(|row| row.windows(2).map(<[usize]>::to_vec)).collect(),
            Self::Chain => rows.into_iter().filter(|row| row.len() > 1).collect(),
        };
        dofs.into_iter().map(Place::Dofs).collect()
    }

    /// Candidates of `effect` at the places of the family. A law of the whole structure has one place whatever the
    /// family, an error of a channel none on the structure.
    pub fn candidates(self, effect: Effect, structure: &Structure) -> Vec<Source> {
        let places = match effect.kind() {
            Kind::Relative(_) => self.places(structure),
            Kind::Whole(_) => vec![Place::Whole(None)],
            Kind::Channel(_) => Vec::new(),
        };
        places.into_iter().map(|place| Source::candidate(effect, place)).collect()
    }
}

/// Translations in the order of the matrix rows, one list a direction.
fn tracks(structure: &Structure) -> Vec<Vec<usize>> {
    let mut tracks = Vec::new();
    let mut directions = Vec::new();
    for (row, dof) in structure.dofs().iter().enumerate() {
        if dof.direction.is_rotation() {
            continue;
        }
        if let Some(at) = directions.iter().position(|&d| d == dof.direction) {
            let track: &mut Vec<usize> = &mut tracks[at];
            track.push(row);
        } else {
            directions.push(dof.direction);
            tracks.push(vec![row]);
        }
    }
    tracks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{Direction, Dof, Node, Origin, StructureKind};

    fn structure(directions: &[Direction]) -> Structure {
        let dof = |(row, &direction): (usize, &Direction)| Dof { label: (row + 1).to_string(), node: row, direction };
        let node = |row: usize| Node { label: row.to_string(), position: [row as f64, 0.0, 0.0] };
        Structure {
            kind: StructureKind::Points,
            dofs: directions.iter().enumerate().map(dof).collect(),
            nodes: (0..directions.len()).map(node).collect(),
            lines: Vec::new(),
            matrices: None,
            elements: Vec::new(),
            lumped: Vec::new(),
            origin: Origin::default(),
        }
    }

    fn dofs(family: Family, structure: &Structure) -> Vec<Vec<usize>> {
        let sources = family.candidates(Effect::Coulomb, structure);
        let rows = |source: Source| match source.place {
            Place::Dofs(dofs) => dofs,
            Place::Whole(_) | Place::Channel(_) => Vec::new(),
        };
        sources.into_iter().map(rows).collect()
    }

    #[test]
    fn a_beam_has_candidates_at_its_translations() {
        let beam = structure(&[Direction::Y, Direction::Rz, Direction::Y, Direction::Rz, Direction::Y, Direction::Rz]);
        assert_eq!(dofs(Family::EachTranslation, &beam), [[0], [2], [4]]);
        assert_eq!(dofs(Family::EachDof, &beam).len(), 6);
        assert_eq!(dofs(Family::EachPair, &beam), [[0, 2], [2, 4]]);
        assert_eq!(dofs(Family::Chain, &beam), [[0, 2, 4]]);
    }

    #[test]
    fn pairs_are_of_one_direction() {
        let frame = structure(&[Direction::X, Direction::Y, Direction::X, Direction::Y]);
        assert_eq!(dofs(Family::EachTranslation, &frame), [[0], [1], [2], [3]]);
        assert_eq!(dofs(Family::EachPair, &frame), [[0, 2], [1, 3]]);
        assert_eq!(dofs(Family::Chain, &frame), [[0, 2], [1, 3]]);
        assert!(dofs(Family::Chain, &structure(&[Direction::X])).is_empty());
    }

    #[test]
    fn whole_structure_laws_have_one_place_and_channel_errors_none() {
        let chain = structure(&[Direction::X; 3]);
        let whole = Family::EachPair.candidates(Effect::LossFactor, &chain);
        assert_eq!(whole, [Source::candidate(Effect::LossFactor, Place::Whole(None))]);
        assert!(Family::EachPair.candidates(Effect::Delay, &chain).is_empty());
    }

    #[test]
    fn names_are_those_of_serde() {
        for family in Family::ALL {
            assert_eq!(serde_json::to_string(&family).ok(), Some(format!("\"{}\"", family.name())));
            assert_eq!(Family::from_name(family.name()), Some(family));
        }
    }
}

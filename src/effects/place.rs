//! Where an effect acts.

use crate::structure::Structure;
use serde::{Deserialize, Serialize};

/// One relative displacement `d = x_first - x_second`, or `d = x_first` to the ground. Indices are zero-based DOF rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Leg {
    /// DOF that feels `-F`.
    pub first: usize,
    /// DOF that feels `+F`; `None` is the ground.
    pub second: Option<usize>,
}

impl Leg {
    /// The relative displacement `L^T x` for any number type.
    pub fn relative<T: Copy + std::ops::Sub<Output = T>>(self, x: impl Fn(usize) -> T) -> T {
        match self.second {
            Some(second) => x(self.first) - x(second),
            None => x(self.first),
        }
    }
}

/// Where an effect acts: on DOFs, over the whole structure, or on a channel.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Place {
    /// One DOF: to the ground. Two: between them. More: a chain, each to the next with the same law and parameters.
    Dofs(Vec<usize>),
    /// The whole structure, or a range of its beam elements (zero-based, last included).
    Whole(Option<[usize; 2]>),
    /// A channel by its name, such as `acc@7`.
    Channel(String),
}

/// A place in the terms of project files.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct WrittenPlace {
    /// Labels of the DOFs; none for the whole structure and channels.
    pub dofs: Vec<String>,
    /// First and last beam element, counted from 1.
    pub elements: Option<[i64; 2]>,
    /// The name of a channel.
    pub channel: Option<String>,
}

impl Place {
    /// As project files and JSON write it: labels of DOFs, a range of elements, or a channel.
    pub fn written(&self, structure: &Structure) -> WrittenPlace {
        match self {
            Self::Dofs(dofs) => {
                let dofs = dofs.iter().map(|&dof| structure.label(dof).to_owned()).collect();
                WrittenPlace { dofs, ..WrittenPlace::default() }
            }
            Self::Whole(range) => {
                let elements = range.map(|range| range.map(|element| element as i64 + 1));
                WrittenPlace { elements, ..WrittenPlace::default() }
            }
            Self::Channel(channel) => WrittenPlace { channel: Some(channel.clone()), ..WrittenPlace::default() },
        }
    }

    /// As one word in exported results: labels joined by hyphens, such as `13-17`; `structure` for the whole, the name of a channel.
    pub fn exported(&self, structure: &Structure) -> String {
        match self.written(structure) {
            WrittenPlace { channel: Some(channel), .. } => channel,
            WrittenPlace { elements: Some([first, last]), .. } => format!("elements {first}-{last}"),
            _ if matches!(self, Self::Whole(_)) => "structure".to_owned(),
            WrittenPlace { dofs, .. } => dofs.join("-"),
        }
    }

    /// Whether both are the same place: `[1, 2]` is `[2, 1]`, and a chain may be read from either end.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Dofs(a), Self::Dofs(b)) => a == b || a.iter().eq(b.iter().rev()),
            _ => self == other,
        }
    }

    /// The range of elements that a law of the whole structure is restricted to (zero-based, last included); none of any other place.
    pub fn elements(&self) -> Option<[usize; 2]> {
        if let Self::Whole(range) = self { *range } else { None }
    }

    /// The relative displacements on which a law at this place acts; none for the whole structure and channels.
    pub fn legs(&self) -> Vec<Leg> {
        match self {
            Self::Dofs(dofs) if dofs.len() == 1 => vec![Leg { first: dofs[0], second: None }],
            Self::Dofs(dofs) => dofs.windows(2).map(|d| Leg { first: d[0], second: Some(d[1]) }).collect(),
            Self::Whole(_) | Self::Channel(_) => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_the_same_from_either_end() {
        let place = |dofs: &[usize]| Place::Dofs(dofs.to_vec());
        assert!(place(&[1, 2]).is_same(&place(&[2, 1])));
        assert!(place(&[1, 2, 3]).is_same(&place(&[3, 2, 1])));
        assert!(!place(&[1, 2, 3]).is_same(&place(&[2, 1, 3])));
        assert!(!place(&[1]).is_same(&place(&[1, 2])));
        assert!(Place::Whole(None).is_same(&Place::Whole(None)));
        assert!(!Place::Whole(None).is_same(&Place::Whole(Some([0, 1]))));
    }

    #[test]
    fn a_chain_has_a_leg_from_each_to_the_next() {
        let legs = Place::Dofs(vec![4, 2, 7]).legs();
        assert_eq!(legs, [Leg { first: 4, second: Some(2) }, Leg { first: 2, second: Some(7) }]);
        assert_eq!(Place::Dofs(vec![4]).legs(), [Leg { first: 4, second: None }]);
        assert!(Place::Dofs(Vec::new()).legs().is_empty());
        assert_eq!(legs[0].relative(|dof| dof as f64), 2.0);
    }
}

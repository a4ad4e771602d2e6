//! Where an effect acts.

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

impl Place {
    /// The relative displacements on which a law at this place acts; none for the whole structure and channels.
    pub fn legs(&self) -> Vec<Leg> {
        match self {
            Self::Dofs(dofs) if dofs.len() == 1 => vec![Leg { first: dofs[0], second: None }],
            Self::Dofs(dofs) => dofs.windows(2).map(|d| Leg { first: d[0], second: Some(d[1]) }).collect(),
            Self::Whole(_) | Self::Channel(_) => Vec::new(),
        }
    }
}

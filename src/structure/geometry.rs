//! Degrees of freedom and the points where they are.

use serde::{Deserialize, Serialize};

/// Direction of a degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Direction {
    X,
    Y,
    Z,
    Rx,
    Ry,
    Rz,
    /// A generalised coordinate, such as the amplitude of a fixed-interface mode: no direction in space.
    Q,
}

impl Direction {
    /// Whether it is a rotation (rad) or a generalised coordinate rather than a translation (m).
    pub fn is_rotation(self) -> bool {
        matches!(self, Self::Rx | Self::Ry | Self::Rz | Self::Q)
    }
}

impl Direction {
    /// Direction in space of a word such as `z` or `ry`.
    pub(super) fn from_word(word: &str) -> Option<Self> {
        const SPACE: [(&str, Direction); 6] = [
            ("x", Direction::X),
            ("y", Direction::Y),
            ("z", Direction::Z),
            ("rx", Direction::Rx),
            ("ry", Direction::Ry),
            ("rz", Direction::Rz),
        ];
        SPACE.iter().find(|(known, _)| word.eq_ignore_ascii_case(known)).map(|(_, direction)| *direction)
    }

    /// 0, 1 or 2 for a translation along x, y or z.
    pub fn axis(self) -> Option<usize> {
        [Self::X, Self::Y, Self::Z].into_iter().position(|direction| direction == self)
    }
}

/// One degree of freedom: a row of the system matrices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dof {
    /// Name in files, such as `19`.
    pub label: String,
    /// Index into [`crate::structure::Structure::nodes`].
    pub node: usize,
    /// Direction of positive displacement.
    pub direction: Direction,
}

/// A point of the structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Name in files.
    pub label: String,
    /// Position, m.
    pub position: [f64; 3],
}

//! Degrees of freedom: a node and a direction.

use std::fmt;

/// A degree of freedom of a function.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Dof {
    /// Name of the entity (component, channel); empty where the file says `NONE`.
    pub entity: String,
    /// Node.
    pub node: i64,
    /// Direction: 0 scalar; 1, 2, 3 translation along X, Y, Z; 4, 5, 6 rotation about them; negative ones reversed.
    pub direction: i64,
}

impl Dof {
    /// The DOF of a node, without an entity.
    pub fn new(node: i64, direction: i64) -> Self {
        Self { entity: String::new(), node, direction }
    }

    /// `+X` to `-RZ`, `S` for a scalar; `None` for a number that means nothing.
    pub fn direction_name(&self) -> Option<&'static str> {
        const NAMES: [&str; 13] = ["-RZ", "-RY", "-RX", "-Z", "-Y", "-X", "S", "+X", "+Y", "+Z", "+RX", "+RY", "+RZ"];
        usize::try_from(self.direction.checked_add(6)?).ok().and_then(|i| NAMES.get(i).copied())
    }
}

impl fmt::Display for Dof {
    /// `12:+Z`, after the entity where there is one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.entity.is_empty() {
            write!(f, "{} ", self.entity)?;
        }
        match self.direction_name() {
            Some(name) => write!(f, "{}:{name}", self.node),
            None => write!(f, "{}:{}", self.node, self.direction),
        }
    }
}

//! The symbol of a law in the schematic as data: marks in a frame of its own, `x` along the body from -1/2 to 1/2, `y`
//! across it in points. Whoever draws knows lines and areas, not laws.

/// How dark an area is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// In the colour of the lines.
    Full,
    /// In a light shade of it.
    Faint,
}

/// A piece of a symbol.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// Through these points.
    Line(&'static [(f32, f32)]),
    /// A convex area with its outline.
    Area(&'static [(f32, f32)], Tone),
    /// Cup and piston between two `x`.
    Dashpot(f32, f32),
    /// A rod that slides between two pressed pads, between two `x`.
    Pads(f32, f32, Tone),
    /// A zigzag of `coils` between two `x`, `height` to each side of `y`.
    Spring {
        /// Both ends.
        ends: (f32, f32),
        /// Number of coils.
        coils: u8,
        /// Middle line.
        y: f32,
        /// Half its height.
        height: f32,
    },
    /// An ellipse around the middle: half its extent along and across.
    Ring(f32, f32),
    /// A letter above the middle.
    Letter(&'static str),
    /// A slanted arrow across the body: the sign for a variable element.
    Arrow,
}

impl Mark {
    /// A spring of `coils` between two `x`.
    pub const fn spring(from: f32, to: f32, coils: u8) -> Self {
        Self::Spring { ends: (from, to), coils, y: 0.0, height: 6.0 }
    }
}

/// Half the width of a dashpot, points.
pub(crate) const HALF_WIDTH: f32 = 7.0;
/// A dashpot over the whole body.
pub(crate) const DASHPOT: &[Mark] = &[Mark::Dashpot(-0.5, 0.5)];
/// A spring over the whole body.
pub(crate) const SPRING: &[Mark] = &[Mark::spring(-0.5, 0.5, 5)];

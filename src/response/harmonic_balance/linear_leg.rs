//! Linear sources between single DOFs, one at each leg, and the loads of their forces.

use crate::effects::{Leg, Source};
use faer::c64;

/// A linear source at one leg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearLeg {
    /// Index of the source in the list given.
    pub source: usize,
    pub leg: Leg,
}

/// Adds the load `-force L` of a leg.
pub(crate) fn push_leg(loads: &mut Vec<(usize, c64)>, leg: Leg, force: c64) {
    loads.push((leg.first, -force));
    if let Some(second) = leg.second {
        loads.push((second, force));
    }
}

/// Dynamic stiffness of a linear source between DOFs, N/m.
pub(crate) fn stiffness_of(source: &Source, omega: f64) -> c64 {
    let law = source.effect.law();
    law.and_then(|law| law.dynamic_stiffness(&source.parameters, omega)).unwrap_or(c64::new(0.0, 0.0))
}

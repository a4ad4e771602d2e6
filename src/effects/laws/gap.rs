//! Gap: `F = stiffness (|d| - gap) sgn(d)` beyond the gap, 0 within. It takes out no energy.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::law::{Point, Variable};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::range::geometric;
use crate::effects::symbol::{HALF_WIDTH, Mark};

/// Clearance on both sides, then a spring.
#[derive(Debug)]
pub(crate) struct Gap;

const DESCRIPTION: Description = Description {
    folds: true,
    dissipates: false,
    shapes: |range| {
        let gaps = geometric(0.1 * range.displacement, 0.95 * range.displacement, 10);
        gaps.into_iter().map(|gap| vec![1.0, gap]).collect()
    },
    limits: &[Limit { law: Effect::Stiffness, holds: |p, at| p[1] < CLOSE * at.least, parameters: |p| vec![p[0]] }],
    symbol: &[
        Mark::spring(-0.5, 0.1, 3),
        Mark::Line(&[(0.12, -HALF_WIDTH), (0.12, HALF_WIDTH)]),
        Mark::Line(&[(0.36, -HALF_WIDTH), (0.36, HALF_WIDTH)]),
        Mark::Line(&[(0.36, 0.0), (0.5, 0.0)]),
    ],
    example: &[1000.0, 0.005],
    ..Description::new(
        "gap",
        "k_g (|d| - g)",
        "A clearance: nothing up to a displacement, a spring beyond it.",
        &[Parameter::coefficient("stiffness", "N/m", "k_g"), Parameter::shape("gap", "m", "g", 1e-4)],
    )
};

impl MemorylessLaw for Gap {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Displacement
    }

    fn at(&self, p: &[f64], d: f64, _v: f64) -> Point {
        let beyond = d.abs() - p[1];
        if beyond <= 0.0 {
            return Point::default();
        }
        Point { force: p[0] * beyond.copysign(d), by_displacement: p[0], by_velocity: 0.0 }
    }

    fn by_parameter(&self, p: &[f64], k: usize, d: f64, _v: f64) -> f64 {
        let beyond = d.abs() - p[1];
        if beyond <= 0.0 {
            return 0.0;
        }
        if k == 0 { beyond.copysign(d) } else { -p[0] * d.signum() }
    }
}

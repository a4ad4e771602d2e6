//! Iwan joint with Segalman's four-parameter distribution of sliders.
//!
//! Sliders of equal stiffness yield at the extension `phi`, with the density `rho = R phi^chi + S delta(phi - phi_max)` up
//! to `phi_max`. The file's parameters are the stiffness without slip `K_T` and the force `F_S` of full slip:
//!
//! ```text
//! K_T = integral rho dphi      = R phi_max^(chi+1) / (chi+1) + S
//! F_S = integral phi rho dphi  = R phi_max^(chi+2) / (chi+2) + S phi_max
//! beta = S (chi+1) / (R phi_max^(chi+1)),    phi_max = F_S (1+beta) / (K_T (beta + (chi+1)/(chi+2)))
//! ```
//!
//! From rest, with `u = |d| / phi_max < 1`: `F = K_T phi_max (u - u^(chi+2) / ((1+beta)(chi+2)))`, beyond it `F_S`. The
//! continuous distribution is integrated exactly; there is no count of sliders. Energy per cycle of `d = X cos(omega t)`:
//! `4 R X^(chi+3) / ((chi+2)(chi+3))` in partial slip; beyond, `4 (F_S X - integral phi^2 rho dphi)`.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::masing::MasingLaw;
use crate::effects::parameter::{Ends, Parameter};
use crate::effects::range::{Range, geometric};
use crate::effects::symbol::{Mark, Tone};

/// Parallel elastic sliders with power-law distributed yield forces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iwan;

const fn spring(y: f32) -> Mark {
    Mark::Spring { ends: (-0.5, 0.05), coils: 3, y, height: 2.5 }
}

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes,
    limits: &[
        // No slider slips by a share worth mentioning; all do at once; all slip together.
        Limit { law: Effect::Stiffness, holds: sticks, parameters: |p| vec![p[0]] },
        Limit { law: Effect::Coulomb, holds: slides, parameters: |p| vec![p[1]] },
        Limit { law: Effect::ElasticSlider, holds: |p, _| CLOSE * p[3] > 1.0, parameters: |p| vec![p[0], p[1]] },
    ],
    symbol: &[
        Mark::Line(&[(-0.5, -5.0), (-0.5, 5.0)]),
        Mark::Line(&[(0.5, -5.0), (0.5, 5.0)]),
        spring(-5.0),
        Mark::Line(&[(0.05, -5.0), (0.5, -5.0)]),
        Mark::Area(&[(0.15, -7.5), (0.4, -7.5), (0.4, -2.5), (0.15, -2.5)], Tone::Faint),
        spring(5.0),
        Mark::Line(&[(0.05, 5.0), (0.5, 5.0)]),
        Mark::Area(&[(0.15, 2.5), (0.4, 2.5), (0.4, 7.5), (0.15, 7.5)], Tone::Faint),
    ],
    example: &[400.0, 1.0, -0.5, 1.0],
    ..Description::new(
        "Iwan joint",
        "K_T + sliders F_S",
        "A bolted joint: slip that starts small and spreads over the contact until all of it slides.",
        &[
            Parameter::shape("stiffness", "N/m", "K_T", 1e4),
            Parameter::shape("force", "N", "F_S", 1.0),
            Parameter::shape("chi", "", "chi", -0.5).within(-1.0, 0.0, Ends::OpenBelow),
            Parameter::shape("beta", "", "beta", 1.0),
        ],
    )
};

fn shapes(range: &Range) -> Vec<Vec<f64>> {
    geometric(0.1 * range.least.max(0.05 * range.displacement), 3.0 * range.displacement, 6)
        .into_iter()
        .flat_map(|x| [-0.7, -0.4, -0.1].into_iter().flat_map(move |chi| [0.3, 1.5].map(|b| vec![1.0, x, chi, b])))
        .collect()
}

fn sticks(p: &[f64], range: &Range) -> bool {
    let joint = Joint::new(p);
    let u = joint.relative(range.displacement);
    u < 1.0 && joint.slipped(u) / (u * (1.0 + joint.beta)) < CLOSE
}

fn slides(p: &[f64], range: &Range) -> bool {
    Joint::new(p).relative(range.least) * CLOSE > 1.0
}

/// The joint in the variables of its backbone.
struct Joint {
    stiffness: f64,
    force: f64,
    chi: f64,
    beta: f64,
    /// `beta + (chi+1)/(chi+2)`.
    sum: f64,
    /// `K_T phi_max`, N.
    scale: f64,
}

impl Joint {
    fn new(p: &[f64]) -> Self {
        let [stiffness, force, chi, beta] = [p[0], p[1], p[2], p[3]];
        let sum = beta + (chi + 1.0) / (chi + 2.0);
        Self { stiffness, force, chi, beta, sum, scale: force * (1.0 + beta) / sum }
    }

    /// `|d| / phi_max`, at least 1 in full slip.
    fn relative(&self, d: f64) -> f64 {
        if self.scale > 0.0 { self.stiffness * d.abs() / self.scale } else { f64::INFINITY }
    }

    /// `u^(chi+2) / (chi+2)`.
    fn slipped(&self, u: f64) -> f64 {
        u.powf(self.chi + 2.0) / (self.chi + 2.0)
    }

    /// Force over `K_T phi_max` and its derivative by `u`, for `u < 1`.
    fn shape(&self, u: f64) -> (f64, f64) {
        let slope = 1.0 - u.powf(self.chi + 1.0) / (1.0 + self.beta);
        (u - self.slipped(u) / (1.0 + self.beta), slope)
    }

    fn backbone(&self, d: f64) -> f64 {
        let u = self.relative(d);
        if u >= 1.0 { self.force.copysign(d) } else { (self.scale * self.shape(u).0).copysign(d) }
    }

    fn slope(&self, d: f64) -> f64 {
        let u = self.relative(d);
        if u >= 1.0 { 0.0 } else { self.stiffness * self.shape(u).1 }
    }

    fn by_parameter(&self, k: usize, d: f64) -> f64 {
        let u = self.relative(d);
        if u >= 1.0 {
            return if k == 1 { d.signum() } else { 0.0 };
        }
        if u == 0.0 {
            return if k == 0 { d } else { 0.0 };
        }
        let (shape, slope) = self.shape(u);
        let rest = shape - u * slope;
        let size = match k {
            0 => d.abs() * slope,
            1 => self.scale / self.force * rest,
            2 => {
                let by_chi = (self.chi + 2.0).powi(-2) / self.sum;
                let explicit = self.slipped(u) * (1.0 / (self.chi + 2.0) - u.ln()) / (1.0 + self.beta);
                self.scale * (explicit - by_chi * rest)
            }
            _ => {
                let by_beta = 1.0 / (1.0 + self.beta) - 1.0 / self.sum;
                self.scale * (by_beta * rest + self.slipped(u) * (1.0 + self.beta).powi(-2))
            }
        };
        size * d.signum()
    }

    /// Energy per cycle at amplitude `x`, J.
    fn energy(&self, x: f64) -> f64 {
        if self.scale <= 0.0 || self.stiffness <= 0.0 {
            return 0.0;
        }
        let u = self.relative(x);
        let length = self.scale / self.stiffness;
        let power = (self.chi + 1.0) / ((1.0 + self.beta) * (self.chi + 3.0));
        if u < 1.0 {
            return 4.0 * self.scale * length * power / (self.chi + 2.0) * u.powf(self.chi + 3.0);
        }
        4.0 * (self.force * x - self.scale * length * (power + self.beta / (1.0 + self.beta)))
    }
}

impl MasingLaw for Iwan {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn backbone(&self, p: &[f64], d: f64) -> f64 {
        Joint::new(p).backbone(d)
    }

    fn slope(&self, p: &[f64], d: f64) -> f64 {
        Joint::new(p).slope(d)
    }

    fn by_parameter(&self, p: &[f64], k: usize, d: f64) -> f64 {
        Joint::new(p).by_parameter(k, d)
    }

    fn loop_energy(&self, p: &[f64], amplitude: f64) -> f64 {
        Joint::new(p).energy(amplitude)
    }
}

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

use crate::effects::law::Ends;
use crate::effects::masing::march;
use crate::effects::memory::MasingMemory;
use crate::effects::turning::loop_ranges;
use crate::effects::{Law, Memory, Motion, Parameter};

/// Parallel elastic sliders with power-law distributed yield forces.
#[derive(Debug)]
pub struct Iwan;

const PARAMETERS: [Parameter; 4] = [
    Parameter::shape("stiffness", "N/m", "K_T", 1e4),
    Parameter::shape("force", "N", "F_S", 1.0),
    Parameter::shape("chi", "", "chi", -0.5).within(-1.0, 0.0, Ends::OpenBelow),
    Parameter::shape("beta", "", "beta", 1.0),
];

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

impl Law for Iwan {
    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        let (joint, d) = (Joint::new(p), &motion.displacement);
        march(d, force, |n| joint.backbone(d[n]), |r, n| 2.0 * joint.backbone(0.5 * (d[n] - d[r])));
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        let (joint, d, e) = (Joint::new(p), &motion.displacement, &direction.displacement);
        march(d, tangent, |n| joint.slope(d[n]) * e[n], |r, n| joint.slope(0.5 * (d[n] - d[r])) * (e[n] - e[r]));
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        let (joint, d) = (Joint::new(p), &motion.displacement);
        march(d, tangent, |n| joint.by_parameter(k, d[n]), |r, n| 2.0 * joint.by_parameter(k, 0.5 * (d[n] - d[r])));
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let joint = Joint::new(p);
        Some(Box::new(MasingMemory::new(move |d| [joint.backbone(d), joint.slope(d)])))
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(Joint::new(p).energy(amplitude))
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        let joint = Joint::new(p);
        loop_ranges(motion).into_iter().map(|range| joint.energy(0.5 * range)).sum()
    }
}

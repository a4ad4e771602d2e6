//! One exact step of the linear part: forces of elements constant, measured forces linear within it.
//!
//! ```text
//! z(h) = e^(lambda h) z_0 + h phi_1 (beta f + beta_u u_0) + h phi_2 beta_u (u_1 - u_0)
//! S(h) = e^(lambda h) S_0 + A_theta-driven part,   from z(t) = e^(lambda t) (z_0 - z_p) + z_p + z_q t
//! ```
//!
//! with `z_q = -g_1 / lambda`, `z_p = (z_q - g_0) / lambda` for the modal force `g_0 + g_1 t`.

use super::exponentials::{divided, phi1, phi2};
use super::system::{LinearChange, LinearSystem};
use faer::c64;

/// Forces within one step: constant ones of elements, N, and the drives at both ends.
pub(super) struct StepForces<'a> {
    /// Force that each element puts on the structure along its pattern, N.
    pub elements: &'a [f64],
    /// Measured forces at the start, N.
    pub start: &'a [f64],
    /// At the end.
    pub end: &'a [f64],
}

/// Factors of one length of step.
#[derive(Debug, Clone)]
pub(super) struct Step {
    /// Length, s.
    pub length: f64,
    decay: Vec<c64>,
    /// `h phi_1`.
    constant: Vec<c64>,
    /// `h phi_2`: of a force that rises to 1.
    rising: Vec<c64>,
    /// `(e^(lambda_k h) - e^(lambda_j h)) / (lambda_k - lambda_j)`, row by row; and with the conjugate of `lambda_j`.
    between: Vec<[c64; 2]>,
}

impl Step {
    /// Of `length` s; `linear` where derivatives by parameters of the linear part are wanted.
    pub fn new(system: &LinearSystem, length: f64, linear: bool) -> Self {
        let of = |f: &dyn Fn(c64) -> c64| system.lambda.iter().map(|&l| f(l * length)).collect::<Vec<c64>>();
        let between = if linear {
            let pair = |a: c64, b: c64| [b, b.conj()].map(|b| length * divided(a * length, b * length));
            system.lambda.iter().flat_map(|&a| system.lambda.iter().map(move |&b| pair(a, b))).collect()
        } else {
            Vec::new()
        };
        Self {
            length,
            decay: of(&|x| x.exp()),
            constant: of(&|x| length * phi1(x)),
            rising: of(&|x| length * phi2(x)),
            between,
        }
    }

    /// `z <- e^(lambda h) z`.
    pub fn decay(&self, z: &mut [c64]) {
        z.iter_mut().zip(&self.decay).for_each(|(z, e)| *z *= e);
    }

    /// Adds what a constant unit force times `force` does along `beta`.
    pub fn push(&self, beta: &[c64], force: f64, z: &mut [c64]) {
        if force != 0.0 {
            for ((z, b), c) in z.iter_mut().zip(beta).zip(&self.constant) {
                *z += c * b * force;
            }
        }
    }

    /// Adds what a drive does that goes from `start` to `end`.
    pub fn drive(&self, beta: &[c64], start: f64, end: f64, z: &mut [c64]) {
        let rise = end - start;
        for (((z, b), c), r) in z.iter_mut().zip(beta).zip(&self.constant).zip(&self.rising) {
            *z += b * (c * start + r * rise);
        }
    }

    /// What a constant unit force along `beta` has done at the end, along a functional.
    pub fn receptance(&self, beta: &[c64], functional: &[c64]) -> f64 {
        functional.iter().zip(beta).zip(&self.constant).map(|((c, b), p)| (c * b * p).re).sum()
    }

    /// Adds to the derivative `s` what the change of the linear part does while the state moves on from `z0` under `forces`.
    pub fn change(&self, system: &LinearSystem, change: &LinearChange, z0: &[c64], forces: &StepForces, s: &mut [c64]) {
        let count = z0.len();
        let mut free = Vec::with_capacity(count);
        let mut held = Vec::with_capacity(count);
        for k in 0..count {
            let [g0, rise] = modal_force(&system.beta, k, forces);
            let lambda = system.lambda[k];
            let q = -rise / (self.length * lambda);
            let p = (q - g0) / lambda;
            free.push(z0[k] - p);
            held.push((p, q * self.length));
        }
        for k in 0..count {
            let mut sum = c64::new(0.0, 0.0);
            for j in 0..count {
                let at = k * count + j;
                let (p, q, [direct, conjugate]) = (change.direct[at], change.conjugate[at], self.between[at]);
                let (still, moving) = held[j];
                sum += p * (direct * free[j] + self.constant[k] * still + self.rising[k] * moving);
                sum +=
                    q * (conjugate * free[j].conj() + self.constant[k] * still.conj() + self.rising[k] * moving.conj());
            }
            let [g0, rise] = modal_force(&change.inputs, k, forces);
            s[k] += sum + self.constant[k] * g0 + self.rising[k] * rise;
        }
    }
}

/// Modal force at the start and its rise over the step, of damped mode `k`.
fn modal_force(beta: &[Vec<c64>], k: usize, forces: &StepForces) -> [c64; 2] {
    let count = forces.elements.len();
    let mut g0: c64 = forces.elements.iter().enumerate().map(|(i, f)| beta[i][k] * *f).sum();
    let mut rise = c64::new(0.0, 0.0);
    for (i, (start, end)) in forces.start.iter().zip(forces.end).enumerate() {
        g0 += beta[count + i][k] * *start;
        rise += beta[count + i][k] * (end - start);
    }
    [g0, rise]
}

//! What changes of the linear part add to the derivatives of the state over a step.
//!
//! ```text
//! S(h) = e^(lambda h) S_0 + int_0^h e^(lambda (h - t)) g dt,    g = A_theta z + B_theta f
//! ```
//!
//! Over a step of full length exactly, `z(t) = e^(lambda t) (z_0 - z_p) + z_p + z_q t` with `z_q = -g_1 / lambda`,
//! `z_p = (z_q - g_0) / lambda` for the modal force `g_0 + g_1 t`: linear in the state and the forces at its ends, so that one
//! real matrix made beforehand gives it for all parameters at once. Over a piece of a step, next to a reversal of friction, with `g`
//! taken as linear between the ends of the piece.

use super::exponentials::divided;
use super::step::Step;
use super::system::{LinearChange, LinearSystem};
use dashpot_numerics::add_product;
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

/// Changes of the linear part by several parameters.
pub(super) struct Changes {
    /// What a full step adds, over the state, the forces of elements, the drives at its start and their rises, column by column.
    full: Vec<f64>,
    /// `g` over the state and the forces.
    rates: Vec<f64>,
    /// What the last step added, one flat state a parameter.
    pub added: Vec<f64>,
    width: usize,
    inputs: Vec<f64>,
    ends: [Vec<f64>; 2],
}

impl Changes {
    /// Of the full `step`, with `elements` forces of elements and `drives` drives.
    pub(super) fn new(
        system: &LinearSystem,
        step: &Step,
        list: &[LinearChange],
        [elements, drives]: [usize; 2],
    ) -> Self {
        let count = system.lambda.len();
        let between: Vec<[c64; 2]> = if list.is_empty() {
            Vec::new()
        } else {
            let h = step.length;
            let pair = |a: c64, b: c64| [b, b.conj()].map(|b| h * divided(a * h, b * h));
            system.lambda.iter().flat_map(|&a| system.lambda.iter().map(move |&b| pair(a, b))).collect()
        };
        let exact = Exact { system, step, between: &between };
        let (mut full, mut rates) = (Vec::new(), Vec::new());
        for column in 0..2 * count {
            let (j, z) = (column % count, if column < count { c64::new(1.0, 0.0) } else { c64::new(0.0, 1.0) });
            for change in list {
                let index = |k: usize| k * count + j;
                let parts = |k: usize| [change.direct[index(k)] * z, change.conjugate[index(k)] * z.conj()];
                let rate = |k: usize| parts(k)[0] + parts(k)[1];
                let sum = |k: usize| parts(k)[0] * between[index(k)][0] + parts(k)[1] * between[index(k)][1];
                flatten(&(0..count).map(rate).collect::<Vec<c64>>(), &mut rates);
                flatten(&(0..count).map(sum).collect::<Vec<c64>>(), &mut full);
            }
        }
        for column in 0..elements + 2 * drives {
            let mut unit = vec![0.0; elements + 2 * drives];
            unit[column] = 1.0;
            let (forces, rest) = unit.split_at(elements);
            let (start, rise) = rest.split_at(drives);
            for change in list {
                flatten(&exact.of_forces(change, [forces, start, rise]), &mut full);
                if column < elements + drives {
                    let now = |k: usize| modal_force(&change.inputs, k, [forces, start, rise])[0];
                    flatten(&(0..count).map(now).collect::<Vec<c64>>(), &mut rates);
                }
            }
        }
        let width = 2 * count;
        Self { full, rates, added: vec![0.0; width * list.len()], width, inputs: Vec::new(), ends: Default::default() }
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.added.is_empty()
    }

    /// What a full step from the state `z` adds, into [`Self::added`].
    pub(super) fn over_full_step(&mut self, z: &[f64], forces: &StepForces) {
        self.inputs.clear();
        self.inputs.extend_from_slice(z);
        self.inputs.extend_from_slice(forces.elements);
        self.inputs.extend_from_slice(forces.start);
        self.inputs.extend(forces.start.iter().zip(forces.end).map(|(a, b)| b - a));
        self.added.fill(0.0);
        add_product(&self.full, &self.inputs, &mut self.added);
    }

    /// What a piece of a step between two states adds, into [`Self::added`].
    pub(super) fn over_piece(&mut self, step: &Step, states: [&[f64]; 2], forces: &StepForces) {
        for ((z, u), g) in states.into_iter().zip([forces.start, forces.end]).zip(&mut self.ends) {
            self.inputs.clear();
            self.inputs.extend_from_slice(z);
            self.inputs.extend_from_slice(forces.elements);
            self.inputs.extend_from_slice(u);
            g.clear();
            g.resize(self.added.len(), 0.0);
            add_product(&self.rates, &self.inputs, g);
        }
        let half = self.width / 2;
        for (c, added) in self.added.chunks_exact_mut(self.width).enumerate() {
            for k in 0..half {
                let state_at = |end: usize| {
                    c64::new(self.ends[end][c * self.width + k], self.ends[end][c * self.width + half + k])
                };
                let [start, end] = [state_at(0), state_at(1)];
                let sum = step.constant[k] * start + step.rising[k] * (end - start);
                (added[k], added[half + k]) = (sum.re, sum.im);
            }
        }
    }
}

/// The exact sum over a full step of what forces do; that of the state is its first term.
struct Exact<'a> {
    system: &'a LinearSystem,
    step: &'a Step,
    /// `(e^(lambda_k h) - e^(lambda_j h)) / (lambda_k - lambda_j)`, row by row; and with the conjugate of `lambda_j`.
    between: &'a [[c64; 2]],
}

impl Exact<'_> {
    fn of_forces(&self, change: &LinearChange, [elements, start, rise]: [&[f64]; 3]) -> Vec<c64> {
        let count = self.system.lambda.len();
        let (mut free, mut held) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for k in 0..count {
            let [g0, rise] = modal_force(&self.system.beta, k, [elements, start, rise]);
            let lambda = self.system.lambda[k];
            let q = -rise / (self.step.length * lambda);
            let p = (q - g0) / lambda;
            free.push(-p);
            held.push((p, q * self.step.length));
        }
        let (constant, rising) = (&self.step.constant, &self.step.rising);
        let sum = |k: usize| {
            let [g0, rise] = modal_force(&change.inputs, k, [elements, start, rise]);
            let mut sum = constant[k] * g0 + rising[k] * rise;
            for j in 0..count {
                let at = k * count + j;
                let (p, q, [direct, conjugate]) = (change.direct[at], change.conjugate[at], self.between[at]);
                let (still, moving) = held[j];
                sum += p * (direct * free[j] + constant[k] * still + rising[k] * moving);
                sum += q * (conjugate * free[j].conj() + constant[k] * still.conj() + rising[k] * moving.conj());
            }
            sum
        };
        (0..count).map(sum).collect()
    }
}

/// Modal force at the start and its rise over the step, of damped mode `k`.
fn modal_force(beta: &[Vec<c64>], k: usize, [elements, starts, rises]: [&[f64]; 3]) -> [c64; 2] {
    let count = elements.len();
    let mut g0: c64 = elements.iter().enumerate().map(|(i, f)| beta[i][k] * *f).sum();
    let mut rise = c64::new(0.0, 0.0);
    for (i, (start, rises)) in starts.iter().zip(rises).enumerate() {
        g0 += beta[count + i][k] * *start;
        rise += beta[count + i][k] * *rises;
    }
    [g0, rise]
}

fn flatten(list: &[c64], into: &mut Vec<f64>) {
    into.extend(list.iter().map(|z| z.re));
    into.extend(list.iter().map(|z| z.im));
}

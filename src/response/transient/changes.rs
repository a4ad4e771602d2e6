//! What changes of the linear part add to the derivatives of the state over a step.
//!
//! ```text
//! S(h) = e^(lambda h) S_0 + int_0^h e^(lambda (h - t)) g dt,    g = A_theta z + B_theta f
//! ```
//!
//! Over a step of full length exactly: `z` is a sum of exponentials and of what powers of time do, so that `S` is linear in the
//! state and the forces, with divided differences of the functions of `exponentials`:
//!
//! ```text
//! int_0^h e^(a (h - t)) int_0^t e^(b (t - s)) (s / T)^k ds dt = k! h^2 (h / T)^k phi_k+1[a h, b h]
//! ```
//!
//! One real matrix made beforehand gives it for all parameters at once. Over a piece of a step, next to a reversal of friction, with
//! `g` taken as linear between the ends of the piece.

use super::exponentials::{FUNCTIONS, divided};
use super::hold::{ORDERS, Polynomial, value};
use super::step::Step;
use super::system::{LinearChange, LinearSystem};
use dashpot_numerics::add_product;
use faer::c64;

/// Forces within one step.
pub(super) struct StepForces<'a> {
    /// Constant force that each element puts on the structure along its pattern, N.
    pub elements: &'a [f64],
    /// Measured forces, N.
    pub drives: &'a [Polynomial],
}

/// Changes of the linear part by several parameters.
pub(super) struct Changes {
    /// What a full step adds, over the state, the forces of elements and the coefficients of the drives, column by column.
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
        let full_step = FullStep::new(system, step, list.is_empty());
        let (mut full, mut rates) = (Vec::new(), Vec::new());
        for column in 0..2 * count {
            let (j, z) = (column % count, if column < count { c64::new(1.0, 0.0) } else { c64::new(0.0, 1.0) });
            for change in list {
                let rate = |k: usize| change.direct[k * count + j] * z + change.conjugate[k * count + j] * z.conj();
                flatten(&(0..count).map(rate).collect::<Vec<c64>>(), &mut rates);
                flatten(&full_step.of_state(change, j, z), &mut full);
            }
        }
        for input in 0..elements + drives {
            for change in list {
                flatten(&change.inputs[input], &mut rates);
            }
            for power in 0..if input < elements { 1 } else { ORDERS } {
                for change in list {
                    flatten(&full_step.of_input(change, input, power), &mut full);
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
        self.inputs.extend(forces.drives.iter().flatten());
        self.added.fill(0.0);
        add_product(&self.full, &self.inputs, &mut self.added);
    }

    /// What a piece of a step between two states adds, into [`Self::added`].
    pub(super) fn over_piece(&mut self, step: &Step, states: [&[f64]; 2], forces: &StepForces) {
        for ((z, s), g) in states.into_iter().zip([0.0, step.share()]).zip(&mut self.ends) {
            self.inputs.clear();
            self.inputs.extend_from_slice(z);
            self.inputs.extend_from_slice(forces.elements);
            self.inputs.extend(forces.drives.iter().map(|drive| value(drive, s)));
            g.clear();
            g.resize(self.added.len(), 0.0);
            add_product(&self.rates, &self.inputs, g);
        }
        let half = self.width / 2;
        let rising = step.share().recip();
        for (c, added) in self.added.chunks_exact_mut(self.width).enumerate() {
            for k in 0..half {
                let state_at = |end: usize| {
                    c64::new(self.ends[end][c * self.width + k], self.ends[end][c * self.width + half + k])
                };
                let [start, end] = [state_at(0), state_at(1)];
                let sum = step.powers[0][k] * start + step.powers[1][k] * (end - start) * rising;
                (added[k], added[half + k]) = (sum.re, sum.im);
            }
        }
    }
}

/// The exact sum over a full step.
struct FullStep<'a> {
    system: &'a LinearSystem,
    step: &'a Step,
    /// Divided differences of `lambda_k h` with `lambda_j h` and with its conjugate, row by row.
    between: Vec<[[c64; FUNCTIONS - 1]; 2]>,
}

impl<'a> FullStep<'a> {
    fn new(system: &'a LinearSystem, step: &'a Step, is_unused: bool) -> Self {
        let h = step.length;
        let pair = |a: c64, b: c64| [b, b.conj()].map(|b| divided(a * h, b * h));
        let rows = if is_unused { &[][..] } else { &system.lambda[..] };
        let between = rows.iter().flat_map(|&a| system.lambda.iter().map(move |&b| pair(a, b))).collect();
        Self { system, step, between }
    }

    /// What the state `z` of damped mode `j` does.
    fn of_state(&self, change: &LinearChange, j: usize, z: c64) -> Vec<c64> {
        let count = self.system.lambda.len();
        let sum = |k: usize| {
            let at = k * count + j;
            let [direct, conjugate] = self.between[at].map(|phi| phi[0] * self.step.length);
            change.direct[at] * z * direct + change.conjugate[at] * z.conj() * conjugate
        };
        (0..count).map(sum).collect()
    }

    /// What a unit force at an input does that grows with a power of time.
    fn of_input(&self, change: &LinearChange, input: usize, power: usize) -> Vec<c64> {
        let count = self.system.lambda.len();
        let beta = &self.system.beta[input];
        let share = self.step.share();
        let factor = (1..=power).fold(self.step.length.powi(2), |product, k| product * k as f64 * share);
        let sum = |k: usize| {
            let through = |j: usize| {
                let at = k * count + j;
                let [direct, conjugate] = self.between[at].map(|phi| phi[power + 1]);
                change.direct[at] * beta[j] * direct + change.conjugate[at] * beta[j].conj() * conjugate
            };
            change.inputs[input][k] * self.step.powers[power][k] + (0..count).map(through).sum::<c64>() * factor
        };
        (0..count).map(sum).collect()
    }
}

fn flatten(list: &[c64], into: &mut Vec<f64>) {
    into.extend(list.iter().map(|z| z.re));
    into.extend(list.iter().map(|z| z.im));
}

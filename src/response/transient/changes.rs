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
//! One real table made beforehand gives it for all parameters at once. Over a piece of a step, next to a reversal of friction, with
//! `g` taken as linear between the ends of the piece.

use super::exponentials::{FUNCTIONS, divided};
use super::hold::{ORDERS, Polynomial, value};
use super::step::Step;
use super::system::{LinearChange, LinearSystem};
use dashpot_numerics::{add_product_to_rows, stride};
use faer::c64;

/// Forces within one step.
pub(super) struct StepForces<'a> {
    /// Constant force that each element puts on the structure along its pattern, N.
    pub elements: &'a [f64],
    /// Measured forces, N.
    pub drives: &'a [Polynomial],
}

/// Changes of the linear part by several parameters, which are the first of those by which a march is differentiated.
pub(super) struct Changes {
    /// Length of the rows of the parameters.
    columns: usize,
    /// What a full step adds to each entry of a state, over the state, the forces of elements and the coefficients of the drives; a row of
    /// the parameters each.
    full: Vec<f64>,
    /// `g` over the state and the forces, laid out alike.
    rates: Vec<f64>,
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
        let (states, columns) = (2 * count, stride(list.len()));
        let [mut full, mut rates] = [elements + ORDERS * drives, elements + drives]
            .map(|inputs| Table::new([states, states + inputs, columns]));
        for (c, change) in list.iter().enumerate() {
            for column in 0..states {
                let (j, z) = (column % count, if column < count { c64::new(1.0, 0.0) } else { c64::new(0.0, 1.0) });
                let rate = |k: usize| change.direct[k * count + j] * z + change.conjugate[k * count + j] * z.conj();
                rates.set(column, c, &(0..count).map(rate).collect::<Vec<c64>>());
                full.set(column, c, &full_step.of_state(change, j, z));
            }
            for input in 0..elements + drives {
                rates.set(states + input, c, &change.inputs[input]);
                let powers = if input < elements { 1 } else { ORDERS };
                let first = states + if input < elements { input } else { elements + ORDERS * (input - elements) };
                for power in 0..powers {
                    full.set(first + power, c, &full_step.of_input(change, input, power));
                }
            }
        }
        Self { columns, full: full.entries, rates: rates.entries, inputs: Vec::new(), ends: Default::default() }
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.columns == 0
    }

    /// Adds what a full step from the state `z` gives to `rows` of derivatives, each `stride` long.
    pub(super) fn over_full_step(&mut self, z: &[f64], forces: &StepForces, rows: &mut [f64], stride: usize) {
        self.inputs.clear();
        self.inputs.extend_from_slice(z);
        self.inputs.extend_from_slice(forces.elements);
        self.inputs.extend(forces.drives.iter().flatten());
        add_product_to_rows(&self.full, &self.inputs, self.columns, rows, stride);
    }

    /// Adds what a piece of a step between two states gives.
    pub(super) fn over_piece(
        &mut self,
        step: &Step,
        states: [&[f64]; 2],
        forces: &StepForces,
        rows: &mut [f64],
        stride: usize,
    ) {
        let (width, columns) = (states[0].len(), self.columns);
        for ((z, s), g) in states.into_iter().zip([0.0, step.share()]).zip(&mut self.ends) {
            self.inputs.clear();
            self.inputs.extend_from_slice(z);
            self.inputs.extend_from_slice(forces.elements);
            self.inputs.extend(forces.drives.iter().map(|drive| value(drive, s)));
            g.clear();
            g.resize(width * columns, 0.0);
            add_product_to_rows(&self.rates, &self.inputs, columns, g, columns);
        }
        let half = width / 2;
        let rising = step.share().recip();
        for k in 0..half {
            for c in 0..columns {
                let state_at = |g: &Vec<f64>| c64::new(g[k * columns + c], g[(half + k) * columns + c]);
                let [start, end] = [state_at(&self.ends[0]), state_at(&self.ends[1])];
                let sum = step.powers[0][k] * start + step.powers[1][k] * (end - start) * rising;
                rows[k * stride + c] += sum.re;
                rows[(half + k) * stride + c] += sum.im;
            }
        }
    }
}

/// Numbers over entries of a state, inputs and parameters.
struct Table {
    entries: Vec<f64>,
    inputs: usize,
    columns: usize,
}

impl Table {
    fn new([states, inputs, columns]: [usize; 3]) -> Self {
        Self { entries: vec![0.0; states * inputs * columns], inputs, columns }
    }

    /// What `input` does to a state, by parameter `c`.
    fn set(&mut self, input: usize, c: usize, state: &[c64]) {
        for (i, x) in state.iter().map(|z| z.re).chain(state.iter().map(|z| z.im)).enumerate() {
            self.entries[(i * self.inputs + input) * self.columns + c] = x;
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

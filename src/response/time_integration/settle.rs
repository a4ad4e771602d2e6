//! From any state to the periodic motion, and its harmonics.
//!
//! One period of stepping maps the state at its start to that at its end, and the periodic motion is the fixed point.
//! Waiting finds it as slowly as the structure's damping lets transients die; Anderson's mixing of the last periods finds
//! the same fixed point in a few tens of periods whatever the damping.

use super::model::{TimeError, TimeModel};
use crate::control::Control;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Periods that are mixed.
const DEPTH: usize = 24;

/// How to come to the periodic motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// Largest change of the state over a period, relative to the state.
    pub tolerance: f64,
    /// Most periods.
    pub most_periods: usize,
    /// Whether to mix periods; without, transients die out by themselves.
    pub accelerate: bool,
}

impl Default for Settling {
    fn default() -> Self {
        Self { tolerance: 1e-6, most_periods: 400, accelerate: true }
    }
}

/// One recorded period or more.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Time of each sample, s.
    pub time: Vec<f64>,
    /// Displacement, m: one row a sample, one column a DOF.
    pub displacement: Mat<f64>,
    /// Velocity, m/s.
    pub velocity: Mat<f64>,
    /// Acceleration, m/s^2; where a force jumps, the mean of both sides.
    pub acceleration: Mat<f64>,
}

impl TimeModel {
    /// Runs until periodic; gives the number of periods run.
    pub fn settle(&mut self, settling: &Settling, control: &Control) -> Result<usize, TimeError> {
        let mut mixer = Mixer::default();
        let mut change = f64::INFINITY;
        for period in 1..=settling.most_periods {
            control.check()?;
            let before = self.state.clone();
            self.run(self.steps)?;
            change = self.change(&before);
            if change <= settling.tolerance {
                return Ok(period);
            }
            if settling.accelerate {
                let weight = self.omega / self.scale();
                let n = self.len();
                self.state = mixer.next(before, &self.state, |i| if i < n { weight } else { 1.0 });
            }
        }
        Err(TimeError::NotSettled { periods: settling.most_periods, change })
    }

    /// Runs a number of steps.
    pub fn run(&mut self, steps: usize) -> Result<(), TimeError> {
        (0..steps).try_for_each(|_| self.advance())
    }

    /// Runs on and keeps every state from the present one on, `steps` of them.
    pub fn record(&mut self, steps: usize) -> Result<Samples, TimeError> {
        let n = self.len();
        let mut time = Vec::with_capacity(steps);
        let blank = Mat::zeros(steps, n);
        let mut samples =
            Samples { time: Vec::new(), displacement: blank.clone(), velocity: blank.clone(), acceleration: blank };
        for row in 0..steps {
            time.push(self.time());
            for i in 0..n {
                samples.displacement[(row, i)] = self.displacement(i);
                samples.velocity[(row, i)] = self.velocity(i);
            }
            let before = Instant { state: self.state.clone(), count: self.count, forces: self.forces.clone() };
            self.advance()?;
            for (i, a) in self.acceleration_between(before).into_iter().enumerate() {
                samples.acceleration[(row, i)] = a;
            }
        }
        Ok(Samples { time, ..samples })
    }

    /// Acceleration at an instant, from the mean forces of the step before it and of the one just made.
    fn acceleration_between(&mut self, mut before: Instant) -> Vec<f64> {
        std::mem::swap(&mut self.state, &mut before.state);
        std::mem::swap(&mut self.count, &mut before.count);
        // At the very start there is no step before.
        let old = |k: usize| if self.count == 0 { self.forces[k] } else { before.forces[k] };
        let result = self.acceleration((0..self.forces.len()).map(|k| 0.5 * (old(k) + self.forces[k])));
        std::mem::swap(&mut self.state, &mut before.state);
        std::mem::swap(&mut self.count, &mut before.count);
        result
    }

    /// Complex displacement amplitudes (m) of harmonics 1..=`order` over the next period: n rows, one column a harmonic.
    pub fn harmonics(&mut self, order: usize) -> Result<Mat<c64>, TimeError> {
        let (n, steps) = (self.len(), self.steps);
        let mut harmonics = Mat::<c64>::zeros(n, order);
        let scale = 2.0 / steps as f64;
        for _ in 0..steps {
            let phase = (self.count % steps) as f64 / steps as f64 * TAU;
            for h in 1..=order {
                let (sin, cos) = (h as f64 * phase).sin_cos();
                let wave = c64::new(cos * scale, -sin * scale);
                for i in 0..n {
                    harmonics[(i, h - 1)] += wave * self.displacement(i);
                }
            }
            self.advance()?;
        }
        Ok(harmonics)
    }

    /// Relative change of the state, displacements weighted by the fundamental frequency.
    fn change(&self, before: &[f64]) -> f64 {
        let weight = self.omega / self.scale();
        let (mut difference, mut size) = (0.0, 0.0);
        for (i, (now, old)) in self.state.iter().zip(before).enumerate() {
            let w = if i < self.len() { weight } else { 1.0 };
            difference += (w * (now - old)).powi(2);
            size += (w * now).powi(2);
        }
        if size == 0.0 { 0.0 } else { (difference / size).sqrt() }
    }
}

/// An instant that was left.
struct Instant {
    state: Vec<f64>,
    count: usize,
    forces: Vec<f64>,
}

/// Anderson's mixing.
#[derive(Default)]
struct Mixer {
    /// States before a period, and their changes over it.
    history: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Mixer {
    /// The next state to try, from a state and what a period makes of it.
    fn next(&mut self, before: Vec<f64>, after: &[f64], weight: impl Fn(usize) -> f64) -> Vec<f64> {
        let change: Vec<f64> = after.iter().zip(&before).map(|(a, b)| a - b).collect();
        self.history.push((before, change));
        if self.history.len() > DEPTH {
            self.history.remove(0);
        }
        let count = self.history.len() - 1;
        if count == 0 {
            return after.to_vec();
        }
        let n = after.len();
        let column = |k: usize, i: usize| self.history[k + 1].1[i] - self.history[k].1[i];
        // A little weight on small mixtures keeps columns that say the same from blowing up.
        let norm = (0..count).fold(0.0_f64, |m, k| m.max((0..n).map(|i| (weight(i) * column(k, i)).powi(2)).sum()));
        let ridge = 1e-9 * norm.sqrt();
        let matrix = Mat::from_fn(n + count, count, |i, k| match i {
            i if i < n => weight(i) * column(k, i),
            i => {
                if i - n == k {
                    ridge
                } else {
                    0.0
                }
            }
        });
        let last = &self.history[count].1;
        let rhs = Mat::from_fn(n + count, 1, |i, _| if i < n { weight(i) * last[i] } else { 0.0 });
        let mix = dashpot_numerics::least_squares(matrix.as_ref(), rhs.as_ref());
        let mut state = after.to_vec();
        for k in 0..count {
            let share = mix[(k, 0)];
            for (i, y) in state.iter_mut().enumerate() {
                let moved = self.history[k + 1].0[i] - self.history[k].0[i];
                *y -= share * (moved + column(k, i));
            }
        }
        if state.iter().all(|x| x.is_finite()) { state } else { after.to_vec() }
    }
}

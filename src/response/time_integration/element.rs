//! The nonlinear forces of one time step: the mean force of the step as a function of the displacement `x` made in it.
//!
//! ```text
//! laws of d and d'        F = f(d_0 + x/2, x/h)                                  (implicit midpoint)
//! friction                F - g(x/h) in bound Sgn(x/h), set-valued               (Moreau; Jean)
//! laws with memory        F = (F_0 + F_1) / 2,  F_1 from the law's own state     (trapezoidal)
//! ```
//!
//! Each element solves `x + w F(x) = b` for itself, with the receptance `w` of the leg over the step; the elements are
//! brought together by Gauss and Seidel (projected where friction is set-valued).

use crate::effects::{Effect, Law, Leg, Memory};

/// One nonlinear relative motion in time.
pub(crate) struct Element {
    pub source: usize,
    pub leg: Leg,
    pub parameters: Vec<f64>,
    effect: Effect,
    law: &'static dyn Law,
    memory: Option<Box<dyn Memory>>,
    /// Force of the memory at the start of the step, N.
    remembered: f64,
}

impl Element {
    /// At rest at the origin.
    pub fn new(source: usize, leg: Leg, effect: Effect, law: &'static dyn Law, parameters: &[f64]) -> Self {
        let memory = law.memory(parameters);
        Self { source, leg, parameters: parameters.to_vec(), effect, law, memory, remembered: 0.0 }
    }

    /// Forgets the past and goes to `d` (m).
    pub fn restart(&mut self, d: f64) {
        self.memory = self.law.memory(&self.parameters);
        self.remembered = 0.0;
        self.commit(d, f64::INFINITY);
    }

    /// Ends a step of `step` s at `d` (m).
    pub fn commit(&mut self, d: f64, step: f64) {
        if let Some(memory) = &mut self.memory {
            self.remembered = memory.advance(d, step);
        }
    }

    /// Mean force of the step that satisfies `x + w F(x) = b`, from displacement `d` (m); `guess` is a force nearby.
    pub fn force(&self, d: f64, w: f64, b: f64, step: f64, guess: f64) -> f64 {
        match self.effect {
            Effect::Coulomb => bounded(b / w, self.parameters[0]),
            Effect::Stribeck if (b / w).abs() <= self.parameters[1] => b / w,
            Effect::Power if self.parameters[1] < 1.0 => self.flat_power(w, b, step),
            _ => (b - self.displacement(d, w, b, step, b - w * guess)) / w,
        }
    }

    /// Slope-free solution for powers below one: `h v + w c v^e = |b|` for the speed `v`, by bisection.
    fn flat_power(&self, w: f64, b: f64, step: f64) -> f64 {
        let [c, e] = [self.parameters[0], self.parameters[1]];
        let (mut low, mut high) = (0.0, b.abs() / step);
        if w * c * high.powf(e) == 0.0 {
            return 0.0;
        }
        for _ in 0..200 {
            let v = 0.5 * (low + high);
            if v <= low || v >= high {
                break;
            }
            if step * v + w * c * v.powf(e) > b.abs() { high = v } else { low = v }
        }
        (b.abs() - step * low) / w * b.signum()
    }

    /// Root `x` of `x + w F(x) = b` by Newton's method, kept in a bracket for laws that only resist.
    fn displacement(&self, d: f64, w: f64, b: f64, step: f64, start: f64) -> f64 {
        let mut x = start;
        let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
        for _ in 0..100 {
            let [force, slope] = self.mean_force(d, x, step, b);
            let residual = x + w * force - b;
            bracket[usize::from(residual > 0.0)] = x;
            let newton = x - residual / (1.0 + w * slope);
            let inside = newton > bracket[0] && newton < bracket[1];
            let next = if inside { newton } else { 0.5 * (bracket[0] + bracket[1]) };
            let scale = b.abs() + (w * force).abs();
            if !next.is_finite() || (next - x).abs() <= 1e-14 * scale {
                return if next.is_finite() { next } else { x };
            }
            x = next;
        }
        x
    }

    /// Mean force and its slope by the displacement `x` of the step; `b` tells on which side friction slips.
    fn mean_force(&self, d: f64, x: f64, step: f64, b: f64) -> [f64; 2] {
        if let Some(memory) = &self.memory {
            let [force, slope] = memory.trial(d + x, step);
            return [0.5 * (self.remembered + force), 0.5 * slope];
        }
        if self.effect == Effect::Stribeck {
            let [sliding, resting, velocity] = [self.parameters[0], self.parameters[1], self.parameters[2]];
            let speed = (x / step * b.signum()).max(0.0);
            let excess = (resting - sliding) * (-speed / velocity).exp();
            return [(sliding + excess) * b.signum(), -excess / (velocity * step)];
        }
        let point = self.law.point(&self.parameters, 0.0, d + 0.5 * x, x / step).unwrap_or_default();
        [point.force, 0.5 * point.by_displacement + point.by_velocity / step]
    }
}

fn bounded(value: f64, bound: f64) -> f64 {
    value.clamp(-bound.max(0.0), bound.max(0.0))
}

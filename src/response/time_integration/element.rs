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

use crate::effects::{Law, Leg, Manner, Memory, SetValued, Steep};

/// Share of the displacements in the balance of a step that it may be off by where rounding keeps it from being met.
const CLOSE: f64 = 1e-9;

/// One nonlinear relative motion in time.
pub(crate) struct Element {
    pub leg: Leg,
    pub parameters: Vec<f64>,
    law: &'static dyn Law,
    memory: Option<Box<dyn Memory>>,
    /// Force of the memory at the start of the step, N.
    remembered: f64,
}

impl Element {
    /// At rest at the origin.
    pub(super) fn new(leg: Leg, law: &'static dyn Law, parameters: &[f64]) -> Self {
        let memory = law.memory(parameters);
        Self { leg, parameters: parameters.to_vec(), law, memory, remembered: 0.0 }
    }

    /// Forgets the past and goes to `d` (m).
    pub(super) fn restart(&mut self, d: f64) {
        self.memory = self.law.memory(&self.parameters);
        self.remembered = 0.0;
        self.commit(d, f64::INFINITY);
    }

    /// Ends a step of `step` s at `d` (m).
    pub(super) fn commit(&mut self, d: f64, step: f64) {
        if let Some(memory) = &mut self.memory {
            self.remembered = memory.advance(d, step);
        }
    }

    /// Mean force of the step that satisfies `x + w F(x) = b`, from displacement `d` (m); `guess` is a force nearby.
    pub(super) fn force(&self, d: f64, w: f64, b: f64, step: f64, guess: f64) -> f64 {
        match self.law.manner(&self.parameters) {
            Manner::SetValued => self.law.set_valued().map_or(0.0, |law| self.friction(law, w, b, step, guess)),
            Manner::Steep => self.law.steep().map_or(0.0, |law| self.steep(law, w, b, step)),
            Manner::Linear | Manner::Pointwise | Manner::Memory => {
                let mean = |x: f64| self.mean_force(d, x, step);
                (b - displacement(w, b, b - w * guess, mean)) / w
            }
        }
    }

    /// Friction that holds if it can, else slips the way it is drawn.
    fn friction(&self, law: &dyn SetValued, w: f64, b: f64, step: f64, guess: f64) -> f64 {
        let [low, high] = law.bounds(&self.parameters);
        let holding = b / w;
        if (low..=high).contains(&holding) || !law.has_smooth_part() {
            return holding.clamp(low, high.max(low));
        }
        let (bound, direction) = if holding > high { (high, 1.0) } else { (low, -1.0) };
        let slipping = |x: f64| {
            let speed = (x / step * direction).max(0.0);
            let [g, slope] = law.smooth_part(&self.parameters, direction * speed);
            [bound + g, slope / step]
        };
        (b - displacement(w, b, b - w * guess, slipping)) / w
    }

    /// Force of infinite slope at rest: `f(v) + (h / w) v = |b| / w` for the speed `v`.
    fn steep(&self, law: &dyn Steep, w: f64, b: f64, step: f64) -> f64 {
        let speed = law.speed(&self.parameters, step / w, b.abs() / w);
        (b.abs() - step * speed) / w * b.signum()
    }

    /// Mean force and its slope by the displacement `x` of the step.
    fn mean_force(&self, d: f64, x: f64, step: f64) -> [f64; 2] {
        if let Some(memory) = &self.memory {
            let [force, slope] = memory.trial(d + x, step);
            return [0.5 * (self.remembered + force), 0.5 * slope];
        }
        let point = self.law.point(&self.parameters, d + 0.5 * x, x / step).unwrap_or_default();
        [point.force, 0.5 * point.by_displacement + point.by_velocity / step]
    }
}

/// Root `x` of `x + w F(x) = b` by Newton's method from `start`, kept in a bracket for laws that only resist; not a number where there
/// is none, as beyond the limit point of a softening spring. `mean` gives the force and its slope by `x`.
fn displacement(w: f64, b: f64, start: f64, mean: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut x = start;
    let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
    for _ in 0..100 {
        let [force, slope] = mean(x);
        let residual = x + w * force - b;
        bracket[usize::from(residual > 0.0)] = x;
        let newton = x - residual / (1.0 + w * slope);
        let inside = newton > bracket[0] && newton < bracket[1];
        let next = if inside { newton } else { 0.5 * (bracket[0] + bracket[1]) };
        let scale = b.abs() + (w * force).abs();
        if (next - x).abs() <= 1e-14 * scale {
            return next;
        }
        if !next.is_finite() {
            break;
        }
        x = next;
    }
    let force = mean(x)[0];
    let close = CLOSE * (b.abs() + (w * force).abs());
    // A force that jumps leaves a residual at its jump.
    let found = (x + w * force - b).abs() <= close || bracket[1] - bracket[0] <= close;
    if found { x } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_softening_spring_holds_up_to_its_limit_point_only() {
        // x - x^2 = b has roots up to b = 1/4.
        let root = |b: f64| displacement(1.0, b, b, |x| [-x * x, -2.0 * x]);
        assert!((root(0.2) - (1.0 - 0.2_f64.sqrt()) / 2.0).abs() < 1e-12);
        assert!(root(0.3).is_nan());
        // The force of a switch jumps at nothing.
        let jump = displacement(1.0, 0.5, 0.5, |x| [x.signum(), 0.0]);
        assert!(jump.abs() < 1e-9, "{jump}");
    }
}

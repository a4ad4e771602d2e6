//! The nonlinear forces of one step: the mean force as a function of the displacement `x` made in it, and its derivatives.
//!
//! ```text
//! laws of d and d'     F = f(d_0 + x/2, x/h)                                        (implicit midpoint)
//! friction that slips  the same on the side of its sign; at rest the force that keeps it there
//! Masing hysteresis    F = (F_0 + F_1) / 2,  F_1 = F_r + 2 B((d_1 - d_r) / 2)       (from the reversal r)
//! Maxwell              F = c v + (F_0 - c v) (1 - e^-a) / a,  a = k h / c           (exact for a straight step)
//! one internal force   F = (G(Z_0) + G(Z_1)) / 2,  Z_1 = step(Z_0, x)               (Dahl, Bouc and Wen; G = output)
//! ```
//!
//! Each element solves `x + w F(x) = b` for itself, with the receptance `w` over the step.

use crate::effects::memory::open_reversals;
use crate::effects::ways::{InternalSteps, Way};
use crate::effects::{Law, Memory, Motion};
use faer::c64;

/// Share of a parameter by which the backbone of a law with memory is varied for its derivative.
const VARIATION: f64 = 1e-5;
/// Speed that stands for "just above rest", m/s.
const CREEP: f64 = 1e-30;

/// What kind of law an element has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Smooth,
    Friction,
    Masing,
    Maxwell,
    Internal,
}

impl Form {
    /// Whether the force depends on the motion before.
    pub(super) fn has_memory(self) -> bool {
        matches!(self, Self::Masing | Self::Maxwell | Self::Internal)
    }

    /// Of a law; `None` where it has no force in time that can be stepped here.
    pub(super) fn of(law: &dyn Law) -> Option<Self> {
        let typical: Vec<f64> = law.parameters().iter().map(|p| p.typical).collect();
        if law.internal(&typical).is_some() {
            Some(Self::Internal)
        } else if law.memory(&typical).is_some() {
            Some(if law.is_linear() { Self::Maxwell } else { Self::Masing })
        } else {
            law.point(&typical, 0.0, 1.0)?;
            Some(if law.set_valued().is_some() { Self::Friction } else { Self::Smooth })
        }
    }
}

/// Mean force of a step with its slopes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Mean {
    /// Force, N.
    pub force: f64,
    /// By the displacement made in the step, N/m.
    pub by_step: f64,
    /// By the displacement at its start.
    pub by_start: f64,
}

/// A place on the way of a law with memory: displacement and force, internal where it has one, with their derivatives by all
/// parameters.
#[derive(Debug, Clone, Default)]
struct Instant {
    d: f64,
    force: f64,
    by: Vec<[f64; 2]>,
}

/// One relative motion with its law and the state of it.
pub(super) struct Element {
    pub source: usize,
    pub form: Form,
    parameters: Vec<f64>,
    law: &'static dyn Law,
    scratch: Motion,
    /// The law at rest, and at rest with each parameter varied down and up, with the width of the variation.
    backbone: Option<Box<dyn Memory>>,
    varied: Vec<([Box<dyn Memory>; 2], f64)>,
    /// The law of one internal force.
    internal: Option<Box<dyn InternalSteps>>,
    last: Instant,
    reversals: Vec<Instant>,
    direction: f64,
    spare: Vec<f64>,
}

impl Element {
    /// At rest at the origin, differentiated by `count` parameters.
    pub(super) fn new(source: usize, form: Form, law: &'static dyn Law, parameters: &[f64], count: usize) -> Self {
        let with_parameter = |k: usize, step: f64| {
            let mut p = parameters.to_vec();
            p[k] += step;
            law.memory(&p)
        };
        let masing = form == Form::Masing;
        let width = |k: usize| VARIATION * parameters[k].abs().max(1e-9);
        let vary = |k: usize| Some(([with_parameter(k, -width(k))?, with_parameter(k, width(k))?], 2.0 * width(k)));
        let varied = if masing && count > 0 { (0..parameters.len()).filter_map(vary).collect() } else { Vec::new() };
        let backbone = if masing { law.memory(parameters) } else { None };
        Self {
            source,
            form,
            parameters: parameters.to_vec(),
            law,
            scratch: Motion::new(1.0, 0.0, &[c64::new(0.0, 0.0)], 1),
            backbone,
            varied,
            internal: if form == Form::Internal { law.internal(parameters) } else { None },
            last: Instant { by: vec![[0.0; 2]; count], ..Instant::default() },
            reversals: Vec::new(),
            direction: 0.0,
            spare: vec![0.0; count],
        }
    }

    /// Least and greatest force of friction at rest, N.
    pub(super) fn static_forces(&self) -> [f64; 2] {
        [-CREEP, CREEP].map(|v| self.law.point(&self.parameters, 0.0, v).map_or(0.0, |p| p.force))
    }

    /// Mean force of a step of `step` s from `d` (m) by `x`; `side` is the sign of the slip of friction.
    pub(super) fn mean(&self, d: f64, x: f64, step: f64, side: f64) -> Mean {
        match self.form {
            Form::Smooth | Form::Friction => {
                let v = self.on_side(x / step, side);
                let point = self.law.point(&self.parameters, d + 0.5 * x, v).unwrap_or_default();
                let (by_d, by_v) = (finite(point.by_displacement), finite(point.by_velocity));
                let by_v = if self.form == Form::Friction && v * side <= CREEP { 0.0 } else { by_v };
                Mean { force: point.force, by_step: 0.5 * by_d + by_v / step, by_start: by_d }
            }
            Form::Masing => {
                let [force, slope] = self.branch(d + x);
                Mean { force: 0.5 * (self.last.force + force), by_step: 0.5 * slope, by_start: 0.5 * slope }
            }
            Form::Maxwell => {
                let (share, [_, c]) = (self.relaxed(step), [self.parameters[0], self.parameters[1]]);
                let steady = c * x / step;
                let force = steady + (self.last.force - steady) * share;
                Mean { force, by_step: c / step * (1.0 - share), by_start: 0.0 }
            }
            Form::Internal => {
                let way = self.way(x);
                let ([before, _], [after, slope]) = (self.output(self.last.force), self.output(way.force));
                Mean { force: 0.5 * (before + after), by_step: 0.5 * slope * way.by_way, by_start: 0.0 }
            }
        }
    }

    /// Where the internal force is led by the displacement `x`.
    fn way(&self, x: f64) -> Way {
        let held = Way { force: self.last.force, by_start: 1.0, by_way: 0.0 };
        self.internal.as_ref().map_or(held, |law| law.step(self.last.force, x))
    }

    /// Derivative of that by a parameter of the law.
    fn way_by(&self, own: Option<usize>, x: f64) -> f64 {
        let by = |k: usize| self.internal.as_ref().map_or(0.0, |law| law.step_by(k, self.last.force, x));
        finite(own.map_or(0.0, by))
    }

    /// The law's force at an internal one, and its slope by it.
    fn output(&self, internal: f64) -> [f64; 2] {
        self.internal.as_ref().map_or([internal, 1.0], |law| law.output(internal))
    }

    /// Derivative of the law's force by a parameter, of which the internal force `z` has the derivative `by`.
    fn output_by(&self, own: Option<usize>, z: f64, by: f64) -> f64 {
        let explicit = |k: usize| self.internal.as_ref().map_or(0.0, |law| law.output_by(k, z));
        self.output(z)[1] * by + own.map_or(0.0, explicit)
    }

    fn on_side(&self, v: f64, side: f64) -> f64 {
        if self.form == Form::Friction { side * (v * side).max(CREEP) } else { v }
    }

    /// Mean force that satisfies `x + w F(x) = b`, by Newton's method kept in a bracket; `guess` is a force nearby.
    pub(super) fn solve(&self, d: f64, w: f64, b: f64, step: f64, side: f64, guess: f64) -> f64 {
        let mut x = b - w * guess;
        let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
        for _ in 0..100 {
            let mean = self.mean(d, x, step, side);
            let residual = x + w * mean.force - b;
            let scale = b.abs() + (w * mean.force).abs() + x.abs();
            if residual.abs() <= 4e-16 * scale {
                return mean.force;
            }
            bracket[usize::from(residual > 0.0)] = x;
            let newton = x - residual / (1.0 + w * mean.by_step);
            let inside = newton > bracket[0] && newton < bracket[1];
            let next = if inside || bracket.iter().any(|b| b.is_infinite()) {
                newton
            } else {
                0.5 * (bracket[0] + bracket[1])
            };
            if !next.is_finite() || (next - x).abs() <= 1e-15 * scale {
                break;
            }
            x = next;
        }
        (b - x) / w
    }

    /// Derivatives of the mean force by all parameters at fixed displacements, of a step `[d, x, step, side]` as in
    /// [`Self::mean`]: `own` tells which parameter of the law each one is, where it is one.
    pub(super) fn by_parameters(&mut self, [d, x, step, side]: [f64; 4], own: &[Option<usize>], out: &mut [f64]) {
        match self.form {
            Form::Smooth | Form::Friction => {
                let v = self.on_side(x / step, side);
                out.fill(0.0);
                for (out, own) in out.iter_mut().zip(own) {
                    if let Some(k) = own {
                        *out = self.at_instant(*k, d + 0.5 * x, v);
                    }
                }
            }
            Form::Masing => {
                self.branch_changes(d + x, own, out);
                out.iter_mut().zip(&self.last.by).for_each(|(out, by)| *out = 0.5 * (by[1] + *out));
            }
            Form::Maxwell => {
                let share = self.relaxed(step);
                for (theta, out) in out.iter_mut().enumerate() {
                    *out = share * self.last.by[theta][1] + own[theta].map_or(0.0, |k| self.maxwell_by(k, x, step));
                }
            }
            Form::Internal => {
                let (way, before) = (self.way(x), self.last.force);
                for (theta, out) in out.iter_mut().enumerate() {
                    let ([_, start], own) = (self.last.by[theta], own[theta]);
                    let end = way.by_start * start + self.way_by(own, x);
                    *out = 0.5 * (self.output_by(own, before, start) + self.output_by(own, way.force, end));
                }
            }
        }
    }

    /// Force at one instant, N, with its slopes by displacement and velocity; `held` is the force of friction at rest.
    pub(super) fn instant(&self, d: f64, v: f64, side: f64, held: f64) -> [f64; 3] {
        match self.form {
            Form::Friction if side == 0.0 => [held, 0.0, 0.0],
            Form::Smooth | Form::Friction => {
                let point = self.law.point(&self.parameters, d, self.on_side(v, side)).unwrap_or_default();
                [point.force, finite(point.by_displacement), finite(point.by_velocity)]
            }
            Form::Masing | Form::Maxwell => [self.last.force, 0.0, 0.0],
            Form::Internal => [self.output(self.last.force)[0], 0.0, 0.0],
        }
    }

    /// Derivative of [`Self::instant`] by parameter `theta` at fixed motion.
    pub(super) fn instant_by(&mut self, theta: usize, own: Option<usize>, d: f64, v: f64, side: f64) -> f64 {
        match self.form {
            Form::Smooth | Form::Friction => {
                let v = self.on_side(v, side);
                own.map_or(0.0, |k| self.at_instant(k, d, v))
            }
            Form::Masing | Form::Maxwell => self.last.by[theta][1],
            Form::Internal => self.output_by(own, self.last.force, self.last.by[theta][1]),
        }
    }

    /// Ends a step of `step` s at `d`; `change` holds the derivatives of `d`, `own` as above.
    pub(super) fn commit(&mut self, d: f64, step: f64, change: &[f64], own: &[Option<usize>]) {
        match self.form {
            Form::Smooth | Form::Friction => {}
            Form::Masing => {
                let [force, slope] = self.branch(d);
                let mut by = std::mem::take(&mut self.spare);
                self.branch_changes(d, own, &mut by);
                by.iter_mut().zip(change).for_each(|(by, change)| *by += slope * change);
                if self.turns(d) {
                    self.reversals.push(self.last.clone());
                }
                let open = self.open(d, false);
                self.reversals.truncate(open);
                if d != self.last.d {
                    self.direction = (d - self.last.d).signum();
                }
                (self.last.d, self.last.force) = (d, force);
                for (last, now) in self.last.by.iter_mut().zip(change.iter().zip(&by)) {
                    *last = [*now.0, *now.1];
                }
                self.spare = by;
            }
            Form::Maxwell => {
                let [k, c] = [self.parameters[0], self.parameters[1]];
                let (x, decay) = (d - self.last.d, if c > 0.0 { (-k * step / c).exp() } else { 0.0 });
                let steady = if step.is_finite() { c * x / step } else { 0.0 };
                let force = steady + (self.last.force - steady) * decay;
                let rest = self.last.force - steady;
                for (theta, change) in change.iter().enumerate() {
                    let [before, past] = self.last.by[theta];
                    let explicit = match own[theta] {
                        Some(0) if c > 0.0 => -rest * decay * step / c,
                        Some(1) if c > 0.0 => x / step * (1.0 - decay) + rest * decay * k * step / (c * c),
                        _ => 0.0,
                    };
                    let by_x = if step.is_finite() { c / step * (1.0 - decay) } else { 0.0 };
                    let explicit = if explicit.is_finite() { explicit } else { 0.0 };
                    self.last.by[theta] = [*change, past * decay + by_x * (change - before) + explicit];
                }
                (self.last.d, self.last.force) = (d, force);
            }
            Form::Internal => {
                let x = d - self.last.d;
                let way = self.way(x);
                for (theta, change) in change.iter().enumerate() {
                    let [before, past] = self.last.by[theta];
                    let led = way.by_start * past + way.by_way * (change - before) + self.way_by(own[theta], x);
                    self.last.by[theta] = [*change, led];
                }
                (self.last.d, self.last.force) = (d, way.force);
            }
        }
    }

    fn at_instant(&mut self, k: usize, d: f64, v: f64) -> f64 {
        self.scratch.displacement[0] = d;
        self.scratch.velocity[0] = v;
        let mut value = [0.0];
        self.law.parameter_tangent(&self.parameters, k, &self.scratch, &mut value);
        if value[0].is_finite() { value[0] } else { 0.0 }
    }

    /// Mean of `e^(-k t / c)` over a step.
    fn relaxed(&self, step: f64) -> f64 {
        let [k, c] = [self.parameters[0], self.parameters[1]];
        let a = if c > 0.0 { k * step / c } else { f64::INFINITY };
        match a {
            a if a < 1e-6 => 1.0 - 0.5 * a,
            a if a.is_infinite() => 0.0,
            a => -(-a).exp_m1() / a,
        }
    }

    fn maxwell_by(&self, k: usize, x: f64, step: f64) -> f64 {
        let [stiffness, c] = [self.parameters[0], self.parameters[1]];
        if c <= 0.0 || stiffness <= 0.0 {
            return 0.0;
        }
        let a = stiffness * step / c;
        let by_a = if a < 1e-4 { -0.5 + a / 3.0 } else { ((-a).exp() * (1.0 + a) - 1.0) / (a * a) };
        let rest = self.last.force - c * x / step;
        match k {
            0 => rest * by_a * step / c,
            _ => x / step * (1.0 - self.relaxed(step)) - rest * by_a * a / c,
        }
    }

    /// Whether the motion turns at the last instant on its way to `d`.
    fn turns(&self, d: f64) -> bool {
        (d - self.last.d) * self.direction < 0.0
    }

    /// Reversals that stay open on the way to `d`, the last instant among them if `turned`.
    fn open(&self, d: f64, turned: bool) -> usize {
        let place = |i: usize| self.reversals.get(i).unwrap_or(&self.last).d;
        open_reversals(place, self.reversals.len() + usize::from(turned), d)
    }

    /// Force and slope of Masing's branch at `d`.
    fn branch(&self, d: f64) -> [f64; 2] {
        let Some(backbone) = &self.backbone else { return [0.0; 2] };
        match self.open(d, self.turns(d)) {
            0 => backbone.trial(d, 1.0),
            count => {
                let from = self.reversals.get(count - 1).unwrap_or(&self.last);
                let [half, slope] = backbone.trial(0.5 * (d - from.d), 1.0);
                [from.force + 2.0 * half, slope]
            }
        }
    }

    /// Derivatives of the force of the branch by all parameters at a fixed `d`.
    fn branch_changes(&self, d: f64, own: &[Option<usize>], out: &mut [f64]) {
        let explicit = |d: f64, own: &Option<usize>| {
            own.and_then(|k| self.varied.get(k))
                .map_or(0.0, |([low, high], width)| (high.trial(d, 1.0)[0] - low.trial(d, 1.0)[0]) / width)
        };
        match self.open(d, self.turns(d)) {
            0 => out.iter_mut().zip(own).for_each(|(out, own)| *out = explicit(d, own)),
            count => {
                let from = self.reversals.get(count - 1).unwrap_or(&self.last);
                let [_, slope] = self.branch(d);
                for ((out, own), by) in out.iter_mut().zip(own).zip(&from.by) {
                    *out = by[1] - slope * by[0] + 2.0 * explicit(0.5 * (d - from.d), own);
                }
            }
        }
    }
}

fn finite(slope: f64) -> f64 {
    if slope.is_finite() { slope } else { 0.0 }
}

//! Rate-independent hysteresis with one internal force that follows the displacement: `dF/dd = s(F, sgn d')`.
//!
//! The samples of a period are joined by straight ways, over each of which a law says where its force goes from where it
//! was: `F_1 = step(F_0, d_1 - d_0)`. One period maps the force at its start to that at its end, rising with a slope below
//! one; the steady state is where the two are the same, found by Newton's method in a bracket. Its derivatives are
//! marched along with it and closed over the period alike.
//!
//! The law's force is the internal one itself, or `F = output(Z)` of an internal one `Z`, as behind a play.
//!
//! Where the motion is so small that nothing slips, the map gives back what it was given and any mean force would do;
//! the force is then that of the spring about the middle of the motion, which is the limit of small slip.

use super::description::Description;
use super::law::{ByParameter, Law, Linearised, Manner};
use super::memory::Memory;
use super::motion::Motion;
use super::turning::turning_points;
pub(crate) use super::ways::{InternalSteps, Way};

/// Slope of the period's map from which on nothing slips.
const SLIPLESS: f64 = 1.0 - 1e-9;
/// Parts of the way from one turning point to the next for the energy; even.
const PARTS: usize = 256;
/// Most steps of Newton's method to the steady state.
const STEPS: usize = 80;

/// A law given by what one straight way does to its force.
pub(crate) trait InternalLaw: Sync {
    /// What the ways of one set of parameters have in common, computed once.
    type Shape: Send + Sync + 'static;

    /// As [`Law::description`].
    fn description(&self) -> &'static Description;

    /// What the ways of the parameters `p` have in common.
    fn shape(&self, p: &[f64]) -> Self::Shape;

    /// Slope of the force at rest, N/m.
    fn stiffness(&self, p: &[f64]) -> f64;

    /// From the force `start` (N) over the straight `way` (m).
    fn step(&self, shape: &Self::Shape, p: &[f64], start: f64, way: f64) -> Way;

    /// Derivative of the force at the end by parameter `k`, start and way held.
    fn step_by(&self, shape: &Self::Shape, p: &[f64], k: usize, start: f64, way: f64) -> f64;

    /// Largest internal force, N: no steady motion between extremes that are `range` (m) apart leads beyond it.
    fn bound(&self, p: &[f64], range: f64) -> f64;

    /// The law's force (N) at this internal one, and its slope by it.
    fn output(&self, p: &[f64], internal: f64) -> [f64; 2] {
        let _ = p;
        [internal, 1.0]
    }

    /// Derivative of [`InternalLaw::output`] by parameter `k`, the internal force held.
    fn output_by(&self, p: &[f64], k: usize, internal: f64) -> f64 {
        let _ = (p, k, internal);
        0.0
    }

    /// Energy per cycle of `d = amplitude cos(omega t)`, J, where a closed form exists.
    fn loop_energy(&self, p: &[f64], amplitude: f64) -> Option<f64> {
        let _ = (p, amplitude);
        None
    }

    /// Energy over one period of any motion, J, where it is known in closed form.
    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        let _ = (p, motion);
        None
    }
}

/// [`InternalSteps`] of a law.
struct Stepped<T: InternalLaw> {
    law: T,
    shape: T::Shape,
    p: Vec<f64>,
}

impl<T: InternalLaw + Send> InternalSteps for Stepped<T> {
    fn step(&self, start: f64, way: f64) -> Way {
        self.law.step(&self.shape, &self.p, start, way)
    }

    fn step_by(&self, k: usize, start: f64, way: f64) -> f64 {
        self.law.step_by(&self.shape, &self.p, k, start, way)
    }

    fn output(&self, internal: f64) -> [f64; 2] {
        self.law.output(&self.p, internal)
    }

    fn output_by(&self, k: usize, internal: f64) -> f64 {
        self.law.output_by(&self.p, k, internal)
    }
}

/// A law with one internal force as a [`Law`].
#[derive(Debug)]
pub(crate) struct Internal<T>(pub T);

impl<T: InternalLaw> Internal<T> {
    /// Where each way of the period starts and leads to from the force `start`, in place of those of another start; the force at the end,
    /// and its derivative by `start`.
    fn period(&self, shape: &T::Shape, p: &[f64], d: &[f64], start: f64, ways: &mut Vec<(f64, Way)>) -> [f64; 2] {
        let [mut force, mut slope] = [start, 1.0];
        for n in 0..d.len() {
            // What has forgotten its start goes on as before.
            if slope == 0.0 && ways.get(n).is_some_and(|(before, _)| *before == force) {
                return [ways[ways.len() - 1].1.force, 0.0];
            }
            let way = self.0.step(shape, p, force, d[(n + 1) % d.len()] - d[n]);
            match ways.get_mut(n) {
                Some(known) => *known = (force, way),
                None => ways.push((force, way)),
            }
            (force, slope) = (way.force, slope * way.by_start);
        }
        [force, slope]
    }

    /// The force of a spring about the middle of the motion, within the bound.
    fn unslipped(&self, p: &[f64], d: &[f64]) -> f64 {
        let (least, most) = extremes(d);
        let bound = self.0.bound(p, d[most] - d[least]);
        // No clamp: of a trial whose parameters are no numbers the bound is none either, and the answer is then no number.
        (self.0.stiffness(p) * (d[0] - middle(d))).max(-bound).min(bound)
    }

    /// The ways of one period in steady state, and the slope of the period's map there.
    fn ways(&self, p: &[f64], d: &[f64]) -> (Vec<(f64, Way)>, f64) {
        let (least, most) = extremes(d);
        let range = d[most] - d[least];
        let (bound, shape) = (self.0.bound(p, range), self.0.shape(p));
        let (mut low, mut high, mut start) = (-bound, bound, self.unslipped(p, d));
        let size = bound.min(self.0.stiffness(p) * range);
        let (mut ways, mut slope) = (Vec::with_capacity(d.len()), 1.0);
        for _ in 0..STEPS {
            let [end, by_start] = self.period(&shape, p, d, start, &mut ways);
            slope = by_start;
            if (slope - 1.0).abs() < 1.0 - SLIPLESS {
                break;
            }
            let rest = end - start;
            if rest > 0.0 {
                low = start;
            } else {
                high = start;
            }
            // Where forces grow on the way the map may rise faster than its argument; at the steady state it does not.
            let newton = if slope < 1.0 { start + rest / (1.0 - slope) } else { f64::NAN };
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let change = (next - start).abs();
            // Newton converges quadratically: what is left is rounding, as the step to the fixed point magnifies it.
            if change * (1.0 - slope).abs() <= 1e-13 * size {
                break;
            }
            start = next;
        }
        (ways, slope)
    }
}

/// Carries a derivative of the internal force around the period.
fn carry(ways: &[(f64, Way)], slope: f64, unslipped: f64, added: impl Fn(usize) -> f64, out: &mut [f64]) {
    let mut value = unslipped;
    if slope <= SLIPLESS {
        let around = ways.iter().enumerate().fold(0.0, |sum, (n, (_, way))| way.by_start * sum + added(n));
        value = around / (1.0 - slope);
    }
    for (n, (out, (_, way))) in out.iter_mut().zip(ways).enumerate() {
        *out = value;
        value = way.by_start * value + added(n);
    }
}

/// Middle between the extremes.
fn middle(d: &[f64]) -> f64 {
    let (least, most) = extremes(d);
    0.5 * (d[least] + d[most])
}

/// Samples of the extremes.
fn extremes(d: &[f64]) -> (usize, usize) {
    (1..d.len()).fold((0, 0), |(least, most), n| {
        (if d[n] < d[least] { n } else { least }, if d[n] > d[most] { n } else { most })
    })
}

impl<T: InternalLaw + Copy + Send + 'static> Law for Internal<T> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn manner(&self, _p: &[f64]) -> Manner {
        Manner::Memory
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        let (ways, _) = self.ways(p, &motion.displacement);
        ways.iter().zip(force).for_each(|((start, _), f)| *f = self.0.output(p, *start)[0]);
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.linearised(p, motion)(direction, tangent);
    }

    fn linearised<'a>(&'a self, p: &'a [f64], motion: &'a Motion) -> Linearised<'a> {
        self.force_and_tangent(p, motion, &mut [])
    }

    fn force_and_tangent<'a>(&'a self, p: &'a [f64], motion: &'a Motion, force: &mut [f64]) -> Linearised<'a> {
        let (ways, slope) = self.ways(p, &motion.displacement);
        ways.iter().zip(force).for_each(|((start, _), f)| *f = self.0.output(p, *start)[0]);
        let (least, most) = extremes(&motion.displacement);
        let stiffness = self.0.stiffness(p);
        Box::new(move |direction, tangent| {
            let e = &direction.displacement;
            let unslipped = stiffness * (e[0] - 0.5 * (e[least] + e[most]));
            carry(&ways, slope, unslipped, |n| ways[n].1.by_way * (e[(n + 1) % e.len()] - e[n]), tangent);
            tangent.iter_mut().zip(&ways).for_each(|(t, (start, _))| *t *= self.0.output(p, *start)[1]);
        })
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        self.by_parameters(p, motion)(k, tangent);
    }

    fn by_parameters<'a>(&'a self, p: &'a [f64], motion: &'a Motion) -> ByParameter<'a> {
        let d = &motion.displacement;
        let ((ways, slope), shape) = (self.ways(p, d), self.0.shape(p));
        Box::new(move |k, tangent| {
            let by = |n: usize| self.0.step_by(&shape, p, k, ways[n].0, d[(n + 1) % d.len()] - d[n]);
            let added: Vec<f64> = (0..d.len()).map(by).collect();
            carry(&ways, slope, self.0.step_by(&shape, p, k, 0.0, d[0] - middle(d)), |n| added[n], tangent);
            for (t, (start, _)) in tangent.iter_mut().zip(&ways) {
                *t = *t * self.0.output(p, *start)[1] + self.0.output_by(p, k, *start);
            }
        })
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        Some(Box::new(InternalMemory { law: self.0, shape: self.0.shape(p), p: p.to_vec(), last: [0.0; 2] }))
    }

    fn internal(&self, p: &[f64]) -> Option<Box<dyn InternalSteps>> {
        Some(Box::new(Stepped { law: self.0, shape: self.0.shape(p), p: p.to_vec() }))
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        self.0.loop_energy(p, amplitude)
    }

    /// By a closed form where there is one, else the work on the way from each turning point of the motion to the next, by
    /// Simpson's rule: a law that knows no rate knows nothing else of the motion.
    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        if let [single] = motion.harmonics[..]
            && let Some(energy) = self.0.loop_energy(p, single.norm())
        {
            return energy;
        }
        if let Some(energy) = self.0.exact_energy(p, motion) {
            return energy;
        }
        let points = turning_points(motion);
        if points.is_empty() {
            return 0.0;
        }
        let count = points.len();
        let segment = |i: usize| {
            let (from, to) = (points[i], points[(i + 1) % count]);
            (0..PARTS).map(move |k| from + (to - from) * k as f64 / PARTS as f64)
        };
        let path: Vec<f64> = (0..count).flat_map(segment).collect();
        let (ways, _) = self.ways(p, &path);
        let force = |n: usize| self.0.output(p, ways[n % ways.len()].0)[0];
        let pair = |n: usize| {
            let length = path[(n + 2) % path.len()] - path[n];
            (force(n) + 4.0 * force(n + 1) + force(n + 2)) / 6.0 * length
        };
        (0..path.len()).step_by(2).map(pair).sum::<f64>().max(0.0)
    }
}

/// The law stepped through time from rest.
struct InternalMemory<T: InternalLaw> {
    law: T,
    shape: T::Shape,
    p: Vec<f64>,
    /// Displacement (m) and internal force (N) of the last instant.
    last: [f64; 2],
}

impl<T: InternalLaw> InternalMemory<T> {
    fn way(&self, d: f64) -> Way {
        self.law.step(&self.shape, &self.p, self.last[1], d - self.last[0])
    }
}

impl<T: InternalLaw> Memory for InternalMemory<T> {
    fn trial(&self, d: f64, _step: f64) -> [f64; 2] {
        let way = self.way(d);
        let [force, slope] = self.law.output(&self.p, way.force);
        [force, slope * way.by_way]
    }

    fn advance(&mut self, d: f64, _step: f64) -> f64 {
        self.last = [d, self.way(d).force];
        self.law.output(&self.p, self.last[1])[0]
    }
}

//! Rate-independent hysteresis of Masing's kind, exact and without any discretisation of slip.
//!
//! Sliders in parallel, each in series with a spring, follow from rest the backbone `B(d)` (odd, concave for d > 0), and
//! after a reversal at `(d_r, F_r)`
//!
//! ```text
//! F = F_r + 2 B((d - d_r) / 2)
//! ```
//!
//! until the inner loop closes, where the branch interrupted before goes on (return-point memory). In steady state the
//! greatest |d| of the period lies on the backbone, so one period of marching that starts there is periodic at once,
//! whatever came before.

use super::description::Description;
use super::law::{Law, Linearised, Manner};
use super::memory::{MasingMemory, Memory};
use super::motion::Motion;
use super::set_valued::SetValued;
use super::turning::loop_ranges;

/// Marches a steady period: `out[n]` at every sample of `displacement` (m).
///
/// `start(n)` is the value at the sample of greatest displacement, `branch(r, n)` what is added on the way from the
/// reversal at sample `r` to sample `n`. With `B` these give the force, with derivatives of `B` its tangents.
pub(crate) fn march(
    displacement: &[f64],
    out: &mut [f64],
    start: impl Fn(usize) -> f64,
    branch: impl Fn(usize, usize) -> f64,
) {
    branches(displacement, |n, origin| {
        out[n] = match origin {
            None => start(n),
            Some(r) => out[r] + branch(r, n),
        };
    });
}

/// Calls `visit` with every sample of a steady period, in the order of the march, and the reversal from which its branch
/// starts; the first, of greatest displacement, lies on the backbone and has none.
fn branches(displacement: &[f64], mut visit: impl FnMut(usize, Option<usize>)) {
    let count = displacement.len();
    let d = displacement;
    let Some(first) = (0..count).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())) else {
        return;
    };
    visit(first, None);
    let mut reversals = vec![first];
    let mut origin = first;
    let mut last = first;
    for n in (first + 1..count).chain(0..first) {
        if (d[n] - d[last]) * (d[last] - d[origin]) < 0.0 {
            reversals.push(last);
            origin = last;
        }
        while let [.., resumed, outer, inner] = reversals[..] {
            if (d[n] - d[outer]) * (d[outer] - d[inner]) < 0.0 {
                break;
            }
            reversals.truncate(reversals.len() - 2);
            origin = resumed;
        }
        visit(n, Some(origin));
        last = n;
    }
}

/// A sample of the march with the slope of its branch there (N/m).
struct Marched {
    sample: usize,
    origin: Option<usize>,
    by_way: f64,
}

/// A law given by its backbone.
pub(crate) trait MasingLaw: Sync {
    /// As [`Law::description`].
    fn description(&self) -> &'static Description;

    /// Force (N) of the backbone at displacement `d` (m) from rest: odd, concave for `d > 0`.
    fn backbone(&self, p: &[f64], d: f64) -> f64;

    /// Its slope, N/m.
    fn slope(&self, p: &[f64], d: f64) -> f64;

    /// Its derivative by parameter `k`.
    fn by_parameter(&self, p: &[f64], k: usize, d: f64) -> f64;

    /// Energy per cycle of `d = amplitude cos(omega t)`, J.
    fn loop_energy(&self, p: &[f64], amplitude: f64) -> f64;

    /// As [`Law::set_valued`].
    fn set_valued(&self) -> Option<&dyn SetValued> {
        None
    }

    /// As [`Law::series_stiffness`].
    fn series_stiffness(&self, p: &[f64]) -> Option<f64> {
        let _ = p;
        None
    }
}

/// A law of Masing's kind as a [`Law`].
#[derive(Debug)]
pub(crate) struct Masing<T>(pub T);

impl<T: MasingLaw + Copy + Send + 'static> Law for Masing<T> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn manner(&self, _p: &[f64]) -> Manner {
        Manner::Memory
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        let (law, d) = (&self.0, &motion.displacement);
        march(d, force, |n| law.backbone(p, d[n]), |r, n| 2.0 * law.backbone(p, 0.5 * (d[n] - d[r])));
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.linearised(p, motion)(direction, tangent);
    }

    fn linearised<'a>(&'a self, p: &'a [f64], motion: &'a Motion) -> Linearised<'a> {
        let d = &motion.displacement;
        let mut marched = Vec::with_capacity(d.len());
        branches(d, |sample, origin| {
            let way = origin.map_or(d[sample], |r| 0.5 * (d[sample] - d[r]));
            marched.push(Marched { sample, origin, by_way: self.0.slope(p, way) });
        });
        Box::new(move |direction, tangent| {
            let e = &direction.displacement;
            for Marched { sample, origin, by_way } in &marched {
                let (from, moved) = origin.map_or((0.0, e[*sample]), |r| (tangent[r], e[*sample] - e[r]));
                tangent[*sample] = from + by_way * moved;
            }
        })
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        let (law, d) = (&self.0, &motion.displacement);
        march(d, tangent, |n| law.by_parameter(p, k, d[n]), |r, n| 2.0 * law.by_parameter(p, k, 0.5 * (d[n] - d[r])));
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        self.0.set_valued()
    }

    fn series_stiffness(&self, p: &[f64]) -> Option<f64> {
        self.0.series_stiffness(p)
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let (law, p) = (self.0, p.to_vec());
        Some(Box::new(MasingMemory::new(move |d| [law.backbone(&p, d), law.slope(&p, d)])))
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(self.0.loop_energy(p, amplitude))
    }

    /// The sum over its closed loops.
    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        loop_ranges(motion).into_iter().map(|range| self.0.loop_energy(p, 0.5 * range)).sum()
    }
}

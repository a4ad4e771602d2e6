//! The first loading curve of Bouc-Wen hysteresis, tabulated: from rest the force `z` rises over the way `xi` (both without units)
//! by
//!
//! ```text
//! dz/dxi = 1 - z^n,      w = dz/dn:   dw/dxi = -n z^(n-1) w - z^n ln z
//! ```
//!
//! The equation does not know where it is, so that every way that loads is a part of this one curve, `z(xi_0 + way)` with
//! `z(xi_0)` the force at its start. Between the nodes cubics with the slopes there (Hermite) are exact to 2e-7. Near `z = 1`,
//! with `e = 1 - z`, `e' = -n e + n (n-1) / 2 e^2` has a closed form, and `w = (w_0 + e_0 xi) exp(-n xi)`.

/// Steps between nodes: at rest, where small exponents give a kink, and how much longer each may be than the one before; the
/// longest, over the exponent of large ones, and times the rate at which the curve bends.
const FIRST: f64 = 1e-3;
const GROWTH: f64 = 1.25;
const LONGEST: f64 = 0.03;
const SHARP: f64 = 0.4;
const BENT: f64 = 0.06;
/// `n (1 - z)` below which what is left to rise falls off as an exponential.
const RISEN: f64 = 1e-3;
/// Steps of Newton's method on a cubic that is almost straight.
const STEPS: usize = 4;

/// A force after a way that loads, with its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reached {
    pub z: f64,
    pub by_start: f64,
    pub by_way: f64,
    pub by_exponent: f64,
}

/// Way, then force and its derivative by the exponent, each with its slope over the way.
#[derive(Debug, Clone, Copy)]
struct Node {
    way: f64,
    z: [f64; 2],
    w: [f64; 2],
}

/// The curve of one exponent.
#[derive(Debug)]
pub(crate) struct LoadingCurve {
    n: f64,
    nodes: Vec<Node>,
}

impl LoadingCurve {
    /// The curve of the exponent `n`, at least 1, by the classical Runge-Kutta method from node to node.
    pub(crate) fn new(n: f64) -> Self {
        let slope = |[z, w]: [f64; 2]| {
            if z <= 0.0 {
                return [1.0, 0.0];
            }
            let power = z.powf(n);
            [1.0 - power, -n * power / z * w - power * z.ln()]
        };
        let node = |way: f64, at: [f64; 2]| {
            let rates = slope(at);
            Node { way, z: [at[0], rates[0]], w: [at[1], rates[1]] }
        };
        let (mut at, mut way, mut longest) = ([0.0, 0.0], 0.0, FIRST);
        let mut nodes = vec![node(way, at)];
        while n * (1.0 - at[0]) >= RISEN {
            let a = slope(at);
            let h = longest.min(BENT / (n * (1.0 - a[0]) + 1.0));
            let moved = |rates: [f64; 2], h: f64| [at[0] + h * rates[0], at[1] + h * rates[1]];
            let b = slope(moved(a, 0.5 * h));
            let c = slope(moved(b, 0.5 * h));
            let d = slope(moved(c, h));
            at = std::array::from_fn(|i| at[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
            way += h;
            longest = LONGEST.min(SHARP / n).min(GROWTH * longest);
            nodes.push(node(way, at));
        }
        Self { n, nodes }
    }

    fn last(&self) -> Node {
        self.nodes[self.nodes.len() - 1]
    }

    /// From the force `start` (0 to 1) over `way >= 0`.
    pub(crate) fn risen(&self, start: f64, way: f64) -> Reached {
        // A start or an exponent that is no number is below nothing.
        let is_below = start < self.last().z[0];
        if !is_below {
            return self.end(start.min(1.0), 0.0, way);
        }
        let from = self.way_to(start);
        let (z, w) = self.at(from);
        let to = from + way;
        // What a longer start would change is what a longer way would, times the change of the way to the start.
        let moved = |there: Reached| Reached {
            by_start: there.by_way / z[1],
            by_exponent: there.by_exponent - there.by_way * w[0] / z[1],
            ..there
        };
        let last = self.last();
        if to > last.way {
            return moved(self.end(last.z[0], last.w[0], to - last.way));
        }
        let (there, by_exponent) = self.at(to);
        moved(Reached { z: start + there[0] - z[0], by_start: 1.0, by_way: there[1], by_exponent: by_exponent[0] })
    }

    /// From a force near 1, whose derivative by the exponent is `w`.
    fn end(&self, z: f64, w: f64, way: f64) -> Reached {
        let (n, e) = (self.n, 1.0 - z);
        let fade = (-n * way).exp();
        let rest = 1.0 - 0.5 * (n - 1.0) * e * (1.0 - fade);
        let left = e * fade / rest;
        Reached {
            z: 1.0 - left,
            by_start: fade / (rest * rest),
            by_way: n * left * (1.0 - 0.5 * (n - 1.0) * left),
            by_exponent: (w + e * way) * fade,
        }
    }

    /// Force and its derivative by the exponent, each with its slope, after a way within the nodes.
    fn at(&self, way: f64) -> ([f64; 2], [f64; 2]) {
        let k = self.nodes.partition_point(|node| node.way <= way).clamp(1, self.nodes.len() - 1);
        let (a, b) = (self.nodes[k - 1], self.nodes[k]);
        let h = b.way - a.way;
        let t = (way - a.way) / h;
        (cubic(t, h, a.z, b.z), cubic(t, h, a.w, b.w))
    }

    /// The way after which the force is `z`, below that of the last node.
    fn way_to(&self, z: f64) -> f64 {
        let k = self.nodes.partition_point(|node| node.z[0] <= z).clamp(1, self.nodes.len() - 1);
        let (a, b) = (self.nodes[k - 1], self.nodes[k]);
        let h = b.way - a.way;
        let mut t = (z - a.z[0]) / (b.z[0] - a.z[0]);
        for _ in 0..STEPS {
            let [value, rate] = cubic(t, h, a.z, b.z);
            let step = (z - value) / (rate * h);
            t = (t + step).clamp(0.0, 1.0);
            if step.abs() < 1e-15 {
                break;
            }
        }
        a.way + t * h
    }
}

/// Value and slope at the share `t` of a step `h` of the cubic with these values and slopes at its ends.
fn cubic(t: f64, h: f64, [y, dy]: [f64; 2], [z, dz]: [f64; 2]) -> [f64; 2] {
    let (rise, a, b) = (z - y, h * dy, h * dz);
    let (c, d) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
    [y + t * (a + t * (c + t * d)), (a + t * (2.0 * c + 3.0 * t * d)) / h]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `xi` at which the curve reaches `z`, by Simpson's rule for `integral du / (1 - u^n)`.
    fn way_to(z: f64, n: f64) -> f64 {
        let parts = 20_000;
        let h = z / f64::from(parts);
        let f = |k: i32| 1.0 / (1.0 - (f64::from(k) * h).powf(n));
        (0..parts).step_by(2).map(|k| (f(k) + 4.0 * f(k + 1) + f(k + 2)) * h / 3.0).sum()
    }

    #[test]
    fn the_curve_is_the_integral_of_its_equation() {
        for n in [1.0, 1.3, 2.0, 7.5, 40.0] {
            let curve = LoadingCurve::new(n);
            for z in [0.003, 0.05, 0.4, 0.8, 0.97, 0.9996] {
                let found = curve.risen(0.0, way_to(z, n)).z;
                assert!((found - z).abs() < 2e-7, "{n} {z}: {found}");
            }
        }
    }

    #[test]
    fn a_way_may_begin_anywhere_on_the_curve() {
        for n in [1.0, 1.3, 2.0, 7.5, 40.0] {
            let curve = LoadingCurve::new(n);
            for (first, second) in [(0.0, 0.4), (0.01, 0.3), (0.7, 0.5), (0.3, 12.0), (12.0, 0.2)] {
                let half = curve.risen(0.0, first);
                let (apart, together) = (curve.risen(half.z, second), curve.risen(0.0, first + second));
                assert!((apart.z - together.z).abs() < 1e-12, "{n}: {} {}", apart.z, together.z);
            }
            assert_eq!(curve.risen(0.25, 0.0).z, 0.25);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_curve() {
        for n in [1.2, 2.0, 7.5] {
            for (start, way) in [(0.0, 0.03), (0.2, 0.5), (0.6, 0.05), (0.5, 4.0), (0.99999, 0.1)] {
                let there = LoadingCurve::new(n).risen(start, way);
                let h = 1e-6;
                let difference = |plus: Reached, minus: Reached| (plus.z - minus.z) / (2.0 * h);
                let risen = |dn: f64, start: f64, way: f64| LoadingCurve::new(n + dn).risen(start, way);
                let by_way = difference(risen(0.0, start, way + h), risen(0.0, start, way - h));
                assert!((there.by_way - by_way).abs() < 1e-6, "{n} {start} {way}");
                if start > h {
                    let by_start = difference(risen(0.0, start + h, way), risen(0.0, start - h, way));
                    assert!((there.by_start - by_start).abs() < 1e-6, "{n} {start} {way}");
                }
                let by_exponent = difference(risen(h, start, way), risen(-h, start, way));
                assert!((there.by_exponent - by_exponent).abs() < 1e-5, "{n} {start} {way} {by_exponent}");
            }
        }
    }
}

//! Forces that Newton's method cannot follow in the velocity: set-valued at rest, or of infinite slope there. Both are
//! answered exactly in force and velocity together, with a weight `r > 0` in N s/m that does not change the solution:
//!
//! ```text
//! set-valued   F = g(v) + clamp(F - g(v) + r v, low, high)          (Alart and Curnier 1991)
//! steep        F = f(v),  v the root of  f(v) + r v = s,  s = F + r v      (resolvent)
//! ```

/// Friction: any force from `low` to `high` at rest, `high + g(v)` where the motion goes on, `low + g(v)` where it goes back.
pub trait SetValued: Sync {
    /// Least and greatest force at rest, N.
    fn bounds(&self, p: &[f64]) -> [f64; 2];

    /// Derivative of both by parameter `k`.
    fn bounds_by(&self, p: &[f64], k: usize) -> [f64; 2];

    /// Whether there is a smooth part `g` at all.
    fn has_smooth_part(&self) -> bool {
        false
    }

    /// Smooth part `g(v)` in N with `g(0) = 0`, and its slope in N s/m.
    fn smooth_part(&self, p: &[f64], v: f64) -> [f64; 2] {
        let _ = (p, v);
        [0.0; 2]
    }

    /// Derivative of the smooth part by parameter `k`.
    fn smooth_part_by(&self, p: &[f64], k: usize, v: f64) -> f64 {
        let _ = (p, k, v);
        0.0
    }

    /// The right side above at force `force` (N), velocity `v` (m/s) and weight `r` (N s/m). It is the force itself where
    /// force and velocity are friction's.
    fn held(&self, p: &[f64], force: f64, v: f64, r: f64) -> f64 {
        let ([low, high], [g, _]) = (self.bounds(p), self.smooth_part(p, v));
        g + (force - g + r * v).max(low).min(high.max(low))
    }
}

/// A force `f(v)` of velocity alone that rises with it, of infinite slope at rest.
pub trait Steep: Sync {
    /// Speed `v >= 0` in m/s at which `f(v) + r v = s`, for `s >= 0` in N.
    fn speed(&self, p: &[f64], r: f64, s: f64) -> f64;

    /// Slope `f'(v)` in N s/m at a speed `v >= 0`; infinite at rest.
    fn slope(&self, p: &[f64], speed: f64) -> f64;

    /// Derivative of `f` by parameter `k` at a speed `v >= 0`.
    fn by(&self, p: &[f64], k: usize, speed: f64) -> f64;
}

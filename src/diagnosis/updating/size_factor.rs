//! Factors of updating parameters: of stiffnesses and masses `e^v`, of the size of a known source that may be absent, as a function of its
//! parameter `v`,
//!
//! ```text
//! f(v) = e^v             v >= 0
//!        1 + v           0 > v > -(1 - r)
//!        r e^((v + 1 - r) / r)       below,      r = 0.1
//! ```
//!
//! A source may be stated that is not there: damping that was measured at small amplitudes, or as that of a mode, is often all of a joint
//! that is modelled as an effect then. With the logarithm of the factor its absence would be infinitely far from what is stated; here it
//! is about `1 / s` prior deviations away, and sizes stay positive. Within a tenth both are the same to half a per cent.

use super::parameters::{Updating, UpdatingParameter};

/// Factor below which it falls exponentially: what is left then damps next to nothing, and any small one does.
const REST: f64 = 0.1;
/// Largest exponent: models are not wrong by more than a factor of seven.
const LARGEST: f64 = 2.0;
/// Least value: a share of `REST e^-4`, two thousandths, is left.
const LEAST: f64 = -(1.0 - REST) - 4.0 * REST;

impl Updating {
    /// Factor of parameter `k`, of stiffnesses, masses and sizes, as the updated model has it.
    pub(crate) fn factor(&self, k: usize) -> f64 {
        if self.size_may_vanish(k) {
            return factor(self.values[k]);
        }
        self.values[k].clamp(-LARGEST, LARGEST).exp()
    }

    /// Derivative of the logarithm of that factor.
    pub(crate) fn relative_slope(&self, k: usize) -> f64 {
        if self.size_may_vanish(k) { relative_slope(self.values[k]) } else { 1.0 }
    }

    /// The value of parameter `k` whose factor is `factor`.
    pub(crate) fn value_of(&self, k: usize, factor: f64) -> f64 {
        if self.size_may_vanish(k) { value(factor) } else { factor.ln() }
    }

    /// Whether parameter `k` is the size of a source that may be absent.
    fn size_may_vanish(&self, k: usize) -> bool {
        matches!(self.parameters[k], UpdatingParameter::Known(j) if self.may_be_absent.contains(&j))
    }
}

/// The factor at `v`.
fn factor(v: f64) -> f64 {
    let v = v.clamp(LEAST, LARGEST);
    if v >= 0.0 {
        v.exp()
    } else if v > REST - 1.0 {
        1.0 + v
    } else {
        REST * ((v + 1.0 - REST) / REST).exp()
    }
}

/// Relative derivative `f'(v) / f(v)` of the factor.
fn relative_slope(v: f64) -> f64 {
    if v >= 0.0 { 1.0 } else { 1.0 / factor(v).max(REST) }
}

/// The value whose factor is `factor`, within its bounds.
fn value(factor: f64) -> f64 {
    if factor >= 1.0 {
        factor.ln().min(LARGEST)
    } else if factor > REST {
        factor - 1.0
    } else {
        (REST - 1.0 + REST * (factor / REST).ln()).max(LEAST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_the_inverse_and_the_slope_the_derivative_of_the_factor() {
        for v in [-1.25, -1.0, -0.899, -0.5, -1e-3, 1e-3, 0.7, 1.9] {
            assert!((value(factor(v)) - v).abs() < 1e-12, "{v}");
            let h = 1e-6;
            let slope = (factor(v + h) - factor(v - h)) / (2.0 * h);
            assert!((relative_slope(v) * factor(v) - slope).abs() < 1e-8 * slope.max(1.0), "{v}: {slope}");
        }
    }

    /// With a prior deviation of 0.5 a source that is not there is two deviations away and a half.
    #[test]
    fn a_source_may_be_absent_and_its_size_stays_positive() {
        assert!(factor(-1.2) < 0.006 && factor(-9.0) > 0.0 && factor(9.0) == 2.0_f64.exp());
        assert!(value(0.0) == LEAST && value(0.9) == 0.9 - 1.0 && value(1e9) == LARGEST);
    }
}

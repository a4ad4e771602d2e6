//! Integrals of the exponential over a step, without loss of digits for small arguments.
//!
//! ```text
//! phi_1(x) = (e^x - 1) / x,    phi_2(x) = (e^x - 1 - x) / x^2,    (e^a - e^b) / (a - b) = e^((a+b)/2) sinh(c) / c,  c = (a-b)/2
//! ```

use faer::c64;

/// Argument below which the series is summed.
const SMALL: f64 = 0.5;

/// `1/k! + x/(k+1)! + x^2/(k+2)! + ...`
fn series(x: c64, k: u32) -> c64 {
    let first: f64 = (1..=k).map(f64::from).product::<f64>().recip();
    let mut term = c64::new(first, 0.0);
    let mut sum = term;
    for j in 1..=18 {
        term = term * x / f64::from(k + j);
        sum += term;
    }
    sum
}

/// `(e^x - 1) / x`.
pub(super) fn phi1(x: c64) -> c64 {
    if x.norm() < SMALL { series(x, 1) } else { (x.exp() - 1.0) / x }
}

/// `(e^x - 1 - x) / x^2`.
pub(super) fn phi2(x: c64) -> c64 {
    if x.norm() < SMALL { series(x, 2) } else { (x.exp() - 1.0 - x) / (x * x) }
}

/// `(e^a - e^b) / (a - b)`.
pub(super) fn divided(a: c64, b: c64) -> c64 {
    let half = 0.5 * (a - b);
    if half.norm() < SMALL {
        let square = half * half;
        let (mut term, mut sum) = (c64::new(1.0, 0.0), c64::new(1.0, 0.0));
        for j in 1..=8 {
            let n = f64::from(2 * j);
            term = term * square / (n * (n + 1.0));
            sum += term;
        }
        return (0.5 * (a + b)).exp() * sum;
    }
    (a.exp() - b.exp()) / (a - b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_quotients_meet() {
        for angle in [0.3, 1.9, 3.0] {
            let at = |r: f64| c64::new(r * f64::cos(angle), r * f64::sin(angle));
            for f in [phi1, phi2] {
                let jump = f(at(0.499_999_999)) - f(at(0.500_000_001));
                assert!(jump.norm() < 1e-8);
            }
            let b = c64::new(-0.2, 4.0);
            let jump = divided(b + at(0.999_999_999), b) - divided(b + at(1.000_000_001), b);
            assert!(jump.norm() < 1e-8);
            assert!((divided(b, b) - b.exp()).norm() < 1e-15);
        }
    }
}

//! Integrals of the exponential over a step, without loss of digits for small arguments.
//!
//! ```text
//! phi_1(x) = (e^x - 1) / x,    phi_2(x) = (e^x - 1 - x) / x^2,    (e^a - e^b) / (a - b) = e^((a+b)/2) sinh(c) / c,  c = (a-b)/2
//! ```

use faer::c64;

/// Argument below which the series is summed.
const SMALL: f64 = 0.5;

/// `1 / (k + 2)!` for `k` of 0 to 15.
const SERIES: [f64; 16] = {
    let mut list = [0.5; 16];
    let mut k = 1;
    while k < 16 {
        list[k] = list[k - 1] / (k as f64 + 2.0);
        k += 1;
    }
    list
};

/// `e^x`, `phi_1(x)` and `phi_2(x)`.
pub(super) fn integrals(x: c64) -> [c64; 3] {
    if x.norm_sqr() < SMALL * SMALL {
        let last = SERIES.len() - 1;
        let phi2 = SERIES[..last].iter().rev().fold(c64::new(SERIES[last], 0.0), |sum, c| sum * x + *c);
        let phi1 = phi2 * x + 1.0;
        return [phi1 * x + 1.0, phi1, phi2];
    }
    let e = x.exp();
    let phi1 = (e - 1.0) / x;
    [e, phi1, (phi1 - 1.0) / x]
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
            let argument = |r: f64| c64::new(r * f64::cos(angle), r * f64::sin(angle));
            for k in 0..3 {
                let jump = integrals(argument(0.499_999_999))[k] - integrals(argument(0.500_000_001))[k];
                assert!(jump.norm() < 1e-8);
            }
            let b = c64::new(-0.2, 4.0);
            let jump = divided(b + argument(0.999_999_999), b) - divided(b + argument(1.000_000_001), b);
            assert!(jump.norm() < 1e-8);
            assert!((divided(b, b) - b.exp()).norm() < 1e-15);
        }
    }
}

//! Integrals of the exponential over a step, without loss of digits for small arguments.
//!
//! ```text
//! phi_0(x) = e^x,    phi_k+1(x) = (phi_k(x) - 1 / k!) / x = int_0^1 e^(x (1 - t)) t^k / k! dt
//! phi_k[a, b] = (phi_k(a) - phi_k(b)) / (a - b) = int_0^1 e^(a (1 - t)) t^k phi_k(b t) dt
//! ```
//!
//! (Hochbruck and Ostermann, "Exponential integrators", Acta Numerica 19, 2010, section 2.)

use super::hold::ORDERS;
use faer::c64;

/// Functions that are made.
pub(super) const FUNCTIONS: usize = ORDERS + 2;
/// Argument below which the series is summed.
const SMALL: f64 = 2.0;
/// Distance of two arguments below which their divided difference is integrated.
const NEAR: f64 = 0.5;
/// Terms of the series: `2^27 / 34!` is below a part in 10^30 of its sum.
const TERMS: usize = 28;

/// `1 / k!`.
const INVERSE_FACTORIALS: [f64; FUNCTIONS + TERMS] = {
    let mut list = [1.0; FUNCTIONS + TERMS];
    let mut k = 1;
    while k < FUNCTIONS + TERMS {
        list[k] = list[k - 1] / k as f64;
        k += 1;
    }
    list
};

/// Nodes and weights of Gauss and Legendre's rule of six points on `[0, 1]`.
const NODES: [[f64; 2]; 6] = [
    [0.033_765_242_898_423_99, 0.085_662_246_189_585_17],
    [0.169_395_306_766_867_74, 0.180_380_786_524_069_3],
    [0.380_690_406_958_401_55, 0.233_956_967_286_345_52],
    [0.619_309_593_041_598_5, 0.233_956_967_286_345_52],
    [0.830_604_693_233_132_3, 0.180_380_786_524_069_3],
    [0.966_234_757_101_576, 0.085_662_246_189_585_17],
];

/// `phi_0(x)` and those that follow.
pub(super) fn phi(x: c64) -> [c64; FUNCTIONS] {
    let mut list = [c64::new(0.0, 0.0); FUNCTIONS];
    let last = FUNCTIONS - 1;
    if x.norm_sqr() < SMALL * SMALL {
        let series = &INVERSE_FACTORIALS[last..last + TERMS];
        list[last] = series.iter().rev().fold(c64::new(0.0, 0.0), |sum, c| sum * x + *c);
        for k in (0..last).rev() {
            list[k] = list[k + 1] * x + INVERSE_FACTORIALS[k];
        }
    } else {
        list[0] = x.exp();
        for k in 0..last {
            list[k + 1] = (list[k] - INVERSE_FACTORIALS[k]) / x;
        }
    }
    list
}

/// Divided differences of `phi_0` to the last but one.
pub(super) fn divided(a: c64, b: c64) -> [c64; FUNCTIONS - 1] {
    if (a - b).norm_sqr() > NEAR * NEAR {
        let (at_a, at_b) = (phi(a), phi(b));
        return std::array::from_fn(|k| (at_a[k] - at_b[k]) / (a - b));
    }
    let mut sum = [c64::new(0.0, 0.0); FUNCTIONS - 1];
    for [node, weight] in NODES {
        // The derivative of phi_k is phi_k - k phi_k+1.
        let at_node = phi(b + (a - b) * node);
        for (k, sum) in sum.iter_mut().enumerate() {
            *sum += (at_node[k] - at_node[k + 1] * k as f64) * weight;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By quadrature of the defining integral, `[k]` of 1 on.
    fn by_quadrature(x: c64, k: i32) -> c64 {
        let panels = 40;
        let mut sum = c64::new(0.0, 0.0);
        for panel in 0..panels {
            for [node, weight] in NODES {
                let t = (f64::from(panel) + node) / f64::from(panels);
                sum += (x * (1.0 - t)).exp() * t.powi(k - 1) * weight / f64::from(panels);
            }
        }
        sum * INVERSE_FACTORIALS[k as usize - 1]
    }

    #[test]
    fn they_are_the_integrals() {
        for (size, angle) in [(1e-6, 1.0), (0.4, 0.3), (1.99, 1.9), (2.01, 1.9), (6.0, 3.1), (12.0, 1.6)] {
            let x = c64::new(size * f64::cos(angle), size * f64::sin(angle));
            for k in 1..FUNCTIONS {
                let (found, expected) = (phi(x)[k], by_quadrature(x, k as i32));
                assert!((found - expected).norm() < 1e-12 * expected.norm(), "{x} {k}: {found} {expected}");
            }
        }
    }

    #[test]
    fn divided_differences_meet_where_the_way_changes() {
        for angle in [0.3, 1.9, 3.0] {
            let argument = |r: f64| c64::new(r * f64::cos(angle), r * f64::sin(angle));
            let b = c64::new(-0.2, 4.0);
            let (near, far) = (divided(b + argument(0.499_999_999), b), divided(b + argument(0.500_000_001), b));
            for k in 0..FUNCTIONS - 1 {
                assert!((near[k] - far[k]).norm() < 1e-8 * near[k].norm(), "{k}");
            }
            assert!((divided(b, b)[0] - b.exp()).norm() < 1e-14);
        }
    }
}

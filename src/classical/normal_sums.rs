//! Reduced normal matrices of the poly-reference estimator for all its orders from one pass over the lines.
//!
//! With `|z| = 1` a product of two terms depends on the difference of their powers alone:
//!
//! ```text
//! R_ab = r(b - a)              r(d) = Re sum_k w_k z_k^d
//! S_a,qj = -s_j(q - a)         s_j(d) = Re sum_k w_k z_k^d H_j
//! T_pi,qj = t_ij(q - p)        t_ij(d) = Re sum_k w_k z_k^d conj(H_i) H_j,  t_ij(-d) = t_ji(d)
//! ```

use super::error::ClassicalError;
use super::refine::Band;
use crate::math::fill::filled;
use crate::math::least_squares::solve_symmetric;
use faer::{Mat, c64};
use std::f64::consts::PI;

/// The sums of one output.
struct Output {
    /// `r(d)`, d from 0.
    r: Vec<f64>,
    /// `s_j(d)`, d from `-most`, drives fastest.
    s: Vec<f64>,
    /// `t_ij(d)`, d from 0, then j, then i.
    t: Vec<f64>,
}

/// The sums of a band up to an order.
pub(super) struct NormalSums {
    drives: usize,
    most: usize,
    outputs: Vec<Output>,
}

impl NormalSums {
    /// Over all lines of `band`, whose instants on the unit circle are at these angles, up to the order `most`.
    pub(super) fn new(band: &Band, angles: &[f64], most: usize) -> Self {
        let outputs = (0..band.sensors()).map(|output| Output::new(band, output, angles, most)).collect();
        Self { drives: band.drives(), most, outputs }
    }

    /// `M = sum_o (T_o - S_o^T R_o^-1 S_o)` of one order, m (order + 1) square.
    ///
    /// # Errors
    /// Those of the linear algebra.
    pub(super) fn reduced(&self, order: usize) -> Result<Mat<f64>, ClassicalError> {
        let (m, terms) = (self.drives, order + 1);
        let mut normal = Mat::<f64>::zeros(m * terms, m * terms);
        for output in &self.outputs {
            let r = filled(terms, terms, |a, b| output.r[a.abs_diff(b)]);
            let s = filled(terms, m * terms, |a, c| -output.s[(self.most + c / m - a) * m + c % m]);
            let solved = solve_symmetric(r.as_ref(), s.as_ref())?;
            normal += filled(m * terms, m * terms, |p, q| output.product(m, [p, q]));
            normal -= s.transpose() * solved;
        }
        Ok(normal)
    }
}

impl Output {
    fn new(band: &Band, output: usize, angles: &[f64], most: usize) -> Self {
        let m = band.drives();
        let mut sums =
            Self { r: vec![0.0; most + 1], s: vec![0.0; (2 * most + 1) * m], t: vec![0.0; (most + 1) * m * m] };
        for (k, angle) in angles.iter().enumerate() {
            let row: Vec<c64> = (0..m).map(|j| band.value(k, output, j)).collect();
            sums.add(&row, *angle, band.weight(k, output), most);
        }
        sums
    }

    fn add(&mut self, row: &[c64], angle: f64, weight: f64, most: usize) {
        let m = row.len();
        for d in 0..=most {
            // Turned back by a whole turn where it is large: as exact as a power of z.
            let z = c64::from_polar(weight, (d as f64 * angle).rem_euclid(2.0 * PI));
            self.r[d] += z.re;
            for (j, h) in row.iter().enumerate() {
                self.s[(most + d) * m + j] += (z * h).re;
                if d > 0 {
                    self.s[(most - d) * m + j] += (z.conj() * h).re;
                }
                let turned = z * h;
                for (i, other) in row.iter().enumerate() {
                    self.t[(d * m + j) * m + i] += other.re * turned.re + other.im * turned.im;
                }
            }
        }
    }

    /// Entry of `T`: row and column are power times the number of drives plus drive.
    fn product(&self, m: usize, [p, q]: [usize; 2]) -> f64 {
        let ([first, i], [second, j]) = ([p / m, p % m], [q / m, q % m]);
        if second >= first {
            self.t[((second - first) * m + j) * m + i]
        } else {
            self.t[((first - second) * m + i) * m + j]
        }
    }
}

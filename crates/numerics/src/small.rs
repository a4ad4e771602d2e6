//! LU factors of matrices of some tens to some hundreds of rows, where a general library's set-up would cost more than
//! the work. The loops run in the widest vector instructions that the machine has.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the wide instructions")]

use crate::lanes::{Wide, dot, widest};

/// `P A = L U` of a real square matrix, stored row by row.
#[derive(Debug, Clone)]
pub struct RowLu {
    size: usize,
    factors: Vec<f64>,
    order: Vec<usize>,
    sign: f64,
}

impl RowLu {
    /// Factors of the `size x size` matrix given row by row; `None` if it is singular or not finite.
    pub fn new(size: usize, matrix: Vec<f64>) -> Option<Self> {
        widest(Factors(size, matrix))
    }

    /// Replaces `rhs` by the solution.
    pub fn solve(&self, rhs: &mut [f64]) {
        widest(Substitute(self, rhs));
    }

    /// Sign of the determinant, -1 or 1.
    pub fn sign(&self) -> f64 {
        (0..self.size).fold(self.sign, |s, i| s * self.factors[i * self.size + i].signum())
    }
}

struct Factors(usize, Vec<f64>);

impl Wide for Factors {
    type Output = Option<RowLu>;

    #[inline(always)]
    fn call(self) -> Option<RowLu> {
        factors(self.0, self.1)
    }
}

struct Substitute<'a>(&'a RowLu, &'a mut [f64]);

impl Wide for Substitute<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        substitute(self.0, self.1);
    }
}

#[inline(always)]
fn factors(n: usize, mut a: Vec<f64>) -> Option<RowLu> {
    if !a.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut order: Vec<usize> = (0..n).collect();
    let mut sign = 1.0;
    for k in 0..n {
        let mut pivot = (k, 0.0_f64);
        for i in k..n {
            let size = a[i * n + k].abs();
            if size > pivot.1 {
                pivot = (i, size);
            }
        }
        if pivot.1 == 0.0 {
            return None;
        }
        if pivot.0 != k {
            order.swap(pivot.0, k);
            sign = -sign;
            let (above, below) = a.split_at_mut(pivot.0 * n);
            above[k * n..(k + 1) * n].swap_with_slice(&mut below[..n]);
        }
        let (above, below) = a.split_at_mut((k + 1) * n);
        let row = &above[k * n..];
        let inverse = 1.0 / row[k];
        for lower in below.chunks_exact_mut(n) {
            let factor = lower[k] * inverse;
            lower[k] = factor;
            if factor != 0.0 {
                for (x, y) in lower[k + 1..].iter_mut().zip(&row[k + 1..]) {
                    *x -= factor * y;
                }
            }
        }
    }
    Some(RowLu { size: n, factors: a, order, sign })
}

#[inline(always)]
fn substitute(lu: &RowLu, rhs: &mut [f64]) {
    let n = lu.size;
    let given: Vec<f64> = lu.order.iter().map(|&i| rhs[i]).collect();
    rhs.copy_from_slice(&given);
    for i in 1..n {
        let (known, rest) = rhs.split_at_mut(i);
        rest[0] -= dot(&lu.factors[i * n..i * n + i], known);
    }
    for i in (0..n).rev() {
        let row = &lu.factors[i * n..(i + 1) * n];
        let (head, known) = rhs.split_at_mut(i + 1);
        head[i] = (head[i] - dot(&row[i + 1..], known)) / row[i];
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn factors_solve_and_say_the_sign() {
        for n in [1, 3, 9, 40] {
            let a: Vec<f64> = (0..n * n)
                .map(|k| ((k * k + 3 * k) as f64 * 0.7).sin() + if k % (n + 1) == 0 { 2.0 } else { 0.0 })
                .collect();
            let x: Vec<f64> = (0..n).map(|i| i as f64 - 1.5).collect();
            let mut b: Vec<f64> = a.chunks_exact(n).map(|row| dot(row, &x)).collect();
            let lu = RowLu::new(n, a.clone()).unwrap();
            lu.solve(&mut b);
            assert!(b.iter().zip(&x).all(|(p, q)| (p - q).abs() < 1e-9), "{n}");
            let determinant = faer::Mat::from_fn(n, n, |i, j| a[i * n + j]).determinant();
            assert_eq!(lu.sign(), determinant.signum(), "{n}");
        }
    }

    #[test]
    fn singular_and_infinite_matrices_have_no_factors() {
        assert!(RowLu::new(2, vec![1.0, 2.0, 2.0, 4.0]).is_none());
        assert!(RowLu::new(2, vec![1.0, f64::NAN, 2.0, 4.0]).is_none());
        assert!(RowLu::new(2, vec![f64::INFINITY, 0.0, 2.0, 4.0]).is_none());
    }
}

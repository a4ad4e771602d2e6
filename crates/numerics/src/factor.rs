//! Factorisations of square matrices and solutions with them; QR of tall ones.

use faer::linalg::solvers::{Llt, PartialPivLu, Solve, SolveLstsq};
use faer::{Mat, MatMut, MatRef, Side, c64};

/// `A = L L^T` of a symmetric positive definite matrix (its lower triangle is read).
#[derive(Debug, Clone)]
pub struct Cholesky(Llt<f64>);

impl Cholesky {
    /// Factors of `a`, n x n; `None` if it is not positive definite.
    pub fn new(a: MatRef<'_, f64>) -> Option<Self> {
        a.llt(Side::Lower).ok().map(Self)
    }

    /// `L`, n x n.
    pub fn factor(&self) -> MatRef<'_, f64> {
        self.0.L()
    }

    /// `A^-1 B`.
    pub fn solve(&self, b: MatRef<'_, f64>) -> Mat<f64> {
        self.0.solve(b)
    }

    /// `ln det A`.
    pub fn log_determinant(&self) -> f64 {
        let factor = self.0.L();
        (0..factor.nrows()).map(|i| 2.0 * factor[(i, i)].ln()).sum()
    }
}

/// `P A = L U` of a real square matrix.
#[derive(Debug, Clone)]
pub struct RealLu(PartialPivLu<f64>);

impl RealLu {
    /// Factors of `a`, n x n.
    pub fn new(a: MatRef<'_, f64>) -> Self {
        Self(a.partial_piv_lu())
    }

    /// `A^-1 B`; not finite if `A` is singular.
    pub fn solve(&self, b: MatRef<'_, f64>) -> Mat<f64> {
        self.0.solve(b)
    }

    /// Replaces `b` by `A^-1 b`.
    pub fn solve_in_place(&self, b: MatMut<'_, f64>) {
        self.0.solve_in_place(b);
    }

    /// Entry `i` of the diagonal of `U`.
    pub fn pivot(&self, i: usize) -> f64 {
        self.0.U()[(i, i)]
    }

    /// Order of the rows.
    pub fn order(&self) -> &[usize] {
        self.0.P().arrays().0
    }
}

/// `P A = L U` of a complex square matrix.
#[derive(Debug, Clone)]
pub struct ComplexLu(PartialPivLu<c64>);

impl ComplexLu {
    /// Factors of `a`, n x n.
    pub fn new(a: MatRef<'_, c64>) -> Self {
        Self(a.partial_piv_lu())
    }

    /// `A^-1 B`; not finite if `A` is singular.
    pub fn solve(&self, b: MatRef<'_, c64>) -> Mat<c64> {
        self.0.solve(b)
    }
}

/// `A^-1 B` for a symmetric matrix that need not be definite, by Bunch and Kaufman.
pub fn solve_indefinite(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    a.lblt(Side::Lower).solve(b)
}

/// `A = Q R` with `Q`, m x k and `R`, k x n, k the smaller of m and n.
pub fn thin_qr(a: MatRef<'_, f64>) -> (Mat<f64>, Mat<f64>) {
    let qr = a.qr();
    (qr.compute_thin_Q(), qr.thin_R().to_owned())
}

/// `R` of [`thin_qr`].
pub fn triangle(a: MatRef<'_, f64>) -> Mat<f64> {
    a.qr().thin_R().to_owned()
}

/// The solution of least residual of `A X = B`, `A` tall with independent columns.
pub fn least_squares(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    a.qr().solve_lstsq(b)
}

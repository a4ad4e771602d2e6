//! The last two levels of the tree at once. After the columns already chosen are projected out, a pair (p, j) with normal
//! matrix `G` and right-hand side `g` lowers the squared residual by
//!
//! ```text
//! (g_p^2 G_jj - 2 g_p g_j G_pj + g_j^2 G_pp) / (G_pp G_jj - G_pj^2)
//! ```
//!
//! with coefficients of the signs of `g_p G_jj - g_j G_pj` and `g_j G_pp - g_p G_pj`: a few multiplications a pair. What
//! passes is solved anew by orthogonal factorisation, so that rounding here costs time but never an answer.

/// Squared sine of the angle to the chosen columns under which a column depends on them: such a set does no better than
/// a smaller one.
const DEPENDENT: f64 = 1e-12;

/// Pairs looked at in one go.
const LANES: usize = 8;

/// Normal matrix of the columns not yet chosen, after the chosen ones are projected out.
#[derive(Debug, Clone)]
pub(super) struct Schur {
    pub columns: Vec<usize>,
    stride: usize,
    gram: Vec<f64>,
    diagonal: Vec<f64>,
    g: Vec<f64>,
    /// Squared residual of unbounded least squares on the chosen columns.
    pub squared_residual: f64,
    /// Growth of rounding by the projections.
    noise: f64,
}

impl Schur {
    pub(super) fn new(columns: Vec<usize>, n: usize, gram: &[f64], h: &[f64]) -> Self {
        let stride = columns.len();
        let product = |i: usize, j: usize| gram[columns[i] * n + columns[j]];
        Self {
            gram: (0..stride * stride).map(|k| product(k / stride, k % stride)).collect(),
            diagonal: (0..stride).map(|i| product(i, i)).collect(),
            g: columns.iter().map(|&j| h[j]).collect(),
            columns,
            stride,
            squared_residual: 1.0,
            noise: 4.0 * f64::EPSILON,
        }
    }

    pub(super) fn position(&self, column: usize) -> Option<usize> {
        self.columns.iter().position(|&j| j == column)
    }

    /// Projects column number `p` of this matrix out and drops it and what then depends on it; `None` if it is itself
    /// dependent.
    pub(super) fn choose(&self, p: usize) -> Option<Self> {
        let pivot = self.diagonal[p];
        if pivot <= DEPENDENT {
            return None;
        }
        let row = self.row(p);
        let kept: Vec<usize> = (0..self.columns.len())
            .filter(|&i| i != p && self.diagonal[i] - row[i] * row[i] / pivot > DEPENDENT)
            .collect();
        let stride = kept.len();
        let mut gram = vec![0.0; stride * stride];
        for (a, &i) in kept.iter().enumerate() {
            let (factor, from) = (row[i] / pivot, self.row(i));
            for (value, &j) in gram[a * stride..(a + 1) * stride].iter_mut().zip(&kept) {
                *value = from[j] - factor * row[j];
            }
        }
        Some(Self {
            columns: kept.iter().map(|&i| self.columns[i]).collect(),
            diagonal: (0..stride).map(|a| gram[a * stride + a]).collect(),
            g: kept.iter().map(|&i| self.g[i] - row[i] * self.g[p] / pivot).collect(),
            stride,
            gram,
            squared_residual: (self.squared_residual - self.g[p] * self.g[p] / pivot).max(0.0),
            noise: self.noise + 4.0 * f64::EPSILON / pivot,
        })
    }

    /// Drops a column without choosing it; the last one takes its place.
    pub(super) fn discard(&mut self, p: usize) {
        let last = self.columns.len() - 1;
        let s = self.stride;
        for k in 0..=last {
            self.gram[k * s + p] = self.gram[k * s + last];
        }
        self.gram.copy_within(last * s..last * s + last, p * s);
        self.diagonal.swap_remove(p);
        self.columns.swap_remove(p);
        self.g.swap_remove(p);
        if p < last {
            self.gram[p * s + p] = self.diagonal[p];
        }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.gram[i * self.stride..i * self.stride + self.columns.len()]
    }

    /// Number of the column that lowers the squared residual most with a positive coefficient.
    pub(super) fn best_single(&self) -> Option<usize> {
        let gain = |i: usize| self.g[i] * self.g[i] / self.diagonal[i];
        (0..self.columns.len())
            .filter(|&i| self.g[i] > 0.0 && self.diagonal[i] > 0.0)
            .max_by(|&i, &j| gain(i).total_cmp(&gain(j)))
    }

    /// Every single column that may bring the squared residual down to `goal`.
    pub(super) fn singles(&self, goal: f64, signs: bool) -> Vec<usize> {
        let gain = self.squared_residual - goal;
        let allowance = self.allowance();
        let passes = |i: usize| {
            self.g[i] * self.g[i] + allowance >= gain * self.diagonal[i] && (self.g[i] > -allowance || !signs)
        };
        (0..self.columns.len()).filter(|&i| passes(i)).map(|i| self.columns[i]).collect()
    }

    /// Calls `found` with every pair that may bring the squared residual down to `goal`, with positive coefficients if
    /// `signs`. `found` returns the goal from there on.
    pub(super) fn pairs<E>(
        &self,
        mut goal: f64,
        signs: bool,
        mut found: impl FnMut(usize, usize) -> Result<f64, E>,
    ) -> Result<(), E> {
        let count = self.columns.len();
        let sign_slack = if signs { self.allowance() } else { f64::INFINITY };
        for p in 0..count {
            let scan = Scan { g: self.g[p], d: self.diagonal[p], allowance: self.allowance(), sign_slack };
            let row = self.row(p);
            let mut j = p + 1;
            while j < count {
                let end = (j + LANES).min(count);
                let gain = self.squared_residual - goal;
                if scan.any(gain, &row[j..end], &self.diagonal[j..end], &self.g[j..end]) {
                    for q in j..end {
                        if scan.any(self.squared_residual - goal, &row[q..=q], &self.diagonal[q..=q], &self.g[q..=q]) {
                            goal = found(self.columns[p], self.columns[q])?;
                        }
                    }
                }
                j = end;
            }
        }
        Ok(())
    }

    /// Rounding of the products above.
    fn allowance(&self) -> f64 {
        self.noise * self.squared_residual.max(1e-12)
    }
}

/// One column against a run of others.
struct Scan {
    g: f64,
    d: f64,
    allowance: f64,
    sign_slack: f64,
}

impl Scan {
    /// Whether any of the pairs passes; free of branches, so that it runs on vectors.
    #[expect(clippy::needless_bitwise_bool, reason = "lazy operators would bring the branches back")]
    fn any(&self, gain: f64, row: &[f64], diagonal: &[f64], g: &[f64]) -> bool {
        let mut hit = false;
        for ((&c, &d), &g) in row.iter().zip(diagonal).zip(g) {
            let first = self.g * d - g * c;
            let second = g * self.d - self.g * c;
            let enough = self.g * first + g * second + self.allowance >= gain * (self.d * d - c * c);
            hit |= enough & (first > -self.sign_slack) & (second > -self.sign_slack);
        }
        hit
    }
}

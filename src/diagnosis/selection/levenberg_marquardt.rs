//! Levenberg and Marquardt's method for a weighted residual of unit variance, with bounds and the geodesic acceleration of Transtrum,
//! Machta and Sethna (2011).

pub(crate) mod variables;

use crate::math::least_squares::solve_symmetric;
use crate::math::statistics::sum_of_squares;
use dashpot_numerics::{Cholesky, transposed_product};
use faer::Mat;

/// Least and largest damping factor before a descent gives up.
const DAMPING: [f64; 2] = [1e-9, 1e8];

/// Added to the diagonal of a normal matrix of unit diagonal, so that its inverse exists.
const RIDGE: f64 = 1e-12;

/// Where a descent ended.
#[derive(Debug, Clone)]
pub(crate) struct Descent {
    pub theta: Vec<f64>,
    pub chi_square: f64,
    /// Residual of unit variance at `theta`.
    pub residual: Vec<f64>,
    /// Its derivative, one column a variable.
    pub jacobian: Mat<f64>,
    /// By how much the squared residual would still fall were the derivative the same everywhere.
    pub to_go: f64,
}

impl Descent {
    /// Logarithm of the share of the parameters' prior, normal with unit deviation in the variables (a factor of `e` for sizes),
    /// that the data leave: `-1/2 ln det(J^T J + 1)`.
    pub(crate) fn log_volume(&self) -> f64 {
        let mut normal = transposed_product(self.jacobian.as_ref(), self.jacobian.as_ref());
        (0..normal.nrows()).for_each(|k| normal[(k, k)] += 1.0);
        Cholesky::new(normal.as_ref()).map_or(0.0, |factor| -0.5 * factor.log_determinant())
    }

    /// Standard deviations of the variables for a residual of unit variance; infinite where the data say nothing, very
    /// large where they cannot tell variables apart. A variable that does nothing leaves those of the others alone.
    pub(crate) fn deviations(&self) -> Vec<f64> {
        let n = self.theta.len();
        let normal = transposed_product(self.jacobian.as_ref(), self.jacobian.as_ref());
        let sizes: Vec<f64> = (0..n).map(|i| normal[(i, i)].max(0.0).sqrt()).collect();
        let largest = sizes.iter().fold(0.0_f64, |m, &s| m.max(s));
        let seen: Vec<usize> = (0..n).filter(|&i| sizes[i] > 1e-9 * largest && sizes[i].is_finite()).collect();
        let scaled = Mat::from_fn(seen.len(), seen.len(), |a, b| {
            let (i, j) = (seen[a], seen[b]);
            normal[(i, j)] / (sizes[i] * sizes[j]) + if a == b { RIDGE } else { 0.0 }
        });
        let mut deviations = vec![f64::INFINITY; n];
        if let Ok(inverse) = solve_symmetric(scaled.as_ref(), Mat::<f64>::identity(seen.len(), seen.len()).as_ref()) {
            for (a, &i) in seen.iter().enumerate() {
                deviations[i] = inverse[(a, a)].max(0.0).sqrt() / sizes[i];
            }
        }
        deviations
    }
}

/// A residual as a function of the variables.
pub(crate) trait Residual {
    /// Error that stops the descent.
    type Error;
    /// Residual of unit variance.
    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Self::Error>;
    /// Its derivative at `theta`, where the residual is `at`.
    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Self::Error>;
    /// Whether the descent is to end where it is for want of time.
    fn is_late(&self) -> bool {
        false
    }
    /// Least and largest value of the first variables; those that follow are free.
    fn bounds(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }
    /// Gain of the squared residual, in units of what is left per datum, below which the descent has arrived.
    fn enough(&self) -> f64 {
        ARRIVED
    }
    /// Squared residual above which where the descent would end is of no interest.
    fn most(&self) -> f64 {
        f64::INFINITY
    }
}

/// How many times what the linear fit predicts a descent may gain where the response bends.
const BEYOND: f64 = 2.0;

/// Whether what is left, of which the linear fit is to take away `to_go`, stays above the `most` that is of interest.
pub(crate) fn stays_above(left: f64, to_go: f64, most: f64) -> bool {
    left - BEYOND * to_go > most
}

/// A descent has arrived when no more than this is to be gained, in units of the squared residual per datum.
const ARRIVED: f64 = 0.02;
/// Share of what the derivative predicts below which a step gains next to nothing.
const STUCK: f64 = 1e-3;
/// Steps in a row that gain no more than that before a descent gives up.
const IDLE: usize = 3;

/// Share of the gain that counts which a step must be predicted to bring to be tried where another has failed.
const TRIED: f64 = 0.1;

/// Longest step, in natural units (a logarithm, a prior deviation), and the damping up to which it is raised to keep within.
const LONGEST: f64 = 1.5;
const FIRM: f64 = 1.0;
/// Damping up to which steps are straight, unless a straight one has failed: beyond, the valley bends.
const STRAIGHT: f64 = 1e-2;
/// Share of a step at which its bend is measured, and largest share of the bend in the step.
const AHEAD: f64 = 0.1;
const BENT: f64 = 0.4;

/// Descends from `theta` in at most `steps` steps.
pub(crate) fn descend<R: Residual>(problem: &mut R, theta: &[f64], steps: usize) -> Result<Descent, R::Error> {
    let mut theta = theta.to_vec();
    let mut residual = problem.residual(&theta)?;
    let mut chi_square = sum_of_squares(&residual);
    let mut jacobian = problem.jacobian(&theta, &residual)?;
    let bounds = problem.bounds();
    let mut equations = Normal::new(&jacobian, &residual, &held(&bounds, &theta, &jacobian, &residual));
    let (mut damping, mut idle) = (1e-3, 0);
    for _ in 0..steps {
        let enough = problem.enough() * (chi_square / residual.len().max(1) as f64).max(1.0);
        let above = stays_above(chi_square, equations.to_go(), problem.most());
        if equations.to_go() < enough || above || problem.is_late() {
            break;
        }
        let stepped = step(problem, &theta, &residual, &jacobian, &equations, enough, &mut damping)?;
        let Some((next, after, chi)) = stepped else { break };
        let gain = chi_square - chi;
        idle = if gain < enough || gain < STUCK * equations.to_go() { idle + 1 } else { 0 };
        (theta, residual, chi_square) = (next, after, chi);
        jacobian = problem.jacobian(&theta, &residual)?;
        equations = Normal::new(&jacobian, &residual, &held(&bounds, &theta, &jacobian, &residual));
        if idle == IDLE {
            break;
        }
    }
    Ok(Descent { theta, chi_square, residual, jacobian, to_go: equations.to_go() })
}

/// Which variables are at a bound across which the residual would fall: they stay there.
fn held(bounds: &[[f64; 2]], theta: &[f64], jacobian: &Mat<f64>, residual: &[f64]) -> Vec<bool> {
    let is_held = |(k, [least, greatest]): (usize, &[f64; 2])| {
        let uphill: f64 = jacobian.col_as_slice(k).iter().zip(residual).map(|(j, r)| j * r).sum();
        theta[k] <= *least && uphill > 0.0 || theta[k] >= *greatest && uphill < 0.0
    };
    bounds.iter().enumerate().map(is_held).collect()
}

/// Normal equations of a linearised residual: `N move = g`.
struct Normal {
    matrix: Mat<f64>,
    gradient: Mat<f64>,
}

impl Normal {
    /// Of the variables that are not `held`.
    fn new(jacobian: &Mat<f64>, residual: &[f64], held: &[bool]) -> Self {
        let product = |k: usize| jacobian.col_as_slice(k).iter().zip(residual).map(|(j, r)| j * r).sum();
        let mut matrix = transposed_product(jacobian.as_ref(), jacobian.as_ref());
        let mut gradient = Mat::from_fn(jacobian.ncols(), 1, |k, _| product(k));
        for k in (0..held.len()).filter(|&k| held[k]) {
            for i in 0..matrix.nrows() {
                (matrix[(i, k)], matrix[(k, i)]) = (0.0, 0.0);
            }
            (matrix[(k, k)], gradient[(k, 0)]) = (1.0, 0.0);
        }
        Self { matrix, gradient }
    }

    /// `(N + damping diag N)^-1 g`.
    fn move_by(&self, damping: f64) -> Option<Mat<f64>> {
        self.solve(damping, &self.gradient)
    }

    /// `(N + damping diag N)^-1` of a column.
    fn solve(&self, damping: f64, column: &Mat<f64>) -> Option<Mat<f64>> {
        let n = column.nrows();
        let damped = Mat::from_fn(n, n, |i, j| {
            self.matrix[(i, j)] + if i == j { damping * self.matrix[(i, i)].max(1e-12) + 1e-12 } else { 0.0 }
        });
        solve_symmetric(damped.as_ref(), column.as_ref()).ok()
    }

    /// What the step `move`, damped so, would take from the squared residual were it linear: `g^T move + damping move^T diag N move`.
    fn predicted_reduction(&self, damping: f64, by: &Mat<f64>) -> f64 {
        let of_variable = |k: usize| by[(k, 0)] * (self.gradient[(k, 0)] + damping * self.matrix[(k, k)] * by[(k, 0)]);
        (0..by.nrows()).map(of_variable).sum()
    }

    /// `g^T N^-1 g`.
    fn to_go(&self) -> f64 {
        let Some(full) = self.move_by(DAMPING[0]) else { return f64::INFINITY };
        let gain: f64 = (0..full.nrows()).map(|k| full[(k, 0)] * self.gradient[(k, 0)]).sum();
        gain.max(0.0)
    }
}

/// The next point of a descent with its residual.
type Point = (Vec<f64>, Vec<f64>, f64);

/// A step that lowers the residual, whose value and derivative at `theta` are given; none if none does that is predicted to bring a share
/// of `enough`.
fn step<R: Residual>(
    problem: &mut R,
    theta: &[f64],
    residual: &[f64],
    jacobian: &Mat<f64>,
    equations: &Normal,
    enough: f64,
    damping: &mut f64,
) -> Result<Option<Point>, R::Error> {
    let chi_square = sum_of_squares(residual);
    let (bounds, mut failed) = (problem.bounds(), false);
    while *damping < DAMPING[1] {
        if let Some(straight) = equations.move_by(*damping) {
            if failed && equations.predicted_reduction(*damping, &straight) < TRIED * enough {
                return Ok(None);
            }
            let straight: Vec<f64> = (0..theta.len()).map(|k| -straight[(k, 0)]).collect();
            // What the data hardly know would run away, and cut short with it all the others would hardly move.
            let largest = straight.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if largest > LONGEST && *damping < FIRM {
                *damping *= 4.0;
                continue;
            }
            let share = if largest > LONGEST { LONGEST / largest } else { 1.0 };
            let moved = |by: &[f64]| -> Vec<f64> {
                let mut next: Vec<f64> = theta.iter().zip(by).map(|(x, d)| x + share * d).collect();
                next.iter_mut().zip(&bounds).for_each(|(x, [least, greatest])| *x = x.clamp(*least, *greatest));
                next
            };
            let bend = if (failed || *damping > STRAIGHT) && share == 1.0 {
                bend(problem, theta, residual, jacobian, equations, *damping, &straight)?
            } else {
                None
            };
            let next = moved(bend.as_ref().unwrap_or(&straight));
            let after = problem.residual(&next)?;
            let chi = sum_of_squares(&after);
            if chi.is_finite() && chi < chi_square {
                *damping = (*damping * 0.2).max(DAMPING[0]);
                return Ok(Some((next, after, chi)));
            }
            if share == 1.0 && (chi_square - chi).abs() < 1e-9 * chi_square {
                return Ok(None);
            }
            failed = true;
        }
        *damping *= 8.0;
    }
    Ok(None)
}

/// The step along the valley, which bends: the straight one and half the geodesic acceleration (Transtrum, Machta and
/// Sethna 2011), from the second derivative of the residual in its direction; none where that says nothing.
fn bend<R: Residual>(
    problem: &mut R,
    theta: &[f64],
    residual: &[f64],
    jacobian: &Mat<f64>,
    equations: &Normal,
    damping: f64,
    straight: &[f64],
) -> Result<Option<Vec<f64>>, R::Error> {
    let there: Vec<f64> = theta.iter().zip(straight).map(|(x, d)| x + AHEAD * d).collect();
    let after = problem.residual(&there)?;
    let slope = |i: usize| (0..theta.len()).map(|k| jacobian[(i, k)] * straight[k]).sum::<f64>();
    let second: Vec<f64> = (after.iter().zip(residual).enumerate())
        .map(|(i, (b, a))| 2.0 / AHEAD * ((b - a) / AHEAD - slope(i)))
        .collect();
    let product = |k: usize| jacobian.col_as_slice(k).iter().zip(&second).map(|(j, r)| j * r).sum();
    let column = Mat::from_fn(theta.len(), 1, |k, _| product(k));
    let Some(acceleration) = equations.solve(damping, &column) else { return Ok(None) };
    let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let half: Vec<f64> = (0..theta.len()).map(|k| -0.5 * acceleration[(k, 0)]).collect();
    let small = size(&half) <= BENT * size(straight);
    Ok(small.then(|| straight.iter().zip(&half).map(|(s, h)| s + h).collect()))
}

#[cfg(test)]
mod certified;

#[cfg(test)]
mod tests;

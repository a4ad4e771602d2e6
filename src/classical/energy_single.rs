//! Energy balance of one degree of freedom with viscous damping and friction (Liang and Feeny, 3.22-3.32):
//!
//! ```text
//! c integral v^2 dt + F integral |v| dt = integral f v dt
//! ```
//!
//! one row a run, least squares. **Needs** force and displacement in steady state; two runs of different amplitude over
//! frequency for both parameters. **Limits**: equivalent parameters of the amplitudes and frequencies measured; with one
//! harmonic the friction column is `4 |X|`, parallel to the viscous one where `w |X|` is the same in every run.

use super::error::ClassicalError;
use crate::balance::action::{Field, relative_energy};
use crate::effects::{Effect, Place, Source};
use crate::math::fill::{filled, filled_complex};
use crate::math::least_squares::LeastSquares;
use faer::c64;

/// One steady state: complex amplitudes of harmonics 1, 2, ...
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Displacement, m.
    pub displacement: Vec<c64>,
    /// Force, N.
    pub force: Vec<c64>,
}

impl SteadyState {
    /// Work of the force over one period, J.
    pub fn input(&self) -> f64 {
        super::hysteresis_loop::from_harmonics(self.omega, &self.displacement, &self.force, 1.0).area
    }

    /// `integral v^2 dt`, m^2/s: what a unit dashpot takes out.
    pub fn viscous(&self) -> f64 {
        self.taken(Effect::DASHPOT)
    }

    /// `integral |v| dt`, m: what a unit friction force takes out.
    pub fn friction(&self) -> f64 {
        self.taken(Effect::Coulomb)
    }

    /// Energy that a law of unit coefficient takes out over one period, J a unit.
    fn taken(&self, law: Effect) -> f64 {
        let numbers: Vec<usize> = (1..=self.displacement.len()).collect();
        let x = filled_complex(1, numbers.len(), |_, k| self.displacement[k]);
        let source = Source::known(law, Place::Dofs(vec![0]), &[1.0]);
        relative_energy(&source, Field { omega: self.omega, numbers: &numbers, x: &x })
    }
}

/// Parameters and their standard deviations from the residual of the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleDegree {
    /// Viscous coefficient, N s/m.
    pub c: f64,
    /// Friction force, N.
    pub friction: f64,
    /// Standard deviation of each; 0 where no row is to spare.
    pub deviation: [f64; 2],
}

/// `c` and the friction force (3.32).
///
/// # Errors
/// [`ClassicalError::Few`] below two runs; [`ClassicalError::Missing`] where the runs cannot tell the two apart.
pub fn viscous_and_friction(runs: &[SteadyState]) -> Result<SingleDegree, ClassicalError> {
    if runs.len() < 2 {
        return Err(ClassicalError::Few { what: "steady states", needed: 2, found: runs.len() });
    }
    // Rows divided by their energy: a strong run must not drown the weak ones, which hold the friction.
    let input: Vec<f64> = runs.iter().map(SteadyState::input).collect();
    let rows = filled(runs.len(), 2, |i, j| (if j == 0 { runs[i].viscous() } else { runs[i].friction() }) / input[i]);
    let problem = LeastSquares::new(rows.as_ref())?;
    if problem.condition() > 1e8 {
        let what = "runs of different velocity: friction and viscous damping take out energy in the same proportion";
        return Err(ClassicalError::Missing { what: what.to_string() });
    }
    let solution = problem.solve(&vec![1.0; runs.len()])?;
    let deviations = problem.standard_deviations(solution.variance);
    Ok(SingleDegree { c: solution.x[0], friction: solution.x[1], deviation: [deviations[0], deviations[1]] })
}

//! Dynamic stiffness of a structure with its linear sources,
//!
//! ```text
//! Z(omega) = K - omega^2 M + sum_j z_j(omega) L_j L_j^T + sum_w factor_w(omega) B_w,      Z X = F
//! ```
//!
//! with `z_j = F / D` of every law on a relative motion (viscous `i omega c`, hysteretic `i h`, Maxwell, ...) and the mass
//! or stiffness matrix `B_w` for laws over the whole structure or a range of its elements.

use crate::effects::{Basis, Kind, Law, Leg, Place, Source, WholeLaw};
use crate::structure::{Structure, SystemMatrices};
use dashpot_numerics::ComplexLu;
use faer::{Mat, c64};

/// Why a linear response cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum DynamicStiffnessError {
    #[error(
        "this structure has no mass and stiffness matrices, so it has no response: use kind beam, chain or matrices"
    )]
    NoMatrices,
    #[error("the response is not linear because of {}: use harmonic balance", laws.join(", "))]
    Nonlinear { laws: Vec<String> },
    #[error("elements {first} to {last} are asked for but the structure has {count} elements (counted from 0)")]
    Elements { first: usize, last: usize, count: usize },
    #[error("source {effect} acts on DOF row {row} but the structure has {size} (counted from 0)")]
    Row { effect: String, row: usize, size: usize },
    #[error("the force has {found} values but the structure has {size} degrees of freedom")]
    ForceSize { found: usize, size: usize },
    #[error(
        "the dynamic stiffness is singular at {frequency_hz} Hz: nothing limits the response there; add damping or move the frequency"
    )]
    Singular { frequency_hz: f64 },
    #[error("the modal sum does not hold for a rigid body mode: compute the response directly")]
    RigidBody,
    #[error(transparent)]
    Cancelled(#[from] crate::control::Cancelled),
}

enum Term {
    Leg { leg: Leg, law: &'static dyn Law, parameters: Vec<f64> },
    Whole { law: &'static dyn WholeLaw, value: f64, basis: Mat<f64> },
}

/// `Z(omega)` for any frequency. Errors of measuring channels are no part of it.
pub struct DynamicStiffness<'a> {
    matrices: &'a SystemMatrices,
    terms: Vec<Term>,
}

impl<'a> DynamicStiffness<'a> {
    /// Takes every one of `sources` at its values, whatever its state.
    ///
    /// # Errors
    /// [`DynamicStiffnessError`] for a structure without matrices, nonlinear laws, or places that do not exist.
    pub fn new(structure: &'a Structure, sources: &[Source]) -> Result<Self, DynamicStiffnessError> {
        let matrices = structure.matrices().ok_or(DynamicStiffnessError::NoMatrices)?;
        let nonlinear = sources.iter().filter(|source| !source.effect.is_linear());
        let laws: Vec<String> = nonlinear.map(|source| source.phrase(structure)).collect();
        if !laws.is_empty() {
            return Err(DynamicStiffnessError::Nonlinear { laws });
        }
        let mut terms = Vec::new();
        for source in sources {
            match source.effect.kind() {
                Kind::Relative(law) => {
                    for leg in checked_legs(structure, source)? {
                        terms.push(Term::Leg { leg, law, parameters: source.parameters.clone() });
                    }
                }
                Kind::Whole(law) => {
                    let basis = basis_matrix(structure, &source.place, law.basis())?;
                    terms.push(Term::Whole { law, value: source.parameters[0], basis });
                }
                Kind::Channel(_) => {}
            }
        }
        Ok(Self { matrices, terms })
    }

    /// Number of degrees of freedom, n.
    pub fn size(&self) -> usize {
        self.matrices.mass.nrows()
    }

    /// `Z(omega)`, n x n, complex symmetric; `omega` in rad/s.
    pub fn matrix(&self, omega: f64) -> Mat<c64> {
        let SystemMatrices { mass, stiffness } = self.matrices;
        let n = self.size();
        let mut z = Mat::from_fn(n, n, |i, j| c64::new(stiffness[(i, j)] - omega * omega * mass[(i, j)], 0.0));
        for term in &self.terms {
            term.add(omega, &mut z);
        }
        z
    }

    /// Factorises `Z(omega)` for any number of forces.
    pub fn factorise(&self, omega: f64) -> FactorisedStiffness {
        FactorisedStiffness { lu: ComplexLu::new(self.matrix(omega).as_ref()), omega, size: self.size() }
    }

    /// Complex amplitudes `X = Z^-1 F` of the displacement, m, for force amplitudes `F` in N, n values each.
    ///
    /// # Errors
    /// [`DynamicStiffnessError::Singular`] at an undamped resonance; [`DynamicStiffnessError::ForceSize`].
    pub fn solve(&self, omega: f64, force: &[c64]) -> Result<Vec<c64>, DynamicStiffnessError> {
        self.factorise(omega).solve(force)
    }
}

/// Factors of `Z` at one frequency.
pub struct FactorisedStiffness {
    lu: ComplexLu,
    omega: f64,
    size: usize,
}

impl FactorisedStiffness {
    /// `X = Z^-1 F`, n values each.
    ///
    /// # Errors
    /// As [`DynamicStiffness::solve`].
    pub fn solve(&self, force: &[c64]) -> Result<Vec<c64>, DynamicStiffnessError> {
        if force.len() != self.size {
            return Err(DynamicStiffnessError::ForceSize { found: force.len(), size: self.size });
        }
        let x = self.lu.solve(Mat::from_fn(self.size, 1, |i, _| force[i]).as_ref());
        self.checked((0..self.size).map(|i| x[(i, 0)]).collect())
    }

    /// Column `dof` of the receptance: displacements, m, for a unit force there.
    ///
    /// # Errors
    /// As [`DynamicStiffness::solve`].
    pub fn receptance_column(&self, dof: usize) -> Result<Vec<c64>, DynamicStiffnessError> {
        let mut force = vec![c64::new(0.0, 0.0); self.size];
        force[dof] = c64::new(1.0, 0.0);
        self.solve(&force)
    }

    fn checked(&self, x: Vec<c64>) -> Result<Vec<c64>, DynamicStiffnessError> {
        if x.iter().all(|v| v.re.is_finite() && v.im.is_finite()) {
            Ok(x)
        } else {
            Err(DynamicStiffnessError::Singular { frequency_hz: self.omega / std::f64::consts::TAU })
        }
    }
}

impl Term {
    fn add(&self, omega: f64, z: &mut Mat<c64>) {
        match self {
            Self::Leg { leg, law, parameters } => {
                let value = law.dynamic_stiffness(parameters, omega).unwrap_or(c64::new(0.0, 0.0));
                add_leg(z, *leg, value);
            }
            Self::Whole { law, value, basis } => {
                let factor = law.factor(*value, omega);
                for j in 0..basis.ncols() {
                    for i in 0..basis.nrows() {
                        z[(i, j)] += factor * basis[(i, j)];
                    }
                }
            }
        }
    }
}

/// Adds `value L L^T`.
pub fn add_leg<T>(matrix: &mut Mat<T>, leg: Leg, value: T)
where
    T: Copy + std::ops::AddAssign + std::ops::SubAssign,
{
    matrix[(leg.first, leg.first)] += value;
    if let Some(second) = leg.second {
        matrix[(second, second)] += value;
        matrix[(leg.first, second)] -= value;
        matrix[(second, leg.first)] -= value;
    }
}

/// The legs of a source, whose rows exist.
pub(super) fn checked_legs(structure: &Structure, source: &Source) -> Result<Vec<Leg>, DynamicStiffnessError> {
    let size = structure.len();
    let legs = source.place.legs();
    match legs.iter().flat_map(|leg| [Some(leg.first), leg.second]).flatten().find(|&row| row >= size) {
        Some(row) => Err(DynamicStiffnessError::Row { effect: source.effect.to_string(), row, size }),
        None => Ok(legs),
    }
}

/// Mass or stiffness matrix of the whole structure or of a range of its elements, which must be there (without lumped masses).
pub fn basis_matrix(structure: &Structure, place: &Place, basis: Basis) -> Result<Mat<f64>, DynamicStiffnessError> {
    let range = place.elements();
    let count = structure.elements().len();
    if let Some([first, last]) = range.filter(|[first, last]| first > last || *last >= count) {
        return Err(DynamicStiffnessError::Elements { first, last, count });
    }
    basis.matrix(structure, range).ok_or(DynamicStiffnessError::NoMatrices)
}

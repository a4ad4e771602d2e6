//! Constant matrices of the linear sources: `M x'' + C x' + (K + i H) x = f`, from which damped modes follow.

use super::dynamic_stiffness::{DynamicStiffnessError, add_leg, basis_matrix, checked_legs};
use crate::effects::{Constant, Kind, Source};
use crate::structure::Structure;
use faer::Mat;

/// The four matrices, all symmetric n x n.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearMatrices {
    /// Mass of the structure and of `mass` sources.
    pub mass: Mat<f64>,
    /// Stiffness of the structure and of `stiffness` sources.
    pub stiffness: Mat<f64>,
    /// `viscous`, `stiffness_proportional` and `mass_proportional` sources, N s/m.
    pub viscous: Mat<f64>,
    /// `hysteretic` and `loss_factor` sources, N/m.
    pub hysteretic: Mat<f64>,
    /// Indices of the sources that no constant matrix describes: nonlinear laws, `maxwell`, `fractional`.
    pub others: Vec<usize>,
}

impl LinearMatrices {
    /// Assembles the sources at their values, whatever their state. Errors of channels are passed over.
    ///
    /// # Errors
    /// [`DynamicStiffnessError`] for a structure without matrices or places that do not exist.
    pub fn new(structure: &Structure, sources: &[Source]) -> Result<Self, DynamicStiffnessError> {
        let n = structure.len();
        let base = structure.matrices().ok_or(DynamicStiffnessError::NoMatrices)?;
        let mut all = Self {
            mass: base.mass.clone(),
            stiffness: base.stiffness.clone(),
            viscous: Mat::zeros(n, n),
            hysteretic: Mat::zeros(n, n),
            others: Vec::new(),
        };
        for (index, source) in sources.iter().enumerate() {
            let target = match source.effect.constant() {
                Some(Constant::Mass) => &mut all.mass,
                Some(Constant::Stiffness) => &mut all.stiffness,
                Some(Constant::Viscous) => &mut all.viscous,
                Some(Constant::Hysteretic) => &mut all.hysteretic,
                None if source.effect.is_of_channel() => continue,
                None => {
                    all.others.push(index);
                    continue;
                }
            };
            *target += unit_matrix(structure, source)? * faer::Scale(source.coefficient());
        }
        Ok(all)
    }
}

/// The matrix of a linear source of unit coefficient: `sum L L^T` over its legs, or the basis matrix of a
/// whole-structure law; n x n.
///
/// # Errors
/// [`DynamicStiffnessError`] for a structure without matrices (whole-structure laws only) or places that do not exist.
pub fn unit_matrix(structure: &Structure, source: &Source) -> Result<Mat<f64>, DynamicStiffnessError> {
    if let Kind::Whole(law) = source.effect.kind() {
        return basis_matrix(structure, &source.place, law.basis());
    }
    let mut sum = Mat::zeros(structure.len(), structure.len());
    for leg in checked_legs(structure, source)? {
        add_leg(&mut sum, leg, 1.0);
    }
    Ok(sum)
}

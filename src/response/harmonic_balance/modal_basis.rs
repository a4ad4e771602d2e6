//! Undamped modes of the structure, in which its receptance is a sum.

use super::error::ModelError;
use crate::structure::SystemMatrices;
use crate::structure::modes::modes;
use faer::{Mat, c64};

/// Undamped modes of the structure, `phi^T M phi = 1`.
#[derive(Debug)]
pub(crate) struct ModalBasis {
    /// Squares of the natural circular frequencies, rad^2/s^2.
    pub squares: Vec<f64>,
    /// Mode shapes, n x n, one a column.
    pub shapes: Mat<f64>,
}

impl ModalBasis {
    /// Number of modes.
    pub(crate) fn len(&self) -> usize {
        self.squares.len()
    }

    /// Square of the natural circular frequency of mode `r`.
    pub(crate) fn square(&self, r: usize) -> f64 {
        self.squares[r]
    }

    /// Shape of mode `r`, n.
    pub(crate) fn shape(&self, r: usize) -> &[f64] {
        self.shapes.col_as_slice(r)
    }

    pub(crate) fn combine(&self, modal: impl Iterator<Item = c64>, result: &mut [c64]) {
        for (r, q) in modal.enumerate() {
            for (x, shape) in result.iter_mut().zip(self.shapes.col_as_slice(r)) {
                *x += q * *shape;
            }
        }
    }
}

/// Undamped modes, `phi^T M phi = 1`.
pub(crate) fn modal_basis(matrices: &SystemMatrices) -> Result<ModalBasis, ModelError> {
    let modes = modes(matrices).map_err(|error| ModelError::NoModes { reason: error.to_string() })?;
    Ok(ModalBasis { squares: modes.omega.iter().map(|w| w * w).collect(), shapes: modes.shapes })
}

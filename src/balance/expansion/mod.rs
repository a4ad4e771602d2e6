//! From the sensors to all DOFs: `X_h = E_h Y_h + B_h F_h`, linear in what was measured, so that its covariance can be
//! carried along.

mod dynamic;
mod expanded;
mod map;
mod modal;
pub(crate) mod modal_model;
mod points;

pub use expanded::{Acting, Expanded};
pub use map::Map;

use super::error::BalanceError;
use super::measured::Measured;
use super::settings::Expansion;
use crate::structure::Structure;
use modal_model::ModalModel;

/// Expands runs of one structure by one method.
#[derive(Debug, Clone)]
pub struct Expander<'a> {
    structure: &'a Structure,
    method: Expansion,
    model: Option<ModalModel>,
}

impl<'a> Expander<'a> {
    /// Prepares a method for `runs`; `Auto` becomes `Dynamic` where there are mass and stiffness, else `None`.
    ///
    /// # Errors
    /// [`BalanceError::NoMatrices`] and [`BalanceError::Modes`].
    pub fn new(structure: &'a Structure, method: Expansion, runs: &[Measured]) -> Result<Self, BalanceError> {
        let method = match method {
            Expansion::Auto if structure.matrices().is_some() => Expansion::Dynamic,
            Expansion::Auto => Expansion::None,
            other => other,
        };
        let model = if method == Expansion::None {
            None
        } else if structure.matrices().is_none() {
            return Err(BalanceError::NoMatrices { method: name(method) });
        } else {
            let highest = runs.iter().map(|m| m.frequency(m.harmonics() - 1)).fold(0.0, f64::max);
            let places = runs.iter().flat_map(|m| m.forces.dofs.iter().chain(&m.sensors.dofs));
            Some(ModalModel::new(structure, highest, places.copied().collect())?)
        };
        Ok(Self { structure, method, model })
    }

    /// The method in use, never `Auto`.
    pub fn method(&self) -> Expansion {
        self.method
    }

    /// The modal model, unless the method is `None`.
    pub fn model(&self) -> Option<&ModalModel> {
        self.model.as_ref()
    }

    /// Expands one run.
    ///
    /// # Errors
    /// [`BalanceError::ModeUnseen`] for the modal methods.
    pub fn expand(&self, measured: &Measured, acting: Acting<'_>) -> Result<Expanded, BalanceError> {
        match (&self.model, self.method) {
            (Some(model), Expansion::SingleMode) => modal::expand(model, measured, 1),
            (Some(model), Expansion::Modes) => modal::expand(model, measured, usize::MAX),
            (Some(model), _) => Ok(dynamic::expand(self.structure, model, measured, acting)),
            (None, _) => Ok(points::expand(self.structure.len(), measured)),
        }
    }
}

/// Name of a method in project files.
pub fn name(method: Expansion) -> &'static str {
    match method {
        Expansion::Auto => "auto",
        Expansion::None => "none",
        Expansion::SingleMode => "single-mode",
        Expansion::Modes => "modes",
        Expansion::Dynamic => "dynamic",
    }
}

//! Runs of a structure on a moving base: their base channels become forces ([`crate::measurement::base`],
//! [`crate::measurement::base_in_time`]).

use super::error::{ProjectError, TableProblem};
use super::file::BaseResponse;
use super::plan::Plan;
use crate::measurement::base::{AXES, Base, driven};
use crate::measurement::base_in_time::driven_in_time;
use crate::measurement::{Channel, Quantity, Run, TransientRun};
use crate::structure::Structure;
use std::sync::Arc;

/// How a structure takes a motion of its base along an axis (0 to 2); `None` without a mass matrix.
pub(crate) fn base(structure: &Structure, axis: usize) -> Option<Base> {
    let loads = structure.base_load(axis)?.into_iter().enumerate().filter(|(_, load)| *load != 0.0);
    let loads = loads.map(|(dof, load)| (dof, structure.label(dof).to_owned(), load)).collect();
    Some(Base { label: AXES[axis].to_owned(), loads, along: structure.carried_by_base(axis) })
}

impl Plan {
    /// The run with its base channels turned into forces and its motions relative to the base; as it is without any.
    ///
    /// # Errors
    /// [`TableProblem::BaseWithoutMass`] for a structure without mass.
    pub fn on_its_base(&self, index: Option<usize>, mut run: Run) -> Result<Run, ProjectError> {
        let moving = run.fit.channels.iter().filter(|c| c.channel.quantity == Quantity::Base);
        let axes: Vec<usize> = moving.filter_map(|c| AXES.iter().position(|&axis| axis == c.channel.label)).collect();
        if axes.is_empty() {
            return Ok(run);
        }
        let bases: Option<Vec<Base>> = axes.into_iter().map(|axis| base(&self.structure, axis)).collect();
        let missing = || self.error(None, TableProblem::BaseWithoutMass { file: run.file.clone() });
        let bases = bases.ok_or_else(missing)?;
        let response = index.map_or(self.file.base.response, |index| self.runs[index].response);
        run.fit = driven(run.fit, &bases, response == BaseResponse::Absolute);
        run.on_moving_base = true;
        Ok(run)
    }

    /// The same of a run that is not steady.
    ///
    /// # Errors
    /// [`TableProblem::BaseWithoutMass`] for a structure without mass, [`TableProblem::RidesOnBase`] for absolute displacements and velocities.
    pub(super) fn in_time_on_its_base(
        &self,
        index: usize,
        mut run: TransientRun,
    ) -> Result<TransientRun, ProjectError> {
        let moving = run.channels().iter().filter(|c| c.quantity == Quantity::Base);
        let axes: Vec<usize> = moving.filter_map(|c| AXES.iter().position(|&axis| axis == c.label)).collect();
        if axes.is_empty() {
            return Ok(run);
        }
        let bases: Option<Vec<Base>> = axes.into_iter().map(|axis| base(&self.structure, axis)).collect();
        let missing = || self.run_error(index, "file", TableProblem::BaseWithoutMass { file: run.file.clone() });
        let bases = bases.ok_or_else(missing)?;
        let is_absolute = self.runs[index].response == BaseResponse::Absolute;
        let rides = |channel: Channel| {
            let (file, channel) = (run.file.clone(), channel.to_string());
            self.run_error(index, "file", TableProblem::RidesOnBase { file, channel })
        };
        run.on_moving_base = true;
        run.record = Arc::new(driven_in_time(&run.record, &bases, is_absolute).map_err(rides)?);
        Ok(run)
    }
}

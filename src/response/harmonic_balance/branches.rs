//! Every periodic response at one force: where stiffness laws fold the curve of the response against the level of the force, its answers at
//! the full force, each with its stability.

use super::arc::all_crossings;
use super::condense::split;
use super::error::ResponseError;
use super::excitation::Excitation;
use super::model::RunModel;
use super::nonlinear_leg::NonlinearLeg;
use super::outcome::Response;
use super::prepared::Prepared;
use super::settings::Settings;
use super::solve::{assemble, respond};
use super::stability::is_stable;
use crate::control::Control;
use crate::effects::Source;

/// Difference of the fundamental, relative, within which two responses are one.
const SAME: f64 = 1e-3;

impl RunModel {
    /// All periodic responses to `excitation` that lie on the curve of the response against the level of the force, up to
    /// three times the force, and the one from rest, each with whether small disturbances die out; several where stiffness laws fold
    /// that curve.
    pub fn branches(
        &self,
        sources: &[Source],
        excitation: &Excitation,
        settings: &Settings,
        control: &Control,
    ) -> Result<Vec<(Response, bool)>, ResponseError> {
        let run = &self.ready(sources, excitation)?;
        let one = respond(run, sources, excitation, settings, None, control)?;
        if !split(sources, run.compliance(1)).0.iter().any(NonlinearLeg::folds) {
            return Ok(vec![(one, true)]);
        }
        let prepared = Prepared::new(run, sources, excitation, settings.harmonics.max(excitation.order()))?;
        let crossings = all_crossings(&prepared.balance(), settings.tolerance, control)?;
        let mut found = Vec::with_capacity(crossings.len() + 1);
        for u in crossings {
            let start = assemble(run, &prepared, excitation, u);
            // A solution with more harmonics that is not found on this branch is not one of its own.
            let response = match respond(run, sources, excitation, settings, Some(&start), control) {
                Err(ResponseError::NotConverged { .. }) => start,
                other => other?,
            };
            found.push(response);
        }
        // Just beyond a fold a step of the curve passes two answers at once, of which the response from rest may be one.
        if !found.iter().any(|response| is_same(response, &one)) {
            found.push(one);
        }
        let several = found.len() > 1;
        let judged = |response: Response| {
            let stable = !several || is_stable(run, sources, excitation, &response);
            (response, stable)
        };
        Ok(found.into_iter().map(judged).collect())
    }
}

/// Whether two responses have the same fundamental.
fn is_same(a: &Response, b: &Response) -> bool {
    let largest = |size: &dyn Fn(usize) -> f64| (0..b.mean.len()).map(size).fold(0.0, f64::max);
    let difference = largest(&|dof| (a.amplitude(dof, 1) - b.amplitude(dof, 1)).norm());
    difference <= SAME * largest(&|dof| b.amplitude(dof, 1).norm())
}

//! Faults of channels where the damping of the model is still to be identified from them: their mapping is mended first. What a
//! reversed sensor makes of the damping is no model to start from.

use crate::control::Control;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::diagnosis::diagnose::faults_of_channels;
use crate::diagnosis::result::Diagnosis;
use crate::effects::{Effect, Place, Source, State};
use crate::exchange::Project;
use crate::session::adoption::Adoption;
use crate::session::validation::{ValidationError, agreement, channel_faults, has_records, is_component, problem};
use crate::session::{Document, Session};
use anyhow::Context;
use std::path::Path;

/// Loss factors of the structure while the faults are looked for, of one that is damped lightly and of one that is damped well:
/// the amplitudes of the modes are free, but channels are weighed by those of the model.
const STAND_INS: [f64; 2] = [0.004, 0.03];

/// What was mended of a project.
pub(super) struct MendedFirst {
    /// The project file with the mapping mended.
    pub document: Document,
    /// The project as its channels were read.
    unmended: Project,
    faults: Vec<ChannelFault>,
}

/// The project with its mapping mended where its channels have faults, and what was mended; as it is where they have none.
///
/// # Errors
/// What keeps the mended project from being read.
pub(super) fn mended_first(
    project: Project,
    file: &Path,
    control: &Control,
) -> anyhow::Result<(Project, Option<MendedFirst>)> {
    if project.structure.matrices().is_none() || is_component(&project) {
        return Ok((project, None));
    }
    let context = || file.display().to_string();
    let mut faults = Vec::new();
    for loss_factor in STAND_INS {
        if faults.is_empty() {
            faults = faults_with(&project, loss_factor, control).with_context(context)?;
        }
    }
    if faults.is_empty() {
        return Ok((project, None));
    }
    let mut adoption = Adoption::new(Session::open(file).with_context(context)?.document());
    // What no mapping can mend is told by the search, with the rest.
    if faults.iter().any(|fault| adoption.fault(fault, &project).is_err()) {
        return Ok((project, None));
    }
    let document = adoption.document;
    let mended = document.plan(file).and_then(|plan| plan.load(control))?;
    eprintln!("{}: mended first", faults.iter().map(ChannelFault::words).collect::<Vec<_>>().join("; "));
    Ok((mended, Some(MendedFirst { document, unmended: project, faults })))
}

/// Faults that a mapping can mend, with a model that has this loss factor beside what is known.
fn faults_with(project: &Project, loss_factor: f64, control: &Control) -> Result<Vec<ChannelFault>, ValidationError> {
    let whole = Source::candidate(Effect::STAND_IN, Place::Whole(None)).with_coefficient(loss_factor);
    let mut damped = project.clone();
    damped.sources.push(Source { state: State::Known, ..whole });
    let mut faults = if has_records(project) {
        channel_faults(&damped, control)?
    } else {
        faults_of_channels(&problem(&damped), control)?.0
    };
    faults.retain(|fault| !matches!(fault.fault, Fault::Unreliable(_)));
    Ok(faults)
}

impl MendedFirst {
    /// Puts the faults before what was found with them mended; `known` is the model that was compared.
    ///
    /// # Errors
    /// What keeps that model from being compared with the channels as they were read.
    pub(super) fn before(self, known: &[Source], diagnosis: &mut Diagnosis, control: &Control) -> anyhow::Result<()> {
        let as_read = Project { sources: known.to_vec(), ..self.unmended };
        diagnosis.follows(agreement(&as_read, control)?, self.faults);
        Ok(())
    }
}

//! A base whose motion comes from a record, in `dashpot simulate`.

use super::moving_base;
use crate::exchange::project::Plan;
use crate::exchange::project::file::BaseResponse;
use crate::exchange::project::load_base::base;
use crate::exchange::records::read_record;
use crate::measurement::base::{AXES, Base};
use crate::measurement::{Channel, Quantity};
use crate::response::recording::BaseMotion;
use anyhow::{Context, anyhow, bail};

/// Share of a step by which the steps of the record may differ.
const UNEVEN: f64 = 1e-3;

/// The acceleration of a base along an axis, and what it does to the structure.
pub(super) struct RecordedBase {
    base: Base,
    loads: Vec<(usize, f64)>,
    channel: Channel,
    acceleration: Vec<f64>,
    step_s: f64,
    is_absolute: bool,
}

impl RecordedBase {
    /// Of the excitation of run number `index`: the first base channel of its file.
    pub(super) fn read(plan: &Plan, index: usize) -> anyhow::Result<Self> {
        let table = plan.file.run[index].excitation.as_ref();
        let file = table.and_then(|t| t.file.as_ref()).context("the excitation names no file of the base")?;
        let path = plan.path.parent().map_or_else(|| file.into(), |folder| folder.join(file));
        let record = read_record(&path, &plan.structure)?;
        let moving = (0..record.channels().len()).find(|&c| record.channels()[c].quantity == Quantity::Base);
        let moving =
            moving.ok_or_else(|| anyhow!("{file} holds no motion of a base; name its column base@z [m/s^2]"))?;
        let label = &record.channels()[moving].label;
        let axis = AXES.iter().position(|axis| axis == label).with_context(|| format!("{label} is no axis"))?;
        let base = base(&plan.structure, axis).context("a structure without mass has no force from its base")?;
        if base.along.is_empty() {
            bail!("no DOF of the structure moves along {label}; correct the column of {file}");
        }
        let time = record.time();
        let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
        if time.windows(2).any(|t| ((t[1] - t[0]) / step_s - 1.0).abs() > UNEVEN) {
            bail!("the time steps of {file} are uneven; a motion of the base needs even ones");
        }
        Ok(Self {
            loads: base.loads.iter().map(|(dof, _, load)| (*dof, *load)).collect(),
            base,
            channel: moving_base::channel(plan, axis),
            acceleration: record.samples(moving).to_vec(),
            step_s,
            is_absolute: plan.runs[index].response == BaseResponse::Absolute,
        })
    }

    pub(super) fn channel(&self) -> Channel {
        self.channel.clone()
    }

    pub(super) fn motion(&self) -> BaseMotion<'_> {
        BaseMotion {
            loads: &self.loads,
            along: &self.base.along,
            channel: &self.channel,
            acceleration: &self.acceleration,
            step_s: self.step_s,
            is_absolute: self.is_absolute,
        }
    }
}

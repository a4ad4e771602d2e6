//! Plots of records that are not steady: their samples, and what a decay tells of damping over amplitude.

use crate::control::Control;
use crate::display::words;
use crate::exchange::Project;
use crate::measurement::{Quantity, TransientRun};
use crate::plots::amplitude_curve::{self, LEAST_POINTS};
use crate::plots::figure::{Axis, Data, Figure, Look};
use crate::plots::pyramid::Pyramid;
use crate::plots::style::Palette;
use crate::session::validation::compared_with_records;
use anyhow::{Context, bail};
use std::sync::Arc;

/// Records of a project, and what was asked of them.
pub(super) struct RecordPlots<'a> {
    pub p: &'a Project,
    /// Number of the record, from 1.
    pub run: Option<usize>,
    /// Name of the channel.
    pub channel: Option<&'a str>,
    pub palette: &'static Palette,
    pub control: &'a Control,
}

impl RecordPlots<'_> {
    /// Index of the record that was asked for, else of the first that is used.
    fn index(&self) -> anyhow::Result<usize> {
        let records = &self.p.transient_runs;
        match self.run {
            Some(number) if (1..=records.len()).contains(&number) => Ok(number - 1),
            Some(number) => bail!("--run {number}: the project has records 1 to {}", records.len()),
            None => records.iter().position(|r| r.enabled).context("the project has no record that is not steady"),
        }
    }

    /// Number of the channel that was asked for, else of the first motion, else of the first.
    fn channel(&self, run: &TransientRun) -> anyhow::Result<usize> {
        let channels = run.channels();
        let motion = || channels.iter().position(|c| c.quantity != Quantity::Force).unwrap_or(0);
        let Some(name) = self.channel else { return Ok(motion()) };
        let names = || channels.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let found = channels.iter().position(|c| c.to_string() == name);
        found.with_context(|| format!("{} has no such channel; it has {}", run.file, names()))
    }

    /// The samples of one channel over time.
    pub fn record(&self) -> anyhow::Result<Figure> {
        let run = &self.p.transient_runs[self.index()?];
        let number = self.channel(run)?;
        let channel = &run.channels()[number];
        let rotation = self.p.structure.dofs().get(channel.dof).is_some_and(|d| d.direction.is_rotation());
        let title = format!("{}, {channel}", run.file);
        let samples = Data::Record(Arc::new(Pyramid::new(run.time(), run.samples(number))));
        let figure = Figure::new(&title, Axis::new("Time", "s"), Axis::of(words::axis(channel.quantity, rotation)));
        Ok(figure.with("measured", self.palette.measured, Look::Line(1.2), samples))
    }

    /// Damping ratio and frequency over amplitude of the mode that stands out most, under their title.
    pub fn amplitude(&self) -> anyhow::Result<(String, Vec<Figure>)> {
        let index = self.index()?;
        let file = &self.p.transient_runs[index].file;
        let found = compared_with_records(self.p, self.control)?;
        let records = found.context("there is no model of mass and stiffness to compare the records with")?.records;
        let record = records.iter().find(|r| r.index == index).with_context(|| format!("{file} is switched off"))?;
        let curve = record.curves.iter().find(|c| c.measured.len() >= LEAST_POINTS);
        let curve = curve.with_context(|| format!("no mode of {file} can be followed over its amplitude"))?;
        let title = format!("{file}, {}: damping ratio and frequency over amplitude", curve.channel);
        let figures = [true, false].map(|ratio| amplitude_curve::figure(curve, ratio, self.palette));
        Ok((title, figures.into()))
    }
}

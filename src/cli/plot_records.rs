//! Records that are not steady, without a model beside them.

use crate::display::words;
use crate::exchange::Project;
use crate::measurement::{Quantity, TransientRun};
use crate::plots::figure::{Axis, Data, Figure, Look};
use crate::plots::pyramid::Pyramid;
use crate::plots::style::Palette;
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
}

impl RecordPlots<'_> {
    /// Index of the record that was asked for, else of the first that is used.
    pub(super) fn index(&self) -> anyhow::Result<usize> {
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
    pub(super) fn record(&self) -> anyhow::Result<Figure> {
        let run = &self.p.transient_runs[self.index()?];
        let number = self.channel(run)?;
        let channel = &run.channels()[number];
        let rotation = self.p.structure.dofs().get(channel.dof).is_some_and(|d| d.direction.is_rotation());
        let title = format!("{}, {channel}", run.file);
        let samples = Data::Record(Arc::new(Pyramid::new(run.time(), run.samples(number))));
        let figure = Figure::new(&title, Axis::new("Time", "s"), Axis::of(words::axis(channel.quantity, rotation)));
        Ok(figure.with("measured", self.palette.measured, Look::Line(1.2), samples))
    }
}

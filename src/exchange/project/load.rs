//! Reads and fits the records of a project and corrects them for the known errors of their channels.

use super::error::{Problem, ProjectError};
use super::plan::{Plan, open};
use crate::control::Control;
use crate::effects::{Effect, Place, Source};
use crate::exchange::Project;
use crate::measurement::run::Correction;
use crate::measurement::{Channel, Quantity, Run};
use std::path::Path;
use std::sync::Arc;

/// Reads the project at `path` with all its records.
///
/// # Errors
/// [`ProjectError`] with file and line of the first thing that is wrong.
pub fn load(path: &Path, control: &Control) -> Result<Project, ProjectError> {
    open(path)?.load(control)
}

impl Plan {
    /// Reads and fits all records.
    ///
    /// # Errors
    /// [`ProjectError`] for records that cannot be read or fitted, and for projects that measure nothing.
    pub fn load(self, control: &Control) -> Result<Project, ProjectError> {
        if self.runs.is_empty() && self.file.harmonics.is_empty() {
            return Err(self.error(None, Problem::NothingMeasured));
        }
        let mut runs = Vec::with_capacity(self.runs.len());
        for index in 0..self.runs.len() {
            control.check().map_err(|_| self.error(None, Problem::Cancelled))?;
            let piece = control.piece(index, self.runs.len());
            runs.push(self.run(index, &piece)?);
            piece.report(1.0);
        }
        let corrections = self.corrections();
        for run in self.harmonics()? {
            let fitted = Run::from_harmonics(run.name, None, true, run.fit, &corrections);
            runs.push(self.on_its_base(None, fitted)?);
        }
        self.check_sensors(&runs)?;
        Ok(Project {
            title: self.file.project.title,
            notes: self.file.project.notes,
            structure: self.structure,
            sources: self.sources,
            ruled_out: self.ruled_out,
            runs,
            settings: self.file.analysis,
        })
    }

    /// Reads and fits the record of run number `index`, and corrects it for the known errors of its channels.
    ///
    /// # Errors
    /// [`ProjectError`] for a record that cannot be read or fitted.
    pub fn run(&self, index: usize, control: &Control) -> Result<Run, ProjectError> {
        let planned = &self.runs[index];
        let record = self.record(index, control)?;
        let (file, settings) = (planned.file.clone(), self.settings());
        let (level, enabled, frequency_hz) = (planned.level, planned.enabled, planned.frequency_hz);
        let corrections = self.corrections();
        let run =
            Run::from_record(file, level, enabled, Arc::new(record), frequency_hz, settings.harmonics, &corrections);
        let run = run.map_err(|error| {
            let key = if frequency_hz.is_some() { "frequency" } else { "file" };
            self.run_error(index, key, Problem::Fit { file: planned.file.clone(), error })
        })?;
        self.on_its_base(Some(index), run)
    }

    /// Known errors of the measuring chain, one entry a channel.
    pub fn corrections(&self) -> Vec<Correction> {
        let mut corrections: Vec<Correction> = Vec::new();
        for sensor in &self.sensors {
            let Some(channel) = self.channel(sensor) else { continue };
            let at = corrections.iter().position(|known| known.channel == channel).unwrap_or(corrections.len());
            if at == corrections.len() {
                corrections.push(Correction { channel, delay: 0.0, gain: 1.0 });
            }
            match sensor.effect {
                Effect::Delay => corrections[at].delay = sensor.parameters[0],
                _ => corrections[at].gain = sensor.parameters[0],
            }
        }
        corrections
    }

    /// The channel of a sensor.
    fn channel(&self, sensor: &Source) -> Option<Channel> {
        let Place::Channel(name) = &sensor.place else { return None };
        let (word, label) = name.split_once('@')?;
        let quantity = Quantity::from_word(word)?;
        Some(Channel { quantity, dof: self.structure.dof(label)?, label: label.to_owned() })
    }

    /// A correction whose channel is in no record would silently do nothing.
    fn check_sensors(&self, runs: &[Run]) -> Result<(), ProjectError> {
        let channels: Vec<String> =
            runs.iter().flat_map(|run| &run.fit.channels).map(|channel| channel.channel.to_string()).collect();
        for sensor in &self.sensors {
            let Place::Channel(name) = &sensor.place else { continue };
            if !channels.contains(name) {
                let line = self.file.sensor.iter().position(|table| table.channel.trim() == name);
                let line = line.map(|i| self.lines.sensor[i]);
                return Err(self.error(line, Problem::NoSuchChannel { channel: name.clone() }));
            }
        }
        Ok(())
    }
}

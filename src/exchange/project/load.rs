//! Reads and fits the records of a project and corrects them for the known errors of their channels.

use super::error::{Problem, ProjectError};
use super::plan::{Plan, open};
use super::sensors::correct;
use crate::control::Control;
use crate::effects::Place;
use crate::exchange::Project;
use crate::exchange::records::HarmonicsRun;
use crate::measurement::{FitError, HarmonicFit, Record, Run, fit, frequency};
use std::f64::consts::TAU;
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
            runs.push(self.run(index, &Control::unattended())?);
            control.report((index + 1) as f64 / self.runs.len() as f64);
        }
        runs.extend(self.harmonics()?.into_iter().map(|run| self.fitted(run)));
        self.check_sensors(&runs)?;
        Ok(Project {
            title: self.file.project.title,
            notes: self.file.project.notes,
            structure: self.structure,
            sources: self.sources,
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
        let fit = fitted(&record, planned.frequency_hz, self.settings().harmonics).map_err(|error| {
            let key = if planned.frequency_hz.is_some() { "frequency" } else { "file" };
            self.run_error(index, key, Problem::Fit { file: planned.file.clone(), error })
        })?;
        let mut run = Run {
            file: planned.file.clone(),
            level: planned.level,
            enabled: planned.enabled,
            record: Some(Arc::new(record)),
            noise_ratio: noise_ratio(&fit),
            fit,
            findings: Vec::new(),
        };
        correct(&mut run.fit, &self.sensors);
        Ok(run)
    }

    /// A run whose harmonics were fitted elsewhere.
    fn fitted(&self, run: HarmonicsRun) -> Run {
        let mut fit = run.fit;
        correct(&mut fit, &self.sensors);
        Run {
            file: run.name,
            level: None,
            enabled: true,
            record: None,
            noise_ratio: noise_ratio(&fit),
            fit,
            findings: Vec::new(),
        }
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

    fn error(&self, line: Option<usize>, problem: Problem) -> ProjectError {
        ProjectError { file: self.path.display().to_string(), line, problem }
    }
}

/// Harmonics at the frequency that is given or, without one, found in the record.
fn fitted(record: &Record, frequency_hz: Option<f64>, harmonics: usize) -> Result<HarmonicFit, FitError> {
    match frequency_hz {
        Some(frequency_hz) => fit(record, TAU * frequency_hz, harmonics),
        None => {
            let found = frequency::estimate(record, harmonics)?;
            let fitted = fit(record, found.omega, harmonics)?;
            Ok(HarmonicFit { omega_deviation: found.deviation, ..fitted })
        }
    }
}

/// Noise over signal, root mean square over the channels that show anything.
fn noise_ratio(fit: &HarmonicFit) -> f64 {
    let power =
        |channel: &crate::measurement::ChannelFit| 0.5 * channel.amplitudes.iter().map(|y| y.norm_sqr()).sum::<f64>();
    let ratios: Vec<f64> = fit
        .channels
        .iter()
        .filter(|channel| power(channel) > 0.0)
        .map(|channel| channel.noise * channel.noise / power(channel))
        .collect();
    if ratios.is_empty() { 0.0 } else { (ratios.iter().sum::<f64>() / ratios.len() as f64).sqrt() }
}

//! Reads and fits the records of a project and corrects them for the known errors of their channels.

use super::error::{ProjectError, TableProblem};
use super::file::HarmonicsTable;
use super::plan::{Fitted, Plan, open};
use crate::control::Control;
use crate::effects::{self, Place, Source};
use crate::exchange::Project;
use crate::exchange::mapping::{AmplitudeTable, read_amplitudes};
use crate::exchange::records::{HarmonicsRun, SteppedSine, base_channel, read_harmonics_as};
use crate::measurement::proposal::{Proposal, propose};
use crate::measurement::run::ChannelCorrection;
use crate::measurement::unsettled::take_unsettled;
use crate::measurement::{Channel, Flag, Kind, Quantity, Run, TransientLabel, TransientRun, TransientRunError};
use crate::structure::StructureKind;
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
        if self.runs.is_empty() && self.file.harmonics.is_empty() && self.file.frf.is_empty() {
            return Err(self.error(None, TableProblem::NothingMeasured));
        }
        let (mut runs, transient_runs) = self.records(control)?;
        let corrections = self.corrections();
        for run in self.harmonics()? {
            runs.push(self.on_its_base(None, run.run(&corrections))?);
        }
        let mut remarks = Vec::new();
        for index in 0..self.file.frf.len() {
            let chosen = self.frf(index, control)?;
            runs.extend(chosen.runs);
            remarks.extend(chosen.remarks);
        }
        remarks.extend(take_unsettled(&mut runs));
        self.check_sensors(&runs, &transient_runs)?;
        Ok(Project {
            title: self.file.project.title,
            notes: self.file.project.notes,
            structure: self.structure,
            sources: self.sources,
            ruled_out: self.ruled_out,
            runs,
            transient_runs,
            reference_shapes: self.reference_shapes,
            settings: self.file.analysis,
            remarks,
        })
    }

    /// The runs that are records: steady ones, and the others.
    fn records(&self, control: &Control) -> Result<(Vec<Run>, Vec<TransientRun>), ProjectError> {
        let mut runs = Vec::with_capacity(self.runs.len());
        let mut transient_runs = Vec::new();
        for index in 0..self.runs.len() {
            control.check().map_err(|_| self.error(None, TableProblem::Cancelled))?;
            let piece = control.piece(index, self.runs.len());
            if self.file.is_steady(self.runs[index].kind) {
                runs.push(self.run(index, &piece)?);
            } else {
                transient_runs.push(self.transient_run(index, &piece)?);
            }
            piece.report(1.0);
        }
        Ok((runs, transient_runs))
    }

    /// Reads the runs of every `[[harmonics]]` file, as they were measured.
    pub fn harmonics(&self) -> Result<Vec<Fitted>, ProjectError> {
        let files = (0..self.file.harmonics.len()).map(|index| self.harmonics_of(index));
        Ok(files.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// The same of `[[harmonics]]` number `index`.
    pub fn harmonics_of(&self, index: usize) -> Result<Vec<Fitted>, ProjectError> {
        let table = &self.file.harmonics[index];
        let wrong = |problem| self.error(self.lines.of("[[harmonics]]", index, ""), problem);
        let path = self.path.parent().unwrap_or(Path::new("")).join(&table.file);
        if !path.is_file() {
            return Err(wrong(TableProblem::NoRecord { file: table.file.clone() }));
        }
        let (set, phase_of) = (table.set.as_deref(), table.phase_of);
        let read = if table.phases.is_empty() {
            let (force, response) = (table.force.as_deref(), table.response.as_deref());
            read_harmonics_as(&path, &self.structure, &SteppedSine { force, response, phase_of })
        } else {
            let (channels, phases) = (&self.file.channel, &table.phases);
            read_amplitudes(&path, AmplitudeTable { channels, phases, set, phase_of }, &self.structure)
        };
        let read = read.map_err(|error| wrong(TableProblem::Record(Box::new(error))))?;
        Ok(read.into_iter().map(|run| fitted(table, run)).collect())
    }

    /// Reads and fits the record of run number `index`, and corrects it for the known errors of its channels.
    ///
    /// # Errors
    /// [`ProjectError`] for a record that cannot be read or fitted.
    pub fn run(&self, index: usize, control: &Control) -> Result<Run, ProjectError> {
        let planned = &self.runs[index];
        let mut record = self.record(index, control)?;
        if !planned.part.is_whole() {
            let range = planned.part.samples(record.time());
            let wrong = |error| TableProblem::Part { file: planned.name(), error };
            record = record.part(range).map_err(|error| self.run_error(index, "start_s", wrong(error)))?;
        }
        let (file, settings) = (planned.name(), self.settings());
        let (level, enabled, frequency_hz) = (planned.level, planned.enabled, planned.frequency_hz);
        let corrections = self.corrections_in(planned.set.as_deref());
        let record = Arc::new(record);
        let run =
            Run::from_record(file, level, enabled, record.clone(), frequency_hz, settings.harmonics, &corrections)
                .map(|run| Run { session: planned.session.clone(), insisted: planned.insisted, ..run })
                .map_err(|error| {
                    let key = if frequency_hz.is_some() { "frequency" } else { "file" };
                    let (file, looks_like) = (planned.name(), propose(&record));
                    let problem = match looks_like {
                        Proposal { kind: Kind::Steady, .. } => TableProblem::Fit { file, error },
                        Proposal { kind, reason, .. } => {
                            TableProblem::NotSteady { file, error, kind: kind.name(), reason }
                        }
                    };
                    self.run_error(index, key, problem)
                })?;
        self.on_its_base(Some(index), run.without_dead_channels())
    }

    /// Reads the record of run number `index`, which is not steady.
    ///
    /// # Errors
    /// [`ProjectError`] for a record that cannot be read or a part that holds no motion.
    pub fn transient_run(&self, index: usize, control: &Control) -> Result<TransientRun, ProjectError> {
        let planned = &self.runs[index];
        let record = self.record(index, control)?;
        let label = TransientLabel {
            file: planned.name(),
            kind: planned.kind,
            part: planned.part,
            level: planned.level,
            session: planned.session.clone(),
            enabled: planned.enabled,
            exponential_window_s: planned.exponential_window_s,
        };
        let mut run = TransientRun::new(label, Arc::new(record), &self.corrections_in(planned.set.as_deref()))
            .map_err(|error| {
                let key = if matches!(error, TransientRunError::PartTooShort { .. }) { "start_s" } else { "file" };
                self.run_error(index, key, TableProblem::Transient { file: planned.name(), error })
            })?;
        if self.structure.kind() == StructureKind::Component {
            // A testing machine may move it in any way.
            run.findings.retain(|finding| finding.flag != Flag::OtherKind);
        }
        self.in_time_on_its_base(index, run)
    }

    /// Known errors of the measuring chain, one entry a channel.
    pub fn corrections(&self) -> Vec<ChannelCorrection> {
        self.corrections_in(None)
    }

    /// The same of a run in a set of its file.
    fn corrections_in(&self, set: Option<&str>) -> Vec<ChannelCorrection> {
        let mut corrections: Vec<ChannelCorrection> = Vec::new();
        for sensor in &self.sensors {
            let Some(channel) = self.channel(sensor) else { continue };
            let at = corrections.iter().position(|known| known.channel == channel).unwrap_or(corrections.len());
            if at == corrections.len() {
                corrections.push(ChannelCorrection { channel, delay: 0.0, gain: 1.0 });
            }
            match sensor.effect.kind() {
                effects::Kind::Channel(law) if law.turns_phase() => corrections[at].delay = sensor.parameters[0],
                _ => corrections[at].gain = sensor.parameters[0],
            }
        }
        let has = |other: &str| set.is_none_or(|own| own == other);
        for table in self.file.channel.iter().filter(|table| table.is_meant(&self.file.channel, &has)) {
            let channel = match table.quantity {
                Quantity::Base => base_channel(&table.dof, &self.structure),
                quantity => {
                    self.structure.dof(&table.dof).map(|dof| Channel { quantity, dof, label: table.dof.clone() })
                }
            };
            let (Some(delay), Some(channel)) = (table.delay, channel) else { continue };
            match corrections.iter_mut().find(|known| known.channel == channel) {
                Some(known) => known.delay += delay,
                None => corrections.push(ChannelCorrection { channel, delay, gain: 1.0 }),
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
    fn check_sensors(&self, runs: &[Run], transient_runs: &[TransientRun]) -> Result<(), ProjectError> {
        let steady = runs.iter().flat_map(|run| &run.fit.channels).map(|channel| channel.channel.to_string());
        let others = transient_runs.iter().flat_map(TransientRun::channels).map(ToString::to_string);
        let channels: Vec<String> = steady.chain(others).collect();
        for sensor in &self.sensors {
            let Place::Channel(name) = &sensor.place else { continue };
            if !channels.contains(name) {
                let sensor = self.file.sensor.iter().position(|table| table.channel.trim() == name);
                let line = sensor.and_then(|k| self.lines.of("[[sensor]]", k, ""));
                return Err(self.error(line, TableProblem::NoSuchChannel { channel: name.clone() }));
            }
        }
        Ok(())
    }
}

/// A run of a table with what this says of all its runs.
fn fitted(table: &HarmonicsTable, run: HarmonicsRun) -> Fitted {
    let HarmonicsRun { name, fit, level, session } = run;
    let (level, session) = (level.or(table.level), session.or_else(|| table.session.clone()));
    Fitted { name, fit, level, session, enabled: table.enabled }
}

//! The files of `dashpot simulate`.

use super::arguments::{Records, Simulate};
use crate::exchange::project::{Plan, ProjectError};
use crate::exchange::records::{write_harmonics, write_record};
use crate::measurement::{HarmonicFit, Record, fit::fit, frequency};
use crate::response::synthesis::Noise;
use anyhow::Context;
use std::f64::consts::TAU;
use std::fs;

impl Simulate {
    /// Noise of a run, in a stream of its own.
    pub(super) fn noise_of(&self, run: usize) -> Option<Noise> {
        (self.noise > 0.0).then_some(Noise { ratio: self.noise, seed: self.seed, stream: run as u64 })
    }
}

/// An error with the line of its run, unless it says already where it is.
pub(super) fn at_run(plan: &Plan, index: usize, error: anyhow::Error) -> anyhow::Error {
    if error.downcast_ref::<ProjectError>().is_some() { error } else { error.context(plan.place_of_run(index)) }
}

pub(super) fn fit_record(plan: &Plan, index: usize, record: &Record) -> anyhow::Result<HarmonicFit> {
    let harmonics = plan.settings().harmonics;
    let omega = match plan.runs[index].frequency_hz {
        Some(frequency) => TAU * frequency,
        None => frequency::estimate(record, harmonics)?.omega,
    };
    Ok(fit(record, omega, harmonics)?)
}

pub(super) fn write(plan: &Plan, records: &[Record], arguments: &Simulate) -> anyhow::Result<String> {
    let folder = &arguments.out;
    fs::create_dir_all(folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    if arguments.records == Records::Harmonics {
        let path = folder.join("harmonics.csv");
        let fits = fits(plan, records)?;
        let named: Vec<(&str, &HarmonicFit)> = plan.runs.iter().map(|run| run.file.as_str()).zip(&fits).collect();
        write_harmonics(&path, &named, &plan.structure)?;
        return Ok(format!("{} runs are in {}\n", records.len(), path.display()));
    }
    for (run, record) in plan.runs.iter().zip(records) {
        let path = folder.join(&run.file);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).with_context(|| format!("{}: the folder cannot be made", parent.display()))?;
        }
        write_record(&path, record, &plan.structure, arguments.digits.map(usize::from))?;
    }
    Ok(format!("{} records are in {}\n", records.len(), folder.display()))
}

fn fits(plan: &Plan, records: &[Record]) -> anyhow::Result<Vec<HarmonicFit>> {
    records.iter().enumerate().map(|(index, record)| fit_record(plan, index, record)).collect()
}

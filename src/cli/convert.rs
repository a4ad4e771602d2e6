//! `dashpot convert`: measurement files between formats: whatever `import` reads into the plain CSV in SI units, time records into
//! fitted harmonics.

use super::arguments::{Convert, Records};
use crate::control::Control;
use crate::exchange::importing::Request;
use crate::exchange::importing::plain::{Measurements, Wanted, plain};
use crate::exchange::mapping::is_own_record;
use crate::exchange::project::template;
use crate::exchange::records::places::{Contents, contents};
use crate::exchange::records::{RecordProblem, read_harmonics, read_record, write_harmonics, write_record};
use crate::measurement::{HarmonicFit, Record, fit::fit, frequency};
use crate::structure::Structure;
use anyhow::{Context, bail, ensure};
use std::f64::consts::TAU;

/// What a file holds, each run with its name.
enum Measured {
    Time(Vec<(String, Record)>),
    Harmonics(Vec<(String, HarmonicFit)>),
}

pub(super) fn run(arguments: &Convert) -> anyhow::Result<String> {
    let (from, to) = (&arguments.input, &arguments.output);
    ensure!(
        to.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv")),
        "{}: measurements are written as CSV; end the name with .csv",
        to.display()
    );
    let (measured, structure) = measured(arguments)?;
    let what = match (measured, arguments.records) {
        (Measured::Time(records), None | Some(Records::Time)) => {
            let [(_, record)] = &records[..] else { bail!("{}: holds no record", from.display()) };
            write_record(to, record, &structure, arguments.digits.map(usize::from))?;
            format!("{} samples of {} channels", record.time().len(), record.channels().len())
        }
        (Measured::Time(records), Some(Records::Harmonics)) => {
            let fits = fitted(arguments, &records)?;
            write_harmonics(to, &borrowed(&fits), &structure)?;
            let frequencies: Vec<String> = fits.iter().map(|(_, fit)| format!("{:.6} Hz", fit.omega / TAU)).collect();
            format!("{} harmonics of {}", arguments.harmonics, frequencies.join(", "))
        }
        (Measured::Harmonics(runs), None | Some(Records::Harmonics)) => {
            write_harmonics(to, &borrowed(&runs), &structure)?;
            format!("{} runs", runs.len())
        }
        (_, Some(Records::Frf)) => {
            bail!("{}: frequency responses are made by `dashpot simulate --as frf`, not from records", from.display())
        }
        (Measured::Harmonics(_), Some(Records::Time)) => {
            bail!("{}: holds harmonics, not samples; `dashpot simulate` makes time records", from.display())
        }
    };
    Ok(format!("{what} are in {}\n", to.display()))
}

/// What the file holds, on the points that it measures: by itself where it is of the project's own form, else as `import` reads it.
fn measured(arguments: &Convert) -> anyhow::Result<(Measured, Structure)> {
    let from = &arguments.input;
    let mapped = arguments.map.is_some() || arguments.set.is_some() || arguments.sampling_hz.is_some();
    if !mapped && let Some(own) = own(arguments)? {
        return Ok(own);
    }
    let channels = arguments.map.as_ref().map(|path| {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).with_context(|| format!("{name}: the template cannot be read"))?;
        Ok::<_, anyhow::Error>(template(&text, &name)?)
    });
    let request = Request {
        files: vec![from.clone()],
        channels: channels.transpose()?,
        sampling_hz: arguments.sampling_hz,
        ..Request::default()
    };
    let one = arguments.records != Some(Records::Harmonics);
    let found = plain(&request, Wanted { set: arguments.set.as_deref(), one }, &Control::unattended())?;
    found.remarks.iter().for_each(|remark| eprintln!("{remark}"));
    let measured = match found.measurements {
        Measurements::Records(records) => Measured::Time(records),
        Measurements::Harmonics(runs) => Measured::Harmonics(runs.into_iter().map(|run| (run.name, run.fit)).collect()),
    };
    Ok((measured, found.structure))
}

/// A record or harmonics in the project's own form; none of any other file.
fn own(arguments: &Convert) -> anyhow::Result<Option<(Measured, Structure)>> {
    let from = &arguments.input;
    let Ok((kind, structure)) = contents(from) else { return Ok(None) };
    if kind == Contents::Harmonics {
        let runs = read_harmonics(from, &structure)?.into_iter().map(|run| (run.name, run.fit)).collect();
        return Ok(Some((Measured::Harmonics(runs), structure)));
    }
    if !is_own_record(from) {
        return Ok(None);
    }
    let name = from.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    match read_record(from, &structure) {
        Ok(record) => Ok(Some((Measured::Time(vec![(name, record)]), structure))),
        // Records of a project have their time in seconds, files of laboratories in any unit.
        Err(error) if matches!(error.problem, RecordProblem::TimeUnit { .. } | RecordProblem::NoTimeUnit) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// The harmonics of every record.
fn fitted(arguments: &Convert, records: &[(String, Record)]) -> anyhow::Result<Vec<(String, HarmonicFit)>> {
    let several = records.len() > 1;
    let named_fit = |(name, record): &(String, Record)| {
        let set = if several { format!(", set \"{name}\"") } else { String::new() };
        let context = || format!("{}{set}", arguments.input.display());
        let omega = match arguments.frequency {
            Some(frequency) => TAU * frequency,
            None => frequency::estimate(record, arguments.harmonics).with_context(context)?.omega,
        };
        Ok((name.clone(), fit(record, omega, arguments.harmonics).with_context(context)?))
    };
    records.iter().map(named_fit).collect()
}

fn borrowed(runs: &[(String, HarmonicFit)]) -> Vec<(&str, &HarmonicFit)> {
    runs.iter().map(|(name, fit)| (name.as_str(), fit)).collect()
}

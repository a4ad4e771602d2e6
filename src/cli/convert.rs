//! `dashpot convert`: measurement files between formats: any CSV that is understood into the plain one in SI units, time
//! records into fitted harmonics.

use super::arguments::{Convert, Records};
use crate::exchange::records::places::{Contents, contents};
use crate::exchange::records::{read_harmonics, read_record, write_harmonics, write_record};
use crate::measurement::{HarmonicFit, fit::fit, frequency};
use anyhow::{Context, bail, ensure};
use std::f64::consts::TAU;

pub(super) fn run(arguments: &Convert) -> anyhow::Result<String> {
    let (from, to) = (&arguments.input, &arguments.output);
    ensure!(
        to.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv")),
        "{}: measurements are written as CSV; end the name with .csv",
        to.display()
    );
    let (kind, structure) = contents(from)?;
    let what = match (kind, arguments.records) {
        (Contents::Time, None | Some(Records::Time)) => {
            let record = read_record(from, &structure)?;
            write_record(to, &record, &structure, arguments.digits.map(usize::from))?;
            format!("{} samples of {} channels", record.time().len(), record.channels().len())
        }
        (Contents::Time, Some(Records::Harmonics)) => {
            let record = read_record(from, &structure)?;
            let context = || from.display().to_string();
            let omega = match arguments.frequency {
                Some(frequency) => TAU * frequency,
                None => frequency::estimate(&record, arguments.harmonics).with_context(context)?.omega,
            };
            let found = fit(&record, omega, arguments.harmonics).with_context(context)?;
            let name = from.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            write_harmonics(to, &[(name.as_str(), &found)], &structure)?;
            format!("{} harmonics of {:.6} Hz", arguments.harmonics, omega / TAU)
        }
        (Contents::Harmonics, None | Some(Records::Harmonics)) => {
            let runs = read_harmonics(from, &structure)?;
            let named: Vec<(&str, &HarmonicFit)> = runs.iter().map(|run| (run.name.as_str(), &run.fit)).collect();
            write_harmonics(to, &named, &structure)?;
            format!("{} runs", runs.len())
        }
        (_, Some(Records::Frf)) => {
            bail!("{}: frequency responses are made by `dashpot simulate --as frf`, not from records", from.display())
        }
        (Contents::Harmonics, Some(Records::Time)) => {
            bail!("{}: holds harmonics, not samples; `dashpot simulate` makes time records", from.display())
        }
    };
    Ok(format!("{what} are in {}\n", to.display()))
}

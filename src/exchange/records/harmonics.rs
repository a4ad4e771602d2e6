//! Harmonics that were fitted elsewhere, as CSV: `run,frequency_hz,channel,harmonic,cos,sin[,cos_std,sin_std]`.
//!
//! `y(t) = sum_h cos_h cos(h w t) + sin_h sin(h w t)`, so `Y_h = cos_h - i sin_h`.

use super::error::{At, RecordFileError, RecordProblem};
use super::harmonics_run::HarmonicsRun;
use super::reader::channel;
use super::stepped_sine::{self, SteppedSine};
use super::table::{Table, quote};
use super::writer::{channel_name, push_number, quoted, save};
use crate::measurement::{Channel, ChannelFit, HarmonicFit};
use crate::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;
use std::path::Path;

/// Highest harmonic that is read: more is a mistake in the column.
pub(crate) const HIGHEST_HARMONIC: usize = 1000;

const NAMES: [&str; 8] = ["run", "frequency_hz", "channel", "harmonic", "cos", "sin", "cos_std", "sin_std"];
const REQUIRED: usize = 6;

/// Reads every run in the harmonics file at `path`, in the order in which they appear.
pub fn read_harmonics(path: &Path, structure: &Structure) -> Result<Vec<HarmonicsRun>, RecordFileError> {
    read_harmonics_as(path, structure, &SteppedSine::default())
}

/// [`read_harmonics`] of a file that may be a stepped-sine table instead, whose columns `stepped` explains.
pub fn read_harmonics_as(
    path: &Path,
    structure: &Structure,
    stepped: &SteppedSine,
) -> Result<Vec<HarmonicsRun>, RecordFileError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| At { file: &name }.file(RecordProblem::Unreadable { reason: error.to_string() }))?;
    if stepped_sine::is_one(&bytes, &name)? {
        return stepped_sine::parse(&bytes, &name, structure, stepped);
    }
    parse_harmonics(&bytes, &name, structure)
}

/// Reads every run from the bytes of a harmonics file called `name` in messages.
pub fn parse_harmonics(bytes: &[u8], name: &str, structure: &Structure) -> Result<Vec<HarmonicsRun>, RecordFileError> {
    let at = At { file: name };
    let mut table = Table::open(bytes, at)?;
    let columns = columns(&table, at)?;
    let mut runs: Vec<PendingRun> = Vec::new();
    while table.next()? {
        table.check_width()?;
        let row = Row::read(&table, &columns, structure)?;
        take(&mut runs, row, &table, &columns)?;
    }
    if runs.is_empty() {
        return Err(at.file(RecordProblem::HeaderOnly));
    }
    runs.into_iter().map(|run| run.finish(at)).collect()
}

/// Column of each of [`NAMES`].
fn columns(table: &Table<'_>, at: At<'_>) -> Result<[Option<usize>; 8], RecordFileError> {
    let line = table.header_line;
    let mut columns = [None; 8];
    for (i, name) in table.header.iter().enumerate() {
        let plain = name.to_lowercase();
        let Some(known) = NAMES.iter().position(|&known| known == plain) else {
            return Err(at.line(line, RecordProblem::UnknownColumn { name: quote(name.as_bytes()) }));
        };
        if columns[known].replace(i).is_some() {
            return Err(at.line(line, RecordProblem::ColumnTwice { name: plain }));
        }
    }
    if let Some(missing) = (0..REQUIRED).find(|&i| columns[i].is_none()) {
        return Err(at.line(line, RecordProblem::NoColumn { name: NAMES[missing] }));
    }
    if columns[6].is_some() != columns[7].is_some() {
        return Err(at.line(line, RecordProblem::HalfOfDeviations));
    }
    Ok(columns)
}

/// One row in SI units.
struct Row {
    run: String,
    frequency_hz: f64,
    channel: Channel,
    harmonic: usize,
    amplitude: c64,
    deviations: [f64; 2],
}

impl Row {
    fn read(table: &Table<'_>, columns: &[Option<usize>; 8], structure: &Structure) -> Result<Self, RecordFileError> {
        let column = |i: usize| columns[i].unwrap_or_default();
        let run = table.text(column(0));
        if run.is_empty() {
            return Err(table.error(column(0), RecordProblem::EmptyCell));
        }
        let frequency_hz = table.reading(column(1), 1.0)?;
        if frequency_hz <= 0.0 {
            let text = quote(table.bytes(column(1)));
            return Err(table.error(column(1), RecordProblem::BadFrequency { text }));
        }
        let name = table.text(column(2));
        let (channel, unit) = channel(&name, structure).map_err(|problem| table.error(column(2), problem))?;
        let number = table.bytes(column(3));
        let harmonic = std::str::from_utf8(number).ok().and_then(|text| text.parse().ok());
        let Some(harmonic) = harmonic.filter(|h| (1..=HIGHEST_HARMONIC).contains(h)) else {
            let problem = RecordProblem::BadHarmonic { text: quote(number), most: HIGHEST_HARMONIC };
            return Err(table.error(column(3), problem));
        };
        let [cos, sin] = [column(4), column(5)].map(|place| table.reading(place, unit.to_si));
        let amplitude = c64::new(cos?, -sin?);
        let mut deviations = [0.0; 2];
        for (i, deviation) in deviations.iter_mut().enumerate() {
            let Some(place) = columns[6 + i] else { continue };
            *deviation = table.reading(place, unit.to_si)?;
            if *deviation < 0.0 {
                let text = quote(table.bytes(place));
                return Err(table.error(place, RecordProblem::BadDeviation { text }));
            }
        }
        Ok(Self { run, frequency_hz, channel, harmonic, amplitude, deviations })
    }
}

/// A run while its rows come in; harmonics in any order.
struct PendingRun {
    name: String,
    frequency_hz: f64,
    channels: Vec<PendingChannel>,
}

struct PendingChannel {
    channel: Channel,
    first_line: u64,
    harmonics: Vec<Option<(c64, [f64; 2])>>,
}

/// Puts a row into its run and channel.
fn take(
    runs: &mut Vec<PendingRun>,
    row: Row,
    table: &Table<'_>,
    columns: &[Option<usize>; 8],
) -> Result<(), RecordFileError> {
    let at = runs.iter().position(|run| run.name == row.run).unwrap_or(runs.len());
    if at == runs.len() {
        runs.push(PendingRun { name: row.run.clone(), frequency_hz: row.frequency_hz, channels: Vec::new() });
    }
    let run = &mut runs[at];
    if run.frequency_hz != row.frequency_hz {
        let (found, expected) = (row.frequency_hz, run.frequency_hz);
        let problem = RecordProblem::TwoFrequencies { run: quote(row.run.as_bytes()), found, expected };
        return Err(table.error(columns[1].unwrap_or_default(), problem));
    }
    let at = run.channels.iter().position(|pending| pending.channel == row.channel).unwrap_or(run.channels.len());
    if at == run.channels.len() {
        run.channels.push(PendingChannel { channel: row.channel, first_line: table.line(), harmonics: Vec::new() });
    }
    let harmonics = &mut run.channels[at].harmonics;
    if harmonics.len() < row.harmonic {
        harmonics.resize(row.harmonic, None);
    }
    if harmonics[row.harmonic - 1].replace((row.amplitude, row.deviations)).is_some() {
        let problem = RecordProblem::HarmonicTwice { run: quote(row.run.as_bytes()), harmonic: row.harmonic };
        return Err(table.error(columns[3].unwrap_or_default(), problem));
    }
    Ok(())
}

impl PendingRun {
    /// The run with every harmonic of every channel up to the highest of the run.
    fn finish(self, at: At<'_>) -> Result<HarmonicsRun, RecordFileError> {
        let highest = self.channels.iter().map(|pending| pending.harmonics.len()).max().unwrap_or(0);
        let mut channels = Vec::new();
        for pending in self.channels {
            let first_line = pending.first_line;
            let name = pending.channel.to_string();
            let missing = |harmonic| {
                let run = quote(self.name.as_bytes());
                at.cell(first_line, &name, RecordProblem::MissingHarmonic { run, harmonic, highest })
            };
            channels.push(pending.finish(highest).map_err(missing)?);
        }
        let omega = TAU * self.frequency_hz;
        let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
        Ok(HarmonicsRun { name: self.name, fit, level: None, session: None })
    }
}

impl PendingChannel {
    /// The channel's fit, or the first harmonic that is missing.
    fn finish(self, highest: usize) -> Result<ChannelFit, usize> {
        let mut amplitudes = Vec::with_capacity(highest);
        let mut covariance = Mat::zeros(2 * highest, 2 * highest);
        for h in 0..highest {
            let (amplitude, deviations) = self.harmonics.get(h).copied().flatten().ok_or(h + 1)?;
            amplitudes.push(amplitude);
            for (i, deviation) in deviations.into_iter().enumerate() {
                covariance[(2 * h + i, 2 * h + i)] = deviation * deviation;
            }
        }
        Ok(ChannelFit { channel: self.channel, offset: 0.0, slope: 0.0, amplitudes, covariance, noise: 0.0 })
    }
}

/// Writes the harmonics of runs, each with its name, to `path` in SI units; standard deviations where they are known.
pub fn write_harmonics(
    path: &Path,
    runs: &[(&str, &HarmonicFit)],
    structure: &Structure,
) -> Result<(), RecordFileError> {
    save(path, &harmonics_text(runs, structure))
}

/// The text that [`write_harmonics`] writes.
pub(crate) fn harmonics_text(runs: &[(&str, &HarmonicFit)], structure: &Structure) -> String {
    let known = runs.iter().all(|(_, fit)| fit.channels.iter().all(ChannelFit::has_deviation));
    let mut text = NAMES[..if known { 8 } else { REQUIRED }].join(",");
    text.push('\n');
    for (name, fit) in runs {
        for channel in &fit.channels {
            for h in 0..channel.amplitudes.len() {
                push_row(&mut text, name, fit, channel, h, known, structure);
            }
        }
    }
    text
}

fn push_row(
    text: &mut String,
    name: &str,
    fit: &HarmonicFit,
    channel: &ChannelFit,
    h: usize,
    known: bool,
    structure: &Structure,
) {
    let column = quoted(&channel_name(&channel.channel, structure));
    text.push_str(&format!("{},{},{column},{}", quoted(name), fit.omega / TAU, h + 1));
    let mut numbers = vec![channel.amplitudes[h].re, -channel.amplitudes[h].im];
    if known {
        numbers.extend([0, 1].map(|i| channel.covariance[(2 * h + i, 2 * h + i)].sqrt()));
    }
    for number in numbers {
        text.push(',');
        push_number(text, number, None);
    }
    text.push('\n');
}

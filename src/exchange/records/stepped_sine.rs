//! Stepped-sine tables as controllers write them: one row a run, with its frequency, the amplitude of the force, and the
//! amplitude and phase of each response.
//!
//! ```text
//! frequency_hz, force@1 [N], acc@7 [m/s^2], phase_deg acc@7     or     frequency_hz, force, amplitude, phase_deg
//! ```
//!
//! with `level` and `session` where there are any; other names of the columns are told by [`super::columns`]. The force has
//! phase 0: a response is `Y = A exp(i phi)`, where `phi` is the phase by which it leads the force. Where the phase is that
//! of another derivative of the same motion (such as of the displacement beside the amplitude of an acceleration),
//! `Y = A exp(i phi) i^(q - p)`, with `q` and `p` the number of times the two differentiate.

use super::columns::{Role, role};
use super::error::{At, RecordFileError, RecordProblem};
use super::harmonics_run::HarmonicsRun;
use super::reader::channel;
use super::table::{Table, quote};
use crate::measurement::channel::Unit;
use crate::measurement::{Channel, ChannelFit, HarmonicFit, Quantity};
use crate::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// What the project says of the columns of such a table.
#[derive(Debug, Clone, Copy, Default)]
pub struct SteppedSine<'a> {
    /// Channel and unit of the column of the force.
    pub force: Option<&'a str>,
    /// Channel and unit of the columns of the response: amplitude, and phase in degrees or radians.
    pub response: Option<&'a str>,
    /// Quantity whose phases are given, where it is not that of the channel.
    pub phase_of: Option<Quantity>,
}

/// A channel of the table: its amplitude and, of a response, its phase and the radians of its unit.
struct Column {
    channel: Channel,
    unit: &'static Unit,
    amplitude: usize,
    phase: Option<(usize, f64)>,
}

/// Where everything stands in a row.
struct Layout {
    /// Column and factor to Hz.
    frequency: (usize, f64),
    level: Option<usize>,
    session: Option<usize>,
    channels: Vec<Column>,
}

/// Whether a table has a frequency a row and no numbers of harmonics.
pub(super) fn is_one(bytes: &[u8], name: &str) -> Result<bool, RecordFileError> {
    let table = Table::open(bytes, At { file: name })?;
    let has = |wanted: &str| table.header.iter().any(|cell| cell.eq_ignore_ascii_case(wanted));
    let any = |wanted: fn(&Role) -> bool| table.header.iter().any(|cell| wanted(&role(cell)));
    let swept = any(|role| matches!(role, Role::Frequency(_))) && any(|role| matches!(role, Role::Phase(..)));
    Ok(swept && !has("harmonic") && !has("cos"))
}

/// Bytes in which the first line of a table ends: files of other formats may be larger than memory.
const BEGINNING: u64 = 1 << 20;

/// Whether the file at `path` is a table that [`parse`] reads: its columns are told in its first line.
pub(crate) fn is_stepped_table(path: &std::path::Path) -> bool {
    use std::io::Read;
    let mut bytes = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(BEGINNING).read_to_end(&mut bytes));
    if bytes.len() as u64 == BEGINNING {
        // A letter or a line that is cut says nothing.
        bytes.truncate(bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1));
    }
    read.is_ok() && is_one(&bytes, "").unwrap_or(false)
}

/// Reads every row as a run.
pub(super) fn parse(
    bytes: &[u8],
    name: &str,
    structure: &Structure,
    stepped: &SteppedSine,
) -> Result<Vec<HarmonicsRun>, RecordFileError> {
    let at = At { file: name };
    let mut table = Table::open(bytes, at)?;
    let layout = layout(&table, structure, stepped, at)?;
    let mut runs = Vec::new();
    while table.next()? {
        table.check_width()?;
        runs.push(run(&table, &layout, stepped, runs.len() + 1)?);
    }
    if runs.is_empty() { Err(at.file(RecordProblem::HeaderOnly)) } else { Ok(runs) }
}

fn layout(
    table: &Table<'_>,
    structure: &Structure,
    stepped: &SteppedSine,
    at: At<'_>,
) -> Result<Layout, RecordFileError> {
    let line = table.header_line;
    let mut layout = Layout { frequency: (0, 1.0), level: None, session: None, channels: Vec::new() };
    let mut phases: Vec<(usize, f64, String)> = Vec::new();
    for (i, name) in table.header.iter().enumerate() {
        let named = |text: Option<&str>, key| {
            let missing = RecordProblem::WhichChannel { column: name.clone(), key };
            text.map(str::to_owned).ok_or_else(|| at.line(line, missing))
        };
        let channel_name = match role(name) {
            Role::Phase(unit, of) => {
                phases.push((i, unit, of));
                continue;
            }
            Role::Frequency(to_hz) => {
                layout.frequency = (i, to_hz);
                continue;
            }
            Role::Level => {
                layout.level = Some(i);
                continue;
            }
            Role::Session => {
                layout.session = Some(i);
                continue;
            }
            Role::Force(_) => named(stepped.force, "force")?,
            Role::Response(..) => named(stepped.response, "response")?,
            Role::Other => name.clone(),
        };
        let (channel, unit) =
            channel(&channel_name, structure).map_err(|problem| at.cell(line, &quote(name.as_bytes()), problem))?;
        if layout.channels.iter().any(|c| c.channel == channel) {
            return Err(at.line(line, RecordProblem::ColumnTwice { name: channel.to_string() }));
        }
        layout.channels.push(Column { channel, unit, amplitude: i, phase: None });
    }
    for (i, unit, of) in phases {
        place_phase(&mut layout.channels, (i, unit), &of).map_err(|problem| at.line(line, problem))?;
    }
    check(&layout.channels).map_err(|problem| at.line(line, problem))?;
    Ok(layout)
}

/// Gives a phase to the channel it names, or to the only response.
fn place_phase(channels: &mut [Column], phase: (usize, f64), of: &str) -> Result<(), RecordProblem> {
    let wanted = of.split('[').next().unwrap_or_default().trim();
    let mut fit: Vec<&mut Column> = channels
        .iter_mut()
        .filter(
            |c| if wanted.is_empty() { c.channel.quantity != Quantity::Force } else { c.channel.to_string() == wanted },
        )
        .collect();
    match fit.as_mut_slice() {
        [one] if one.phase.is_none() => {
            one.phase = Some(phase);
            Ok(())
        }
        _ => Err(RecordProblem::WhosePhase { of: wanted.to_owned() }),
    }
}

/// A table needs a force and a response, and every response its phase.
fn check(channels: &[Column]) -> Result<(), RecordProblem> {
    let is_force = |c: &&Column| c.channel.quantity == Quantity::Force;
    if !channels.iter().any(|c| is_force(&c)) {
        return Err(RecordProblem::NoForceColumn);
    }
    match channels.iter().find(|c| !is_force(c) && c.phase.is_none()) {
        Some(column) => Err(RecordProblem::NoPhase { channel: column.channel.to_string() }),
        None => Ok(()),
    }
}

fn run(
    table: &Table<'_>,
    layout: &Layout,
    stepped: &SteppedSine,
    number: usize,
) -> Result<HarmonicsRun, RecordFileError> {
    let (column, to_hz) = layout.frequency;
    let frequency_hz = table.reading(column, to_hz)?;
    if frequency_hz <= 0.0 {
        let text = quote(table.bytes(column));
        return Err(table.error(column, RecordProblem::BadFrequency { text }));
    }
    let mut channels = Vec::new();
    for column in &layout.channels {
        let size = table.reading(column.amplitude, column.unit.to_si)?;
        let phase = column.phase.map_or(Ok(0.0), |(place, unit)| table.reading(place, unit))?;
        let amplitude = c64::new(0.0, phase).exp() * size * turn(column.channel.quantity, stepped.phase_of);
        channels.push(ChannelFit {
            channel: column.channel.clone(),
            offset: 0.0,
            slope: 0.0,
            amplitudes: vec![amplitude],
            covariance: Mat::zeros(2, 2),
            noise: 0.0,
        });
    }
    let level = layout.level.map(|column| level(table, column)).transpose()?;
    let session = layout.session.map(|column| table.text(column)).filter(|name| !name.is_empty());
    let fit = HarmonicFit { omega: TAU * frequency_hz, omega_deviation: 0.0, channels };
    Ok(HarmonicsRun { name: format!("row {number}"), fit, level, session })
}

/// `i^(q - p)`: what the amplitude of a channel must be turned by where the phase is that of another derivative.
fn turn(quantity: Quantity, phase_of: Option<Quantity>) -> c64 {
    let times = |q: Quantity| q.derivatives();
    match (times(quantity), phase_of.and_then(times)) {
        (Some(q), Some(p)) => c64::new(0.0, 1.0).powi(q - p),
        _ => c64::new(1.0, 0.0),
    }
}

fn level(table: &Table<'_>, column: usize) -> Result<i64, RecordFileError> {
    let value = table.number(column)?;
    if value.fract() == 0.0 && value.abs() < 1e15 {
        return Ok(value as i64);
    }
    Err(table.error(column, RecordProblem::BadLevel { text: quote(table.bytes(column)) }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models;

    fn chain() -> Structure {
        models::chain(&[1.0, 2.0], &[1e3, 0.0], &[1e3])
    }

    fn read(text: &str, stepped: &SteppedSine) -> Result<Vec<HarmonicsRun>, String> {
        assert!(is_one(text.as_bytes(), "t.csv").unwrap());
        parse(text.as_bytes(), "t.csv", &chain(), stepped).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_named_by_channels_with_levels_and_sessions() {
        let text = "level,session,frequency_hz,force@1 [N],acc@2 [g],phase_deg acc@2,acc@1 [m/s^2],phase_rad acc@1\n\
                    3,monday,80.5,0.5,0.1,90,2,-0.25\n";
        let runs = read(text, &SteppedSine::default()).unwrap();
        let run = &runs[0];
        assert_eq!((run.name.as_str(), run.level, run.session.as_deref()), ("row 1", Some(3), Some("monday")));
        assert!((run.fit.omega - TAU * 80.5).abs() < 1e-12);
        assert_eq!(run.fit.channels[0].amplitudes, [c64::new(0.5, 0.0)]);
        let second = run.fit.channels[1].amplitudes[0];
        assert!((second - c64::new(0.0, 0.980_665)).norm() < 1e-12, "{second}");
        assert!((run.fit.channels[2].amplitudes[0] - c64::new(0.0, -0.25).exp() * 2.0).norm() < 1e-12);
    }

    #[test]
    fn plain_columns_take_their_channels_from_the_project() {
        let text = "frequency_hz;force;amplitude;phase_deg\n80,5;0,5;2;-90\n";
        let stepped = SteppedSine {
            force: Some("force@1 [N]"),
            response: Some("acc@1 [m/s^2]"),
            phase_of: Some(Quantity::Displacement),
        };
        let run = &read(text, &stepped).unwrap()[0];
        // The displacement lags by 90 degrees, so the acceleration leads by 90.
        let acceleration = run.fit.channels[1].amplitudes[0];
        assert!((acceleration - c64::new(0.0, 2.0)).norm() < 1e-12, "{acceleration}");
        let displacement = run.fit.displacement(0).unwrap().amplitudes[0];
        assert!(displacement.im < 0.0 && displacement.re.abs() < 1e-12 * displacement.im.abs());
    }

    #[test]
    fn what_is_missing_is_said_in_one_line() {
        let stepped = SteppedSine::default();
        let said = |text: &str| read(text, &stepped).unwrap_err();
        let which = said("frequency_hz,force,acc@1 [g],phase_deg\n1,1,1,1\n");
        assert!(which.starts_with("t.csv, line 1: which channel the column \"force\" is, is not said"), "{which}");
        let whose = said("frequency_hz,force@1 [N],acc@1 [g],acc@2 [g],phase_deg\n1,1,1,1,1\n");
        assert!(whose.contains("name its channel"), "{whose}");
        let phase = said("frequency_hz,force@1 [N],acc@1 [g],acc@2 [g],phase_deg acc@2\n1,1,1,1,1\n");
        assert!(phase.contains("acc@1 has no phase"), "{phase}");
        let force = said("frequency_hz,acc@1 [g],phase_deg\n1,1,1\n");
        assert!(force.contains("no force"), "{force}");
        let large = said("frequency_hz,force@1 [N],acc@1 [g],phase_deg\n1,1,2e30,1\n");
        assert!(large.starts_with("t.csv, line 2, acc@1 [g]: 1.96"), "{large}");
        assert!(large.contains("is more than any sensor reads"), "{large}");
        let level = said("level,frequency_hz,force@1 [N],acc@1 [g],phase_deg\n1.5,1,1,1,1\n");
        assert!(level.contains("line 2, level: \"1.5\" is not the number of a level"), "{level}");
    }
}

//! A model where decays come without one: a mass on a spring, with the frequency that the clearest channel shows.

use super::text::comment;
use crate::diagnosis::records::amplitude::{AmplitudePoint, Band, amplitude_curve, peaks};
use crate::exchange::mapping::units::LabUnit;
use crate::exchange::mapping::{ChannelTable, NotMapped, Proposal};
use crate::math::numerals::rounded;
use crate::measurement::{Kind, Quantity, Record, TimeSpan, proposal};
use std::f64::consts::TAU;

/// Fewest periods in which a channel must decay.
const PERIODS: f64 = 8.0;
/// Fewest points of a curve of frequency and damping over the amplitude.
const POINTS: usize = 4;
/// Amplitude over its deviation from which on a piece counts.
const CLEAR: f64 = 10.0;
/// Pieces of a decay that are looked at, and their length in periods.
const PIECES: usize = 16;
const EACH: f64 = 4.5;

/// One mode out of decays.
pub(super) struct SingleMode {
    channel: String,
    frequency_hz: f64,
}

impl SingleMode {
    /// Stiffness of 1 kg, N/m.
    fn stiffness(&self) -> f64 {
        (TAU * self.frequency_hz).powi(2)
    }

    /// `[structure]`.
    pub(super) fn structure(&self) -> String {
        let what = comment(&format!(
            "No model is given: one mass on a spring, with the {:.5} Hz that \"{}\" has at its smallest amplitudes. The mass is not \
             known: 1 kg stands there, so that forces and coefficients are those a kilogram. Fill in the modal mass at this DOF \
             and multiply the stiffness by it, or give a model by --mass. Damping ratios do not depend on it.",
            self.frequency_hz, self.channel
        ));
        let stiffness = rounded(self.stiffness(), 7);
        format!(
            "[structure]\n{what}kind = \"chain\"\nmasses = [1.0]                # kg\nground_stiffness = [{stiffness:?}] # N/m\ncoupling_stiffness = []\n"
        )
    }

    /// What was assumed, in one line.
    pub(super) fn words(&self) -> String {
        format!(
            "no model is given: one mass of 1 kg on a spring at {:.5} Hz, by \"{}\"; fill in the mass under [structure]",
            self.frequency_hz, self.channel
        )
    }
}

/// The mode that the clearest channel of a record without a force shows; the mapping is left with that channel alone, at DOF 1.
/// None where no channel decays clearly.
pub(super) fn single_mode(record: &Record, mapping: &mut Proposal) -> Option<SingleMode> {
    let all: Vec<ChannelTable> = mapping.channels.clone();
    let motion = |table: &ChannelTable| !matches!(table.quantity, Quantity::Force | Quantity::Base);
    let found = all.iter().enumerate().filter(|(_, table)| motion(table)).filter_map(|(i, table)| {
        let at = record.channels().iter().position(|channel| channel.to_string() == table.channel())?;
        let (frequency_hz, clear) = decaying(record, at)?;
        Some((i, frequency_hz, clear))
    });
    let (at, frequency_hz, _) = found.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let before = all[at].channel();
    let own = |assumed: &(String, String)| assumed.0 == before && !assumed.1.starts_with("the file says no DOF");
    mapping.assumed.retain(own);
    let mut table = all[at].clone();
    "1".clone_into(&mut table.dof);
    translated(&mut table, &mut mapping.assumed);
    mapping.assumed.iter_mut().for_each(|(name, _)| *name = table.channel());
    for (_, other) in all.iter().enumerate().filter(|(i, _)| *i != at) {
        let why = format!("one mass follows one channel, the clearest, \"{}\"", all[at].name);
        mapping.left.push((other.name.clone(), NotMapped::Other(why)));
    }
    mapping.uncalibrated.clear();
    let channel = table.name.clone();
    mapping.channels = vec![table];
    Some(SingleMode { channel, frequency_hz })
}

/// An angle stands for the displacement of the one mass.
fn translated(table: &mut ChannelTable, assumed: &mut Vec<(String, String)>) {
    let Some(unit) = table.unit.as_deref().and_then(LabUnit::from_name).filter(|unit| unit.rotation) else { return };
    table.unit = Some(table.quantity.si_unit(false).to_owned());
    table.factor = Some(unit.to_si * table.factor.unwrap_or(1.0));
    let what = "the angle in rad stands for the displacement, so that the mass is a moment of inertia".to_owned();
    assumed.push((table.channel(), what));
}

/// Frequency (Hz) of the smallest amplitudes of a channel that decays, and how clear it is: the sum of the logarithms of amplitude over
/// deviation.
fn decaying(record: &Record, channel: usize) -> Option<(f64, f64)> {
    let samples = record.samples(channel).to_vec();
    let alone = Record::new(record.time().to_vec(), vec![record.channels()[channel].clone()], vec![samples]).ok()?;
    let proposal::Proposal { kind, part, .. } = proposal::propose(&alone);
    if kind != Kind::Decay {
        return None;
    }
    let range = TimeSpan { end_s: None, ..part }.samples(alone.time());
    let signal = alone.samples(0).get(range)?;
    let step = alone.step();
    let near = *peaks(signal, step, 0.5, 1).first()?;
    if signal.len() as f64 * step * near < PERIODS {
        return None;
    }
    let length = (EACH / (near * step)).ceil() as usize;
    let apart = (signal.len().saturating_sub(length) / (PIECES - 1)).max(1);
    let pieces = (0..PIECES).filter_map(|i| signal.get(i * apart..i * apart + length));
    let band = Band { frequency_hz: near, width: 0.0 };
    let clear = |point: &AmplitudePoint| (point.amplitude / point.amplitude_deviation.max(f64::MIN_POSITIVE)).min(1e6);
    let curve: Vec<AmplitudePoint> = pieces.filter_map(|piece| amplitude_curve(piece, step, 0.0, band).pop()).collect();
    let curve: Vec<AmplitudePoint> = curve.into_iter().filter(|point| clear(point) > CLEAR).collect();
    if curve.len() < POINTS {
        return None;
    }
    let mut last: Vec<f64> = curve[2 * curve.len() / 3..].iter().map(|point| point.frequency_hz).collect();
    Some((median(&mut last), curve.iter().map(|point| clear(point).ln()).sum()))
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

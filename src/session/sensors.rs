//! Known errors of the measuring chain in a project file.

use super::refusal::Refusal;
use crate::effects::{Kind, Source};
use crate::exchange::project::file::{ProjectFile, SensorTable};
use crate::exchange::project::lines::At;
use crate::exchange::project::sources::sensors;
use crate::structure::Structure;

/// States delay (s) and gain of a channel in place of what is stated of it.
pub(super) fn set_sensor(
    file: &mut ProjectFile,
    channel: &str,
    values: [Option<f64>; 2],
    on: &Structure,
) -> Result<(), Refusal> {
    let [delay, gain] = values;
    let table = SensorTable { channel: channel.into(), delay, gain };
    sensors(std::slice::from_ref(&table), on, At::NOWHERE)?;
    file.sensor.retain(|sensor| sensor.channel.trim() != channel.trim());
    if table.errors().next().is_some() {
        file.sensor.push(table);
    }
    Ok(())
}

/// Delay (s) and gain of a channel with a further error on top of what is stated of it.
pub(super) fn further(file: &ProjectFile, channel: &str, error: &Source) -> [Option<f64>; 2] {
    let stated = file.sensor_at(channel);
    let (mut delay, mut gain) = (stated.and_then(|s| s.delay), stated.and_then(|s| s.gain));
    if let (Kind::Channel(law), Some(more)) = (error.effect.kind(), error.parameters.first()) {
        let value = if law.turns_phase() { &mut delay } else { &mut gain };
        *value = Some(law.joined(value.unwrap_or(law.neutral()), *more)).filter(|value| *value != law.neutral());
    }
    [delay, gain]
}

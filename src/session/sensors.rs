//! Known errors of the measuring chain in a project file.

use super::refusal::Refusal;
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

/// States that a channel is recorded `more` seconds late beside what is stated of it.
pub(super) fn delay_further(file: &mut ProjectFile, channel: &str, more: f64, on: &Structure) -> Result<(), Refusal> {
    let stated = file.sensor_at(channel);
    let (delay, gain) = (stated.and_then(|s| s.delay).unwrap_or(0.0), stated.and_then(|s| s.gain));
    set_sensor(file, channel, [Some(delay + more), gain], on)
}

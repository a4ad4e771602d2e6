//! Known errors of the measuring chain in a project file.

use super::refusal::Refusal;
use crate::effects::{Place, Source};
use crate::exchange::project::file::{ProjectFile, SensorTable};
use crate::measurement::Quantity;
use crate::structure::Structure;

/// States delay (s) and gain of a channel in place of what is stated of it.
pub(super) fn set_sensor(
    file: &mut ProjectFile,
    channel: &str,
    values: [Option<f64>; 2],
    on: &Structure,
) -> Result<(), Refusal> {
    let wrong = || Refusal::NoSuchChannel { channel: channel.into() };
    let (word, label) = channel.split_once('@').ok_or_else(wrong)?;
    Quantity::from_word(word).ok_or_else(wrong)?;
    on.require_dof(label)?;
    let [delay, gain] = values;
    let table = SensorTable { channel: channel.into(), delay, gain };
    for (effect, value) in table.errors() {
        Source::known(effect, Place::Channel(channel.into()), &[value]).check()?;
    }
    file.sensor.retain(|sensor| sensor.channel != channel);
    if table.errors().next().is_some() {
        file.sensor.push(table);
    }
    Ok(())
}

/// States that a channel is recorded `more` seconds late beside what is stated of it.
pub(super) fn delay_further(file: &mut ProjectFile, channel: &str, more: f64, on: &Structure) -> Result<(), Refusal> {
    let stated = file.sensor.iter().find(|table| table.channel.trim() == channel);
    let (delay, gain) = (stated.and_then(|s| s.delay).unwrap_or(0.0), stated.and_then(|s| s.gain));
    set_sensor(file, channel, [Some(delay + more), gain], on)
}

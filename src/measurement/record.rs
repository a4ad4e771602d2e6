//! A time record in SI units that holds only finite numbers at times that never go back.

use super::channel::Channel;
use std::ops::Range;

/// Fewest samples of a record: one unknown more than offset, slope and one harmonic.
pub(crate) const FEWEST_SAMPLES: usize = 5;

/// Largest share of times that may equal the one before. A few repeated samples are a finding; many mean that the
/// times were written with too few digits to be used.
const MOST_REPEATED: f64 = 0.1;

/// Largest number that is taken for a measurement, SI units; squares of larger ones soon overflow.
pub(crate) const MOST: f64 = crate::math::GREATEST;

/// A time record: `samples[channel][n]` at `time[n]`.
///
/// Its constructor refuses NaN, unequal lengths, times that go back, two channels of the same name. A time that is
/// repeated is kept: it harms no fit, and [`super::quality`] shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub(crate) time: Vec<f64>,
    pub(crate) channels: Vec<Channel>,
    pub(crate) samples: Vec<Vec<f64>>,
    pub(crate) resolution: Vec<f64>,
}

/// Why numbers make no record. `row` counts samples from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum RecordError {
    #[error("there is no channel beside the time; add one, such as acc@7 [m/s^2]")]
    NoChannel,
    #[error("there are {found} samples; a record needs at least {FEWEST_SAMPLES}")]
    TooFewSamples { found: usize },
    #[error("{channel} has {found} samples and the time has {expected}; give both the same number")]
    UnequalLengths { channel: String, found: usize, expected: usize },
    #[error("there are {channels} channels and {columns} columns of samples; give one column a channel")]
    UnequalColumns { channels: usize, columns: usize },
    #[error("{channel} stands twice; remove or rename one")]
    DuplicateChannel { channel: String },
    #[error("sample {row} of {channel} is {}; remove the row or mend the number", no_number(*value))]
    NotFinite { channel: String, row: usize, value: f64 },
    #[error("time {time} s of sample {row} follows {before} s; sort the rows by time")]
    TimeGoesBack { row: usize, time: f64, before: f64 },
    #[error("{repeated} of {total} times equal the one before; write the time with more digits")]
    TimeTooCoarse { repeated: usize, total: usize },
}

impl Record {
    /// Checks and keeps `samples[channel][n]` (SI units) at `time[n]` (s).
    pub fn new(time: Vec<f64>, channels: Vec<Channel>, samples: Vec<Vec<f64>>) -> Result<Self, RecordError> {
        check_channels(&channels, &samples)?;
        check_time(&time)?;
        for (channel, values) in channels.iter().zip(&samples) {
            check_values(channel, values, time.len())?;
        }
        let resolution = vec![0.0; channels.len()];
        Ok(Self { time, channels, samples, resolution })
    }

    /// The samples of a range alone.
    ///
    /// # Errors
    /// [`RecordError::TooFewSamples`].
    pub fn part(&self, range: Range<usize>) -> Result<Self, RecordError> {
        let samples = self.samples.iter().map(|values| values[range.clone()].to_vec()).collect();
        let part = Self::new(self.time[range].to_vec(), self.channels.clone(), samples)?;
        Ok(part.with_resolution(self.resolution.clone()))
    }

    /// The record with every channel rounded; `round` mends the samples and gives the step of the rounding.
    #[must_use]
    pub fn quantised(mut self, round: impl Fn(&mut [f64]) -> f64) -> Self {
        self.resolution = self.samples.iter_mut().map(|samples| round(samples)).collect();
        self
    }

    /// States the steps in which the numbers of each channel were written (SI units, 0 for exact), one a channel. The
    /// fit counts their rounding as noise: it may repeat in every period and then shows in no scatter.
    #[must_use]
    pub fn with_resolution(mut self, resolution: Vec<f64>) -> Self {
        if resolution.len() == self.channels.len() {
            self.resolution = resolution;
        }
        self
    }

    /// Times, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Channels in the order of the file.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The first sample that is larger than anything a sensor reads: channel and row, from 0.
    pub(crate) fn beyond_measure(&self) -> Option<(usize, usize)> {
        let beyond = |values: &Vec<f64>| values.iter().position(|value| value.abs() > MOST);
        self.samples.iter().enumerate().find_map(|(c, values)| Some((c, beyond(values)?)))
    }

    /// Samples of channel number `channel` in SI units.
    pub fn samples(&self, channel: usize) -> &[f64] {
        &self.samples[channel]
    }

    /// Step in which the numbers of channel number `channel` were written, SI units; 0 for exact.
    pub fn resolution(&self, channel: usize) -> f64 {
        self.resolution[channel]
    }

    /// Number of samples of a channel.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample; never true for a record that was built.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Time from the first to the last sample, s.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// Mean time between samples, s.
    pub fn step(&self) -> f64 {
        self.duration() / (self.len() - 1) as f64
    }
}

fn check_channels(channels: &[Channel], samples: &[Vec<f64>]) -> Result<(), RecordError> {
    if channels.is_empty() {
        return Err(RecordError::NoChannel);
    }
    if channels.len() != samples.len() {
        return Err(RecordError::UnequalColumns { channels: channels.len(), columns: samples.len() });
    }
    for (i, channel) in channels.iter().enumerate() {
        if channels[..i].iter().any(|other| other.quantity == channel.quantity && other.label == channel.label) {
            return Err(RecordError::DuplicateChannel { channel: channel.to_string() });
        }
    }
    Ok(())
}

fn check_time(time: &[f64]) -> Result<(), RecordError> {
    if let Some(n) = time.iter().position(|t| !t.is_finite()) {
        return Err(RecordError::NotFinite { channel: "time".to_owned(), row: n + 1, value: time[n] });
    }
    if let Some(n) = time.windows(2).position(|pair| pair[1] < pair[0]) {
        return Err(RecordError::TimeGoesBack { row: n + 2, time: time[n + 1], before: time[n] });
    }
    if time.len() < FEWEST_SAMPLES {
        return Err(RecordError::TooFewSamples { found: time.len() });
    }
    let total = time.len() - 1;
    let repeated = time.windows(2).filter(|pair| pair[1] == pair[0]).count();
    if repeated as f64 > MOST_REPEATED * total as f64 {
        return Err(RecordError::TimeTooCoarse { repeated, total });
    }
    Ok(())
}

/// A number that is none, in words: readers give NaN for cells that are empty.
fn no_number(value: f64) -> String {
    if value.is_nan() { "NaN or left empty".to_owned() } else { value.to_string() }
}

fn check_values(channel: &Channel, values: &[f64], expected: usize) -> Result<(), RecordError> {
    if values.len() != expected {
        let channel = channel.to_string();
        return Err(RecordError::UnequalLengths { channel, found: values.len(), expected });
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(n) => Err(RecordError::NotFinite { channel: channel.to_string(), row: n + 1, value: values[n] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::Quantity;

    fn channel(label: &str) -> Channel {
        Channel { quantity: Quantity::Velocity, dof: 0, label: label.to_owned() }
    }

    fn message(time: &[f64], samples: Vec<Vec<f64>>) -> String {
        let channels = (0..samples.len()).map(|c| channel(&c.to_string())).collect();
        Record::new(time.to_vec(), channels, samples).unwrap_err().to_string()
    }

    #[test]
    fn what_is_no_record_is_refused_with_its_row() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        assert_eq!(message(&time[..3], vec![vec![0.0; 3]]), "there are 3 samples; a record needs at least 5");
        assert_eq!(
            message(&time, vec![vec![0.0, 1.0, f64::NAN, 0.0, 0.0]]),
            "sample 3 of vel@0 is NaN or left empty; remove the row or mend the number"
        );
        assert_eq!(
            message(&[0.0, 1.0, 0.5, 3.0, 4.0], vec![vec![0.0; 5]]),
            "time 0.5 s of sample 3 follows 1 s; sort the rows by time"
        );
        assert_eq!(
            message(&[0.0, 1.0, 1.0, 2.0, 2.0], vec![vec![0.0; 5]]),
            "2 of 4 times equal the one before; write the time with more digits"
        );
        assert_eq!(
            message(&time, vec![vec![0.0; 4]]),
            "vel@0 has 4 samples and the time has 5; give both the same number"
        );
    }

    #[test]
    fn two_channels_of_one_name_are_refused() {
        let made = Record::new(vec![0.0; 5], vec![channel("1"), channel("1")], vec![vec![0.0; 5]; 2]);
        assert_eq!(made.unwrap_err(), RecordError::DuplicateChannel { channel: "vel@1".to_owned() });
    }
}

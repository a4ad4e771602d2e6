//! One run that is not in steady state: a part of a record in time.

use super::channel::{Channel, Quantity};
use super::finding::Finding;
use super::kind::{Kind, TimeSpan};
use super::record::Record;
use crate::math::decimation::{decimated, kept};
use std::ops::Range;
use std::sync::Arc;

/// A decay or a transient record and the part of it that is used.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientRun {
    /// Name of the file, for messages and results.
    pub file: String,
    /// The whole record in equal steps, channels corrected for their known errors.
    pub record: Arc<Record>,
    /// Decay or transient.
    pub kind: Kind,
    /// The part that is used, as the project says it.
    pub part: TimeSpan,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Label of the session: runs without re-assembly between them.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// What is wrong with the record, each with its reason in words.
    pub findings: Vec<Finding>,
    /// Whether its forces are those of a moving base, whose acceleration was measured in their place.
    pub(crate) on_moving_base: bool,
    pub(super) samples: Range<usize>,
}

/// What a run is called and what is done with it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TransientLabel {
    /// Name of the file.
    pub file: String,
    /// Decay or transient.
    pub kind: Kind,
    /// The part that is used.
    pub part: TimeSpan,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Label of the session.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// Time constant of the exponential window that the recorder laid over the motion from the start of the record on, s.
    pub exponential_window_s: Option<f64>,
}

impl TransientRun {
    /// The same run of another record with the same instants.
    pub(crate) fn with_record(&self, record: Arc<Record>) -> Self {
        Self { record, ..self.clone() }
    }

    /// Numbers of the samples of the record that are used.
    pub fn range(&self) -> Range<usize> {
        self.samples.clone()
    }

    /// Number of samples that are used.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Whether no sample is used; never true.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Instants of the part that is used, s.
    pub fn time(&self) -> &[f64] {
        &self.record.time()[self.samples.clone()]
    }

    /// Channels in the order of the record.
    pub fn channels(&self) -> &[Channel] {
        self.record.channels()
    }

    /// Samples of a channel in the part that is used, SI units.
    pub fn samples(&self, channel: usize) -> &[f64] {
        &self.record.samples(channel)[self.samples.clone()]
    }

    /// Time between samples, s.
    pub fn step(&self) -> f64 {
        let time = self.time();
        (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64
    }

    /// Numbers of the channels that measure motion.
    pub fn response_channels(&self) -> Vec<usize> {
        self.numbers(|quantity| quantity != Quantity::Force)
    }

    /// Numbers of the channels that measure forces. A decay has none: nothing acts on it.
    pub fn force_channels(&self) -> Vec<usize> {
        if self.kind == Kind::Decay { Vec::new() } else { self.numbers(|quantity| quantity == Quantity::Force) }
    }

    /// Every `factor`-th sample of the part that is used, behind a filter against aliasing; what the filter does not cover wholly at both
    /// ends is left out. `None` where too little is left.
    pub(crate) fn decimated(&self, factor: usize) -> Option<Self> {
        let time = kept(self.len(), factor).map(|n| self.time()[n]).collect();
        let samples = (0..self.channels().len()).map(|c| decimated(self.samples(c), factor)).collect();
        let record = Record::new(time, self.channels().to_vec(), samples).ok()?;
        Some(Self { samples: 0..record.time().len(), record: Arc::new(record), ..self.clone() })
    }

    fn numbers(&self, wanted: impl Fn(Quantity) -> bool) -> Vec<usize> {
        (0..self.channels().len()).filter(|&c| wanted(self.channels()[c].quantity)).collect()
    }
}

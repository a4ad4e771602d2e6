//! Errors of the mode shapes of the model and gains of the channels: channel `k` shows mode `r` with `phi_r(k) + s_r e_rk` in
//! place of `phi_r(k)`, `s_r^2` being the mean of `phi_r(k)^2` over the channels.
//!
//! No laboratory's model has springs and masses, and no sensor a gain, that are right to a percent (Friswell and Mottershead
//! 1995, chapter 2: modelling errors show in frequencies and in shapes). Frequencies are corrected mode by mode; a gain is an
//! error in proportion to all shapes of a channel. All records of a project share them. Each channel of a record has an offset
//! of its own besides: amplifiers drift, and a constant is otherwise taken for a spring that pulls to one side.

use super::data::{RecordData, Records};
use crate::measurement::Channel;

impl Records<'_> {
    /// Number of channels that differ.
    pub(super) fn sensors(&self) -> usize {
        self.sensors.len()
    }

    /// Whether one sensor shows one mode under a measured force: the error of that shape is one of the mass, which a project states.
    pub(super) fn has_one_shape(&self) -> bool {
        self.kept == 1 && self.sensors.len() == 1 && self.list.iter().any(RecordData::shows_mass)
    }

    /// Which of the channels that differ channel `c` of a record is.
    pub(super) fn sensor(&self, record: &RecordData, c: usize) -> usize {
        let channel = &record.channels[c];
        let same = |s: &Channel| s.dof == channel.dof && s.quantity == channel.quantity;
        self.sensors.iter().position(same).unwrap_or(0)
    }

    /// `s_r` of a kept mode, kg^(-1/2).
    pub(super) fn shape_size(&self, mode: usize) -> f64 {
        let square: f64 = self.sensors.iter().map(|s| self.modes.shapes[(s.dof, mode)].powi(2)).sum();
        (square / self.sensors.len().max(1) as f64).sqrt()
    }

    /// Shapes as the model has them, `[sensor][mode]`.
    pub(super) fn no_shape_errors(&self) -> Vec<Vec<f64>> {
        vec![vec![0.0; self.kept]; self.sensors.len()]
    }

    /// Channels without an offset, `[record][channel]`.
    pub(super) fn no_offsets(&self) -> Vec<Vec<f64>> {
        self.list.iter().map(|r| vec![0.0; r.channels.len()]).collect()
    }

    /// Most channels of a record.
    pub(super) fn most_channels(&self) -> usize {
        self.list.iter().map(|r| r.channels.len()).max().unwrap_or(0)
    }

    /// What the channels of a record show more of each kept mode than the model, kg^(-1/2), with `errors` of the sensors.
    pub(super) fn shape_errors(&self, record: &RecordData, errors: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let errors_of_channel = |c: usize| -> Vec<f64> {
            let own = errors.get(self.sensor(record, c)).into_iter().flatten();
            own.enumerate().map(|(r, e)| e * self.shape_size(r)).collect()
        };
        (0..record.channels.len()).map(errors_of_channel).collect()
    }
}

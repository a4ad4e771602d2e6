//! Relative errors of the channels of a record.

use super::data::RecordData;
use crate::math::statistics::root_mean_square;

/// `|y - y_model| / |y|` of every channel of a record over some samples; `|y|` at least a twentieth of the largest of its
/// quantity.
pub(crate) fn channel_errors(record: &RecordData, model: &[Vec<f64>], samples: std::ops::Range<usize>) -> Vec<f64> {
    let size = |y: &[f64]| root_mean_square(&y[samples.clone()]);
    let largest = |c: usize| {
        let same = (0..record.channels.len()).filter(|&k| record.channels[k].quantity == record.channels[c].quantity);
        same.map(|k| size(&record.samples[k])).fold(0.0, f64::max)
    };
    let channel_error = |c: usize| {
        let left: Vec<f64> = samples.clone().map(|n| record.samples[c][n] - model[c][n]).collect();
        let scale = size(&record.samples[c]).max(largest(c) / 20.0);
        if scale > 0.0 { root_mean_square(&left) / scale } else { 0.0 }
    };
    (0..record.channels.len()).map(channel_error).collect()
}

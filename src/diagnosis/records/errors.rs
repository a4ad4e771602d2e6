//! Relative errors of the channels of a record.

use super::data::RecordData;
use crate::math::statistics::root_mean_square;

/// Root mean square of a part over that of the whole record below which the motion has died out there, and what is left is noise.
const DIED_OUT: f64 = 0.1;

/// `|y - y_model| / |y|` of every channel of a record over some samples; `|y|` at least a twentieth of the largest of its
/// quantity, and a tenth of that of the whole record.
pub(crate) fn channel_errors(record: &RecordData, model: &[Vec<f64>], samples: std::ops::Range<usize>) -> Vec<f64> {
    let size = |c: usize| {
        let whole = root_mean_square(&record.samples[c]);
        root_mean_square(&record.samples[c][samples.clone()]).max(DIED_OUT * whole)
    };
    let largest = |c: usize| {
        let same = (0..record.channels.len()).filter(|&k| record.channels[k].quantity == record.channels[c].quantity);
        same.map(size).fold(0.0, f64::max)
    };
    let channel_error = |c: usize| {
        let left: Vec<f64> = samples.clone().map(|n| record.samples[c][n] - model[c][n]).collect();
        let scale = size(c).max(largest(c) / 20.0);
        if scale > 0.0 { root_mean_square(&left) / scale } else { 0.0 }
    };
    (0..record.channels.len()).map(channel_error).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::diagnosis::records::data::Records;

    /// Where a motion has died out its error is not that of noise over nothing.
    #[test]
    fn noise_after_the_motion_is_small_beside_the_motion() {
        let structure = chain(&[1.0], &[400.0], &[]);
        let noise = |n: usize| 1e-5 * (1.7 * n as f64).sin();
        let wave = |n: usize| 1e-2 * (-0.02 * n as f64).exp() * (0.2 * n as f64).cos();
        let run = decay(1e-2, vec![(0..2000).map(|n| wave(n) + noise(n)).collect()]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let record = &records.list[0];
        let model = vec![(0..record.len()).map(wave).collect::<Vec<f64>>()];
        let [whole, end] =
            [0..record.len(), record.len() / 2..record.len()].map(|part| channel_errors(record, &model, part)[0]);
        assert!(whole < 0.02 && end < 0.12 && end > whole, "{whole} {end}");
    }
}

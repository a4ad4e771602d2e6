//! What holds for the responses of files of every format.

use crate::measurement::frf::ResponseSet;

/// Largest difference of the frequencies of two functions, relative.
const SAME: f64 = 1e-6;

/// Whether two functions have the same frequencies, Hz.
pub(super) fn same_frequencies(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * b.abs().max(1e-9))
}

/// Whether all values are between 0 and 1 but for rounding.
pub(super) fn is_coherence(values: &[f64]) -> bool {
    const ROUNDING: f64 = 1e-3;
    values.iter().all(|g2| *g2 >= -ROUNDING && *g2 <= 1.0 + ROUNDING)
}

/// Leaves out the line at 0 Hz, which is no motion.
pub(super) fn drop_zero(set: &mut ResponseSet) {
    let from = set.frequencies_hz.iter().take_while(|f| **f <= 0.0).count();
    set.frequencies_hz.drain(..from);
    for function in &mut set.functions {
        function.values.drain(..from);
        if let Some(coherence) = &mut function.coherence {
            coherence.drain(..from);
        }
    }
}

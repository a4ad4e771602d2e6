//! Harmonics above those that are asked for, which leak into them where they are not fitted beside them.
//!
//! Over `P` periods a harmonic of amplitude `A_k` that is not fitted adds to the amplitude of harmonic `h` up to
//! `A_k |sin pi (k - h) P| / (pi |k - h| P)`: nothing over whole periods, else as much as the noise of hundreds of samples. A stop or
//! friction makes such harmonics without end.

use std::f64::consts::PI;

/// Most harmonics that are fitted, and the factor by which their number grows.
const MOST: usize = 63;
const GROWTH: usize = 3;
/// Share of the deviation of an amplitude that harmonics which are not fitted may add to it.
const SHARE: f64 = 0.2;
/// Distance from whole periods over which harmonics a few apart begin to leak.
const NEARLY_WHOLE: f64 = 0.05;

/// How many harmonics to fit where those up to `fitted` leave others that leak.
pub(super) fn further(fitted: usize) -> usize {
    MOST.min(GROWTH * fitted)
}

/// Whether harmonics that a fit over `periods` leaves would add to an amplitude more than a share of its deviation, of `count` samples
/// of which it leaves the mean square `left`, and of which `noise` is the variance.
pub(super) fn leaks(periods: f64, count: usize, left: f64, noise: f64) -> bool {
    let broken = ((periods - periods.round()).abs() / NEARLY_WHOLE).min(1.0);
    let leaked = broken * (2.0 * (left - noise).max(0.0)).sqrt() / (PI * periods);
    leaked > SHARE * (2.0 * noise / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::leaks;

    /// A harmonic of a tenth that is left over 20.4 periods adds up to 5e-4, ten deviations of amplitudes of 1000 samples with 1e-3 of
    /// noise; over 20 periods it adds nothing.
    #[test]
    fn harmonics_leak_over_broken_periods() {
        assert!(leaks(20.4, 1000, 0.005, 1e-6) && !leaks(20.0, 1000, 0.005, 1e-6));
        assert!(!leaks(20.4, 1000, 1.01e-6, 1e-6) && !leaks(20_000.4, 1000, 0.005, 1e-6));
    }
}

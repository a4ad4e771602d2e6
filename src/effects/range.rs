//! Range of a relative motion over the runs: what the start grid of a law is laid over, and its limits are judged by.

use super::motion::Motion;

/// Sizes of a relative motion over several runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Largest relative displacement, m.
    pub displacement: f64,
    /// Least of the runs' amplitudes, m.
    pub least: f64,
    /// Largest relative velocity, m/s.
    pub velocity: f64,
    /// Geometric mean of the circular frequencies, rad/s.
    pub omega: f64,
}

/// Share of the largest amplitude below which motion counts as rest where it is asked when a slider slips.
const DEEPEST: f64 = 1e-4;
/// Ratio of neighbouring extensions at most: slipping begins so gradually that fits find their way over a factor of two.
const APART: f64 = 2.5;
/// Fewest extensions.
const FEWEST: usize = 8;

impl Range {
    /// Of a motion of which nothing is known: no comparison with it holds.
    pub const UNKNOWN: Self = Self { displacement: f64::NAN, least: f64::NAN, velocity: f64::NAN, omega: f64::NAN };

    /// Of sampled motions, one a run.
    pub fn of(motions: &[Motion]) -> Self {
        let peak = |x: &[f64]| x.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let sizes: Vec<f64> = motions.iter().map(|m| peak(&m.displacement)).collect();
        let logarithms: f64 = motions.iter().map(|m| m.omega.ln()).sum();
        Self {
            displacement: sizes.iter().copied().fold(0.0, f64::max),
            least: sizes.iter().copied().fold(f64::INFINITY, f64::min),
            velocity: motions.iter().map(|m| peak(&m.velocity)).fold(0.0, f64::max),
            omega: (logarithms / motions.len().max(1) as f64).exp(),
        }
    }

    /// Of motions of which the circular frequency (rad/s) and the amplitude (m) of the fundamental are known, one pair a run.
    pub fn of_amplitudes(pairs: impl Iterator<Item = [f64; 2]>) -> Self {
        let empty = Self { displacement: 0.0, least: f64::INFINITY, velocity: 0.0, omega: 0.0 };
        let mut count = 0.0;
        let sum = pairs.fold(empty, |range, [omega, amplitude]| {
            count += 1.0;
            Self {
                displacement: range.displacement.max(amplitude),
                least: range.least.min(amplitude),
                velocity: range.velocity.max(omega * amplitude),
                omega: range.omega + omega.ln(),
            }
        });
        if count == 0.0 { Self::UNKNOWN } else { Self { omega: (sum.omega / count).exp(), ..sum } }
    }

    /// Extensions (m) at which a slider may begin to slip: from well below the least amplitude to the largest, which over several modes
    /// are decades apart.
    pub fn yields(&self) -> Vec<f64> {
        let (first, last) = (0.3 * self.least.max(DEEPEST * self.displacement), 0.95 * self.displacement);
        let ratios = ((last / first).ln() / APART.ln()).ceil();
        geometric(first, last, FEWEST.max(ratios as usize + 1))
    }
}

/// `count` values from `first` to `last` in equal ratios.
pub(crate) fn geometric(first: f64, last: f64, count: usize) -> Vec<f64> {
    let (first, last) = (first.max(1e-300), last.max(1e-300));
    let ratio = (last / first).powf(1.0 / (count.max(2) - 1) as f64);
    (0..count).map(|k| first * ratio.powi(k as i32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Sampling;
    use faer::c64;

    /// Extensions begin below the least motion however far it is below the largest, and none is farther from the next than is asked.
    #[test]
    fn yields_reach_below_the_least_of_motions_that_are_decades_apart() {
        for least in [5e-3, 1e-4, 1e-5] {
            let range = Range::of_amplitudes([[10.0, 1e-2], [100.0, least]].into_iter());
            let yields = range.yields();
            assert!(yields[0] <= 0.31 * least && yields.len() >= 8, "{yields:?}");
            assert!(yields.windows(2).all(|pair| pair[1] / pair[0] < 2.5001), "{yields:?}");
        }
    }

    /// Sampled sines have the range of their amplitudes; of no motion nothing is known.
    #[test]
    fn amplitudes_tell_the_range_of_sampled_motions() {
        let pairs = [[10.0, 2e-3], [40.0, 1e-3]];
        let sampling = Sampling::new(4096);
        let motion = |[omega, amplitude]: [f64; 2]| sampling.motion(omega, 0.0, &[c64::new(amplitude, 0.0)]);
        let (by_samples, told) = (Range::of(&pairs.map(motion)), Range::of_amplitudes(pairs.into_iter()));
        let list = |r: Range| [r.displacement, r.least, r.velocity, r.omega];
        for (a, b) in list(by_samples).into_iter().zip(list(told)) {
            assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        }
        assert!(Range::of_amplitudes(std::iter::empty()).omega.is_nan());
    }
}

//! Noise of the channels of a record, as it shows in the highest quarter of its spectrum.
//!
//! Where the exciter fills that quarter as well, what stands there is motion. It is coherent with the forces, noise is not: of the lines of
//! `n` overlapping segments, `Y = sum_j H_j U_j` with the `H_j` that leave least is taken out (Bendat and Piersol, *Random Data*, chapter 7:
//! multiple coherence).

use crate::math::spectrum::Spectrum;
use crate::math::statistics::median;
use dashpot_numerics::RealTransform;
use faer::c64;
use std::f64::consts::TAU;

/// Share of the lines of a spectrum above which they show noise.
const HIGH: f64 = 0.75;
/// Segments of a record without overlap; with half of it there are twice as many less one, for each force some.
const SEGMENTS: usize = 16;
/// Fewest samples of a segment: a mode rings out within it, or it is not coherent.
const SHORTEST: usize = 64;

/// Noise of a channel of motion under these forces; at least rounding of its largest sample.
pub(super) fn under_forces(signal: &[f64], forces: &[Vec<f64>], step: f64) -> f64 {
    let all = noise_of(signal, step);
    incoherent(signal, forces).map_or(all, |noise| noise.clamp(least(signal), all))
}

/// Noise of a signal from the highest quarter of its spectrum, taken as white; at least rounding of the largest sample.
pub(crate) fn noise_of(signal: &[f64], step: f64) -> f64 {
    let Some(spectrum) = Spectrum::new(signal, step) else { return largest(signal) * 1e-3 };
    let high = median(&spectrum.amplitude[first_high(spectrum.amplitude.len())..]);
    // Amplitude of a line of white noise behind Hann's window: Rayleigh with a median of 0.8326 sigma sqrt(6 / N).
    let sigma = high / (0.8326 * (6.0 / signal.len() as f64).sqrt());
    sigma.max(least(signal))
}

fn largest(signal: &[f64]) -> f64 {
    signal.iter().fold(0.0_f64, |m, y| m.max(y.abs()))
}

fn least(signal: &[f64]) -> f64 {
    (1e-6 * largest(signal)).max(f64::MIN_POSITIVE)
}

fn first_high(lines: usize) -> usize {
    (HIGH * lines as f64) as usize
}

/// Deviation of what of a signal is not coherent with the forces in the highest quarter of the spectrum; `None` without forces and
/// for short records.
fn incoherent(signal: &[f64], forces: &[Vec<f64>]) -> Option<f64> {
    let length = signal.len() / SEGMENTS;
    let is_sampled_alike = forces.iter().all(|force| force.len() == signal.len());
    if forces.is_empty() || length < SHORTEST || !is_sampled_alike {
        return None;
    }
    let spectra = |signal: &[f64]| segments(signal, length);
    let (motion, forces): (Vec<Vec<c64>>, Vec<Vec<Vec<c64>>>) =
        (spectra(signal), forces.iter().map(|f| spectra(f)).collect());
    let lines = motion[0].len();
    let free = motion.len().checked_sub(forces.len()).filter(|free| *free > 0)? as f64;
    let on_line = |list: &[Vec<c64>], k: usize| list.iter().map(|segment| segment[k]).collect::<Vec<c64>>();
    let left = |k: usize| {
        let mut motion = on_line(&motion, k);
        let mut others: Vec<Vec<c64>> = forces.iter().map(|force| on_line(force, k)).collect();
        while let Some(force) = others.pop() {
            others.iter_mut().chain(std::iter::once(&mut motion)).for_each(|x| take_out(&force, x));
        }
        power(&motion) / free
    };
    let powers: Vec<f64> = (first_high(lines)..lines.saturating_sub(1)).map(left).collect();
    // The mean square of Hann's window is 3/8.
    Some((median(&powers) / (0.375 * length as f64)).sqrt())
}

/// Spectra of half overlapping segments behind Hann's window, unscaled.
fn segments(signal: &[f64], length: usize) -> Vec<Vec<c64>> {
    let transform = RealTransform::new(length);
    let window: Vec<f64> = (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
    let segment = |first: usize| {
        let mut own: Vec<f64> = signal[first..first + length].iter().zip(&window).map(|(y, w)| y * w).collect();
        transform.forward(&mut own)
    };
    (0..=signal.len() - length).step_by((length / 2).max(1)).map(segment).collect()
}

/// Takes out of `x` what is in proportion to `force`.
fn take_out(force: &[c64], x: &mut [c64]) {
    let own = power(force);
    if own > 0.0 {
        let factor = force.iter().zip(&*x).map(|(f, x)| f.conj() * x).sum::<c64>() / own;
        x.iter_mut().zip(force).for_each(|(x, f)| *x -= factor * f);
    }
}

fn power(x: &[c64]) -> f64 {
    x.iter().map(c64::norm_sqr).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::runs::uniform;

    /// Noise of about unit deviation.
    fn noise(seed: u64, count: usize) -> Vec<f64> {
        let mut uniform = uniform(seed);
        (0..count).map(|_| (0..12).map(|_| uniform()).sum()).collect()
    }

    /// Two forces that fill the band to its end, and a motion of short memory: its noise of a thirtieth is told within some per cent, where
    /// the spectrum alone takes the motion for noise. What a segment holds of the force before it is taken for noise as well.
    #[test]
    fn motion_that_is_coherent_with_the_forces_is_no_noise() {
        let count = 16_384;
        let forces = [noise(1, count), noise(2, count)].map(|f| f.iter().map(|f| 3.0 * f).collect::<Vec<f64>>());
        let own = noise(3, count);
        let motion: Vec<f64> = (0..count)
            .map(|n| {
                let past = |f: &[f64], k: usize| n.checked_sub(k).map_or(0.0, |n| f[n]);
                let coherent = past(&forces[0], 0) - 0.5 * past(&forces[0], 3) + 0.7 * past(&forces[1], 2);
                coherent + 0.1 * own[n]
            })
            .collect();
        let told = under_forces(&motion, &forces, 1e-3);
        assert!((told / 0.1 - 1.0).abs() < 0.1, "{told}");
        assert!(noise_of(&motion, 1e-3) > 1.0);
        // With one of the forces alone the other stays.
        assert!(under_forces(&motion, &forces[..1], 1e-3) > 1.0);
        // A record without forces, and one that is short.
        assert_eq!(under_forces(&motion, &[], 1e-3), noise_of(&motion, 1e-3));
        assert_eq!(under_forces(&motion[..100], &[forces[0][..100].to_vec()], 1e-3), noise_of(&motion[..100], 1e-3));
    }
}

//! How sampled forces go on between their samples: a polynomial a step.
//!
//! A measured force is band-limited. Straight lines between its samples (a first-order hold) have images about every multiple of the
//! sampling rate, `(w h / 2 pi)^2` of the force, which drive modes above the sampled band at their resonances. The spline of degree
//! five through the samples has images of the sixth power of that ratio (Unser, "Splines: a perfect fit for signal and image
//! processing", IEEE Signal Processing Magazine 16, 1999): 3e-5 of the force at an eighth of the sampling rate, 1.6 % at a third.
//! Forces that are known along a motion, whose laws jump, go straight from sample to sample.

/// Coefficients of the polynomial of a step.
pub(super) const ORDERS: usize = 6;
/// Poles of the filter that turns samples into coefficients of the spline of degree five.
const POLES: [f64; 2] = [-0.430_575_347_099_973_8, -0.043_096_288_203_264_65];
/// Samples that are added beyond each end, as if the force went on through its end point turned by half a turn.
const BEYOND: usize = 24;

/// Force over a step, `sum_k c_k s^k`, with `s` the time from its start over the time between samples.
pub(super) type Polynomial = [f64; ORDERS];

/// How a force goes on between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// As a band-limited one does.
    BandLimited,
    /// Straight.
    FirstOrder,
}

impl Hold {
    /// One polynomial from each sample to the next; that of the last goes on as the one before.
    pub(super) fn polynomials(self, force: &[f64]) -> Vec<Polynomial> {
        match self {
            Hold::FirstOrder => (0..force.len()).map(|n| straight(force, n)).collect(),
            Hold::BandLimited => spline(force),
        }
    }
}

fn straight(force: &[f64], n: usize) -> Polynomial {
    let mut p = [0.0; ORDERS];
    p[0] = force[n];
    p[1] = force.get(n + 1).map_or(0.0, |next| next - force[n]);
    p
}

/// The spline of degree five through the samples.
fn spline(force: &[f64]) -> Vec<Polynomial> {
    let Some(last) = force.len().checked_sub(1) else { return Vec::new() };
    let turned = |end: usize, other: usize| 2.0 * force[end] - force[other];
    let before = (1..=BEYOND).rev().map(|k| turned(0, k.min(last)));
    let after = (1..=BEYOND).map(|k| turned(last, last.saturating_sub(k)));
    let mut c: Vec<f64> = before.chain(force.iter().copied()).chain(after).collect();
    for pole in POLES {
        filter(&mut c, pole);
    }
    let pieces = pieces();
    let piece_after_sample = |n: usize| {
        let around = &c[n + BEYOND - 2..n + BEYOND + 4];
        pieces.map(|row| row.iter().zip(around).map(|(a, c)| a * c).sum())
    };
    (0..=last).map(piece_after_sample).collect()
}

/// Divides by `(1 - z E)(1 - z E^-1) / (1 - z)^2`, with `E` the shift by a sample: there and back.
fn filter(c: &mut [f64], z: f64) {
    let gain = (1.0 - z) * (1.0 - z);
    // What lies beyond the ends is taken as constant.
    let mut last = c.first().map_or(0.0, |c| c / (1.0 - z));
    for c in &mut *c {
        last = *c + z * last;
        *c = last;
    }
    let mut last = c.last().map_or(0.0, |c| c / (1.0 - z));
    for c in c.iter_mut().rev() {
        last = *c + z * last;
        *c = gain * last;
        last = *c / gain;
    }
}

/// What the coefficients of two splines before a sample, its own and the three behind it give to each power of `s`.
fn pieces() -> [[f64; 6]; ORDERS] {
    let mut rows = [[0.0; 6]; ORDERS];
    for (power, row) in rows.iter_mut().enumerate() {
        for (index, entry) in row.iter_mut().enumerate() {
            // The spline about the sample `j` is sum_i (-1)^i C(6, i) (s - j + 3 - i)_+^5 / 120.
            let j = index as i32 - 2;
            let sum: f64 = (0..=3 - j)
                .map(|i| {
                    let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                    sign * binomial(6, i) * f64::from(3 - j - i).powi(5 - power as i32)
                })
                .sum();
            *entry = binomial(5, power as i32) * sum / 120.0;
        }
    }
    rows
}

fn binomial(n: i32, k: i32) -> f64 {
    (0..k).fold(1.0, |product, i| product * f64::from(n - i) / f64::from(i + 1))
}

/// Value at `s`.
pub(super) fn value(p: &Polynomial, s: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// The same polynomial from `s` on.
pub(super) fn shifted(p: &Polynomial, s: f64) -> Polynomial {
    let mut p = *p;
    // Horner's scheme, once a power.
    for from in 0..ORDERS {
        for k in (from..ORDERS - 1).rev() {
            p[k] += s * p[k + 1];
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Root mean square of what a sine of `phase` rad a sample is missed by between its samples.
    fn missed(hold: Hold, phase: f64) -> f64 {
        let sine = |t: f64| (phase * t + 0.3).sin();
        let samples: Vec<f64> = (0..200).map(|n| sine(f64::from(n))).collect();
        let pieces = hold.polynomials(&samples);
        let errors = (60..140).flat_map(|n| (0..10).map(move |k| (n, 0.1 * f64::from(k))));
        let squares = errors.map(|(n, s)| (value(&pieces[n], s) - sine(n as f64 + s)).powi(2));
        (squares.sum::<f64>() / 800.0 * 2.0).sqrt()
    }

    /// Images and losses of the spline are of the sixth power of the ratio of frequency to sampling rate, of lines of the second.
    #[test]
    fn sines_are_followed_between_their_samples() {
        for phase in [0.5, 1.0, 2.0] {
            let image = (phase / (std::f64::consts::TAU - phase)).powi(6);
            let found = missed(Hold::BandLimited, phase);
            assert!(found < 2.0 * image && found > 0.5 * image, "{phase}: {found:.1e} {image:.1e}");
            assert!(missed(Hold::FirstOrder, phase) > 0.05 * phase.powi(2));
        }
    }

    #[test]
    fn samples_are_met_and_pieces_join() {
        let samples: Vec<f64> = (0..40).map(|n| f64::from((n * n * 7) % 13)).collect();
        for hold in [Hold::BandLimited, Hold::FirstOrder] {
            let pieces = hold.polynomials(&samples);
            for n in 0..39 {
                assert!((pieces[n][0] - samples[n]).abs() < 1e-9);
                assert!((value(&pieces[n], 1.0) - samples[n + 1]).abs() < 1e-9);
                let (here, there) = (shifted(&pieces[n], 0.3), value(&pieces[n], 0.8));
                assert!((value(&here, 0.5) - there).abs() < 1e-12 * (1.0 + there.abs()));
            }
            assert_eq!(hold.polynomials(&[]).len(), 0);
            assert!((hold.polynomials(&[3.0])[0][0] - 3.0).abs() < 1e-12);
        }
    }

    /// Slopes go on from piece to piece up to the fourth derivative.
    #[test]
    fn the_spline_is_smooth() {
        let samples: Vec<f64> = (0..40).map(|n| f64::from((n * n * 7) % 13)).collect();
        let pieces = Hold::BandLimited.polynomials(&samples);
        for n in 0..39 {
            let end = shifted(&pieces[n], 1.0);
            for k in 0..5 {
                assert!((end[k] - pieces[n + 1][k]).abs() < 1e-8, "{n} {k}");
            }
        }
    }
}

//! The function of the driving point among those of one reference that nothing names.
//!
//! A passive structure takes energy in where it is driven, `Re(v conj(F)) >= 0`, at every frequency: the imaginary part of a
//! receptance or accelerance of the driving point, the real part of a mobility, has one sign over the whole band, whatever its
//! modes are. Elsewhere modes move in and against the phase of the first, and the part changes its sign from one to the next:
//! D. J. Ewins, *Modal Testing*, 2nd edition, 2.6. It is looked at about the resonances only, where it stands out of the noise.

use super::error::Result;
use crate::math::statistics::median;
use crate::measurement::frf::lines::{Density, resonances};
use dashpot_datafiles::{DataFile, Set, Values};

/// Most functions that are looked at.
const MOST: usize = 400;
/// Squared modulus over that of the noise from which on a value stands out of it.
const ABOVE_NOISE: f64 = 20.0;
/// Share of a resonance's part that has one sign where the sign is clear.
const ONE_SIGN: f64 = 0.7;
/// Deviations of the sum of a resonance's part from zero where its sign is clear.
const BEYOND: f64 = 5.0;
/// Fewest resonances with a clear sign.
const RESONANCES: usize = 2;

/// Number, in their order, of the function that alone can be that of a driving point; none where several can, or none.
/// `is_function` says which channels of a set are functions.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn driving_point(files: &[DataFile], is_function: impl Fn(&Set, usize) -> bool) -> Result<Option<usize>> {
    let mut functions = Vec::new();
    for file in files {
        for (s, set) in file.contents().sets.iter().enumerate() {
            for c in (0..set.channels.len()).filter(|&c| is_function(set, c)) {
                let Values::Complex(values) = file.read(s, c)? else { return Ok(None) };
                functions.push(values);
                if functions.len() > MOST {
                    return Ok(None);
                }
            }
        }
    }
    Ok(of_functions(&functions))
}

/// The same of the values of the functions on common frequencies.
fn of_functions(functions: &[Vec<[f64; 2]>]) -> Option<usize> {
    let count = functions.first()?.len();
    let usable = |values: &Vec<[f64; 2]>| values.len() == count && values.iter().flatten().all(|x| x.is_finite());
    if functions.len() < 2 || !functions.iter().all(usable) {
        return None;
    }
    let noise: Vec<f64> = functions.iter().map(|values| deviation(values)).collect();
    let resonances = resonances(&density(functions, &noise));
    let signs = |part: usize| -> Vec<Vec<Option<f64>>> {
        let of_one = |(values, noise): (&Vec<[f64; 2]>, &f64)| {
            resonances.iter().map(|lines| sign(values, lines, part, *noise)).collect()
        };
        functions.iter().zip(&noise).map(of_one).collect()
    };
    // The other part goes through zero at every resonance.
    let clear = |signs: &[Vec<Option<f64>>]| signs.iter().flatten().flatten().count();
    let [real, imaginary] = [signs(0), signs(1)];
    let signs = if clear(&real) > clear(&imaginary) { real } else { imaginary };
    let mut possible = (0..signs.len()).filter(|&k| is_of_one_sign(&signs[k]));
    let (first, None) = (possible.next()?, possible.next()) else { return None };
    let clear = signs[first].iter().flatten().count();
    (clear >= RESONANCES).then_some(first)
}

/// Whether no two clear signs differ.
fn is_of_one_sign(signs: &[Option<f64>]) -> bool {
    let clear: Vec<f64> = signs.iter().flatten().copied().collect();
    clear.windows(2).all(|pair| pair[0] == pair[1])
}

/// How far each line stands out of the noise, all functions together, squared as the information of lines is.
fn density(functions: &[Vec<[f64; 2]>], noise: &[f64]) -> Density {
    let above = |k: usize, line: usize| {
        let [re, im] = functions[k][line];
        if noise[k] > 0.0 { (re * re + im * im) / (2.0 * noise[k].powi(2)) } else { 0.0 }
    };
    let all = |line: usize| (0..functions.len()).map(|k| above(k, line)).sum::<f64>().powi(2);
    let any_stands_out = |line: usize| (0..functions.len()).any(|k| above(k, line) > ABOVE_NOISE);
    let lines = 0..functions[0].len();
    Density { information: lines.clone().map(all).collect(), stands_out: lines.map(any_stands_out).collect() }
}

/// Sign of a part of a function over the lines of a resonance, where it is clear.
fn sign(values: &[[f64; 2]], lines: &[usize], part: usize, noise: f64) -> Option<f64> {
    let (sum, size) = lines.iter().fold((0.0, 0.0_f64), |(sum, size), &line| {
        let value: f64 = values[line][part];
        (sum + value, size + value.abs())
    });
    let clear = sum.abs() > ONE_SIGN * size && sum.abs() > BEYOND * noise * (lines.len() as f64).sqrt();
    clear.then(|| f64::signum(sum))
}

/// Standard deviation of the real and of the imaginary part by what lies between each value and the middle of its neighbours,
/// whose variance is 3/2 of that of a value. A curve that bends strongly at few lines leaves the median as it is.
fn deviation(values: &[[f64; 2]]) -> f64 {
    const OF_NORMAL: f64 = 0.674_49;
    let bend = |three: &[[f64; 2]], part: usize| (three[1][part] - 0.5 * (three[0][part] + three[2][part])).abs();
    let bends: Vec<f64> = values.windows(3).flat_map(|three| [bend(three, 0), bend(three, 1)]).collect();
    if bends.is_empty() { 0.0 } else { median(&bends) / (OF_NORMAL * 1.5_f64.sqrt()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// Accelerances of a uniform bar, fixed at 0 and free at 1, driven at `x`: shapes `sin((2 j - 1) pi x / 2)`, three modes
    /// at 10, 30 and 50 Hz with a damping ratio of 1 %, and noise of `noise` times the root mean square of each function.
    fn bar(at: &[f64], driven: f64, noise: f64) -> Vec<Vec<[f64; 2]>> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let shape = |j: f64, x: f64| ((2.0 * j - 1.0) * std::f64::consts::FRAC_PI_2 * x).sin();
        let value = |x: f64, f: f64| {
            (1..=3).map(f64::from).fold([0.0, 0.0], |[re, im]: [f64; 2], j| {
                let own = 10.0 * (2.0 * j - 1.0);
                let (a, b) = (own * own - f * f, 0.02 * own * f);
                let h = -f * f * shape(j, x) * shape(j, driven) / (a * a + b * b);
                [re + h * a, im - h * b]
            })
        };
        let mut function = |&x: &f64| {
            let clean: Vec<[f64; 2]> = (0..600).map(|k| value(x, 0.1 * f64::from(k))).collect();
            let size = (clean.iter().flatten().map(|x| x * x).sum::<f64>() / 600.0).sqrt();
            let mut random = || noise * size * (rng.random::<f64>() + rng.random::<f64>() - 1.0);
            clean.iter().map(|[re, im]| [re + random(), im + random()]).collect()
        };
        at.iter().map(&mut function).collect()
    }

    #[test]
    fn the_driving_point_is_told_under_noise() {
        let at = [0.25, 0.5, 0.75, 1.0];
        for noise in [0.0, 0.03] {
            for (k, x) in at.iter().enumerate() {
                assert_eq!(of_functions(&bar(&at, *x, noise)), Some(k), "{x} {noise}");
            }
        }
        // Driven at none of them.
        assert_eq!(of_functions(&bar(&at[..3], 1.0, 0.03)), None);
        // Two points so near to each other that both can be it.
        assert_eq!(of_functions(&bar(&[0.98, 1.0, 0.5], 1.0, 0.03)), None);
    }
}

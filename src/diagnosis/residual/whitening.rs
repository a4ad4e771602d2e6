//! Noise of the residual of a run and the whitening that makes all of it of unit variance.
//!
//! ```text
//! S_h = diag(s_c,h^2 + t_c,h^2 + m_c,h^2) + sum_f a_f,h s_f,h^2 a_f,h^H = L L^H,      whitened residual L^-1 e_h
//! ```
//!
//! `s` is the noise of the fit, `t` the truncation error of the forward model, `m` an allowance for what no model
//! matches (integration errors, the last digits of a file). `a_f` is the response of the channels to the force channel
//! `f`; under a single force it is measured, `Y / F`, at the fundamental.

use crate::diagnosis::residual::data::RunData;
use crate::diagnosis::residual::run_nuisance::RunNuisance;
use crate::math::hermitian::HermitianFactor;
use faer::c64;

/// Least share of a variance that is left by the channels before it: less is rounding.
const ROUNDING: f64 = 1e-12;
/// Allowance for what no model matches, relative to the amplitude of the same harmonic.
const OWN: f64 = 2e-4;
/// The same, relative to the fundamental of the channel, for its higher harmonics.
const FUNDAMENTAL: f64 = 2e-5;
/// Squared whitened residual per datum up to which a residual counts as noise.
const NOISY: f64 = 2.5;
/// Noise assumed where a file gives harmonics without deviations, relative to the channel's size.
const ASSUMED: f64 = 5e-3;

/// Response of every channel to a unit of every force channel: `[harmonic][force][channel]`.
pub(crate) type Transfers = Vec<Vec<Vec<c64>>>;

/// Lower triangular factors that whiten the residual of one run; only channels that are alive take part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Whitening {
    /// Of the living channels, per harmonic.
    factors: Vec<HermitianFactor>,
    alive: Vec<usize>,
    /// Expected `|e_c,h|^2`, `[channel][harmonic]`, of all channels, without the allowance.
    expected: Vec<Vec<f64>>,
    /// The part of it that is each channel's own.
    own: Vec<Vec<f64>>,
    /// What differs from run to run, eliminated.
    nuisance: RunNuisance,
    /// Where a single force drives the run: variance of a real part of its noise, and `a`, per harmonic.
    force: Vec<Option<(f64, Vec<c64>)>>,
}

/// Standard deviation per real part of channel data `(size, measured deviation)`, never zero.
fn own_deviation(size: f64, deviation: f64) -> f64 {
    if deviation > 0.0 { deviation } else { ASSUMED * size }
}

impl Whitening {
    /// Noise of `run` for a model of transfers `a` whose prediction has the error `truncation[channel][harmonic]`.
    pub(crate) fn new(run: &RunData, a: &Transfers, truncation: &[Vec<f64>]) -> Self {
        let mut expected = vec![vec![0.0; run.harmonics]; run.responses.len()];
        let mut own = expected.clone();
        let mut force = Vec::with_capacity(run.harmonics);
        let mut factors = Vec::with_capacity(run.harmonics);
        for h in 0..run.harmonics {
            let full = covariance(run, a, truncation, h, false);
            for (c, e) in expected.iter_mut().enumerate() {
                e[h] = 2.0 * full[c * run.responses.len() + c].re;
            }
            let single = if let [only] = &run.forces[..] { Some(only) } else { None };
            let known = single.map(|f| (own_deviation(f.size(), f.deviation[h]).powi(2), a[h][0].clone()));
            for (c, o) in own.iter_mut().enumerate() {
                o[h] = expected[c][h] - known.as_ref().map_or(0.0, |(s, a)| 2.0 * s * a[c].norm_sqr());
            }
            force.push(known);
            let alive = select(&covariance(run, a, truncation, h, true), &run.alive, run.responses.len());
            factors.push(HermitianFactor::new(&alive, ROUNDING));
        }
        Self { factors, alive: run.alive.clone(), expected, own, force, nuisance: RunNuisance::default() }
    }

    /// The same noise with local parameters of the run eliminated.
    #[must_use]
    pub(crate) fn with_nuisance(self, nuisance: RunNuisance) -> Self {
        Self { nuisance, ..self }
    }

    /// What differs from run to run, eliminated.
    pub(crate) fn nuisance(&self) -> &RunNuisance {
        &self.nuisance
    }

    /// Whitened real and imaginary parts of all harmonics, local parameters not eliminated; `value(c, h)` is the entry of
    /// response channel `c` at harmonic `h`.
    pub(crate) fn rows(&self, value: impl Fn(usize, usize) -> c64) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.len());
        let mut white = Vec::with_capacity(self.alive.len());
        for (i, factor) in self.factors.iter().enumerate() {
            white.clear();
            white.extend(self.alive.iter().map(|&c| value(c, i + 1)));
            // Most derivatives are of the fundamental alone.
            if white.iter().any(|e| *e != c64::new(0.0, 0.0)) {
                factor.whiten(&mut white);
            }
            white.iter().for_each(|e| rows.extend([e.re, e.im]));
        }
        rows
    }

    /// `ln det` of the covariance of all real values, what is the run's own not included.
    pub(crate) fn log_determinant(&self) -> f64 {
        self.factors.iter().map(|factor| 2.0 * factor.log_determinant()).sum()
    }

    /// Number of real values of a whitened run.
    pub(crate) fn len(&self) -> usize {
        2 * self.alive.len() * self.factors.len()
    }

    /// `L^-1 v` at harmonic `h` (from 1); `value(c)` is the entry of response channel `c`.
    pub(crate) fn apply(&self, h: usize, value: impl Fn(usize) -> c64) -> Vec<c64> {
        let mut result: Vec<c64> = self.alive.iter().map(|&c| value(c)).collect();
        self.factors[h - 1].whiten(&mut result);
        result
    }

    /// Expected `|e_c|^2` over the harmonics of response channel `c`, were the model exact, given what the residual
    /// `e(c, h)` shows of the noise of the force: that is one number a harmonic, often the largest of all, and its scatter
    /// must not pass for an error of the model. Where the residual is more than noise it shows nothing.
    pub(crate) fn expected_given(&self, c: usize, e: impl Fn(usize, usize) -> c64) -> f64 {
        let expected_at_harmonic = |(i, force): (usize, &Option<(f64, Vec<c64>)>)| {
            let h = i + 1;
            let white: f64 = self.apply(h, |k| e(k, h)).iter().map(c64::norm_sqr).sum();
            let Some((variance, a)) = force.as_ref().filter(|_| white < NOISY * 2.0 * self.alive.len() as f64) else {
                return self.expected[c][i];
            };
            let (mut product, mut square) = (c64::new(0.0, 0.0), 0.0);
            for &k in self.alive.iter().filter(|&&k| self.own[k][i] > 0.0) {
                product += a[k].conj() * e(k, h) * (2.0 / self.own[k][i]);
                square += a[k].norm_sqr() * (2.0 / self.own[k][i]);
            }
            let left = 1.0 / (1.0 / variance.max(f64::MIN_POSITIVE) + square);
            self.own[c][i] + a[c].norm_sqr() * ((product * left).norm_sqr() + 2.0 * left)
        };
        self.force.iter().enumerate().map(expected_at_harmonic).sum()
    }

    /// Standard deviation of one real part of harmonic `h` (from 1) of channel `c`.
    pub(crate) fn deviation(&self, c: usize, h: usize) -> f64 {
        (0.5 * self.expected[c][h - 1]).sqrt()
    }
}

/// Covariance of the residual at harmonic index `h`, all channels, row by row.
fn covariance(run: &RunData, a: &Transfers, truncation: &[Vec<f64>], h: usize, allow: bool) -> Vec<c64> {
    let n = run.responses.len();
    let mut s = vec![c64::new(0.0, 0.0); n * n];
    for (c, channel) in run.responses.iter().enumerate() {
        let noise = own_deviation(channel.size(), channel.deviation[h]);
        let allowance = OWN * channel.measured[h].norm() + FUNDAMENTAL * channel.size();
        let model = truncation.get(c).map_or(0.0, |t| t[h]);
        let extra = if allow { 0.5 * allowance * allowance } else { 0.0 };
        s[c * n + c].re = noise * noise + 0.5 * model * model + extra + f64::MIN_POSITIVE;
    }
    for (f, force) in run.forces.iter().enumerate() {
        let noise = own_deviation(force.size(), force.deviation[h]).powi(2);
        for i in 0..n {
            for j in 0..n {
                s[i * n + j] += a[h][f][i] * a[h][f][j].conj() * noise;
            }
        }
    }
    s
}

/// Rows and columns `keep` of an n x n matrix.
fn select(matrix: &[c64], keep: &[usize], n: usize) -> Vec<c64> {
    keep.iter().flat_map(|&i| keep.iter().map(move |&j| matrix[i * n + j])).collect()
}

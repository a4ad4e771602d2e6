//! The model of the data: noise of sensors and force, what differs from run to run, and updating parameters, all but the
//! parameters of effects eliminated.
//!
//! ```text
//! y = (1 + a_k) e^{-i h w t_k} yhat(theta, m, s_r, (1 + l_r) F) (1 + d_r) + e
//! ```
//!
//! `m` multiplies parts of the model, `a_k`, `t_k` are gain and delay of channel `k`, `s_r` shifts the stiffness of run
//! `r`, `l_r` its forces, which are not known better than what measures them, `d_r` multiplies its response, as `l_r` does that of a linear
//! model, `e` is noise. `m`, `a`, `t` are common to all runs ([`Marginalisation`]), `s_r`, `l_r`, `d_r` are the run's own
//! ([`RunNuisance`]).

use super::marginalisation::Marginalisation;
use super::modal_expansion::ModalExpansion;
use super::parameters::{Updating, UpdatingParameter};
use super::scales::Scales;
use crate::control::Control;
use crate::diagnosis::residual::data::{ChannelData, RunData};
use crate::diagnosis::residual::run_nuisance::RunNuisance;
use crate::diagnosis::residual::whitening::Whitening;
use faer::c64;
use std::sync::Arc;

/// Derivatives of the recorded amplitudes of one run, `[parameter][channel][harmonic - 1]`.
pub(crate) type RunSlopes = Vec<Vec<Vec<c64>>>;

/// What updating parameters and those of the runs do to the recorded amplitudes near a reference.
#[derive(Debug, Clone, Default)]
pub(crate) struct Linearisation {
    /// Updating parameters, their values at the reference, and the scales.
    pub updating: Updating,
    /// Derivatives of the recorded amplitudes, whatever the scales.
    pub derivatives: Arc<Derivatives>,
    /// Whether higher harmonics are doubted as far as the model is: else its receptance is taken for exact there.
    pub doubts_harmonics: bool,
    /// Whether higher harmonics count for nothing.
    pub of_fundamentals: bool,
}

/// Derivatives of the recorded amplitudes at a reference.
#[derive(Debug, Default)]
pub(crate) struct Derivatives {
    /// By updating parameters (of unit logarithm or second), one list a run; of fundamentals alone where they are taken at the
    /// measured motion.
    pub common: Vec<RunSlopes>,
    /// The same at the measured motion with the higher harmonics, which tell places; none where derivatives are of the model itself.
    pub at_motion: Vec<RunSlopes>,
    /// By the relative stiffness of the run, one list of `[channel][harmonic - 1]` a run.
    pub stiffness: Vec<Vec<Vec<c64>>>,
    /// By the logarithm of the level of the forces of the run, likewise; none of a run that is linear, whose `amplitudes` they are.
    pub level: Vec<Vec<Vec<c64>>>,
    /// What turns a motion into the one that the sensors show, `[run][harmonic - 1]`; none where derivatives are of the model itself.
    pub(crate) expansions: Vec<Vec<Option<ModalExpansion>>>,
    /// Amplitudes that gains, delays and factors of runs multiply, `[run][channel][harmonic - 1]`.
    pub amplitudes: Vec<Vec<Vec<c64>>>,
    /// Error of the derivatives at the measured motion, as a factor on the response, one a run; none where they are of the
    /// model itself.
    pub leverage: Vec<f64>,
}

impl Linearisation {
    /// Whether nothing is free.
    pub(crate) fn is_empty(&self) -> bool {
        self.derivatives.common.is_empty()
    }

    /// Derivatives of harmonic `h` of run `r` by the standardised parameters that are common to all runs, then by what differs from run
    /// to run, `[parameter][channel]`; none where nothing is free.
    pub(crate) fn of_harmonic(&self, r: usize, h: usize) -> [Vec<Vec<c64>>; 2] {
        let free = h == 1 || self.doubts_harmonics;
        let Derivatives { common, at_motion, amplitudes, .. } = &*self.derivatives;
        let Some(common) = at_motion.get(r).or_else(|| common.get(r)).filter(|_| free) else {
            return [Vec::new(), Vec::new()];
        };
        let scaled_slope = |(k, slope): (usize, &Vec<Vec<c64>>)| {
            slope.iter().map(|channel| channel[h - 1] * self.updating.prior(k)).collect()
        };
        let own = self.own_scales(r);
        let column = |k: usize| (0..amplitudes[r].len()).map(|c| self.derivatives.own(r, k, c, h) * own[k]).collect();
        [common.iter().enumerate().map(scaled_slope).collect(), (0..OWN).map(column).collect()]
    }

    /// Own parameters of run `r` that are in the model already, standardised.
    pub(crate) fn own_reference(&self, r: usize) -> Vec<f64> {
        self.updating.shifts.get(r).map_or_else(Vec::new, |shift| vec![shift / self.updating.scales.shift])
    }

    /// Prior deviations of the own parameters of run `r`.
    fn own_scales(&self, r: usize) -> [f64; OWN] {
        let Scales { shift, response, .. } = self.updating.scales;
        let response = response.hypot(self.derivatives.leverage.get(r).copied().unwrap_or(0.0));
        // What forces are not wrong by multiplies the response.
        let is_felt = !self.derivatives.level[r].is_empty();
        let beyond = if is_felt { (response.powi(2) - LEVEL.powi(2)).max(0.0).sqrt() } else { response };
        [shift, beyond, response, response.min(LEVEL)]
    }
}

impl Derivatives {
    /// Derivative of channel `c` at harmonic `h` by own parameter `k` of run `r`.
    fn own(&self, r: usize, k: usize, c: usize, h: usize) -> c64 {
        match k {
            0 => self.stiffness[r][c][h - 1],
            1 => self.amplitudes[r][c][h - 1],
            2 => self.amplitudes[r][c][h - 1] * c64::new(0.0, 1.0),
            _ => self.level[r].get(c).map_or(c64::new(0.0, 0.0), |level| level[h - 1]),
        }
    }

    /// All of run `r`, whitened by its `noise`.
    fn whitened(&self, r: usize, noise: &Whitening) -> WhitenedDerivatives {
        WhitenedDerivatives {
            common: self.common[r].iter().map(|slope| noise.rows(|c, h| slope[c][h - 1])).collect(),
            own: (0..OWN).map(|k| noise.rows(|c, h| self.own(r, k, c, h))).collect(),
        }
    }
}

/// Derivatives of one run, whitened, one list of rows a parameter: what scales multiply.
#[derive(Debug, Default)]
struct WhitenedDerivatives {
    common: Vec<Vec<f64>>,
    own: Vec<Vec<f64>>,
}

impl WhitenedDerivatives {
    /// Those by the run's own parameters from `first` on, times their `scales`.
    fn scaled(&self, first: usize, scales: &[f64; OWN]) -> Vec<Vec<f64>> {
        self.own.iter().zip(scales).skip(first).map(|(rows, scale)| scaled(rows, *scale)).collect()
    }
}

/// Parameters that are a run's own: its stiffness, real and imaginary part of the factor on its response, the level of its forces.
pub(crate) const OWN: usize = 4;

/// Greatest prior deviation of the level of the forces of a run, which are measured: what a law leaves near a fold, where the response
/// follows the level by much, is no force.
const LEVEL: f64 = 0.01;

/// Noise of the residual of all runs with everything eliminated that is not the parameter of an effect.
#[derive(Debug, Clone, Default)]
pub(crate) struct NoiseModel {
    /// Of each run, what is its own eliminated.
    pub runs: Vec<Whitening>,
    /// Updating parameters.
    pub updating: Marginalisation,
    /// Derivatives of each run.
    derivatives: Arc<Vec<WhitenedDerivatives>>,
}

impl NoiseModel {
    /// Of the noise of the `runs`, with the parameters of `linearisation` eliminated.
    pub(crate) fn new(runs: Vec<Whitening>, linearisation: &Linearisation, control: &Control) -> Self {
        if linearisation.is_empty() {
            return Self { runs, ..Self::default() };
        }
        let whitened = control.map(runs.len(), |r| linearisation.derivatives.whitened(r, &runs[r]));
        Self { runs, derivatives: Arc::new(whitened), ..Self::default() }.rescaled(linearisation)
    }

    /// The same noise with the parameters eliminated as far as the scales of `linearisation` let them move, which has the same derivatives.
    #[must_use]
    pub(crate) fn rescaled(&self, linearisation: &Linearisation) -> Self {
        if linearisation.is_empty() {
            return self.clone();
        }
        let nuisance = |r: usize, own: &WhitenedDerivatives| {
            RunNuisance::new(own.scaled(0, &linearisation.own_scales(r))).at(linearisation.own_reference(r))
        };
        let updating = &linearisation.updating;
        let all: Vec<usize> = (0..updating.len()).collect();
        self.eliminated(nuisance, updating, &all, updating.clone())
    }

    /// The same with only what is linear eliminated, for fits that contain the rest: the response of each run, gains and
    /// delays of the channels.
    pub(crate) fn of_channels(&self, linearisation: &Linearisation) -> Self {
        let nuisance =
            |r: usize, own: &WhitenedDerivatives| RunNuisance::new(own.scaled(1, &linearisation.own_scales(r)));
        let all = &linearisation.updating;
        let of_channels: Vec<usize> = (0..all.len()).filter(|&k| !all.parameters[k].is_of_model()).collect();
        let updating = Updating {
            parameters: of_channels.iter().map(|&k| all.parameters[k].clone()).collect(),
            values: vec![0.0; of_channels.len()],
            spreads: Vec::new(),
            ..all.clone()
        };
        self.eliminated(nuisance, all, &of_channels, updating)
    }

    /// The same noise with the own parameters in `nuisance` eliminated, then those of `all` that are `free`, which are `updating`.
    fn eliminated(
        &self,
        nuisance: impl Fn(usize, &WhitenedDerivatives) -> RunNuisance,
        all: &Updating,
        free: &[usize],
        updating: Updating,
    ) -> Self {
        let mut slopes = vec![Vec::with_capacity(self.count()); free.len()];
        let local = |(r, (noise, derivatives)): (usize, (&Whitening, &WhitenedDerivatives))| {
            let nuisance = nuisance(r, derivatives);
            for (slope, &k) in slopes.iter_mut().zip(free) {
                let mut rows = scaled(&derivatives.common[k], all.prior(k));
                nuisance.project(&mut rows);
                slope.extend(rows);
            }
            noise.clone().with_nuisance(nuisance)
        };
        let runs = self.runs.iter().zip(&*self.derivatives).enumerate().map(local).collect();
        Self { updating: Marginalisation::new(updating, slopes), runs, derivatives: self.derivatives.clone() }
    }

    /// Number of real data.
    pub(crate) fn count(&self) -> usize {
        self.runs.iter().map(Whitening::len).sum()
    }

    /// `ln det` of the covariance by what is eliminated, and the prior of the scales: what freedom costs in evidence.
    pub(crate) fn cost(&self) -> f64 {
        if self.updating.is_empty() {
            return 0.0;
        }
        let own: f64 = self.runs.iter().map(|run| run.nuisance().log_determinant()).sum();
        own + self.updating.log_determinant + self.updating.updating.scales.prior_cost()
    }

    /// Scales re-estimated from the whitened residual `rows`, taken at the reference (one step of restricted maximum
    /// likelihood, MacKay 1992).
    pub(crate) fn scales(&self, rows: &[f64]) -> Scales {
        let u = self.updating.solve(rows);
        let left = self.updating.left(rows.to_vec(), &u);
        let mut list = self.updating.scales(&u, LEAST_KNOWN).list();
        let (mut squares, mut known) = ([0.0; 2], [0.0; 2]);
        let mut at = 0;
        for run in &self.runs {
            let estimate = run.nuisance().estimate(&left[at..at + run.len()]);
            at += run.len();
            // The level has the scale of the response as far as forces may be wrong by it.
            let response = self.updating.updating.scales.response;
            for k in 0..if response < LEVEL { OWN } else { OWN - 1 } {
                let class = usize::from(k > 0);
                squares[class] += estimate.values[k] * estimate.values[k];
                known[class] += 1.0 - estimate.variances[k];
            }
        }
        for class in 0..2 {
            if known[class] > LEAST_KNOWN {
                list[4 + class] *= (squares[class] / known[class]).sqrt();
            }
        }
        Scales::from_list(list)
    }
}

fn scaled(rows: &[f64], scale: f64) -> Vec<f64> {
    rows.iter().map(|row| row * scale).collect()
}

/// Effective number of parameters of a class that the data determine from which on its scale is estimated.
pub(crate) const LEAST_KNOWN: f64 = 0.5;

/// Derivatives of the recorded amplitudes of a run by the gain or the delay of a channel, `[channel][harmonic - 1]`, where
/// they are `amplitudes`.
pub(crate) fn of_channel(parameter: &UpdatingParameter, run: &RunData, amplitudes: &[Vec<c64>]) -> Vec<Vec<c64>> {
    let channel = |(channel, amplitudes): (&ChannelData, &Vec<c64>)| {
        let derivative_at_harmonic = |(i, y): (usize, &c64)| match parameter {
            UpdatingParameter::Gain(name) if *name == channel.name => *y,
            UpdatingParameter::Delay(name) if *name == channel.name => {
                *y * c64::new(0.0, -((i + 1) as f64) * run.omega)
            }
            _ => c64::new(0.0, 0.0),
        };
        amplitudes.iter().enumerate().map(derivative_at_harmonic).collect()
    };
    run.responses.iter().zip(amplitudes).map(channel).collect()
}

/// Difference of measured and predicted amplitude, relative, within which the predicted one is taken as what a gain
/// multiplies: the measured one contains the noise, which a gain would then seem to make smaller.
const PREDICTED: f64 = 0.3;

/// Amplitudes that gains multiply: predicted, but for fundamentals whose prediction is far off.
pub(crate) fn amplitudes(run: &RunData, predicted: &[Vec<c64>]) -> Vec<Vec<c64>> {
    let amplitude_of_harmonic = |(i, (y, model)): (usize, (&c64, &c64))| {
        if i > 0 || (y - model).norm() < PREDICTED * y.norm() { *model } else { *y }
    };
    let channel = |(channel, predicted): (&ChannelData, &Vec<c64>)| {
        channel.measured.iter().zip(predicted).enumerate().map(amplitude_of_harmonic).collect()
    };
    run.responses.iter().zip(predicted).map(channel).collect()
}

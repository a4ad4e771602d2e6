//! Measured and predicted amplitudes of a run as displacements, with the modes nearby, whose amplitudes are free.

use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::residual::prediction::RunPrediction;
use crate::structure::Structure;
use crate::structure::modes::Modes;
use faer::c64;
use nalgebra::{DMatrix, DVector};

/// Modes whose frequency is that near to the run's, relative, are free.
const NEAR: f64 = 0.2;
/// A run with a mode that near, relative, is left out where its channels are too few to leave the mode free.
const TOO_NEAR: f64 = 0.1;
/// A channel below this share of the largest of its kind in a run says nothing of itself.
const SMALL: f64 = 0.1;
/// Runs whose frequencies differ by less, natural logarithm, count as one: they show the same mode.
const ONE_FREQUENCY: f64 = 0.1;
/// Steps of the fit by least absolute deviations.
const STEPS: usize = 6;
/// Error below which all channels weigh the same.
const EVEN: f64 = 0.05;

/// One run.
pub(super) struct Cells {
    /// Number of its frequency.
    pub frequency: usize,
    /// Numbers of its channels among all.
    pub channels: Vec<usize>,
    /// Measured displacement amplitudes, m or rad.
    pub measured: Vec<c64>,
    /// Whether the model moves there enough.
    pub moves: Vec<bool>,
    model: Vec<c64>,
    /// Least amplitude that an error is measured by.
    floor: Vec<f64>,
    /// Shapes of the free modes at the channels.
    shapes: Vec<Vec<f64>>,
    /// The nearest of them.
    nearest: Option<Nearest>,
}

/// The mode next to a run.
struct Nearest {
    mode: usize,
    /// Circular frequencies of the mode and of the run, rad/s.
    omega: [f64; 2],
    /// Modal force, N / sqrt(kg).
    force: c64,
    /// Shapes at the channels of as many modes as these tell apart, its own first.
    shapes: Vec<Vec<f64>>,
}

/// One run next to a mode.
pub(super) struct NextToMode {
    /// Number of the mode.
    pub mode: usize,
    /// Circular frequency of the mode in the model, rad/s.
    pub omega_mode: f64,
    /// Of the run, rad/s.
    pub omega: f64,
    /// Real part of modal force over modal amplitude, 1/s^2.
    pub stiffness: f64,
}

/// All runs that can be judged, and the names of their channels.
pub(super) fn cells(
    structure: &Structure,
    modes: &Modes,
    data: &Data,
    predictions: &[RunPrediction],
) -> (Vec<String>, Vec<Cells>) {
    let [names, _] = data.channel_names();
    let mut frequencies: Vec<f64> = Vec::new();
    let mut all = Vec::new();
    for (run, prediction) in data.runs.iter().zip(predictions) {
        let near = |&known: &f64| (known / run.omega).ln().abs() < ONE_FREQUENCY;
        let frequency = frequencies.iter().position(near).unwrap_or_else(|| {
            frequencies.push(run.omega);
            frequencies.len() - 1
        });
        all.extend(Cells::new(structure, modes, run, prediction, &names, frequency));
    }
    (names, all)
}

impl Cells {
    fn new(
        structure: &Structure,
        modes: &Modes,
        run: &RunData,
        prediction: &RunPrediction,
        names: &[String],
        frequency: usize,
    ) -> Option<Self> {
        let rows = &run.alive;
        let near = free_modes(modes, run.omega, rows.len())?;
        let back = |c: usize| run.responses[c].from_displacement(run.omega);
        let model: Vec<c64> = rows.iter().map(|&c| prediction.channels[c][0] / back(c)).collect();
        let measured: Vec<c64> = rows.iter().map(|&c| run.responses[c].measured[0] / back(c)).collect();
        let turns = |c: usize| structure.dofs()[run.responses[c].dof].direction.is_rotation();
        let largest = |c: usize| {
            let alike = rows.iter().zip(&model).filter(|(k, _)| turns(**k) == turns(c));
            alike.map(|(_, x)| x.norm()).fold(0.0, f64::max)
        };
        let floor: Vec<f64> = rows.iter().map(|&c| SMALL * largest(c)).collect();
        if floor.iter().any(|f| !f.is_finite() || *f <= 0.0) {
            return None;
        }
        let number = |c: usize| names.iter().position(|name| *name == run.responses[c].name);
        let shape = |j: usize| rows.iter().map(|&c| modes.shapes[(run.responses[c].dof, j)]).collect::<Vec<f64>>();
        let nearest = near.first().map(|&mode| Nearest {
            mode,
            omega: [modes.omega[mode], run.omega],
            force: run.forces.iter().map(|force| force.measured[0] * modes.shapes[(force.dof, mode)]).sum(),
            shapes: by_distance(modes, run.omega).into_iter().take(rows.len().saturating_sub(1)).map(shape).collect(),
        });
        Some(Self {
            nearest,
            frequency,
            channels: rows.iter().map(|&c| number(c)).collect::<Option<_>>()?,
            moves: model.iter().zip(&floor).map(|(x, floor)| x.norm() >= *floor).collect(),
            measured,
            model,
            floor,
            shapes: near.iter().map(|&j| shape(j)).collect(),
        })
    }

    /// Modal force over modal amplitude of the mode next to the run, where there is one: by the motion alone, whatever the
    /// model says of the size of the others.
    pub(super) fn next_to_mode(&self) -> Option<NextToMode> {
        let nearest = self.nearest.as_ref()?;
        let weights: Vec<f64> = self.floor.iter().map(|floor| 1.0 / floor.powi(2)).collect();
        let amplitude = *amplitudes(&nearest.shapes, &self.measured, &weights)?.first()?;
        let ratio = nearest.force / amplitude;
        let [omega_mode, omega] = nearest.omega;
        ratio.re.is_finite().then_some(NextToMode { mode: nearest.mode, omega_mode, omega, stiffness: ratio.re })
    }

    /// What the model says with the amplitudes of the free modes fitted to `measured`, the channel `without` left out.
    pub(super) fn fitted(&self, measured: &[c64], without: Option<usize>) -> Vec<c64> {
        let (n, k) = (measured.len(), self.shapes.len());
        if k == 0 {
            return self.model.clone();
        }
        let mut fit = self.model.clone();
        let scale = |c: usize| 1.0 / self.model[c].norm().max(self.floor[c]).max(measured[c].norm());
        let mut weights: Vec<f64> = (0..n).map(|c| if Some(c) == without { 0.0 } else { scale(c).powi(2) }).collect();
        for _ in 0..STEPS {
            let left: Vec<c64> = measured.iter().zip(&self.model).map(|(measured, model)| measured - model).collect();
            let Some(b) = amplitudes(&self.shapes, &left, &weights) else { break };
            let moved = |c: usize| (0..k).fold(self.model[c], |x, j| x + b[j] * self.shapes[j][c]);
            fit = (0..n).map(moved).collect();
            for c in (0..n).filter(|&c| Some(c) != without) {
                weights[c] = scale(c).powi(2) / self.error(c, measured[c], fit[c]).max(EVEN);
            }
        }
        fit
    }

    /// Relative error of a channel: 0 where they agree, 2 where the sign is wrong.
    pub(super) fn error(&self, channel: usize, measured: c64, fit: c64) -> f64 {
        (measured - fit).norm() / measured.norm().max(fit.norm()).max(self.floor[channel])
    }
}

/// Amplitudes of modes with these shapes in `motion` by weighted least squares.
fn amplitudes(shapes: &[Vec<f64>], motion: &[c64], weights: &[f64]) -> Option<Vec<c64>> {
    let (n, k) = (motion.len(), shapes.len());
    let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(|c| weights[c] * f(c)).sum::<f64>();
    let mut normal = DMatrix::from_fn(k, k, |i, j| sum(&|c: usize| shapes[i][c] * shapes[j][c]));
    for i in 0..k {
        // Two modes that look the same at the sensors share what there is.
        normal[(i, i)] *= 1.0 + 1e-6;
    }
    let factor = normal.cholesky()?;
    let part = |of: fn(c64) -> f64| {
        let right = |i: usize, _: usize| sum(&|c: usize| shapes[i][c] * of(motion[c]));
        factor.solve(&DVector::from_fn(k, right))
    };
    let (re, im) = (part(|x| x.re), part(|x| x.im));
    Some(re.iter().zip(im.iter()).map(|(re, im)| c64::new(*re, *im)).collect())
}

/// The modes that are free at a frequency, the nearest first; none where that takes too many for the channels.
fn free_modes(modes: &Modes, omega: f64, channels: usize) -> Option<Vec<usize>> {
    let distance = |j: usize| (modes.omega[j] / omega - 1.0).abs();
    let mut near = by_distance(modes, omega);
    near.retain(|&j| distance(j) < NEAR);
    let most = channels.saturating_sub(1) / 2;
    if near.get(most).is_some_and(|&j| distance(j) < TOO_NEAR) {
        return None;
    }
    near.truncate(most);
    Some(near)
}

/// All modes, the nearest to a frequency first.
fn by_distance(modes: &Modes, omega: f64) -> Vec<usize> {
    let distance = |j: usize| (modes.omega[j] / omega - 1.0).abs();
    let mut all: Vec<usize> = (0..modes.len()).collect();
    all.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    all
}

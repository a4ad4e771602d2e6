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
pub(super) const SMALL: f64 = 0.1;
/// Runs whose frequencies differ by less, natural logarithm, count as one: they show the same mode.
const ONE_FREQUENCY: f64 = 0.1;
/// Steps of the fit by least absolute deviations.
const STEPS: usize = 6;
/// Error below which all channels weigh the same.
const EVEN: f64 = 0.05;

/// One run.
#[derive(Clone)]
pub(super) struct Cells {
    /// Number of its frequency.
    pub frequency: usize,
    /// Numbers of its channels among all.
    pub channels: Vec<usize>,
    /// Measured displacement amplitudes, m or rad.
    pub measured: Vec<c64>,
    /// Whether the model moves there enough.
    pub moves: Vec<bool>,
    pub(super) model: Vec<c64>,
    /// What the model says at every DOF of the structure, m or rad.
    pub(super) everywhere: Vec<c64>,
    /// Least amplitude that an error is measured by.
    pub(super) floor: Vec<f64>,
    /// Numbers of the free modes, and their shapes at the channels.
    pub(super) free: Vec<usize>,
    pub(super) shapes: Vec<Vec<f64>>,
    /// The nearest of them.
    pub(super) nearest: Option<Nearest>,
}

/// The mode next to a run.
#[derive(Clone)]
pub(super) struct Nearest {
    pub mode: usize,
    /// Circular frequencies of the mode and of the run, rad/s.
    pub omega: [f64; 2],
    /// Modal force, N / sqrt(kg).
    pub force: c64,
    /// Number of the force among the names of the forces, and its amplitude, N, where it is the only one.
    pub alone: Option<(usize, c64)>,
    /// As many modes as the channels tell apart, its own first, and their shapes at these.
    pub modes: Vec<usize>,
    pub shapes: Vec<Vec<f64>>,
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

/// One run next to a mode with one force alone.
pub(super) struct NextToForce {
    /// Number of the force among the names of the forces.
    pub force: usize,
    /// With the force itself, N, in place of the modal one: `stiffness` is in N / (m sqrt(kg)).
    pub run: NextToMode,
}

/// All runs that can be judged, and the names of their channels.
pub(super) fn cells(
    structure: &Structure,
    modes: &Modes,
    data: &Data,
    predictions: &[RunPrediction],
) -> (Vec<String>, Vec<Cells>) {
    let [names, forces] = data.channel_names();
    let mut frequencies = Frequencies::default();
    let mut all = Vec::new();
    for (run, prediction) in data.runs.iter().zip(predictions) {
        let frequency = frequencies.number(run.omega);
        all.extend(Cells::new(structure, modes, run, prediction, [&names, &forces], frequency));
    }
    (names, all)
}

/// Frequencies that count as different, rad/s.
#[derive(Default)]
pub(super) struct Frequencies(Vec<f64>);

impl Frequencies {
    /// Number of the one that a frequency counts as.
    pub(super) fn number(&mut self, omega: f64) -> usize {
        let near = |&known: &f64| (known / omega).ln().abs() < ONE_FREQUENCY;
        self.0.iter().position(near).unwrap_or_else(|| {
            self.0.push(omega);
            self.0.len() - 1
        })
    }
}

impl Cells {
    fn new(
        structure: &Structure,
        modes: &Modes,
        run: &RunData,
        prediction: &RunPrediction,
        [names, forces]: [&[String]; 2],
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
        let told: Vec<usize> = by_distance(modes, run.omega).into_iter().take(rows.len().saturating_sub(1)).collect();
        let nearest = near.first().map(|&mode| Nearest {
            mode,
            omega: [modes.omega[mode], run.omega],
            alone: match &run.forces[..] {
                [force] => forces.iter().position(|name| *name == force.name).map(|f| (f, force.measured[0])),
                _ => None,
            },
            force: run.forces.iter().map(|force| force.measured[0] * modes.shapes[(force.dof, mode)]).sum(),
            shapes: told.iter().map(|&j| shape(j)).collect(),
            modes: told.clone(),
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
            everywhere: (0..structure.len()).map(|dof| prediction.response.harmonics[(dof, 0)]).collect(),
            free: near,
        })
    }

    /// Modal force over modal amplitude of the mode next to the run, where there is one: by the motion alone, whatever the
    /// model says of the size of the others.
    pub(super) fn next_to_mode(&self) -> Option<NextToMode> {
        self.nearest.as_ref().and_then(|nearest| self.over_amplitude(nearest, nearest.force))
    }

    /// The same of the only force, whatever its place.
    pub(super) fn next_to_force(&self) -> Option<NextToForce> {
        let nearest = self.nearest.as_ref()?;
        let (force, value) = nearest.alone?;
        Some(NextToForce { force, run: self.over_amplitude(nearest, value)? })
    }

    /// A force over the modal amplitude of the nearest mode.
    fn over_amplitude(&self, nearest: &Nearest, force: c64) -> Option<NextToMode> {
        let weights: Vec<f64> = self.floor.iter().map(|floor| 1.0 / floor.powi(2)).collect();
        let amplitude = *amplitudes(&nearest.shapes, &self.measured, &weights)?.first()?;
        let ratio = force / amplitude;
        let [omega_mode, omega] = nearest.omega;
        ratio.re.is_finite().then_some(NextToMode { mode: nearest.mode, omega_mode, omega, stiffness: ratio.re })
    }

    /// Puts the channel at place `i` of the run to another DOF.
    pub(super) fn put(&mut self, i: usize, dof: usize, modes: &Modes) {
        self.model[i] = self.everywhere[dof];
        self.moves[i] = self.model[i].norm() >= self.floor[i];
        let all = self.nearest.iter_mut().flat_map(|nearest| nearest.modes.iter().zip(&mut nearest.shapes));
        for (&mode, shape) in self.free.iter().zip(&mut self.shapes).chain(all) {
            shape[i] = modes.shapes[(dof, mode)];
        }
    }

    /// Relative error of the channel at place `i` if it were at another DOF, by what the other channels say; none where
    /// neither it nor that DOF moves.
    pub(super) fn error_at(&self, i: usize, dof: usize, free: &[c64], modes: &Modes) -> Option<f64> {
        let there =
            self.free.iter().zip(free).fold(self.everywhere[dof], |x, (&mode, b)| x + b * modes.shapes[(dof, mode)]);
        let moves = self.measured[i].norm().max(there.norm()) >= self.floor[i];
        moves.then(|| self.error(i, self.measured[i], there))
    }

    /// What the model says with the amplitudes of the free modes fitted to `measured`, the channel `without` left out.
    pub(super) fn fitted(&self, measured: &[c64], without: Option<usize>) -> Vec<c64> {
        self.moved_by(&self.free_amplitudes(measured, without))
    }

    /// What the model says at the channels with these amplitudes of the free modes added.
    pub(super) fn moved_by(&self, free: &[c64]) -> Vec<c64> {
        let moved = |c: usize| free.iter().zip(&self.shapes).fold(self.model[c], |x, (b, shape)| x + b * shape[c]);
        (0..self.model.len()).map(moved).collect()
    }

    /// Amplitudes of the free modes beside the model, fitted to `measured`, the channel `without` left out.
    pub(super) fn free_amplitudes(&self, measured: &[c64], without: Option<usize>) -> Vec<c64> {
        let n = measured.len();
        let mut found = vec![c64::new(0.0, 0.0); self.shapes.len()];
        if found.is_empty() {
            return found;
        }
        let scale = |c: usize| 1.0 / self.model[c].norm().max(self.floor[c]).max(measured[c].norm());
        let mut weights: Vec<f64> = (0..n).map(|c| if Some(c) == without { 0.0 } else { scale(c).powi(2) }).collect();
        for _ in 0..STEPS {
            let left: Vec<c64> = measured.iter().zip(&self.model).map(|(measured, model)| measured - model).collect();
            let Some(b) = amplitudes(&self.shapes, &left, &weights) else { break };
            found = b;
            let fit = self.moved_by(&found);
            for c in (0..n).filter(|&c| Some(c) != without) {
                weights[c] = scale(c).powi(2) / self.error(c, measured[c], fit[c]).max(EVEN);
            }
        }
        found
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
pub(super) fn free_modes(modes: &Modes, omega: f64, channels: usize) -> Option<Vec<usize>> {
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
pub(super) fn by_distance(modes: &Modes, omega: f64) -> Vec<usize> {
    let distance = |j: usize| (modes.omega[j] / omega - 1.0).abs();
    let mut all: Vec<usize> = (0..modes.len()).collect();
    all.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    all
}

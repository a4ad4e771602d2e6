//! A structure with its sources, stepped through time: see the parent module.

use super::element::Element;
use super::propagator::Propagator;
use crate::effects::{Constant, Kind, Leg, Place, Source};
use crate::response::equivalent_viscous::equivalent_viscous;
use crate::response::harmonic_balance::{Excitation, HarmonicForce, Response};
use crate::structure::{Structure, StructureError, SystemMatrices};
use faer::Mat;
use std::f64::consts::TAU;

/// Sweeps of Gauss and Seidel over the nonlinear elements of one step.
const SWEEPS: usize = 500;
/// Change of a force, relative to the greatest so far, that counts as rounding.
const ROUNDING: f64 = 1e-10;

/// Why a model cannot be stepped through time.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimeError {
    /// `points` structures have no equation of motion.
    #[error("the structure has no mass and stiffness matrices, so it cannot be stepped through time")]
    NoMatrices,
    /// A law that exists only in steady state.
    #[error(
        "law `{effect}` is defined harmonic by harmonic and has no force in time: simulate it by harmonic balance, without `--by time`, `--transient` and `integrate = true`"
    )]
    NoTimeDomain {
        /// Index in the list of sources.
        source_index: usize,
        /// Its law.
        effect: &'static str,
    },
    /// The total mass is not positive definite.
    #[error(
        "the mass matrix with its `mass` sources is not positive definite, so the model cannot be stepped through time: correct the negative masses"
    )]
    MassNotPositive,
    /// Nonsense as number of steps or frequency.
    #[error("{steps} steps in a period of {period_s} s: give at least 8 steps and a positive period")]
    BadStep {
        /// Steps a period.
        steps: usize,
        /// Period, s.
        period_s: f64,
    },
    /// Gauss and Seidel did not come to rest, or a force has no answer.
    #[error(
        "the forces of a time step at {time_s:.6e} s were not found: a softening spring may have been driven beyond its limit point, from where the motion grows without bounds; else take more steps a period (`--steps`) than {steps}"
    )]
    StepFailed {
        /// Time, s.
        time_s: f64,
        /// Steps a period.
        steps: usize,
    },
    /// No periodic motion within the periods allowed.
    #[error(
        "no periodic motion was found by stepping through {periods} periods (it still changes by {change:.1e} a period): take more steps a period (`--steps`), add damping, or simulate by harmonic balance"
    )]
    NotSettled {
        /// Periods run.
        periods: usize,
        /// Relative change of the last period.
        change: f64,
    },
    /// No modes at which structural damping could be taken as viscous.
    #[error(transparent)]
    Modes(#[from] StructureError),
    /// The computation was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] crate::control::Cancelled),
}

/// A model at one excitation with a constant time step, and its present state.
pub struct TimeModel {
    pub(crate) steps: usize,
    pub(crate) step: f64,
    pub(crate) omega: f64,
    propagator: Propagator,
    elements: Vec<Element>,
    /// Receptance between elements over one step, m/N, row by row.
    receptance: Vec<f64>,
    /// Mean force of each driven DOF over each step of a period, N.
    drive: Vec<Vec<f64>>,
    /// Force of each driven DOF at the start of each step of a period, N.
    instant_drive: Vec<Vec<f64>>,
    /// Scaled displacements, then velocities.
    pub(crate) state: Vec<f64>,
    next: Vec<f64>,
    /// Mean force of each element over the last step, N.
    pub(crate) forces: Vec<f64>,
    /// Greatest force of an element so far, N.
    greatest: f64,
    /// Steps since time zero.
    pub(crate) count: usize,
}

impl TimeModel {
    /// At rest, `steps` steps a period of the excitation.
    pub fn new(
        structure: &Structure,
        sources: &[Source],
        excitation: &Excitation,
        steps: usize,
    ) -> Result<Self, TimeError> {
        let period = TAU / excitation.omega;
        if steps < 8 || !(period > 0.0 && period.is_finite()) {
            return Err(TimeError::BadStep { steps, period_s: period });
        }
        // In a steady state off resonance structural damping is not the viscous one of the natural frequency.
        let hysteretic = |s: &Source| s.effect.adds_to(Constant::Hysteretic);
        if let Some(source_index) = sources.iter().position(hysteretic) {
            return Err(TimeError::NoTimeDomain { source_index, effect: sources[source_index].effect.name() });
        }
        let driven: Vec<Vec<(usize, f64)>> = excitation.forces.iter().map(|force| vec![(force.dof, 1.0)]).collect();
        let drive = [drive(excitation, steps, true), drive(excitation, steps, false)];
        Self::driven(structure, sources, &driven, drive, period / steps as f64)
    }

    /// At rest under any force: `force[n]` (N) at the instants `n step` on one DOF, straight between them; without it, free.
    /// It may be stepped as often as the force has values less one.
    pub fn under_force(
        structure: &Structure,
        sources: &[Source],
        force: Option<(usize, &[f64])>,
        step: f64,
    ) -> Result<Self, TimeError> {
        let force = force.map(|(dof, values)| (vec![(dof, 1.0)], values));
        Self::under_loads(structure, sources, force.as_ref().map(|(loads, values)| (&loads[..], *values)), step)
    }

    /// The same under one force in time that acts on several DOFs at once, each with its factor, as that of a moving base does.
    pub fn under_loads(
        structure: &Structure,
        sources: &[Source],
        force: Option<(&[(usize, f64)], &[f64])>,
        step: f64,
    ) -> Result<Self, TimeError> {
        let mean = |values: &[f64]| {
            let pairs = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
            pairs.chain(values.last().copied()).collect::<Vec<f64>>()
        };
        match force {
            Some((loads, values)) if !values.is_empty() => {
                let drive = [vec![mean(values)], vec![values.to_vec()]];
                Self::driven(structure, sources, &[loads.to_vec()], drive, step)
            }
            _ => Self::driven(structure, sources, &[], [Vec::new(), Vec::new()], step),
        }
    }

    /// Under given forces, each on DOFs with their factors: their means over the steps and their values at the start of each.
    fn driven(
        structure: &Structure,
        sources: &[Source],
        driven: &[Vec<(usize, f64)>],
        drive: [Vec<Vec<f64>>; 2],
        step: f64,
    ) -> Result<Self, TimeError> {
        let steps = drive[0].first().map_or(usize::MAX, Vec::len);
        if !(step > 0.0 && step.is_finite()) {
            return Err(TimeError::BadStep { steps, period_s: step });
        }
        let matrices = structure.matrices().ok_or(TimeError::NoMatrices)?;
        let (linear, elements) = sort(structure, matrices, sources)?;
        let patterns = patterns(structure.len(), &elements, driven);
        let [mass, damping, stiffness] = &linear;
        let propagator =
            Propagator::new(mass, damping, stiffness, &patterns, step).ok_or(TimeError::MassNotPositive)?;
        let between = |a: &Element, j: usize| a.leg.relative(|i| propagator.displacement(i, j));
        let receptance = elements.iter().flat_map(|a| (0..elements.len()).map(move |j| (a, j)));
        let receptance = receptance.map(|(a, j)| between(a, j)).collect();
        let forces = vec![0.0; elements.len()];
        let zeros = vec![0.0; 2 * structure.len()];
        let [drive, instant_drive] = drive;
        let omega = TAU / (step * steps as f64);
        let (state, next) = (zeros.clone(), zeros);
        Ok(Self {
            steps,
            step,
            omega,
            propagator,
            elements,
            receptance,
            drive,
            instant_drive,
            state,
            next,
            forces,
            greatest: 0.0,
            count: 0,
        })
    }

    /// Starts at time zero of a periodic response.
    pub fn start_from(&mut self, response: &Response) {
        let (displacement, velocity) = response.state_at(0.0);
        self.start(&displacement, &velocity);
    }

    /// Starts at time zero with displacements (m) and velocities (m/s) of all DOFs, memories fresh.
    pub fn start(&mut self, displacement: &[f64], velocity: &[f64]) {
        let n = self.propagator.size;
        for i in 0..n {
            self.state[i] = self.propagator.scale * displacement[i];
            self.state[n + i] = velocity[i];
        }
        self.count = 0;
        for element in &mut self.elements {
            element.restart(element.leg.relative(|i| displacement[i]));
        }
    }

    /// Number of degrees of freedom.
    pub fn len(&self) -> usize {
        self.propagator.size
    }

    /// Whether there is no degree of freedom; never true.
    pub fn is_empty(&self) -> bool {
        self.propagator.size == 0
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.count as f64 * self.step
    }

    /// Displacement of DOF `i`, m.
    pub fn displacement(&self, i: usize) -> f64 {
        self.state[i] / self.propagator.scale
    }

    /// Velocity of DOF `i`, m/s.
    pub fn velocity(&self, i: usize) -> f64 {
        self.state[self.propagator.size + i]
    }

    /// Accelerations (m/s^2) of all DOFs at the present instant, under the given forces of the nonlinear elements (N).
    pub(crate) fn acceleration(&self, elements: impl Iterator<Item = f64>) -> Vec<f64> {
        let phase = self.count % self.steps;
        let drive = self.instant_drive.iter().map(|drive| drive[phase]);
        self.propagator.acceleration(&self.state, elements.map(|f| -f).chain(drive))
    }

    pub(crate) fn scale(&self) -> f64 {
        self.propagator.scale
    }

    /// One step.
    pub fn advance(&mut self) -> Result<(), TimeError> {
        self.propagator.advance(&self.state, &mut self.next);
        let phase = self.count % self.steps;
        let count = self.elements.len();
        for (input, drive) in self.drive.iter().enumerate() {
            self.propagator.push(count + input, drive[phase], &mut self.next);
        }
        let relative = |leg: Leg, y: &[f64]| leg.relative(|i| y[i]) / self.propagator.scale;
        let before: Vec<f64> = self.elements.iter().map(|e| relative(e.leg, &self.state)).collect();
        let free: Vec<f64> = self.elements.iter().zip(&before).map(|(e, d)| relative(e.leg, &self.next) - d).collect();
        if !self.balance(&before, &free) {
            return Err(TimeError::StepFailed { time_s: self.time(), steps: self.steps });
        }
        for i in 0..count {
            self.propagator.push(i, -self.forces[i], &mut self.next);
        }
        std::mem::swap(&mut self.state, &mut self.next);
        for element in &mut self.elements {
            let d = element.leg.relative(|i| self.state[i]) / self.propagator.scale;
            element.commit(d, self.step);
        }
        self.count += 1;
        Ok(())
    }

    /// Forces of the elements over the step, from displacements `before` and their free change.
    fn balance(&mut self, before: &[f64], free: &[f64]) -> bool {
        let count = self.elements.len();
        let mut change = 0.0_f64;
        for _ in 0..SWEEPS {
            let mut largest = 0.0_f64;
            change = 0.0;
            for i in 0..count {
                let row = &self.receptance[i * count..(i + 1) * count];
                let others: f64 = (0..count).filter(|&j| j != i).map(|j| row[j] * self.forces[j]).sum();
                let old = self.forces[i];
                let new = self.elements[i].force(before[i], row[i], free[i] - others, self.step, old);
                self.forces[i] = new;
                change = change.max((new - old).abs());
                largest = largest.max(new.abs());
            }
            self.greatest = self.greatest.max(largest);
            if count == 1 || change <= 1e-12 * largest {
                return self.forces.iter().all(|f| f.is_finite());
            }
        }
        // Where all forces pass zero together, their sum is at rest long before their ratio is.
        change <= ROUNDING * self.greatest && self.forces.iter().all(|f| f.is_finite())
    }
}

/// `M`, `C`, `K` with the linear sources, and the elements of all others.
fn sort(
    structure: &Structure,
    matrices: &SystemMatrices,
    sources: &[Source],
) -> Result<([Mat<f64>; 3], Vec<Element>), TimeError> {
    let n = structure.len();
    let mut linear = [matrices.mass.clone(), Mat::zeros(n, n), matrices.stiffness.clone()];
    let mut loss = Mat::zeros(n, n);
    let mut elements = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let refuse = || TimeError::NoTimeDomain { source_index: index, effect: source.effect.name() };
        let target = match source.effect.constant() {
            Some(Constant::Mass) => &mut linear[0],
            Some(Constant::Viscous) => &mut linear[1],
            Some(Constant::Stiffness) => &mut linear[2],
            Some(Constant::Hysteretic) => &mut loss,
            None => {
                let Some(law) = source.effect.law() else { continue };
                if law.is_linear() && law.memory(&source.parameters).is_none() {
                    return Err(refuse());
                }
                let new = |leg| Element::new(leg, law, &source.parameters);
                elements.extend(source.place.legs().into_iter().map(new));
                continue;
            }
        };
        add_legs(target, source);
        add_whole(target, structure, source);
    }
    if sources.iter().any(|s| s.effect.adds_to(Constant::Hysteretic)) {
        linear[1] += equivalent_viscous(matrices, &loss)?;
    }
    Ok((linear, elements))
}

fn add_legs(matrix: &mut Mat<f64>, source: &Source) {
    for leg in source.place.legs() {
        let value = source.parameters[0];
        matrix[(leg.first, leg.first)] += value;
        if let Some(second) = leg.second {
            matrix[(second, second)] += value;
            matrix[(leg.first, second)] -= value;
            matrix[(second, leg.first)] -= value;
        }
    }
}

/// `beta K` or `alpha M`, of the whole structure or of a range of its elements.
fn add_whole(damping: &mut Mat<f64>, structure: &Structure, source: &Source) {
    if let (Kind::Whole(law), Place::Whole(range)) = (source.effect.kind(), &source.place)
        && let Some(matrix) = law.basis().matrix(structure, *range)
    {
        *damping += matrix * faer::Scale(source.parameters[0]);
    }
}

/// Force patterns: of the elements first, then of the driven DOFs.
fn patterns(n: usize, elements: &[Element], driven: &[Vec<(usize, f64)>]) -> Mat<f64> {
    let mut patterns = Mat::zeros(n, elements.len() + driven.len());
    for (j, element) in elements.iter().enumerate() {
        patterns[(element.leg.first, j)] = 1.0;
        if let Some(second) = element.leg.second {
            patterns[(second, j)] = -1.0;
        }
    }
    for (j, loads) in driven.iter().enumerate() {
        loads.iter().for_each(|&(dof, load)| patterns[(dof, elements.len() + j)] = load);
    }
    patterns
}

/// Each force over the steps of the period: its mean over each, or its value at the start of each.
fn drive(excitation: &Excitation, steps: usize, mean: bool) -> Vec<Vec<f64>> {
    let angle = TAU / steps as f64;
    let value = |force: &HarmonicForce, n: usize| {
        (1..=force.harmonics.len()).fold(force.mean, |sum, h| {
            let half = 0.5 * h as f64 * angle;
            let (share, shift) = if mean { (half.sin() / half, 0.5) } else { (1.0, 0.0) };
            let (sin, cos) = (2.0 * half * (n as f64 + shift)).sin_cos();
            let f = force.amplitude(h);
            sum + (f.re * cos - f.im * sin) * share
        })
    };
    excitation.forces.iter().map(|force| (0..steps).map(|n| value(force, n)).collect()).collect()
}

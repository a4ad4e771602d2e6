//! The model of a record: built once for a structure with its sources, predicted for any force and initial state.

use super::assembly::{Nonlinear, assemble, is_linear, modal_stiffness, nonlinear, pattern_matrix};
use super::changes::Changes;
use super::derivatives::Derivatives;
use super::element::{Element, Form};
use super::error::TransientError;
use super::hold::Polynomial;
use super::march::March;
use super::reduction::Reduction;
use super::setup::{SampledForces, TransientParameter, TransientResponse, TransientSetup};
use super::step::Step;
use super::system::{LinearChange, LinearSystem, Matrices};
use super::view::{Sensitivity, View};
use super::writer::{Seen, Sensor, Writer};
use crate::effects::Leg;
use crate::measurement::{Channel, Quantity};
use dashpot_numerics::dot;
use faer::Mat;

/// A model that predicts records.
pub struct TransientModel {
    reduction: Reduction,
    pub(super) system: LinearSystem,
    views: Vec<View>,
    pub(super) sensors: Vec<Sensor>,
    pub(super) legs: Vec<Nonlinear>,
    changes: Vec<(TransientParameter, Matrices)>,
    /// Stiffness of each coordinate as it is in the model, 1/s^2.
    mode_stiffness: Vec<f64>,
    /// Static displacement of each residual coordinate under a unit of every drive.
    flexibility: Vec<Vec<f64>>,
}

impl TransientModel {
    /// Assembles the model.
    ///
    /// # Errors
    /// [`TransientError`]: no matrices, laws without a force in time, masses or springs that cannot be.
    pub fn new(setup: &TransientSetup) -> Result<Self, TransientError> {
        let matrices = setup.structure.matrices().ok_or(TransientError::NoMatrices)?;
        let mut legs = Vec::new();
        for (index, source) in setup.sources.iter().enumerate() {
            legs.extend(nonlinear(index, source)?);
        }
        let n = setup.structure.len();
        let driven = |&dof: &usize| Leg { first: dof, second: None };
        let places: Vec<Leg> = legs.iter().map(|(_, leg, ..)| *leg).chain(setup.drives.iter().map(driven)).collect();
        let linear = setup.sources.iter().filter(|s| is_linear(s.effect)).flat_map(|s| s.place.legs());
        let patterns = pattern_matrix(n, &places.iter().copied().chain(linear).collect::<Vec<_>>());
        let reduction = Reduction::new(matrices, setup.modes, setup.kept, &patterns)?;
        let size = reduction.omega.len();
        let along = |leg: Leg| -> Vec<f64> { (0..size).map(|r| leg.relative(|i| reduction.basis[(i, r)])).collect() };
        let inputs: Vec<Vec<f64>> = places.iter().map(|leg| along(*leg)).collect();
        let inputs = Mat::from_fn(size, inputs.len(), |r, i| inputs[i][r]);
        let (total, changes) = assemble(setup, &reduction, &along);
        let system = LinearSystem::new(&total, &inputs)?;
        let view = |leg: Leg| {
            let observed = |order| system.functional(&along(leg), order);
            View { displacement: observed(0).row, velocity: observed(1).row, acceleration: observed(2) }
        };
        let views = legs.iter().map(|(_, leg, ..)| view(*leg)).collect();
        let sensor = |(c, channel): (usize, &Channel)| {
            let mut pattern = along(driven(&channel.dof));
            let errors = setup.shape_errors.get(c).into_iter().flatten().take(reduction.kept);
            pattern.iter_mut().zip(errors).for_each(|(p, e)| *p += e);
            let order = channel.quantity.derivatives();
            Sensor {
                order,
                functional: system.functional(&pattern, order.unwrap_or(0)),
                pattern: (order == Some(2)).then_some(pattern),
                drive: match channel.quantity {
                    Quantity::Force => Some(setup.drives.iter().position(|d| *d == channel.dof).unwrap_or(usize::MAX)),
                    _ => None,
                },
            }
        };
        let sensors = setup.channels.iter().enumerate().map(sensor).collect();
        let mode_stiffness: Vec<f64> = (0..size).map(|r| modal_stiffness(setup, &reduction, r)).collect();
        let drives = legs.len()..legs.len() + setup.drives.len();
        let under = |r: usize| drives.clone().map(|i| inputs[(r, i)] / mode_stiffness[r]).collect();
        let flexibility = (reduction.kept..size).map(under).collect();
        Ok(Self { reduction, system, views, sensors, legs, changes, mode_stiffness, flexibility })
    }

    /// Number of kept modes `m`; an initial state has `2 m` entries.
    pub fn kept(&self) -> usize {
        self.reduction.kept
    }

    /// Whether every force is linear in the motion, so that a step between samples is exact.
    pub fn is_linear(&self) -> bool {
        self.legs.is_empty()
    }

    /// Natural frequency of the highest kept mode, rad/s, where friction may hold it.
    fn held_by_friction(&self) -> Option<f64> {
        let holds = self.legs.iter().any(|(_, _, form, ..)| *form == Form::Friction);
        holds.then(|| self.reduction.omega[..self.kept()].iter().copied().fold(0.0, f64::max))
    }

    /// The record from `initial`: displacements of the kept modes times `sqrt(kg)`, then their velocities divided by the
    /// natural frequency (those of rigid bodies as they are), and its derivatives by `parameters`.
    ///
    /// # Errors
    /// [`TransientError::StepFailed`] where the motion grows without bounds.
    pub fn predict(
        &self,
        forces: &SampledForces,
        initial: &[f64],
        parameters: &[TransientParameter],
    ) -> Result<TransientResponse, TransientError> {
        let segments = forces.segments(self.held_by_friction());
        let first = segments[0].begin(forces.step);
        let lengths = segments[0].lengths(forces.step);
        let changes: Vec<LinearChange> = parameters.iter().filter_map(|p| self.change(*p)).collect();
        let (mut march, mut writer) = self.start(initial, &first, parameters, &changes, lengths);
        let (count, every) = (self.sensors.len(), forces.every.max(1));
        let predicted = forces.samples.div_ceil(every);
        let mut channels = vec![Vec::with_capacity(predicted); count];
        let mut derivatives = vec![vec![Vec::with_capacity(predicted); count]; parameters.len()];
        let mut modal = self.no_modal(parameters, predicted);
        let mut drives = vec![Polynomial::default(); first.len()];
        let mut inputs = vec![0.0; self.legs.len() + first.len()];
        for (k, segment) in segments.iter().enumerate() {
            if k > 0 {
                let lengths = segment.lengths(forces.step);
                march.set_step(lengths, &changes, first.len());
                writer.set_step(&self.system, &self.sensors, lengths);
            }
            let begin = if k == 0 { 0 } else { segment.from + segment.samples };
            for n in (begin..=segment.to).step_by(segment.samples) {
                for part in 0..if n == 0 { 0 } else { segment.substeps } {
                    segment.drives(n - segment.samples, part, &mut drives);
                    march.advance(&drives)?;
                }
                if !n.is_multiple_of(every) {
                    continue;
                }
                segment.inputs(n, &mut inputs[self.legs.len()..]);
                writer.moved = n > 0;
                self.write(&march, &mut writer, &mut inputs, &mut channels);
                if !derivatives.is_empty() {
                    self.write_derivatives(&mut march, &mut writer, &inputs, &mut derivatives);
                }
                writer.write_modal(&march, &inputs, &mut modal);
            }
        }
        writer.write_gathered(&march.derivatives.order, &mut derivatives, true);
        if !march.z.iter().all(|z| z.is_finite()) {
            return Err(TransientError::StepFailed);
        }
        Ok(TransientResponse { channels, derivatives, modal, end: self.state(&march.z) })
    }

    /// Empty lists of what channels show of the kept modes, where derivatives by `parameters` are asked for.
    fn no_modal(&self, parameters: &[TransientParameter], samples: usize) -> [Vec<Vec<f64>>; 3] {
        let wanted = |order| !parameters.is_empty() && self.sensors.iter().any(|s| s.order == Some(order));
        let list = |order| if wanted(order) { vec![Vec::with_capacity(samples); self.kept()] } else { Vec::new() };
        [0, 1, 2].map(list)
    }

    /// Unit of velocity entries of the initial state.
    fn rate(&self, r: usize) -> f64 {
        if self.reduction.omega[r] > 0.0 { self.reduction.omega[r] } else { 1.0 }
    }

    /// Damped modes of an initial state; the residual coordinates, which are not followed, rest under the `drives`, each a force and
    /// its rate, so that a part of a record does not begin with a blow.
    pub(super) fn modes_of(&self, state: &[f64], drives: &[[f64; 2]]) -> Vec<f64> {
        let (kept, size) = (self.kept(), self.system.coordinates());
        let mut displacement = vec![0.0; size];
        let mut velocity = vec![0.0; size];
        for r in 0..kept {
            displacement[r] = state[r];
            velocity[r] = state[kept + r] * self.rate(r);
        }
        for (r, list) in self.flexibility.iter().enumerate() {
            for (flexibility, [force, rate]) in list.iter().zip(drives) {
                displacement[kept + r] += flexibility * force;
                velocity[kept + r] += flexibility * rate;
            }
        }
        self.system.modes_of(&displacement, &velocity)
    }

    fn state(&self, z: &[f64]) -> Vec<f64> {
        let (p, v) = self.system.coordinates_of(z);
        let kept = self.kept();
        (0..kept).map(|r| p[r]).chain((0..kept).map(|r| v[r] / self.rate(r))).collect()
    }

    fn start(
        &self,
        initial: &[f64],
        drives: &[[f64; 2]],
        parameters: &[TransientParameter],
        changes: &[LinearChange],
        [length, sample]: [f64; 2],
    ) -> (March<'_>, Writer) {
        let state = self.modes_of(initial, drives);
        let element = |(source, _, form, law, p): &Nonlinear| Element::new(*source, *form, *law, p, parameters.len());
        let elements: Vec<Element> = self.legs.iter().map(element).collect();
        let mut sensitivities = Vec::new();
        for parameter in parameters {
            let changes_linear_part = self.changes_linear_part(*parameter);
            let state = self.initial_derivative(*parameter, initial.len(), drives);
            let own = match *parameter {
                TransientParameter::Source { source, parameter } => Some((source, parameter)),
                _ => None,
            };
            sensitivities.push(Sensitivity { state, own, changes_linear_part });
        }
        let widths = [elements.len(), self.kept(), parameters.len()];
        let writer = Writer::new(&self.system, &self.sensors, widths, changes, [length, sample]);
        let step = Step::new(&self.system, length, sample);
        let changes = Changes::new(&self.system, &step, changes, [elements.len(), drives.len()]);
        let derivatives = Derivatives::new(&elements, &sensitivities, changes, state.len());
        (March::new(&self.system, &self.views, elements, state, derivatives, step), writer)
    }

    /// How the initial state, of `count` entries under the `drives`, changes with a parameter.
    fn initial_derivative(&self, parameter: TransientParameter, count: usize, drives: &[[f64; 2]]) -> Vec<f64> {
        let rest = vec![0.0; count];
        match parameter {
            TransientParameter::Initial(k) => {
                let mut unit = rest;
                unit[k] = 1.0;
                self.modes_of(&unit, &[])
            }
            // What rests under a force moves back as the stiffness grows.
            TransientParameter::Stiffness => {
                let back: Vec<[f64; 2]> = drives.iter().map(|drive| drive.map(|u| -u)).collect();
                self.modes_of(&rest, &back)
            }
            _ => vec![0.0; 2 * self.system.lambda.len()],
        }
    }

    fn changes_linear_part(&self, parameter: TransientParameter) -> bool {
        matches!(parameter, TransientParameter::Mode(_)) || self.changes.iter().any(|(p, _)| *p == parameter)
    }

    fn change(&self, parameter: TransientParameter) -> Option<LinearChange> {
        if let TransientParameter::Mode(r) = parameter {
            let mut by = Matrices::zeros(self.system.coordinates());
            by.stiffness[(r, r)] = self.mode_stiffness[r];
            return Some(self.system.change(&by));
        }
        self.changes.iter().find(|(p, _)| *p == parameter).map(|(_, by)| self.system.change(by))
    }

    /// What the channels show at the present sample under `inputs`, of which the forces of elements are filled in.
    fn write(&self, march: &March, writer: &mut Writer, inputs: &mut [f64], channels: &mut [Vec<f64>]) {
        let count = march.elements.len();
        writer.seen.clear();
        for (l, view) in self.views.iter().enumerate() {
            let motion = [dot(&view.displacement, &march.z), dot(&view.velocity, &march.z)];
            let [force, by_d, by_v] = march.elements[l].instant(motion[0], motion[1], march.side[l], march.forces[l]);
            inputs[l] = -force;
            writer.seen.push(Seen { motion, slopes: [by_d, by_v] });
        }
        writer.set_beyond(inputs, &march.forces);
        for (c, (sensor, list)) in self.sensors.iter().zip(channels).enumerate() {
            list.push(if let Some(drive) = sensor.drive {
                inputs.get(count.saturating_add(drive)).copied().unwrap_or(0.0)
            } else {
                let seen = dot(&sensor.functional.row, &march.z) + dot(&sensor.functional.inputs, inputs);
                seen + writer.late(c)
            });
        }
    }

    /// Their derivatives.
    fn write_derivatives(
        &self,
        march: &mut March,
        writer: &mut Writer,
        inputs: &[f64],
        derivatives: &mut [Vec<Vec<f64>>],
    ) {
        let March { elements, derivatives: by, side, z, .. } = march;
        for l in 0..elements.len() {
            let seen = writer.seen[l];
            self.force_change(l, &mut elements[l], by, seen, side[l], writer.force_row(l));
        }
        for (c, sensor) in self.sensors.iter().enumerate() {
            writer.gather(c, sensor, by, z, inputs);
        }
        writer.write_gathered(&by.order, derivatives, false);
    }

    /// Derivatives of the present force of element `l`.
    fn force_change(
        &self,
        l: usize,
        element: &mut Element,
        by: &mut Derivatives,
        seen: Seen,
        side: f64,
        row: &mut [f64],
    ) {
        if element.form == Form::Friction && side == 0.0 {
            row.copy_from_slice(&by.forces[l * by.stride..(l + 1) * by.stride]);
            return;
        }
        row.fill(0.0);
        let view = &self.views[l];
        for (slope, view) in seen.slopes.into_iter().zip([&view.displacement, &view.velocity]) {
            if slope != 0.0 {
                by.add_seen(view, slope, row);
            }
        }
        let [d, v] = seen.motion;
        for (p, row) in row.iter_mut().take(by.len()).enumerate() {
            *row += element.instant_by(p, by.own[l][p], d, v, side);
        }
    }
}

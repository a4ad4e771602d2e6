//! What channels show of the state at a sample.

use super::derivatives::Derivatives;
use super::march::March;
use super::step::Step;
use super::system::{Functional, LinearChange, LinearSystem};
use dashpot_numerics::{combine_rows, dot, stride};

/// Samples whose derivatives are written together: two lines of memory.
const GATHERED: usize = 16;

/// What a channel shows.
pub(super) struct Sensor {
    /// Times the motion is differentiated; none for a force.
    pub order: Option<i32>,
    pub functional: Functional,
    /// Shape along the reduced coordinates, for accelerations.
    pub pattern: Option<Vec<f64>>,
    /// The drive that a force channel repeats.
    pub drive: Option<usize>,
}

/// What an element sees at a sample: displacement (m) and velocity (m/s), with the slopes of its force by both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub motion: [f64; 2],
    pub slopes: [f64; 2],
}

/// What turns states into samples of the channels.
pub(super) struct Writer {
    /// How accelerations change with each change of the linear part at a fixed state: over the state and the inputs, a row of the
    /// parameters each; empty for other sensors.
    changes: Vec<Vec<f64>>,
    /// What a sensor shows too late of a unit by which the force of an element is beyond its mean over the step, one sensor after the
    /// other: modes that follow at once have come to rest under the mean.
    late: Vec<f64>,
    elements: usize,
    /// Whether a step lies behind.
    pub moved: bool,
    /// What the elements see.
    pub seen: Vec<Seen>,
    /// By how much the force of every element on the structure is beyond its mean over the last step.
    beyond: Vec<f64>,
    /// Derivatives of the forces of the elements, a row an element.
    by_force: Vec<f64>,
    state: Vec<f64>,
    row: Vec<f64>,
    changed: Vec<f64>,
    /// Rows of derivatives of each sensor that are not written yet.
    gathered: Vec<Vec<f64>>,
    /// What a channel of each order shows of each kept mode, and what it shows of it too late.
    modes: [Vec<(Functional, Vec<f64>)>; 3],
}

impl Writer {
    /// Of a linear part under `elements` elements, whose first `kept` coordinates are kept modes, differentiated by some `parameters`; steps
    /// of `steps[0]` s, samples `steps[1]` s apart.
    pub(super) fn new(
        system: &LinearSystem,
        sensors: &[Sensor],
        [elements, kept, parameters]: [usize; 3],
        changes: &[LinearChange],
        steps: [f64; 2],
    ) -> Self {
        let stride_of_all = stride(parameters);
        let mut writer = Self {
            changes: sensors.iter().map(|sensor| changes_seen(system, sensor, changes)).collect(),
            late: Vec::new(),
            elements,
            moved: false,
            seen: Vec::with_capacity(elements),
            beyond: vec![0.0; elements],
            by_force: vec![0.0; elements * stride_of_all],
            state: Vec::new(),
            row: vec![0.0; stride_of_all],
            changed: vec![0.0; stride(changes.len())],
            gathered: vec![Vec::with_capacity(GATHERED * stride_of_all); sensors.len()],
            modes: [0, 1, 2]
                .map(|order| modes_seen(system, kept, order).into_iter().map(|f| (f, Vec::new())).collect()),
        };
        writer.set_step(system, sensors, steps);
        writer
    }

    /// Goes on with steps of another length.
    pub(super) fn set_step(&mut self, system: &LinearSystem, sensors: &[Sensor], [length, sample]: [f64; 2]) {
        let (step, elements) = (Step::new(system, length, sample), self.elements);
        let late = |f: &Functional| (0..elements).map(|l| step.ramp(l, &f.row)).collect::<Vec<f64>>();
        self.late = sensors.iter().flat_map(|s| late(&s.functional)).collect();
        self.modes.iter_mut().flatten().for_each(|(f, own)| *own = late(f));
    }

    /// Notes what the forces on the structure, the first of the inputs, are beyond the mean `forces` of the elements.
    pub(super) fn set_beyond(&mut self, inputs: &[f64], forces: &[f64]) {
        let beyond = inputs.iter().zip(forces).map(|(now, mean)| now + mean);
        self.beyond.iter_mut().zip(beyond).for_each(|(own, beyond)| *own = beyond);
    }

    fn late_of(&self, c: usize) -> &[f64] {
        if self.moved { &self.late[c * self.elements..(c + 1) * self.elements] } else { &[] }
    }

    /// What sensor `c` shows more where the forces of elements are beyond their means over the last step.
    pub(super) fn late(&self, c: usize) -> f64 {
        dot(self.late_of(c), &self.beyond[..self.late_of(c).len()])
    }

    /// The row of the derivatives of the force of element `l`.
    pub(super) fn force_row(&mut self, l: usize) -> &mut [f64] {
        let stride = self.row.len();
        &mut self.by_force[l * stride..(l + 1) * stride]
    }

    /// Gathers the derivatives of what sensor `c` shows of the state `z` under `inputs`.
    pub(super) fn gather(&mut self, c: usize, sensor: &Sensor, by: &Derivatives, z: &[f64], inputs: &[f64]) {
        let mut row = std::mem::take(&mut self.row);
        if sensor.drive.is_some() {
            row.fill(0.0);
        } else {
            self.fill(&mut row, c, sensor, by, z, inputs);
        }
        self.gathered[c].extend_from_slice(&row);
        self.row = row;
    }

    /// Writes what was gathered once it is enough, or whatever it is at the end: `derivatives[parameter][channel]`, whose parameters stand in
    /// another `order` in the rows. Lists that are as many and as long as these are slow to be written sample by sample.
    pub(super) fn write_gathered(&mut self, order: &[usize], derivatives: &mut [Vec<Vec<f64>>], at_end: bool) {
        let stride = self.row.len();
        for (c, rows) in self.gathered.iter_mut().enumerate() {
            if stride == 0 || rows.len() < GATHERED * stride && !at_end {
                continue;
            }
            for (p, &theta) in order.iter().enumerate() {
                derivatives[theta][c].extend(rows.chunks_exact(stride).map(|row| row[p]));
            }
            rows.clear();
        }
    }

    fn fill(&mut self, row: &mut [f64], c: usize, sensor: &Sensor, by: &Derivatives, z: &[f64], inputs: &[f64]) {
        combine_rows(&sensor.functional.row, &by.states, row);
        if !self.changes[c].is_empty() {
            self.state.clear();
            self.state.extend(z.iter().chain(inputs));
            combine_rows(&self.state, &self.changes[c], &mut self.changed);
            row.iter_mut().zip(&self.changed).for_each(|(row, changed)| *row += changed);
        }
        let stride = row.len();
        for l in 0..self.elements {
            let late = self.late_of(c).get(l).copied().unwrap_or(0.0);
            let at_once = late + sensor.functional.inputs[l];
            let means = &by.forces[l * stride..(l + 1) * stride];
            for ((row, now), mean) in row.iter_mut().zip(&self.by_force[l * stride..]).zip(means) {
                *row += late * mean - at_once * now;
            }
        }
    }

    /// Adds what channels show of the kept modes at the present state under inputs.
    pub(super) fn write_modal(&self, march: &March, inputs: &[f64], modal: &mut [Vec<Vec<f64>>; 3]) {
        for (lists, modes) in modal.iter_mut().zip(&self.modes) {
            for (list, (functional, late)) in lists.iter_mut().zip(modes) {
                let late = if self.moved { dot(late, &self.beyond) } else { 0.0 };
                list.push(dot(&functional.row, &march.z) + dot(&functional.inputs, inputs) + late);
            }
        }
    }
}

/// How an acceleration changes with each change of the linear part, over the state and the inputs, a row of the changes each; empty for
/// other sensors.
fn changes_seen(system: &LinearSystem, sensor: &Sensor, changes: &[LinearChange]) -> Vec<f64> {
    let Some(pattern) = &sensor.pattern else { return Vec::new() };
    let columns = stride(changes.len());
    let mut rows = vec![0.0; columns * (2 * system.lambda.len() + system.beta.len())];
    for (c, change) in changes.iter().enumerate() {
        let Functional { row, inputs } = system.acceleration_change(pattern, change);
        rows.chunks_exact_mut(columns).zip(row.iter().chain(&inputs)).for_each(|(row, x)| row[c] = *x);
    }
    rows
}

/// What a channel of an order of differentiation shows of each kept mode.
fn modes_seen(system: &LinearSystem, kept: usize, order: i32) -> Vec<Functional> {
    let unit = |r: usize| -> Vec<f64> { (0..system.coordinates()).map(|k| f64::from(u8::from(k == r))).collect() };
    (0..kept).map(|r| system.functional(&unit(r), order)).collect()
}

//! What channels show of the state at a sample.

use super::march::March;
use super::step::Step;
use super::system::{Functional, LinearChange, LinearSystem};
use dashpot_numerics::{dot, scalar_products};

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

/// What turns states into samples of the channels.
pub(super) struct Writer {
    /// Rows of the sensors, one behind the other.
    pub sensors: Vec<f64>,
    /// How accelerations change with each change of the linear part at a fixed state: rows on the state and on the inputs, a
    /// sensor after the other, `width` numbers each.
    changes: Vec<f64>,
    width: usize,
    /// What a sensor shows too late of a unit by which the force of an element is beyond its mean over the step, one sensor after the
    /// other: modes that follow at once have come to rest under the mean.
    late: Vec<f64>,
    elements: usize,
    /// Whether a step lies behind.
    pub moved: bool,
    state: Vec<f64>,
    pub by_change: Vec<f64>,
    pub seen: Vec<f64>,
    /// What a channel of each order shows of each kept mode, and what it shows of it too late.
    modes: [Vec<(Functional, Vec<f64>)>; 3],
}

impl Writer {
    /// Of a linear part under `elements` elements, whose first `kept` coordinates are kept modes; steps of `steps[0]` s, samples `steps[1]`
    /// s apart.
    pub(super) fn new(
        system: &LinearSystem,
        sensors: &[Sensor],
        [elements, kept]: [usize; 2],
        changes: &[LinearChange],
        steps: [f64; 2],
    ) -> Self {
        let step = Step::new(system, steps[0], steps[1]);
        let width = 2 * system.lambda.len() + system.beta.len();
        let mut rows = Vec::with_capacity(changes.len() * sensors.len() * width);
        for change in changes {
            for sensor in sensors {
                match &sensor.pattern {
                    Some(pattern) => {
                        let Functional { row, inputs } = system.acceleration_change(pattern, change);
                        rows.extend(row.iter().chain(&inputs));
                    }
                    None => rows.resize(rows.len() + width, 0.0),
                }
            }
        }
        let late = |f: &Functional| (0..elements).map(|l| step.ramp(l, &f.row)).collect::<Vec<f64>>();
        Self {
            sensors: sensors.iter().flat_map(|s| s.functional.row.iter().copied()).collect(),
            changes: rows,
            width,
            late: sensors.iter().flat_map(|s| late(&s.functional)).collect(),
            elements,
            moved: false,
            state: Vec::new(),
            by_change: Vec::new(),
            seen: Vec::new(),
            modes: [0, 1, 2]
                .map(|order| modes_seen(system, kept, order).into_iter().map(|f| (f.clone(), late(&f))).collect()),
        }
    }

    /// What sensor `c` shows more where the force of every element is so far `beyond` its mean over the last step.
    pub(super) fn late(&self, c: usize, beyond: &[f64]) -> f64 {
        if !self.moved {
            return 0.0;
        }
        self.late[c * self.elements..(c + 1) * self.elements].iter().zip(beyond).map(|(late, f)| late * f).sum()
    }

    /// Adds what channels show of the kept modes at the present state under inputs.
    pub(super) fn write_modal(&self, march: &March, inputs: &[f64], modal: &mut [Vec<Vec<f64>>; 3]) {
        let beyond = if self.moved { beyond_mean(inputs, march) } else { vec![0.0; self.elements] };
        for (lists, modes) in modal.iter_mut().zip(&self.modes) {
            for (list, (functional, late)) in lists.iter_mut().zip(modes) {
                list.push(dot(&functional.row, &march.z) + dot(&functional.inputs, inputs) + dot(late, &beyond));
            }
        }
    }

    /// What the changes of the linear part do to the samples at a state under inputs.
    pub(super) fn changed(&mut self, z: &[f64], inputs: &[f64]) {
        self.state.clear();
        self.state.extend(z.iter().chain(inputs));
        scalar_products(&self.changes, &self.state, self.width, &mut self.by_change);
    }
}

/// By how much the force of every element on the structure is beyond its mean over the last step.
pub(super) fn beyond_mean(inputs: &[f64], march: &March) -> Vec<f64> {
    inputs.iter().zip(&march.forces).map(|(now, mean)| now + mean).collect()
}

/// What a channel of an order of differentiation shows of each kept mode.
fn modes_seen(system: &LinearSystem, kept: usize, order: i32) -> Vec<Functional> {
    let unit = |r: usize| -> Vec<f64> { (0..system.coordinates()).map(|k| f64::from(u8::from(k == r))).collect() };
    (0..kept).map(|r| system.functional(&unit(r), order)).collect()
}

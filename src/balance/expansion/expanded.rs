//! The motion of all DOFs as an expansion gives it, and what is known to act while it is found.

use super::map::Map;
use crate::balance::action::{self, Field, Secant};
use crate::balance::measured::Measured;
use crate::effects::Source;
use faer::{Mat, c64};

/// The motion of all DOFs in one run and how it follows from the measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Expanded {
    /// Displacement, n x kept harmonics, m.
    pub x: Mat<c64>,
    /// Expected standard deviation of the real part of each entry of `x`, from the noise and (`dynamic` only) the model's
    /// error; infinite where nothing is known.
    pub deviation: Mat<f64>,
    /// `E_h`, n x sensors, one a kept harmonic.
    pub from_sensors: Vec<Map>,
    /// `B_h`, n x force channels, one a kept harmonic.
    pub from_forces: Vec<Map>,
    /// Receptance between all DOFs and the sensors, n x sensors, one a kept harmonic; only for `dynamic`.
    pub receptance: Vec<Mat<c64>>,
    /// Whether each DOF is known at all.
    pub known: Vec<bool>,
    /// Root mean square of (measured - expanded) at the sensors, in standard deviations.
    pub misfit: f64,
    /// Root mean square of (measured - expanded) at the sensors over that of the measured.
    pub relative_misfit: f64,
}

impl Expanded {
    /// The motion as harmonics of the run.
    pub fn field<'a>(&'a self, measured: &'a Measured) -> Field<'a> {
        Field { omega: measured.omega, numbers: &measured.numbers, x: &self.x }
    }
}

/// What acts on the structure besides the exciters, as far as it is known, for `dynamic` expansion.
#[derive(Debug, Clone, Copy)]
pub struct Acting<'a> {
    /// Known and identified sources at their values.
    pub sources: &'a [Source],
    /// The motion found before, at which nonlinear laws are linearised.
    pub motion: Option<&'a Mat<c64>>,
    /// Relative error of the model: 0 trusts it entirely, 1 hardly.
    pub model_error: f64,
}

impl Acting<'_> {
    /// Nothing is known of the damping.
    pub const NOTHING: Self = Self { sources: &[], motion: None, model_error: 1.0 };

    /// Stand-in stiffness of every source at kept harmonic `k`; nonlinear ones only once a motion is known.
    pub(super) fn secants(&self, measured: &Measured, k: usize, n: usize) -> Vec<Secant> {
        let rest = Mat::zeros(n, measured.harmonics());
        let x = self.motion.unwrap_or(&rest);
        let field = Field { omega: measured.omega, numbers: &measured.numbers, x };
        self.sources.iter().filter_map(|source| action::secant(source, field, k)).collect()
    }
}

/// `E Y + B F` for all harmonics, with the deviation that noise gives and the misfit at the sensors.
pub(super) fn from_maps(
    measured: &Measured,
    from_sensors: Vec<Map>,
    from_forces: Vec<Map>,
    known: Vec<bool>,
) -> Expanded {
    let (n, harmonics) = (known.len(), measured.harmonics());
    let (mut x, mut deviation) = (Mat::zeros(n, harmonics), Mat::zeros(n, harmonics));
    for k in 0..harmonics {
        let (sensors, forces) = (&from_sensors[k], &from_forces[k]);
        let motion =
            sensors.times(&measured.sensors.values, k).into_iter().zip(forces.times(&measured.forces.values, k));
        motion.enumerate().for_each(|(i, (a, b))| x[(i, k)] = a + b);
        let noise = sensors.variances(&measured.sensors.deviations, k);
        for (i, (a, b)) in noise.into_iter().zip(forces.variances(&measured.forces.deviations, k)).enumerate() {
            deviation[(i, k)] = if known[i] { (a + b).sqrt() } else { f64::INFINITY };
        }
    }
    let mut expanded = Expanded {
        x,
        deviation,
        from_sensors,
        from_forces,
        receptance: Vec::new(),
        known,
        misfit: 0.0,
        relative_misfit: 0.0,
    };
    state_misfit(measured, &mut expanded);
    expanded
}

pub(super) fn state_misfit(measured: &Measured, expanded: &mut Expanded) {
    let (mut weighted, mut difference, mut size) = (0.0, 0.0, 0.0);
    for k in 0..measured.harmonics() {
        for (s, &dof) in measured.sensors.dofs.iter().enumerate() {
            let y = measured.sensors.values[(s, k)];
            let error = (y - expanded.x[(dof, k)]).norm_sqr();
            weighted += error / (2.0 * measured.sensors.deviations[(s, k)].powi(2));
            difference += error;
            size += y.norm_sqr();
        }
    }
    expanded.misfit = (weighted / (measured.sensors.len() * measured.harmonics()) as f64).sqrt();
    expanded.relative_misfit = if size > 0.0 { (difference / size).sqrt() } else { 0.0 };
}

/// No map for any kept harmonic.
pub(super) fn no_maps(n: usize, harmonics: usize) -> Vec<Map> {
    vec![Map::zero(n); harmonics]
}

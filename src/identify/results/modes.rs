//! Damped modes of the identified model (2.69) and how certain their damping ratios are.
//!
//! Viscous sources enter as they are. Laws that are not viscous enter by their energy-equivalent coefficient over all runs,
//! hysteretic ones by `h / omega_r` at each mode, to first order: `d lambda / d c_j = -lambda psi^T B_j psi`.

use super::input::ResultsInput;
use super::matrices::{EquivalentViscous, weighted_sum};
use crate::effects::{Constant, Effect, Kind, Source};
use crate::response::frequency_response::{self, HalfPower};
use crate::response::linear_matrices::{LinearMatrices, unit_matrix};
use crate::structure::damped_modes::{DampedMode, damped_modes_from};
use crate::structure::lowest_modes::LowestModes;
use crate::structure::modes::modes;
use crate::structure::{Structure, StructureError, SystemMatrices};
use faer::{Mat, c64};

/// Points of a half-power curve.
const POINTS: usize = 241;

/// DOFs up to which all modes are computed: twice as many cost eight times the time.
const ALL: usize = 600;
/// Undamped modes of larger structures, as a multiple of the highest frequency of the runs ...
const BAND: f64 = 4.0;
/// ... and the least number of them.
const LEAST: usize = 60;

/// One damped mode of the identified model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeResult {
    /// Frequency `|lambda| / 2 pi`, Hz.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Its standard deviation from that of the coefficients.
    pub damping_ratio_deviation: f64,
    /// Ratio from the half-power points of the model's own receptance, where its peak has both.
    pub half_power_ratio: Option<f64>,
    /// Complex shape, n values.
    pub shape: Vec<c64>,
}

/// The damped modes, of large structures those in the band of the runs; empty without mass and stiffness.
pub(crate) fn damped(input: &ResultsInput<'_>, equivalent: &EquivalentViscous) -> Vec<ModeResult> {
    let Ok(linear) = LinearMatrices::new(input.structure, input.acting) else { return Vec::new() };
    let constant: Vec<f64> = input
        .acting
        .iter()
        .zip(&equivalent.overall)
        .map(|(s, c)| if is_hysteretic(s.effect) || !s.effect.dissipates() { 0.0 } else { *c })
        .collect();
    let c = weighted_sum(input.structure, input.acting, &constant);
    let matrices = SystemMatrices { mass: linear.mass, stiffness: linear.stiffness };
    let Ok(modes) = modes_of(&matrices, &c, input) else { return Vec::new() };
    let half_power = half_power_ratios(input, &modes);
    let ends = modes.iter().zip(half_power);
    ends.map(|(mode, half)| result(input, mode, half)).collect()
}

/// All modes; of a structure of more than [`ALL`] DOFs those of the band of the runs, in the space of the undamped modes up to
/// [`BAND`] times as high: those above change them as little as their stiffness is larger.
fn modes_of(
    matrices: &SystemMatrices,
    c: &Mat<f64>,
    input: &ResultsInput<'_>,
) -> Result<Vec<DampedMode>, StructureError> {
    let highest = input.runs.iter().map(|(m, _)| m.omega).fold(0.0, f64::max);
    if c.nrows() > ALL
        && let Some(lowest) = LowestModes::new(matrices, BAND * highest, LEAST)?
    {
        let mut modes = damped_modes_from(&lowest.modes, c.as_ref())?;
        modes.retain(|mode| mode.lambda.norm() <= 1.2 * highest);
        return Ok(modes);
    }
    let undamped = modes(matrices)?;
    damped_modes_from(&undamped, c.as_ref())
}

fn is_hysteretic(effect: Effect) -> bool {
    effect.adds_to(Constant::Hysteretic)
}

fn result(input: &ResultsInput<'_>, mode: &DampedMode, half_power_ratio: Option<f64>) -> ModeResult {
    let omega = mode.lambda.norm();
    let mut damping_ratio = mode.damping_ratio;
    if omega > 0.0 {
        for source in input.acting.iter().filter(|s| is_hysteretic(s.effect)) {
            damping_ratio += slope(input.structure, mode, source) * source.coefficient();
        }
    }
    let slopes: Vec<f64> = input.columns.iter().map(|s| slope(input.structure, mode, s)).collect();
    let variance: f64 = (0..slopes.len())
        .map(|i| {
            (0..slopes.len()).map(|j| slopes[i] * finite(input.covariance[(i, j)], i == j) * slopes[j]).sum::<f64>()
        })
        .sum();
    ModeResult {
        frequency_hz: mode.frequency_hz,
        damping_ratio,
        damping_ratio_deviation: variance.max(0.0).sqrt(),
        half_power_ratio,
        shape: mode.shape.clone(),
    }
}

/// An undetermined coefficient leaves the ratio undetermined; other entries of the covariance are then zero.
fn finite(value: f64, diagonal: bool) -> f64 {
    if value.is_finite() || diagonal { value } else { 0.0 }
}

/// `d zeta / d c_j` of a source's coefficient, by its equivalent dashpot at the mode's frequency.
fn slope(structure: &Structure, mode: &DampedMode, source: &Source) -> f64 {
    let omega = mode.lambda.norm();
    if omega == 0.0 {
        return 0.0;
    }
    let form = match source.effect.kind() {
        Kind::Relative(_) => source
            .place
            .legs()
            .into_iter()
            .map(|leg| {
                let d = leg.relative(|dof| mode.shape[dof]);
                d * d
            })
            .sum::<c64>(),
        Kind::Whole(_) => {
            unit_matrix(structure, source).map_or(c64::new(0.0, 0.0), |b| mode.quadratic_form(b.as_ref()))
        }
        Kind::Channel(_) => return 0.0,
    };
    let viscous = match source.effect.constant() {
        Some(Constant::Viscous) => 1.0,
        Some(Constant::Hysteretic) => 1.0 / omega,
        // Amplitude decides for the others: the ratio between coefficient and equivalent dashpot is not one number.
        Some(Constant::Mass | Constant::Stiffness) | None => 0.0,
    };
    mode.sensitivity(form).damping_ratio * viscous
}

/// Half-power ratio of each mode within the band of the runs, from the receptance at the DOF that moves most.
fn half_power_ratios(input: &ResultsInput<'_>, modes: &[DampedMode]) -> Vec<Option<f64>> {
    let highest = input.runs.iter().map(|(m, _)| m.omega).fold(0.0, f64::max);
    let ratio = |mode: &DampedMode| {
        let omega = mode.lambda.norm();
        if omega == 0.0 || mode.is_overdamped() || omega > 1.2 * highest {
            return None;
        }
        let dof = (0..mode.shape.len()).max_by(|&a, &b| mode.shape[a].norm().total_cmp(&mode.shape[b].norm()))?;
        let width = 4.0 * mode.damping_ratio.max(1e-9);
        let grid: Vec<f64> = (0..POINTS)
            .map(|i| omega * (1.0 + width * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0)))
            .filter(|w| *w > 0.0)
            .collect();
        let receptance: Result<Vec<c64>, _> =
            grid.iter().map(|&w| frequency_response::modal(modes, dof, dof, w)).collect();
        frequency_response::half_power(&grid, &receptance.ok()?).map(|h: HalfPower| h.damping_ratio())
    };
    modes.iter().map(ratio).collect()
}

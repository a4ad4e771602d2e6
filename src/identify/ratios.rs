//! Measured damping ratios with the modes of the model that they belong to.

use super::error::IdentifyError;
use crate::effects::{Constant, Effect, Source};
use crate::measurement::MeasuredRatio;
use crate::response::linear_matrices::LinearMatrices;
use crate::structure::damped_modes::{DampedMode, damped_modes_from};
use crate::structure::modes::{Modes, modes};
use crate::structure::{Structure, SystemMatrices};
use std::f64::consts::TAU;

/// Relative distance of frequencies within which a ratio belongs to a mode.
const SAME_MODE: f64 = 0.05;

/// The ratios and the undamped modes that they belong to.
pub(crate) struct Ratios {
    pub list: Vec<MeasuredRatio>,
    modes: Modes,
    /// Undamped mode of each ratio.
    place: Vec<usize>,
}

impl Ratios {
    /// Pairs ratios with modes of the model, known stiffnesses and masses in it.
    pub(super) fn new(
        structure: &Structure,
        sources: [&[Source]; 2],
        ratios: &[MeasuredRatio],
    ) -> Result<Option<Self>, IdentifyError> {
        if ratios.is_empty() {
            return Ok(None);
        }
        let [known, columns] = sources;
        let other = |s: &&Source| s.effect.dissipates() && !is_constant(s.effect);
        if let Some(source) = known.iter().chain(columns).find(other) {
            return Err(IdentifyError::RatioOfAmplitude { source_name: source.phrase(structure) });
        }
        let linear = LinearMatrices::new(structure, known).map_err(|_| IdentifyError::RatioWithoutModel)?;
        let matrices = SystemMatrices { mass: linear.mass, stiffness: linear.stiffness };
        let modes = modes(&matrices).map_err(|_| IdentifyError::RatioWithoutModel)?;
        let place: Result<Vec<usize>, IdentifyError> = ratios.iter().map(|ratio| place(&modes, ratio)).collect();
        Ok(Some(Self { list: ratios.to_vec(), place: place?, modes }))
    }

    /// Number of ratios.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// The damped mode of each ratio at the sources that act.
    pub(super) fn damped(&self, structure: &Structure, acting: &[Source]) -> Option<Vec<DampedMode>> {
        let constant: Vec<Source> = acting.iter().filter(|s| !is_hysteretic(s.effect)).cloned().collect();
        let linear = LinearMatrices::new(structure, &constant).ok()?;
        let all = damped_modes_from(&self.modes, linear.viscous.as_ref()).ok()?;
        let nearest = |omega: f64| {
            let distance = |m: &&DampedMode| (m.lambda.norm() - omega).abs();
            let oscillating = all.iter().filter(|m| m.lambda.im > 0.0);
            oscillating.min_by(|a, b| distance(a).total_cmp(&distance(b))).cloned()
        };
        self.place.iter().map(|&r| nearest(self.modes.omega[r])).collect()
    }
}

/// The mode that a ratio belongs to.
fn place(modes: &Modes, ratio: &MeasuredRatio) -> Result<usize, IdentifyError> {
    let hz = ratio.omega / TAU;
    if !(ratio.ratio > 0.0 && ratio.ratio < 1.0 && ratio.deviation >= 0.0 && ratio.deviation.is_finite()) {
        return Err(IdentifyError::RatioValue { frequency_hz: hz, ratio: ratio.ratio });
    }
    let found = modes.nearest(ratio.omega).filter(|&r| (modes.omega[r] - ratio.omega).abs() < SAME_MODE * ratio.omega);
    found.ok_or(IdentifyError::RatioOfNoMode { frequency_hz: hz })
}

/// Whether a law's damping is the same at every amplitude.
fn is_constant(effect: Effect) -> bool {
    effect.adds_to(Constant::Viscous) || is_hysteretic(effect)
}

pub(super) fn is_hysteretic(effect: Effect) -> bool {
    effect.adds_to(Constant::Hysteretic)
}

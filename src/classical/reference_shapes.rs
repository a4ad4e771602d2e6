//! Modes and operating shapes that another program found, beside those found here.
//!
//! Two shapes are compared by the modal assurance criterion at the DOFs that the other program gives,
//! `MAC = |a^H b|^2 / (a^H a b^H b)`, which no scale changes (Allemang and Brown, 1st IMAC, 1982).

use super::data::ModalData;
use crate::structure::modes::Modes;
use faer::c64;

/// Modes whose frequencies differ by more than this share are not the same.
const NEAR: f64 = 0.3;

/// What a shape is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeKind {
    /// A normal mode: its shape is real.
    Normal,
    /// A complex mode.
    Complex,
    /// The motion at one frequency of a response.
    Operating,
}

impl ShapeKind {
    /// Word for tables and JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Normal => "normal mode",
            Self::Complex => "complex mode",
            Self::Operating => "operating shape",
        }
    }
}

/// A shape of another program.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceShape {
    /// File and name in it.
    pub name: String,
    /// What it is.
    pub kind: ShapeKind,
    /// Hz.
    pub frequency_hz: f64,
    /// Damping ratio, where the file says it.
    pub damping_ratio: Option<f64>,
    /// DOFs and the motion there, in any scale.
    pub at: Vec<(usize, c64)>,
}

/// A mode found here that is the same as one of another program.
#[derive(Debug, Clone, PartialEq)]
pub struct Match {
    /// Its number, from 0.
    pub mode: usize,
    /// Hz.
    pub frequency_hz: f64,
    /// Damping ratio; none of an undamped mode.
    pub damping_ratio: Option<f64>,
    /// Modal assurance criterion at the DOFs of the other program.
    pub mac: f64,
    /// The motion at those DOFs, in the scale of the other shape.
    pub at: Vec<c64>,
}

/// A shape of another program and what is the same here.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// The shape.
    pub reference: ReferenceShape,
    /// The complex mode as measured.
    pub measured: Option<Match>,
    /// The undamped mode of the model.
    pub model: Option<Match>,
}

/// Every shape of another program beside the complex modes as measured and the undamped modes of the model.
pub(crate) fn beside(references: &[ReferenceShape], measured: Option<&ModalData>, model: &Modes) -> Vec<Beside> {
    let best_match = |reference: &ReferenceShape| {
        let complex = |modal: &ModalData, p: usize| {
            let hz = modal.poles[p].norm() / std::f64::consts::TAU;
            compared(reference, p, hz, Some(modal.damping_ratio(p)), |i| modal.shapes[(i, p)])
        };
        let undamped =
            |p: usize| compared(reference, p, model.frequency_hz(p), None, |i| c64::new(model.shapes[(i, p)], 0.0));
        let measured = measured.and_then(|modal| best(reference, (0..modal.len()).map(|p| complex(modal, p))));
        let modes = (0..model.shapes.ncols()).map(undamped);
        Beside { reference: reference.clone(), measured, model: best(reference, modes) }
    };
    references.iter().map(best_match).collect()
}

/// The mode of the likest shape among those near in frequency; where shapes tell nothing apart, the nearest.
fn best(reference: &ReferenceShape, modes: impl Iterator<Item = Match>) -> Option<Match> {
    let away = |mode: &Match| (mode.frequency_hz / reference.frequency_hz).ln().abs();
    let worth = |mode: &Match| mode.mac - away(mode);
    modes.filter(|mode| away(mode) < NEAR).max_by(|a, b| worth(a).total_cmp(&worth(b)))
}

fn compared(
    reference: &ReferenceShape,
    mode: usize,
    frequency_hz: f64,
    damping_ratio: Option<f64>,
    shape: impl Fn(usize) -> c64,
) -> Match {
    let ours: Vec<c64> = reference.at.iter().map(|&(dof, _)| shape(dof)).collect();
    let theirs = || reference.at.iter().map(|(_, value)| *value);
    let across: c64 = ours.iter().zip(theirs()).map(|(a, b)| a.conj() * b).sum();
    let own: f64 = ours.iter().map(c64::norm_sqr).sum();
    let other: f64 = theirs().map(|value| value.norm_sqr()).sum();
    let mac = if own > 0.0 && other > 0.0 { across.norm_sqr() / (own * other) } else { 0.0 };
    let scale = if own > 0.0 { across / own } else { c64::new(0.0, 0.0) };
    Match { mode, frequency_hz, damping_ratio, mac, at: ours.into_iter().map(|value| value * scale).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::models;
    use crate::structure::damped_modes::damped_modes_from;
    use faer::Mat;

    /// Complex modes of a chain with one dashpot, and its undamped ones.
    fn chain() -> (ModalData, Modes) {
        let model = models::chain(&[1.0, 2.0, 1.5], &[4e4, 0.0, 0.0], &[5e4, 3e4]).modes().expect("modes");
        let c = Mat::from_fn(3, 3, |i, j| if (i, j) == (2, 2) { 8.0 } else { 0.0 });
        let modes = damped_modes_from(&model, c.as_ref()).expect("modes");
        (ModalData::from_modes(&modes, 3), model)
    }

    #[test]
    fn a_mode_of_any_scale_and_phase_is_known_again() {
        let (modal, model) = chain();
        for p in 0..3 {
            let turned = c64::new(-3.0, 7.0);
            let reference = ReferenceShape {
                name: format!("mode {p}"),
                kind: ShapeKind::Complex,
                frequency_hz: 1.01 * modal.poles[p].norm() / std::f64::consts::TAU,
                damping_ratio: Some(0.01),
                at: (0..3).map(|i| (i, turned * modal.shapes[(i, p)])).collect(),
            };
            let found = &beside(std::slice::from_ref(&reference), Some(&modal), &model)[0];
            let measured = found.measured.as_ref().expect("the mode itself");
            assert_eq!(measured.mode, p);
            assert!((measured.mac - 1.0).abs() < 1e-12, "{}", measured.mac);
            let off = measured.at.iter().zip(&reference.at).map(|(a, (_, b))| (a - b).norm()).fold(0.0, f64::max);
            assert!(off < 1e-12, "{off}");
            let undamped = found.model.as_ref().expect("the undamped mode");
            assert!(undamped.mode == p && undamped.mac > 0.97 && undamped.mac < 1.0, "{undamped:?}");
        }
    }

    #[test]
    fn at_one_dof_the_nearest_mode_is_taken_and_far_ones_never() {
        let (modal, model) = chain();
        let hz = |p: usize| modal.poles[p].norm() / std::f64::consts::TAU;
        let shape = |frequency_hz| ReferenceShape {
            name: "line".to_owned(),
            kind: ShapeKind::Operating,
            frequency_hz,
            damping_ratio: None,
            at: vec![(0, c64::new(0.0, 2.0))],
        };
        let found = beside(&[shape(1.02 * hz(1)), shape(0.2 * hz(0))], Some(&modal), &model);
        assert_eq!(found[0].measured.as_ref().map(|found| found.mode), Some(1));
        assert_eq!((&found[1].measured, &found[1].model), (&None, &None));
    }
}

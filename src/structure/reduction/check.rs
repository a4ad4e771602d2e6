//! The modes of the whole model in the band against those of the reduced one.

use super::mode_check::ModeCheck;
use super::request::Wanted;
use crate::structure::error::StructureError;
use crate::structure::matrices::SystemMatrices;
use crate::structure::modes::{Modes, mac_real, modes};
use std::f64::consts::TAU;

/// Compares with the modes of the whole model in the band, mode by mode in ascending order; `kept` are the rows of the whole model that are the first of the reduced one.
pub(super) fn check(
    full: &Modes,
    reduced: &SystemMatrices,
    kept: &[usize],
    wanted: Wanted,
) -> Result<Vec<ModeCheck>, StructureError> {
    let own = modes(reduced)?;
    let count = full.omega.iter().filter(|&&omega| omega <= TAU * wanted.band_hz).count().min(own.len());
    Ok((0..count)
        .map(|r| {
            let (full_hz, reduced_hz) = (full.frequency_hz(r), own.frequency_hz(r));
            ModeCheck { full_hz, reduced_hz, mac: likeness(full, &own, kept, r) }
        })
        .collect())
}

fn likeness(full: &Modes, own: &Modes, kept: &[usize], r: usize) -> f64 {
    let whole: Vec<f64> = kept.iter().map(|&i| full.shapes[(i, r)]).collect();
    let part: Vec<f64> = (0..kept.len()).map(|i| own.shapes[(i, r)]).collect();
    mac_real(&whole, &part)
}

//! Modes of neighbouring bands: each band is fitted again with the modes of all others taken off, with their conjugates,
//! until nothing moves.
//!
//! ```text
//! H - sum_{other} (R / (i w - lambda) + conjugate pole) - sum_{own} R* / (i w - lambda*) = sum_{own} R / (i w - lambda) + P + Q (w - w0)
//! ```
//!
//! The straight line of a single band does not follow the tail of a close neighbour; once that is taken off only modes outside
//! of all lines are left to it. Without noise the true modes are where this ends.

use super::error::ClassicalError;
use super::extracted_mode::ExtractedMode;
use super::refine::{Band, refine};
use crate::control::Control;

/// Most rounds over all bands.
const ROUNDS: usize = 40;
/// Part of a decay rate ...
const SETTLED: f64 = 1e-9;
/// ... or of a pole's standard deviation below which its moves do not count.
const WITHIN_NOISE: f64 = 0.01;

/// A band and its modes.
pub(super) struct FittedBand {
    pub band: Band,
    pub modes: Vec<ExtractedMode>,
}

/// All modes, ascending.
pub(super) fn settled(mut bands: Vec<FittedBand>, control: &Control) -> Result<Vec<ExtractedMode>, ClassicalError> {
    without_doubles(&mut bands);
    for _ in 0..ROUNDS {
        let mut moving = false;
        for k in 0..bands.len() {
            control.check()?;
            moving |= fit_again(&mut bands, k)?;
        }
        if !moving {
            break;
        }
    }
    without_doubles(&mut bands);
    let mut modes: Vec<ExtractedMode> = bands.into_iter().flat_map(|s| s.modes).collect();
    modes.sort_by(|a, b| a.pole.norm().total_cmp(&b.pole.norm()));
    Ok(modes)
}

/// One mode that two bands found belongs to the first; growing and overdamped ones to none.
fn without_doubles(bands: &mut [FittedBand]) {
    let mut seen: Vec<faer::c64> = Vec::new();
    for fitted in bands {
        fitted.modes.retain(|mode| {
            let alike = |pole: &faer::c64| (mode.pole - pole).norm() < mode.pole.re.abs().min(pole.re.abs());
            let keep = mode.pole.re < 0.0 && mode.pole.im > 0.0 && !seen.iter().any(alike);
            seen.extend(keep.then_some(mode.pole));
            keep
        });
    }
}

/// Whether a mode of band `k` moved.
fn fit_again(bands: &mut [FittedBand], k: usize) -> Result<bool, ClassicalError> {
    let (before, rest) = bands.split_at_mut(k);
    let Some((own, after)) = rest.split_first_mut() else { return Ok(false) };
    if own.modes.is_empty() {
        return Ok(false);
    }
    let others: Vec<&ExtractedMode> = before.iter().chain(after.iter()).flat_map(|s| &s.modes).collect();
    own.band.take_off(&others, &own.modes);
    let start: Vec<faer::c64> = own.modes.iter().map(|mode| mode.pole).collect();
    let modes = refine(&own.band, &start)?;
    let sound = modes.iter().all(|mode| mode.pole.re < 0.0 && mode.pole.im > 0.0);
    if !sound {
        return Ok(false);
    }
    let moved = |(new, old): (&ExtractedMode, &ExtractedMode)| {
        (new.pole - old.pole).norm() > (SETTLED * new.pole.re.abs()).max(WITHIN_NOISE * new.deviation)
    };
    let moving = modes.iter().zip(&own.modes).any(moved);
    own.modes = modes;
    Ok(moving)
}

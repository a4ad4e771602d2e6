//! Faults of measuring channels that are looked for before any law: a reversed sensor, two cables exchanged, a wrong unit.
//!
//! They are told from the *shape* of the motion, which neither a missing law nor a model that is a little out of tune can
//! forge. Near a resonance both change the modal amplitudes first, so that those of the modes nearby are left free:
//!
//! ```text
//! X_r,c = X_model,c + sum over modes j near w_r of phi_c,j b_r,j,       b_r,j complex, free
//! ```
//!
//! `X` displacement amplitudes of the fundamental (m, rad), `r` runs, `c` response channels. `b` is fitted to all channels of a
//! run by least absolute deviations, so that a channel that is wrong hardly bends it. The error of a channel in a run is
//! `|X - X_fit| / max(|X|, |X_fit|)`, 2 where the sign is wrong. A fault is named where it brings the error of its channels in
//! all frequencies down to a fraction. Beside that, a factor that all motions have in common against the force (`common`): no
//! shape shows it; and sensors and forces at other DOFs than are said (`places`).

mod cells;
mod common;
pub(crate) mod fault;
mod in_time;
mod lines;
pub(crate) mod mending;
mod places;
mod search;

pub use fault::{ChannelFault, Fault};
pub(crate) use in_time::find_in_time;
pub(crate) use search::{find, place_of_force};

use crate::diagnosis::residual::data::{ChannelData, Data};
use std::f64::consts::FRAC_1_SQRT_2;

/// The data with the faults mended: what a channel reads divided by its factor, what two exchanged channels read exchanged.
pub(crate) fn mended(data: &Data, faults: &[ChannelFault]) -> Data {
    let mut data = data.clone();
    let unreliable = faults.iter().filter(|fault| matches!(fault.fault, Fault::Unreliable(_)));
    data.doubted.extend(unreliable.map(|fault| fault.channels[0].clone()));
    for run in &mut data.runs {
        for fault in faults {
            let is_first = |channel: &&mut ChannelData| channel.name == fault.channels[0];
            let responses = run.responses.iter_mut();
            match &fault.fault {
                Fault::Factor(factor) => responses.filter(is_first).for_each(|channel| divide(channel, *factor)),
                Fault::Common(factor) => responses
                    .chain(&mut run.forces)
                    .filter(|channel| fault.channels.contains(&channel.name))
                    .for_each(|channel| divide(channel, *factor)),
                // Of runs that are not steady alone.
                Fault::Late(_) => {}
                Fault::Unreliable(scatter) => responses.filter(is_first).for_each(|channel| widen(channel, *scatter)),
                Fault::Elsewhere(dof) => responses
                    .chain(&mut run.forces)
                    .filter(is_first)
                    .for_each(|channel| (channel.dof, channel.name) = (*dof, fault.channels[1].clone())),
                Fault::Exchanged => {
                    let position = |name: &String| run.responses.iter().position(|channel| channel.name == *name);
                    if let (Some(a), Some(b)) = (position(&fault.channels[0]), position(&fault.channels[1])) {
                        exchange(&mut run.responses, a, b);
                    }
                }
            }
        }
    }
    data
}

fn divide(channel: &mut ChannelData, factor: f64) {
    channel.measured.iter_mut().for_each(|value| *value /= factor);
    channel.deviation.iter_mut().for_each(|deviation| *deviation /= factor.abs());
}

/// Adds a relative deviation (root mean square of the complex error) to what a channel reads; deviations are of one real part.
fn widen(channel: &mut ChannelData, scatter: f64) {
    let pairs = channel.deviation.iter_mut().zip(&channel.measured);
    pairs.for_each(|(deviation, value)| *deviation = deviation.hypot(FRAC_1_SQRT_2 * scatter * value.norm()));
}

/// Exchanges what two channels read; their names and DOFs stay.
fn exchange(channels: &mut [ChannelData], a: usize, b: usize) {
    let (first, second) = (channels[a].clone(), channels[b].clone());
    channels[a] = ChannelData { measured: second.measured, deviation: second.deviation, ..first.clone() };
    channels[b] = ChannelData { measured: first.measured, deviation: first.deviation, ..second };
}

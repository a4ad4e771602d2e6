//! The model's forces against the measured ones, record by record and by part of time.

use super::fit::predicted;
use crate::balance::loops::{ComponentError, LoopRecord, Loops};
use crate::diagnosis::records::compare::{OneRecord, RecordComparison, RecordPart};
use crate::effects::Source;
use crate::math::statistics::root_mean_square;

/// Parts of time.
const PARTS: usize = 8;

/// Compares the known sources of a component, with `effects` added, with its loops. The model of a record is its force, N, on
/// the samples that were compared.
///
/// # Errors
/// [`ComponentError::NoTimeDomain`] for laws without a force in time.
pub fn compare_component(loops: &Loops, effects: &[Source]) -> Result<RecordComparison, ComponentError> {
    let compare_loop = |l: &LoopRecord| -> Result<OneRecord, ComponentError> {
        let mut model = predicted(loops, l, effects)?;
        // The zero of the force cell is not known.
        let mean = l.force.iter().zip(&model).map(|(f, m)| f - m).sum::<f64>() / model.len() as f64;
        model.iter_mut().for_each(|m| *m += mean);
        Ok(compared(l, model, noise_left(loops, l, effects)?))
    };
    let records: Vec<OneRecord> = loops.list.iter().map(compare_loop).collect::<Result<_, _>>()?;
    let over = |value: &dyn Fn(&OneRecord) -> f64| root_mean_square(&records.iter().map(value).collect::<Vec<f64>>());
    Ok(RecordComparison { error: over(&|r| r.error), noise_floor: over(&|r| r.noise_floor), records })
}

/// What noise leaves of the force of a record beside the right law, N: that of the force cell, and that of the displacement through the
/// law, `F(d + e) - F(d)` for a draw of it, whatever the law remembers.
fn noise_left(loops: &Loops, one: &LoopRecord, effects: &[Source]) -> Result<f64, ComponentError> {
    let [still, moved] = [predicted(loops, one, effects)?, predicted(loops, &one.jittered(), effects)?];
    let apart: Vec<f64> = still.iter().zip(&moved).map(|(a, b)| b - a).collect();
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    let by_motion = root_mean_square(&apart.iter().map(|e| e - mean).collect::<Vec<f64>>());
    Ok(one.noise.hypot(by_motion))
}

/// What noise leaves over the size of the force, root mean square over the records.
pub(super) fn noise_floor(loops: &Loops, effects: &[Source]) -> Result<f64, ComponentError> {
    let noise_share = |one: &LoopRecord| Ok::<f64, ComponentError>(noise_left(loops, one, effects)? / one.size());
    Ok(root_mean_square(&loops.list.iter().map(noise_share).collect::<Result<Vec<f64>, _>>()?))
}

fn compared(one: &LoopRecord, model: Vec<f64>, noise: f64) -> OneRecord {
    let left: Vec<f64> = one.force.iter().zip(&model).map(|(f, m)| f - m).collect();
    let (error, floor) = (root_mean_square(&left) / one.size(), noise / one.size());
    let length = left.len() / PARTS;
    let part = |k: usize| {
        let range = k * length..(k + 1) * length;
        let size = root_mean_square(&one.force[range.clone()]);
        let time_at_sample = |n: usize| one.first_s + n as f64 * one.step;
        RecordPart {
            range: [time_at_sample(range.start), time_at_sample(range.end)],
            size: size / one.size(),
            error: root_mean_square(&left[range]) / size.max(f64::MIN_POSITIVE),
        }
    };
    OneRecord {
        index: one.index,
        time: (0..one.force.len()).map(|n| one.first_s + n as f64 * one.step).collect(),
        measured: vec![one.force.clone()],
        error,
        noise_floor: floor,
        channels: vec![(one.channel.clone(), [error, floor])],
        times: if length < 4 { Vec::new() } else { (0..PARTS).map(part).collect() },
        bands: Vec::new(),
        model: vec![model],
        curves: Vec::new(),
    }
}

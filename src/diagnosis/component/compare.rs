//! The model's forces against the measured ones, record by record and by part of time.

use super::fit::predicted;
use crate::balance::loops::{ComponentError, Loop, Loops};
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
    let one = |l: &Loop| -> Result<OneRecord, ComponentError> {
        let mut model = predicted(loops, l, effects)?;
        // The zero of the force cell is not known.
        let mean = l.force.iter().zip(&model).map(|(f, m)| f - m).sum::<f64>() / model.len() as f64;
        model.iter_mut().for_each(|m| *m += mean);
        Ok(compared(l, model))
    };
    let records: Vec<OneRecord> = loops.list.iter().map(one).collect::<Result<_, _>>()?;
    let over = |of: &dyn Fn(&OneRecord) -> f64| root_mean_square(&records.iter().map(of).collect::<Vec<f64>>());
    Ok(RecordComparison { error: over(&|r| r.error), noise_floor: over(&|r| r.noise_floor), records })
}

fn compared(one: &Loop, model: Vec<f64>) -> OneRecord {
    let left: Vec<f64> = one.force.iter().zip(&model).map(|(f, m)| f - m).collect();
    let (error, floor) = (root_mean_square(&left) / one.size(), one.noise / one.size());
    let length = left.len() / PARTS;
    let part = |k: usize| {
        let range = k * length..(k + 1) * length;
        let size = root_mean_square(&one.force[range.clone()]);
        let at = |n: usize| one.first_s + n as f64 * one.step;
        RecordPart {
            range: [at(range.start), at(range.end)],
            size: size / one.size(),
            error: root_mean_square(&left[range]) / size.max(f64::MIN_POSITIVE),
        }
    };
    OneRecord {
        index: one.index,
        error,
        noise_floor: floor,
        channels: vec![(one.channel.clone(), [error, floor])],
        times: if length < 4 { Vec::new() } else { (0..PARTS).map(part).collect() },
        bands: Vec::new(),
        model: vec![model],
        curves: Vec::new(),
    }
}

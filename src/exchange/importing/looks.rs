//! Of what kind a record is by its looks, and which part of it.

use crate::measurement::{Kind, Quantity, Record, TimeSpan, fit, frequency, proposal, steady_part};

/// Share of its largest size that a motion without a force keeps to the end where it is no decay.
const KEPT: f64 = 0.7;
/// Harmonics by which the steady part of a record is found.
const HARMONICS: usize = 3;

/// What a record of the project looks like.
pub(super) struct Looks {
    pub kind: Kind,
    pub part: TimeSpan,
    pub reason: String,
}

/// What a record looks like, and why.
pub(super) fn look(record: &Record) -> Looks {
    let proposal::Proposal { kind, mut part, mut reason } = proposal::propose(record);
    let forced = record.channels().iter().any(|channel| channel.quantity == Quantity::Force);
    if kind == Kind::Transient || kind == Kind::Decay && (forced || !keeps(record)) {
        return Looks { kind, part, reason };
    }
    if kind == Kind::Decay {
        // Blocks shorter than a period rise and fall with it.
        (part, reason) =
            (TimeSpan::default(), "no force is measured, and the motion keeps its size to the end".to_owned());
    }
    let found = frequency::estimate(record, HARMONICS);
    match found.and_then(|found| fit(record, found.omega, HARMONICS)) {
        Ok(fit) => {
            if let Some(steady) = steady_part(record, &fit) {
                part = steady;
                reason = format!("{reason}; what is run up or down is left out");
            }
            Looks { kind: Kind::Steady, part, reason }
        }
        Err(error) => {
            Looks { kind: Kind::Transient, part: TimeSpan::default(), reason: format!("it is not steady: {error}") }
        }
    }
}

/// Whether every channel is nearly as large in the last eighth of a record as at its largest, by root mean squares about the mean.
fn keeps(record: &Record) -> bool {
    let size = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
    };
    (0..record.channels().len()).all(|c| {
        let parts: Vec<f64> = record.samples(c).chunks(record.len().div_ceil(8)).map(size).collect();
        let most = parts.iter().copied().fold(0.0, f64::max);
        parts.last().is_none_or(|last| *last >= KEPT * most)
    })
}

//! Runs with the faults of their channels mended: what a later search is made on.

use super::fault::{ChannelFault, Fault};
use crate::measurement::{Channel, Run, TransientRun};
use crate::structure::Structure;
use std::sync::Arc;

/// What becomes of one channel.
struct Mended {
    /// As it is called now.
    channel: Channel,
    /// By how much what it reads is divided.
    factor: f64,
}

/// A channel after all faults, each on the names that those before it leave.
fn mended(channel: &Channel, faults: &[ChannelFault], structure: &Structure) -> Mended {
    let mut mended = Mended { channel: channel.clone(), factor: 1.0 };
    for fault in faults {
        let name = mended.channel.to_string();
        let at = fault.channels.iter().position(|own| *own == name);
        let renamed = match (fault.fault, at) {
            (Fault::Factor(factor) | Fault::Common(factor), Some(_)) => {
                mended.factor *= factor;
                None
            }
            (Fault::Exchanged, Some(k)) => fault.channels.get(1 - k.min(1)),
            (Fault::Elsewhere(_), Some(0)) => fault.channels.get(1),
            _ => None,
        };
        let label = renamed.and_then(|name| name.split_once('@')).map(|(_, label)| label);
        if let Some((label, dof)) = label.and_then(|label| Some((label, structure.dof(label)?))) {
            mended.channel = Channel { dof, label: label.to_owned(), ..mended.channel };
        }
    }
    mended
}

/// A steady run without the faults.
pub(crate) fn mended_run(run: &Run, faults: &[ChannelFault], structure: &Structure) -> Run {
    let mut run = run.clone();
    for fit in &mut run.fit.channels {
        let Mended { channel, factor } = mended(&fit.channel, faults, structure);
        fit.channel = channel;
        fit.amplitudes.iter_mut().for_each(|amplitude| *amplitude /= factor);
        fit.covariance *= faer::Scale(factor.powi(-2));
        fit.offset /= factor;
        fit.slope /= factor;
        fit.noise /= factor.abs();
    }
    run
}

/// A run that is not steady without the faults.
pub(crate) fn mended_in_time(run: &TransientRun, faults: &[ChannelFault], structure: &Structure) -> TransientRun {
    let mut record = (*run.record).clone();
    let columns = record.channels.iter_mut().zip(&mut record.samples).zip(&mut record.resolution);
    for ((own, samples), resolution) in columns {
        let Mended { channel, factor } = mended(own, faults, structure);
        *own = channel;
        samples.iter_mut().for_each(|sample| *sample /= factor);
        *resolution /= factor.abs();
    }
    run.with_record(Arc::new(record))
}

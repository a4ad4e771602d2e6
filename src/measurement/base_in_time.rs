//! Base excitation in time: the samples of a base channel as forces on the structure and accelerations relative to the base.
//!
//! ```text
//! F(t) = -M r a(t),    x''(relative) = x''(absolute) - r a(t)
//! ```
//!
//! An absolute displacement or velocity would need `a` integrated, whose offset and drift nobody knows: such channels are refused.

use super::base::Base;
use super::channel::{Channel, Quantity};
use super::record::Record;

/// The record with its base channels turned into force channels; `is_absolute` tells whether its motions show the base.
///
/// # Errors
/// A channel of absolute displacement or velocity along a base.
pub(crate) fn driven_in_time(record: &Record, bases: &[Base], is_absolute: bool) -> Result<Record, Channel> {
    let moving = |c: &usize| record.channels()[*c].quantity == Quantity::Base;
    let (base_channels, others): (Vec<usize>, Vec<usize>) = (0..record.channels().len()).partition(moving);
    let mut channels: Vec<Channel> = others.iter().map(|&c| record.channels()[c].clone()).collect();
    let mut samples: Vec<Vec<f64>> = others.iter().map(|&c| record.samples(c).to_vec()).collect();
    for c in base_channels {
        let (label, acceleration) = (&record.channels()[c].label, record.samples(c));
        let Some(base) = bases.iter().find(|base| base.label == *label) else { continue };
        for (channel, list) in channels.iter().zip(&mut samples) {
            if !is_absolute || channel.quantity == Quantity::Force || !base.along.contains(&channel.dof) {
                continue;
            }
            if channel.quantity != Quantity::Acceleration {
                return Err(channel.clone());
            }
            list.iter_mut().zip(acceleration).for_each(|(y, a)| *y -= a);
        }
        for (dof, label, load) in &base.loads {
            let same = |f: &Channel| f.quantity == Quantity::Force && f.dof == *dof;
            let at = channels.iter().position(same).unwrap_or_else(|| {
                channels.push(Channel { quantity: Quantity::Force, dof: *dof, label: label.clone() });
                samples.push(vec![0.0; acceleration.len()]);
                channels.len() - 1
            });
            samples[at].iter_mut().zip(acceleration).for_each(|(f, a)| *f -= load * a);
        }
    }
    // The channels differ from each other and are as long as the record: it stays valid.
    Ok(Record::new(record.time().to_vec(), channels, samples).unwrap_or_else(|_| record.clone()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn forces_appear_and_absolute_accelerations_lose_the_base() {
        let channel = |quantity, dof, label: &str| Channel { quantity, dof, label: label.into() };
        let time: Vec<f64> = (0..8).map(|n| 0.1 * f64::from(n)).collect();
        let a: Vec<f64> = (0..8).map(|n| f64::from(n * n)).collect();
        let own: Vec<f64> = (0..8).map(|n| 3.0 - f64::from(n)).collect();
        let force: Vec<f64> = vec![5.0; 8];
        let channels = vec![
            channel(Quantity::Base, 0, "x"),
            channel(Quantity::Acceleration, 1, "2"),
            channel(Quantity::Force, 1, "2"),
        ];
        let record = Record::new(time.clone(), channels, vec![a.clone(), own.clone(), force]).unwrap();
        let loads = vec![(0, "1".to_owned(), 2.0), (1, "2".to_owned(), 3.0)];
        let base = Base { label: "x".into(), loads, along: vec![0, 1] };
        let made = driven_in_time(&record, std::slice::from_ref(&base), true).unwrap();
        assert_eq!(made.channels().len(), 3);
        for n in 0..8 {
            assert_eq!(made.samples(0)[n], own[n] - a[n]);
            assert_eq!(made.samples(1)[n], 5.0 - 3.0 * a[n]);
            assert_eq!(made.samples(2)[n], -2.0 * a[n]);
        }
        let relative = driven_in_time(&record, std::slice::from_ref(&base), false).unwrap();
        assert_eq!(relative.samples(0), &own[..]);
        let disp = vec![channel(Quantity::Base, 0, "x"), channel(Quantity::Displacement, 1, "2")];
        let record = Record::new(time, disp, vec![a, own]).unwrap();
        assert_eq!(driven_in_time(&record, &[base], true).unwrap_err().dof, 1);
    }
}

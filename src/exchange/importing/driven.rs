//! The place of a force that its file does not say, by the power that it puts in.
//!
//! ```text
//! P = mean(F v)
//! ```
//!
//! A passive structure takes energy in where it is driven: in a steady state, and from rest to the end of a record, `P >= 0` there
//! whatever its modes are. Elsewhere modes move in and against the phase of the driven point, and `P` has either sign.

use crate::exchange::mapping::{FORCE_WITHOUT_PLACE, Proposal};
use crate::measurement::{Quantity, Record};

/// Cosine between force and velocity from which on a power has a sign.
const CLEAR: f64 = 0.05;
/// Fewest records whose power has a clear sign somewhere.
const FEWEST: usize = 3;

/// Powers of the only force over the motions of one record, by the names of the channels.
pub(super) fn powers(record: &Record) -> Vec<(String, f64)> {
    let channels = record.channels();
    let forces: Vec<usize> = (0..channels.len()).filter(|&c| channels[c].quantity == Quantity::Force).collect();
    let [force] = forces[..] else { return Vec::new() };
    let motions = (0..channels.len()).filter(|&c| c != force);
    let power = |c: usize| {
        let velocity = velocity(record, c)?;
        Some((channels[c].to_string(), cosine(record.samples(force), &velocity)))
    };
    motions.filter_map(power).collect()
}

/// Puts a force whose place is assumed at the motion over which it puts power in throughout, where that is one alone.
pub(super) fn place(mapping: &mut Proposal, powers: &[Vec<(String, f64)>]) {
    let (Some(force), Some((motion, records))) = (force_without_place(mapping), driven(powers)) else { return };
    let Some(at) = mapping.channels.iter().find(|table| table.channel() == motion).map(|table| table.dof.clone())
    else {
        return;
    };
    let old = mapping.channels[force].channel();
    mapping.channels[force].dof = at;
    let new = mapping.channels[force].channel();
    for (channel, what) in mapping.assumed.iter_mut().filter(|(channel, _)| *channel == old) {
        channel.clone_from(&new);
        if what.starts_with(FORCE_WITHOUT_PLACE) {
            *what = format!(
                "the file says no DOF: of all motions that of {motion} alone takes power in from it in all of {records} records, so that \
                 it is taken to act there"
            );
        }
    }
}

/// The channel of the only force whose place is assumed.
fn force_without_place(mapping: &Proposal) -> Option<usize> {
    let assumed = |name: &String| {
        mapping.assumed.iter().any(|(channel, what)| channel == name && what.starts_with(FORCE_WITHOUT_PLACE))
    };
    let tables = mapping.channels.iter().enumerate();
    let mut forces = tables.filter(|(_, table)| table.quantity == Quantity::Force && assumed(&table.channel()));
    let (first, None) = (forces.next(), forces.next()) else { return None };
    first.map(|(i, _)| i)
}

/// The only motion over which the power is positive in all records, and the number of records with a clear one.
fn driven(powers: &[Vec<(String, f64)>]) -> Option<(&str, usize)> {
    let names = &powers.first()?[..];
    let powers_of_motion = |name: &str| -> Vec<f64> {
        powers.iter().filter_map(|record| record.iter().find(|(own, _)| own == name).map(|(_, power)| *power)).collect()
    };
    let mut takes_in = names
        .iter()
        .map(|(name, _)| (name.as_str(), powers_of_motion(name)))
        .filter(|(_, powers)| powers.iter().all(|power| *power > -CLEAR));
    let (motion, own) = takes_in.next()?;
    let clear = own.iter().filter(|power| **power > CLEAR).count();
    let alone = takes_in.next().is_none() && names.len() > 1;
    (alone && own.len() == powers.len() && clear >= FEWEST).then_some((motion, clear))
}

/// Velocity of a motion, without mean and drift; none of other quantities.
fn velocity(record: &Record, channel: usize) -> Option<Vec<f64>> {
    let (time, values) = (record.time(), record.samples(channel));
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    match record.channels()[channel].quantity {
        Quantity::Velocity => Some(values.iter().map(|v| v - mean).collect()),
        Quantity::Acceleration => Some(without_drift(time, integral(time, values, mean))),
        Quantity::Displacement => {
            let last = values.len().checked_sub(1)?;
            let slope = |i: usize| {
                let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
                (values[b] - values[a]) / (time[b] - time[a])
            };
            Some((0..values.len()).map(slope).collect())
        }
        _ => None,
    }
}

/// Integral of values less their mean by the rule of trapezia, from zero on.
fn integral(time: &[f64], values: &[f64], mean: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut found = vec![0.0];
    for i in 1..values.len() {
        sum += 0.5 * (values[i] + values[i - 1] - 2.0 * mean) * (time[i] - time[i - 1]);
        found.push(sum);
    }
    found
}

/// Values less the straight line that fits them best.
fn without_drift(time: &[f64], values: Vec<f64>) -> Vec<f64> {
    let n = values.len() as f64;
    let (t, y) = (time.iter().sum::<f64>() / n, values.iter().sum::<f64>() / n);
    let (ty, tt) = time
        .iter()
        .zip(&values)
        .fold((0.0, 0.0), |(ty, tt), (time, value)| (ty + (time - t) * (value - y), tt + (time - t).powi(2)));
    let slope = if tt > 0.0 { ty / tt } else { 0.0 };
    time.iter().zip(values).map(|(time, value)| value - y - slope * (time - t)).collect()
}

/// `sum F v` over the sizes of both, the force without its mean.
fn cosine(force: &[f64], velocity: &[f64]) -> f64 {
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    let (fv, ff, vv) = force.iter().zip(velocity).fold((0.0, 0.0, 0.0), |(fv, ff, vv), (force, v)| {
        let force = force - mean;
        (fv + force * v, ff + force * force, vv + v * v)
    });
    if ff * vv > 0.0 { fv / (ff * vv).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::Channel;

    /// Receptance at mass 2 (sign 1) or 1 (sign -1) of two masses of 1 kg with modes at 10 and sqrt(300) rad/s and a damping ratio
    /// of 2 % of both, driven at mass 2: `(1 / (100 - w^2 + i d1) +- 1 / (300 - w^2 + i d2)) / 2`.
    fn receptance(omega: f64, sign: f64) -> [f64; 2] {
        let mode = |omega0: f64| {
            let (re, im) = (omega0 * omega0 - omega * omega, 0.04 * omega0 * omega);
            [re / (re * re + im * im), -im / (re * re + im * im)]
        };
        let (a, b) = (mode(10.0), mode(300.0_f64.sqrt()));
        [0, 1].map(|i| 0.5 * (a[i] + sign * b[i]))
    }

    fn record(omega: f64, quantity: Quantity) -> Record {
        let time: Vec<f64> = (0..600).map(|i| f64::from(i) * 0.01 + 0.3).collect();
        let channel = |quantity, dof: usize| Channel { quantity, dof, label: (dof + 1).to_string() };
        let motion = |sign: f64| -> Vec<f64> {
            let h = receptance(omega, sign);
            let differentiated = if quantity == Quantity::Acceleration { -omega * omega } else { 1.0 };
            time.iter().map(|t| differentiated * (h[0] * (omega * t).cos() - h[1] * (omega * t).sin())).collect()
        };
        let force = time.iter().map(|t| (omega * t).cos() + 0.2).collect();
        let channels = vec![channel(Quantity::Force, 0), channel(quantity, 0), channel(quantity, 1)];
        Record::new(time.clone(), channels, vec![force, motion(-1.0), motion(1.0)]).unwrap()
    }

    #[test]
    fn the_driven_point_takes_power_in_at_every_frequency() {
        for quantity in [Quantity::Acceleration, Quantity::Displacement] {
            let frequencies = [9.8, 10.0, 10.3, 17.0, 17.3, 17.6];
            let all: Vec<_> = frequencies.iter().map(|omega| powers(&record(*omega, quantity))).collect();
            let word = if quantity == Quantity::Acceleration { "acc" } else { "disp" };
            assert_eq!(driven(&all), Some((format!("{word}@2").as_str(), 6)), "{all:?}");
            // One mode alone says nothing of the place.
            assert_eq!(driven(&all[..3]), None);
            for (omega, found) in frequencies.iter().zip(&all) {
                for (sign, (_, cosine)) in [-1.0, 1.0].into_iter().zip(found) {
                    // `Re(i w H) / |w H|`, but for the parts of a period at the ends of the record.
                    let [re, im] = receptance(*omega, sign);
                    let exact = -im / re.hypot(im);
                    assert!((cosine - exact).abs() < 0.02, "{omega} {sign}: {cosine} {exact}");
                }
            }
        }
    }
}

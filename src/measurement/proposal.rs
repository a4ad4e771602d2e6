//! The kind of run that a record looks like, read from the record itself.
//!
//! Root mean squares over blocks of time say where force acts and where motion is. No force while the motion dies away: a
//! decay, from where the force ends. Force that acts all the time on few lines: steady. Everything else: transient.

use super::channel::Quantity;
use super::kind::{Kind, TimeSpan};
use super::record::Record;
use crate::math::spectrum::Spectrum;
use crate::math::statistics::mean;

/// Blocks of time.
const BLOCKS: usize = 100;
/// Force, over its largest, that counts as none.
const NO_FORCE: f64 = 0.02;
/// Ratio of motion at the end to its largest below which it dies away.
const DIES: f64 = 0.5;
/// Length of a contact, over the record, below which the force is that of a hammer.
const HAMMER: f64 = 0.1;
/// Motion before a release, over its largest, that is rest; that of an even drive, of its last block and of all before it; its first
/// half over its second; blocks that it lasts at least.
const QUIET: f64 = 0.2;
const EVEN: f64 = 0.9;
const DRIVEN: f64 = 0.7;
const NO_TREND: f64 = 1.02;
const LONG: usize = 10;
/// Most samples that one spectrum is made of.
const LONGEST_PART: usize = 1 << 20;
/// Share of the power on the largest lines from which a signal is periodic.
const PERIODIC: f64 = 0.8;
/// Periods of a record below which the lines about multiples of one frequency are most of its spectrum.
const FEW_PERIODS: usize = 16;
/// Times by which a signal is shifted to find its period, and samples that are enough for it.
const LAGS: usize = 200;
const ENOUGH: usize = 8192;

/// What a record looks like.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Proposal {
    /// Kind.
    pub kind: Kind,
    /// Part to be used.
    pub part: TimeSpan,
    /// Why, in one sentence with numbers and units.
    pub reason: String,
}

/// What a record looks like.
pub(crate) fn propose(record: &Record) -> Proposal {
    let force = envelope(record, drives);
    let motion = envelope(record, |quantity| !drives(quantity));
    let most = force.iter().copied().fold(0.0, f64::max);
    let acts: Vec<usize> = (0..force.len()).filter(|&b| force[b] > NO_FORCE * most).collect();
    let time = |block: usize| record.time()[(block * record.len() / BLOCKS).min(record.len() - 1)];
    match (acts.first(), acts.last()) {
        (Some(&first), Some(&last)) if most > 0.0 && last + 2 < BLOCKS => {
            after_force(record, &motion, [first, last], time)
        }
        (Some(_), Some(_)) if most > 0.0 => driven(record, Quantity::Force),
        _ => free(record, &motion, time),
    }
}

/// Whether a quantity is what drives the structure: a force, or its base.
fn drives(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Force | Quantity::Base)
}

/// Time (s) from which on a record of a decay shows it, where it begins earlier: at rest or held still, under a force that ends,
/// or driven evenly. None where it may begin at once.
pub(super) fn release(record: &Record) -> Option<f64> {
    let force = envelope(record, drives);
    let motion = envelope(record, |quantity| !drives(quantity));
    let most = force.iter().copied().fold(0.0, f64::max);
    let driven = force.iter().rposition(|f| most > 0.0 && *f > NO_FORCE * most).map_or(0, |last| last + 1);
    let first_sample = |block: usize| block * record.len() / BLOCKS;
    let sample = first_sample(driven).max(released(record, &motion, first_sample));
    (sample > 0 && sample + first_sample(LONG) < record.len()).then(|| record.time()[sample])
}

/// Sample from which on nothing drives the motion, which was at rest or even before; 0 where neither is seen.
fn released(record: &Record, motion: &[f64], first_sample: impl Fn(usize) -> usize) -> usize {
    let largest = motion.iter().copied().fold(0.0, f64::max);
    let large = motion.iter().rposition(|m| *m > EVEN * largest).unwrap_or(0);
    let peak = motion.iter().position(|m| *m >= largest).unwrap_or(0);
    if peak > 0 && motion[..peak.div_ceil(2)].iter().all(|m| *m < QUIET * largest) {
        // A displacement is let go where it is largest; an acceleration is largest while it is struck.
        let near = first_sample(peak - 1)..first_sample((peak + 2).min(BLOCKS));
        let size = |n: usize| displacements(record).map(|y| y[n].abs()).fold(0.0, f64::max);
        let top = near.clone().max_by(|&a, &b| size(a).total_cmp(&size(b)));
        return top.filter(|&n| size(n) > 0.0).unwrap_or(near.end);
    }
    if is_even(&motion[..large], largest) { first_sample(large + 1) } else { 0 }
}

/// Whether a drive holds these blocks: none falls far below the `largest`, and they fall no more than chance has it.
fn is_even(motion: &[f64], largest: f64) -> bool {
    let steady = || mean(&motion[1..motion.len() / 2]) < NO_TREND * mean(&motion[motion.len() / 2..]);
    motion.len() >= LONG && motion[1..].iter().all(|m| *m > DRIVEN * largest) && steady()
}

fn displacements(record: &Record) -> impl Iterator<Item = &[f64]> {
    let numbers = (0..record.channels().len()).filter(|&c| record.channels()[c].quantity == Quantity::Displacement);
    numbers.map(|c| record.samples(c))
}

/// The force ends before the record does.
fn after_force(record: &Record, motion: &[f64], [first, last]: [usize; 2], time: impl Fn(usize) -> f64) -> Proposal {
    let (duration, end) = (record.duration(), time(last + 1));
    let contact = (last + 1 - first) as f64 / BLOCKS as f64;
    if contact < HAMMER {
        let reason = format!(
            "the force acts for less than {:.3} s of {duration:.3} s, from {:.3} s on, as a hammer's does",
            contact * duration,
            time(first)
        );
        return Proposal { kind: Kind::Transient, part: TimeSpan::default(), reason };
    }
    let left = motion.get(last + 1).copied().unwrap_or(0.0) / motion.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    if left > 0.1 {
        let reason = format!("the force ends at {end:.3} s and the motion dies away from there");
        return Proposal { kind: Kind::Decay, part: TimeSpan { start_s: Some(end), end_s: None }, reason };
    }
    let reason = format!("the force acts until {end:.3} s and the motion ends with it");
    Proposal { kind: Kind::Transient, part: TimeSpan::default(), reason }
}

/// No force: the motion dies away, or is driven by what was not measured.
fn free(record: &Record, motion: &[f64], time: impl Fn(usize) -> f64) -> Proposal {
    let last = motion.len().saturating_sub(3);
    let end = motion[last..].iter().sum::<f64>() / (motion.len() - last).max(1) as f64;
    // The decay begins where the motion leaves the level of its largest blocks for good.
    let most = motion.iter().copied().fold(0.0, f64::max);
    let start = (0..motion.len()).rev().find(|&b| motion[b] > 0.9 * most).unwrap_or(0);
    if most > 0.0 && end < DIES * most {
        // Within that block what drove it may still act: the next one is free.
        let start = if start <= 1 { start } else { start + 1 };
        let from = if start <= 1 { None } else { Some(time(start)) };
        let reason = format!(
            "no force is measured, and the motion falls to {:.1} % of its largest from {:.3} s on",
            100.0 * end / most,
            time(start)
        );
        return Proposal { kind: Kind::Decay, part: TimeSpan { start_s: from, end_s: None }, reason };
    }
    driven(record, Quantity::Acceleration)
}

/// Steady where few lines hold the power.
fn driven(record: &Record, quantity: Quantity) -> Proposal {
    let like = |c: &usize| drives(record.channels()[*c].quantity) == drives(quantity);
    let share = (0..record.channels().len()).filter(like).map(|c| concentration(record, c)).fold(0.0, f64::max);
    let moving_base = record.channels().iter().any(|channel| channel.quantity == Quantity::Base);
    let what = match (drives(quantity), moving_base) {
        (true, true) => "motion of the base",
        (true, false) => "force",
        _ => "motion",
    };
    let (kind, word) = if share >= PERIODIC { (Kind::Steady, "periodic") } else { (Kind::Transient, "not periodic") };
    let reason =
        format!("the {what} is {word}: {:.0} % of its power lies on one frequency and its multiples", 100.0 * share);
    Proposal { kind, part: TimeSpan::default(), reason }
}

/// Share of a channel's power within two lines of its largest line and of the multiples of that.
fn concentration(record: &Record, channel: usize) -> f64 {
    // Of a long record the mean over parts: their lines are still far narrower than those of any resonance.
    let parts = record.samples(channel).chunks_exact(record.len().min(LONGEST_PART));
    let Some(spectrum) = Spectrum::mean(parts.map(|part| Spectrum::new(part, record.step()))) else { return 0.0 };
    let power: Vec<f64> = spectrum.amplitude.iter().map(|a| a * a).collect();
    let Some(top) = (1..power.len()).max_by(|&a, &b| power[a].total_cmp(&power[b])) else { return 0.0 };
    let total: f64 = power[1..].iter().sum();
    if top < FEW_PERIODS {
        // Of that few periods one sample in many tells as much.
        let part = &record.samples(channel)[..record.len().min(LONGEST_PART)];
        let thinned: Vec<f64> = part.iter().copied().step_by(part.len().div_ceil(ENOUGH)).collect();
        return repeated(&thinned, top);
    }
    // At a multiple the frequency is known that much worse.
    let near = |k: usize| (1..=7).any(|h| (k as f64 - (h * top) as f64).abs() <= 2.0 + 0.5 * (h - 1) as f64);
    let lines: f64 = (1..power.len()).filter(|&k| near(k)).map(|k| power[k]).sum();
    if total > 0.0 { lines / total } else { 0.0 }
}

/// Share of the power of a signal of about so many periods that it repeats a period later: squared correlation of both.
fn repeated(samples: &[f64], periods: usize) -> f64 {
    let lag = |periods: f64| (samples.len() as f64 / periods).round() as usize;
    let (shortest, longest) = (lag(periods as f64 + 0.5), lag(periods as f64 - 0.5).min(samples.len() / 2));
    let step = ((longest.saturating_sub(shortest)) / LAGS).max(1);
    let correlation = |lag: usize| {
        let (earlier, later) = (&samples[..samples.len() - lag], &samples[lag..]);
        let (a, b) = (mean(earlier), mean(later));
        let sum = |x: &[f64], y: &[f64], a: f64, b: f64| x.iter().zip(y).map(|(x, y)| (x - a) * (y - b)).sum::<f64>();
        let size = (sum(earlier, earlier, a, a) * sum(later, later, b, b)).sqrt();
        if size > 0.0 { sum(earlier, later, a, b) / size } else { 0.0 }
    };
    (shortest..=longest).step_by(step).map(correlation).fold(0.0, f64::max).powi(2)
}

/// Largest root mean square over the channels of a kind in each block, each channel less its mean at the end and over its
/// largest; empty without such channels.
fn envelope(record: &Record, wanted: impl Fn(Quantity) -> bool) -> Vec<f64> {
    let mut most = Vec::new();
    for c in (0..record.channels().len()).filter(|&c| wanted(record.channels()[c].quantity)) {
        let samples = record.samples(c);
        let tail = &samples[samples.len() - (samples.len() / 20).max(1)..];
        let mean = mean(tail);
        let largest = samples.iter().fold(0.0_f64, |m, y| m.max((y - mean).abs()));
        if largest == 0.0 {
            continue;
        }
        most.resize(BLOCKS, 0.0_f64);
        for (b, value) in most.iter_mut().enumerate() {
            let block =
                b * samples.len() / BLOCKS..((b + 1) * samples.len() / BLOCKS).max(b * samples.len() / BLOCKS + 1);
            let part = &samples[block.start.min(samples.len() - 1)..block.end.min(samples.len())];
            let square = part.iter().map(|y| ((y - mean) / largest).powi(2)).sum::<f64>() / part.len().max(1) as f64;
            *value = value.max(square.sqrt());
        }
    }
    most
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::Channel;
    use std::f64::consts::TAU;

    fn record(force: Option<&dyn Fn(f64) -> f64>, motion: &dyn Fn(f64) -> f64) -> Record {
        let time: Vec<f64> = (0..4000).map(|n| 0.001 * f64::from(n)).collect();
        let signal = |y: &dyn Fn(f64) -> f64| time.iter().map(|&t| y(t)).collect::<Vec<f64>>();
        let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
        let mut channels = vec![channel(Quantity::Acceleration)];
        let mut samples = vec![signal(motion)];
        if let Some(force) = force {
            channels.push(channel(Quantity::Force));
            samples.push(signal(force));
        }
        Record::new(time, channels, samples).unwrap()
    }

    /// What shakes a structure at its foot drives it: no decay, however the motion ends.
    #[test]
    fn a_moving_base_drives() {
        let gust = |t: f64| (TAU * (3.0 + 7.0 * t) * t).sin() * (-1.5 * t).exp();
        let mut base = record(Some(&gust), &|t| 2.0 * gust(t));
        let mut channels = base.channels().to_vec();
        channels[1] = Channel { quantity: Quantity::Base, dof: 0, label: "x".into() };
        let samples = (0..2).map(|c| base.samples(c).to_vec()).collect();
        base = Record::new(base.time().to_vec(), channels, samples).unwrap();
        let proposal = propose(&base);
        assert_eq!(proposal.kind, Kind::Transient, "{}", proposal.reason);
    }

    /// A few periods of a sine repeat themselves; as many strokes of a drive, each of another length and speed, do not.
    #[test]
    fn a_few_strokes_are_no_periods() {
        let sine = |t: f64| (TAU * t).sin();
        assert_eq!(propose(&record(Some(&sine), &sine)).kind, Kind::Steady);
        let strokes = [(0.0, 0.9, 1.0), (0.9, 0.5, -1.0), (1.4, 1.2, 0.4), (2.6, 0.4, -0.7), (3.0, 1.0, 0.5)];
        let force = |t: f64| {
            let stroke = strokes.iter().find(|(from, length, _)| (0.0..*length).contains(&(t - from)));
            stroke.map_or(0.0, |(from, length, size)| size * (TAU * (t - from) / length).sin())
        };
        let proposal = propose(&record(Some(&force), &sine));
        assert_eq!(proposal.kind, Kind::Transient, "{}", proposal.reason);
    }

    #[test]
    fn records_are_what_they_look_like() {
        let sine = |t: f64| (TAU * 20.0 * t).sin();
        let decay = |t: f64| (TAU * 20.0 * t).sin() * (-1.5 * t).exp();
        let sweep = |t: f64| (TAU * (5.0 + 10.0 * t) * t).sin();
        let hit = |t: f64| if (0.5..0.51).contains(&t) { 1.0 } else { 0.0 };
        let off = |t: f64| if t < 2.0 { sine(t) } else { 0.0 };
        let rings = |t: f64| if t < 2.0 { sine(t) } else { sine(t) * (-2.0 * (t - 2.0)).exp() };
        let kind = |record: &Record| propose(record).kind;
        assert_eq!(kind(&record(Some(&sine), &sine)), Kind::Steady);
        assert_eq!(kind(&record(None, &sine)), Kind::Steady);
        assert_eq!(kind(&record(None, &decay)), Kind::Decay);
        assert_eq!(kind(&record(Some(&sweep), &sweep)), Kind::Transient);
        assert_eq!(kind(&record(Some(&hit), &decay)), Kind::Transient);
        let switched = propose(&record(Some(&off), &rings));
        assert_eq!(switched.kind, Kind::Decay);
        assert!((switched.part.start_s.unwrap() - 2.0).abs() < 0.08, "{switched:?}");
        // The exciter was not measured: steady first, then free.
        let unseen = propose(&record(None, &rings));
        assert_eq!(unseen.kind, Kind::Decay);
        assert!((unseen.part.start_s.unwrap() - 2.0).abs() < 0.08, "{unseen:?}");
    }
}

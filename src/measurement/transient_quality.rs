//! Quality of a record that is not steady: what an engineer should know before trusting it. Nothing is corrected here.

use super::channel::Quantity;
use super::contacts::{HAMMER, contacts, is_blow};
use super::finding::{Finding, Flag};
use super::kind::Kind;
use super::proposal::propose;
use super::transient_run::TransientRun;
use super::zero::zeros;
use crate::math::spectrum::Spectrum;
use std::ops::Range;

/// Root mean square at the end over the largest from which a decay is cut off.
const CUT: f64 = 0.2;
/// Share of the power above 0.4 of the sampling rate that is too much.
const OUT_OF_BAND: f64 = 0.05;
/// Equal samples at an end of the range that are no chance.
const CLIPPED: usize = 4;
/// Share of the largest sample that is cut off at least: less is a round top, or a body at rest, that a converter shows as equal samples.
const CUT_OFF: f64 = 0.005;
/// Share of the largest force by which its samples on either side of two equal ones differ at least: a round top of two equal samples has
/// equal neighbours.
const UNEVEN: f64 = 0.02;
/// Mean of an acceleration over a third of the record, over its root mean square, that makes its integral drift.
const DRIFT: f64 = 0.1;
/// Half-power bands that two modes must be apart in the resolution of the record.
const CLOSE: f64 = 2.0;

/// Everything that is wrong with the part that is used.
pub(super) fn assess(run: &TransientRun) -> Vec<Finding> {
    let mut findings = Vec::new();
    findings.extend(other_kind(run));
    findings.extend(hammer(run));
    findings.extend((0..run.channels().len()).filter_map(|c| clipped(run, c)));
    findings.extend(cut_decay(run));
    findings.extend(run.response_channels().into_iter().filter_map(|c| out_of_band(run, c)));
    findings.extend(too_short(run));
    findings.extend(run.response_channels().into_iter().filter_map(|c| drift(run, c)));
    findings.extend(zeros(run));
    findings
}

/// The whole record looks like a run of another kind.
fn other_kind(run: &TransientRun) -> Option<Finding> {
    if !run.part.is_whole() {
        return None;
    }
    let proposal = propose(&run.record);
    (proposal.kind != run.kind).then(|| {
        Finding::of_record(
            Flag::OtherKind,
            format!("it looks like kind \"{}\": {}", proposal.kind.name(), proposal.reason),
        )
    })
}

/// No quiet part before the contact; more than one contact.
fn hammer(run: &TransientRun) -> Vec<Finding> {
    let mut findings = Vec::new();
    for c in run.force_channels() {
        let contacts = contacts(run.samples(c));
        let length: usize = contacts.iter().map(|(first, last)| last - first).sum();
        if contacts.is_empty() || length as f64 > HAMMER * run.len() as f64 {
            continue;
        }
        let time = |n: usize| run.time()[n];
        let channel = &run.channels()[c];
        if contacts[0].0 < 8.max(run.len() / 500) {
            let reason = format!("{channel} acts from the start; record a quiet part before the hit (pre-trigger)");
            findings.push(Finding::of_record(Flag::NoPreTrigger, reason));
        }
        if contacts.len() > 1 {
            let reason = format!(
                "{channel} strikes {} times, at {:.4} s and {:.4} s; the energy balance holds all the same, as long as both are measured",
                contacts.len(),
                time(contacts[0].0),
                time(contacts[1].0)
            );
            findings.push(Finding::of_record(Flag::DoubleHit, reason));
        }
    }
    findings
}

/// A channel that stands at the end of its range.
fn clipped(run: &TransientRun, c: usize) -> Option<Finding> {
    let samples = run.samples(c);
    let most = samples.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    let longest = longest_stay(samples, most);
    let is_blow = run.channels()[c].quantity == Quantity::Force && longest.len() > 1 && is_blow(samples);
    let is_cut = longest.len() >= CLIPPED && cut_off(samples, &longest) > CUT_OFF * most;
    (is_cut || (is_blow && has_flat_top(samples, most))).then(|| {
        let channel = &run.channels()[c];
        let longest = longest.len();
        Finding::of_channel(
            Flag::Clipped,
            channel,
            format!("{longest} samples of {channel} in a row stand at {most:.4e} (SI units), the end of its range"),
        )
    })
}

/// The most samples in a row of size `most`.
fn longest_stay(samples: &[f64], most: f64) -> Range<usize> {
    let mut longest = 0..0;
    let mut first = 0;
    for n in 0..samples.len() {
        if samples[n].abs() != most || most == 0.0 {
            first = n + 1;
        } else if n + 1 - first > longest.len() {
            longest = first..n + 1;
        }
    }
    longest
}

/// What a parabola that enters and leaves such a row as the signal does would show above it: none of a body that comes to rest there.
fn cut_off(samples: &[f64], stay: &Range<usize>) -> f64 {
    let slope = |inside: usize, outside: Option<usize>| {
        outside.and_then(|n| samples.get(n)).map_or(f64::INFINITY, |y| (samples[inside] - y).abs() / 2.0)
    };
    let (entered, left) = (slope(stay.start, stay.start.checked_sub(2)), slope(stay.end - 1, Some(stay.end + 1)));
    let known = [entered, left].into_iter().filter(|slope| slope.is_finite());
    known.reduce(f64::max).unwrap_or(f64::INFINITY) * stay.len() as f64 / 4.0
}

/// Whether a contact of a few samples has a flat top: equal samples at `most` between neighbours that are not equal.
fn has_flat_top(force: &[f64], most: f64) -> bool {
    let at_end = |n: usize| force[n].abs() == most;
    let last = |first: usize| (first..force.len()).take_while(|&n| at_end(n)).last().unwrap_or(first);
    (1..force.len()).filter(|&n| at_end(n) && !at_end(n - 1)).any(|first| {
        let after = last(first) + 1;
        let uneven = |b: &f64| (force[first - 1] - b).abs() > UNEVEN * most;
        after > first + 1 && force.get(after).is_some_and(uneven)
    })
}

/// Root mean square over a part of a channel less its mean.
fn rms(samples: &[f64]) -> f64 {
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    (samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / samples.len().max(1) as f64).sqrt()
}

/// A decay that is not over at the end of the part, where the record goes on.
fn cut_decay(run: &TransientRun) -> Option<Finding> {
    if run.kind != Kind::Decay {
        return None;
    }
    let block = (run.len() / 20).max(8);
    let left = |c: &usize| {
        let samples = run.samples(*c);
        let most = samples.chunks(block).map(rms).fold(0.0, f64::max);
        if most > 0.0 { rms(&samples[samples.len() - block..]) / most } else { 0.0 }
    };
    let worst = run.response_channels().iter().map(left).fold(0.0, f64::max);
    let goes_on = run.range().end < run.record.len();
    (worst > CUT && goes_on).then(|| {
        let reason =
            format!("the part ends at {:.0} % of the largest motion and the record goes on; move end_s", 100.0 * worst);
        Finding::of_record(Flag::CutDecay, reason)
    })
}

fn out_of_band(run: &TransientRun, c: usize) -> Option<Finding> {
    let spectrum = Spectrum::new(run.samples(c), run.step())?;
    let limit = 0.4 / run.step();
    let power = |k: usize| spectrum.amplitude[k].powi(2);
    let total: f64 = (1..spectrum.amplitude.len()).map(power).sum();
    let above: f64 = (1..spectrum.amplitude.len()).filter(|&k| spectrum.frequency_hz(k) > limit).map(power).sum();
    (total > 0.0 && above > OUT_OF_BAND * total).then(|| {
        let channel = &run.channels()[c];
        let reason = format!(
            "{:.0} % of the power of {channel} lies above {limit:.4} Hz, where filters and sensors are no longer true; sample faster",
            100.0 * above / total,
        );
        Finding::of_channel(Flag::OutOfBand, channel, reason)
    })
}

/// Two peaks nearer than the record can resolve stand out as one broad one; told from the two largest peaks of a channel. Only of a
/// motion that is free for most of the record: under noise or a multisine neighbouring lines differ as those of the force do.
fn too_short(run: &TransientRun) -> Option<Finding> {
    let driven = run.channels().iter().any(|channel| channel.quantity == Quantity::Base);
    if driven || !run.force_channels().into_iter().all(|c| is_blow(run.samples(c))) {
        return None;
    }
    let c = *run.response_channels().first()?;
    let spectrum = Spectrum::new(run.samples(c), run.step())?;
    let a = &spectrum.amplitude;
    let mut peaks: Vec<usize> =
        (2..a.len().saturating_sub(2)).filter(|&k| a[k] > a[k - 1] && a[k] >= a[k + 1]).collect();
    peaks.sort_by(|&x, &y| a[y].total_cmp(&a[x]));
    let [first, second] = [*peaks.first()?, *peaks.get(1)?];
    let apart = first.abs_diff(second) as f64;
    (a[second] > 0.3 * a[first] && apart <= 2.0 * CLOSE).then(|| {
        let reason = format!(
            "two modes at {:.4} Hz and {:.4} Hz are only {apart:.0} lines apart; {:.1} s or more tell them apart",
            spectrum.frequency_hz(first),
            spectrum.frequency_hz(second),
            run.len() as f64 * run.step() * 4.0 * CLOSE / apart
        );
        Finding::of_record(Flag::TooShort, reason)
    })
}

/// An acceleration whose mean wanders.
fn drift(run: &TransientRun, c: usize) -> Option<Finding> {
    let channel = &run.channels()[c];
    if channel.quantity != Quantity::Acceleration {
        return None;
    }
    let samples = run.samples(c);
    let (size, third) = (rms(samples), samples.len() / 3);
    let means: Vec<f64> =
        samples.chunks_exact(third.max(1)).map(|part| part.iter().sum::<f64>() / part.len() as f64).collect();
    let spread = means.iter().fold(f64::MIN, |m, x| m.max(*x)) - means.iter().fold(f64::MAX, |m, x| m.min(*x));
    (size > 0.0 && spread > DRIFT * size).then(|| {
        let reason = format!(
            "the mean of {channel} wanders by {:.0} % of its root mean square; its integrals drift and are kept above the lowest mode only",
            100.0 * spread / size
        );
        Finding::of_channel(Flag::Drift, channel, reason)
    })
}

#[cfg(test)]
mod tests {
    use super::{CUT_OFF, cut_off, longest_stay};
    use std::f64::consts::TAU;

    /// Share of its largest sample that a signal of 400 samples looks cut off by.
    fn lost(signal: impl Fn(f64) -> f64) -> f64 {
        let samples: Vec<f64> = (0..400).map(|n| signal(f64::from(n) / 400.0)).collect();
        let most = samples.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        cut_off(&samples, &longest_stay(&samples, most)) / most
    }

    /// A sine cut at nine tenths looks cut by about a tenth; the round top of a coarse converter, or a body that comes to rest, by nothing.
    #[test]
    fn what_is_cut_off_is_told_from_what_comes_to_rest() {
        let sine = |t: f64| (TAU * 2.0 * t).sin();
        let cut = lost(|t| sine(t).clamp(-0.9, 0.9));
        assert!((0.05..0.2).contains(&cut), "{cut}");
        assert!(lost(|t| (sine(t) * 1000.0).round() / 1000.0) < CUT_OFF);
        let stroke = |t: f64| (2.0 * t).min(1.0);
        assert!(lost(|t| stroke(t).powi(3) * (10.0 - 15.0 * stroke(t) + 6.0 * stroke(t).powi(2))) < CUT_OFF);
    }
}

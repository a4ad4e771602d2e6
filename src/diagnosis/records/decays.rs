//! Decays of the model that begin louder and quieter than its record, so that its amplitude curve covers what was measured.
//!
//! A model that is off loses more or less of its amplitude over the time of a record than the structure did: its own record tells
//! its damping over a part of the measured amplitudes, or beside them. Damping over amplitude is a property of the model, whatever
//! state it begins with: records of the same length from multiples of the initial state tell the rest, by the same estimator.

use super::amplitude::AmplitudePoint;

/// Most decays beside the model's record.
const MOST: usize = 8;
/// Share of its amplitude above which a decay that ends there is slow.
const SLOW: f64 = 0.5;
/// Ratio of amplitudes below which there is nothing between them.
const NEAR: f64 = 1.05;

/// Signals of further decays of the model, from the loudest on: `louder` gives one from so many times the initial state, `read` the
/// amplitudes of a mode in it, whose curve is `measured` in the record and `model` in that of the model.
pub(super) fn decays(
    [measured, model]: [&[AmplitudePoint]; 2],
    louder: &dyn Fn(f64) -> Option<Vec<f64>>,
    read: &dyn Fn(&[f64]) -> Vec<AmplitudePoint>,
) -> Vec<Vec<f64>> {
    let (Some([least, most]), Some([low, high])) = (ends(measured), ends(model)) else { return Vec::new() };
    let widest = (most / least).powf(1.0 / MOST as f64);
    let mut found = Vec::new();
    let mut begin = most;
    while found.len() < MOST && begin > NEAR * least {
        // What the model's own record tells is known.
        if begin <= NEAR * high && begin > low {
            begin = low;
            continue;
        }
        let Some(decay) = louder(begin / high) else { break };
        let reached = ends(&read(&decay)).map_or(begin, |[reached, _]| reached);
        found.push(decay);
        begin = reached.min(begin / widest);
    }
    found
}

/// The points of a decay of the model that tell its damping: of a slow one those of the inner half, for what a record that begins and
/// ends abruptly adds to its first and last windows may be more than that damping.
pub(super) fn telling(points: Vec<AmplitudePoint>) -> Vec<AmplitudePoint> {
    let quarter = points.len() / 4;
    match ends(&points) {
        Some([least, most]) if least > SLOW * most => points[quarter..points.len() - quarter].to_vec(),
        _ => points,
    }
}

/// Least and largest amplitude of a curve; none where it has no points.
fn ends(points: &[AmplitudePoint]) -> Option<[f64; 2]> {
    let widened = |ends: [f64; 2], p: &AmplitudePoint| [ends[0].min(p.amplitude), ends[1].max(p.amplitude)];
    let [least, most] = points.iter().fold([f64::INFINITY, 0.0], widened);
    (least > 0.0 && most > 0.0).then_some([least, most])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An envelope as a signal: its samples are its amplitudes.
    fn read(envelope: &[f64]) -> Vec<AmplitudePoint> {
        let point = |amplitude: &f64| AmplitudePoint {
            time_s: 0.0,
            amplitude: *amplitude,
            frequency_hz: 1.0,
            damping_ratio: 0.01,
            amplitude_deviation: 0.0,
            frequency_deviation_hz: 0.0,
            damping_deviation: 0.0,
        };
        envelope.iter().map(point).collect()
    }

    #[test]
    fn the_ends_of_a_slow_decay_tell_nothing() {
        let told = |envelope: &[f64]| telling(read(envelope)).iter().map(|p| p.amplitude).collect::<Vec<f64>>();
        assert_eq!(told(&[2.0, 1.9, 1.8, 1.7, 1.6, 1.5, 1.4, 1.3]), [1.8, 1.7, 1.6, 1.5]);
        assert_eq!(told(&[2.0, 1.0, 0.5, 0.2]), [2.0, 1.0, 0.5, 0.2]);
        assert_eq!(told(&[2.0]), [2.0]);
        assert!(told(&[]).is_empty());
    }

    /// A model that loses a fifth over a record, of a structure that loses all but a hundredth.
    #[test]
    fn decays_of_the_model_lie_over_all_measured_amplitudes() {
        let own = [1.5, 1.35, 1.2];
        let louder = |factor: f64| Some(own.map(|a| a * factor).to_vec());
        let compared_decays = |measured: &[f64], model: &[f64]| decays([&read(measured), &read(model)], &louder, &read);
        let found = compared_decays(&[3.0, 0.3, 0.03], &own);
        assert!(found.len() <= MOST && (found[0][0] - 3.0).abs() < 1e-12, "{found:?}");
        assert!(found.last().is_some_and(|last| last[2] < 0.06), "{found:?}");
        assert!(found.windows(2).all(|pair| pair[1][0] < pair[0][0]));
        // None lies within what the record tells.
        assert!(found.iter().all(|decay| decay[0] > 1.05 * 1.5 || decay[0] <= 1.2), "{found:?}");
        // A record that covers all amplitudes is enough, and one without a curve says nothing.
        assert!(compared_decays(&[3.0, 0.3], &[3.0, 0.3]).is_empty());
        assert!(compared_decays(&[3.0, 0.3], &[]).is_empty());
        assert!(decays([&read(&[3.0, 0.03]), &read(&own)], &|_| None, &read).is_empty());
    }
}

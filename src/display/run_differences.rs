//! How runs differ from each other beside a model and what was found, in sentences: what is left of an answer that is no noise and
//! nothing that is missing.

use super::findings::{RunSpread, spread_of_runs};
use super::format::{percent, with_unit};
use crate::diagnosis::updating::scatter::Scatter;

/// Share of the variance of the frequencies that a straight line over the runs must explain to be told as a drift.
const DRIFT: f64 = 0.8;
/// Fewest runs that show one.
const FEWEST: usize = 5;
/// Root mean square phase from which on it is looked into, rad, and the share of its square that a high-pass may leave.
const LEAST_PHASE: f64 = 0.01;
const MOST_LEFT: f64 = 0.1;
/// Ratio of the highest to the lowest frequency from which on a high-pass is told from a constant phase.
const LEAST_RATIO: f64 = 1.5;

/// What is told of the runs; `hz` is the frequency of a run of the project.
pub fn sentences(scatter: &Scatter, hz: &dyn Fn(usize) -> Option<f64>) -> Vec<String> {
    let frequencies = spread_of_runs(scatter).map(|spread| of_frequencies(scatter, &spread));
    frequencies.into_iter().chain(high_pass(scatter, hz)).collect()
}

/// The spread of the frequencies, and whether they drift.
fn of_frequencies(scatter: &Scatter, spread: &RunSpread) -> String {
    let sign = if spread.most > 0.0 { "+" } else { "" };
    let mut said = format!(
        "natural frequencies differ by {} from run to run, in run {} by {sign}{}",
        percent(spread.shift),
        spread.run + 1,
        percent(spread.most)
    );
    if let Some(change) = drift(scatter) {
        let way = if change > 0.0 { "rise" } else { "fall" };
        said.push_str(&format!(
            "; they {way} by {} from the first run to the last: temperature?",
            percent(change.abs())
        ));
    }
    said
}

/// Change of the frequencies from the first run to the last, where they drift.
fn drift(scatter: &Scatter) -> Option<f64> {
    let n = scatter.runs.len();
    if n < FEWEST {
        return None;
    }
    let mean = |value: &dyn Fn(usize) -> f64| (0..n).map(value).sum::<f64>() / n as f64;
    let (place, shift) = (|k: usize| scatter.runs[k].run as f64, |k: usize| scatter.runs[k].frequency.value);
    let (middle, usual) = (mean(&place), mean(&shift));
    let product = mean(&|k| (place(k) - middle) * (shift(k) - usual));
    let (width, variance) = (mean(&|k| (place(k) - middle).powi(2)), mean(&|k| (shift(k) - usual).powi(2)));
    let slope = product / width;
    (slope * product > DRIFT * variance).then(|| slope * (place(n - 1) - place(0)))
}

/// A phase that all motions have in common and that goes with the inverse of the frequency, beside a delay that was corrected.
fn high_pass(scatter: &Scatter, hz: &dyn Fn(usize) -> Option<f64>) -> Option<String> {
    let points: Vec<[f64; 2]> =
        scatter.runs.iter().filter_map(|run| Some([hz(run.run)?, run.phase.value])).filter(|p| p[0] > 0.0).collect();
    let (low, high) = points.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p[0]), h.max(p[0])));
    if points.len() < FEWEST || high < LEAST_RATIO * low {
        return None;
    }
    // phase = corner / f + slope f, by least squares.
    let sum = |value: &dyn Fn(f64, f64) -> f64| points.iter().map(|&[f, phase]| value(f, phase)).sum::<f64>();
    let (a, b, c) = (sum(&|f, _| f.powi(-2)), points.len() as f64, sum(&|f, _| f * f));
    let (p, q, whole) = (sum(&|f, y| y / f), sum(&|f, y| y * f), sum(&|_, y| y * y));
    let determinant = a * c - b * b;
    let (corner, slope) = ((p * c - q * b) / determinant, (a * q - b * p) / determinant);
    let left = sum(&|f, y| (y - corner / f - slope * f).powi(2));
    let matters = whole > LEAST_PHASE.powi(2) * b && corner.abs() / low > LEAST_PHASE;
    (determinant > 0.0 && matters && left < MOST_LEFT * whole).then(|| {
        let (leads, who) = if corner > 0.0 { ("lead", "sensors") } else { ("lag behind", "force") };
        format!(
            "all motions {leads} the force by {:.1} degrees at {}, and the less the higher the frequency, as behind a high-pass (AC \
             coupling) of {} of the {who}: set it to DC, or correct the records for it",
            (corner.abs() / low).to_degrees(),
            with_unit(low, "Hz"),
            with_unit(corner.abs(), "Hz")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::updating::scatter::{Estimated, RunScatter};

    fn runs(count: usize, shift: impl Fn(usize) -> f64, phase: impl Fn(usize) -> f64) -> Scatter {
        let exact = |value: f64| Estimated { value, deviation: 1e-4 };
        let run = |run: usize| RunScatter {
            run,
            frequency: exact(shift(run)),
            amplitude: exact(0.0),
            phase: exact(phase(run)),
        };
        Scatter { channels: Vec::new(), runs: (0..count).map(run).collect() }
    }

    #[test]
    fn a_drift_is_told_from_scatter() {
        let none = |_: usize| None;
        let warm = sentences(&runs(11, |r| 3e-3 - 6e-4 * r as f64, |_| 0.0), &none);
        assert!(warm[0].contains("they fall by 0.6") && warm[0].ends_with("temperature?"), "{warm:?}");
        let seated = sentences(&runs(12, |r| if r % 2 == 0 { 2e-3 } else { -2e-3 }, |_| 0.0), &none);
        assert!(seated.len() == 1 && !seated[0].contains("temperature"), "{seated:?}");
        assert_eq!(sentences(&runs(12, |_| 0.0, |_| 0.0), &none), Vec::<String>::new());
    }

    #[test]
    fn a_high_pass_is_told_by_its_phase() {
        let hz = |r: usize| Some(2.0 + r as f64);
        let told = sentences(&runs(8, |_| 0.0, |r| 0.5 / (2.0 + r as f64) - 0.01 * r as f64), &hz);
        assert!(
            told.len() == 1 && told[0].contains("all motions lead") && told[0].contains("(AC coupling)"),
            "{told:?}"
        );
        let turned = sentences(&runs(8, |_| 0.0, |r| if r % 3 == 0 { 0.1 } else { -0.05 }), &hz);
        assert_eq!(turned, Vec::<String>::new());
    }
}

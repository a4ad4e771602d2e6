//! How runs differ from each other beside a model and what was found, in sentences: what is left of an answer that is no noise and
//! nothing that is missing.

use super::findings::{RunSpread, spread_of_runs};
use super::format::percent;
use crate::diagnosis::updating::scatter::Scatter;

/// Share of the variance of the frequencies that a straight line over the runs must explain to be told as a drift.
const DRIFT: f64 = 0.8;
/// Fewest runs that show one.
const FEWEST: usize = 5;

/// What is told of the runs.
pub fn sentences(scatter: &Scatter) -> Vec<String> {
    spread_of_runs(scatter).map(|spread| of_frequencies(scatter, &spread)).into_iter().collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::updating::scatter::{Estimated, RunScatter};

    fn runs(count: usize, shift: impl Fn(usize) -> f64) -> Scatter {
        let exact = |value: f64| Estimated { value, deviation: 1e-4 };
        let run =
            |run: usize| RunScatter { run, frequency: exact(shift(run)), amplitude: exact(0.0), phase: exact(0.0) };
        Scatter { channels: Vec::new(), runs: (0..count).map(run).collect() }
    }

    #[test]
    fn a_drift_is_told_from_scatter() {
        let warm = sentences(&runs(11, |r| 3e-3 - 6e-4 * r as f64));
        assert!(warm[0].contains("they fall by 0.6") && warm[0].ends_with("temperature?"), "{warm:?}");
        let seated = sentences(&runs(12, |r| if r % 2 == 0 { 2e-3 } else { -2e-3 }));
        assert!(seated.len() == 1 && !seated[0].contains("temperature"), "{seated:?}");
        assert_eq!(sentences(&runs(12, |_| 0.0)), Vec::<String>::new());
    }
}

//! Lines of an axis and what stands beside them; the same on the screen and in a file.

use super::figure::{Axis, Scale, Ticks};
use super::grid::{GridInput, GridMark, round_step};
use super::log;

/// A line of the grid: its place, its label (may be empty), and whether it stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Place along the axis.
    pub at: f64,
    /// What stands beside it.
    pub label: String,
    /// Whether it stands out.
    pub strong: bool,
}

/// Points that a label takes along the axis of x.
pub const ACROSS: f64 = 64.0;
/// Points that a label takes along the axis of y.
pub const UPWARDS: f64 = 36.0;

/// Grid lines for the plot on the screen, labels `room` points apart.
pub fn marks(axis: &Axis, input: &GridInput, room: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    match (&axis.ticks, axis.scale) {
        (Ticks::Auto, Scale::Log) => log::lines(input, room),
        (Ticks::OneTwoFive, Scale::Log) => log::one_two_five(input, room),
        (Ticks::Whole | Ticks::Names(_), _) => {
            let step = (3.0 * input.base_step_size).ceil().max(((high - low) / 24.0).ceil()).max(1.0);
            multiples(low, high, step).map(|value| GridMark { value, step_size: step }).collect()
        }
        (Ticks::RightAngles, _) if multiples(low, high, 90.0).nth(1).is_some() => {
            multiples(low, high, 90.0).map(|value| GridMark { value, step_size: 90.0 }).collect()
        }
        _ => {
            // The least step of the plot stands for eight points on the screen.
            let parts = (8.0 / room * (high - low) / input.base_step_size).clamp(3.0, 9.0);
            let step = round_step((high - low).max(f64::MIN_POSITIVE), parts);
            multiples(low, high, step).map(|value| GridMark { value, step_size: step }).collect()
        }
    }
}

fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(-1.0, 400.0) as i64;
    (0..=count).map(move |k| (first + k as f64) * step)
}

/// What stands beside a line.
pub fn label(axis: &Axis, mark: GridMark) -> String {
    match (&axis.ticks, axis.scale) {
        (Ticks::Auto | Ticks::OneTwoFive, Scale::Log) => log::label(mark),
        (Ticks::Names(names), _) => {
            let k = mark.value.round();
            let whole = (mark.value - k).abs() < 1e-6 && k >= 0.0;
            if whole { names.get(k as usize).cloned().unwrap_or_default() } else { String::new() }
        }
        _ => tick(mark.value, mark.step_size),
    }
}

/// Lines between two places for a drawing of `length` points.
pub fn rules(axis: &Axis, [low, high]: [f64; 2], length: f32) -> Vec<Rule> {
    let parts = (length / 80.0).clamp(2.0, 9.0);
    let marks = match (&axis.ticks, axis.scale) {
        (Ticks::Auto | Ticks::OneTwoFive, Scale::Linear) => {
            let step = round_step(high - low, f64::from(parts));
            multiples(low, high, step).map(|value| GridMark { value, step_size: step }).collect()
        }
        _ => marks(
            axis,
            &GridInput { bounds: (low, high), base_step_size: 8.0 * (high - low) / f64::from(length) },
            ACROSS,
        ),
    };
    let log = axis.scale == Scale::Log;
    marks
        .into_iter()
        .map(|mark| Rule { at: mark.value, label: label(axis, mark), strong: !log || mark.step_size >= 1.0 })
        .collect()
}

/// A number at a grid line, with as many digits as the step asks for.
pub fn tick(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    let text = if (1e-3..1e5).contains(&value.abs()) {
        let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{value:.decimals$}")
    } else {
        let digits = (value.abs().log10().floor() - step.log10().floor()).clamp(0.0, 4.0) as usize;
        format!("{value:.digits$e}")
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::{round_step, rules, tick};
    use crate::plots::figure::{Axis, Ticks};

    #[test]
    fn lines_are_round_numbers_with_labels() {
        let r = rules(&Axis::new("t", "s"), [0.03, 1.02], 500.0);
        let at: Vec<f64> = r.iter().map(|r| (r.at * 100.0).round() / 100.0).collect();
        assert_eq!(at, [0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(r[0].label, "0.2");
    }

    #[test]
    fn decades_stand_out_on_a_logarithmic_axis() {
        let r = rules(&Axis::log("H", "m/N"), [-3.2, -0.9], 300.0);
        let strong: Vec<&str> = r.iter().filter(|r| r.strong).map(|r| r.label.as_str()).collect();
        assert_eq!(strong, ["0.001", "0.01", "0.1"]);
        assert!(r.len() > 15, "the lines between are there");
    }

    #[test]
    fn names_stand_at_whole_numbers() {
        let axis = Axis::new("DOF", "").ticks(Ticks::Names(["1z", "2z"].map(str::to_owned).to_vec().into()));
        let labels: Vec<String> = rules(&axis, [-0.5, 1.5], 200.0).into_iter().map(|r| r.label).collect();
        assert_eq!(labels, ["1z", "2z"]);
    }

    #[test]
    fn ticks_show_what_their_step_asks_for() {
        assert_eq!(tick(0.25, 0.05), "0.25");
        assert_eq!(tick(-20.0, 10.0), "−20");
        assert_eq!(tick(1e-17, 0.1), "0");
        assert_eq!(tick(2.5e-6, 5e-7), "2.5e−6");
        assert_eq!(tick(120_000.0, 20_000.0), "1.2e5");
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([round_step(10.0, 5.0), round_step(0.9, 4.0), round_step(7300.0, 5.0)], [2.0, 0.2, 1000.0]);
    }
}

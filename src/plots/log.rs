//! Logarithmic axes: the plot holds log10 of the value, the grid shows decades and the lines between.

use super::grid::{GridInput, GridMark, round_step};
use crate::display::format::significant;

/// Step of a line without a label: below it none is written.
const UNLABELLED: f64 = 0.15;

/// Lines at 1, 2, ..., 9 of each decade; decades stand out, and where they are closer than labels `room` points apart can be,
/// every second, third, fifth or tenth of them only.
pub(crate) fn decades(input: &GridInput, room: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let (first, last) = (low.floor() as i32, high.ceil() as i32);
    if last - first > 60 {
        return Vec::new();
    }
    let minor = if last - first <= 4 { 9 } else { 1 };
    // The least step of the plot stands for eight points on the screen.
    let decade = 8.0 / input.base_step_size;
    let every = [1, 2, 3, 5].into_iter().find(|&n| f64::from(n) * decade >= 0.6 * room).unwrap_or(10);
    (first..=last)
        .flat_map(|d| (1..=minor).map(move |m| (d, m)))
        .map(|(d, m)| GridMark {
            value: f64::from(d) + f64::from(m).log10(),
            step_size: if m == 1 && d.rem_euclid(every) == 0 { f64::from(every) } else { UNLABELLED },
        })
        .filter(|mark| mark.value >= low && mark.value <= high)
        .collect()
}

/// Lines for labels `room` points apart: decades where at least two of them have one, else as [`one_two_five`].
pub(crate) fn lines(input: &GridInput, room: f64) -> Vec<GridMark> {
    let marks = decades(input, room);
    if marks.iter().filter(|m| m.step_size >= 1.0).count() > 1 { marks } else { one_two_five(input, room) }
}

/// Longest step of a line at a round number of a short range: less than that of a line without a label.
const ROUND: f64 = 0.14;

/// Decades and the lines between; where fewer than two of 1, 2 and 5 are in sight, lines at round numbers.
pub(crate) fn one_two_five(input: &GridInput, room: f64) -> Vec<GridMark> {
    let mut marks = decades(input, room);
    let (low, high) = input.bounds;
    if high - low > 2.0 || marks.iter().filter(|m| leads(m.value)).count() > 1 {
        // Lines with a label stand out from those between.
        for mark in marks.iter_mut().filter(|m| m.step_size < 1.0 && leads(m.value) && !is_decade(m.value)) {
            mark.step_size = 0.4;
        }
        return marks;
    }
    let ends = [low, high].map(|v| 10f64.powf(v));
    let step = round_step((ends[1] - ends[0]).max(f64::MIN_POSITIVE), 3.0);
    let first = (ends[0] / step).ceil() as i64;
    // A label needs room for its step.
    let step_size = (0.25 * (high - low)).min(ROUND);
    (first..first + 8)
        .map(|k| GridMark { value: (k as f64 * step).log10(), step_size })
        .filter(|mark| mark.value <= high)
        .collect()
}

/// Whether a place stands for 1, 2 or 5 times a power of ten.
fn leads(value: f64) -> bool {
    let lead = 10f64.powf(value - value.floor());
    [1.0, 2.0, 5.0, 10.0].iter().any(|m| (lead - m).abs() < 1e-6)
}

fn is_decade(value: f64) -> bool {
    (value - value.round()).abs() < 1e-9
}

/// Label of a line: decades as `0.01`, `1`, `100`, `1e−6`, others in as many figures as they have; nothing at the lines between.
pub(crate) fn label(mark: GridMark) -> String {
    if mark.step_size == UNLABELLED {
        return String::new();
    }
    if is_decade(mark.value) {
        return decade(mark.value.round() as i32);
    }
    let plain = 10f64.powf(mark.value);
    let text = significant(plain, if plain < 1.0 { 3 } else { 4 });
    let (digits, exponent) = text.find('e').map_or((text.as_str(), ""), |at| text.split_at(at));
    if digits.contains('.') {
        format!("{}{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
    } else {
        text
    }
}

fn decade(exponent: i32) -> String {
    match exponent {
        -3..=-1 => format!("{:.*}", -exponent as usize, 10f64.powi(exponent)),
        0..=4 => format!("{:.0}", 10f64.powi(exponent)),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}

#[cfg(test)]
mod tests {
    use super::{decades, label, lines, one_two_five};
    use crate::plots::grid::GridInput;
    use crate::plots::ticks::UPWARDS;

    fn labels(low: f64, high: f64, points: f64) -> Vec<String> {
        let input = GridInput { bounds: (low, high), base_step_size: 8.0 * (high - low) / points };
        decades(&input, UPWARDS).into_iter().map(label).filter(|l| !l.is_empty()).collect()
    }

    #[test]
    fn decades_are_labelled_and_the_lines_between_are_not() {
        assert_eq!(labels(-2.0, 0.5, 300.0), ["0.01", "0.1", "1"]);
        assert_eq!(labels(2.9, 4.1, 300.0), ["1000", "10000"]);
        let marks = decades(&GridInput { bounds: (-1.0, 1.0), base_step_size: 0.1 }, UPWARDS);
        assert_eq!(marks.iter().filter(|m| m.step_size >= 1.0).count(), 3);
        assert!(marks.iter().any(|m| (m.value - 2f64.log10()).abs() < 1e-12));
    }

    #[test]
    fn where_decades_are_close_some_of_them_are_labelled() {
        assert_eq!(labels(-7.2, 6.8, 180.0), ["1e−6", "1e−4", "0.01", "1", "100", "10000", "1e6"]);
        assert_eq!(labels(-9.5, 20.0, 180.0), ["1e−5", "1", "1e5", "1e10", "1e15", "1e20"]);
    }

    #[test]
    fn a_short_range_has_round_numbers_and_a_long_one_has_1_2_and_5() {
        let labels = |low: f64, high: f64| -> Vec<String> {
            let input = GridInput { bounds: (low.log10(), high.log10()), base_step_size: 0.01 };
            one_two_five(&input, UPWARDS).into_iter().map(label).filter(|l| !l.is_empty()).collect()
        };
        assert_eq!(labels(0.9, 11.0), ["1", "2", "5", "10"]);
        assert_eq!(labels(0.03, 0.11), ["0.05", "0.1"]);
        assert_eq!(labels(6.1, 8.9), ["7", "8"]);
        assert_eq!(labels(0.9e-4, 3e-4), ["1e−4", "2e−4"]);
    }
    #[test]
    fn a_range_within_a_decade_has_numbers() {
        let labels = |low: f64, high: f64, points: f64| -> Vec<String> {
            let input = GridInput { bounds: (low, high), base_step_size: 8.0 * (high - low) / points };
            lines(&input, UPWARDS).into_iter().map(label).filter(|l| !l.is_empty()).collect()
        };
        assert_eq!(labels(2.1, 2.55, 90.0), ["200", "300"]);
        assert_eq!(labels(-0.2, 0.9, 90.0), ["1", "2", "5"]);
        assert_eq!(labels(-2.0, 0.5, 300.0), ["0.01", "0.1", "1"]);
        // A label is written where its step has thirteen points.
        let marks = lines(&GridInput { bounds: (0.72, 0.98), base_step_size: 8.0 * 0.26 / 80.0 }, UPWARDS);
        assert!(marks.len() > 1 && marks.iter().all(|m| m.step_size * 80.0 / 0.26 > 13.0));
    }
}

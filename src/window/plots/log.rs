//! Logarithmic axes: the plot holds log10 of the value, the grid shows decades and the lines between.

use egui_plot::{GridInput, GridMark};

/// Lines at 1, 2, ..., 9 of each decade; decades stand out.
pub fn decades(input: &GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let (first, last) = (low.floor() as i32, high.ceil() as i32);
    if last - first > 60 {
        return Vec::new();
    }
    let minor = if last - first <= 4 { 9 } else { 1 };
    (first..=last)
        .flat_map(|d| (1..=minor).map(move |m| (d, m)))
        .map(|(d, m)| GridMark {
            value: f64::from(d) + f64::from(m).log10(),
            step_size: if m == 1 { 1.0 } else { 0.15 },
        })
        .filter(|mark| mark.value >= low && mark.value <= high)
        .collect()
}

/// Label of a decade: `0.01`, `1`, `100`, `1e−6`; nothing at the lines between.
pub fn label(value: f64) -> String {
    let nearest = value.round();
    if (value - nearest).abs() > 1e-6 {
        return String::new();
    }
    let exponent = nearest as i32;
    match exponent {
        -3..=-1 => format!("{:.*}", -exponent as usize, 10f64.powi(exponent)),
        0..=4 => format!("{:.0}", 10f64.powi(exponent)),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}

/// Label on an axis of frequency: decades, and 2 and 5 between them.
pub fn frequency(value: f64) -> String {
    let plain = 10f64.powf(value);
    let lead = plain / 10f64.powf(value.floor());
    let shown = [1.0, 2.0, 5.0, 10.0].iter().any(|m| (lead - m).abs() < 1e-6);
    if shown {
        super::super::format::significant(plain, if plain < 1.0 { 1 } else { 4 })
            .trim_end_matches(".000")
            .trim_end_matches(".00")
            .trim_end_matches(".0")
            .to_owned()
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{decades, label};
    use egui_plot::GridInput;

    #[test]
    fn decades_are_labelled_and_the_lines_between_are_not() {
        assert_eq!(label(-2.0), "0.01");
        assert_eq!(label(3.0), "1000");
        assert_eq!(label(-7.0), "1e−7");
        assert_eq!(label(0.301), "");
        let marks = decades(&GridInput { bounds: (-1.0, 1.0), base_step_size: 0.1 });
        assert_eq!(marks.iter().filter(|m| m.step_size == 1.0).count(), 3);
        assert!(marks.iter().any(|m| (m.value - 2f64.log10()).abs() < 1e-12));
    }
}

//! The fingerprint of a suggestion as a plot: the runs with their deviations, the fitted power, the powers of simple laws.

use crate::explain::prints::{Against, Measure, Print, PrintPoint};
use crate::window::format;
use crate::window::plots::{axis, curve, frame, log, tick, upright};
use crate::window::theme::{Palette, size};
use crate::window::widgets::UiExt;
use egui::{Align2, Ui};
use egui_plot::{AxisHints, LineStyle, MarkerShape, PlotPoint, PlotPoints, PlotUi, Points, Text};

/// Title of the plot and what the slope says, in one line each.
pub fn words(print: &Print) -> (String, String) {
    let what = match print.measure {
        Measure::Damping => "Equivalent damping",
        Measure::Stiffness => "Equivalent stiffness",
        Measure::Phase => "Phase, measured minus model",
        Measure::Ratio => "Measured over model",
    };
    let against = if print.against == Against::Amplitude { "amplitude" } else { "frequency" };
    let slope = print.slope.map_or_else(String::new, |[value, deviation]| match print.measure {
        Measure::Damping | Measure::Stiffness => format!("power {}", format::with_deviation(value, deviation, "")),
        Measure::Phase => {
            // A delay t turns the phase by -360 t degrees a hertz.
            let micro = [-value, deviation].map(|v| v / 360.0 * 1e6);
            format!("delay {}", format::with_deviation(micro[0], micro[1], "µs"))
        }
        Measure::Ratio => format!("mean {}", format::with_deviation(value, deviation, "")),
    });
    (format!("{what} against {against}"), slope)
}

/// Shows the plot `height` points high.
pub fn show(ui: &mut Ui, print: &Print, height: f32) {
    let palette = ui.palette();
    let powers = matches!(print.measure, Measure::Damping | Measure::Stiffness);
    let (title, slope) = words(print);
    ui.horizontal(|ui| {
        ui.hint(title);
        ui.label(egui::RichText::new(slope).size(size::SMALL).color(palette.missing).strong());
    });
    let at = print.at_frequency.map_or_else(String::new, |f| format!(" at {}", format::with_unit(f, "Hz")));
    let y_label = match print.measure {
        Measure::Damping => format!("N·s/m{at}"),
        Measure::Stiffness => format!("N/m{at}"),
        Measure::Phase => "Phase, °".to_owned(),
        Measure::Ratio => "Ratio".to_owned(),
    };
    let x_label = if print.against == Against::Amplitude { "Amplitude at the place, m" } else { "Frequency, Hz" };
    let place = move |x: f64, y: f64| if powers { [x.log10(), y.log10()] } else { [x, y] };
    let y_axis = upright(palette, &y_label)
        .min_thickness(52.0)
        .formatter(move |mark, _| if powers { log::frequency(mark.value) } else { tick(mark.value, mark.step_size) });
    let x_axis = axis(AxisHints::new_x(), palette, x_label)
        .min_thickness(32.0)
        .formatter(move |mark, _| if powers { log::frequency(mark.value) } else { tick(mark.value, mark.step_size) });
    let mut plot = frame(ui, "fingerprint", x_label, "")
        .custom_x_axes(vec![x_axis])
        .custom_y_axes(vec![y_axis])
        .set_margin_fraction(egui::vec2(0.05, 0.12))
        .height(height);
    if powers {
        plot = plot.x_grid_spacer(|input| log::decades(&input)).y_grid_spacer(|input| log::decades(&input));
    } else if print.measure == Measure::Phase {
        plot = plot.include_x(0.0).include_y(0.0);
    } else {
        plot = plot.include_y(1.0);
    }
    plot.show(ui, |plot| {
        if powers {
            laws(plot, palette, print);
        }
        trend(plot, palette, print, powers);
        for p in &print.points {
            let low = if powers { (p.y - p.deviation).max(0.05 * p.y) } else { p.y - p.deviation };
            let bar = vec![place(p.x, low), place(p.x, p.y + p.deviation)];
            plot.line(curve("deviation", bar, palette.measured, 1.2));
        }
        let points: Vec<[f64; 2]> = print.points.iter().map(|p| place(p.x, p.y)).collect();
        let points = Points::new("runs", PlotPoints::from(points)).shape(MarkerShape::Circle);
        plot.points(points.radius(3.0).color(palette.measured).allow_hover(false));
    });
}

/// Middle of the cloud in logarithms, and the ends of its abscissa.
fn cloud(points: &[PrintPoint]) -> ([f64; 2], [f64; 2]) {
    let n = points.len().max(1) as f64;
    let mean = |f: fn(&PrintPoint) -> f64| points.iter().map(|p| f(p).log10()).sum::<f64>() / n;
    let x = points.iter().map(|p| p.x.log10());
    let ends = x.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
    ([mean(|p| p.x), mean(|p| p.y)], ends)
}

/// Faint lines with the powers of simple laws through the middle of the cloud, no further up and down than it reaches.
fn laws(plot: &mut PlotUi<'_>, palette: &Palette, print: &Print) {
    let ([x, y], ends) = cloud(&print.points);
    let heights = print.points.iter().map(|p| p.y.log10());
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    let margin = 0.15 * (high - low).max(0.3);
    if print.against != Against::Amplitude {
        return;
    }
    for (name, power) in print.laws() {
        let inside = |v: f64| (low - margin..=high + margin).contains(&v);
        let points: Vec<[f64; 2]> = (0..=40)
            .map(|k| ends[0] + (ends[1] - ends[0]) * f64::from(k) / 40.0)
            .map(|at| [at, y + power * (at - x)])
            .filter(|p| inside(p[1]))
            .collect();
        // At its right end, where lines of different powers are apart; the trend covers the one that it follows.
        if let (Some(&[x, y]), true) = (points.last(), print.slope.is_none_or(|s| (s[0] - power).abs() > 0.3)) {
            let text = egui::RichText::new(*name).size(size::SMALL).color(palette.weak);
            plot.text(Text::new("law", PlotPoint::new(x, y + 0.03 * (high - low)), text).anchor(Align2::RIGHT_BOTTOM));
        }
        plot.line(curve("law", points, palette.weak.gamma_multiply(0.7), 1.0).style(LineStyle::dashed_dense()));
    }
}

/// The fitted line.
fn trend(plot: &mut PlotUi<'_>, palette: &Palette, print: &Print, powers: bool) {
    let Some([slope, _]) = print.slope else { return };
    let line: Vec<[f64; 2]> = if powers {
        let ([x, y], ends) = cloud(&print.points);
        ends.map(|at| [at, y + slope * (at - x)]).to_vec()
    } else {
        let most = print.points.iter().map(|p| p.x).fold(0.0, f64::max);
        let height = |x: f64| if print.measure == Measure::Phase { slope * x } else { slope };
        [0.0, most].map(|x| [x, height(x)]).to_vec()
    };
    plot.line(curve("trend", line, palette.missing, 2.0));
}

#[cfg(test)]
mod tests {
    use super::words;
    use crate::explain::prints::{Against, Measure, Print};

    #[test]
    fn slopes_are_said_with_their_deviation() {
        let print = |measure, slope| Print {
            measure,
            against: Against::Amplitude,
            points: Vec::new(),
            slope: Some(slope),
            at_frequency: None,
        };
        assert_eq!(words(&print(Measure::Damping, [-1.02, 0.03])).1, "power −1.020 ± 0.030");
        assert_eq!(words(&print(Measure::Phase, [-0.072, 0.0036])).1, "delay 200 ± 10 µs");
        assert_eq!(words(&print(Measure::Ratio, [1.05, 0.002])).1, "mean 1.0500 ± 0.0020");
    }
}

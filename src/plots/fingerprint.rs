//! The fingerprint of a suggestion as a plot: the runs with their deviations, the fitted power, the powers of simple laws.

use super::figure::{Axis, Figure, Label, Look, Ticks};
use super::style::Palette;
use crate::diagnosis::candidates::fingerprint_plot::{Against, Measure, Print, PrintPoint};
use crate::display::format;
use crate::effects::{Effect, ForcePart};

/// Title of the plot and what the slope says, in one line each.
pub(crate) fn words(print: &Print) -> (String, String) {
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

/// The part of the force whose powers of the abscissa are shown, on logarithmic axes.
fn part(print: &Print) -> Option<ForcePart> {
    match print.measure {
        Measure::Damping => Some(ForcePart::Damping),
        Measure::Stiffness => Some(ForcePart::Stiffness),
        Measure::Phase | Measure::Ratio => None,
    }
}

/// A law with its power: `Coulomb friction −1`.
pub(super) fn law_with_power(law: Effect, power: f64) -> String {
    format!("{} {}", law.noun(), format::significant(power, 1))
}

/// Runs with deviations, the fitted trend, and the powers of simple laws.
pub(crate) fn figure(print: &Print, palette: &Palette) -> Figure {
    let part = part(print);
    let axis = |name, unit| {
        if part.is_some() { Axis::log(name, unit).ticks(Ticks::OneTwoFive) } else { Axis::new(name, unit) }
    };
    let x = if print.against == Against::Amplitude {
        axis("Amplitude at the place", "m").peak()
    } else {
        axis("Frequency", "Hz")
    };
    let y = match print.measure {
        Measure::Damping => axis("Damping", "N·s/m"),
        Measure::Stiffness => axis("Stiffness", "N/m"),
        Measure::Phase => axis("Phase", "°").include(&[0.0]),
        Measure::Ratio => axis("Ratio", "").include(&[1.0]),
    };
    let x = if print.measure == Measure::Phase { x.include(&[0.0]) } else { x };
    let mut figure = Figure::new(&words(print).0, x, y);
    figure.margin = 0.05;
    if let Some(part) = part.filter(|_| print.against == Against::Amplitude) {
        figure = laws(figure, palette, print, part);
    }
    if let Some(line) = trend(print) {
        figure = figure.points("trend", palette.missing, Look::Line(2.0), line);
    }
    figure
        .points("runs", palette.measured, Look::Dots(3.0), print.points.iter().map(|p| [p.x, p.y]).collect())
        .deviation(print.points.iter().map(|p| p.deviation).collect())
}

/// Middle of the cloud in logarithms, and the ends of its abscissa.
fn cloud(points: &[PrintPoint]) -> ([f64; 2], [f64; 2]) {
    let n = points.len().max(1) as f64;
    let mean = |f: fn(&PrintPoint) -> f64| points.iter().map(|p| f(p).log10()).sum::<f64>() / n;
    let x = points.iter().map(|p| p.x.log10());
    let ends = x.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
    ([mean(|p| p.x), mean(|p| p.y)], ends)
}

/// Room for the name of a law above the end of its line, as a share of the height of the cloud.
const HEADROOM: f64 = 0.30;

/// Faint lines with the powers of simple laws through the middle of the cloud, no further up and down than it reaches.
fn laws(mut figure: Figure, palette: &Palette, print: &Print, part: ForcePart) -> Figure {
    let ([x, y], ends) = cloud(&print.points);
    let heights = print.points.iter().map(|p| p.y.log10());
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    let margin = 0.15 * (high - low).max(0.3);
    for (law, power) in Effect::amplitude_powers(part) {
        let inside = |v: f64| (low - margin..=high + margin).contains(&v);
        let points: Vec<[f64; 2]> = (0..=40)
            .map(|k| ends[0] + (ends[1] - ends[0]) * f64::from(k) / 40.0)
            .map(|at| [at, y + power * (at - x)])
            .filter(|p| inside(p[1]))
            .collect();
        // At its right end, where lines of different powers are apart; the trend covers the one that it follows.
        if let (Some(&[x, y]), true) = (points.last(), print.slope.is_none_or(|s| (s[0] - power).abs() > 0.3)) {
            let at = [x, y + 0.03 * (high - low)].map(|v| 10f64.powf(v));
            // Room above the highest for its name, which would else stand below the edge, on its own line.
            figure.y.include.push(10f64.powf(y + HEADROOM * (high - low)));
            figure.labels.push(Label { at, text: law_with_power(law, power), colour: palette.weak });
        }
        let points = points.into_iter().map(|p| p.map(|v| 10f64.powf(v))).collect();
        figure = figure.points("", palette.weak.gamma_multiply(0.7), Look::Dashed(1.0), points);
    }
    figure
}

/// Ends of the fitted line.
fn trend(print: &Print) -> Option<Vec<[f64; 2]>> {
    let [slope, _] = print.slope?;
    if part(print).is_some() {
        let ([x, y], ends) = cloud(&print.points);
        return Some(ends.map(|at| [at, y + slope * (at - x)].map(|v| 10f64.powf(v))).to_vec());
    }
    let most = print.points.iter().map(|p| p.x).fold(0.0, f64::max);
    let height = |x: f64| if print.measure == Measure::Phase { slope * x } else { slope };
    Some([0.0, most].map(|x| [x, height(x)]).to_vec())
}

#[cfg(test)]
mod tests {
    use super::words;
    use crate::diagnosis::candidates::fingerprint_plot::{Against, Measure, Print};

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

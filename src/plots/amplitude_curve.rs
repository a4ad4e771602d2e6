//! Frequency and damping ratio of one mode over its amplitude, measured and modelled: what the envelope of a decay tells.

use super::figure::{Axis, Figure, Look, Scale, Ticks};
use super::fingerprint::law_with_power;
use super::style::Palette;
use crate::diagnosis::records::amplitude::AmplitudePoint;
use crate::diagnosis::records::compare::ModeCurve;
use crate::display::units::{self, Damping};
use crate::display::{format, words};
use crate::effects::{Effect, ForcePart};
use crate::measurement::Quantity;

/// Points from which on a curve says something.
const LEAST_POINTS: usize = 3;

/// Largest over least amplitude from which on a slope shows: there the axes of the damping ratio are logarithmic.
const WIDE: f64 = 2.0;

/// Slope of a contact that slips in part, `chi + 1` at the usual `chi = -1/2`: between those of dashpot and drag.
const MICROSLIP: f64 = 0.5;

/// Laws and their slopes of `ln zeta` over `ln A`, in rising order: guides for the curve.
pub(crate) fn slopes() -> Vec<(Effect, f64)> {
    let mut slopes = Effect::amplitude_powers(ForcePart::Damping);
    slopes.push((Effect::MICROSLIP, MICROSLIP));
    slopes.sort_by(|a, b| a.1.total_cmp(&b.1));
    slopes
}

/// The modes of a record whose curves say something.
pub(crate) fn told(curves: &[ModeCurve]) -> Vec<&ModeCurve> {
    curves.iter().filter(|c| c.measured.len() >= LEAST_POINTS).collect()
}

/// Both figures of every mode, the damping ratio first; each says its mode where there are several.
pub(crate) fn figures(curves: &[&ModeCurve], palette: &Palette) -> Vec<Figure> {
    let titled_figure = |(curve, ratio): (&&ModeCurve, bool)| {
        let mut figure = figure(curve, ratio, palette);
        if curves.len() > 1 {
            figure.title = format!("{}, mode near {}", figure.title, format::with_unit(curve.frequency_hz, "Hz"));
        }
        figure
    };
    curves.iter().flat_map(|curve| [true, false].map(|ratio| (curve, ratio))).map(titled_figure).collect()
}

/// Damping ratio over amplitude (`ratio`), else frequency over amplitude.
pub(crate) fn figure(curve: &ModeCurve, ratio: bool, palette: &Palette) -> Figure {
    let quantity = curve.channel.split('@').next().and_then(Quantity::from_word);
    let name = quantity.map_or("Amplitude", |q| words::axis(q, false));
    // Both figures share the axis of amplitude, so that it is of one kind.
    let wide = is_wide(&curve.measured);
    let measure = units::now().damping;
    let [title_of_measure, unit] = measure.title();
    let y = if ratio { Axis::new(title_of_measure, unit) } else { Axis::new("Frequency", "Hz") };
    let damping = |p: &AmplitudePoint| measure.of(p.damping_ratio, p.damping_deviation);
    let points = |list: &[AmplitudePoint]| -> Vec<[f64; 2]> {
        list.iter().map(|p| [p.amplitude, if ratio { damping(p)[0] } else { p.frequency_hz }]).collect()
    };
    let deviation = |p: &AmplitudePoint| if ratio { damping(p)[1] } else { p.frequency_deviation_hz };
    let title = if ratio { title_of_measure } else { "Frequency" };
    let logarithmic = |plain: Axis| Axis { scale: Scale::Log, ticks: Ticks::OneTwoFive, ..plain };
    let x = Axis::of(name).peak();
    let x = if wide { logarithmic(x) } else { x };
    let mut figure = Figure::new(title, x, if wide && ratio { logarithmic(y) } else { y });
    figure.margin = 0.04;
    if wide && ratio {
        // The quality factor falls where the damping ratio rises.
        let sign = if measure == Damping::Quality { -1.0 } else { 1.0 };
        // Each is told from the others in black and white too.
        let [ink, weak] = [palette.ink, palette.weak];
        let looks =
            [(ink, Look::Dashed(1.2)), (weak, Look::Line(1.0)), (weak, Look::Dashed(1.2)), (ink, Look::Line(1.0))];
        for ((law, slope), (colour, look)) in slopes().into_iter().zip(looks) {
            let slope = sign * slope;
            let line = guide(&points(&curve.measured), slope);
            figure = figure.points(&law_with_power(law, slope), colour, look, line);
        }
    }
    figure
        .points("measured", palette.measured, Look::Dots(3.0), points(&curve.measured))
        .deviation(curve.measured.iter().map(deviation).collect())
        .points("model", palette.model, Look::Line(1.6), points(&curve.model_over_amplitude))
}

/// Whether damping ratios that can be drawn by their logarithm span amplitudes that are far apart.
fn is_wide(points: &[AmplitudePoint]) -> bool {
    let seen = points.iter().filter(|p| p.damping_ratio > 0.0 && p.amplitude > 0.0);
    let (least, most) = seen.fold((f64::INFINITY, 0.0_f64), |(a, b), p| (a.min(p.amplitude), b.max(p.amplitude)));
    most > WIDE * least
}

/// `y = y_0 (x / x_0)^slope` through the middle of the points, over as much of them as keeps it beside them.
fn guide(points: &[[f64; 2]], slope: f64) -> Vec<[f64; 2]> {
    let logs: Vec<[f64; 2]> =
        points.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0).map(|p| [p[0].ln(), p[1].ln()]).collect();
    let sorted = |k: usize| {
        let mut list: Vec<f64> = logs.iter().map(|p| p[k]).collect();
        list.sort_by(f64::total_cmp);
        list
    };
    let [x, y] = [sorted(0), sorted(1)];
    let (Some(first), Some(last)) = (x.first().zip(y.first()), x.last().zip(y.last())) else { return Vec::new() };
    let middle = [x[x.len() / 2], y[y.len() / 2]];
    // Steep guides end where they leave the points, or they would squeeze them.
    let room = 0.5 * (last.1 - first.1) + 0.4;
    let reach = |to: f64| if slope == 0.0 { to } else { to.clamp(-room / slope.abs(), room / slope.abs()) };
    let on_line = |to: f64| [(middle[0] + to).exp(), (middle[1] + slope * to).exp()];
    vec![on_line(reach(first.0 - middle[0])), on_line(reach(last.0 - middle[0]))]
}

#[cfg(test)]
mod tests {
    use super::{guide, slopes};
    use crate::effects::Effect;

    /// A guide has its slope, passes through the middle of the points and stays beside them.
    #[test]
    fn guides_have_the_slopes_of_their_laws() {
        let points: Vec<[f64; 2]> = (1..40).map(|k| [f64::from(k) * 1e-3, 2.0 / f64::from(k)]).collect();
        for (law, slope) in slopes() {
            let line = guide(&points, slope);
            let [[a, p], [b, q]] = [line[0], line[1]];
            assert!(((q / p).ln() - slope * (b / a).ln()).abs() < 1e-12, "{law}");
            let middle = p * (20e-3_f64 / a).powf(slope);
            assert!((middle / 0.1 - 1.0).abs() < 1e-9, "{law}: {middle}");
            assert!(p.max(q) < 10.0 && p.min(q) > 0.01, "{law}");
        }
        let laws = slopes().into_iter().map(|(law, _)| law);
        assert!(laws.eq([Effect::Coulomb, Effect::Viscous, Effect::Iwan, Effect::Quadratic]));
        // Coulomb friction lies on its guide.
        let line = guide(&points, -1.0);
        assert!(line.iter().all(|p| (p[1] * p[0] / 2e-3 - 1.0).abs() < 1e-9));
    }
}

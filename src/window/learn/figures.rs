//! The portrait of a law as plots.

use crate::display::format;
use crate::plots::figure::{Axis, Figure, Look, Ticks};
use crate::response::portrait::{AtLevel, Points, Portrait, ResponsePoint};
use crate::window::appearance::theme::Palette;
use egui::Color32;

/// Line of the k-th force level: the larger the force, the heavier.
fn level(palette: &Palette, k: usize) -> (Color32, f32) {
    match k {
        0 => (palette.model.gamma_multiply(0.5), 1.3),
        1 => (palette.model, 1.9),
        _ => (palette.ink, 1.9),
    }
}

fn name(force: f64) -> String {
    format!("{} N", format::significant(force, 2))
}

/// Free motion of the driven mass.
pub(super) fn decay(portrait: &Portrait, palette: &Palette) -> Result<Figure, String> {
    let points = portrait.decay.clone()?;
    let figure = Figure::new("Free motion", Axis::new("Time", "s"), Axis::new("Displacement", "m"));
    Ok(figure.points("", palette.model, Look::Line(1.6), points))
}

/// Magnitude and phase over frequency.
pub(super) fn bode(portrait: &Portrait, palette: &Palette) -> [Figure; 2] {
    let frequency = || Axis::log("Frequency", "Hz").ticks(Ticks::OneTwoFive);
    let mut magnitude = Figure::new("Magnitude", frequency(), Axis::log("Receptance", "m/N"));
    let degrees = Axis::new("Phase", "°").ticks(Ticks::RightAngles).include(&[-180.0, 0.0]);
    let mut phase = Figure::new("Phase", frequency(), degrees);
    for (k, curve) in portrait.curves.iter().enumerate() {
        let (colour, width) = level(palette, k);
        for (stable, piece) in pieces(curve) {
            let look = if stable { Look::Line(width) } else { Look::Dotted(width) };
            let points = |y: &dyn Fn(&ResponsePoint) -> f64| piece.iter().map(|p| [p.frequency_hz, y(p)]).collect();
            magnitude = magnitude.points(&name(curve.force), colour, look, points(&|p| p.receptance.norm()));
            let angle = |p: &ResponsePoint| p.receptance.im.atan2(p.receptance.re).to_degrees();
            phase = phase.points("", colour, look, points(&angle));
        }
    }
    [magnitude, phase]
}

/// Imaginary over real part.
pub(super) fn nyquist(portrait: &Portrait, palette: &Palette) -> Figure {
    let (x, y) = (Axis::new("Real part", "m/N").include(&[0.0]), Axis::new("Imaginary part", "m/N").include(&[0.0]));
    let mut figure = Figure::new("Nyquist diagram", x, y);
    (figure.square, figure.margin) = (true, 0.08);
    for (k, curve) in portrait.curves.iter().enumerate() {
        let (colour, width) = level(palette, k);
        for (stable, piece) in pieces(curve) {
            let points = piece.iter().map(|p| [p.receptance.re, p.receptance.im]).collect();
            let look = if stable { Look::Line(width) } else { Look::Dotted(width) };
            figure = figure.points(&name(curve.force), colour, look, points);
        }
    }
    figure
}

/// Loops of force over displacement, of the exciter or of the law.
pub(super) fn loops(title: &str, all: &[AtLevel<Points>], palette: &Palette) -> Figure {
    let mut figure = Figure::new(title, Axis::new("Displacement", "m"), Axis::new("Force", "N"));
    figure.margin = 0.08;
    for (k, one) in all.iter().enumerate().rev() {
        let (colour, width) = level(palette, k);
        if let Ok(points) = &one.found {
            figure = figure.points(&name(one.force), colour, Look::Line(width), points.clone());
        }
    }
    figure
}

/// Energy a cycle over amplitude, with the power of the amplitude at the middle force in words.
///
/// # Errors
/// One line for a law that takes out no energy.
pub(super) fn energy(portrait: &Portrait, palette: &Palette) -> Result<(Figure, String), String> {
    let x = Axis::log("Amplitude", "m").peak().ticks(Ticks::OneTwoFive);
    let points: Points = portrait.energy.iter().copied().filter(|p| p[1] > 1e-15).collect();
    let middle = points.len() / 2;
    let (Some(a), Some(b)) = (points.get(middle.wrapping_sub(1)), points.get(middle + 1)) else {
        return Err("This law takes out no energy.".to_owned());
    };
    let power = (b[1] / a[1]).ln() / (b[0] / a[0]).ln();
    let words = format!("grows with the amplitude to the power {}", format::significant(power, 3));
    let figure = Figure::new("Energy per cycle", x, Axis::log("Energy", "J"));
    Ok((figure.points("", palette.model, Look::Line(1.9), points), words))
}

/// A curve cut where it changes its stability; pieces share their ends.
fn pieces(curve: &AtLevel<Vec<ResponsePoint>>) -> Vec<(bool, Vec<ResponsePoint>)> {
    let mut pieces: Vec<(bool, Vec<ResponsePoint>)> = Vec::new();
    for point in curve.found.iter().flatten() {
        match pieces.last_mut() {
            Some((stable, piece)) if *stable == point.stable => piece.push(*point),
            Some((_, piece)) => {
                let start = piece.last().copied().into_iter().chain([*point]).collect();
                pieces.push((point.stable, start));
            }
            None => pieces.push((point.stable, vec![*point])),
        }
    }
    pieces
}

//! The missing force at its place over displacement and over velocity: identified points in the colours of their levels, the
//! law drawn through; and as colour over both, the surface of the force seen from above.

use super::cycle::scaled;
use super::figure::{Axis, Figure, Look};
use super::sheet::Sheet;
use super::style::Palette;
use crate::diagnosis::candidates::restoring_force::{ForcePoint, RestoringForce, RunForce};
use crate::display::{format, words};
use crate::effects::Place;
use crate::measurement::Quantity;
use crate::structure::Structure;
use ecolor::Color32;

/// Colours of a map; odd, so that one of them is that of no force.
const CLASSES: usize = 9;

/// Largest value of a coordinate over all runs.
fn largest(force: &RestoringForce, of: fn(&ForcePoint) -> f64) -> f64 {
    force.runs.iter().flat_map(|r| &r.points).map(|p| of(p).abs()).fold(0.0, f64::max)
}

/// What the plots show, as a title: `Missing force at DOF 7`.
pub(crate) fn title(force: &RestoringForce, structure: &Structure) -> String {
    format!("Missing force {}", force.place.phrase(structure))
}

/// What stands in them, in one line: the law, the harmonics and the deviation of the points.
pub(crate) fn caption(force: &RestoringForce) -> String {
    let harmonics = force.runs.iter().map(|r| r.harmonics).max().unwrap_or(1);
    let deviation = force.runs.iter().map(|r| r.deviation).fold(0.0, f64::max);
    if harmonics == 0 {
        let law = force
            .law
            .as_ref()
            .map_or_else(String::new, |s| format!("; lines: {} along the same motion", s.effect.noun()));
        return format!("points: parts of records, ± {}{law}", format::prefixed(deviation, "N"));
    }
    let law = force.law.as_ref().map_or_else(
        || "no law is drawn through them".to_owned(),
        |s| format!("lines: {} with the same harmonics", s.effect.noun()),
    );
    let count = words::counted(harmonics, "harmonic");
    format!("points: one period, {count}, ± {}; {law}", format::prefixed(deviation, "N"))
}

/// Name of a level in the key; parts of records are called by the second that they begin at.
fn name(run: &RunForce) -> String {
    match run.level_name.strip_suffix(" s") {
        _ if run.level_name.parse::<i64>().is_ok() => format!("level {}", run.level_name),
        Some(start) if start.parse::<f64>().is_ok() => format!("from {start} s"),
        _ => run.level_name.clone(),
    }
}

/// Colours of the runs: those of their levels, or of data and missing effect where there is one level only.
fn colours(force: &RestoringForce, palette: &Palette) -> Vec<[Color32; 2]> {
    let mut levels: Vec<usize> = force.runs.iter().map(|r| r.level).collect();
    levels.dedup();
    let colour_of = |run: &RunForce| {
        let at = levels.iter().position(|l| *l == run.level).unwrap_or(0);
        let colour = palette.level(at as f32 / (levels.len().max(2) - 1) as f32);
        if levels.len() < 2 { [palette.measured, palette.missing] } else { [colour; 2] }
    };
    force.runs.iter().map(colour_of).collect()
}

fn is_rotation(force: &RestoringForce, structure: &Structure) -> bool {
    match &force.place {
        Place::Dofs(dofs) => dofs.iter().any(|&d| structure.dofs().get(d).is_some_and(|d| d.direction.is_rotation())),
        _ => false,
    }
}

/// The axis of a quantity, and the factor on its values in SI units.
fn axis(quantity: Quantity, rotation: bool, largest: f64) -> (f64, Axis) {
    let (factor, prefix) = scaled(largest);
    let plain = Axis::of(words::axis(quantity, rotation));
    (factor, Axis::new(&plain.name, &format!("{prefix}{}", plain.unit)).include(&[0.0]))
}

/// Force over displacement, and over velocity.
pub(crate) fn figures(force: &RestoringForce, structure: &Structure, palette: &Palette) -> [Figure; 2] {
    let rotation = is_rotation(force, structure);
    let (scale, y) = axis(Quantity::Force, rotation, largest(force, |p| p.force));
    let over = |what: &str, quantity, of: fn(&ForcePoint) -> f64| {
        let (factor, x) = axis(quantity, rotation, largest(force, of));
        let place = |p: &ForcePoint| [factor * of(p), scale * p.force];
        let mut figure = Figure::new(&format!("{} over {what}", title(force, structure)), x, y.clone());
        figure.margin = 0.06;
        curves(keyed(figure, force, palette), force, palette, scale, place)
    };
    [
        over("displacement", Quantity::Displacement, |p| p.displacement),
        over("velocity", Quantity::Velocity, |p| p.velocity),
    ]
}

/// Force as colour over displacement and velocity (force-state map: Crawley and Aubert 1986, AIAA Journal 24, 155): as identified, then,
/// where a law is drawn, by the law along the same motion. A law without memory gives one colour at a point; one with memory gives
/// others on the way there and back. The last colours stand for all forces beyond them.
pub(crate) fn maps(force: &RestoringForce, structure: &Structure, palette: &Palette) -> Vec<Figure> {
    // Single points scatter far beyond what a law does there: its force is the scale.
    let of_law = force.runs.iter().flat_map(|r| &r.law).map(|p| p.force.abs()).fold(0.0, f64::max);
    let most = if of_law > 0.0 { of_law } else { largest(force, |p| p.force) };
    if most <= 0.0 {
        return Vec::new();
    }
    let mut list = vec![map(force, structure, palette, ("identified", most, |r| &r.points))];
    if let Some(law) = force.law.as_ref().filter(|_| force.runs.iter().any(|r| !r.law.is_empty())) {
        list.push(map(force, structure, palette, (law.effect.noun(), most, |r| &r.law)));
    }
    list
}

/// What a map shows: its name, the force of its last colour, the points of a run.
type Mapped<'a> = (&'a str, f64, fn(&RunForce) -> &Vec<ForcePoint>);

fn map(force: &RestoringForce, structure: &Structure, palette: &Palette, (name, most, points): Mapped<'_>) -> Figure {
    let rotation = is_rotation(force, structure);
    let [(a, x), (b, y)] = [
        axis(Quantity::Displacement, rotation, largest(force, |p| p.displacement)),
        axis(Quantity::Velocity, rotation, largest(force, |p| p.velocity)),
    ];
    let mut figure = Figure::new(&format!("{}, {name}", title(force, structure)), x, y);
    figure.margin = 0.06;
    let unit = Axis::of(words::axis(Quantity::Force, rotation)).unit;
    let class = |p: &ForcePoint| ((0.5 + 0.5 * p.force / most).clamp(0.0, 1.0) * (CLASSES - 1) as f64).round() as usize;
    for k in 0..CLASSES {
        let share = k as f64 / (CLASSES - 1) as f64;
        // The ends and the middle of the scale are named.
        let key = match k {
            _ if k % (CLASSES / 2) != 0 => String::new(),
            k if 2 * k + 1 == CLASSES => format!("0 {unit}"),
            _ => format::prefixed((2.0 * share - 1.0) * most, &unit),
        };
        let own = force.runs.iter().flat_map(points).filter(|p| class(p) == k);
        let own = own.map(|p| [a * p.displacement, b * p.velocity]).collect();
        figure = figure.points(&key, palette.level(share as f32), Look::Dots(2.4), own);
    }
    figure
}

/// With keys to marks and colours.
fn keyed(mut figure: Figure, force: &RestoringForce, palette: &Palette) -> Figure {
    let colours = colours(force, palette);
    let many = colours.windows(2).any(|c| c[0] != c[1]);
    let [dots, line] = if many { [palette.ink; 2] } else { colours[0] };
    figure = figure.key("identified", dots, Look::Dots(3.0));
    if let Some(law) = &force.law {
        figure = figure.key(law.effect.noun(), line, Look::Line(3.0));
    }
    if many {
        for (k, run) in force.runs.iter().enumerate() {
            if k == 0 || force.runs[k - 1].level != run.level {
                figure = figure.key(&name(run), colours[k][0], Look::Line(3.0));
            }
        }
    }
    figure
}

fn curves(
    mut figure: Figure,
    force: &RestoringForce,
    palette: &Palette,
    scale: f64,
    place: impl Fn(&ForcePoint) -> [f64; 2],
) -> Figure {
    for (run, [dots, line]) in force.runs.iter().zip(colours(force, palette)) {
        if !run.law.is_empty() {
            figure = figure.points("", line, Look::Line(1.5), run.law.iter().map(&place).collect());
        }
        let points: Vec<[f64; 2]> = run.points.iter().map(&place).collect();
        let deviation = vec![scale * run.deviation; points.len()];
        figure = figure.points("", dots, Look::Dots(2.4), points).deviation(deviation);
    }
    figure
}

/// All plots on one sheet: over displacement and velocity, and below them the maps.
pub(crate) fn sheet(force: &RestoringForce, structure: &Structure, palette: &Palette) -> Sheet {
    let title = title(force, structure);
    let mut sheet = Sheet::of(
        &title,
        figures(force, structure, palette).into_iter().chain(maps(force, structure, palette)).collect(),
    );
    sheet.columns = 2;
    sheet
}

/// Values of all points as a table with tabs, SI units.
pub(crate) fn table(force: &RestoringForce) -> String {
    let mut text =
        "run\tlevel\tfrequency (Hz)\tdisplacement (m)\tvelocity (m/s)\tforce (N)\tstandard deviation (N)\n".to_owned();
    for run in &force.runs {
        for p in &run.points {
            text += &format!(
                "{}\t{}\t{:e}\t{:e}\t{:e}\t{:e}\t{:e}\n",
                run.run + 1,
                run.level_name,
                run.frequency_hz,
                p.displacement,
                p.velocity,
                p.force,
                run.deviation
            );
        }
    }
    text
}

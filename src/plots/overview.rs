//! All runs at once: amplitude and phase of one channel over frequency, one curve a level.

use super::channel_response::per_force;
use super::figure::{Axis, Figure, Look, Ticks};
use super::response_curve::{ForceLevel, force, levels};
use super::samples::phase;
use super::style::Palette;
use crate::exchange::Project;
use crate::measurement::Channel;
use faer::c64;

/// Logarithm of a frequency ratio beyond which neighbours are not joined by a line: another resonance.
const APART: f64 = 0.25;
/// Highest over lowest frequency from which on the axis is logarithmic, so that the lower resonances are as broad as the higher.
const WIDE: f64 = 8.0;
/// Free room at the sides of the first and the last run, as a share of the width.
const MARGIN: f32 = 0.04;
/// Most levels that stand in the row of keys; beyond, the lowest and the highest.
const MOST_KEYS: usize = 8;

/// Runs of one level in the order of their frequencies.
struct Group {
    name: String,
    /// Run, frequency (Hz), fundamental of the channel over that of the force.
    points: Vec<(usize, f64, c64)>,
}

/// Runs that have the `channel`, by their labels where all have one, else by their force.
fn groups(p: &Project, channel: &Channel) -> Vec<Group> {
    let ratio = |&run: &usize| {
        let fit = p.runs[run].fit.channels.iter().find(|c| c.channel == *channel)?;
        let (_, force) = force(p, run).filter(|(_, f)| f.norm() > 0.0)?;
        Some((run, p.runs[run].frequency_hz(), *fit.amplitudes.first()? / force))
    };
    let group_of = |(name, runs): (String, Vec<usize>)| {
        let mut points: Vec<(usize, f64, c64)> = runs.iter().filter_map(ratio).collect();
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        Group { name, points }
    };
    runs_by_level(p).into_iter().map(group_of).filter(|g| !g.points.is_empty()).collect()
}

/// Name and runs of every level.
fn runs_by_level(p: &Project) -> Vec<(String, Vec<usize>)> {
    let all: Vec<usize> = (0..p.runs.len()).collect();
    let labels: Option<Vec<i64>> = p.runs.iter().map(|r| r.level).collect();
    let Some(labels) = labels.filter(|labels| !labels.is_empty()) else {
        let named = |level: ForceLevel| (level.name(), level.runs);
        return levels(p, &all).into_iter().map(named).collect();
    };
    let mut kinds = labels.clone();
    kinds.sort_unstable();
    kinds.dedup();
    let labelled = |kind: i64| all.iter().copied().filter(|&r| labels[r] == kind).collect();
    kinds.into_iter().map(|kind| (format!("level {kind}"), labelled(kind))).collect()
}

/// Amplitude above phase with their shares of the height; the selected `run` is ringed. Empty where no run has the channel
/// and a force.
pub(crate) fn figures(p: &Project, channel: &Channel, run: usize, palette: &Palette) -> Vec<(Figure, f32)> {
    let groups = groups(p, channel);
    if groups.is_empty() {
        return Vec::new();
    }
    let rotation = p.structure.dofs().get(channel.dof).is_some_and(|d| d.direction.is_rotation());
    let per = per_force(channel.quantity.si_unit(rotation));
    let y = [Axis::log("Magnitude", &per).ticks(Ticks::OneTwoFive), Axis::new("Phase", "°").ticks(Ticks::RightAngles)];
    let parts: [(&str, fn(c64) -> f64); 2] = [("Magnitude", |z| z.norm()), ("Phase", phase)];
    let frequencies = groups.iter().flat_map(|g| &g.points).map(|(_, f, _)| *f);
    let [low, high] = frequencies.fold([f64::INFINITY, 0.0_f64], |[a, b], f| [a.min(f), b.max(f)]);
    let x = if high > WIDE * low {
        Axis::log("Frequency", "Hz").ticks(Ticks::OneTwoFive)
    } else {
        Axis::new("Frequency", "Hz")
    };
    let figure = |(y, (name, of)): (Axis, (&str, fn(c64) -> f64))| {
        let title = format!("{name} of {channel} over the force, all runs");
        let figure = Figure::new(&title, x.clone(), y);
        curves(figure, &groups, run, palette, of)
    };
    y.into_iter().zip(parts).map(figure).zip([0.6, 0.4]).collect()
}

fn curves(mut figure: Figure, groups: &[Group], run: usize, palette: &Palette, of: fn(c64) -> f64) -> Figure {
    let last = groups.len() - 1;
    for (k, group) in groups.iter().enumerate() {
        let colour = if last == 0 { palette.measured } else { palette.level(k as f32 / last as f32) };
        let keyed = last > 0 && (last < MOST_KEYS || k == 0 || k == last);
        figure = figure.key(if keyed { &group.name } else { "" }, colour, Look::Line(3.0));
        let ends = |w: &[(usize, f64, c64)]| (w[1].1 / w[0].1).ln() < APART;
        for piece in group.points.chunk_by(|a, b| ends(&[*a, *b])) {
            let line = piece.iter().map(|(_, f, z)| [*f, of(*z)]).collect();
            figure = figure.points("", colour, Look::Line(1.2), line);
        }
        let dots = group.points.iter().map(|(_, f, z)| [*f, of(*z)]).collect();
        figure = figure.points("", colour, Look::Dots(2.4), dots);
    }
    let chosen = groups.iter().flat_map(|g| &g.points).filter(|(r, _, _)| *r == run);
    let ring = chosen.map(|(_, f, z)| [*f, of(*z)]).collect();
    figure.margin = MARGIN;
    figure.points("", palette.accent, Look::Rings(8.0), ring)
}

//! Amplitude of a signal over time and frequency: windows of it, each half over the one before, under Hann's window.
//!
//! Shown in decibels below the largest amplitude of a signal that it is compared with: what a model leaves of a record, where in time
//! and at which frequency.

use super::drawing::{Drawing, Stroke};
use super::figure::Axis;
use super::style::{self, Palette, size};
use super::ticks::rules;
use crate::math::spectrum::Spectrum;
use emath::{Align2, Pos2, Rect, Vec2, pos2, vec2};
use std::ops::Range;

/// Windows of time, and rows of frequency that are drawn at most.
const COLUMNS: usize = 56;
const ROWS: usize = 40;
/// Fewest samples of a window.
const FEWEST: usize = 32;
/// Decibels below the largest at which the scale of colours ends.
const RANGE_DB: f64 = 60.0;
/// Amplitude below the largest over all times, dB, from which on frequencies above are not drawn.
const SILENT_DB: f64 = 54.0;
/// Room of the axes and of the scale of colours.
const MARGIN: [f32; 4] = [64.0, 44.0, 92.0, 44.0];
/// Room of the title on paper.
const TITLE: f32 = 28.0;
/// What the colours mean.
const REMARK: &str = "dB below the largest amplitude that was measured";

/// Amplitudes over time and frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrogram {
    /// Beginning of the first window and end of the last, s.
    pub time_s: [f64; 2],
    /// Least and highest frequency that are shown, Hz.
    pub range_hz: [f64; 2],
    /// Amplitudes over the largest of the signal that is compared with, dB: `[window][row]`, rows from zero up.
    pub decibels: Vec<Vec<f64>>,
}

impl Spectrogram {
    /// Of `signal` beside `reference`, which begin at `start` s with `step` s between samples; `None` where they are too short.
    pub fn new(signal: &[f64], reference: &[f64], start: f64, step: f64) -> Option<Self> {
        let length = (2 * signal.len() / (COLUMNS + 1)).max(FEWEST);
        if signal.len() < 2 * length {
            return None;
        }
        let windows = |list: &[f64]| -> Option<Vec<Spectrum>> {
            let starts = (0..=list.len() - length).step_by(length / 2);
            starts.map(|from| Spectrum::new(&list[from..from + length], step)).collect()
        };
        let (own, other) = (windows(signal)?, windows(reference)?);
        let largest = other.iter().flat_map(|s| s.amplitude.iter().skip(1)).fold(0.0_f64, |m, a| m.max(*a));
        if largest <= 0.0 {
            return None;
        }
        let below = |a: f64| 20.0 * (a / largest).max(1e-12).log10();
        let loud = |k: usize| own.iter().chain(&other).any(|s| below(s.amplitude[k]) > -SILENT_DB);
        let lines = own.first()?.amplitude.len();
        let last = (1..lines).rev().find(|&k| loud(k)).unwrap_or(lines - 1);
        let count = (last + last / 8 + 2).min(lines);
        let rows = count.min(ROWS);
        let row = |s: &Spectrum, r: usize| {
            let lines = r * count / rows..((r + 1) * count / rows).max(r * count / rows + 1);
            below(lines.map(|k| s.amplitude[k]).fold(0.0, f64::max))
        };
        let decibels: Vec<Vec<f64>> = own.iter().map(|s| (0..rows).map(|r| row(s, r)).collect()).collect();
        let end = start + step * (length / 2 * (decibels.len() - 1) + length) as f64;
        Some(Self { time_s: [start, end], range_hz: [0.0, own.first()?.frequency_hz(count)], decibels })
    }

    /// Windows of time and rows of frequency.
    pub fn count(&self) -> [usize; 2] {
        [self.decibels.len(), self.decibels.first().map_or(0, Vec::len)]
    }

    /// Those windows and rows alone.
    #[must_use]
    pub fn part(&self, [windows, rows]: [Range<usize>; 2]) -> Self {
        let [across, up] = self.count();
        let ends = |[from, to]: [f64; 2], cells: &Range<usize>, count: usize| {
            [cells.start, cells.end].map(|k| from + (to - from) * k as f64 / count.max(1) as f64)
        };
        Self {
            time_s: ends(self.time_s, &windows, across),
            range_hz: ends(self.range_hz, &rows, up),
            decibels: self.decibels[windows].iter().map(|list| list[rows.clone()].to_vec()).collect(),
        }
    }

    /// Drawn on paper under its title, with its axes and the scale of its colours.
    pub fn draw(&self, room: Vec2, title: &str, palette: &Palette) -> Drawing {
        let mut drawing = Drawing::new(room, palette.canvas, title);
        drawing.words(pos2(16.0, 18.0), Align2::LEFT_CENTER, title, size::HEADING, palette.ink);
        let below = Rect::from_min_max(pos2(0.0, TITLE), room.to_pos2());
        self.draw_within(&mut drawing, below, palette);
        drawing
    }

    /// Drawn with its axes and the scale of its colours; gives back the area of the cells.
    pub fn draw_within(&self, drawing: &mut Drawing, room: Rect, palette: &Palette) -> Rect {
        let [left, top, right, foot] = MARGIN;
        let plot = Rect::from_min_max(room.min + vec2(left, top), room.max - vec2(right, foot));
        drawing.words(room.min + vec2(16.0, 10.0), Align2::LEFT_CENTER, REMARK, size::SMALL, palette.weak);
        let rows = self.decibels.first().map_or(1, Vec::len).max(1);
        let cell = vec2(plot.width() / self.decibels.len().max(1) as f32, plot.height() / rows as f32);
        for (column, list) in self.decibels.iter().enumerate() {
            for (row, decibels) in list.iter().enumerate() {
                let corner = pos2(plot.left() + cell.x * column as f32, plot.bottom() - cell.y * (row + 1) as f32);
                // Cells overlap by a hair, or the ground shines through between them.
                let rect = Rect::from_min_size(corner, cell + vec2(0.4, 0.4)).intersect(plot);
                drawing.rect(rect, palette.error_shade(share(*decibels)), Stroke::NONE);
            }
        }
        drawing.rect(plot, ecolor::Color32::TRANSPARENT, style::hair(palette.line));
        self.axes(drawing, plot, palette);
        legend(drawing, plot, palette);
        plot
    }

    /// Time in s, frequency in Hz and level in dB of the cell at a point, where the cells fill `plot`.
    pub fn at(&self, plot: Rect, point: Pos2) -> Option<[f64; 3]> {
        let share = (point - plot.min) / plot.size();
        let list =
            plot.contains(point).then(|| self.decibels.get((share.x * self.decibels.len() as f32) as usize))??;
        let level = list.get(((1.0 - share.y) * list.len() as f32) as usize)?;
        let along = |[from, to]: [f64; 2], share: f32| from + f64::from(share) * (to - from);
        Some([along(self.time_s, share.x), along(self.range_hz, 1.0 - share.y), *level])
    }

    fn axes(&self, drawing: &mut Drawing, plot: Rect, palette: &Palette) {
        let mut tick = |from: Pos2, to: Pos2, align: Align2, label: &str| {
            drawing.line(vec![from, to], style::hair(palette.line));
            drawing.words(to + (to - from), align, label, size::SMALL, palette.weak);
        };
        let [from, to] = self.time_s;
        for rule in rules(&Axis::new("Time", "s"), self.time_s, plot.width()) {
            let x = plot.left() + plot.width() * ((rule.at - from) / (to - from)) as f32;
            tick(pos2(x, plot.bottom()), pos2(x, plot.bottom() + 4.0), Align2::CENTER_TOP, &rule.label);
        }
        let frequency = Axis::new("Frequency", "Hz").displayed();
        let range = self.range_hz.map(|hz| frequency.factor * hz);
        for rule in rules(&frequency, range, plot.height()) {
            let y = plot.bottom() - plot.height() * ((rule.at - range[0]) / (range[1] - range[0])) as f32;
            tick(pos2(plot.left(), y), pos2(plot.left() - 4.0, y), Align2::RIGHT_CENTER, &rule.label);
        }
        let below = pos2(plot.center().x, plot.bottom() + 34.0);
        drawing.words(below, Align2::CENTER_CENTER, "Time, s", size::SMALL, palette.ink);
        let above = pos2(plot.left() - 48.0, plot.top() - 10.0);
        drawing.words(above, Align2::LEFT_CENTER, frequency.label(), size::SMALL, palette.ink);
    }

    /// The same as a table with tabs: a row a window, a column a frequency, dB.
    pub fn table(&self) -> String {
        let rows = self.decibels.first().map_or(1, Vec::len).max(1) as f64;
        let [from, to] = self.time_s;
        let half = (to - from) / (self.decibels.len() + 1) as f64;
        let mut text = "time (s)".to_owned();
        let [low, high] = self.range_hz;
        let frequency = |r: usize| low + (high - low) * (r as f64 + 0.5) / rows;
        (0..rows as usize).for_each(|r| text += &format!("\t{:.4e} Hz (dB)", frequency(r)));
        for (n, list) in self.decibels.iter().enumerate() {
            text += &format!("\n{:.6e}", from + half * (n + 1) as f64);
            list.iter().for_each(|x| text += &format!("\t{x:.2}"));
        }
        text + "\n"
    }
}

/// Where a level stands on the scale of colours.
fn share(decibels: f64) -> f32 {
    (1.0 + decibels / RANGE_DB).clamp(0.0, 1.0) as f32
}

fn legend(drawing: &mut Drawing, plot: Rect, palette: &Palette) {
    let steps = 30;
    let height = plot.height() / steps as f32;
    let left = plot.right() + 16.0;
    for k in 0..steps {
        let shade = palette.error_shade((k as f32 + 0.5) / steps as f32);
        let corner = pos2(left, plot.bottom() - height * (k + 1) as f32);
        drawing.rect(Rect::from_min_size(corner, vec2(14.0, height + 0.4)), shade, Stroke::NONE);
    }
    for level in [0.0, -20.0, -40.0, -60.0] {
        let at = pos2(left + 20.0, plot.bottom() - plot.height() * share(level));
        drawing.words(at, Align2::LEFT_CENTER, format!("{level:.0} dB").replace('-', "−"), size::SMALL, palette.weak);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{COLUMNS, Spectrogram};
    use std::f64::consts::TAU;

    /// A burst in the second half at 50 Hz, a tenth of a steady tone at 20 Hz that it is compared with: it stands at its time, at its
    /// frequency, 20 dB down; elsewhere there is nothing.
    #[test]
    fn a_burst_stands_where_it_is() {
        let step = 1e-3;
        let time = |n: usize| f64::from(u32::try_from(n).unwrap()) * step;
        let tone: Vec<f64> = (0..8000).map(|n| (TAU * 20.0 * time(n)).sin()).collect();
        let burst = |n: usize| if (5000..6500).contains(&n) { 0.1 * (TAU * 50.0 * time(n)).sin() } else { 0.0 };
        let found = Spectrogram::new(&(0..8000).map(burst).collect::<Vec<f64>>(), &tone, 0.0, step).unwrap();
        assert!(found.decibels.len() >= COLUMNS - 2 && found.range_hz[1] < 120.0, "{:?}", found.range_hz);
        let rows = found.decibels[0].len();
        let window = (5.75 / 8.0 * found.decibels.len() as f64) as usize;
        let loudest =
            (0..rows).max_by(|&a, &b| found.decibels[window][a].total_cmp(&found.decibels[window][b])).unwrap();
        let frequency = (loudest as f64 + 0.5) * found.range_hz[1] / rows as f64;
        assert!((frequency - 50.0).abs() < 4.0, "{frequency}");
        assert!((found.decibels[window][loudest] + 20.0).abs() < 1.0, "{}", found.decibels[window][loudest]);
        assert!(found.decibels[2].iter().all(|d| *d < -100.0));
        // The cell of the burst alone lies where it lies in the whole.
        let cell = found.part([window..window + 1, loudest..loudest + 1]);
        assert!((cell.range_hz[0] + cell.range_hz[1] - 2.0 * frequency).abs() < 1e-9, "{:?}", cell.range_hz);
        assert!(cell.time_s[0] <= 5.75 && 5.75 <= cell.time_s[1], "{:?}", cell.time_s);
        assert_eq!(cell.decibels, [[found.decibels[window][loudest]]]);
    }
}

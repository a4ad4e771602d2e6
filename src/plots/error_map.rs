//! The error map as numbers: which run stands in which column, which channel in which row, and where a value stands on the
//! scale of colours.

use super::drawing::{Drawing, Stroke};
use super::style::{self, Palette, size};
use crate::diagnosis::Comparison;
use crate::display::format;
use ecolor::Color32;
use emath::{Align2, Rect, pos2, vec2};
use std::ops::Range;

/// Name of the only row where there is no response to predict.
pub const ENERGY: &str = "energy";

/// One cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Relative error.
    pub error: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
}

impl Cell {
    /// Errors up to this many noise floors are those of noise: a single channel of a single run scatters.
    const NOISE: f64 = 2.0;

    /// Whether the error is no more than noise makes.
    pub fn is_noise(self) -> bool {
        self.error <= Self::NOISE * self.noise_floor
    }
}

/// Runs (columns) by channels (rows).
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Run of each column, as its index in the project.
    pub runs: Vec<usize>,
    /// Whether each of them takes part.
    pub used: Vec<bool>,
    /// Channel of each row.
    pub channels: Vec<String>,
    /// `cells[row][column]`; none where the run lacks the channel.
    pub cells: Vec<Vec<Option<Cell>>>,
}

impl Grid {
    /// The map of a comparison, worst runs first and worst channels on top, or in the order of the project. Its cost
    /// goes with the number of cells.
    pub fn new(comparison: &Comparison, worst_first: bool) -> Self {
        let runs = &comparison.runs;
        let (mut channels, numbers) = numbered(comparison);
        let mut order: Vec<usize> = (0..runs.len()).collect();
        let mut rows: Vec<usize> = (0..channels.len()).collect();
        if worst_first {
            order.sort_by(|&a, &b| {
                let (a, b) = (&runs[a], &runs[b]);
                b.used.cmp(&a.used).then(b.error.total_cmp(&a.error))
            });
            let mut squares = vec![0.0; channels.len()];
            for (run, own) in runs.iter().zip(&numbers).filter(|(run, _)| run.used) {
                run.channels.iter().zip(own).for_each(|(c, &k)| squares[k] += c.error * c.error);
            }
            rows.sort_by(|&a, &b| squares[b].total_cmp(&squares[a]));
        }
        let mut row_of = vec![0; channels.len()];
        rows.iter().enumerate().for_each(|(row, &k)| row_of[k] = row);
        if channels.is_empty() {
            (channels, rows) = (vec![ENERGY.to_owned()], vec![0]);
        }
        let mut cells = vec![vec![None; runs.len()]; rows.len()];
        for (column, &k) in order.iter().enumerate() {
            let run = &runs[k];
            if run.channels.is_empty() {
                let whole = Some(Cell { error: run.error, noise_floor: comparison.noise_floor });
                cells.iter_mut().for_each(|row| row[column] = whole);
            }
            for (c, &number) in run.channels.iter().zip(&numbers[k]) {
                let cell = &mut cells[row_of[number]][column];
                *cell = cell.or(Some(Cell { error: c.error, noise_floor: c.noise_floor }));
            }
        }
        Self {
            runs: order.iter().map(|&k| runs[k].index).collect(),
            used: order.iter().map(|&k| runs[k].used).collect(),
            channels: rows.iter().map(|&k| channels[k].clone()).collect(),
            cells,
        }
    }
}

impl Grid {
    /// Those columns and rows alone.
    #[must_use]
    pub fn part(&self, [columns, rows]: [Range<usize>; 2]) -> Self {
        Self {
            runs: self.runs[columns.clone()].to_vec(),
            used: self.used[columns.clone()].to_vec(),
            channels: self.channels[rows.clone()].to_vec(),
            cells: self.cells[rows].iter().map(|row| row[columns.clone()].to_vec()).collect(),
        }
    }
}

/// All channels in the order in which the runs name them first, and the numbers in that list of the channels of every run.
fn numbered(comparison: &Comparison) -> (Vec<String>, Vec<Vec<usize>>) {
    let mut channels: Vec<String> = Vec::new();
    let mut numbers = Vec::with_capacity(comparison.runs.len());
    for run in &comparison.runs {
        let mut own = Vec::with_capacity(run.channels.len());
        for (place, c) in run.channels.iter().enumerate() {
            // Nearly all runs have the same channels in the same order.
            let there = channels.get(place).is_some_and(|name| *name == c.channel).then_some(place);
            own.push(there.or_else(|| channels.iter().position(|name| *name == c.channel)).unwrap_or_else(|| {
                channels.push(c.channel.clone());
                channels.len() - 1
            }));
        }
        numbers.push(own);
    }
    (channels, numbers)
}

/// Logarithmic scale of colours from the noise floor to the largest error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Noise floor, a share.
    pub floor: f64,
    /// Largest error, a share.
    pub most: f64,
}

impl Scale {
    /// From `floor` to `most`, at least a factor of ten apart, so that scatter about the noise does not fill the scale.
    pub fn new(floor: f64, most: f64) -> Self {
        let floor = if floor > 0.0 { floor } else { 1e-4 };
        Self { floor, most: most.max(10.0 * floor) }
    }

    /// Where an error stands: 0 at the floor, 1 at the largest.
    pub fn share(&self, error: f64) -> f32 {
        ((error / self.floor).max(1e-12).ln() / (self.most / self.floor).ln()).clamp(0.0, 1.0) as f32
    }

    /// Round errors between the ends, for the legend.
    pub fn ticks(&self) -> Vec<f64> {
        let every = ((self.most / self.floor).log10() / 6.0).ceil().max(1.0) as i32;
        let decades = (self.floor.log10().floor() as i32)..=(self.most.log10().ceil() as i32);
        let fine = self.most / self.floor < 40.0;
        let round = |d: i32| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d));
        let inside = |v: &f64| *v > 1.12 * self.floor && *v <= self.most;
        let decade = |v: &f64| (v.log10() - v.log10().round()).abs() < 1e-9 && v.log10().round() as i32 % every == 0;
        let plain = |v: &f64| fine || decade(v);
        decades.flat_map(round).filter(inside).filter(plain).collect()
    }
}

/// Colour of a cell.
pub fn shade(palette: &Palette, scale: &Scale, cell: Cell) -> Color32 {
    if cell.is_noise() { palette.raised } else { palette.error_shade(scale.share(cell.error)) }
}

/// The error in a cell, in %.
pub fn percent(cell: Cell) -> String {
    if cell.error > 10.0 { "> 1000".to_owned() } else { format::significant(100.0 * cell.error, 2) }
}

/// Runs that stand side by side on paper; the others follow below.
const ACROSS: usize = 24;

impl Grid {
    /// The map on paper, with the noise floor in its title; cells in %.
    pub fn draw(&self, scale: &Scale, title: &str, palette: &Palette) -> Drawing {
        let label = 14.0 + 6.4 * self.channels.iter().map(|c| c.chars().count()).max().unwrap_or(0) as f32;
        let columns = self.runs.len().clamp(1, ACROSS) as f32;
        let cell = vec2(((868.0 - label) / columns).clamp(20.0, 52.0), 22.0);
        let band = 30.0 + cell.y * self.channels.len() as f32;
        let bands = self.runs.len().div_ceil(ACROSS).max(1);
        let paper = vec2(900.0, 64.0 + band * bands as f32 + 12.0);
        let mut drawing = Drawing::new(paper, palette.canvas, title);
        drawing.words(pos2(16.0, 20.0), Align2::LEFT_CENTER, title, size::HEADING, palette.ink);
        let remark = format!("Error in %, grey: within twice the noise. Noise floor {}.", format::percent(scale.floor));
        drawing.words(pos2(16.0, 42.0), Align2::LEFT_CENTER, remark, size::SMALL, palette.weak);
        for (k, columns) in (0..self.runs.len()).collect::<Vec<_>>().chunks(ACROSS).enumerate() {
            let corner = pos2(16.0 + label, 64.0 + band * k as f32 + 20.0);
            for (row, name) in self.channels.iter().enumerate() {
                let at = pos2(corner.x - 8.0, corner.y + (row as f32 + 0.5) * cell.y);
                drawing.words(at, Align2::RIGHT_CENTER, name.clone(), size::SMALL, palette.ink);
            }
            for (x, &column) in columns.iter().enumerate() {
                let left = corner.x + x as f32 * cell.x;
                let head = pos2(left + 0.5 * cell.x, corner.y - 10.0);
                let run = (self.runs[column] + 1).to_string();
                drawing.words(head, Align2::CENTER_CENTER, run, size::SMALL, palette.weak);
                for (row, cells) in self.cells.iter().enumerate() {
                    let at = pos2(left, corner.y + row as f32 * cell.y);
                    let rect = Rect::from_min_size(at, cell).shrink(0.5);
                    let Some(found) = cells[column] else {
                        drawing.rect(rect, Color32::TRANSPARENT, style::hair(palette.line));
                        continue;
                    };
                    let fill = shade(palette, scale, found);
                    drawing.rect(rect, fill, Stroke::NONE);
                    let ink = if self.used[column] { palette.text_on(fill) } else { palette.weak };
                    let words = if self.used[column] { percent(found) } else { "×".to_owned() };
                    drawing.words(rect.center(), Align2::CENTER_CENTER, words, size::SMALL - 1.0, ink);
                }
            }
        }
        drawing
    }

    /// The map as a table with tabs: a row a channel, a column a run, errors as shares.
    pub fn table(&self) -> String {
        let mut text = "channel".to_owned();
        self.runs.iter().for_each(|run| text += &format!("\trun {}", run + 1));
        for (name, cells) in self.channels.iter().zip(&self.cells) {
            text += &format!("\n{name}");
            cells.iter().for_each(|cell| text += &cell.map_or_else(|| "\t".to_owned(), |c| format!("\t{:e}", c.error)));
        }
        text + "\n"
    }
}

/// A comparison with nothing but an error, its noise floor of 1 % and runs.
#[cfg(test)]
pub fn bare(error: f64, runs: Vec<crate::diagnosis::residual::comparison::RunComparison>) -> Comparison {
    let [levels, channels, harmonics] = [Vec::new(), Vec::new(), Vec::new()];
    let (noise_floor, energy_error, whiteness, unpredicted) = (0.01, 0.0, Vec::new(), Vec::new());
    Comparison { error, noise_floor, energy_error, runs, unpredicted, levels, channels, harmonics, whiteness }
}

#[cfg(test)]
mod tests {
    use super::{Cell, ENERGY, Grid, Scale};
    use crate::diagnosis::Comparison;
    use crate::diagnosis::residual::comparison::{ChannelComparison, RunComparison};

    fn comparison() -> Comparison {
        let channel = |name: &str, dof, error| ChannelComparison {
            channel: name.to_owned(),
            dof,
            error,
            noise_floor: 0.01,
            scale: 1.0,
            harmonics: Vec::new(),
        };
        let run = |index, used, errors: [f64; 2]| RunComparison {
            index,
            used,
            error: errors[0].hypot(errors[1]),
            noise_floor: 0.01,
            branch: None,
            energy_error: 0.0,
            channels: vec![channel("acc@1", 0, errors[0]), channel("acc@2", 1, errors[1])],
        };
        let runs = vec![run(0, true, [0.02, 0.1]), run(1, false, [0.9, 0.9]), run(2, true, [0.1, 0.3])];
        super::bare(0.2, runs)
    }

    #[test]
    fn the_worst_used_run_stands_first_and_unused_runs_last() {
        let grid = Grid::new(&comparison(), true);
        assert_eq!(grid.runs, [2, 0, 1]);
        assert_eq!(grid.used, [true, true, false]);
        assert_eq!(grid.channels, ["acc@2", "acc@1"]);
        assert_eq!(grid.cells[0][0], Some(Cell { error: 0.3, noise_floor: 0.01 }));
        let part = grid.part([1..3, 0..1]);
        assert_eq!((part.runs.as_slice(), part.channels.as_slice()), (&[0, 1][..], &["acc@2".to_owned()][..]));
        assert_eq!(
            part.cells,
            [[Some(Cell { error: 0.1, noise_floor: 0.01 }), Some(Cell { error: 0.9, noise_floor: 0.01 })]]
        );
        let plain = Grid::new(&comparison(), false);
        assert_eq!((plain.runs, plain.channels[0].as_str()), (vec![0, 1, 2], "acc@1"));
    }

    /// Channels that runs name in other orders, or lack, stand in the rows of their names.
    #[test]
    fn every_cell_holds_the_error_of_its_run_and_channel() {
        let mut mixed = comparison();
        mixed.runs[1].channels.reverse();
        mixed.runs[2].channels.remove(0);
        for worst_first in [true, false] {
            let grid = Grid::new(&mixed, worst_first);
            for (row, name) in grid.channels.iter().enumerate() {
                for (column, &run) in grid.runs.iter().enumerate() {
                    let own = mixed.runs[run].channels.iter().find(|c| c.channel == *name);
                    assert_eq!(grid.cells[row][column].map(|c| c.error), own.map(|c| c.error), "{name}, run {run}");
                }
            }
        }
    }

    #[test]
    fn energies_of_points_have_one_row() {
        let mut points = comparison();
        points.runs.iter_mut().for_each(|r| r.channels.clear());
        let grid = Grid::new(&points, true);
        assert_eq!(grid.channels, [ENERGY]);
        assert!(grid.cells[0].iter().all(Option::is_some));
    }

    #[test]
    fn the_scale_runs_from_the_noise_to_the_largest_error() {
        let scale = Scale::new(0.003, 0.3);
        assert!(scale.share(0.003).abs() < 1e-6 && (scale.share(0.3) - 1.0).abs() < 1e-6);
        assert!((scale.share(0.03) - 0.5).abs() < 1e-6);
        assert_eq!(scale.ticks(), [0.01, 0.1]);
        assert!(Cell { error: 0.015, noise_floor: 0.01 }.is_noise());
        assert!(!Cell { error: 0.03, noise_floor: 0.01 }.is_noise());
        assert_eq!(Scale::new(0.0, 0.0).share(f64::NAN).to_string(), "0", "nothing to see is at the floor");
    }
}

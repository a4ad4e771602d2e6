//! The error map as numbers: which run stands in which column, which channel in which row, and where a value stands on the
//! scale of colours.

use crate::diagnosis::Comparison;

/// Name of the only row where there is no response to predict.
pub const ENERGY: &str = "energy";

/// An error in words; beyond ten times the measurement its size says nothing more.
pub fn in_words(error: f64) -> String {
    if error > 10.0 { "> 1000 %".to_owned() } else { crate::window::format::percent(error) }
}

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
    /// The map of a comparison, worst runs first and worst channels on top, or in the order of the project.
    pub fn new(comparison: &Comparison, worst_first: bool) -> Self {
        let mut channels: Vec<String> = Vec::new();
        for name in comparison.runs.iter().flat_map(|r| r.channels.iter().map(|c| &c.channel)) {
            if !channels.contains(name) {
                channels.push(name.clone());
            }
        }
        if channels.is_empty() {
            channels.push(ENERGY.to_owned());
        }
        let mut order: Vec<usize> = (0..comparison.runs.len()).collect();
        if worst_first {
            let key = |k: &usize| (comparison.runs[*k].used, comparison.runs[*k].error);
            order.sort_by(|a, b| {
                let ((used_a, a), (used_b, b)) = (key(a), key(b));
                used_b.cmp(&used_a).then(b.total_cmp(&a))
            });
            let mean = |name: &str| {
                let used = comparison.runs.iter().filter(|r| r.used);
                let square = |c: &crate::diagnosis::compare::ChannelComparison| c.error * c.error;
                used.flat_map(|r| r.channels.iter().filter(|c| c.channel == name).map(square)).sum::<f64>()
            };
            channels.sort_by(|a, b| mean(b).total_cmp(&mean(a)));
        }
        let cell = |name: &str, k: usize| {
            let run = &comparison.runs[k];
            if run.channels.is_empty() {
                return Some(Cell { error: run.error, noise_floor: comparison.noise_floor });
            }
            let channel = run.channels.iter().find(|c| c.channel == name)?;
            Some(Cell { error: channel.error, noise_floor: channel.noise_floor })
        };
        let cells = channels.iter().map(|name| order.iter().map(|&k| cell(name, k)).collect()).collect();
        Self {
            runs: order.iter().map(|&k| comparison.runs[k].index).collect(),
            used: order.iter().map(|&k| comparison.runs[k].used).collect(),
            channels,
            cells,
        }
    }
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

/// A comparison with nothing but an error, its noise floor of 1 % and runs.
#[cfg(test)]
pub fn bare(error: f64, runs: Vec<crate::diagnosis::compare::RunComparison>) -> Comparison {
    let [levels, channels, harmonics] = [Vec::new(), Vec::new(), Vec::new()];
    let (noise_floor, energy_error, whiteness) = (0.01, 0.0, Vec::new());
    Comparison { error, noise_floor, energy_error, runs, levels, channels, harmonics, whiteness }
}

#[cfg(test)]
mod tests {
    use super::{Cell, ENERGY, Grid, Scale};
    use crate::diagnosis::Comparison;
    use crate::diagnosis::compare::{ChannelComparison, RunComparison};

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
        let plain = Grid::new(&comparison(), false);
        assert_eq!((plain.runs, plain.channels[0].as_str()), (vec![0, 1, 2], "acc@1"));
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

//! The error of a comparison, seen by level, channel and harmonic.

use crate::diagnosis::residual::comparison::{ChannelComparison, RunComparison};
use crate::math::statistics::root_mean_square;

/// Error of one part of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Label of the level, name of the channel, order of the harmonic.
    pub name: String,
    /// Root mean square relative error over its used runs and channels.
    pub error: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// Number of used runs in it.
    pub runs: usize,
}

/// Errors collected under one name.
struct Collected {
    name: String,
    errors: Vec<f64>,
    floors: Vec<f64>,
    runs: Vec<usize>,
}

/// Groups in the order in which they come.
#[derive(Default)]
struct Collector(Vec<Collected>);

impl Collector {
    fn add(&mut self, name: &str, run: usize, error: f64, floor: f64) {
        let at = self.0.iter().position(|c| c.name == name).unwrap_or_else(|| {
            self.0.push(Collected { name: name.to_owned(), errors: Vec::new(), floors: Vec::new(), runs: Vec::new() });
            self.0.len() - 1
        });
        let collected = &mut self.0[at];
        collected.errors.push(error);
        collected.floors.push(floor);
        if collected.runs.last() != Some(&run) {
            collected.runs.push(run);
        }
    }

    fn groups(self) -> Vec<Group> {
        let group = |c: Collected| Group {
            error: root_mean_square(&c.errors),
            noise_floor: root_mean_square(&c.floors),
            runs: c.runs.len(),
            name: c.name,
        };
        self.0.into_iter().map(group).collect()
    }
}

fn used(runs: &[RunComparison]) -> impl Iterator<Item = (&RunComparison, &ChannelComparison)> {
    runs.iter().filter(|run| run.used).flat_map(|run| run.channels.iter().map(move |channel| (run, channel)))
}

/// By the level of each run, of the name given for it; runs without channels count with their own error.
pub(crate) fn by_level(runs: &[RunComparison], name: impl Fn(&RunComparison) -> String) -> Vec<Group> {
    let mut collector = Collector::default();
    for run in runs.iter().filter(|run| run.used) {
        let name = name(run);
        if run.channels.is_empty() {
            collector.add(&name, run.index, run.error, run.noise_floor);
        }
        for channel in &run.channels {
            collector.add(&name, run.index, channel.error, channel.noise_floor);
        }
    }
    collector.groups()
}

/// By channel.
pub(crate) fn by_channel(runs: &[RunComparison]) -> Vec<Group> {
    let mut collector = Collector::default();
    used(runs).for_each(|(run, c)| collector.add(&c.channel, run.index, c.error, c.noise_floor));
    collector.groups()
}

/// By harmonic: what each contributes to the errors of the channels.
pub(crate) fn by_harmonic(runs: &[RunComparison]) -> Vec<Group> {
    let mut collector = Collector::default();
    for (run, channel) in used(runs).filter(|(_, channel)| channel.scale > 0.0) {
        for h in &channel.harmonics {
            let error = (h.measured - h.model).norm() / channel.scale;
            let floor = std::f64::consts::SQRT_2 * h.deviation / channel.scale;
            collector.add(&h.harmonic.to_string(), run.index, error, floor);
        }
    }
    collector.groups()
}

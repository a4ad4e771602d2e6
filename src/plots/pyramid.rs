//! Long records drawn fast: minimum and maximum of blocks of samples, level over level, so that a frame touches about as
//! many numbers as it has columns of pixels.

use crate::measurement::Record;
use std::sync::Arc;

/// Samples in a block of the lowest level.
const BLOCK: usize = 16;
/// Blocks in a block of the next level.
const RATIO: usize = 4;

/// Where the samples are: of its own, or those of a record, which are never copied.
#[derive(Debug, Clone, PartialEq)]
enum Samples {
    Own(Vec<f64>, Vec<f64>),
    Row(Arc<Record>, usize),
    Beside(Arc<Record>, Vec<f64>),
}

impl Samples {
    fn time(&self) -> &[f64] {
        match self {
            Self::Own(time, _) => time,
            Self::Row(record, _) | Self::Beside(record, _) => record.time(),
        }
    }

    fn values(&self) -> &[f64] {
        match self {
            Self::Own(_, values) | Self::Beside(_, values) => values,
            Self::Row(record, row) => record.samples(*row),
        }
    }
}

/// Extremes of blocks at every level, beside the samples themselves.
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    samples: Samples,
    levels: Vec<Vec<[f64; 2]>>,
}

impl Pyramid {
    /// Of samples of its own; `time` increases and is as long as `samples`.
    pub fn new(time: &[f64], samples: &[f64]) -> Self {
        Self::build(Samples::Own(time.to_vec(), samples.to_vec()))
    }

    /// Of a row of a record.
    pub fn of_record(record: Arc<Record>, row: usize) -> Self {
        Self::build(Samples::Row(record, row))
    }

    /// Of other values at the times of a record.
    pub fn beside(record: Arc<Record>, values: Vec<f64>) -> Self {
        Self::build(Samples::Beside(record, values))
    }

    fn build(samples: Samples) -> Self {
        let extremes = |block: &[f64]| {
            block.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &v| [low.min(v), high.max(v)])
        };
        let mut levels: Vec<Vec<[f64; 2]>> = vec![samples.values().chunks(BLOCK).map(extremes).collect()];
        while let Some(top) = levels.last().filter(|top| top.len() > 512) {
            let join = |block: &[[f64; 2]]| {
                block.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [low, high]| [a.min(*low), b.max(*high)])
            };
            let next = top.chunks(RATIO).map(join).collect();
            levels.push(next);
        }
        Self { samples, levels }
    }

    /// A polyline for the samples between `from` and `to` that looks the same as all of them on `columns` columns of pixels.
    pub fn polyline(&self, from: f64, to: f64, columns: usize) -> Vec<[f64; 2]> {
        let (time, samples) = (self.samples.time(), self.samples.values());
        let first = time.partition_point(|&t| t < from).saturating_sub(1);
        let last = (time.partition_point(|&t| t <= to) + 1).min(time.len());
        if first >= last {
            return Vec::new();
        }
        let most = 4 * columns.max(1);
        if last - first <= most {
            return (first..last).map(|i| [time[i], samples[i]]).collect();
        }
        let mut size = BLOCK;
        let mut level = 0;
        while level + 1 < self.levels.len() && (last - first) / (size * RATIO) >= columns {
            size *= RATIO;
            level += 1;
        }
        let block = |b: usize| {
            let [low, high] = self.levels[level][b];
            let t = time[(b * size).min(time.len() - 1)];
            [[t, low], [t, high]]
        };
        (first / size..last.div_ceil(size)).flat_map(block).collect()
    }

    /// Least and greatest sample.
    pub fn range(&self) -> [f64; 2] {
        let top = self.levels.last().into_iter().flatten();
        top.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [low, high]| [a.min(*low), b.max(*high)])
    }

    /// Times of the first and of the last sample.
    pub fn span(&self) -> [f64; 2] {
        let time = self.samples.time();
        [time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::Pyramid;

    fn spiky(n: usize) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..n).map(|k| k as f64 * 1e-3).collect();
        let samples = (0..n).map(|k| if k == n / 3 { 9.0 } else { (k as f64 * 0.37).sin() }).collect();
        (time, samples)
    }

    #[test]
    fn a_spike_of_one_sample_is_never_lost() {
        let (time, samples) = spiky(300_000);
        let pyramid = Pyramid::new(&time, &samples);
        for columns in [100, 700, 2000] {
            let line = pyramid.polyline(0.0, 300.0, columns);
            assert!(line.iter().any(|p| p[1] == 9.0), "{columns} columns");
            assert!(line.len() <= 12 * columns, "{} points for {columns} columns", line.len());
        }
    }

    #[test]
    fn close_up_it_shows_every_sample() {
        let (time, samples) = spiky(10_000);
        let line = Pyramid::new(&time, &samples).polyline(1.0, 1.1, 500);
        assert!(line.len() >= 100);
        for p in &line {
            let k = (p[0] * 1e3).round() as usize;
            assert_eq!(p[1], samples[k]);
        }
        assert!(line[0][0] <= 1.0 && line[line.len() - 1][0] >= 1.1, "it reaches over both edges");
    }
}

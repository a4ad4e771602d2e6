//! Multiple shooting (Bock 1983): records in segments, each with an initial state of its own. Over a segment a model that is off loses no
//! phase, while the segments together hold the amplitudes of the whole record.
//!
//! Segments grow by [`GROWTH`] from level to level until one would be half of the record; the last level is the whole
//! record. Decays are decimated to the samples that their motion needs.

use super::compare::struck;
use super::data::{RecordData, Records};
use super::evidence::alike;
use super::weights::local;

/// Periods of the dominant motion in the shortest segments, and in those of a body that floats: no spring brings it back, so that an error
/// of the force moves it by the square of the time.
const PERIODS: f64 = 8.0;
const PERIODS_FLOATING: f64 = 0.25;
/// Least length of a segment, as a share of that many periods of the dominant motion: two periods hold its amplitude and its damping.
const LEAST_SHARE: f64 = 0.25;
/// Ratio of the lengths of segments from one level to the next.
const GROWTH: f64 = 3.0;
/// Most segments of a record and of all records; more records than that have one segment each.
const MOST: usize = 5;
const MOST_OF_ALL: usize = 8;
/// Share of the motion that the segments hold, where it is short enough for it.
const COVERED: f64 = 0.5;
/// Least share of the largest motion, and least ratio to the noise, at which a segment may begin.
const QUIET: f64 = 0.03;
const ABOVE_NOISE: f64 = 6.0;
/// Samples of a decay that a period of its highest motion needs in a segment.
const SAMPLES: f64 = 24.0;
/// Phase of the highest motion, rad, that a step of the model may cover in a segment and in a whole record.
const STEP_PHASE: [f64; 2] = [0.4, 0.2];
/// Samples of all channels of all segments that are enough for a search, and samples over which what a model leaves stays alike for each
/// that is kept: eight of them tell all that there is.
const ENOUGH: usize = 16_000;
const ALIKE: f64 = 8.0;
/// Fewest samples of a segment.
const FEWEST: usize = 48;

impl Records<'_> {
    /// The records in segments of growing length, at last whole.
    pub(super) fn levels(&self) -> Vec<Self> {
        let mut levels = Vec::new();
        let mut periods = if self.floats() { PERIODS_FLOATING } else { PERIODS };
        while let Some(segments) = self.in_segments(periods) {
            levels.push(segments.with_enough_samples());
            periods *= GROWTH;
        }
        let whole = self.list.iter().map(|r| r.segment(0, r.len(), STEP_PHASE[1])).collect();
        levels.push(Self { list: whole, ..self.clone() }.with_enough_samples());
        levels
    }

    /// The same with as many samples of the channels as tell: of many, of which what a model leaves stays alike over [`ALIKE`] times as
    /// many, one in a few. The forces keep theirs.
    fn with_enough_samples(mut self) -> Self {
        let most = (self.samples() / ENOUGH).min((alike(&self, 1.0) / ALIKE) as usize).max(1);
        // Steps of the model may be as long as that, by powers of two.
        let every = 1 << most.ilog2();
        if every > 1 {
            self.list.iter_mut().for_each(|record| record.thin(every));
        }
        self
    }

    /// Segments of `periods` periods of the dominant motion; `None` where they are half of every record.
    fn in_segments(&self, periods: f64) -> Option<Self> {
        let most = (MOST_OF_ALL / self.list.len()).clamp(1, MOST);
        let cut: Vec<Vec<RecordData>> = self.list.iter().map(|r| segments(r, periods, most)).collect();
        let seconds = |r: &RecordData| r.step * r.len() as f64;
        let shorter = cut.iter().zip(&self.list).any(|(segments, whole)| 2.0 * seconds(&segments[0]) <= seconds(whole));
        shorter.then(|| Self { list: cut.into_iter().flatten().collect(), ..self.clone() })
    }
}

/// At most `most` segments of a record, evenly spread over its motion; the first follows a blow to its end.
fn segments(record: &RecordData, periods: f64, most: usize) -> Vec<RecordData> {
    // Free motion that is mostly faster than its highest peak needs shorter segments: phase is lost by its own periods.
    let is_free = record.forces.is_empty() || struck(record).is_some();
    let fast_hz = if is_free { record.median_hz.min(record.dominant_hz / LEAST_SHARE) } else { record.dominant_hz };
    let seconds = periods / fast_hz;
    let length = ((seconds / record.step) as usize).max(FEWEST);
    let blow = struck(record).map_or(0, |end| (end * record.len() as f64) as usize);
    let first = (blow + length).min(record.len());
    let free = active(record, length).saturating_sub(first);
    let count = ((COVERED * (first + free) as f64 / length as f64).ceil() as usize).clamp(1, most);
    let mut ends: Vec<usize> = (1..count).map(|k| first + k * free / (count - 1)).collect();
    ends.retain(|end| *end >= first + length / 2);
    // What acts only where the motion is large must be seen, as in a sweep through a resonance.
    let loud = (loudest(record, length) + length / 2).min(record.len());
    if loud > first + length / 2
        && let Some(nearest) = ends.iter_mut().min_by_key(|end| end.abs_diff(loud))
    {
        *nearest = loud;
    }
    let later = ends.into_iter().map(|end| record.segment(end - length.min(end), end, STEP_PHASE[0]));
    std::iter::once(record.segment(0, first, STEP_PHASE[0])).chain(later).collect()
}

/// Number of the sample about which the motion is largest, in the channel that shows most of it.
fn loudest(record: &RecordData, length: usize) -> usize {
    let peak_of_channel = |c: usize| {
        let sizes = local(&record.samples[c], (length / 4).max(1));
        let at = (0..sizes.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).unwrap_or(0);
        (sizes[at] / record.noise[c], at)
    };
    (0..record.channels.len()).map(peak_of_channel).max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, at)| at)
}

/// Samples up to the end of the motion that stands out.
fn active(record: &RecordData, length: usize) -> usize {
    let half = (length / 4).max(1);
    let size = |c: usize| local(&record.samples[c], half);
    let stands_out = |c: usize| {
        let sizes = size(c);
        let greatest = sizes.iter().fold(0.0_f64, |m, x| m.max(*x));
        let least = (QUIET * greatest).max(ABOVE_NOISE * record.noise[c]);
        sizes.iter().rposition(|x| *x >= least).unwrap_or(0)
    };
    (0..record.channels.len()).map(stands_out).max().unwrap_or(0) + 1
}

impl RecordData {
    /// Samples `from..to`, of a decay no more than its motion needs; steps of the model cover no more than `phase` rad of it.
    fn segment(&self, from: usize, to: usize, phase: f64) -> Self {
        let every = if self.forces.is_empty() { self.spare() } else { 1 };
        let shortened = |lists: &[Vec<f64>]| -> Vec<Vec<f64>> {
            lists.iter().map(|list| list[from..to].iter().copied().step_by(every).collect()).collect()
        };
        Self {
            index: self.index,
            file: self.file.clone(),
            run: self.run.clone(),
            kind: self.kind,
            first_s: self.first_s + from as f64 * self.step,
            step: self.step * every as f64,
            channels: self.channels.clone(),
            samples: shortened(&self.samples),
            means: self.means.clone(),
            largest: self.largest.clone(),
            drives: self.drives.clone(),
            forces: shortened(&self.forces),
            every: self.every,
            settled: Vec::new(),
            noise: self.noise.clone(),
            sigma: shortened(&self.sigma),
            by_force: Vec::new(),
            scatter: self.scatter,
            substeps: self.steps_between(self.step * every as f64, phase),
            dominant_hz: self.dominant_hz,
            median_hz: self.median_hz,
            highest_hz: self.highest_hz,
        }
    }

    /// Keeps one of `every` samples of the channels.
    fn thin(&mut self, every: usize) {
        self.settled = self.settled(every);
        for list in self.samples.iter_mut().chain(&mut self.sigma) {
            *list = list.iter().copied().step_by(every).collect();
        }
        self.every *= every;
        self.step *= every as f64;
    }

    /// One of how many samples is enough.
    fn spare(&self) -> usize {
        ((1.0 / (SAMPLES * self.highest_hz * self.step)) as usize).clamp(1, 64)
    }
}

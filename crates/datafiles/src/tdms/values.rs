//! Values of channels from where their segments lie, piece by piece; of interleaved rows several channels in one pass.

use super::objects::Run;
use super::scale::Scaling;
use crate::bytes::room;
use crate::error::{Fault, Read};
use std::fs::File;
use std::io::{BufReader, Read as _, Seek, SeekFrom};
use std::path::Path;
use uff::Values;

/// Bytes that are read at once from interleaved data.
const PIECE: u64 = 1 << 20;

/// A channel's data and what turns them into its numbers.
pub(super) struct Place {
    pub runs: Vec<Run>,
    pub scaling: Scaling,
    pub complex: bool,
}

/// The first `most` values of a channel.
pub(super) fn first(path: &Path, place: &Place, most: u64) -> Read<Values> {
    let mut found = read(path, &[place], most)?;
    found.pop().ok_or_else(|| Fault::new("there is no such channel"))
}

/// All values of channels whose values stand in the same rows.
pub(super) fn all(path: &Path, places: &[&Place]) -> Read<Vec<Values>> {
    read(path, places, u64::MAX)
}

/// Whether channels stand in the same rows throughout, so that one pass reads them all.
pub(super) fn interleaved(places: &[&Place]) -> bool {
    let Some((first, others)) = places.split_first() else { return false };
    let layout = |run: &Run| (run.count, run.last, run.chunks, run.chunk, run.stride);
    let beside = |(a, b): (&Run, &Run)| {
        layout(a) == layout(b) && a.stride > a.size() && a.start.abs_diff(b.start) + a.size().max(b.size()) <= a.stride
    };
    others.iter().all(|other| other.runs.len() == first.runs.len() && first.runs.iter().zip(&other.runs).all(beside))
        && first.runs.iter().enumerate().all(|(i, _)| extent(&runs(places, i)) <= first.runs[i].stride)
}

/// Run number `i` of every channel.
fn runs<'a>(places: &[&'a Place], i: usize) -> Vec<&'a Run> {
    places.iter().filter_map(|place| place.runs.get(i)).collect()
}

/// Bytes from the first value of a row to the end of the last one.
fn extent(runs: &[&Run]) -> u64 {
    let start = runs.iter().map(|run| run.start).min().unwrap_or(0);
    runs.iter().map(|run| run.start - start + run.size()).max().unwrap_or(0)
}

/// The first `most` values of channels that share their rows.
fn read(path: &Path, places: &[&Place], most: u64) -> Read<Vec<Values>> {
    let mut file = BufReader::new(File::open(path)?);
    let Some(shared) = places.first() else { return Ok(Vec::new()) };
    let total = shared.runs.iter().map(Run::total).fold(0, u64::saturating_add).min(most);
    let numbers = |place: &&Place| room(total.saturating_mul(if place.complex { 2 } else { 1 }));
    let mut raws = places.iter().map(numbers).collect::<Read<Vec<_>>>()?;
    let mut left = total;
    for (i, run) in shared.runs.iter().enumerate() {
        let runs = runs(places, i);
        for chunk in 0..run.chunks {
            if left == 0 {
                break;
            }
            let count = run.count_in(chunk).min(left);
            piece(&mut file, &runs, chunk, count, &mut raws)?;
            left -= count;
        }
    }
    Ok(places.iter().zip(raws).map(|(place, raw)| finished(place, raw)).collect())
}

/// Numbers of a channel, scaled.
fn finished(place: &Place, mut raw: Vec<f64>) -> Values {
    if place.complex {
        return Values::Complex(raw.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect());
    }
    place.scaling.apply(&mut raw);
    Values::Real(raw)
}

/// The first `count` rows of a chunk.
fn piece(file: &mut BufReader<File>, runs: &[&Run], chunk: u64, count: u64, raws: &mut [Vec<f64>]) -> Read<()> {
    let Some(start) = runs.iter().map(|run| run.start).min() else { return Ok(()) };
    let (extent, stride) = (extent(runs), runs[0].stride.max(1));
    let at = start + chunk * runs[0].chunk;
    file.seek(SeekFrom::Start(at))?;
    let most = (PIECE / stride).max(1);
    let mut bytes = Vec::new();
    let mut done = 0;
    while done < count {
        let rows = most.min(count - done);
        // The last row ends with the last value, which may be the last of the file.
        let wanted = (rows - 1) * stride + extent;
        bytes.clear();
        file.by_ref().take(wanted).read_to_end(&mut bytes)?;
        if (bytes.len() as u64) < wanted {
            return Err(Fault::byte(at, "the data end before their count does; the file was cut short: copy it again"));
        }
        if done + rows < count {
            file.seek_relative((stride - extent) as i64)?;
        }
        for (run, raw) in runs.iter().zip(raws.iter_mut()) {
            let from = (run.start - start) as usize;
            let value = from..from + run.size() as usize;
            bytes.chunks(stride as usize).for_each(|row| run.value(&row[value.clone()], raw));
        }
        done += rows;
    }
    Ok(())
}

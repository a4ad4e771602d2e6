//! Channels of a data set, block by block: what is not asked for is not kept, and where the layout allows not read.

use super::fault::wrong;
use super::value::Value;
use crate::bytes::room;
use crate::error::{Fault, Read};
use crate::tree::{Cut, Flat};
use hdf5_reader::{Dataset, SliceInfo, SliceInfoElem};
use std::ops::Range;

/// Values that are read at once: 4 MB of them in memory.
const BLOCK: u64 = 1 << 18;

/// Where channels lie in a data set.
struct Layout<'a> {
    extents: &'a [u64],
    /// Extents of its chunks; none where the values lie in rows one after the other.
    chunk: Option<Vec<u64>>,
    /// Extent along which the samples run.
    along: usize,
    /// Indices of the first value of each channel.
    firsts: Vec<Vec<u64>>,
}

/// Values from index to index of each extent of a block of rows.
fn strides(extents: &[u64]) -> Option<Vec<u64>> {
    let mut strides = vec![1_u64; extents.len()];
    for axis in (1..extents.len()).rev() {
        strides[axis - 1] = strides[axis].checked_mul(extents[axis])?;
    }
    Some(strides)
}

impl<'a> Layout<'a> {
    fn new(dataset: &'a Dataset, cut: &Cut, channels: &[u64]) -> Option<Self> {
        let extents = dataset.shape();
        let strides = strides(extents)?;
        let along = (0..extents.len()).find(|&axis| extents[axis] == cut.count && strides[axis] == cut.stride)?;
        let first = |&channel: &u64| {
            let offset = cut.offset(channel);
            strides.iter().zip(extents).map(|(stride, extent)| offset / stride % extent.max(&1)).collect()
        };
        let chunk = dataset.chunks().filter(|chunk| chunk.len() == extents.len());
        let chunk = chunk.map(|chunk| chunk.iter().map(|&extent| u64::from(extent).max(1)).collect());
        Some(Self { extents, chunk, along, firsts: channels.iter().map(first).collect() })
    }

    /// Whether the same chunks, or the same rows, hold all the channels.
    fn together(&self) -> bool {
        let same = |axis: usize| {
            let piece = match &self.chunk {
                Some(chunk) => chunk[axis],
                None if axis > self.along => u64::MAX,
                None => 1,
            };
            self.firsts.windows(2).all(|pair| pair[0][axis] / piece == pair[1][axis] / piece)
        };
        (0..self.extents.len()).filter(|&axis| axis != self.along).all(same)
    }

    /// Indices of an extent that are read. A value of a contiguous row alone is no cheaper than the row.
    fn range(&self, axis: usize) -> Range<u64> {
        if self.chunk.is_none() && axis > self.along {
            return 0..self.extents[axis];
        }
        let indices = || self.firsts.iter().map(|first| first[axis]);
        indices().min().unwrap_or(0)..indices().max().unwrap_or(0) + 1
    }

    /// Samples that are read at once: whole chunks, each unpacked once.
    fn rows(&self, width: u64) -> u64 {
        let piece = self.chunk.as_ref().map_or(1, |chunk| chunk[self.along]);
        (BLOCK / width.saturating_mul(piece).max(1)).max(1).saturating_mul(piece)
    }
}

/// The values of channels in one pass; none where they do not run along one extent of the data set, or where several lie in
/// chunks of their own.
pub(super) fn columns(dataset: &Dataset, cut: &Cut, channels: &[u64], complex: bool) -> Option<Read<Vec<Flat>>> {
    let layout = Layout::new(dataset, cut, channels)?;
    layout.together().then(|| read(dataset, &layout, cut.count, complex))
}

fn read(dataset: &Dataset, layout: &Layout<'_>, count: u64, complex: bool) -> Read<Vec<Flat>> {
    let axes = 0..layout.extents.len();
    let mut ranges: Vec<Range<u64>> = axes.clone().map(|axis| layout.range(axis)).collect();
    let width = |range: &Range<u64>| range.end - range.start;
    let others = axes.clone().filter(|&axis| axis != layout.along);
    let rows = layout.rows(others.clone().map(|axis| width(&ranges[axis])).product());
    let mut found: Vec<Flat> = Vec::new();
    let mut from = 0;
    while from < count {
        ranges[layout.along] = from..from.saturating_add(rows).min(count);
        let slice = |range: &Range<u64>| SliceInfoElem::Slice { start: range.start, end: range.end, step: 1 };
        let selection = SliceInfo { selections: ranges.iter().map(slice).collect() };
        let block = dataset.read_slice::<Value>(&selection).map_err(wrong)?;
        if from == 0 {
            // Only what begins in the file is given memory.
            let flat = |_| Ok(Flat { re: room(count)?, im: room(if complex { count } else { 0 })? });
            found = layout.firsts.iter().map(flat).collect::<Read<_>>()?;
        }
        let extents: Vec<u64> = ranges.iter().map(width).collect();
        let strides = strides(&extents).unwrap_or_default();
        for (flat, first) in found.iter_mut().zip(&layout.firsts) {
            let start: u64 = others.clone().map(|axis| (first[axis] - ranges[axis].start) * strides[axis]).sum();
            for value in block.iter().skip(start as usize).step_by(strides[layout.along] as usize) {
                flat.re.push(value.0[0]);
                if complex {
                    flat.im.push(value.0[1]);
                }
            }
        }
        from = ranges[layout.along].end;
    }
    if found.iter().all(|flat| flat.re.len() as u64 == count) {
        Ok(found)
    } else {
        Err(Fault::new("has fewer values than its extents say; export it again"))
    }
}

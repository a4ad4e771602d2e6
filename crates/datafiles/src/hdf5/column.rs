//! One channel of a data set, block by block: what is not asked for is not kept, and where the layout allows not read.

use super::fault::wrong;
use super::value::Value;
use crate::bytes::room;
use crate::error::{Fault, Read};
use crate::tree::{Cut, Flat};
use hdf5_reader::{Dataset, SliceInfo, SliceInfoElem};

/// Values that are read at once: 4 MB of them in memory.
const BLOCK: u64 = 1 << 18;

/// Extents of a data set and where a channel lies in it.
struct Layout<'a> {
    extents: &'a [u64],
    /// Values from index to index of each extent.
    strides: Vec<u64>,
    /// Extent along which the samples run.
    along: usize,
    /// Indices of the channel's first value.
    first: Vec<u64>,
}

impl<'a> Layout<'a> {
    fn new(extents: &'a [u64], cut: &Cut, channel: u64) -> Option<Self> {
        let mut strides = vec![1_u64; extents.len()];
        for axis in (1..extents.len()).rev() {
            strides[axis - 1] = strides[axis].checked_mul(extents[axis])?;
        }
        let along = (0..extents.len()).find(|&axis| extents[axis] == cut.count && strides[axis] == cut.stride)?;
        let offset = cut.offset(channel);
        let first = strides.iter().zip(extents).map(|(stride, extent)| offset / stride % extent.max(&1)).collect();
        Some(Self { extents, strides, along, first })
    }

    /// The samples `from..to` of the channel, or with `wide` of all channels that lie between two of its samples.
    fn selection(&self, from: u64, to: u64, wide: bool) -> SliceInfo {
        let of = |axis: usize| match axis.cmp(&self.along) {
            std::cmp::Ordering::Equal => (from, to),
            std::cmp::Ordering::Greater if wide => (0, self.extents[axis]),
            _ => (self.first[axis], self.first[axis] + 1),
        };
        let slice = |(start, end)| SliceInfoElem::Slice { start, end, step: 1 };
        SliceInfo { selections: (0..self.extents.len()).map(of).map(slice).collect() }
    }
}

/// The values of a channel; none where it does not run along one extent of the data set.
pub(super) fn column(dataset: &Dataset, cut: &Cut, channel: u64, complex: bool) -> Option<Read<Flat>> {
    let layout = Layout::new(dataset.shape(), cut, channel)?;
    Some(read(dataset, &layout, cut.count, complex))
}

fn read(dataset: &Dataset, layout: &Layout<'_>, count: u64, complex: bool) -> Read<Flat> {
    // Chunks hold one channel or several and are unpacked once each; of contiguous rows a value alone is no cheaper than the row.
    let chunk = dataset.chunks().and_then(|chunks| chunks.get(layout.along).map(|&chunk| u64::from(chunk).max(1)));
    let stride = if chunk.is_some() { 1 } else { layout.strides[layout.along] };
    let rows = chunk.map_or_else(|| (BLOCK / stride).max(1), |chunk| (BLOCK / chunk).max(1) * chunk);
    let start =
        (layout.first.iter().zip(&layout.strides).skip(layout.along + 1)).map(|(i, stride)| i * stride).sum::<u64>();
    let start = if stride == 1 { 0 } else { start as usize };
    let mut flat = Flat { re: Vec::new(), im: Vec::new() };
    let mut from = 0;
    while from < count {
        let to = from.saturating_add(rows).min(count);
        let block = dataset.read_slice::<Value>(&layout.selection(from, to, stride > 1)).map_err(wrong)?;
        if from == 0 {
            // Only what begins in the file is given memory.
            flat = Flat { re: room(count)?, im: room(if complex { count } else { 0 })? };
        }
        for value in block.iter().skip(start).step_by(stride as usize) {
            flat.re.push(value.0[0]);
            if complex {
                flat.im.push(value.0[1]);
            }
        }
        from = to;
    }
    if flat.re.len() as u64 == count {
        Ok(flat)
    } else {
        Err(Fault::new("has fewer values than its extents say; export it again"))
    }
}

//! Files that are trees of named arrays (MAT, HDF5, NumPy): which arrays are channels of one set, which is their abscissa.

mod abscissa;
mod cells;
mod columns;
mod context;
mod headers;
mod labels;
mod names;
mod own_times;
mod points;
mod repeated;
mod sets;
mod source;
mod timeseries;

pub(crate) use cells::of_cell;
pub(crate) use names::{Sampling, sampling};
pub(crate) use sets::sets;
pub(crate) use source::{Arrays, Flat, TreeSource};
pub(crate) use timeseries::is_plain;

use crate::contents::FIRST;

/// Most channels that one array is cut into.
const MOST_CHANNELS: u64 = 4096;
/// The same of arrays of three and more extents, whose channels are those of many tests.
const MOST_OF_TESTS: u64 = 1 << 16;
/// Most values of an array that are read when its tree is made, to see whether an abscissa is even.
pub(crate) const MOST_CHECKED: u64 = 1 << 20;

/// A named part of a file.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub name: String,
    pub node: Node,
    /// Attributes as word and value.
    pub attributes: Vec<(String, String)>,
}

impl Entry {
    pub(crate) fn new(name: impl Into<String>, node: Node) -> Self {
        Self { name: name.into(), node, attributes: Vec::new() }
    }
}

/// What a part is.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    /// Further parts: a group, a struct.
    Group(Vec<Entry>),
    /// Numbers.
    Array(Array),
    /// Text, one or several.
    Text(Vec<String>),
    /// What is not read, and why.
    Skipped(String),
}

/// An array of numbers in the file.
#[derive(Debug, Clone)]
pub(crate) struct Array {
    /// Number under which [`Arrays`] reads it.
    pub id: usize,
    pub shape: Shape,
    pub complex: bool,
    /// The values at [`Shape::wanted`], in that order.
    pub peek: Vec<[f64; 2]>,
}

/// Extents of an array and the order of its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Extents without those of one.
    pub extents: Vec<u64>,
    /// Whether the first index runs fastest.
    pub column_major: bool,
}

/// How the values of an array are cut into channels: value `i` of channel `c` is at `offset(c) + i stride`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Cut {
    pub channels: u64,
    pub count: u64,
    pub stride: u64,
    inner: u64,
    outer: u64,
}

impl Cut {
    /// All of a vector as one channel.
    pub(crate) fn vector(count: u64) -> Self {
        Self { channels: 1, count, stride: 1, inner: 1, outer: 1 }
    }

    /// Place of the first value of a channel.
    pub(crate) fn offset(&self, channel: u64) -> u64 {
        // Channels run over the indices below and above that of the samples.
        channel % self.inner + channel / self.inner * self.outer
    }
}

impl Shape {
    pub(crate) fn new(extents: impl IntoIterator<Item = u64>, column_major: bool) -> Self {
        Self { extents: extents.into_iter().filter(|&extent| extent != 1).collect(), column_major }
    }

    /// Number of values, none where it overflows.
    pub(crate) fn len(&self) -> Option<u64> {
        self.extents.iter().try_fold(1_u64, |product, &extent| product.checked_mul(extent))
    }

    /// Whether it is a square matrix.
    pub(crate) fn is_square(&self) -> bool {
        matches!(self.extents[..], [a, b] if a == b)
    }

    /// Which extent is that of the samples: the first of length `samples`, else the longest.
    pub(crate) fn along(&self, samples: Option<u64>) -> Option<usize> {
        let said = samples.and_then(|samples| self.extents.iter().position(|&extent| extent == samples));
        said.or_else(|| (0..self.extents.len()).max_by_key(|&i| (self.extents[i], usize::MAX - i)))
    }

    /// Channels along the longest extent, or along the one of length `samples`; none where there are too many.
    pub(crate) fn cut(&self, samples: Option<u64>) -> Option<Cut> {
        let total = self.len()?;
        if total == 0 || self.extents.is_empty() {
            return Some(Cut::vector(total));
        }
        let along = self.along(samples)?;
        let count = self.extents[along];
        let fast = if self.column_major { &self.extents[..along] } else { &self.extents[along + 1..] };
        let stride: u64 = fast.iter().product();
        let channels = total / count;
        let most = if self.extents.len() > 2 { MOST_OF_TESTS } else { MOST_CHANNELS };
        (channels <= most).then_some(Cut { channels, count, stride, inner: stride, outer: stride * count })
    }

    /// Places of the values that a listing shows: the first of each channel, and the last of all.
    pub(crate) fn wanted(&self) -> Vec<u64> {
        let mut wanted = Vec::new();
        let total = self.len().unwrap_or(0);
        for along in 0..self.extents.len().max(1) {
            let Some(cut) = self.cut(self.extents.get(along).copied()) else { continue };
            // Many channels are shown along the longest extent alone.
            if cut.channels > MOST_CHANNELS && Some(along) != self.along(None) {
                continue;
            }
            for channel in 0..cut.channels {
                wanted.extend((0..cut.count.min(FIRST as u64)).map(|i| cut.offset(channel) + i * cut.stride));
            }
        }
        wanted.extend(total.checked_sub(1));
        wanted.sort_unstable();
        wanted.dedup();
        wanted
    }
}

impl Array {
    /// The value at a place, where it was kept.
    pub(crate) fn at(&self, place: u64) -> Option<[f64; 2]> {
        let wanted = self.shape.wanted();
        wanted.binary_search(&place).ok().and_then(|i| self.peek.get(i).copied())
    }

    /// The only value.
    pub(crate) fn scalar(&self) -> Option<f64> {
        (self.shape.len() == Some(1) && !self.complex).then(|| self.peek.first().map(|value| value[0]))?
    }

    /// Step of a long abscissa of `count` values by its first and last ones.
    pub(crate) fn step_of_peek(&self, count: u64) -> Option<f64> {
        let values: Vec<f64> = (0..3).chain([count - 1]).filter_map(|i| self.at(i)).map(|value| value[0]).collect();
        let [a, b, c, last] = values[..] else { return None };
        let step = (last - a) / (count - 1) as f64;
        let near = |difference: f64| (difference - step).abs() <= 0.01 * step.abs();
        (step > 0.0 && near(b - a) && near(c - b)).then_some(step)
    }

    /// Whether it has one extent.
    pub(crate) fn is_vector(&self) -> bool {
        self.shape.extents.len() == 1
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn arrays_are_cut_along_their_longest_extent() {
        // Row-major 5 samples of 2 channels: values 0..10, channel 1 at 1, 3, 5 ...
        let cut = Shape::new([5, 2], false).cut(None).unwrap();
        assert_eq!((cut.channels, cut.count, cut.stride, cut.offset(1)), (2, 5, 2, 1));
        // Column-major: channel 1 from 5 on.
        let cut = Shape::new([5, 2], true).cut(None).unwrap();
        assert_eq!((cut.stride, cut.offset(1)), (1, 5));
        // Row-major 2 x 3 x 7 along the last.
        let cut = Shape::new([2, 3, 7], false).cut(None).unwrap();
        assert_eq!((cut.channels, cut.offset(4), cut.stride), (6, 28, 1));
        // Row-major 2 x 7 x 3 along the middle: channel (1, 2) at 21 + 2.
        let cut = Shape::new([2, 7, 3], false).cut(None).unwrap();
        assert_eq!((cut.channels, cut.offset(5), cut.stride), (6, 23, 3));
        assert_eq!(Shape::new([u64::MAX, 3], false).cut(None), None);
    }
}

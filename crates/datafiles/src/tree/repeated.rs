//! Arrays of three and more extents, one of them that of the samples: repeated tests (`dataset` of samples x channels x tests),
//! periods and levels of a multisine. Each test becomes a set of its own, so that it can be imported as a run.
//!
//! Which extent is that of the channels: the one in which arrays of the group differ or that one of them lacks (`Force` of
//! 9 x N beside `Acceleration` of 3 x 9 x N), else the one of as many names as lie beside it, else the one next to the samples.
//! Frequency responses and their parts are no tests: an array of responses by references stays one set.

use super::labels::Labels;
use super::{Array, Entry, Node, Shape};
use crate::parts::is_part;

/// Most tests that become sets.
const MOST_TESTS: u64 = 4096;

/// The repeated tests of a group.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Repeated {
    samples: u64,
    /// Extents of the tests, in the order of the indices.
    tests: Vec<u64>,
    /// Place of the channels among the extents that are not the samples.
    channel: usize,
    /// What is said of it.
    pub note: String,
}

impl Repeated {
    /// The tests that the arrays of a group hold, samples along `samples` or their longest extent.
    pub(super) fn among(entries: &[Entry], samples: Option<u64>, labels: &Labels) -> Option<Self> {
        let arrays = || entries.iter().filter_map(real);
        let (whole, first) = arrays().max_by_key(|(_, array)| array.shape.extents.len())?;
        let extents = &first.shape.extents;
        let along = first.shape.along(samples).filter(|_| extents.len() > 2)?;
        let samples = extents[along];
        let rest = without(extents, along);
        let lists: Vec<Vec<u64>> = arrays().filter_map(|(_, array)| others(&array.shape, samples)).collect();
        let channel = told(&rest, &lists, labels.names.len()).unwrap_or_else(|| next_to(along, &rest));
        let mut tests = rest.clone();
        let channels = tests.remove(channel);
        let count = tests.iter().try_fold(1_u64, |product, &extent| product.checked_mul(extent))?;
        let said: Vec<String> = extents.iter().map(ToString::to_string).collect();
        let note = format!(
            "\"{}\" of {} is taken as {count} tests of {channels} channels, each test a set",
            whole.name,
            said.join(" x ")
        );
        (count <= MOST_TESTS).then_some(Self { samples, tests, channel, note })
    }

    /// Whether an array is one of all tests, or a vector that is the same in all of them.
    pub(super) fn takes(&self, entry: &Entry) -> bool {
        real(entry).is_some_and(|(_, array)| array.shape.extents == [self.samples] || self.place(array).is_some())
    }

    /// Where the channels are among the extents of an array beside the samples: none within where it has one a test.
    fn place(&self, array: &Array) -> Option<Option<usize>> {
        let rest = others(&array.shape, self.samples)?;
        if rest == self.tests {
            return Some(None);
        }
        let fits = rest.len() == self.tests.len() + 1 && without(&rest, self.channel) == self.tests;
        fits.then_some(Some(self.channel))
    }

    /// Number of tests.
    pub(super) fn count(&self) -> u64 {
        self.tests.iter().product()
    }

    /// Indices of a test from 1 on, in the order of the extents; the index that runs fastest in the file goes first.
    fn indices(&self, test: u64, column_major: bool) -> Vec<u64> {
        let mut rest = test;
        let mut indices = vec![0; self.tests.len()];
        for i in fastest_first(self.tests.len(), column_major) {
            (indices[i], rest) = (rest % self.tests[i] + 1, rest / self.tests[i]);
        }
        indices
    }

    /// Name of a test: `test 3`, of several extents `test 3,2`.
    pub(super) fn name(&self, path: &str, test: u64, column_major: bool) -> String {
        let indices: Vec<String> = self.indices(test, column_major).iter().map(ToString::to_string).collect();
        let name = format!("test {}", indices.join(","));
        if path.is_empty() { name } else { format!("{path}/{name}") }
    }

    /// The channels of an array, as [`Shape::cut`] counts them, that belong to a test.
    pub(super) fn channels(&self, array: &Array, test: u64) -> Vec<u64> {
        let Some(place) = self.place(array) else { return vec![0] };
        let rest = others(&array.shape, self.samples).unwrap_or_default();
        let indices = self.indices(test, array.shape.column_major);
        let number = |k: u64| {
            let mut all: Vec<u64> = indices.iter().map(|index| index - 1).collect();
            if let Some(place) = place {
                all.insert(place, k);
            }
            let (mut number, mut stride) = (0, 1);
            for i in fastest_first(rest.len(), array.shape.column_major) {
                number += all[i] * stride;
                stride *= rest[i];
            }
            number
        };
        (0..place.map_or(1, |place| rest[place])).map(number).collect()
    }

    /// The samples, along which its arrays are cut.
    pub(super) fn samples(&self) -> u64 {
        self.samples
    }
}

/// An array of real numbers that is no part of frequency responses.
fn real(entry: &Entry) -> Option<(&Entry, &Array)> {
    match &entry.node {
        Node::Array(array) if !array.complex && !is_part(&entry.name) => Some((entry, array)),
        _ => None,
    }
}

/// The extents of an array beside the samples; none where it has no samples or nothing beside them.
fn others(shape: &Shape, samples: u64) -> Option<Vec<u64>> {
    let along = shape.along(Some(samples)).filter(|&along| shape.extents[along] == samples)?;
    (shape.extents.len() > 1).then(|| without(&shape.extents, along))
}

fn without(extents: &[u64], at: usize) -> Vec<u64> {
    let mut rest = extents.to_vec();
    rest.remove(at);
    rest
}

/// The extent of the channels by what else lies in the group.
fn told(rest: &[u64], lists: &[Vec<u64>], names: usize) -> Option<usize> {
    let lacks = |list: &&Vec<u64>| list.len() + 1 == rest.len();
    let lacking = lists.iter().find(lacks).and_then(|list| (0..rest.len()).find(|&i| without(rest, i) == *list));
    let differs = |i: &usize| {
        lists
            .iter()
            .any(|list| list.len() == rest.len() && list[*i] != rest[*i] && without(list, *i) == without(rest, *i))
    };
    let named = || (0..rest.len()).rev().find(|&i| names > 1 && rest[i] == names as u64);
    lacking.or_else(|| (0..rest.len()).find(differs)).or_else(named)
}

/// The extent next to the samples at `along`: of the two beside samples in the middle the smaller.
fn next_to(along: usize, rest: &[u64]) -> usize {
    match along.checked_sub(1) {
        None => 0,
        Some(before) if along == rest.len() || rest[before] < rest[along] => before,
        Some(_) => along,
    }
}

fn fastest_first(count: usize, column_major: bool) -> Vec<usize> {
    if column_major { (0..count).collect() } else { (0..count).rev().collect() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::super::source::{Arrays, Flat, TreeSource};
    use super::super::{Array, sets};
    use super::*;
    use crate::contents::Set;
    use crate::error::Read;
    use crate::source::Source;
    use uff::Values;

    #[derive(Clone)]
    struct Made(Vec<Vec<f64>>);
    impl Arrays for Made {
        fn read(&self, id: usize) -> Read<Flat> {
            Ok(Flat::real(self.0[id].clone()))
        }
    }

    /// Values of an array by its indices, written one by one in the order of the file.
    fn filled(extents: &[u64], column_major: bool, value: impl Fn(&[u64]) -> f64) -> Vec<f64> {
        let total: u64 = extents.iter().product();
        let mut values = Vec::new();
        for place in 0..total {
            let (mut index, mut rest) = (vec![0; extents.len()], place);
            for i in fastest_first(extents.len(), column_major) {
                (index[i], rest) = (rest % extents[i], rest / extents[i]);
            }
            values.push(value(&index));
        }
        values
    }

    struct Group {
        entries: Vec<Entry>,
        made: Made,
        column_major: bool,
    }

    impl Group {
        fn new(column_major: bool) -> Self {
            Self { entries: Vec::new(), made: Made(Vec::new()), column_major }
        }

        fn with(mut self, name: &str, extents: &[u64], value: impl Fn(&[u64]) -> f64) -> Self {
            let shape = Shape::new(extents.iter().copied(), self.column_major);
            let flat = Flat::real(filled(extents, self.column_major, value));
            let array = Array { id: self.made.0.len(), peek: flat.peek(&shape.wanted()), shape, complex: false };
            self.entries.push(Entry::new(name, Node::Array(array)));
            self.made.0.push(flat.re);
            self
        }

        /// Names of the sets, and their channels with the values that the file has of them.
        fn read(self) -> Vec<(Set, Vec<Vec<f64>>)> {
            let (found, places) = sets(&self.entries, &[], &self.made).unwrap();
            let source = TreeSource::new(Box::new(self.made), places);
            let values = |s: usize, c: usize| match source.read(s, c).unwrap() {
                Values::Real(values) => values,
                Values::Complex(_) => Vec::new(),
            };
            let all = |s: usize, set: &Set| (0..set.channels.len()).map(|c| values(s, c)).collect();
            found.iter().enumerate().map(|(s, set)| (set.clone(), all(s, set))).collect()
        }
    }

    fn value(sample: u64, channel: u64, test: u64) -> f64 {
        (sample + 1000 * channel + 100_000 * test) as f64
    }

    /// Every order of samples, channels and tests that the conventions cover, in both orders of the values: each test is a set
    /// with its channels, the time of all of them beside it.
    #[test]
    fn every_test_of_an_array_is_a_set() {
        for column_major in [true, false] {
            for (extents, [n, c, r]) in [([50, 3, 4], [0, 1, 2]), ([4, 3, 50], [2, 1, 0]), ([4, 50, 3], [1, 2, 0])] {
                let group = Group::new(column_major).with("dataset", &extents, |at| value(at[n], at[c], at[r])).with(
                    "time",
                    &[50, 1],
                    |at| at[0] as f64 / 320.0,
                );
                let found = group.read();
                assert_eq!(found.len(), 4, "{extents:?}");
                assert!(found[0].0.notes[0].text.contains("4 tests of 3 channels"), "{:?}", found[0].0.notes);
                for (test, (set, values)) in found.iter().enumerate() {
                    assert_eq!((set.name.clone(), set.channels.len()), (format!("test {}", test + 1), 3));
                    for (channel, values) in values.iter().enumerate() {
                        let truth: Vec<f64> = (0..50).map(|n| value(n, channel as u64, test as u64)).collect();
                        assert_eq!(*values, truth, "{extents:?} {column_major} {test} {channel}");
                        assert_eq!(set.channels[channel].name, format!("dataset[{}]", channel + 1));
                        let first = super::super::columns::number([truth[0], 0.0], false);
                        assert_eq!(set.channels[channel].first[0], first);
                        assert!(
                            set.channels[channel].axis.step().is_some_and(|step| (step - 1.0 / 320.0).abs() < 1e-12)
                        );
                    }
                }
            }
        }
    }

    /// `Force` of tests x samples says which extent of `Acceleration`, of channels x tests x samples, counts the tests; a rate holds
    /// for all of them.
    #[test]
    fn an_array_without_channels_tells_the_tests() {
        let group = Group::new(true)
            .with("Force", &[9, 40], |at| value(at[1], 7, at[0]))
            .with("Acceleration", &[3, 9, 40], |at| value(at[2], at[0], at[1]))
            .with("Fs", &[1, 1], |_| 400.0);
        let found = group.read();
        assert_eq!(found.len(), 9);
        let names: Vec<&str> = found[8].0.channels.iter().map(|channel| channel.name.as_str()).collect();
        assert_eq!(names, ["Force", "Acceleration[1]", "Acceleration[2]", "Acceleration[3]"]);
        assert_eq!((found[8].1[0][5], found[8].1[3][5]), (value(5, 7, 8), value(5, 2, 8)));
        assert!(found.iter().all(|(set, _)| set.channels.iter().all(|channel| channel.axis.step() == Some(0.0025))));
    }

    /// Periods and levels of a multisine: input and output differ in the number of their channels.
    #[test]
    fn periods_and_levels_are_tests() {
        let group = Group::new(true).with("u", &[64, 1, 4, 3], |at| value(at[0], 9, at[2] + 10 * at[3])).with(
            "y",
            &[64, 2, 4, 3],
            |at| value(at[0], at[1], at[2] + 10 * at[3]),
        );
        let found = group.read();
        assert_eq!((found.len(), found[1].0.name.as_str(), found[4].0.name.as_str()), (12, "test 2,1", "test 1,2"));
        let (set, values) = &found[6];
        assert_eq!((set.name.as_str(), set.channels.len()), ("test 3,2", 3));
        assert_eq!([values[0][1], values[2][1]], [value(1, 9, 2 + 10), value(1, 1, 2 + 10)]);
    }

    /// Parts of frequency responses, and functions over frequencies, are no tests.
    #[test]
    fn responses_are_no_tests() {
        let parts = Group::new(true).with("H_re", &[50, 3, 2], |_| 1.0).with("H_im", &[50, 3, 2], |_| 1.0);
        assert!(parts.read().iter().all(|(set, _)| !set.name.starts_with("test")));
        let over = Group::new(true).with("Gxx", &[50, 3, 2], |_| 1.0).with("freq", &[50, 1], |at| at[0] as f64);
        assert!(over.read().iter().all(|(set, _)| !set.name.starts_with("test")));
    }
}

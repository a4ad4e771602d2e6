//! Reads channels out of arrays.

use super::Cut;
use crate::error::{Fault, Read};
use crate::source::{MOST_VALUES, Source};
use std::sync::{Arc, Mutex};
use uff::Values;

/// All values of an array in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Flat {
    pub re: Vec<f64>,
    /// Empty for real arrays.
    pub im: Vec<f64>,
}

impl Flat {
    pub(crate) fn real(re: Vec<f64>) -> Self {
        Self { re, im: Vec::new() }
    }

    fn into_values(self) -> Values {
        let Self { re, im } = self;
        if im.is_empty() { Values::Real(re) } else { values(re.into_iter(), im.into_iter(), true) }
    }

    /// Values at the places that a listing shows.
    pub(crate) fn peek(&self, wanted: &[u64]) -> Vec<[f64; 2]> {
        let value = |values: &[f64], i: u64| usize::try_from(i).ok().and_then(|i| values.get(i).copied());
        wanted.iter().map(|&i| [value(&self.re, i).unwrap_or(f64::NAN), value(&self.im, i).unwrap_or(0.0)]).collect()
    }
}

/// Values of an array up to which it is read whole and kept: its other channels are mostly asked for next.
const KEPT: u64 = 1 << 20;

/// Reads arrays.
pub(crate) trait Arrays: Send + Sync {
    /// All values of array number `id`.
    fn read(&self, id: usize) -> Read<Flat>;

    /// One channel of array number `id` without the others in memory; none where the array is only read whole.
    fn column(&self, _id: usize, _cut: &Cut, _channel: u64) -> Option<Read<Flat>> {
        None
    }

    /// Several channels of array number `id` in one pass over it; none where that is no gain.
    fn columns(&self, _id: usize, _cut: &Cut, _channels: &[u64]) -> Option<Read<Vec<Flat>>> {
        None
    }
}

/// Where a channel's values are.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub id: usize,
    pub cut: Cut,
    pub channel: u64,
    /// Whether all values of the array are the channel: a matrix.
    pub whole: bool,
    /// Array of the abscissa.
    pub axis: Option<usize>,
}

/// Channels of a file of arrays.
pub(crate) struct TreeSource {
    arrays: Box<dyn Arrays>,
    sets: Vec<Vec<Place>>,
    // Columns of one array are mostly read one after the other.
    last: Mutex<Option<(usize, Arc<Flat>)>>,
}

impl TreeSource {
    pub(crate) fn new(arrays: Box<dyn Arrays>, sets: Vec<Vec<Place>>) -> Self {
        Self { arrays, sets, last: Mutex::new(None) }
    }

    fn array(&self, id: usize) -> Read<Arc<Flat>> {
        if let Ok(last) = self.last.lock()
            && let Some((known, flat)) = last.as_ref()
            && *known == id
        {
            return Ok(Arc::clone(flat));
        }
        let flat = Arc::new(self.arrays.read(id)?);
        if let Ok(mut last) = self.last.lock() {
            *last = Some((id, Arc::clone(&flat)));
        }
        Ok(flat)
    }

    /// A channel of a large array, where it can be read alone.
    fn alone(&self, id: usize, cut: &Cut, channel: u64) -> Option<Read<Flat>> {
        let large = cut.count.saturating_mul(cut.channels) > KEPT;
        if large { self.arrays.column(id, cut, channel) } else { None }
    }

    fn place(&self, set: usize, channel: usize) -> Read<&Place> {
        self.sets.get(set).and_then(|set| set.get(channel)).ok_or_else(|| Fault::new("there is no such channel"))
    }
}

impl Source for TreeSource {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        let place = self.place(set, channel)?;
        if let Some(flat) = self.alone(place.id, &place.cut, place.channel).filter(|_| !place.whole) {
            return Ok(flat?.into_values());
        }
        if place.cut.count.saturating_mul(place.cut.channels) > MOST_VALUES {
            return Err(Fault::new("its array is too large for memory; save it in pieces"));
        }
        let flat = self.array(place.id)?;
        if place.whole {
            return Ok(values(flat.re.iter().copied(), flat.im.iter().copied(), !flat.im.is_empty()));
        }
        let (from, step) = (place.cut.offset(place.channel) as usize, (place.cut.stride as usize).max(1));
        let count = place.cut.count as usize;
        let pick = |all: &[f64]| {
            all.get(from..).unwrap_or_default().iter().step_by(step).take(count).copied().collect::<Vec<_>>()
        };
        let (re, im) = (pick(&flat.re), pick(&flat.im));
        if re.len() != count {
            return Err(Fault::new("has fewer values than its extents say; export it again"));
        }
        let complex = !flat.im.is_empty();
        Ok(values(re.into_iter(), im.into_iter(), complex))
    }

    fn together(&self, set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        let places: Vec<&Place> =
            channels.iter().map(|&channel| self.place(set, channel).ok()).collect::<Option<_>>()?;
        let first = places.first()?;
        let large = first.cut.count.saturating_mul(first.cut.channels) > KEPT;
        let alike = places.iter().all(|place| place.id == first.id && place.cut == first.cut && !place.whole);
        if !large || !alike {
            return None;
        }
        let wanted: Vec<u64> = places.iter().map(|place| place.channel).collect();
        let read = self.arrays.columns(first.id, &first.cut, &wanted)?;
        Some(read.map(|flats| flats.into_iter().map(Flat::into_values).collect()))
    }

    fn axis(&self, set: usize, channel: usize) -> Read<Vec<f64>> {
        let place = self.place(set, channel)?;
        let axis = place.axis.ok_or_else(|| Fault::new("the abscissa is not stored"))?;
        match self.alone(axis, &Cut::vector(place.cut.count), 0) {
            Some(flat) => Ok(flat?.re),
            None => Ok(self.array(axis)?.re.clone()),
        }
    }
}

fn values(re: impl Iterator<Item = f64>, im: impl Iterator<Item = f64>, complex: bool) -> Values {
    if complex { Values::Complex(re.zip(im).map(|(re, im)| [re, im]).collect()) } else { Values::Real(re.collect()) }
}

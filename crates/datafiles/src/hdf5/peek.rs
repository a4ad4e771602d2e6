//! The few values of a data set that a listing shows.

use super::fault::wrong;
use super::value::Value;
use crate::error::Read;
use crate::tree::Shape;
use hdf5_reader::{Dataset, SliceInfo, SliceInfoElem};
use std::collections::BTreeMap;

/// Data sets of at most so many values are read whole for their first ones.
pub(super) const SMALL: u64 = 4096;

/// Values that a listing shows: of small data sets all, of large ones the slabs at the start of each extent.
pub(super) fn peek(dataset: &Dataset, shape: &Shape) -> Read<Vec<[f64; 2]>> {
    let wanted = shape.wanted();
    let extents = dataset.shape();
    let total = dataset.num_elements().map_err(wrong)?;
    if total == 0 {
        return Ok(Vec::new());
    }
    let mut found = BTreeMap::new();
    if total <= SMALL || extents.is_empty() {
        let all = dataset.read_array::<Value>().map_err(wrong)?;
        found.extend(all.iter().enumerate().map(|(i, value)| (i as u64, value.0)));
    } else {
        for along in 0..extents.len() {
            if total / extents[along] <= 4096 {
                slab(dataset, along, 0..extents[along].min(3), &mut found)?;
            }
        }
        let last: Vec<u64> = extents.iter().map(|extent| extent - 1).collect();
        corner(dataset, &last, total - 1, &mut found)?;
    }
    Ok(wanted.iter().map(|place| found.get(place).copied().unwrap_or([f64::NAN; 2])).collect())
}

fn slab(dataset: &Dataset, along: usize, range: std::ops::Range<u64>, found: &mut BTreeMap<u64, [f64; 2]>) -> Read<()> {
    let extents = dataset.shape();
    let mut selection = SliceInfo::all(extents.len());
    selection.selections[along] = SliceInfoElem::Slice { start: range.start, end: range.end, step: 1 };
    let values = dataset.read_slice::<Value>(&selection).map_err(wrong)?;
    let mut part = extents.to_vec();
    part[along] = range.end - range.start;
    for (i, value) in values.iter().enumerate() {
        let (mut rest, mut place, mut weight) = (i as u64, 0, 1);
        for axis in (0..extents.len()).rev() {
            place += rest % part[axis] * weight;
            rest /= part[axis];
            weight *= extents[axis];
        }
        found.insert(place, value.0);
    }
    Ok(())
}

fn corner(dataset: &Dataset, at: &[u64], place: u64, found: &mut BTreeMap<u64, [f64; 2]>) -> Read<()> {
    let index = |&i: &u64| SliceInfoElem::Slice { start: i, end: i + 1, step: 1 };
    let values =
        dataset.read_slice::<Value>(&SliceInfo { selections: at.iter().map(index).collect() }).map_err(wrong)?;
    found.extend(values.iter().next().map(|value| (place, value.0)));
    Ok(())
}

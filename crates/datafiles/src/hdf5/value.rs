//! A number of any HDF5 type as one or two of 64 bits.

use crate::bytes::Scalar;
use crate::tree::{Entry, Node};
use hdf5_reader::error::{ByteOrder, Error, Result};
use hdf5_reader::{Dataset, Datatype, H5Type, SliceInfo, SliceInfoElem, dtype_element_size};

/// A real or complex number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Value(pub [f64; 2]);

/// Whether a type is numeric, and if so whether it is complex.
pub(super) fn readable(dtype: &Datatype) -> Option<bool> {
    match dtype {
        Datatype::Compound { .. } => parts(dtype).map(|_| true),
        other => scalar(other).map(|_| false),
    }
}

fn scalar(dtype: &Datatype) -> Option<(Scalar, bool)> {
    let big = |order: &ByteOrder| *order == ByteOrder::BigEndian;
    match dtype {
        Datatype::FixedPoint { size, signed, byte_order } => {
            Some((Scalar::integer(usize::from(*size), *signed)?, big(byte_order)))
        }
        Datatype::FloatingPoint { size, byte_order } => Some((Scalar::float(usize::from(*size))?, big(byte_order))),
        Datatype::Bitfield { size, byte_order } => Some((Scalar::integer(usize::from(*size), false)?, big(byte_order))),
        Datatype::Enum { base, .. } => scalar(base),
        _ => None,
    }
}

/// Real and imaginary field of a record of two: `r, i` or `real, imag`.
fn parts(dtype: &Datatype) -> Option<[(usize, &Datatype); 2]> {
    let Datatype::Compound { fields, .. } = dtype else { return None };
    let [re, im] = &fields[..] else { return None };
    let named = |name: &str, words: [&str; 3]| words.contains(&name.to_lowercase().as_str());
    let both = named(&re.name, ["r", "re", "real"]) && named(&im.name, ["i", "im", "imag"]);
    (both && scalar(&re.datatype).is_some() && scalar(&im.datatype).is_some())
        .then_some([(re.byte_offset as usize, &re.datatype), (im.byte_offset as usize, &im.datatype)])
}

fn number(bytes: &[u8], dtype: &Datatype) -> Option<f64> {
    let (scalar, big) = scalar(dtype)?;
    scalar.get(bytes, big)
}

/// A numeric field of records.
#[derive(Debug, Clone)]
pub(super) struct Field {
    pub name: String,
    at: usize,
    dtype: Datatype,
}

/// The numeric fields of a type of records.
pub(super) fn fields(dtype: &Datatype) -> Vec<Field> {
    let Datatype::Compound { fields, .. } = dtype else { return Vec::new() };
    let numeric = fields.iter().filter(|field| scalar(&field.datatype).is_some());
    let field = |field: &hdf5_reader::CompoundField| Field {
        name: field.name.clone(),
        at: field.byte_offset as usize,
        dtype: field.datatype.clone(),
    };
    numeric.map(field).collect()
}

impl Field {
    /// The number of a record.
    pub(super) fn number(&self, record: &[u8]) -> Option<f64> {
        number(record.get(self.at..)?, &self.dtype)
    }

    /// All its numbers.
    pub(super) fn column(&self, dataset: &Dataset) -> Result<Vec<f64>> {
        let size = dtype_element_size(dataset.dtype()).unwrap_or(1).max(1);
        let bytes = dataset.read_raw_bytes()?;
        Ok(bytes.chunks_exact(size).map(|record| self.number(record).unwrap_or(f64::NAN)).collect())
    }
}

/// A record as its bytes.
#[derive(Debug, Clone)]
struct Record(Vec<u8>);

/// The records at ascending places of a data set.
pub(super) fn peek_records(dataset: &Dataset, places: &[u64]) -> Result<Vec<Vec<u8>>> {
    let extents = dataset.shape();
    let record_at = |&place: &u64| {
        let mut rest = place;
        let mut selections = Vec::new();
        for &extent in extents.iter().rev() {
            let at = rest % extent.max(1);
            rest /= extent.max(1);
            selections.push(SliceInfoElem::Slice { start: at, end: at + 1, step: 1 });
        }
        selections.reverse();
        let found = dataset.read_slice::<Record>(&SliceInfo { selections })?;
        Ok(found.iter().next().map(|record| record.0.clone()).unwrap_or_default())
    };
    places.iter().map(record_at).collect()
}

impl H5Type for Record {
    fn hdf5_type() -> Datatype {
        Datatype::FixedPoint { size: 1, signed: false, byte_order: ByteOrder::LittleEndian }
    }

    fn from_bytes(bytes: &[u8], dtype: &Datatype) -> Result<Self> {
        let size = dtype_element_size(dtype).unwrap_or(1);
        bytes
            .get(..size)
            .map(|record| Self(record.to_vec()))
            .ok_or_else(|| Error::InvalidData("a record is cut short".to_owned()))
    }

    fn element_size(dtype: &Datatype) -> usize {
        dtype_element_size(dtype).unwrap_or(1)
    }
}

impl H5Type for Value {
    fn hdf5_type() -> Datatype {
        Datatype::FloatingPoint { size: 8, byte_order: ByteOrder::LittleEndian }
    }

    fn from_bytes(bytes: &[u8], dtype: &Datatype) -> Result<Self> {
        let value = match parts(dtype) {
            Some(both) => {
                let part = |(offset, dtype): (usize, &Datatype)| number(bytes.get(offset..)?, dtype);
                part(both[0]).zip(part(both[1])).map(|(re, im)| [re, im])
            }
            None => number(bytes, dtype).map(|re| [re, 0.0]),
        };
        value.map(Self).ok_or_else(|| Error::InvalidData("a value is no number".to_owned()))
    }

    fn element_size(dtype: &Datatype) -> usize {
        dtype_element_size(dtype).unwrap_or(1)
    }
}

/// The elements of an array of structs in MATLAB 7.3 (a group with a data set of references a field), named `(1)`, `(2)` and so on; other groups as they are.
pub(super) fn elements(fields: Vec<Entry>) -> Vec<Entry> {
    let Some(count) = common_count(&fields) else { return fields };
    let element = |i: usize| {
        let field = |field: &Entry| Entry { name: field.name.clone(), ..element(field, i) };
        Entry::new(format!("({})", i + 1), Node::Group(fields.iter().map(field).collect()))
    };
    (0..count).map(element).collect()
}

/// Number of elements, the same in every field; none where a field is no list of them.
fn common_count(fields: &[Entry]) -> Option<usize> {
    let count = |field: &Entry| match &field.node {
        Node::Group(inner) => {
            let numbered = |(i, entry): (usize, &Entry)| entry.name == format!("({})", i + 1);
            inner.iter().enumerate().all(numbered).then_some(inner.len())
        }
        Node::Text(texts) => Some(texts.len()),
        Node::Array(_) | Node::Skipped(_) => None,
    };
    let first = fields.first().and_then(count).filter(|count| *count > 1)?;
    let lists = fields.iter().any(|field| matches!(field.node, Node::Group(_)));
    (lists && fields.iter().all(|field| count(field) == Some(first))).then_some(first)
}

fn element(field: &Entry, i: usize) -> Entry {
    match &field.node {
        Node::Group(inner) => inner[i].clone(),
        Node::Text(texts) => Entry::new("", Node::Text(vec![texts[i].clone()])),
        Node::Array(_) | Node::Skipped(_) => field.clone(),
    }
}

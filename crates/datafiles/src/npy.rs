//! NumPy arrays (`.npy`).
//!
//! Source: "NEP 1: A simple file format for NumPy arrays": magic, version, length of the header, and a Python dictionary of
//! `descr`, `fortran_order` and `shape`.

use crate::bytes::{Scalar, check_size, columns, take};
use crate::contents::{Contents, Format};
use crate::error::{Fault, Read, one_line};
use crate::source::Source;
use crate::tree::{Array, Arrays, Cut, Entry, Flat, Node, Shape, TreeSource, sets};
use std::fs::File;
use std::io::{Read as Bytes, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Type, extents and order of an array.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Header {
    kind: char,
    size: usize,
    big: bool,
    pub shape: Shape,
}

/// Values of an array of numbers.
#[derive(Debug, Clone, Copy)]
struct Numbers {
    scalar: Scalar,
    complex: bool,
    big: bool,
}

impl Header {
    /// Reads the header; the reader then stands at the first value.
    pub(crate) fn read(reader: &mut impl Bytes) -> Read<Self> {
        let start = take(reader, 10)?;
        if !start.starts_with(b"\x93NUMPY") {
            return Err(Fault::new("is no NumPy array"));
        }
        let mut length = u64::from(u16::from_le_bytes([start[8], start[9]]));
        if start[6] >= 2 {
            let more = take(reader, 2)?;
            length |= u64::from(u16::from_le_bytes([more[0], more[1]])) << 16;
        }
        if length > 1 << 20 {
            return Err(Fault::byte(8, "states a header of more than a megabyte; the file is damaged: save it again"));
        }
        let text = take(reader, length)?;
        Self::parse(&String::from_utf8_lossy(&text))
    }

    fn parse(text: &str) -> Read<Self> {
        let damaged = |what: &str| {
            Fault::byte(10, format!("the header has no {what}; the file is damaged: save it again with numpy.save"))
        };
        let descr = entry(text, "descr").ok_or_else(|| damaged("descr"))?;
        if descr.starts_with('[') {
            return Err(Fault::new("is an array of records; save each field as an array of its own"));
        }
        let descr = descr.trim_matches(['\'', '"']);
        let mut letters = descr.chars();
        let order = letters.next().ok_or_else(|| damaged("descr"))?;
        let kind = letters.next().ok_or_else(|| damaged("descr"))?;
        let size = letters.as_str().chars().take_while(char::is_ascii_digit).collect::<String>();
        let size = size.parse().unwrap_or(0);
        let shape = entry(text, "shape").ok_or_else(|| damaged("shape"))?;
        let extents: Result<Vec<u64>, _> = shape
            .trim_matches(['(', ')'])
            .split(',')
            .map(|extent| extent.trim().trim_end_matches('L'))
            .filter(|extent| !extent.is_empty())
            .map(str::parse)
            .collect();
        let extents = extents.map_err(|_| damaged("shape of whole numbers"))?;
        let fortran = entry(text, "fortran_order").is_some_and(|value| value == "True");
        Ok(Self { kind, size, big: order == '>', shape: Shape::new(extents, fortran) })
    }

    fn numbers(&self) -> Option<Numbers> {
        let (scalar, complex) = match (self.kind, self.size) {
            ('f', size) => (Scalar::float(size)?, false),
            ('i', size) => (Scalar::integer(size, true)?, false),
            ('u', size) => (Scalar::integer(size, false)?, false),
            ('b', 1) => (Scalar::U8, false),
            ('c', 8) => (Scalar::F32, true),
            ('c', 16) => (Scalar::F64, true),
            _ => return None,
        };
        Some(Numbers { scalar, complex, big: self.big })
    }

    /// The node of an array that `available` bytes follow; `read` returns its values.
    pub(crate) fn node(
        &self,
        id: usize,
        available: u64,
        peek: impl FnOnce(&[u64]) -> Read<Vec<[f64; 2]>>,
    ) -> Read<Node> {
        let Some(numbers) = self.numbers() else {
            if matches!(self.kind, 'U' | 'S') {
                return Ok(Node::Skipped("it is text".to_owned()));
            }
            return Ok(Node::Skipped(format!(
                "its values ({}{}) are no numbers of up to 64 bits",
                self.kind, self.size
            )));
        };
        let count =
            self.shape.len().ok_or_else(|| Fault::byte(10, "the shape is larger than any file; save it again"))?;
        check_size(count, numbers.size(), available, 10)?;
        let peek = peek(&self.shape.wanted())?;
        Ok(Node::Array(Array { id, shape: self.shape.clone(), complex: numbers.complex, peek }))
    }

    /// All values of the array that follow.
    pub(crate) fn values(&self, reader: &mut impl Bytes) -> Read<Flat> {
        let numbers = self.numbers().ok_or_else(|| Fault::new("holds no numbers"))?;
        let count = self.shape.len().and_then(|count| count.checked_mul(numbers.size()));
        let bytes = take(reader, count.ok_or_else(|| Fault::new("is larger than any file"))?)?;
        Ok(numbers.flat(&bytes))
    }

    /// The texts of an array of them.
    pub(crate) fn texts(&self, reader: &mut impl Bytes) -> Option<Vec<String>> {
        let count = self.shape.len().filter(|&count| count <= 4096)?;
        let width = match self.kind {
            'U' => self.size.checked_mul(4)?,
            'S' => self.size,
            _ => return None,
        };
        let bytes = take(reader, count.checked_mul(width as u64).filter(|&bytes| bytes < 1 << 20)?).ok()?;
        let text = |bytes: &[u8]| {
            if self.kind == 'S' {
                return String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned();
            }
            let letter = |b: &[u8]| {
                let array = [b[0], b[1], b[2], b[3]];
                char::from_u32(if self.big { u32::from_be_bytes(array) } else { u32::from_le_bytes(array) })
                    .unwrap_or('?')
            };
            bytes.chunks_exact(4).map(letter).take_while(|&c| c != '\0').collect()
        };
        (width > 0).then(|| bytes.chunks_exact(width).map(|bytes| one_line(&text(bytes), 200)).collect())
    }
}

impl Numbers {
    fn size(self) -> u64 {
        self.scalar.size() as u64 * if self.complex { 2 } else { 1 }
    }

    fn flat(self, bytes: &[u8]) -> Flat {
        let all = self.scalar.all(bytes, self.big);
        if !self.complex {
            return Flat::real(all);
        }
        Flat { re: all.iter().step_by(2).copied().collect(), im: all.iter().skip(1).step_by(2).copied().collect() }
    }
}

/// The value of a key of the dictionary.
fn entry<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let at = [format!("'{key}'"), format!("\"{key}\"")]
        .iter()
        .find_map(|key| text.find(key.as_str()).map(|at| at + key.len()))?;
    let rest = text[at..].trim_start().strip_prefix(':')?.trim_start();
    let end = match rest.chars().next()? {
        '(' => rest.find(')')? + 1,
        '[' => rest.rfind(']')? + 1,
        quote @ ('\'' | '"') => rest[1..].find(quote)? + 2,
        _ => rest.find([',', '}'])?,
    };
    Some(rest[..end].trim())
}

struct Npy {
    path: PathBuf,
}

/// Opens a NumPy array.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let length = std::fs::metadata(path)?.len();
    let mut file = File::open(path)?;
    let header = Header::read(&mut file)?;
    let start = file.stream_position()?;
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let node = header.node(0, length.saturating_sub(start), |wanted| peek(&mut file, &header, start, wanted))?;
    let arrays = Npy { path: path.to_owned() };
    let (sets, places) = sets(&[Entry::new(name, node)], &[], &arrays)?;
    let mut contents = Contents::new(Format::Npy);
    contents.sets = sets;
    // One array is the file; its tests are told apart by their names.
    if let [set] = &mut contents.sets[..] {
        set.name.clear();
    }
    Ok((contents, Box::new(TreeSource::new(Box::new(arrays), places))))
}

fn peek(file: &mut File, header: &Header, start: u64, wanted: &[u64]) -> Read<Vec<[f64; 2]>> {
    let Some(numbers) = header.numbers() else { return Ok(Vec::new()) };
    let mut values = Vec::with_capacity(wanted.len());
    for place in wanted {
        file.seek(SeekFrom::Start(start + place * numbers.size()))?;
        let flat = numbers.flat(&take(file, numbers.size())?);
        values.push([flat.re[0], flat.im.first().copied().unwrap_or(0.0)]);
    }
    Ok(values)
}

impl Arrays for Npy {
    fn read(&self, _id: usize) -> Read<Flat> {
        let mut file = File::open(&self.path)?;
        Header::read(&mut file)?.values(&mut std::io::BufReader::new(file))
    }

    fn column(&self, _id: usize, cut: &Cut, channel: u64) -> Option<Read<Flat>> {
        let only_column = |mut flats: Vec<Flat>| flats.pop().ok_or_else(|| Fault::new("there is no such column"));
        self.real_columns(cut, &[channel]).transpose().map(|flats| flats.and_then(only_column))
    }

    fn columns(&self, _id: usize, cut: &Cut, channels: &[u64]) -> Option<Read<Vec<Flat>>> {
        self.real_columns(cut, channels).transpose()
    }
}

impl Npy {
    /// Columns in one pass; none where they are complex, or not beside each other in ascending order.
    fn real_columns(&self, cut: &Cut, channels: &[u64]) -> Read<Option<Vec<Flat>>> {
        let mut file = File::open(&self.path)?;
        let header = Header::read(&mut file)?;
        let Some(numbers) = header.numbers().filter(|numbers| !numbers.complex) else { return Ok(None) };
        let first = channels.first().map_or(0, |&channel| cut.offset(channel));
        let places: Vec<u64> = channels.iter().map(|&channel| cut.offset(channel).wrapping_sub(first)).collect();
        let beside = places.windows(2).all(|pair| pair[0] < pair[1]) && places.iter().all(|&at| at < cut.stride.max(1));
        if !beside {
            return Ok(None);
        }
        file.seek_relative((first * numbers.size()) as i64)?;
        let read = columns(&mut file, numbers.scalar, numbers.big, cut.stride, cut.count, &places)?;
        Ok(Some(read.into_iter().map(Flat::real).collect()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn headers_of_every_order() {
        let header = Header::parse("{'descr': '>f4', 'fortran_order': True, 'shape': (3, 2), }").unwrap();
        assert_eq!((header.kind, header.size, header.big), ('f', 4, true));
        assert_eq!(header.shape, Shape::new([3, 2], true));
        assert_eq!(
            Header::parse("{'descr': '<f8', 'fortran_order': False, 'shape': (), }").unwrap().shape.len(),
            Some(1)
        );
        assert!(Header::parse("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (3,), }").is_err());
    }
}

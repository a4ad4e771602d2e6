//! MAT versions 5 to 7: tagged elements, one a variable, compressed since version 7.
//!
//! Source: "MAT-File Format", MathWorks, chapter 1. The tree is made in one pass over the elements without keeping their
//! numbers; an array is read by a second pass over the element it is in.

use crate::bytes::{Scalar, take};
use crate::error::{Fault, Read, one_line};
use crate::tree::{Array, Arrays, Entry, Flat, Node, Shape};
use flate2::read::ZlibDecoder;
use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek, SeekFrom};
use std::path::{Path, PathBuf};

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Deepest structs and cells.
const DEEPEST: usize = 32;
/// Most text that is kept of a variable, bytes.
const MOST_TEXT: u64 = 1 << 16;

/// Where an array is: byte of the element it is in, and its number among the arrays of that element.
#[derive(Debug, Clone, Copy)]
struct Locator {
    element: u64,
    number: usize,
}

pub(super) struct V5 {
    path: PathBuf,
    big: bool,
    arrays: Vec<Locator>,
}

pub(super) fn tree(path: &Path) -> Read<(Vec<Entry>, V5)> {
    let length = std::fs::metadata(path)?.len();
    let mut file = BufReader::new(File::open(path)?);
    let header = take(&mut file, 128)?;
    let big = match &header[126..] {
        b"IM" => false,
        b"MI" => true,
        _ => return Err(Fault::byte(126, "is no mark of a byte order; the file is damaged: save it again")),
    };
    let subsystem = u64::from_le_bytes(header[116..124].try_into().unwrap_or_default());
    let mut mat = V5 { path: path.to_owned(), big, arrays: Vec::new() };
    let (mut entries, mut at) = (Vec::new(), 128);
    while at + 8 <= length {
        let (entry, next) = mat.element(at, length).map_err(|fault| fault.within(format!("variable at byte {at}")))?;
        // The subsystem holds what objects refer to, no variable of the user.
        if let Some(entry) = entry.filter(|_| at != subsystem) {
            entries.push(entry);
        }
        at = next;
    }
    Ok((entries, mat))
}

impl V5 {
    /// The variable in the element at a byte, and the byte of the next.
    fn element(&mut self, at: u64, length: u64) -> Read<(Option<Entry>, u64)> {
        let (mut input, kind, end) = self.enter(at)?;
        if end > length {
            return Err(Fault::byte(
                at,
                "states more bytes than follow; the file was cut short: copy or save it again",
            ));
        }
        if kind != MATRIX {
            return Ok((None, end));
        }
        let mut walk = Walk { input: &mut input, big: self.big, number: 0, wanted: None, found: None };
        let mut entry = walk.matrix(0)?;
        let first = self.arrays.len();
        self.arrays.extend((0..walk.number).map(|number| Locator { element: at, number }));
        if let Some(entry) = &mut entry {
            shift(entry, first);
        }
        Ok((entry, end))
    }

    /// Opens the element at a byte: its bytes behind the tag of its matrix, its type, and where it ends.
    fn enter(&self, at: u64) -> Read<(Input, u32, u64)> {
        let mut file = BufReader::new(File::open(&self.path)?);
        file.seek(SeekFrom::Start(at))?;
        let tag = take(&mut file, 8)?;
        let (kind, size) = (word(&tag, self.big), word(&tag[4..], self.big));
        let end = at + 8 + u64::from(size);
        if kind != COMPRESSED {
            // Only compressed elements end where they end; others are filled up to eight bytes.
            return Ok((Input::Plain(file.take(size.into())), kind, end.next_multiple_of(8)));
        }
        let mut inside = Input::Packed(Box::new(ZlibDecoder::new(file.take(size.into()))));
        let tag = inside.some(8)?;
        Ok((inside, word(&tag, self.big), end))
    }
}

/// Numbers of arrays in an element become numbers in the file.
fn shift(entry: &mut Entry, first: usize) {
    match &mut entry.node {
        Node::Array(array) => array.id += first,
        Node::Group(entries) => entries.iter_mut().for_each(|entry| shift(entry, first)),
        _ => {}
    }
}

fn word(bytes: &[u8], big: bool) -> u32 {
    let bytes = bytes.get(..4).and_then(|bytes| bytes.try_into().ok()).unwrap_or_default();
    if big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
}

/// Bytes of an element.
enum Input {
    Plain(io::Take<BufReader<File>>),
    Packed(Box<ZlibDecoder<io::Take<BufReader<File>>>>),
}

impl io::Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.read(buffer),
            Self::Packed(stream) => stream.read(buffer),
        }
    }
}

impl Input {
    fn some(&mut self, count: u64) -> Read<Vec<u8>> {
        take(self, count).map_err(|fault| match self {
            Self::Packed(_) if fault.problem.starts_with("cannot be read") => {
                Fault::new("its compressed data are damaged; save the file again")
            }
            _ => fault,
        })
    }

    fn skip(&mut self, count: u64) -> Read<()> {
        if let Self::Plain(file) = self {
            // Within the element: a jump in place of reading.
            if count > file.limit() {
                return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
            }
            let left = file.limit() - count;
            file.get_mut().seek_relative(i64::try_from(count).unwrap_or(i64::MAX))?;
            file.set_limit(left);
            return Ok(());
        }
        let passed = io::copy(&mut self.take(count), &mut io::sink()).map_err(Fault::from)?;
        if passed < count { Err(io::Error::from(io::ErrorKind::UnexpectedEof).into()) } else { Ok(()) }
    }
}

/// Header of a matrix.
struct Header {
    class: u32,
    complex: bool,
    extents: Vec<u64>,
    name: String,
}

/// A pass over the matrices of an element.
struct Walk<'a> {
    input: &'a mut Input,
    big: bool,
    /// Arrays met so far.
    number: usize,
    /// Number of the array whose values are wanted.
    wanted: Option<usize>,
    found: Option<Flat>,
}

impl Walk<'_> {
    /// Tag of an element: its type, its size, and its data where they are in the tag.
    fn tag(&mut self) -> Read<(u32, u64, Option<Vec<u8>>)> {
        let tag = self.input.some(8)?;
        let first = word(&tag, self.big);
        if first >> 16 != 0 {
            let (kind, size) = (first & 0xFFFF, (first >> 16) as usize);
            return Ok((kind, size as u64, Some(tag[4..4 + size.min(4)].to_vec())));
        }
        Ok((first, u64::from(word(&tag[4..], self.big)), None))
    }

    /// A whole small element of at most `most` bytes.
    fn small(&mut self, most: u64) -> Read<(u32, Vec<u8>)> {
        let (kind, size, inside) = self.tag()?;
        if let Some(bytes) = inside {
            return Ok((kind, bytes));
        }
        if size > most {
            return Err(Fault::new(format!(
                "a part of a header states {size} bytes; the file is damaged: save it again"
            )));
        }
        let bytes = self.input.some(size)?;
        self.input.skip(size.next_multiple_of(8) - size)?;
        Ok((kind, bytes))
    }

    fn header(&mut self) -> Read<Header> {
        let (_, flags) = self.small(64)?;
        let flags = word(&flags, self.big);
        let (_, extents) = self.small(1 << 12)?;
        let extents = extents.chunks_exact(4).map(|bytes| u64::from(word(bytes, self.big))).collect();
        let (_, name) = self.small(1 << 12)?;
        let name = String::from_utf8_lossy(&name).trim_end_matches('\0').to_owned();
        Ok(Header { class: flags & 0xFF, complex: flags & 0x800 != 0, extents, name })
    }

    /// The matrix whose tag was read; none for an empty one.
    fn matrix(&mut self, depth: usize) -> Read<Option<Entry>> {
        if depth > DEEPEST {
            return Err(Fault::new("structs and cells are nested too deeply; save their parts alone"));
        }
        // Opaque objects have flags and then words in place of extents.
        let header = self.header()?;
        let name = header.name.clone();
        let node = match header.class {
            1 => self.cell(&header, depth)?,
            2 | 3 => self.fields(&header, depth)?,
            4 => Node::Text(self.text(&header)?),
            5 => Node::Skipped("it is sparse; save full(...) of it".to_owned()),
            6..=15 => Node::Array(self.numbers(&header)?),
            16 => Node::Skipped("it is a function".to_owned()),
            17 => Node::Skipped(
                "it is an object of MATLAB (string, table, datetime, timeseries); save its numbers as arrays"
                    .to_owned(),
            ),
            other => {
                return Err(Fault::new(format!("is of an unknown class {other}; the file is damaged: save it again")));
            }
        };
        Ok(Some(Entry::new(name, node)))
    }

    /// A matrix within a struct or cell, called `name`.
    fn inner(&mut self, name: String, depth: usize) -> Read<Option<Entry>> {
        let (kind, size, _) = self.tag()?;
        if kind != MATRIX {
            return Err(Fault::new(format!(
                "\"{name}\" holds an element of type {kind} where a matrix must be; save the file again"
            )));
        }
        if size == 0 {
            return Ok(None);
        }
        let before = self.position();
        let entry = self.matrix(depth + 1)?;
        self.close(before, size)?;
        Ok(entry.map(|entry| Entry { name, ..entry }))
    }

    /// Bytes that were read so far.
    fn position(&self) -> u64 {
        match &*self.input {
            Input::Plain(file) => u64::MAX - file.limit(),
            Input::Packed(stream) => stream.total_out(),
        }
    }

    /// Passes over what is left of an element of `size` bytes.
    fn close(&mut self, before: u64, size: u64) -> Read<()> {
        let read = self.position() - before;
        match size.next_multiple_of(8).checked_sub(read) {
            Some(rest) => self.input.skip(rest),
            None => Err(Fault::new("a matrix is longer than it states; the file is damaged: save it again")),
        }
    }

    fn count(header: &Header) -> Read<u64> {
        let product = header.extents.iter().try_fold(1_u64, |product, &extent| product.checked_mul(extent));
        product.ok_or_else(|| {
            Fault::new(format!("\"{}\" states more values than any file holds; save it again", header.name))
        })
    }

    fn cell(&mut self, header: &Header, depth: usize) -> Read<Node> {
        let count = Self::count(header)?;
        let mut entries = Vec::new();
        for i in 0..count {
            entries.extend(self.inner(format!("{{{}}}", i + 1), depth)?);
        }
        // A cell of texts is a list of names.
        let texts: Option<Vec<String>> = entries
            .iter()
            .map(|entry| match &entry.node {
                Node::Text(texts) => Some(texts.join(" ")),
                _ => None,
            })
            .collect();
        Ok(match texts {
            Some(texts) if !texts.is_empty() => Node::Text(texts),
            _ => Node::Group(entries),
        })
    }

    fn fields(&mut self, header: &Header, depth: usize) -> Read<Node> {
        let count = Self::count(header)?;
        if header.class == 3 {
            self.small(1 << 12)?;
        }
        let (_, length) = self.small(64)?;
        let length = word(&length, self.big) as usize;
        let (_, names) = self.small(1 << 20)?;
        if length == 0 || length > 4096 {
            return Err(Fault::new("its names of fields have no length; the file is damaged: save it again"));
        }
        let name = |bytes: &[u8]| {
            String::from_utf8_lossy(bytes.split(|&byte| byte == 0).next().unwrap_or_default()).into_owned()
        };
        let names: Vec<String> = names.chunks_exact(length).map(name).collect();
        let mut all = Vec::new();
        for i in 0..if names.is_empty() { 0 } else { count } {
            let mut fields = Vec::new();
            for name in &names {
                fields.extend(self.inner(name.clone(), depth)?);
            }
            if count == 1 {
                return Ok(Node::Group(fields));
            }
            all.push(Entry::new(format!("({})", i + 1), Node::Group(fields)));
        }
        Ok(Node::Group(all))
    }

    /// Rows of a text.
    fn text(&mut self, header: &Header) -> Read<Vec<String>> {
        let (kind, size, inside) = self.tag()?;
        let bytes = match inside {
            Some(bytes) => bytes,
            None if size > MOST_TEXT => {
                self.input.skip(size.next_multiple_of(8))?;
                return Ok(vec!["(long text)".to_owned()]);
            }
            None => {
                let bytes = self.input.some(size)?;
                self.input.skip(size.next_multiple_of(8) - size)?;
                bytes
            }
        };
        let letters: Vec<char> = match kind {
            4 | 17 | 3 => {
                let pair = |pair: &[u8]| {
                    if self.big {
                        u16::from_be_bytes([pair[0], pair[1]])
                    } else {
                        u16::from_le_bytes([pair[0], pair[1]])
                    }
                };
                char::decode_utf16(bytes.chunks_exact(2).map(pair)).map(|c| c.unwrap_or('?')).collect()
            }
            _ => String::from_utf8_lossy(&bytes).chars().collect(),
        };
        let rows = usize::try_from(header.extents.first().copied().unwrap_or(1)).unwrap_or(1).max(1);
        if rows == 1 || rows > letters.len() {
            return Ok(vec![one_line(&letters.iter().collect::<String>(), 400)]);
        }
        Ok((0..rows).map(|row| one_line(&letters.iter().skip(row).step_by(rows).collect::<String>(), 400)).collect())
    }

    fn numbers(&mut self, header: &Header) -> Read<Array> {
        let id = self.number;
        self.number += 1;
        let shape = Shape::new(header.extents.iter().copied(), true);
        let count = Self::count(header)?;
        let wanted = shape.wanted();
        let whole = self.wanted == Some(id);
        let re = self.part(count, &wanted, whole, &header.name)?;
        let im = if header.complex { self.part(count, &wanted, whole, &header.name)? } else { Vec::new() };
        let peek = if whole {
            self.found = Some(Flat { re, im });
            Vec::new()
        } else {
            (0..re.len()).map(|i| [re[i], im.get(i).copied().unwrap_or(0.0)]).collect()
        };
        Ok(Array { id, shape, complex: header.complex, peek })
    }

    /// The real or the imaginary part: all of it, or the values at the places wanted.
    fn part(&mut self, count: u64, wanted: &[u64], whole: bool, name: &str) -> Read<Vec<f64>> {
        let (kind, size, inside) = self.tag()?;
        let scalar = match kind {
            1 => Scalar::I8,
            2 => Scalar::U8,
            3 => Scalar::I16,
            4 => Scalar::U16,
            5 => Scalar::I32,
            6 => Scalar::U32,
            7 => Scalar::F32,
            9 => Scalar::F64,
            12 => Scalar::I64,
            13 => Scalar::U64,
            other => {
                return Err(Fault::new(format!(
                    "\"{name}\" has numbers of an unknown type {other}; save the file again"
                )));
            }
        };
        let width = scalar.size() as u64;
        if size / width != count {
            let found = size / width;
            return Err(Fault::new(format!("\"{name}\" states {count} values and holds {found}; save the file again")));
        }
        if let Some(bytes) = inside {
            let all = scalar.all(&bytes, self.big);
            return Ok(if whole { all } else { wanted.iter().filter_map(|&i| all.get(i as usize).copied()).collect() });
        }
        let values = if whole {
            scalar.all(&self.input.some(size)?, self.big)
        } else {
            let (mut values, mut at) = (Vec::with_capacity(wanted.len()), 0);
            for &place in wanted {
                self.input.skip((place - at) * width)?;
                values.push(scalar.get(&self.input.some(width)?, self.big).unwrap_or(f64::NAN));
                at = place + 1;
            }
            self.input.skip((count - at) * width)?;
            values
        };
        self.input.skip(size.next_multiple_of(8) - count * width)?;
        Ok(values)
    }
}

impl Arrays for V5 {
    fn read(&self, id: usize) -> Read<Flat> {
        let place = *self.arrays.get(id).ok_or_else(|| Fault::new("there is no such array"))?;
        let (mut input, _, _) = self.enter(place.element)?;
        let mut walk = Walk { input: &mut input, big: self.big, number: 0, wanted: Some(place.number), found: None };
        walk.matrix(0)?;
        walk.found.ok_or_else(|| Fault::new("its numbers are not where they were; was the file changed?"))
    }
}

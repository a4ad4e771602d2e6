//! MAT versions 5 to 7: tagged elements, one a variable, compressed since version 7.
//!
//! Source: "MAT-File Format", MathWorks, chapter 1. The tree is made in one pass over the elements without keeping their
//! numbers; an array is read by a second pass over the element it is in.

use super::input::{Input, Part, word};
use crate::bytes::take;
use crate::error::{Fault, Read, one_line};
use crate::tree::{Arrays, Cut, Entry, Flat, Node};
use flate2::read::ZlibDecoder;
use std::fs::File;
use std::io::{BufReader, Read as _, Seek, SeekFrom};
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

/// Header of a matrix.
pub(super) struct Header {
    class: u32,
    pub complex: bool,
    pub extents: Vec<u64>,
    pub name: String,
}

/// A pass over the matrices of an element.
pub(super) struct Walk<'a> {
    pub input: &'a mut Input,
    pub big: bool,
    /// Arrays met so far.
    pub number: usize,
    /// Number of the array whose values are wanted, and the channel of it where not all are.
    pub wanted: Option<(usize, Option<Part>)>,
    pub found: Option<Flat>,
}

impl Walk<'_> {
    /// Tag of an element: its type, its size, and its data where they are in the tag.
    pub(super) fn tag(&mut self) -> Read<(u32, u64, Option<Vec<u8>>)> {
        let tag = self.input.some(8)?;
        let first = word(&tag, self.big);
        if first >> 16 != 0 {
            let (kind, size) = (first & 0xFFFF, (first >> 16) as usize);
            if size > 4 {
                let problem =
                    format!("a part of {size} bytes is said to be in four; the file is damaged: save it again");
                return Err(Fault::new(problem));
            }
            return Ok((kind, size as u64, Some(tag[4..4 + size].to_vec())));
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

    pub(super) fn count(header: &Header) -> Read<u64> {
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
        Ok(crate::tree::of_cell(entries))
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
}

impl Arrays for V5 {
    fn read(&self, id: usize) -> Read<Flat> {
        self.values(id, None)
    }

    fn column(&self, id: usize, cut: &Cut, channel: u64) -> Option<Read<Flat>> {
        Some(self.values(id, Some(Part { cut: cut.clone(), channel })))
    }
}

impl V5 {
    fn values(&self, id: usize, part: Option<Part>) -> Read<Flat> {
        let place = *self.arrays.get(id).ok_or_else(|| Fault::new("there is no such array"))?;
        let (mut input, _, _) = self.enter(place.element)?;
        let wanted = Some((place.number, part));
        let mut walk = Walk { input: &mut input, big: self.big, number: 0, wanted, found: None };
        walk.matrix(0)?;
        walk.found.ok_or_else(|| Fault::new("its numbers are not where they were; was the file changed?"))
    }
}

//! MAT version 4: matrices one after the other, each with a header of 20 bytes.
//!
//! Source: "MAT-File Format", MathWorks, chapter 2. Header: `1000 M + 10 P + T`, rows, columns, imaginary flag, length of
//! the name.

use crate::bytes::{Scalar, check_size, strided, take};
use crate::error::{Fault, Read, one_line};
use crate::tree::{Array, Arrays, Cut, Entry, Flat, Node, Shape};
use std::fs::File;
use std::io::{BufReader, Read as _, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// A matrix of the file.
#[derive(Debug, Clone)]
struct Header {
    scalar: Scalar,
    big: bool,
    text: bool,
    sparse: bool,
    extents: [u64; 2],
    complex: bool,
    name: String,
    /// Byte of the first number.
    data: u64,
}

pub(super) struct V4 {
    path: PathBuf,
    headers: Vec<Header>,
}

/// Whether bytes can be the header of a first matrix: words of its type are told from anything else.
pub(crate) fn is_v4(start: &[u8], length: u64) -> bool {
    let Some(fields) = fields(start) else { return false };
    let ([kind, rows, columns, imaginary, name], _) = fields;
    let plausible = kind % 10 <= 2 && kind / 10 % 10 <= 5 && kind / 100 % 10 == 0;
    plausible
        && imaginary <= 1
        && (2..256).contains(&name)
        && u64::from(rows) * u64::from(columns) <= length
        && start.get(20..20 + name as usize - 1).is_some_and(|name| {
            name.iter().all(|byte| byte.is_ascii_alphanumeric() || *byte == b'_')
                && name.first().is_some_and(u8::is_ascii_alphabetic)
        })
        && start.get(20 + name as usize - 1) == Some(&0)
}

/// The five words of a header and whether they are big-endian.
fn fields(bytes: &[u8]) -> Option<([u32; 5], bool)> {
    let word = |i: usize, big: bool| {
        let bytes = bytes.get(4 * i..4 * i + 4)?.try_into().ok()?;
        Some(if big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    };
    let big = match (word(0, false)?, word(0, true)?) {
        (0..100, _) => false,
        (_, 1000..1100) => true,
        _ => return None,
    };
    Some(([word(0, big)? % 1000, word(1, big)?, word(2, big)?, word(3, big)?, word(4, big)?], big))
}

pub(super) fn tree(path: &Path) -> Read<(Vec<Entry>, V4)> {
    let length = std::fs::metadata(path)?.len();
    let mut file = BufReader::new(File::open(path)?);
    let mut at = 0;
    let mut v4 = V4 { path: path.to_owned(), headers: Vec::new() };
    let mut entries = Vec::new();
    while at < length {
        let header = header(&mut file, at, length)?;
        let size = header.bytes();
        at = header.data + size;
        v4.headers.push(header);
        let entry = v4.entry(v4.headers.len() - 1)?;
        entries.push(entry);
        file.seek(SeekFrom::Start(at))?;
    }
    Ok((entries, v4))
}

fn header(file: &mut BufReader<File>, at: u64, length: u64) -> Read<Header> {
    let damaged = || Fault::byte(at, "is no header of a matrix; the file is damaged: save it again, as version 7");
    let bytes = take(file, 20)?;
    let ([kind, rows, columns, imaginary, name], big) = fields(&bytes).ok_or_else(damaged)?;
    let scalar = match kind / 10 % 10 {
        0 => Scalar::F64,
        1 => Scalar::F32,
        2 => Scalar::I32,
        3 => Scalar::I16,
        4 => Scalar::U16,
        5 => Scalar::U8,
        _ => return Err(damaged()),
    };
    if kind >= 100 || name == 0 || name > 4096 {
        return Err(damaged());
    }
    let text = String::from_utf8_lossy(&take(file, u64::from(name))?).trim_end_matches('\0').to_owned();
    let data = at + 20 + u64::from(name);
    let header = Header {
        scalar,
        big,
        text: kind % 10 == 1,
        sparse: kind % 10 == 2,
        extents: [rows.into(), columns.into()],
        complex: imaginary == 1,
        name: text,
        data,
    };
    let count = header.extents[0].saturating_mul(header.extents[1]);
    let parts = if header.complex { 2 } else { 1 };
    check_size(count, scalar.size() as u64 * parts, length.saturating_sub(data), data)?;
    Ok(header)
}

impl Header {
    fn count(&self) -> u64 {
        self.extents[0] * self.extents[1]
    }

    fn bytes(&self) -> u64 {
        self.count() * self.scalar.size() as u64 * if self.complex { 2 } else { 1 }
    }
}

impl V4 {
    fn entry(&self, id: usize) -> Read<Entry> {
        let header = &self.headers[id];
        let name = header.name.clone();
        if header.sparse {
            return Ok(Entry::new(name, Node::Skipped("it is sparse; save full(...) of it".to_owned())));
        }
        if header.text {
            return Ok(Entry::new(name, Node::Text(self.text(id)?)));
        }
        let shape = Shape::new(header.extents, true);
        let wanted = shape.wanted();
        let mut file = File::open(&self.path)?;
        let size = header.scalar.size() as u64;
        let part = header.count() * size;
        let mut value = |at: u64| -> Read<f64> {
            let mut bytes = [0; 8];
            file.seek(SeekFrom::Start(at))?;
            file.read_exact(&mut bytes[..header.scalar.size()])?;
            Ok(header.scalar.get(&bytes, header.big).unwrap_or(f64::NAN))
        };
        let mut peek = Vec::new();
        for i in wanted {
            let re = value(header.data + i * size)?;
            peek.push([re, if header.complex { value(header.data + part + i * size)? } else { 0.0 }]);
        }
        Ok(Entry::new(name, Node::Array(Array { id, shape, complex: header.complex, peek })))
    }

    /// Rows of a text matrix.
    fn text(&self, id: usize) -> Read<Vec<String>> {
        let header = &self.headers[id];
        let [rows, columns] = header.extents;
        if rows > 10_000 || columns > 10_000 {
            return Ok(vec!["(long text)".to_owned()]);
        }
        let flat = self.read(id)?;
        let letter = |row: u64, column: u64| {
            let code = flat.re.get((column * rows + row) as usize).copied().unwrap_or(0.0);
            char::from_u32(code as u32).unwrap_or(' ')
        };
        Ok((0..rows)
            .map(|row| one_line(&(0..columns).map(|column| letter(row, column)).collect::<String>(), 400))
            .collect())
    }
}

impl Arrays for V4 {
    fn read(&self, id: usize) -> Read<Flat> {
        let header = self.headers.get(id).ok_or_else(|| Fault::new("there is no such matrix"))?;
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(header.data))?;
        let part = header.count() * header.scalar.size() as u64;
        let re = header.scalar.all(&take(&mut file, part)?, header.big);
        let im = if header.complex { header.scalar.all(&take(&mut file, part)?, header.big) } else { Vec::new() };
        Ok(Flat { re, im })
    }

    fn column(&self, id: usize, cut: &Cut, channel: u64) -> Option<Read<Flat>> {
        let header = self.headers.get(id).filter(|header| !header.complex)?;
        let read = || {
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(header.data + cut.offset(channel) * header.scalar.size() as u64))?;
            strided(&mut file, header.scalar, header.big, cut.stride, cut.count).map(Flat::real)
        };
        Some(read())
    }
}

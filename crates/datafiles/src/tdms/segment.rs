//! Segments of a TDMS file: from lead-ins and metadata to where the values of each channel lie.

use super::input::Input;
use super::objects::{Coding, Object, Run, names, property};
use crate::bytes::Scalar;
use crate::error::{Fault, Read};
use crate::note::{Defect, Note};
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Seek, SeekFrom};
use std::path::Path;

const META: u32 = 2;
const NEW_LIST: u32 = 4;
const RAW: u32 = 8;
const INTERLEAVED: u32 = 32;
const BIG: u32 = 64;
const DAQMX: u32 = 128;
const LEAD: u64 = 28;
/// Most objects of a file.
const MOST_OBJECTS: usize = 1_000_000;
/// Most scalers of a channel.
const MOST_SCALERS: u32 = 4096;

/// What a segment holds of a channel.
#[derive(Debug, Clone)]
struct Index {
    coding: Coding,
    count: u64,
    /// Bytes in a chunk, for texts.
    bytes: u64,
    /// Place in the buffers of NI-DAQmx.
    daqmx: Option<Daqmx>,
}

#[derive(Debug, Clone)]
struct Daqmx {
    buffer: usize,
    offset: u64,
    widths: Vec<u64>,
    several: bool,
}

/// Objects that have data in a segment, in their order.
type Active = Vec<(usize, Option<Index>)>;

struct Reader {
    objects: Vec<Object>,
    known: HashMap<String, usize>,
    /// Newest index of each object.
    indices: Vec<Option<Index>>,
    active: Active,
    notes: Vec<Note>,
}

/// All objects of a file, and what the user should know of it.
pub(super) fn objects(path: &Path) -> Read<(Vec<Object>, Vec<Note>)> {
    let length = std::fs::metadata(path)?.len();
    let mut file = BufReader::new(File::open(path)?);
    let mut reader = Reader {
        objects: Vec::new(),
        known: HashMap::new(),
        indices: Vec::new(),
        active: Vec::new(),
        notes: Vec::new(),
    };
    let mut at = 0;
    while at + LEAD <= length {
        at = reader.segment(&mut file, at, length)?;
    }
    if at < length {
        reader.notes.push(broken_off(format!("the last {} bytes are no whole segment", length - at)));
    }
    Ok((reader.objects, reader.notes))
}

/// That a file stops before its last segment does, with what shows it.
fn broken_off(shown_by: String) -> Note {
    Note::new(Defect::BrokenOff, format!("{shown_by}: the recording was broken off"))
}

impl Reader {
    /// Reads the segment at a byte and returns that of the next.
    fn segment(&mut self, file: &mut BufReader<File>, at: u64, length: u64) -> Read<u64> {
        file.seek(SeekFrom::Start(at))?;
        let mut input = Input { file, big: false };
        if input.array::<4>()? != *b"TDSm" {
            return Err(Fault::byte(at, "no segment begins here; the file is damaged: copy or export it again"));
        }
        let toc = input.u32()?;
        input.big = toc & BIG != 0;
        let version = input.u32()?;
        if !(4712..=4713).contains(&version) {
            return Err(Fault::byte(at + 8, format!("version {version} of TDMS is not known; save it as version 2.0")));
        }
        let (next, raw) = (input.u64()?, input.u64()?);
        let end = if next == u64::MAX { length } else { at.saturating_add(LEAD).saturating_add(next) };
        if end > length {
            self.notes.push(broken_off(format!("the segment at byte {at} goes on behind the end of the file")));
        }
        let end = end.min(length);
        if toc & META != 0 {
            self.metadata(&mut input, toc & NEW_LIST != 0, end)
                .map_err(|fault| fault.within(format!("segment at byte {at}")))?;
        }
        let data = at.saturating_add(LEAD).saturating_add(raw);
        if toc & RAW != 0 && data < end {
            self.data(data, end, toc)?;
        }
        Ok(end)
    }

    fn metadata(&mut self, input: &mut Input<'_>, new: bool, end: u64) -> Read<()> {
        if new {
            self.active.clear();
        }
        for _ in 0..input.u32()? {
            let path = input.text()?;
            let index = self.object(&path)?;
            let found = self.index(input, index)?;
            if let Some(found) = found {
                self.indices[index] = found.clone();
                match self.active.iter_mut().find(|(object, _)| *object == index) {
                    Some((_, old)) => *old = found,
                    None => self.active.push((index, found)),
                }
            }
            for _ in 0..input.u32()? {
                let (name, value) = property(input)?;
                self.objects[index].set(name, value);
            }
            if input.position()? > end {
                return Err(Fault::byte(
                    end,
                    "the metadata go on behind their segment; the file is damaged: copy or export it again",
                ));
            }
        }
        Ok(())
    }

    fn object(&mut self, path: &str) -> Read<usize> {
        if let Some(&known) = self.known.get(path) {
            return Ok(known);
        }
        let names = names(path).ok_or_else(|| {
            Fault::new(format!("\"{path}\" is no path of an object; the file is damaged: copy or export it again"))
        })?;
        if self.objects.len() >= MOST_OBJECTS {
            return Err(Fault::new(format!("has more than {MOST_OBJECTS} objects; export the measurement alone")));
        }
        // A channel may come before its group.
        if names.len() == 2 {
            self.object(&format!("/'{}'", names[0].replace('\'', "''")))?;
        }
        let index = self.objects.len();
        self.objects.push(Object { path: names, ..Object::default() });
        self.indices.push(None);
        self.known.insert(path.to_owned(), index);
        Ok(index)
    }

    /// The index of an object: none where the object has no data; the newest where it stays the same.
    fn index(&self, input: &mut Input<'_>, object: usize) -> Read<Option<Option<Index>>> {
        match input.u32()? {
            u32::MAX => Ok(Some(None)),
            0 => Ok(Some(self.indices[object].clone())),
            0x0000_1269 | 0x6912_0000 => daqmx(input, false).map(|index| Some(Some(index))),
            0x0000_126A | 0x6A12_0000 => daqmx(input, true).map(|index| Some(Some(index))),
            _ => {
                let kind = input.u32()?;
                let extents = input.u32()?;
                let count = input.u64()?;
                let at = input.position()?;
                if extents != 1 {
                    return Err(Fault::byte(
                        at,
                        format!("data of {extents} extents are stated; the file is damaged: copy or export it again"),
                    ));
                }
                let coding = Coding::of(kind);
                let bytes = if kind == 0x20 { input.u64()? } else { count.saturating_mul(coding.size()) };
                Ok(Some(Some(Index { coding, count, bytes, daqmx: None })))
            }
        }
    }

    /// Notes where the values of the raw data from byte `data` to `end` lie.
    fn data(&mut self, data: u64, end: u64, toc: u32) -> Read<()> {
        let active: Vec<(usize, Index)> = self
            .active
            .iter()
            .filter_map(|(object, index)| Some((*object, index.clone()?)))
            .filter(|(_, index)| index.count > 0)
            .collect();
        if active.is_empty() {
            return Ok(());
        }
        if let Some(object) =
            active.iter().find(|(_, index)| matches!(index.coding, Coding::Other(kind, 0) if kind != 0x20))
        {
            let name = self.objects[object.0].path.join("/");
            return Err(Fault::byte(
                data,
                format!("channel \"{name}\" is of an unknown type; export it again as numbers"),
            ));
        }
        let big = toc & BIG != 0;
        if toc & DAQMX != 0 || active.iter().any(|(_, index)| index.daqmx.is_some()) {
            self.buffers(data, end, &active, big)
        } else if toc & INTERLEAVED != 0 {
            self.interleaved(data, end, &active, big);
            Ok(())
        } else {
            self.contiguous(data, end, &active, big);
            Ok(())
        }
    }

    /// Chunks, in each of which the values of one channel follow those of the other.
    fn contiguous(&mut self, data: u64, end: u64, active: &[(usize, Index)], big: bool) {
        let chunk = active.iter().fold(0_u64, |sum, (_, index)| sum.saturating_add(index.bytes)).max(1);
        let (whole, rest) = ((end - data) / chunk, (end - data) % chunk);
        let mut start = data;
        for (object, index) in active {
            let size = index.coding.size().max(1);
            // What a chunk that was broken off still has of this channel.
            let before = start - data;
            let partial = (rest.saturating_sub(before) / size).min(index.count);
            let (chunks, last) = if partial > 0 { (whole + 1, partial) } else { (whole, index.count) };
            self.run(
                *object,
                index,
                Run { coding: index.coding, big, start, count: index.count, last, chunks, chunk, stride: size },
            );
            start = start.saturating_add(index.bytes);
        }
    }

    /// Rows with one value of each channel.
    fn interleaved(&mut self, data: u64, end: u64, active: &[(usize, Index)], big: bool) {
        let row: u64 = active.iter().map(|(_, index)| index.coding.size()).sum::<u64>().max(1);
        let rows = (end - data) / row;
        let mut start = data;
        for (object, index) in active {
            let run = Run {
                coding: index.coding,
                big,
                start,
                count: rows,
                last: rows,
                chunks: u64::from(rows > 0),
                chunk: 0,
                stride: row,
            };
            self.run(*object, index, run);
            start += index.coding.size();
        }
    }

    /// Buffers of NI-DAQmx, each of rows with the values of some channels.
    fn buffers(&mut self, data: u64, end: u64, active: &[(usize, Index)], big: bool) -> Read<()> {
        let mixed = || Fault::byte(data, "raw data of NI-DAQmx and others are mixed; export the file again");
        let widths = &active[0].1.daqmx.as_ref().ok_or_else(mixed)?.widths.clone();
        let mut counts = vec![0_u64; widths.len()];
        for (_, index) in active {
            let daqmx = index.daqmx.as_ref().ok_or_else(mixed)?;
            let inside = widths.get(daqmx.buffer).is_some_and(|&width| daqmx.offset + index.coding.size() <= width);
            if daqmx.widths != *widths || !inside {
                return Err(mixed());
            }
            counts[daqmx.buffer] = counts[daqmx.buffer].max(index.count);
        }
        let sizes: Vec<u64> = widths.iter().zip(&counts).map(|(width, count)| width.saturating_mul(*count)).collect();
        let chunk = sizes.iter().fold(0_u64, |sum, size| sum.saturating_add(*size)).max(1);
        let (whole, rest) = ((end - data) / chunk, (end - data) % chunk);
        for (object, index) in active {
            let Some(daqmx) = &index.daqmx else { continue };
            let before = sizes[..daqmx.buffer].iter().fold(0_u64, |sum, size| sum.saturating_add(*size));
            let width = widths[daqmx.buffer].max(1);
            let partial = (rest.saturating_sub(before) / width).min(index.count);
            let (chunks, last) = if partial > 0 { (whole + 1, partial) } else { (whole, index.count) };
            let start = data.saturating_add(before).saturating_add(daqmx.offset);
            self.run(
                *object,
                index,
                Run { coding: index.coding, big, start, count: index.count, last, chunks, chunk, stride: width },
            );
            if daqmx.several {
                self.objects[*object].skipped =
                    Some("it is made of several raw channels; export it again as numbers".to_owned());
            }
        }
        Ok(())
    }

    fn run(&mut self, object: usize, index: &Index, run: Run) {
        let object = &mut self.objects[object];
        match index.coding {
            Coding::Other(0x20, _) => object.skipped = Some("it is text".to_owned()),
            Coding::Other(kind, _) => {
                object.skipped =
                    Some(format!("its values are of type {kind}, numbers of more than 64 bits; export it as double"));
            }
            coding => {
                let complex = matches!(coding, Coding::Complex(_));
                if !object.runs.is_empty() && object.complex != complex {
                    object.skipped = Some("its values are real in one segment and complex in another".to_owned());
                }
                object.complex = complex;
                if run.chunks > 0 {
                    object.runs.push(run);
                }
            }
        }
    }
}

/// Index of raw data of NI-DAQmx: scalers, then widths of buffers.
fn daqmx(input: &mut Input<'_>, digital: bool) -> Read<Index> {
    input.u32()?;
    input.u32()?;
    let count = input.u64()?;
    let scalers = input.u32()?;
    let at = input.position()?;
    let damaged = || Fault::byte(at, "the scalers of NI-DAQmx are damaged; copy or export the file again");
    if scalers == 0 || scalers > MOST_SCALERS {
        return Err(damaged());
    }
    let mut first = None;
    for _ in 0..scalers {
        let (kind, buffer, offset) = (input.u32()?, input.u32()?, input.u32()?);
        if digital {
            input.u8()?;
        } else {
            input.u32()?;
        }
        input.u32()?;
        let scalar = match kind {
            0 => Scalar::U8,
            1 => Scalar::I8,
            2 => Scalar::U16,
            3 => Scalar::I16,
            4 => Scalar::U32,
            5 => Scalar::I32,
            _ => return Err(damaged()),
        };
        // Digital lines count in bits.
        let offset = if digital { u64::from(offset) / 8 } else { u64::from(offset) };
        first.get_or_insert((scalar, buffer as usize, offset));
    }
    let buffers = input.u32()?;
    if buffers > MOST_SCALERS {
        return Err(damaged());
    }
    let widths: Read<Vec<u64>> = (0..buffers).map(|_| input.u32().map(u64::from)).collect();
    let (scalar, buffer, offset) = first.ok_or_else(damaged)?;
    let coding = if digital { Coding::Other(0, 1) } else { Coding::Number(scalar) };
    Ok(Index {
        coding,
        count,
        bytes: 0,
        daqmx: Some(Daqmx { buffer, offset, widths: widths?, several: scalers > 1 || digital }),
    })
}

//! WAV files: one channel a track; integers are shares of full scale as they are in the file.

use crate::bytes::{Scalar, check_size, columns, room};
use crate::contents::{Axis, Channel, Contents, FIRST, Format, Kind, Number, Set};
use crate::error::{Fault, Read};
use crate::source::Source;
use hound::{SampleFormat, WavReader};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use uff::Values;

struct Wav {
    path: PathBuf,
}

/// Opens a WAV file.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let mut reader = reader(path)?;
    let spec = reader.spec();
    let length = std::fs::metadata(path)?.len();
    let size = u64::from(spec.bits_per_sample.div_ceil(8)).max(1);
    check_size(u64::from(reader.len()), size, length, 0)?;
    if spec.channels == 0 || spec.sample_rate == 0 {
        return Err(Fault::new("has no channel or no sampling rate in its header; export it again"));
    }
    let (tracks, count) = (usize::from(spec.channels), u64::from(reader.duration()));
    let head = samples(&mut reader, FIRST * tracks)?;
    let mut set = Set::new("", Kind::Time);
    "s".clone_into(&mut set.axis_unit);
    for track in 0..tracks {
        let mut channel = Channel::new(format!("channel {}", track + 1), "", count);
        channel.axis = Axis::Even { start: 0.0, step: 1.0 / f64::from(spec.sample_rate) };
        channel.first = head.iter().skip(track).step_by(tracks).take(FIRST).map(|&value| Number::Real(value)).collect();
        set.channels.push(channel);
    }
    if spec.sample_format == SampleFormat::Int {
        let bits = spec.bits_per_sample;
        set.notes
            .push(format!("{bits} bit integers are divided by 2^{}: 1 is full scale", bits.saturating_sub(1)).into());
    }
    let mut contents = Contents::new(Format::Wav);
    contents.sets.push(set);
    Ok((contents, Box::new(Wav { path: path.to_owned() })))
}

fn reader(path: &Path) -> Read<WavReader<BufReader<File>>> {
    WavReader::open(path).map_err(wrong)
}

fn wrong(error: hound::Error) -> Fault {
    match error {
        // The library has no kind of its own for the end of the file.
        hound::Error::IoError(error) if error.to_string().contains("enough bytes") => {
            std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into()
        }
        hound::Error::IoError(error) => error.into(),
        hound::Error::Unsupported => {
            Fault::new("is a WAV file of a coding that is not read; save it as PCM or 32 bit float")
        }
        error => Fault::new(format!("is no readable WAV file ({error}); export it again as PCM or 32 bit float")),
    }
}

/// Up to `most` samples of all tracks from where the reader stands.
fn samples(reader: &mut WavReader<BufReader<File>>, most: usize) -> Read<Vec<f64>> {
    let spec = reader.spec();
    match spec.sample_format {
        SampleFormat::Float => {
            reader.samples::<f32>().take(most).map(|value| value.map(f64::from).map_err(wrong)).collect()
        }
        SampleFormat::Int => {
            let full = 2f64.powi(i32::from(spec.bits_per_sample) - 1);
            reader.samples::<i32>().take(most).map(|value| value.map(|v| f64::from(v) / full).map_err(wrong)).collect()
        }
    }
}

/// Tracks of a coding whose numbers have a plain type, in one pass; none of 24 bit and of single bytes.
fn plain(reader: WavReader<BufReader<File>>, tracks: &[usize]) -> Option<Read<Vec<Values>>> {
    let spec = reader.spec();
    let full = 2f64.powi(i32::from(spec.bits_per_sample) - 1);
    let (scalar, full) = match (spec.sample_format, spec.bits_per_sample) {
        (SampleFormat::Float, 32) => (Scalar::F32, 1.0),
        (SampleFormat::Int, 16) => (Scalar::I16, full),
        (SampleFormat::Int, 32) => (Scalar::I32, full),
        _ => return None,
    };
    let (count, wanted) = (u64::from(reader.duration()), tracks.iter().map(|&track| track as u64).collect::<Vec<_>>());
    // The reader stands at the first sample.
    let read = columns(&mut reader.into_inner(), scalar, false, u64::from(spec.channels), count, &wanted);
    let shares = |mut values: Vec<f64>| {
        values.iter_mut().for_each(|value| *value /= full);
        Values::Real(values)
    };
    Some(read.map(|columns| columns.into_iter().map(shares).collect()))
}

impl Source for Wav {
    fn read(&self, _set: usize, channel: usize) -> Read<Values> {
        if let Some(read) = plain(reader(&self.path)?, &[channel]) {
            return Ok(read?.pop().unwrap_or(Values::Real(Vec::new())));
        }
        let mut reader = reader(&self.path)?;
        let spec = reader.spec();
        let full = 2f64.powi(i32::from(spec.bits_per_sample) - 1);
        let mut values = room(u64::from(reader.duration()))?;
        for value in reader.samples::<i32>().skip(channel).step_by(usize::from(spec.channels)) {
            values.push(f64::from(value.map_err(wrong)?) / full);
        }
        Ok(Values::Real(values))
    }

    fn together(&self, _set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        // Rows are passed once, from the left to the right.
        let ascending = channels.windows(2).all(|pair| pair[0] < pair[1]);
        if ascending { plain(reader(&self.path).ok()?, channels) } else { None }
    }
}

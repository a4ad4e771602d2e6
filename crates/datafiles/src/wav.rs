//! WAV files: one channel a track; integers are shares of full scale as they are in the file.

use crate::bytes::{Scalar, check_size, room, strided};
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
        set.notes.push(format!("{bits} bit integers are divided by 2^{}: 1 is full scale", bits.saturating_sub(1)));
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

impl Source for Wav {
    fn read(&self, _set: usize, channel: usize) -> Read<Values> {
        let mut reader = reader(&self.path)?;
        let spec = reader.spec();
        let full = 2f64.powi(i32::from(spec.bits_per_sample) - 1);
        let tracks = usize::from(spec.channels);
        let count = u64::from(reader.duration());
        // The reader stands at the first sample. 24 bit and single bytes have no plain type of number.
        let plain = match (spec.sample_format, spec.bits_per_sample) {
            (SampleFormat::Float, 32) => Some((Scalar::F32, 1.0)),
            (SampleFormat::Int, 16) => Some((Scalar::I16, full)),
            (SampleFormat::Int, 32) => Some((Scalar::I32, full)),
            _ => None,
        };
        if let Some((scalar, full)) = plain {
            let mut file = reader.into_inner();
            file.seek_relative((channel * scalar.size()) as i64)?;
            let mut values = strided(&mut file, (scalar, false), tracks as u64, count)?;
            values.iter_mut().for_each(|value| *value /= full);
            return Ok(Values::Real(values));
        }
        let mut values = room(count)?;
        for value in reader.samples::<i32>().skip(channel).step_by(tracks) {
            values.push(f64::from(value.map_err(wrong)?) / full);
        }
        Ok(Values::Real(values))
    }
}

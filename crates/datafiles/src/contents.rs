//! What is in a file, as a tree that is cheap to make: sets, and channels with their units, steps and first values.

use crate::note::Note;
use uff::Values;

/// Most values of a channel that its entry shows.
pub(crate) const FIRST: usize = 3;

/// Format of a file, told by its content.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Format {
    Uff,
    Mat,
    Hdf5,
    Tdms,
    Lvm,
    Csv,
    Txt,
    Xlsx,
    Wav,
    Npy,
    Npz,
}

impl Format {
    /// Word for the format in listings.
    pub fn word(self) -> &'static str {
        match self {
            Self::Uff => "uff",
            Self::Mat => "mat",
            Self::Hdf5 => "hdf5",
            Self::Tdms => "tdms",
            Self::Lvm => "lvm",
            Self::Csv => "csv",
            Self::Txt => "txt",
            Self::Xlsx => "xlsx",
            Self::Wav => "wav",
            Self::Npy => "npy",
            Self::Npz => "npz",
        }
    }
}

/// What the channels of a set are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Samples over time.
    Time,
    /// Complex values over frequency.
    Frf,
    /// Real values over frequency: spectra, coherences.
    Spectrum,
    /// Nodes, lines, elements.
    Geometry,
    /// Shapes: modes, operating deflections.
    Shape,
    /// A matrix.
    Matrix,
    /// Numbers whose abscissa the file does not say.
    Table,
}

impl Kind {
    /// Word for the kind in listings.
    pub fn word(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Frf => "frf",
            Self::Spectrum => "spectrum",
            Self::Geometry => "geometry",
            Self::Shape => "shape",
            Self::Matrix => "matrix",
            Self::Table => "table",
        }
    }
}

/// A number of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    /// Real.
    Real(f64),
    /// Complex: real and imaginary part.
    Complex([f64; 2]),
}

/// The first values of a channel for its entry.
pub(crate) fn first_numbers(values: &Values) -> Vec<Number> {
    match values {
        Values::Real(values) => values.iter().take(FIRST).map(|&value| Number::Real(value)).collect(),
        Values::Complex(values) => values.iter().take(FIRST).map(|&value| Number::Complex(value)).collect(),
    }
}

/// The abscissa of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// None that the file says.
    None,
    /// `start + i step`, in the unit of the abscissa (s, Hz).
    Even {
        /// First value.
        start: f64,
        /// Difference of two values.
        step: f64,
    },
    /// Stored in the file; read by [`crate::DataFile::axis`]. `step` is the mean step where the values are even.
    Stored {
        /// Mean difference of two values, where they are even to 1 %.
        step: Option<f64>,
    },
}

impl Axis {
    /// Step, where the abscissa is even.
    pub fn step(&self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Even { step, .. } => Some(*step),
            Self::Stored { step } => *step,
        }
    }
}

/// A channel of a set.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name in the file; may be empty and need not be unique.
    pub name: String,
    /// Unit of its numbers in the words of the file; empty where the file has none.
    pub unit: String,
    /// Number of values.
    pub count: u64,
    /// Whether its values are complex.
    pub complex: bool,
    /// Abscissa.
    pub axis: Axis,
    /// Up to three first values.
    pub first: Vec<Number>,
    /// What else the file says of it: node, direction, reference, sensitivity and so on, each as word and value.
    pub attributes: Vec<(String, String)>,
}

impl Channel {
    pub(crate) fn new(name: impl Into<String>, unit: impl Into<String>, count: u64) -> Self {
        let (name, unit) = (name.into(), unit.into());
        Self { name, unit, count, complex: false, axis: Axis::None, first: Vec::new(), attributes: Vec::new() }
    }

    /// An attribute by its word.
    pub fn attribute(&self, word: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == word).map(|(_, value)| value.as_str())
    }
}

/// A set: channels that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Set {
    /// Name in the file: group, sheet, variable, number.
    pub name: String,
    /// What its channels are.
    pub kind: Kind,
    /// Unit of the abscissa, such as `s` or `Hz`; empty where there is none.
    pub axis_unit: String,
    /// Its channels.
    pub channels: Vec<Channel>,
    /// What the user should know: what was skipped and why, what was assumed.
    pub notes: Vec<Note>,
}

impl Set {
    pub(crate) fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self { name: name.into(), kind, axis_unit: String::new(), channels: Vec::new(), notes: Vec::new() }
    }
}

/// What is in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents {
    /// Format.
    pub format: Format,
    /// Sets in the order of the file.
    pub sets: Vec<Set>,
    /// What holds for the whole file.
    pub notes: Vec<Note>,
}

impl Contents {
    pub(crate) fn new(format: Format) -> Self {
        Self { format, sets: Vec::new(), notes: Vec::new() }
    }
}

//! Objects of a TDMS file: the root, groups, channels; their properties and where their data lie.

use super::input::Input;
use crate::bytes::Scalar;
use crate::error::{Fault, Read};

/// A value of a property.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Property {
    Text(String),
    Number(f64),
    /// Seconds from 1904-01-01 UTC.
    Time(f64),
}

impl Property {
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            _ => None,
        }
    }
}

impl std::fmt::Display for Property {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Text(text) => write!(f, "{text}"),
            Self::Number(value) => write!(f, "{value}"),
            Self::Time(seconds) => write!(f, "{seconds} s from 1904-01-01 UTC"),
        }
    }
}

/// How the values of a channel are coded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Coding {
    /// A number.
    Number(Scalar),
    /// Two numbers.
    Complex(Scalar),
    /// A time: fraction and seconds.
    Time,
    /// Not read; its size where it is fixed.
    Other(u32, u64),
}

impl Coding {
    /// The coding of a type of TDMS.
    pub(super) fn of(kind: u32) -> Self {
        match kind {
            1 => Self::Number(Scalar::I8),
            2 => Self::Number(Scalar::I16),
            3 => Self::Number(Scalar::I32),
            4 => Self::Number(Scalar::I64),
            5 | 0x21 => Self::Number(Scalar::U8),
            6 => Self::Number(Scalar::U16),
            7 => Self::Number(Scalar::U32),
            8 => Self::Number(Scalar::U64),
            9 | 0x19 => Self::Number(Scalar::F32),
            10 | 0x1A => Self::Number(Scalar::F64),
            0x44 => Self::Time,
            0x0008_000C => Self::Complex(Scalar::F32),
            0x0010_000D => Self::Complex(Scalar::F64),
            11 | 0x1B => Self::Other(kind, 16),
            _ => Self::Other(kind, 0),
        }
    }

    pub(super) fn size(self) -> u64 {
        match self {
            Self::Number(scalar) => scalar.size() as u64,
            Self::Complex(scalar) => 2 * scalar.size() as u64,
            Self::Time => 16,
            Self::Other(_, size) => size,
        }
    }
}

/// Values at even distances, in chunks at even distances.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub coding: Coding,
    pub big: bool,
    /// Byte of the first value.
    pub start: u64,
    /// Values in a chunk, and in the last one.
    pub count: u64,
    pub last: u64,
    pub chunks: u64,
    /// Bytes from chunk to chunk and from value to value.
    pub chunk: u64,
    pub stride: u64,
}

impl Run {
    pub(super) fn size(&self) -> u64 {
        self.coding.size()
    }

    pub(super) fn count_in(&self, chunk: u64) -> u64 {
        if chunk + 1 == self.chunks { self.last } else { self.count }
    }

    /// Number of its values.
    pub(super) fn total(&self) -> u64 {
        self.count.saturating_mul(self.chunks.saturating_sub(1)).saturating_add(self.last)
    }

    /// Adds the value in `bytes`: one number, or two of a complex one.
    pub(super) fn value(&self, bytes: &[u8], raw: &mut Vec<f64>) {
        match self.coding {
            Coding::Number(scalar) => raw.extend(scalar.get(bytes, self.big)),
            Coding::Complex(scalar) => raw.extend(scalar.all(bytes, self.big)),
            Coding::Time => raw.push(time(bytes, self.big)),
            Coding::Other(..) => raw.push(f64::NAN),
        }
    }
}

/// Seconds from 1904 of a time: 64 bits of fraction and 64 of seconds, in the byte order of the file.
pub(super) fn time(bytes: &[u8], big: bool) -> f64 {
    let (fraction, seconds) = if big { (bytes.get(8..), bytes.get(..8)) } else { (bytes.get(..8), bytes.get(8..)) };
    let part =
        |bytes: Option<&[u8]>, scalar: Scalar| bytes.and_then(|bytes| scalar.get(bytes, big)).unwrap_or(f64::NAN);
    part(seconds, Scalar::I64) + part(fraction, Scalar::U64) / 2f64.powi(64)
}

/// An object of the file.
#[derive(Debug, Clone, Default)]
pub(super) struct Object {
    /// Names of group and channel; none for the root.
    pub path: Vec<String>,
    pub properties: Vec<(String, Property)>,
    pub runs: Vec<Run>,
    pub complex: bool,
    /// Why its data are not read.
    pub skipped: Option<String>,
}

impl Object {
    pub(super) fn property(&self, word: &str) -> Option<&Property> {
        self.properties.iter().find(|(name, _)| name == word).map(|(_, value)| value)
    }

    pub(super) fn set(&mut self, word: String, value: Property) {
        match self.properties.iter_mut().find(|(name, _)| *name == word) {
            Some((_, old)) => *old = value,
            None => self.properties.push((word, value)),
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.runs.iter().map(Run::total).sum()
    }
}

/// Reads the value of a property.
pub(super) fn property(input: &mut Input<'_>) -> Read<(String, Property)> {
    let name = input.text()?;
    let kind = input.u32()?;
    let value = match (kind, Coding::of(kind)) {
        (0x20, _) => Property::Text(input.text()?),
        (_, Coding::Number(scalar)) => {
            let bytes = input.bytes(scalar.size() as u64)?;
            Property::Number(scalar.get(&bytes, input.big).unwrap_or(f64::NAN))
        }
        (_, Coding::Time) => Property::Time(time(&input.array::<16>()?, input.big)),
        (_, Coding::Complex(scalar)) => {
            let bytes = input.bytes(2 * scalar.size() as u64)?;
            let parts = scalar.all(&bytes, input.big);
            Property::Text(format!("{}{:+}j", parts[0], parts[1]))
        }
        (_, Coding::Other(kind, 16)) => {
            input.bytes(16)?;
            Property::Text(format!("(type {kind})"))
        }
        (0, _) => Property::Text(String::new()),
        (kind, _) => {
            let at = input.position()? - 4;
            return Err(Fault::byte(
                at,
                format!(
                    "property \"{name}\" is of an unknown type {kind}; the file is damaged: copy or export it again"
                ),
            ));
        }
    };
    Ok((name, value))
}

/// Names in a path such as `/'group'/'channel'`, in which a quote is written twice.
pub(super) fn names(path: &str) -> Option<Vec<String>> {
    let mut names = Vec::new();
    let mut rest = path;
    while let Some(quoted) = rest.strip_prefix("/'") {
        let (mut name, mut letters) = (String::new(), quoted.char_indices().peekable());
        let mut end = None;
        while let Some((i, letter)) = letters.next() {
            match letter {
                '\'' if letters.peek().is_some_and(|&(_, next)| next == '\'') => {
                    letters.next();
                    name.push('\'');
                }
                '\'' => {
                    end = Some(i + 1);
                    break;
                }
                _ => name.push(letter),
            }
        }
        rest = &quoted[end?..];
        names.push(name);
    }
    (matches!(rest, "" | "/") && names.len() <= 2).then_some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_keep_their_quotes() {
        assert_eq!(names("/"), Some(vec![]));
        assert_eq!(names("/'a'/'it''s/b'"), Some(vec!["a".to_owned(), "it's/b".to_owned()]));
        assert_eq!(names("/'a"), None);
        assert_eq!(names("x"), None);
    }
}

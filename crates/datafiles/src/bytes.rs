//! Numbers out of bytes of either order.

use crate::error::{Fault, Read};
use std::io::{self, Read as _};

/// Reads `count` bytes in pieces, so that a wrong count fails at the end of the file and not in the allocator.
pub(crate) fn take(reader: &mut impl io::Read, count: u64) -> Read<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.by_ref().take(count).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < count {
        return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
    }
    Ok(bytes)
}

/// An empty vector with room for exactly `count` numbers, so that it never grows: a vector that doubles takes three times
/// the memory of a long channel. `count` must have been checked against the size of the file.
pub(crate) fn room(count: u64) -> Read<Vec<f64>> {
    let mut values = Vec::new();
    let there = usize::try_from(count).is_ok_and(|count| values.try_reserve_exact(count).is_ok());
    if there { Ok(values) } else { Err(Fault::new("is too large for memory; cut the record into shorter ones")) }
}

/// Bytes that are read at once of a long array.
const PIECE: u64 = 1 << 20;

/// `count` numbers that are `stride` numbers apart, from where the reader stands; only one piece of the file is in memory beside them.
pub(crate) fn strided(
    reader: &mut impl io::Read,
    scalar: Scalar,
    big: bool,
    stride: u64,
    count: u64,
) -> Read<Vec<f64>> {
    Ok(columns(reader, scalar, big, stride, count, &[0])?.pop().unwrap_or_default())
}

/// Columns of `count` rows that are `stride` numbers long, from where the reader stands: those that lie so many numbers into
/// a row, in ascending order.
pub(crate) fn columns(
    reader: &mut impl io::Read,
    scalar: Scalar,
    big: bool,
    stride: u64,
    count: u64,
    wanted: &[u64],
) -> Read<Vec<Vec<f64>>> {
    let (width, step) = (scalar.size() as u64, scalar.size() as u64 * stride.max(1));
    let needed = width * (wanted.last().unwrap_or(&0) + 1);
    let most = (PIECE / step).max(1);
    let mut found = wanted.iter().map(|_| room(count)).collect::<Read<Vec<_>>>()?;
    let mut done = 0;
    while done < count {
        let rows = most.min(count - done);
        // Behind the last number nothing may follow.
        let rest = if done + rows < count { step } else { needed };
        let bytes = take(reader, (rows - 1) * step + rest)?;
        for (column, at) in found.iter_mut().zip(wanted) {
            let from = (at * width) as usize;
            column.extend(bytes.chunks(step as usize).filter_map(|row| scalar.get(row.get(from..)?, big)));
        }
        done += rows;
    }
    Ok(found)
}

/// A type of number in a binary file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

impl Scalar {
    /// Size in bytes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// An integer of a size in bytes.
    pub(crate) fn integer(size: usize, signed: bool) -> Option<Self> {
        Some(match (size, signed) {
            (1, true) => Self::I8,
            (1, false) => Self::U8,
            (2, true) => Self::I16,
            (2, false) => Self::U16,
            (4, true) => Self::I32,
            (4, false) => Self::U32,
            (8, true) => Self::I64,
            (8, false) => Self::U64,
            _ => return None,
        })
    }

    /// A floating-point number of a size in bytes.
    pub(crate) fn float(size: usize) -> Option<Self> {
        Some(match size {
            2 => Self::F16,
            4 => Self::F32,
            8 => Self::F64,
            _ => return None,
        })
    }

    /// The number in the first bytes of `bytes`, which must hold one.
    pub(crate) fn get(self, bytes: &[u8], big: bool) -> Option<f64> {
        macro_rules! number {
            ($type:ty) => {{
                let array = bytes.get(..size_of::<$type>())?.try_into().ok()?;
                (if big { <$type>::from_be_bytes(array) } else { <$type>::from_le_bytes(array) }) as f64
            }};
        }
        Some(match self {
            Self::I8 => number!(i8),
            Self::U8 => number!(u8),
            Self::I16 => number!(i16),
            Self::U16 => number!(u16),
            Self::I32 => number!(i32),
            Self::U32 => number!(u32),
            Self::I64 => number!(i64),
            Self::U64 => number!(u64),
            Self::F16 => {
                let array = bytes.get(..2)?.try_into().ok()?;
                half(if big { u16::from_be_bytes(array) } else { u16::from_le_bytes(array) })
            }
            Self::F32 => number!(f32),
            Self::F64 => number!(f64),
        })
    }

    /// All numbers in `bytes`.
    pub(crate) fn all(self, bytes: &[u8], big: bool) -> Vec<f64> {
        bytes.chunks_exact(self.size()).filter_map(|chunk| self.get(chunk, big)).collect()
    }
}

/// A number of IEEE half precision.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    match exponent {
        0 => sign * fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        _ => sign * (1.0 + fraction / 1024.0) * 2f64.powi(exponent - 15),
    }
}

/// A fault where a count times a size is more than the file holds.
pub(crate) fn check_size(count: u64, size: u64, available: u64, byte: u64) -> Read<u64> {
    match count.checked_mul(size) {
        Some(bytes) if bytes <= available => Ok(bytes),
        _ => Err(Fault::byte(
            byte,
            format!(
                "states {count} values of {size} bytes and only {available} bytes follow; the file was cut short or is damaged: export it again"
            ),
        )),
    }
}

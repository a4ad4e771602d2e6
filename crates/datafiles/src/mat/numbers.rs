//! Numbers of a MAT file: those that a listing shows, one channel of an array, or all of it.

use super::input::Part;
use super::v5::{Header, Walk};
use crate::bytes::{Scalar, strided};
use crate::error::{Fault, Read};
use crate::tree::{Array, Flat, Shape};

/// Which values of an array are read.
enum Values<'a> {
    At(&'a [u64]),
    All,
    Of(&'a Part),
}

impl Walk<'_> {
    /// The numbers of a matrix whose header was read.
    pub(super) fn numbers(&mut self, header: &Header) -> Read<Array> {
        let id = self.number;
        self.number += 1;
        let shape = Shape::new(header.extents.iter().copied(), true);
        let count = Self::count(header)?;
        let wanted = shape.wanted();
        let (whole, channel) = match &self.wanted {
            Some((number, part)) if *number == id => (true, part.clone()),
            _ => (false, None),
        };
        let values = match &channel {
            Some(part) => Values::Of(part),
            None if whole => Values::All,
            None => Values::At(&wanted),
        };
        let re = self.part(count, &values, &header.name)?;
        let im = if header.complex { self.part(count, &values, &header.name)? } else { Vec::new() };
        let peek = if whole {
            self.found = Some(Flat { re, im });
            Vec::new()
        } else {
            (0..re.len()).map(|i| [re[i], im.get(i).copied().unwrap_or(0.0)]).collect()
        };
        Ok(Array { id, shape, complex: header.complex, peek })
    }

    /// The real or the imaginary part: those of its values that are wanted.
    fn part(&mut self, count: u64, wanted: &Values<'_>, name: &str) -> Read<Vec<f64>> {
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
            return Ok(match wanted {
                Values::At(places) => places.iter().filter_map(|&i| all.get(i as usize).copied()).collect(),
                Values::All | Values::Of(_) => all,
            });
        }
        let (values, passed) = self.chosen(count, wanted, scalar)?;
        self.input.skip((count - passed) * width)?;
        self.input.skip(size.next_multiple_of(8) - count * width)?;
        Ok(values)
    }

    /// The values that are wanted, and how many were passed for them.
    fn chosen(&mut self, count: u64, wanted: &Values<'_>, scalar: Scalar) -> Read<(Vec<f64>, u64)> {
        let width = scalar.size() as u64;
        match wanted {
            Values::All => Ok((strided(self.input, scalar, self.big, 1, count)?, count)),
            Values::Of(Part { cut, channel }) => {
                let first = cut.offset(*channel);
                self.input.skip(first * width)?;
                let values = strided(self.input, scalar, self.big, cut.stride, cut.count)?;
                Ok((values, first + (cut.count - 1) * cut.stride + 1))
            }
            Values::At(places) => {
                let (mut values, mut at) = (Vec::with_capacity(places.len()), 0);
                for &place in *places {
                    self.input.skip((place - at) * width)?;
                    values.push(scalar.get(&self.input.some(width)?, self.big).unwrap_or(f64::NAN));
                    at = place + 1;
                }
                Ok((values, at))
            }
        }
    }
}

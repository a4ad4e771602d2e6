//! The LZF filter of h5py (number 32000), which the reader of HDF5 does not know.
//!
//! Source: LibLZF by Marc Lehmann. A control byte below 32 is followed by that many bytes and one; any other holds a length in
//! its upper three bits and, with the next bytes, a distance back.

use hdf5_reader::FilterRegistry;
use hdf5_reader::error::{Error, Result};

const LZF: u16 = 32000;
/// Largest chunk that is unpacked, bytes.
const MOST: usize = 1 << 28;

/// The filters of the reader and LZF.
pub(super) fn filters() -> FilterRegistry {
    let mut filters = FilterRegistry::new();
    filters.register(LZF, Box::new(|_, data, _| unpack(data)));
    filters
}

fn unpack(data: &[u8]) -> Result<Vec<u8>> {
    let damaged = || Error::InvalidData("a chunk packed by LZF is damaged".to_owned());
    let (mut out, mut at) = (Vec::new(), 0);
    let mut next = || {
        let byte = data.get(at).copied();
        at += 1;
        byte
    };
    while let Some(control) = next() {
        let control = usize::from(control);
        if control < 32 {
            for _ in 0..=control {
                out.push(next().ok_or_else(damaged)?);
            }
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(next().ok_or_else(damaged)?);
            }
            let distance = ((control & 31) << 8) + usize::from(next().ok_or_else(damaged)?) + 1;
            let from = out.len().checked_sub(distance).ok_or_else(damaged)?;
            // Pieces may overlap what they make.
            for i in from..from + length + 2 {
                out.push(out[i]);
            }
        }
        if out.len() > MOST {
            return Err(damaged());
        }
    }
    Ok(out)
}

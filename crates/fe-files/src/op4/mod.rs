//! NASTRAN `OUTPUT4` files, ascii and binary.
//!
//! A matrix is a header (columns, rows, form, type, name), its columns, and a last column that is one too many. A column is
//! dense (first row, number of words, values) or, where its first row is 0, a number of strings: runs of values below each
//! other. A string's head is `IS = row + 65536 (words + 1)`, or, with `BIGMAT` (negative number of rows), `words + 1` and `row`.

mod ascii;
mod binary;
mod header;

use crate::Matrix;
use crate::error::{FileError, Place, Problem};

/// Reads all real square matrices of a file called `file` in messages.
pub fn read(bytes: &[u8], file: &str) -> Result<Vec<Matrix>, FileError> {
    // A binary file begins with the length of its first record, which has bytes below a space.
    let is_binary = bytes.iter().take(4).any(|&byte| byte < b' ' && !byte.is_ascii_whitespace());
    let matrices = if is_binary { binary::read(bytes, file)? } else { ascii::read(bytes, file)? };
    if matrices.is_empty() {
        return Err(FileError::new(file, Place::File, Problem::NoMatrix { expected: "a matrix of OUTPUT4" }));
    }
    // Tables and complex matrices may stand beside mass and stiffness, not in their place.
    if let Some(first) = matrices
        .iter()
        .find(|m| m.header.refused.is_some())
        .filter(|_| matrices.iter().all(|m| m.header.refused.is_some()))
        && let Some(problem) = &first.header.refused
    {
        return Err(FileError::new(file, first.place, problem.clone()));
    }
    let usable = matrices.into_iter().filter(|m| m.header.refused.is_none());
    usable.map(|m| Matrix::new(file, &m.header.name, m.header.size, None, m.entries)).collect()
}

#[cfg(test)]
mod tests;

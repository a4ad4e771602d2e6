//! The matrices of Abaqus, written by `*MATRIX GENERATE` with `*MATRIX OUTPUT`.
//!
//! `FORMAT=MATRIX INPUT` and `LABELS`: one entry `row node, row dof, column node, column dof, value` a line, after an optional
//! keyword line. `FORMAT=COORDINATE`: `row column value`, from 1, without nodes. Internal nodes have negative numbers.

use crate::error::{FileError, Place, Problem, quote};
use crate::matrix::{Matrix, NodeDof, Rows};
use crate::number::{real, whole};

/// Highest component of a node that is read: displacements and rotations.
const HIGHEST: i64 = 6;

/// Reads a matrix from the text of a file called `file` in messages.
pub fn read_matrix(text: &str, file: &str) -> Result<Matrix, FileError> {
    let mut rows = Rows::default();
    let (mut entries, mut size, mut labelled) = (Vec::new(), 0, None);
    for (index, line) in text.lines().enumerate() {
        let wrong = |problem| FileError::line(file, index + 1, problem);
        let line = line.trim();
        if line.is_empty() || line.starts_with('*') {
            continue;
        }
        let words: Vec<&str> = line.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty()).collect();
        let has_labels = words.len() == 5;
        let same = *labelled.get_or_insert(has_labels) == has_labels;
        if !same || !(has_labels || words.len() == 3) {
            let expected = "row node, row dof, column node, column dof, value` or `row column value";
            return Err(wrong(Problem::Row { expected, text: quote(line) }));
        }
        let (i, j) = if has_labels {
            (rows.of(dof(words[0], words[1]).map_err(wrong)?), rows.of(dof(words[2], words[3]).map_err(wrong)?))
        } else {
            (place(words[0], text.len()).map_err(wrong)?, place(words[1], text.len()).map_err(wrong)?)
        };
        size = size.max(i + 1).max(j + 1);
        entries.push((i, j, words.last().map_or(Ok(0.0), |word| real(word)).map_err(wrong)?));
    }
    match labelled {
        None => {
            let expected = "the output of *MATRIX GENERATE";
            Err(FileError::new(file, Place::File, Problem::NoMatrix { expected }))
        }
        Some(true) => Matrix::new(file, "", size, Some(rows.dofs), entries),
        Some(false) => Matrix::new(file, "", size, None, entries),
    }
}

fn dof(node: &str, component: &str) -> Result<NodeDof, Problem> {
    let node = whole(node, "a node number")?;
    match whole(component, "a degree of freedom")? {
        c @ 1..=HIGHEST => Ok(NodeDof { node, component: c as u8 }),
        _ => Err(Problem::Component { text: quote(component) }),
    }
}

fn place(text: &str, most: usize) -> Result<usize, Problem> {
    let index = whole(text, "a row or column")?;
    let problem = || Problem::TooLarge { name: "of this file".into(), rows: index.unsigned_abs() };
    usize::try_from(index - 1).ok().filter(|&k| k < most).ok_or_else(problem)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn both_formats() {
        let input =
            "** stiffness\n*MATRIX INPUT, NAME=K, TYPE=SYMMETRIC\n4,1, 4,1, 2.5e+03\n4,1,7,3,-1.0\n7,3,7,3,1.5\n";
        let labelled = read_matrix(input, "j_STIF1.mtx").unwrap();
        assert_eq!(labelled.dofs.unwrap()[1], NodeDof { node: 7, component: 3 });
        let plain = read_matrix("1 1 2.5e+03\n2 1 -1.0\n2 2 1.5\n", "j_STIF1.mtx").unwrap();
        assert_eq!((plain.dofs, plain.size), (None, 2));
        assert_eq!(plain.entries, labelled.entries);
    }

    #[test]
    fn bad_lines() {
        let message = |text: &str| read_matrix(text, "k.mtx").unwrap_err().to_string();
        assert!(message("1,1,1,1,2.0\n1 2 3.0\n").starts_with("k.mtx:2: \"1 2 3.0\" is not `row node"));
        assert!(message("0 1 3.0\n").starts_with("k.mtx:1: matrix of this file is said to have"));
        assert!(message("1,8,1,8,2.0\n").starts_with("k.mtx:1: component 8 is not"));
        assert!(message("** nothing\n").starts_with("k.mtx: there is no matrix"));
    }
}

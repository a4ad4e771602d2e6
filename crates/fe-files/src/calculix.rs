//! The matrices of CalculiX: `*FREQUENCY, SOLVER=MATRIXSTORAGE` writes `JOB.sti` (stiffness), `JOB.mas` (mass), one entry
//! `row column value` a line, one triangle, from 1; and `JOB.dof`, the node and direction of each row as `node.direction`.

use crate::error::{FileError, Place, Problem, quote};
use crate::matrix::{Matrix, NodeDof};
use crate::number::{real, whole};

/// Reads the list of degrees of freedom.
pub fn read_dofs(text: &str, file: &str) -> Result<Vec<NodeDof>, FileError> {
    let mut dofs = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let row = || Problem::Row { expected: "node.direction", text: quote(line) };
        let dof = line.trim().split_once('.').and_then(|(node, component)| {
            let component = component.parse().ok().filter(|c| (1..=6).contains(c))?;
            Some(NodeDof { node: node.parse().ok()?, component })
        });
        dofs.push(dof.ok_or_else(|| FileError::line(file, index + 1, row()))?);
    }
    if dofs.is_empty() {
        return Err(FileError::new(file, Place::File, Problem::Missing { what: "the list of degrees of freedom" }));
    }
    Ok(dofs)
}

/// Reads a matrix, its rows those of `dofs`.
pub fn read_matrix(text: &str, file: &str, dofs: &[NodeDof]) -> Result<Matrix, FileError> {
    let size = dofs.len();
    let mut entries = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let wrong = |problem| FileError::line(file, index + 1, problem);
        let (row, column, value) = entry(line).map_err(wrong)?;
        let inside = |k: i64| usize::try_from(k - 1).ok().filter(|&k| k < size);
        let (Some(i), Some(j)) = (inside(row), inside(column)) else {
            return Err(wrong(Problem::DofCount { found: size, expected: row.max(column).unsigned_abs() as usize }));
        };
        entries.push((i, j, value));
    }
    if entries.is_empty() {
        return Err(FileError::new(file, Place::File, Problem::NoMatrix { expected: "`row column value` a line" }));
    }
    Matrix::new(file, "", size, Some(dofs.to_vec()), entries)
}

fn entry(line: &str) -> Result<(i64, i64, f64), Problem> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [row, column, value] = words[..] else {
        return Err(Problem::Row { expected: "row column value", text: quote(line) });
    };
    Ok((whole(row, "a row")?, whole(column, "a column")?, real(value)?))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn matrix_with_its_dofs() {
        let dofs = read_dofs("5.1\n5.3\n", "a.dof").unwrap();
        assert_eq!(dofs[1], NodeDof { node: 5, component: 3 });
        let matrix = read_matrix("1 1  4.5e+10\n1 2 -1.0D+00\n2 2 2.0\n", "a.sti", &dofs).unwrap();
        assert_eq!(matrix.entries, [(0, 0, 4.5e10), (1, 0, -1.0), (1, 1, 2.0)]);
        let message = read_matrix("3 1 1.0\n", "a.sti", &dofs).unwrap_err().to_string();
        assert_eq!(
            message,
            "a.sti:1: 2 degrees of freedom are listed but the matrix has 3 rows; take both from one run"
        );
        assert!(
            read_dofs("5\n", "a.dof").unwrap_err().to_string().starts_with("a.dof:1: \"5\" is not `node.direction`")
        );
    }
}

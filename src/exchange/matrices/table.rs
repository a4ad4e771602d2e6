//! CSV files of a structure: a matrix without a header, and the tables of nodes, DOFs and lines.

use super::error::{TableError, TableProblem, number, quote};
use crate::structure::imported::ImportedDof;
use crate::structure::{Direction, MOST_DOFS, Node};
use faer::Mat;

/// Reads a square matrix, one row a line, values separated by commas, semicolons, tabs or spaces.
pub fn parse_matrix_csv(text: &str, file: &str) -> Result<Mat<f64>, TableError> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (at, cells) in rows_of(text) {
        let wrong = |problem| TableError::line(file, at, problem);
        let row = cells.iter().map(|cell| number(cell)).collect::<Result<Vec<f64>, _>>().map_err(wrong)?;
        if let Some(first) = rows.first().filter(|first| first.len() != row.len()) {
            return Err(wrong(TableProblem::RowLength { found: row.len(), expected: first.len() }));
        }
        if row.len() > MOST_DOFS {
            return Err(wrong(TableProblem::TooLarge { rows: row.len(), most: MOST_DOFS }));
        }
        rows.push(row);
    }
    let n = rows.len();
    match rows.first() {
        None => Err(TableError::file(file, TableProblem::Empty)),
        Some(first) if first.len() != n => {
            Err(TableError::file(file, TableProblem::NotSquare { rows: n, columns: first.len() }))
        }
        Some(_) => Ok(Mat::from_fn(n, n, |i, j| rows[i][j])),
    }
}

/// Reads `node,x,y,z`, positions in m.
pub fn parse_nodes(text: &str, file: &str) -> Result<Vec<Node>, TableError> {
    let mut seen = Vec::new();
    let mut nodes = Vec::new();
    for (at, cells) in table(text, file, "node,x,y,z")? {
        let wrong = |problem| TableError::line(file, at, problem);
        let label = unique(&mut seen, "node", &cells[0], at).map_err(wrong)?;
        let mut position = [0.0; 3];
        for (value, cell) in position.iter_mut().zip(&cells[1..]) {
            *value = number(cell).map_err(wrong)?;
        }
        nodes.push(Node { label, position });
    }
    Ok(nodes)
}

/// Reads `dof,node,direction`, one row a matrix row.
pub fn parse_dofs(text: &str, file: &str) -> Result<Vec<ImportedDof>, TableError> {
    let mut seen = Vec::new();
    let mut dofs = Vec::new();
    for (at, cells) in table(text, file, "dof,node,direction")? {
        let wrong = |problem| TableError::line(file, at, problem);
        let label = unique(&mut seen, "DOF", &cells[0], at).map_err(wrong)?;
        let node = present(&cells[1]).map_err(wrong)?;
        let direction = match cells[2].to_lowercase().as_str() {
            "x" => Direction::X,
            "y" => Direction::Y,
            "z" => Direction::Z,
            "rx" => Direction::Rx,
            "ry" => Direction::Ry,
            "rz" => Direction::Rz,
            "q" => Direction::Q,
            other => return Err(wrong(TableProblem::Direction { text: quote(other) })),
        };
        dofs.push(ImportedDof { label, node, direction });
    }
    Ok(dofs)
}

/// Reads `node,node`, the pairs to draw a line between.
pub fn parse_lines(text: &str, file: &str) -> Result<Vec<[String; 2]>, TableError> {
    let mut lines = Vec::new();
    for (at, cells) in table(text, file, "node,node")? {
        let wrong = |problem| TableError::line(file, at, problem);
        let ends = [present(&cells[0]).map_err(wrong)?, present(&cells[1]).map_err(wrong)?];
        if ends[0] == ends[1] {
            return Err(wrong(TableProblem::JoinedToItself { label: quote(&ends[0]) }));
        }
        lines.push(ends);
    }
    Ok(lines)
}

/// Cells of every line that is neither blank nor a comment, with its number.
fn rows_of(text: &str) -> impl Iterator<Item = (usize, Vec<String>)> + '_ {
    let separator = [',', ';', '\t'].into_iter().find(|&c| text.contains(c));
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#')).map(
        move |(i, line)| {
            let cells: Vec<String> = match separator {
                Some(separator) => line.split(separator).map(clean).collect(),
                None => line.split_whitespace().map(clean).collect(),
            };
            (i + 1, cells)
        },
    )
}

fn clean(cell: &str) -> String {
    cell.trim().trim_matches('"').trim().to_owned()
}

/// Rows below a header, all of its width.
fn table(text: &str, file: &str, header: &'static str) -> Result<Vec<(usize, Vec<String>)>, TableError> {
    let mut rows = rows_of(text);
    let (at, first) = rows.next().ok_or_else(|| TableError::file(file, TableProblem::Empty))?;
    let names: Vec<&str> = header.split(',').collect();
    if first.iter().map(|name| name.to_lowercase()).ne(names.iter().map(|&name| name.to_owned())) {
        let problem = TableProblem::Header { expected: header, found: quote(&first.join(",")) };
        return Err(TableError::line(file, at, problem));
    }
    let width = names.len();
    let check = |(at, cells): (usize, Vec<String>)| {
        let problem = TableProblem::RowLength { found: cells.len(), expected: width };
        if cells.len() == width { Ok((at, cells)) } else { Err(TableError::line(file, at, problem)) }
    };
    rows.map(check).collect()
}

fn present(label: &str) -> Result<String, TableProblem> {
    if label.is_empty() { Err(TableProblem::NoLabel) } else { Ok(label.to_owned()) }
}

fn unique(seen: &mut Vec<(String, usize)>, what: &'static str, label: &str, at: usize) -> Result<String, TableProblem> {
    let label = present(label)?;
    if let Some((_, first)) = seen.iter().find(|(other, _)| *other == label) {
        return Err(TableProblem::Twice { what, label: quote(&label), first: *first });
    }
    seen.push((label.clone(), at));
    Ok(label)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn matrices_with_any_separator() {
        for text in ["1,-2\n-2,4e1\n", "1; -2\r\n-2; 40\r\n", "# kg\n1 -2\n\n-2 40", "1\t-2\n-2\t40\n"] {
            assert_eq!(parse_matrix_csv(text, "m").unwrap(), mat![[1.0, -2.0], [-2.0, 40.0]]);
        }
        let message = |text: &str| parse_matrix_csv(text, "m.csv").unwrap_err().to_string();
        assert_eq!(message("1,2\n3\n"), "m.csv:2: the row has 1 values but 2 are needed");
        assert_eq!(message("1,2\n"), "m.csv: the matrix is 1 x 2; it must be square");
        assert_eq!(message("1,x\n"), "m.csv:1: \"x\" is not a finite number");
        assert_eq!(message("\n"), "m.csv: the file is empty");
    }

    #[test]
    fn tables_of_nodes_dofs_and_lines() {
        let nodes = parse_nodes("node,x,y,z\n a ,0,1,2\n\"b\",3,4,5\n", "n").unwrap();
        assert_eq!(nodes[1], Node { label: "b".into(), position: [3.0, 4.0, 5.0] });
        let dofs = parse_dofs("dof,node,direction\n1,a,x\n2,a,RZ\n", "d").unwrap();
        assert_eq!(dofs[1].direction, Direction::Rz);
        assert_eq!(parse_lines("node,node\na,b\n", "l").unwrap(), [["a".to_owned(), "b".to_owned()]]);
        let message = parse_dofs("dof,node,direction\n1,a,x\n1,a,y\n", "d.csv").unwrap_err().to_string();
        assert_eq!(message, "d.csv:3: DOF \"1\" is given twice, first in line 2; leave one out");
        let message = parse_dofs("dof,node,direction\n1,a,up\n", "d.csv").unwrap_err().to_string();
        assert_eq!(
            message,
            "d.csv:2: \"up\" is not a direction; use x, y, z, rx, ry or rz, or q for a generalised coordinate"
        );
        let message = parse_nodes("name,x,y,z\n", "n.csv").unwrap_err().to_string();
        assert_eq!(message, "n.csv:1: the header must be `node,x,y,z`, not \"name,x,y,z\"");
        assert!(parse_lines("node,node\na,a\n", "l.csv").is_err());
    }
}

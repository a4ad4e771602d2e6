//! Matrices and their tables of nodes, DOFs and lines: Matrix Market and CSV.

mod deck;
pub(crate) mod error;
pub(crate) mod market;
pub(crate) mod model;
mod sparse_market;
pub mod table;
mod write;

pub use error::{TableError, TableProblem};
pub use market::parse_market;
pub use write::write_tables;

use crate::structure::Node;
use crate::structure::imported::ImportedDof;
use faer::Mat;
use std::path::Path;

/// Reads the square matrix at `path`: Matrix Market if it begins so or is named `.mtx`, else CSV.
pub fn read_matrix(path: &Path) -> Result<Mat<f64>, TableError> {
    let (text, file) = error::read(path)?;
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mtx"));
    if named || text.starts_with("%%") { parse_market(&text, &file) } else { table::parse_matrix_csv(&text, &file) }
}

/// Reads the table of nodes at `path`.
pub fn read_nodes(path: &Path) -> Result<Vec<Node>, TableError> {
    let (text, file) = error::read(path)?;
    table::parse_nodes(&text, &file)
}

/// Reads the table of DOFs at `path`.
pub fn read_dofs(path: &Path) -> Result<Vec<ImportedDof>, TableError> {
    let (text, file) = error::read(path)?;
    table::parse_dofs(&text, &file)
}

/// Reads the table of lines at `path`.
pub fn read_lines(path: &Path) -> Result<Vec<[String; 2]>, TableError> {
    let (text, file) = error::read(path)?;
    table::parse_lines(&text, &file)
}

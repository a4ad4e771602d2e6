//! Mass and stiffness of a finite-element program with their degrees of freedom, nodes and lines.
//!
//! A degree of freedom is named by its node and its direction, such as `12z` or `12rx` (`q` at scalar points); the rows are
//! in the order of nodes and directions, whatever order the files have. Rows that a program marks as fixed by a stiffness
//! of 1e30 and more are left out, which is said.

use super::deck::read_deck;
use super::error::{TableError, TableProblem, read_deck_text as read};
use super::sparse_market::parse_sparse_market;
use super::{read_dofs, read_lines, read_matrix, read_nodes};
use crate::structure::imported::ImportedDof;
use crate::structure::reduction::SparseSystem;
use crate::structure::{Direction, Node, TurnedNode};
use dashpot_fe_files::{Geometry, Matrix, NodeDof, abaqus, calculix, inp, op4};
use dashpot_numerics::SparseSymmetric;
use faer::Mat;
use std::collections::HashMap;
use std::path::Path;

/// Stiffness from which a degree of freedom counts as fixed by a penalty, N/m.
const FIXED: f64 = 1e30;
/// Bytes by which a file is told.
const BEGINNING: u64 = 64 * 1024;
/// Most lines that are kept for drawing.
const MOST_LINES: usize = 20_000;
/// Directions of components 0 (scalar point) to 6, and their names.
const DIRECTIONS: [(Direction, &str); 7] = [
    (Direction::Q, "q"),
    (Direction::X, "x"),
    (Direction::Y, "y"),
    (Direction::Z, "z"),
    (Direction::Rx, "rx"),
    (Direction::Ry, "ry"),
    (Direction::Rz, "rz"),
];

/// Files of a model, found beside the project, and the names of the matrices in them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ModelFiles<'a> {
    /// Mass and stiffness.
    pub matrices: [&'a Path; 2],
    /// Names of the two in their files, where there are several.
    pub names: [Option<&'a str>; 2],
    /// Table of nodes, or a model file.
    pub nodes: Option<&'a Path>,
    /// Table of degrees of freedom.
    pub dofs: Option<&'a Path>,
    /// Table of lines.
    pub lines: Option<&'a Path>,
}

/// A whole model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Model {
    /// Mass and stiffness.
    pub system: SparseSystem,
    /// One entry a row; none where the files do not name the rows.
    pub dofs: Option<Vec<ImportedDof>>,
    /// Nodes, where the files have them.
    pub nodes: Option<Vec<Node>>,
    /// Pairs of node labels.
    pub lines: Vec<[String; 2]>,
    /// What the files hold that is not understood but could matter.
    pub notes: Vec<String>,
    /// Nodes whose displacements the files state in directions of their own.
    pub turned: Vec<TurnedNode>,
}

/// Kind of a file by its name and first words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Matrix Market or CSV.
    Plain,
    Nastran,
    Output4,
    Abaqus,
    CalculiX,
    /// Input of Abaqus or CalculiX.
    Input,
}

fn kind(path: &Path) -> Kind {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "bdf" | "nas" | "pch" | "blk" => Kind::Nastran,
        "dat" if begins(path, |text| text.contains("DMIG") || text.contains("GRID")) => Kind::Nastran,
        "op4" => Kind::Output4,
        "sti" | "mas" => Kind::CalculiX,
        "inp" => Kind::Input,
        "mtx" if begins(path, is_abaqus) => Kind::Abaqus,
        _ => Kind::Plain,
    }
}

/// Whether the beginning of a file, some thousand characters of text, is as it should be.
fn begins(path: &Path, is_so: impl Fn(&str) -> bool) -> bool {
    use std::io::Read;
    let mut begin = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(BEGINNING).read_to_end(&mut begin));
    read.is_ok() && is_so(&String::from_utf8_lossy(&begin))
}

/// A keyword or comment of Abaqus, or three or five numbers in the first line.
fn is_abaqus(text: &str) -> bool {
    let first = text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
    let words: Vec<&str> = first.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty()).collect();
    first.starts_with('*') || ([3, 5].contains(&words.len()) && words.iter().all(|word| word.parse::<f64>().is_ok()))
}

/// Whether a matrix file is one of a finite-element program rather than a plain one.
pub(crate) fn is_model(path: &Path) -> bool {
    kind(path) != Kind::Plain
}

/// Reads a model from its files.
///
/// # Errors
/// [`TableError`], or [`dashpot_fe_files::FileError`] in it, with file, line, what is wrong and how to mend it.
pub(crate) fn read_model(files: ModelFiles<'_>) -> Result<Model, TableError> {
    let (matrices, mut geometry) = read_matrices(files)?;
    let mut notes = std::mem::take(&mut geometry.notes);
    let (system, dofs) = joined(matrices, files.matrices[1], &mut notes)?;
    let mut nodes = files.nodes.filter(|path| !is_model(path)).map(read_nodes).transpose()?;
    if nodes.is_none() && !geometry.nodes.is_empty() {
        let node = |node: &dashpot_fe_files::Node| Node { label: node.id.to_string(), position: node.position };
        nodes = Some(geometry.nodes.iter().map(node).collect());
    }
    let dofs = match files.dofs {
        Some(path) => Some(in_basic(read_dofs(path)?, &geometry, path)?),
        None => dofs.map(|dofs| dofs.iter().map(named).collect()),
    };
    let mut lines = files.lines.map(read_lines).transpose()?.unwrap_or_default();
    if lines.is_empty() {
        lines = geometry.lines.iter().map(|pair| pair.map(|id| id.to_string())).collect();
    }
    if lines.len() > MOST_LINES {
        notes.push(format!("the model has {} lines, more than are drawn: none is", lines.len()));
        lines.clear();
    }
    drop_unknown(&mut lines, nodes.as_deref());
    let turned =
        geometry.turned.iter().map(|node| TurnedNode { label: node.node.to_string(), axes: node.axes }).collect();
    Ok(Model { system, dofs, nodes, lines, notes, turned })
}

/// Both matrices with their rows in basic directions, and the nodes and lines beside them.
fn read_matrices(files: ModelFiles<'_>) -> Result<(Vec<Matrix>, Geometry), TableError> {
    let mut geometry = Geometry::default();
    let mut matrices = Vec::new();
    for ((path, name), what) in files.matrices.into_iter().zip(files.names).zip(["M", "K"]) {
        let (matrix, own) = one(path, name, what)?;
        matrices.push(matrix);
        if geometry.nodes.is_empty() {
            geometry = own;
        }
    }
    if let Some(path) = files.nodes.filter(|path| is_model(path)) {
        geometry = geometry_of(path)?;
    }
    let turned = |(matrix, path): (Matrix, &Path)| matrix.in_basic(&path.display().to_string(), &geometry.turned);
    let matrices = matrices.into_iter().zip(files.matrices).map(turned).collect::<Result<_, _>>()?;
    Ok((matrices, geometry))
}

/// The rows of a table, whose directions are x, y and z: nodes that move in other systems have no place in it.
fn in_basic(dofs: Vec<ImportedDof>, geometry: &Geometry, path: &Path) -> Result<Vec<ImportedDof>, TableError> {
    let turned: HashMap<String, i64> =
        geometry.turned.iter().map(|node| (node.node.to_string(), node.system)).collect();
    match dofs.iter().find_map(|dof| Some((&dof.node, turned.get(&dof.node)?))) {
        Some((node, &system)) => {
            let problem = TableProblem::TurnedNode { node: node.clone(), system };
            Err(TableError::file(&path.display().to_string(), problem))
        }
        None => Ok(dofs),
    }
}

fn named(dof: &NodeDof) -> ImportedDof {
    let (direction, word) = DIRECTIONS[usize::from(dof.component)];
    ImportedDof { label: format!("{}{word}", dof.node), node: dof.node.to_string(), direction }
}

/// Lines between nodes that are there.
fn drop_unknown(lines: &mut Vec<[String; 2]>, nodes: Option<&[Node]>) {
    if let Some(nodes) = nodes {
        let known: std::collections::HashSet<&str> = nodes.iter().map(|node| node.label.as_str()).collect();
        lines.retain(|pair| pair.iter().all(|label| known.contains(label.as_str())));
    }
}

fn geometry_of(path: &Path) -> Result<Geometry, TableError> {
    if kind(path) == Kind::Nastran {
        return Ok(read_deck(path)?.geometry);
    }
    let (text, file) = read(path)?;
    Ok(inp::read(&text, &file)?)
}

/// One matrix and the nodes and lines that its file, or the input beside it, has.
fn one(path: &Path, name: Option<&str>, what: &str) -> Result<(Matrix, Geometry), TableError> {
    let file = path.display().to_string();
    match kind(path) {
        Kind::Plain | Kind::Input => {
            if let Some(matrix) = sparse(path)? {
                return Ok((matrix, Geometry::default()));
            }
            let dense = read_matrix(path)?;
            let n = dense.nrows();
            Ok((plain(&dense, n), Geometry::default()))
        }
        Kind::Nastran => {
            let bulk = read_deck(path)?;
            Ok((chosen(bulk.matrices, name, what, &file)?, bulk.geometry))
        }
        Kind::Output4 => {
            let bytes = std::fs::read(path)
                .map_err(|error| TableError::file(&file, TableProblem::Unreadable { reason: error.to_string() }))?;
            Ok((chosen(op4::read(&bytes, &file)?, name, what, &file)?, Geometry::default()))
        }
        Kind::Abaqus => {
            let (text, file) = read(path)?;
            Ok((abaqus::read_matrix(&text, &file)?, Geometry::default()))
        }
        Kind::CalculiX => {
            let (list, list_file) = read(&path.with_extension("dof"))?;
            let dofs = calculix::read_dofs(&list, &list_file)?;
            let (text, file) = read(path)?;
            let input = path.with_extension("inp");
            let geometry = if input.is_file() { geometry_of(&input)? } else { Geometry::default() };
            Ok((calculix::read_matrix(&text, &file, &dofs)?, geometry))
        }
    }
}

/// A Matrix Market file of single entries, whose size is not limited by memory for all.
fn sparse(path: &Path) -> Result<Option<Matrix>, TableError> {
    if !begins(path, |text| text.starts_with("%%")) {
        return Ok(None);
    }
    let (text, file) = read(path)?;
    parse_sparse_market(&text, &file)
}

/// The lower triangle of a plain matrix; that the upper one is alike is checked where the structure is built.
fn plain(dense: &Mat<f64>, size: usize) -> Matrix {
    let places = (0..size).flat_map(|j| (j..size).map(move |i| (i, j)));
    let entry = |(i, j): (usize, usize)| (i, j, 0.5 * (dense[(i, j)] + dense[(j, i)]));
    let entries = places.map(entry).filter(|&(_, _, value)| value != 0.0).collect();
    Matrix { name: String::new(), size, dofs: None, entries }
}

/// The matrix of that name, or the only one whose name begins with `what` (`M` or `K`), or the only one.
fn chosen(mut matrices: Vec<Matrix>, name: Option<&str>, what: &str, file: &str) -> Result<Matrix, TableError> {
    let names = || matrices.iter().map(|m| m.name.clone()).collect::<Vec<_>>().join(", ");
    let fits = |m: &Matrix| match name {
        Some(name) => m.name.eq_ignore_ascii_case(name),
        None => m.name.to_uppercase().starts_with(what),
    };
    let found: Vec<usize> = (0..matrices.len()).filter(|&i| fits(&matrices[i])).collect();
    let place = match (&found[..], name, matrices.len()) {
        ([one], _, _) => *one,
        ([], None, 1) => 0,
        _ => {
            let key = if what == "M" { "mass_name" } else { "stiffness_name" };
            return Err(TableError::file(file, TableProblem::WhichMatrix { key, names: names() }));
        }
    };
    Ok(matrices.swap_remove(place))
}

/// Both matrices with their rows in one order.
fn joined(
    matrices: Vec<Matrix>,
    stiffness_file: &Path,
    notes: &mut Vec<String>,
) -> Result<(SparseSystem, Option<Vec<NodeDof>>), TableError> {
    let lists: Vec<&Vec<NodeDof>> = matrices.iter().filter_map(|m| m.dofs.as_ref()).collect();
    let mut dofs: Vec<NodeDof> = lists.into_iter().flatten().copied().collect();
    dofs.sort_unstable();
    dofs.dedup();
    let place: HashMap<NodeDof, usize> = dofs.iter().enumerate().map(|(row, &dof)| (dof, row)).collect();
    let is_named = matrices.iter().all(|m| m.dofs.is_some());
    let size = if is_named { dofs.len() } else { matrices.iter().map(|m| m.size).max().unwrap_or(0) };
    if !is_named && matrices.iter().any(|m| m.size != size) {
        let [mass, stiffness] = [0, 1].map(|k| matrices.get(k).map_or(0, |m| m.size));
        let file = stiffness_file.display().to_string();
        return Err(TableError::file(&file, TableProblem::OtherSize { mass, stiffness }));
    }
    let mut moved = matrices.iter().map(|matrix| {
        let row = |i: usize| match &matrix.dofs {
            Some(own) if is_named => place.get(&own[i]).copied().unwrap_or(i),
            _ => i,
        };
        matrix.entries.iter().map(|&(i, j, value)| (row(i), row(j), value)).collect::<Vec<_>>()
    });
    let (mass, stiffness) = (moved.next().unwrap_or_default(), moved.next().unwrap_or_default());
    let mut is_fixed = vec![false; size];
    stiffness.iter().filter(|(i, j, v)| i == j && *v >= FIXED).for_each(|&(i, _, _)| is_fixed[i] = true);
    let count = is_fixed.iter().filter(|fixed| **fixed).count();
    if count > 0 {
        notes.push(format!("{count} degrees of freedom with a stiffness above 1e30 are taken as fixed and left out"));
    }
    let mut next = 0;
    let new_row: Vec<Option<usize>> = is_fixed
        .iter()
        .map(|fixed| {
            next += usize::from(!fixed);
            (!fixed).then(|| next - 1)
        })
        .collect();
    let built = |entries: Vec<(usize, usize, f64)>| {
        let left = entries.into_iter().filter_map(|(i, j, v)| Some((new_row[i]?, new_row[j]?, v)));
        SparseSymmetric::from_entries(next, &left.collect::<Vec<_>>())
    };
    let (Some(mass), Some(stiffness)) = (built(mass), built(stiffness)) else {
        return Err(TableError::file(&stiffness_file.display().to_string(), TableProblem::Empty));
    };
    let kept = dofs.into_iter().zip(&new_row).filter(|(_, row)| row.is_some()).map(|(dof, _)| dof).collect();
    Ok((SparseSystem { mass, stiffness }, is_named.then_some(kept)))
}

/// A sparse matrix in full.
pub(crate) fn full(a: &SparseSymmetric) -> Mat<f64> {
    let mut full = Mat::zeros(a.size(), a.size());
    a.entries().for_each(|(i, j, value)| {
        full[(i, j)] = value;
        full[(j, i)] = value;
    });
    full
}

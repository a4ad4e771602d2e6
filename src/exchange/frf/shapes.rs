//! Modes and operating shapes of a Universal File (data sets 55 and 2414) at the DOFs of a structure.

use super::error::{FrfError, FrfProblem};
use super::names::place;
use crate::classical::reference_shapes::{ReferenceShape, ShapeKind};
use crate::structure::Structure;
use dashpot_datafiles::Format;
use faer::c64;
use std::collections::BTreeMap;
use std::path::Path;
use uff::{File, Set, Summary};

/// Numbers of data at nodes with three translations, or with three rotations behind them.
const VECTORS: [usize; 2] = [3, 6];

/// A shape as it stands in the file.
struct Raw {
    name: String,
    kind: ShapeKind,
    frequency_hz: f64,
    damping_ratio: Option<f64>,
    /// DOFs of the file and values.
    at: Vec<(uff::Dof, c64)>,
}

/// Reads the modes and operating shapes of the file at `path`, called `name` in messages. `dofs` are DOFs of the file and their
/// labels in the structure; DOFs that the structure does not have are left out, as are those where no shape moves.
///
/// # Errors
/// [`FrfError`] for a file that cannot be read, or that has no shape at a DOF of the structure.
pub(crate) fn read_shapes(
    path: &Path,
    name: &str,
    dofs: &BTreeMap<String, String>,
    structure: &Structure,
) -> Result<Vec<ReferenceShape>, FrfError> {
    let in_file = |problem| FrfError { file: name.to_owned(), problem };
    let raw = raw(path).map_err(|error| in_file(FrfProblem::File(error)))?;
    if raw.is_empty() {
        return Err(in_file(FrfProblem::NoShapes));
    }
    let mut places = Places { raw: &raw, dofs, structure, known: BTreeMap::new() };
    let mut shapes = Vec::new();
    for shape in &raw {
        let at = places.at(shape);
        if at.iter().any(|(_, value)| value.norm() > 0.0) {
            let Raw { kind, frequency_hz, damping_ratio, .. } = *shape;
            let name = format!("{name}, {}", shape.name);
            shapes.push(ReferenceShape { name, kind, frequency_hz, damping_ratio, at });
        }
    }
    if shapes.is_empty() { Err(in_file(FrfProblem::ShapesElsewhere)) } else { Ok(shapes) }
}

/// Where the DOFs of a file lie in the structure.
struct Places<'a> {
    raw: &'a [Raw],
    dofs: &'a BTreeMap<String, String>,
    structure: &'a Structure,
    /// Row and sign by node and direction; none where the structure has no such DOF, or no shape moves there.
    known: BTreeMap<(i64, i64), Option<(usize, f64)>>,
}

impl Places<'_> {
    /// A shape at the DOFs of the structure, each once.
    fn at(&mut self, shape: &Raw) -> Vec<(usize, c64)> {
        let mut found: Vec<(usize, c64)> = Vec::new();
        for (dof, value) in &shape.at {
            if let Some((row, sign)) = self.of(dof)
                && found.iter().all(|(other, _)| *other != row)
            {
                found.push((row, value * sign));
            }
        }
        found
    }

    fn of(&mut self, dof: &uff::Dof) -> Option<(usize, f64)> {
        // Programs write zeros where nothing was measured.
        let mut values = self.raw.iter().flat_map(|shape| &shape.at).filter(|(other, _)| other == dof);
        let known = self.known.entry((dof.node, dof.direction));
        *known.or_insert_with(|| {
            place(dof, self.dofs, self.structure).ok().filter(|_| values.any(|(_, value)| value.norm() > 0.0))
        })
    }
}

/// Whether a Universal File holds a mode or an operating shape.
pub(crate) fn has_shapes(path: &Path) -> bool {
    // Files of other formats may be large, and are told by their first bytes.
    let universal = dashpot_datafiles::open(path).is_ok_and(|file| file.contents().format == Format::Uff);
    universal && File::open(path).is_ok_and(|file| file.sets().iter().any(|entry| kind(&entry.summary).is_some()))
}

/// What a set is by its header, where it is a shape at nodes with a frequency.
fn kind(summary: &Summary) -> Option<(ShapeKind, f64, Option<f64>)> {
    let (analysis, characteristic, complex, frequency, ratio) = match summary {
        Summary::Shape(header) => {
            let (frequency, ratio) = (header.frequency(), header.damping_ratio());
            (header.analysis, header.characteristic, header.complex, frequency, ratio)
        }
        Summary::Analysis(header) if header.location == 1 => {
            let (frequency, ratio) = (header.frequency(), header.damping_ratio());
            (header.analysis, header.characteristic, header.complex(), frequency, ratio)
        }
        _ => return None,
    };
    let kind = match analysis {
        2 if complex => ShapeKind::Complex,
        2 => ShapeKind::Normal,
        3 | 7 => ShapeKind::Complex,
        5 => ShapeKind::Operating,
        _ => return None,
    };
    let frequency = frequency.filter(|f| f.is_finite() && *f > 0.0 && matches!(characteristic, 2 | 3))?;
    let ratio = ratio.filter(|ratio| ratio.is_finite() && *ratio != 0.0 && kind != ShapeKind::Operating);
    Some((kind, frequency, ratio))
}

fn raw(path: &Path) -> Result<Vec<Raw>, uff::Error> {
    let mut file = File::open(path)?;
    let mut shapes = Vec::new();
    for (i, entry) in file.sets().to_vec().iter().enumerate() {
        let Some((kind, frequency_hz, damping_ratio)) = kind(&entry.summary) else { continue };
        let at = match file.read(i)?.set {
            Set::Shape(shape) if VECTORS.contains(&shape.header.per_node) => {
                let rows = shape.nodes.iter().enumerate();
                rows.flat_map(|(i, &node)| directions(node, &shape.at(i))).collect()
            }
            Set::Analysis(data) if VECTORS.contains(&data.header.per_node) => {
                let rows = data.labels.iter().enumerate().filter(|(_, labels)| !labels.is_empty());
                rows.flat_map(|(i, labels)| directions(labels[0], &data.row(i))).collect()
            }
            _ => continue,
        };
        shapes.push(Raw { name: format!("set {}", i + 1), kind, frequency_hz, damping_ratio, at });
    }
    Ok(shapes)
}

/// The values of a node at its directions.
fn directions(node: i64, values: &[[f64; 2]]) -> Vec<(uff::Dof, c64)> {
    let at_node = |(k, value): (usize, &[f64; 2])| (uff::Dof::new(node, k as i64 + 1), c64::new(value[0], value[1]));
    values.iter().enumerate().map(at_node).collect()
}

//! What a file of measurements says of the structure by itself: its kind and the DOFs that its channels name.

use super::error::{At, RecordFileError, RecordProblem};
use super::table::Table;
use crate::measurement::Quantity;
use crate::measurement::channel::ChannelName;
use crate::structure::{Direction, Dof, Node, Origin, Structure, StructureKind};
use std::path::Path;

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Contents {
    /// A time record.
    Time,
    /// Fitted harmonics of runs.
    Harmonics,
}

/// Kind of the file at `path`, and measured points for the DOFs of its channels, in the order in which they appear; a DOF
/// measured in radians is a rotation.
///
/// # Errors
/// [`RecordFileError`] for files that are no tables.
pub(crate) fn contents(path: &Path) -> Result<(Contents, Structure), RecordFileError> {
    let name = path.display().to_string();
    let at = At { file: &name };
    let bytes =
        std::fs::read(path).map_err(|error| at.file(RecordProblem::Unreadable { reason: error.to_string() }))?;
    let mut table = Table::open(&bytes, at)?;
    let column = table.header.iter().position(|name| name.eq_ignore_ascii_case("channel"));
    let mut points = Points::default();
    // Tables of other programs have a column of that name as well.
    let numbered = table.header.iter().any(|name| ["harmonic", "cos"].iter().any(|own| name.eq_ignore_ascii_case(own)));
    let Some(column) = column.filter(|_| numbered) else {
        table.header.iter().skip(1).for_each(|cell| points.add(cell));
        return Ok((Contents::Time, points.structure()));
    };
    while table.next()? {
        table.check_width()?;
        points.add(&table.text(column));
    }
    Ok((Contents::Harmonics, points.structure()))
}

#[derive(Default)]
struct Points {
    dofs: Vec<Dof>,
}

impl Points {
    /// Names that are no channels are passed over: who reads the file says what is wrong with them.
    fn add(&mut self, channel: &str) {
        let Ok(name) = ChannelName::parse(channel) else { return };
        if name.quantity != Quantity::Base && self.dofs.iter().all(|dof| dof.label != name.label) {
            let direction = if name.unit.rotation { Direction::Rx } else { Direction::X };
            self.dofs.push(Dof { label: name.label, node: self.dofs.len(), direction });
        }
    }

    fn structure(self) -> Structure {
        let node = |dof: &Dof| Node { label: dof.label.clone(), position: [dof.node as f64, 0.0, 0.0] };
        let nodes = self.dofs.iter().map(node).collect();
        let kind = StructureKind::Points;
        Structure {
            kind,
            nodes,
            dofs: self.dofs,
            lines: Vec::new(),
            matrices: None,
            elements: Vec::new(),
            lumped: Vec::new(),
            origin: Origin::default(),
        }
    }
}

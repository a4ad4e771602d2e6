//! CalculiX input: `DASHPOTA` elements, for `*STEADY STATE DYNAMICS` and `*MODAL DYNAMIC` steps.
//!
//! A `DASHPOTA` acts along the line through its two nodes. A dashpot to the ground has an extra node, held, one metre from the
//! first in the direction of the degree of freedom: at small motions this is exact. A dashpot between two degrees of freedom is
//! exact only where both are of the direction of the line through their nodes; others are left out, which is said.

use super::dashpots::{Dashpot, dashpots, grid_component};
use super::files::Export;
use super::identified::Identified;
use crate::structure::{Direction, Structure};
use std::fmt::Write;
use std::path::Path;

/// Sine of the angle between a dashpot's line and its direction up to which they count as one.
const ALONG: f64 = 1e-6;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let structure = identified.structure;
    let (dashpots, mut warnings) = dashpots(identified, "CalculiX");
    let mut text = format!("** {}\n** Viscous damping, N s/m. Nodes and degrees of freedom\n", identified.title);
    for (row, dof) in structure.dofs().iter().enumerate().filter(|(_, dof)| dof.direction != Direction::Q) {
        let (node, direction) = grid_component(structure, row);
        let _ = writeln!(text, "** DOF {} is node {node} degree of freedom {direction}", dof.label);
    }
    text.push_str("** Include this file in the model definition, before the first *STEP.\n");
    let highest = structure.dofs().iter().enumerate().map(|(row, _)| grid_component(structure, row).0).max();
    // Above the numbers of common models.
    let first_id = highest.unwrap_or(0).max(900_000) + 1;
    let mut elements = String::new();
    for (index, dashpot) in dashpots.iter().enumerate() {
        match element(structure, dashpot, first_id + index, index + 1) {
            Ok(lines) => elements.push_str(&lines),
            Err(reason) => warnings.push(reason),
        }
    }
    for warning in &warnings {
        let _ = writeln!(text, "** {warning}");
    }
    text.push_str(&elements);
    let mut export = Export { warnings, ..Export::default() };
    export.add(path.to_owned(), text);
    export
}

/// The lines of one dashpot; `id` is that of its element and, to the ground, of its extra node.
fn element(structure: &Structure, dashpot: &Dashpot, id: usize, number: usize) -> Result<String, String> {
    let (first, label) = (dashpot.leg.first, |dof: usize| structure.label(dof));
    let Some(axis) = structure.dofs()[first].direction.axis() else {
        return Err(format!("the dashpot at {} is at a rotation: a DASHPOTA cannot hold it", label(first)));
    };
    let (node, _) = grid_component(structure, first);
    let position = structure.nodes()[structure.dofs()[first].node].position;
    let mut text = String::new();
    let other = match dashpot.leg.second {
        None => {
            let mut ground = position;
            ground[axis] -= 1.0;
            let [x, y, z] = ground;
            let _ = writeln!(text, "*NODE\n{id}, {x:?}, {y:?}, {z:?}\n*BOUNDARY\n{id}, 1, 3");
            id
        }
        Some(second) => {
            let end = structure.nodes()[structure.dofs()[second].node].position;
            let line = [0, 1, 2].map(|k| end[k] - position[k]);
            let length = line.iter().map(|x| x * x).sum::<f64>().sqrt();
            let across = (0..3).filter(|&k| k != axis).map(|k| line[k] * line[k]).sum::<f64>().sqrt();
            if structure.dofs()[second].direction.axis() != Some(axis) || length == 0.0 || across > ALONG * length {
                let (a, b) = (label(first), label(second));
                return Err(format!(
                    "the dashpot between {a} and {b} does not act along the line through its nodes: a DASHPOTA cannot hold it"
                ));
            }
            grid_component(structure, second).0
        }
    };
    let _ = writeln!(text, "*ELEMENT, TYPE=DASHPOTA, ELSET=DASHPOT-{number}\n{id}, {node}, {other}");
    let _ = writeln!(text, "*DASHPOT, ELSET=DASHPOT-{number}\n\n{:?}", dashpot.c);
    Ok(text)
}

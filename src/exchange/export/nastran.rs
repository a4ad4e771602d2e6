//! NASTRAN bulk data: `DMIG` for the whole matrix, `CDAMP2` (element, coefficient, grid, component, grid, component) for single
//! dashpots.
//!
//! Small fields are 8 characters; numbers stand in the large form (16 characters, `*` after the card's name), so that
//! they keep twelve digits.

use super::dashpots::{Dashpot, dashpots, grid_component};
use super::files::{Export, beside};
use super::identified::Identified;
use crate::structure::Structure;
use faer::Mat;
use std::fmt::Write;
use std::path::Path;

/// First element number of the dashpots, above those of common models.
const FIRST_ID: usize = 900_001;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let (dashpots, mut warnings) = dashpots(identified, "NASTRAN");
    warnings.extend(in_own_systems(identified.structure, identified.viscous));
    let mut text = heading(identified);
    for warning in &warnings {
        let _ = writeln!(text, "$ {warning}");
    }
    for (index, dashpot) in dashpots.iter().enumerate() {
        text.push_str(&element(identified.structure, FIRST_ID + index, dashpot));
    }
    let mut export = Export { warnings, ..Export::default() };
    export.add(path.to_owned(), text);
    let mut whole = heading(identified);
    whole.push_str(
        "$ Select it with B2GG = CDAMP in the case control. Do not use it together with the CDAMP2 elements.\n",
    );
    whole.push_str(&dmig("CDAMP", identified.viscous, identified.structure));
    export.add(beside(path, "dmig"), whole);
    export
}

/// That damped grid points of the model have coordinate systems of their own (field CD), where that is so: the cards are in the basic one.
fn in_own_systems(structure: &Structure, viscous: &Mat<f64>) -> Option<String> {
    let is_damped = |row: usize| (0..viscous.ncols()).any(|column| viscous[(row, column)] != 0.0);
    let nodes = structure.nodes();
    let label = |row: usize| nodes.get(structure.dofs()[row].node).map(|node| node.label.as_str());
    let damped: Vec<&str> = (0..structure.len()).filter(|row| is_damped(*row)).filter_map(label).collect();
    let turned: Vec<&str> =
        structure.origin().turned.iter().map(String::as_str).filter(|node| damped.contains(node)).collect();
    (!turned.is_empty()).then(|| {
        format!(
            "grid points {} move in coordinate systems of their own (CD), and the components here are x, y and z of the basic system: give these points CD 0 before the cards are used",
            turned.join(", ")
        )
    })
}

/// `CDAMP2` in the large form, two lines.
fn element(structure: &Structure, id: usize, dashpot: &Dashpot) -> String {
    let (grid, component) = grid_component(structure, dashpot.leg.first);
    let first = format!("{:<8}{id:>16}{}{grid:>16}{component:>16}\n", "CDAMP2*", large(dashpot.c, 'E'));
    match dashpot.leg.second.map(|second| grid_component(structure, second)) {
        Some((grid, component)) => first + &format!("{:<8}{grid:>16}{component:>16}\n", "*"),
        None => first + &format!("{:<8}\n", "*"),
    }
}

fn heading(identified: &Identified) -> String {
    let mut text = format!("$ {}\n$ Viscous damping, N s/m. Grid points and components\n", identified.title);
    for (row, dof) in identified.structure.dofs().iter().enumerate() {
        let (grid, component) = grid_component(identified.structure, row);
        let _ = writeln!(text, "$ DOF {} is grid {grid} component {component}", dof.label);
    }
    text
}

/// A real number in a large field: 16 characters, the shortest exact form where it fits, else as many digits as fit.
/// `marker` is `E`, or `D` for double precision.
fn large(value: f64, marker: char) -> String {
    let exact = with_sign(&format!("{value:E}"), marker);
    let text = if exact.len() <= 16 {
        exact
    } else {
        let fitting = (0..=15).rev().map(|digits| with_sign(&format!("{value:.digits$E}"), marker));
        fitting.into_iter().find(|text| text.len() <= 16).unwrap_or(exact)
    };
    format!("{text:>16}")
}

/// `1E2` as `1.E+2`: a real has a point, its exponent a sign.
fn with_sign(number: &str, marker: char) -> String {
    let (mantissa, exponent) = number.split_once('E').unwrap_or((number, "0"));
    let point = if mantissa.contains('.') { "" } else { "." };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{mantissa}{point}{marker}{sign}{exponent}")
}

/// Symmetric real double-precision matrix of square form 6: header and one column card a column.
fn dmig(name: &str, values: &Mat<f64>, structure: &Structure) -> String {
    let mut text = format!("{:<8}{name:<8}{:>8}{:>8}{:>8}{:>8}\n", "DMIG", 0, 6, 2, 0);
    for j in 0..values.ncols() {
        let entries: Vec<usize> = (j..values.nrows()).filter(|&i| values[(i, j)] != 0.0).collect();
        if entries.is_empty() {
            continue;
        }
        let (grid, component) = grid_component(structure, j);
        let _ = writeln!(text, "{:<8}{name:<16}{grid:>16}{component:>16}", "DMIG*");
        for i in entries {
            let (grid, component) = grid_component(structure, i);
            let _ = writeln!(text, "{:<8}{grid:>16}{component:>16}{}", "*", large(values[(i, j)], 'D'));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::in_own_systems;
    use crate::common::models::cantilever;
    use faer::Mat;

    /// Told of grid points that are damped and turned, not of those that are but one of both.
    #[test]
    fn coordinate_systems_of_damped_grid_points_are_told() {
        let mut structure = cantilever(3);
        let labels: Vec<String> =
            [0, 2].map(|row: usize| structure.nodes()[structure.dofs()[row].node].label.clone()).into();
        let mut viscous = Mat::<f64>::zeros(6, 6);
        viscous[(2, 2)] = 0.5;
        assert_eq!(in_own_systems(&structure, &viscous), None);
        structure.set_origin((Vec::new(), labels.clone()), None, &[]);
        let said = in_own_systems(&structure, &viscous).unwrap_or_default();
        assert!(said.starts_with(&format!("grid points {} move", labels[1])) && said.lines().count() == 1, "{said}");
        assert_eq!(in_own_systems(&structure, &Mat::zeros(6, 6)), None);
    }
}

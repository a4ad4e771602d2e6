//! NASTRAN bulk data: `DMIG` for the whole matrix, `CDAMP2` (element, coefficient, grid, component, grid, component) for single
//! dashpots.
//!
//! Components are those of the grid points of the model (field `CD`): where these move in directions of their own the matrix is
//! turned into them, and a dashpot to the ground across them is a `CBUSH` in the basic system (`CID` 0). Small fields are 8
//! characters; numbers stand in the large form (16 characters, `*` after the card's name), so that they keep twelve digits.

use super::dashpots::{Dashpot, dashpots};
use super::files::{Export, beside};
use super::identified::Identified;
use super::own_directions::{Component, OwnDirections};
use faer::Mat;
use std::fmt::Write;
use std::path::Path;

/// First element number of the dashpots, above those of common models.
const FIRST_ID: usize = 900_001;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let (dashpots, mut warnings) = dashpots(identified, "NASTRAN");
    let own = OwnDirections::of(identified.structure);
    let mut elements = String::new();
    for (index, dashpot) in dashpots.iter().enumerate() {
        match element(&own, FIRST_ID + index, dashpot) {
            Some(lines) => elements.push_str(&lines),
            None => warnings.push(not_an_element(identified, dashpot)),
        }
    }
    let mut text = heading(identified, &own);
    for warning in &warnings {
        let _ = writeln!(text, "$ {warning}");
    }
    text.push_str(&elements);
    let mut export = Export { warnings, ..Export::default() };
    export.add(path.to_owned(), text);
    let mut whole = heading(identified, &own);
    whole.push_str(
        "$ Select it with B2GG = CDAMP in the case control. Do not use it together with the elements of the other file.\n",
    );
    whole.push_str(&dmig("CDAMP", identified.viscous, &own));
    export.add(beside(path, "dmig"), whole);
    export
}

/// That a dashpot between grid points cannot be an element, and where it is.
fn not_an_element(identified: &Identified, dashpot: &Dashpot) -> String {
    let labels =
        [Some(dashpot.leg.first), dashpot.leg.second].into_iter().flatten().map(|row| identified.structure.label(row));
    format!(
        "the dashpot between {} acts across the coordinate systems in which its grid points move (CD): no element holds it, the DMIG in the other file does",
        labels.collect::<Vec<_>>().join(" and ")
    )
}

/// The cards of a dashpot; none where it is between grid points and across the directions in which they move.
fn element(own: &OwnDirections<'_>, id: usize, dashpot: &Dashpot) -> Option<String> {
    let leg = dashpot.leg;
    match (own.alone(leg.first), leg.second.map(|row| own.alone(row))) {
        (Some((first, _)), None) => Some(damper(id, dashpot.c, first, None)),
        (Some((first, a)), Some(Some((second, b)))) if a == b => Some(damper(id, dashpot.c, first, Some(second))),
        (None, None) => Some(bush(id, dashpot.c, own.basic(leg.first))),
        _ => None,
    }
}

/// `CDAMP2` in the large form, two lines.
fn damper(id: usize, c: f64, (grid, component): Component, second: Option<Component>) -> String {
    let first = format!("{:<8}{id:>16}{}{grid:>16}{component:>16}\n", "CDAMP2*", large(c, 'E'));
    match second {
        Some((grid, component)) => first + &format!("{:<8}{grid:>16}{component:>16}\n", "*"),
        None => first + &format!("{:<8}\n", "*"),
    }
}

/// `CBUSH` to the ground in the basic system, and its `PBUSH` with one coefficient.
fn bush(id: usize, c: f64, (grid, component): Component) -> String {
    let coefficient = |number: u8| if number == component { large(c, 'E') } else { " ".repeat(16) };
    let fields = |range: std::ops::RangeInclusive<u8>| range.map(coefficient).collect::<String>();
    let system = format!("{:<8}{id:>16}{id:>16}{grid:>16}\n{:<56}{:>16}\n", "CBUSH*", "*", 0);
    let [first, second] = [fields(1..=2), fields(3..=6)];
    system + &format!("{:<8}{id:>16}{:>16}{}\n{:<8}{}\n", "PBUSH*", "B", first.trim_end(), "*", second.trim_end())
}

fn heading(identified: &Identified, own: &OwnDirections<'_>) -> String {
    let mut text = format!("$ {}\n$ Viscous damping, N s/m. Grid points and components\n", identified.title);
    for (row, dof) in identified.structure.dofs().iter().enumerate() {
        let (grid, component) = own.basic(row);
        let _ = match &own.parts(row)[..] {
            [(one, cosine)] if *cosine >= 1.0 => {
                writeln!(text, "$ DOF {} is grid {} component {}", dof.label, one.0, one.1)
            }
            parts => {
                let parts: Vec<String> =
                    parts.iter().map(|(own, cosine)| format!("{cosine:.6} of {}", own.1)).collect();
                writeln!(
                    text,
                    "$ DOF {} is grid {grid} component {component} of the basic system, {} of its own (CD)",
                    dof.label,
                    parts.join(", ")
                )
            }
        };
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
fn dmig(name: &str, values: &Mat<f64>, own: &OwnDirections<'_>) -> String {
    let (components, values) = own.turned(values);
    let mut text = format!("{:<8}{name:<8}{:>8}{:>8}{:>8}{:>8}\n", "DMIG", 0, 6, 2, 0);
    for (j, (grid, component)) in components.iter().enumerate() {
        let entries: Vec<usize> = (j..values.nrows()).filter(|&i| values[(i, j)] != 0.0).collect();
        if entries.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{:<8}{name:<16}{grid:>16}{component:>16}", "DMIG*");
        for i in entries {
            let (grid, component) = components[i];
            let _ = writeln!(text, "{:<8}{grid:>16}{component:>16}{}", "*", large(values[(i, j)], 'D'));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::cantilever;
    use crate::effects::Leg;
    use crate::structure::{Structure, TurnedNode};

    /// A cantilever of three elements whose second and third free nodes move in directions turned about y, by 30 and by 90 degrees.
    fn turned() -> Structure {
        let mut structure = cantilever(3);
        let label = |row: usize| structure.nodes()[structure.dofs()[row].node].label.clone();
        let about_y = |angle: f64| {
            let (s, c) = angle.to_radians().sin_cos();
            [[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]
        };
        let nodes = [(2, 30.0), (4, 90.0)].map(|(row, angle)| TurnedNode { label: label(row), axes: about_y(angle) });
        structure.set_origin(Vec::new(), nodes.into(), None, &[]);
        structure
    }

    /// The power of a motion is the same in the components of the grid points as in basic ones.
    #[test]
    fn a_matrix_in_own_directions_takes_the_same_power() {
        let structure = turned();
        let own = OwnDirections::of(&structure);
        let c = Mat::from_fn(6, 6, |i, j| if i == j { 3.0 } else { 1.0 / (1.0 + (i + j) as f64) });
        let (components, turned) = own.turned(&c);
        assert_eq!(components, [(2, 3), (2, 5), (3, 1), (3, 3), (3, 5), (4, 1), (4, 5)]);
        let v: Vec<f64> = (0..6).map(|i| (1.7 * f64::from(i)).sin()).collect();
        let mut w = vec![0.0; components.len()];
        for (row, velocity) in v.iter().enumerate() {
            for (component, cosine) in own.parts(row) {
                w[components.iter().position(|c| *c == component).unwrap()] += cosine * velocity;
            }
        }
        let power = |c: &Mat<f64>, v: &[f64]| -> f64 {
            (0..v.len()).flat_map(|i| (0..v.len()).map(move |j| (i, j))).map(|(i, j)| v[i] * c[(i, j)] * v[j]).sum()
        };
        assert!((power(&c, &v) - power(&turned, &w)).abs() < 1e-12 * power(&c, &v));
    }

    /// One component where it is the direction, a bush to the ground across them, and no element between grid points across them.
    #[test]
    fn a_dashpot_is_the_element_that_holds_it() {
        let structure = turned();
        let own = OwnDirections::of(&structure);
        let cards = |first, second| element(&own, 7, &Dashpot { leg: Leg { first, second }, c: 0.5 });
        let fields = |text: String| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(fields(cards(0, None).unwrap()), ["CDAMP2*", "7", "5.E-1", "2", "3", "*"]);
        assert_eq!(fields(cards(4, None).unwrap()), ["CDAMP2*", "7", "5.E-1", "4", "1", "*"]);
        assert_eq!(
            fields(cards(2, None).unwrap()),
            ["CBUSH*", "7", "7", "3", "*", "0", "PBUSH*", "7", "B", "*", "5.E-1"]
        );
        assert_eq!((cards(0, Some(2)), cards(0, Some(4))), (None, None), "across, and against");
    }
}

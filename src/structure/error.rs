//! What can be wrong with a structure.

use crate::math::GREATEST;

/// Why a structure could not be built, or has no modes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum StructureError {
    #[error("{name} is {value} {unit}: give a positive number of at most 1e30")]
    NotPositive { name: String, value: f64, unit: &'static str },
    #[error("{name} is {value} {unit}: give a number from 0 to 1e30")]
    Negative { name: String, value: f64, unit: &'static str },
    #[error("the beam has no elements: set elements to 1 or more")]
    NoElements,
    #[error("a beam of {elements} elements with these supports has no free degree of freedom: use more elements")]
    NothingFree { elements: usize },
    #[error("the structure has {degrees} degrees of freedom; at most {limit} can be handled")]
    TooLarge { degrees: usize, limit: usize },
    #[error("there are no degrees of freedom: name at least one")]
    NoDofs,
    #[error("{what} has {found} values but {expected} are needed{hint}")]
    Count { what: &'static str, found: usize, expected: usize, hint: &'static str },
    #[error(
        "the mass matrix is {mass_rows} x {mass_columns} and the stiffness matrix {stiffness_rows} x {stiffness_columns}: both must be square and of one size"
    )]
    Sizes { mass_rows: usize, mass_columns: usize, stiffness_rows: usize, stiffness_columns: usize },
    #[error("the {matrix} matrix has {value} at row {row}, column {column}: every entry must be a finite number")]
    NotFinite { matrix: &'static str, row: usize, column: usize, value: f64 },
    #[error(
        "the {matrix} matrix is not symmetric: row {row}, column {column} is {upper:e} but row {column}, column {row} is {lower:e} (relative difference {relative:.1e})"
    )]
    Asymmetric { matrix: &'static str, row: usize, column: usize, upper: f64, lower: f64, relative: f64 },
    #[error(
        "the mass matrix is not positive definite (least eigenvalue {least:.3e}, largest at DOF {dof}): every DOF needs mass"
    )]
    MassNotPositive { least: f64, dof: String },
    #[error(
        "the stiffness matrix is not positive semi-definite: omega^2 = {least:.3e} rad^2/s^2 for the lowest mode; correct the matrix"
    )]
    NegativeStiffness { least: f64 },
    #[error("{name} is {value}: give a finite number of metres")]
    NotAPosition { name: String, value: f64 },
    #[error("the damping matrix is {rows} x {columns} but the structure has {size} degrees of freedom")]
    DampingSize { rows: usize, columns: usize, size: usize },
    #[error("the DOF label \"{label}\" is used twice: labels must differ")]
    DuplicateDof { label: String },
    #[error("the node label \"{label}\" is used twice: labels must differ")]
    DuplicateNode { label: String },
    #[error("a DOF label is empty: every DOF needs a name")]
    EmptyLabel,
    #[error("there is no DOF \"{label}\"; labels near it: {}", near.join(", "))]
    UnknownDof { label: String, near: Vec<String> },
    #[error("there is no node \"{label}\"; labels near it: {}", near.join(", "))]
    UnknownNode { label: String, near: Vec<String> },
    #[error("this structure has no mass and stiffness matrices, so it has no modes: use kind beam, chain or matrices")]
    NoMatrices,
    #[error(
        "no degree of freedom is kept by the reduction; measure or drive one, or name some as `dofs` of [structure.reduce]"
    )]
    NothingKept,
    #[error("{kept} degrees of freedom would be kept of {degrees}; leave [structure.reduce] out")]
    NothingReduced { kept: usize, degrees: usize },
    #[error(
        "the stiffness of the inner degrees of freedom has no Cholesky factors: those that are kept do not restrain the structure, or it is unstable; use method \"craig-bampton\", or keep more"
    )]
    NotRestrained,
    #[error(
        "the model is not that of a stable structure: its stiffness is not positive semi-definite; leave out Lagrange multipliers and geometric stiffness"
    )]
    NotStable,
    #[error("more than {most} modes would be needed up to {} Hz; lower `up_to_hz` of [structure.reduce]", six_digits(*up_to_hz))]
    TooManyModes { most: usize, up_to_hz: f64 },
    #[error("the modes could not be computed: {reason}")]
    Modes { reason: String },
}

/// A number to six significant digits: limits that were computed, such as twice a frequency, end in roundings.
pub(super) fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// The few labels most like `label`, for the message about an unknown one.
pub(crate) fn nearest<'a>(label: &str, labels: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut ranked: Vec<(f64, usize, &str)> =
        labels.enumerate().map(|(place, other)| (distance(label, other), place, other)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().take(5).map(|(_, _, other)| other.to_string()).collect()
}

/// Numeric distance for numbers, edit distance for other labels.
fn distance(a: &str, b: &str) -> f64 {
    if let (Ok(x), Ok(y)) = (a.parse::<f64>(), b.parse::<f64>())
        && x.is_finite()
        && y.is_finite()
    {
        return (x - y).abs();
    }
    let other: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in other.iter().enumerate() {
            let replaced = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[other.len()] as f64
}

/// Fails unless `value` is positive and a physical quantity.
pub(crate) fn positive(name: impl Into<String>, value: f64, unit: &'static str) -> Result<(), StructureError> {
    if value > 0.0 && value <= GREATEST {
        Ok(())
    } else {
        Err(StructureError::NotPositive { name: name.into(), value, unit })
    }
}

/// Fails unless `value` is at least zero and a physical quantity.
pub(crate) fn not_negative(name: impl Into<String>, value: f64, unit: &'static str) -> Result<(), StructureError> {
    if (0.0..=GREATEST).contains(&value) {
        Ok(())
    } else {
        Err(StructureError::Negative { name: name.into(), value, unit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_labels() {
        assert_eq!(nearest("21", ["1", "19", "20", "2"].into_iter())[..2], ["20", "19"]);
        assert_eq!(nearest("tp", ["root", "tip"].into_iter())[0], "tip");
    }
}

//! `DMIG`: direct matrix input at grid points.
//!
//! Header `DMIG NAME 0 FORM TIN TOUT`; then one card a column: `DMIG NAME Gj Cj (blank) G1 C1 A1 B1 G2 C2 A2 B2 ...`.
//! Form 6 is symmetric and gives one triangle, form 1 is square.

use super::cards::Card;
use crate::error::{FileError, Problem};
use crate::matrix::{Matrix, NodeDof, Rows};
use crate::number::{component, real, whole};

/// First field of the entries in a column card, and fields an entry.
const ENTRIES: usize = 4;

#[derive(Debug, Default)]
struct Growing {
    name: String,
    rows: Rows,
    entries: Vec<(usize, usize, f64)>,
}

/// Matrices as their cards come.
#[derive(Debug, Default)]
pub(super) struct Matrices {
    found: Vec<Growing>,
    /// Those that are no real square matrices, such as loads, with the line of their header.
    refused: Vec<(String, usize, Problem)>,
}

impl Matrices {
    pub(super) fn card(&mut self, card: &Card<'_>) -> Result<(), Problem> {
        let name = card.field(0).to_uppercase();
        let known = self.found.iter().position(|matrix| matrix.name == name);
        if card.field(1) == "0" {
            match header(card, &name) {
                Err(problem @ (Problem::Form { .. } | Problem::Complex { .. })) => {
                    self.refused.push((name, card.line, problem));
                }
                Err(problem) => return Err(problem),
                Ok(()) if known.is_none() => self.found.push(Growing { name, ..Growing::default() }),
                Ok(()) => {}
            }
            return Ok(());
        }
        match known {
            Some(known) => self.found[known].column(card),
            None if self.refused.iter().any(|(refused, ..)| *refused == name) => Ok(()),
            None => Err(Problem::NoHeader { name }),
        }
    }

    /// The matrices, and a note for each that is none of mass and stiffness.
    ///
    /// # Errors
    /// The reason against the first, where no other matrix is there.
    pub(super) fn finish(self, file: &str) -> Result<(Vec<Matrix>, Vec<String>), FileError> {
        if self.found.is_empty()
            && let Some((_, line, problem)) = self.refused.first()
        {
            return Err(FileError::line(file, *line, problem.clone()));
        }
        let notes = self.refused.iter().map(|(_, _, problem)| format!("{problem}: it is not read")).collect();
        let built = |m: Growing| Matrix::new(file, &m.name, m.rows.dofs.len(), Some(m.rows.dofs), m.entries);
        Ok((self.found.into_iter().map(built).collect::<Result<_, _>>()?, notes))
    }
}

/// Checks that the matrix is square and real.
fn header(card: &Card<'_>, name: &str) -> Result<(), Problem> {
    let form = whole(card.field(2), "the form of a DMIG")?;
    if form != 1 && form != 6 {
        return Err(Problem::Form { name: name.to_owned(), form });
    }
    match whole(card.field(3), "the type of a DMIG")? {
        3 | 4 => Err(Problem::Complex { name: name.to_owned() }),
        _ => Ok(()),
    }
}

impl Growing {
    fn column(&mut self, card: &Card<'_>) -> Result<(), Problem> {
        let column = self.rows.of(dof(card.field(1), card.field(2))?);
        for k in (ENTRIES..card.len()).step_by(ENTRIES) {
            if card.field(k).is_empty() {
                continue;
            }
            let row = self.rows.of(dof(card.field(k), card.field(k + 1))?);
            let value = card.field(k + 2);
            self.entries.push((row, column, if value.is_empty() { 0.0 } else { real(value)? }));
        }
        Ok(())
    }
}

fn dof(grid: &str, direction: &str) -> Result<NodeDof, Problem> {
    Ok(NodeDof { node: whole(grid, "a grid point number")?, component: component(direction)? })
}

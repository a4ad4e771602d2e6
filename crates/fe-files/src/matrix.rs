//! A symmetric matrix as entries of its lower triangle.

use crate::error::{FileError, Float, Place, Problem};
use std::collections::HashMap;
use std::fmt;

/// Relative difference of mirrored entries that counts as rounding of the file.
const SYMMETRY: f64 = 1e-6;

/// A degree of freedom: node number and component, 1 to 3 translations, 4 to 6 rotations, 0 a scalar point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeDof {
    /// Node number.
    pub node: i64,
    /// Component.
    pub component: u8,
}

impl fmt::Display for NodeDof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.node, self.component)
    }
}

/// A real symmetric matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Name in the file, or what the file says that it is; empty without one.
    pub name: String,
    /// Number of rows.
    pub size: usize,
    /// The degree of freedom of each row, where the file says it.
    pub dofs: Option<Vec<NodeDof>>,
    /// Entries `(row, column, value)` of the lower triangle, from 0, each place once.
    pub entries: Vec<(usize, usize, f64)>,
}

impl Matrix {
    /// From all entries of a file: one triangle of either side (or a mixture), or both.
    ///
    /// # Errors
    /// [`Problem::Asymmetric`] where both triangles are given and differ by more than rounding.
    pub(crate) fn new(
        file: &str,
        name: &str,
        size: usize,
        dofs: Option<Vec<NodeDof>>,
        given: Vec<(usize, usize, f64)>,
    ) -> Result<Self, FileError> {
        let mut places: HashMap<(usize, usize), [Option<f64>; 2]> = HashMap::with_capacity(given.len());
        for (i, j, value) in given {
            let side = &mut places.entry((i.max(j), i.min(j))).or_default()[usize::from(i < j)];
            *side = Some(side.unwrap_or(0.0) + value);
        }
        let both = places.iter().any(|(&(i, j), sides)| i != j && sides.iter().all(|s| s.is_some_and(|v| v != 0.0)));
        let mut diagonal = vec![0.0; size];
        places.iter().filter(|((i, j), _)| i == j).for_each(|(&(i, _), sides)| diagonal[i] = sides[0].unwrap_or(0.0));
        let mut entries = Vec::with_capacity(places.len());
        for (&(i, j), &[lower, upper]) in &places {
            let (lower, upper) = (lower.unwrap_or(0.0), upper.unwrap_or(0.0));
            let value = if i == j || !both {
                lower + upper
            } else {
                let scale = (diagonal[i] * diagonal[j]).abs().sqrt().max(lower.abs()).max(upper.abs());
                if (lower - upper).abs() > SYMMETRY * scale {
                    let label = |k: usize| {
                        dofs.as_ref().map_or_else(|| (k + 1).to_string(), |d: &Vec<NodeDof>| d[k].to_string())
                    };
                    let (first, second) = (Float(lower), Float(upper));
                    let (name, row, column) = (name.to_owned(), label(i), label(j));
                    let problem = Problem::Asymmetric { name, row, column, first, second };
                    return Err(FileError::new(file, Place::File, problem));
                }
                0.5 * (lower + upper)
            };
            if value != 0.0 {
                entries.push((i, j, value));
            }
        }
        entries.sort_unstable_by_key(|&(i, j, _)| (j, i));
        Ok(Self { name: name.to_owned(), size, dofs, entries })
    }
}

/// Rows in the order of their first mention.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    places: HashMap<NodeDof, usize>,
    pub dofs: Vec<NodeDof>,
}

impl Rows {
    pub(crate) fn of(&mut self, dof: NodeDof) -> usize {
        *self.places.entry(dof).or_insert_with(|| {
            self.dofs.push(dof);
            self.dofs.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn one_triangle_both_or_a_mixture() {
        let lower = Matrix::new("f", "K", 3, None, vec![(0, 0, 2.0), (1, 0, -1.0), (2, 1, 0.5)]).unwrap();
        let upper = Matrix::new("f", "K", 3, None, vec![(0, 0, 2.0), (0, 1, -1.0), (2, 1, 0.5)]).unwrap();
        let both = vec![(0, 0, 2.0), (0, 1, -1.0), (1, 0, -1.0), (2, 1, 0.5), (1, 2, 0.5)];
        assert_eq!(lower, upper);
        assert_eq!(lower, Matrix::new("f", "K", 3, None, both).unwrap());
    }

    #[test]
    fn what_differs_is_told() {
        let odd = vec![(0, 0, 2.0), (1, 1, 2.0), (0, 1, -1.0), (1, 0, 1.0)];
        let message = Matrix::new("f", "K", 2, None, odd).unwrap_err().to_string();
        assert!(
            message.starts_with("f: matrix K is not symmetric: row 2, column 1 has 1e0 but its mirror -1e0"),
            "{message}"
        );
    }
}

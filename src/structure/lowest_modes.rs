//! The lowest modes of a large structure by block Lanczos, and what all higher ones add to a receptance.
//!
//! ```text
//! A = K + s M        V = M-orthonormal basis of X, A^-1 M X, (A^-1 M)^2 X, ...        V^T K V y = omega^2 y, phi = V y
//! sum_{r > m} phi_r phi_r^T / (omega_r^2 - w^2) = sum_t (w^2 + s)^t R_t,   R_0 = A^-1 - sum_{r <= m} phi_r phi_r^T / (omega_r^2 + s),   R_t+1 = A^-1 M R_t
//! ```
//!
//! Every new block is made orthogonal to the whole basis (twice), so no mode comes twice; a block of `BLOCK` vectors finds
//! modes of that multiplicity. One factorisation (n^3 / 3) and some products with the basis take the place of all n modes
//! (about 10 n^3, most of it slow): seconds instead of minutes at 2000 DOFs, less where the matrices are sparse ([`super::pencil`]).

use super::error::StructureError;
use super::matrices::SystemMatrices;
use super::modes::{self, Modes, failure};
use super::pencil::{Factor, OfMatrices, Pencil};
use crate::math::eigen;
use crate::math::fill::filled;
use dashpot_numerics::{product, transposed_product};
use faer::{ColRef, Mat, MatRef};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// Vectors in a block.
const BLOCK: usize = 12;
/// Shift over the square of the frequency asked for: makes a free structure's matrix definite.
const SHIFT: f64 = 1e-3;
/// `|K phi - omega^2 M phi|` over `(omega^2 + s) |M phi|` at which a mode counts as found.
const FOUND: f64 = 1e-8;
/// Part of a block's largest direction below which a direction is one of the basis already.
const DEPENDENT: f64 = 1e-20;
/// Terms of the series for what the higher modes add.
const TERMS: usize = 3;

/// The lowest modes and the factors that give the rest.
#[derive(Debug, Clone)]
pub(crate) struct LowestModes {
    /// Modes in ascending order of frequency, shapes n x m.
    pub modes: Modes,
    factor: Factor,
    shift: f64,
}

impl LowestModes {
    /// All modes up to the circular frequency `highest` (rad/s), at least `least` of them. `None` where the basis would
    /// have to grow to all vectors, or the stiffness is not that of a stable structure: [`modes::modes`] does it then.
    ///
    /// # Errors
    /// [`StructureError::Modes`] when a small eigenvalue problem does not converge.
    pub(crate) fn new(matrices: &SystemMatrices, highest: f64, least: usize) -> Result<Option<Self>, StructureError> {
        let shift = SHIFT * highest * highest;
        let Some(factor) = Factor::new(matrices, shift) else { return Ok(None) };
        let pencil = OfMatrices { matrices, factor: &factor };
        let found = search(&pencil, shift, highest, least, pencil.size())?;
        Ok(found.map(|modes| Self { modes, factor, shift }))
    }

    /// What the higher modes add to the columns `dofs` of the receptance.
    pub(crate) fn rest(&self, matrices: &SystemMatrices, dofs: &[usize]) -> Vec<Rest> {
        let pencil = OfMatrices { matrices, factor: &self.factor };
        let unit = filled(pencil.size(), dofs.len(), |i, j| f64::from(u8::from(i == dofs[j])));
        let mut term = self.without_lowest(pencil.solve(unit.as_ref()), dofs);
        let mut terms = Vec::new();
        for _ in 1..TERMS {
            let next = pencil.solve(pencil.by_mass(term.as_ref()).as_ref());
            terms.push(term);
            term = next;
        }
        terms.push(term);
        let column = |j: usize| terms.iter().map(|t| t.col(j).iter().copied().collect()).collect();
        (0..dofs.len()).map(|j| Rest { shift: self.shift, terms: column(j) }).collect()
    }

    /// `A^-1 e_j` less the modes that are known.
    fn without_lowest(&self, mut flexibility: Mat<f64>, dofs: &[usize]) -> Mat<f64> {
        let shapes = &self.modes.shapes;
        let weights = filled(self.modes.len(), dofs.len(), |r, j| {
            shapes[(dofs[j], r)] / (self.modes.omega[r].powi(2) + self.shift)
        });
        flexibility -= product(shapes.as_ref(), weights.as_ref());
        flexibility
    }
}

/// One column of what the higher modes add, at any frequency below them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rest {
    shift: f64,
    /// `R_t e_j`.
    terms: Vec<Vec<f64>>,
}

impl Rest {
    /// The column at `omega` (rad/s), n values, m/N.
    pub(crate) fn at(&self, omega: f64) -> Vec<f64> {
        let x = omega * omega + self.shift;
        let value = |i: usize| self.terms.iter().rev().fold(0.0, |sum, term| sum * x + term[i]);
        (0..self.terms[0].len()).map(value).collect()
    }
}

/// All modes of a pencil up to the circular frequency `highest` (rad/s), at least `least` of them; `None` where more than
/// `most` vectors would be needed, or the stiffness is not that of a stable structure. `shift` is `s` of `A = K + s M`.
pub(super) fn search<P: Pencil>(
    pencil: &P,
    shift: f64,
    highest: f64,
    least: usize,
    most: usize,
) -> Result<Option<Modes>, StructureError> {
    let mut krylov = Krylov::new(pencil, shift);
    let mut next_look = 2 * least.max(BLOCK);
    while krylov.basis.len() + BLOCK <= most {
        krylov.grow()?;
        if krylov.basis.len() < next_look {
            continue;
        }
        if let Some(modes) = krylov.found(highest, least)? {
            return Ok(Some(modes));
        }
        next_look = krylov.basis.len() * 5 / 4;
    }
    Ok(None)
}

/// A growing M-orthonormal basis with its products; vectors as columns of blocks.
struct Krylov<'a, P> {
    pencil: &'a P,
    shift: f64,
    basis: Columns,
    by_mass: Columns,
    by_stiffness: Columns,
    /// The newest block, n x its size.
    newest: Mat<f64>,
}

/// Columns of one length that grow in number.
struct Columns {
    rows: usize,
    values: Vec<f64>,
}

impl Columns {
    fn new(rows: usize) -> Self {
        Self { rows, values: Vec::new() }
    }

    fn len(&self) -> usize {
        self.values.len() / self.rows
    }

    fn push(&mut self, block: &Mat<f64>) {
        (0..block.ncols()).for_each(|j| self.values.extend(block.col(j).iter()));
    }

    fn matrix(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.rows, self.len())
    }
}

impl<'a, P: Pencil> Krylov<'a, P> {
    fn new(pencil: &'a P, shift: f64) -> Self {
        let n = pencil.size();
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let newest = filled(n, BLOCK, |_, _| StandardNormal.sample(&mut random));
        let [basis, by_mass, by_stiffness] = [0; 3].map(|_| Columns::new(n));
        Self { pencil, shift, basis, by_mass, by_stiffness, newest }
    }

    /// Adds `A^-1 M` times the newest block to the basis.
    fn grow(&mut self) -> Result<(), StructureError> {
        let loaded = self.pencil.by_mass(self.newest.as_ref());
        let mut block = self.pencil.solve(loaded.as_ref());
        let mut by_mass = self.pencil.by_mass(block.as_ref());
        for _ in 0..2 {
            if self.basis.len() > 0 {
                let along = transposed_product(self.by_mass.matrix(), block.as_ref());
                block -= product(self.basis.matrix(), along.as_ref());
                by_mass = self.pencil.by_mass(block.as_ref());
            }
            let turn = normaliser(&block, &by_mass)?;
            block = product(block.as_ref(), turn.as_ref());
            by_mass = product(by_mass.as_ref(), turn.as_ref());
        }
        self.basis.push(&block);
        self.by_mass.push(&by_mass);
        self.by_stiffness.push(&self.pencil.by_stiffness(block.as_ref()));
        self.newest = block;
        Ok(())
    }

    /// The modes asked for, once all of them are found.
    fn found(&self, highest: f64, least: usize) -> Result<Option<Modes>, StructureError> {
        let reduced = transposed_product(self.basis.matrix(), self.by_stiffness.matrix());
        let ritz = eigen::symmetric(reduced.as_ref()).map_err(|e| failure(&e))?;
        if ritz.values.first().is_some_and(|&v| v < -self.rounding()) {
            return Ok(None);
        }
        let wanted = ritz.values.partition_point(|&v| v <= highest * highest).max(least);
        if wanted + BLOCK > ritz.values.len() {
            return Ok(None);
        }
        let y = ritz.vectors.subcols(0, wanted);
        let by_mass = product(self.by_mass.matrix(), y);
        let by_stiffness = product(self.by_stiffness.matrix(), y);
        let is_found = |r: usize| {
            let left = residual(by_stiffness.col(r), by_mass.col(r), ritz.values[r]);
            let rounding = self.pencil.residual_rounding();
            left <= (FOUND * (ritz.values[r].abs() + self.shift) + rounding) * by_mass.col(r).norm_l2()
        };
        if !(0..wanted).all(is_found) {
            return Ok(None);
        }
        let omega = modes::frequencies(&ritz.values[..wanted], self.rounding());
        Ok(Some(Modes { omega, shapes: product(self.basis.matrix(), y) }))
    }

    /// Of `omega^2`.
    fn rounding(&self) -> f64 {
        (64.0 * f64::EPSILON * self.pencil.stiffest()).max(FOUND * self.shift)
    }
}

fn residual(by_stiffness: ColRef<'_, f64>, by_mass: ColRef<'_, f64>, value: f64) -> f64 {
    let square = |(a, b): (&f64, &f64)| (a - value * b).powi(2);
    by_stiffness.iter().zip(by_mass.iter()).map(square).sum::<f64>().sqrt()
}

/// `T` such that the columns of `block T` are M-orthonormal; dependent directions are dropped.
fn normaliser(block: &Mat<f64>, by_mass: &Mat<f64>) -> Result<Mat<f64>, StructureError> {
    let gram = transposed_product(block.as_ref(), by_mass.as_ref());
    let own = eigen::symmetric(gram.as_ref()).map_err(|e| failure(&e))?;
    let largest = own.values.last().copied().unwrap_or(0.0);
    let first = own.values.partition_point(|&v| v <= DEPENDENT * largest);
    let size = own.values.len();
    Ok(filled(size, size - first, |i, j| own.vectors[(i, first + j)] / own.values[first + j].sqrt()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models;
    use crate::structure::Structure;

    /// A chain, with or without springs to the ground.
    fn chain(n: usize, ground: f64) -> Structure {
        let masses: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * (0.7 * i as f64).sin()).collect();
        let coupling: Vec<f64> = (1..n).map(|i| 1e4 * (1.0 + 0.2 * (0.3 * i as f64).cos())).collect();
        models::chain(&masses, &vec![ground; n], &coupling)
    }

    #[test]
    fn agrees_with_all_modes() {
        for ground in [0.0, 50.0] {
            let structure = chain(300, ground);
            let matrices = structure.matrices().unwrap();
            let all = structure.modes().unwrap();
            let found = LowestModes::new(matrices, 1.0001 * all.omega[20], 10).unwrap().unwrap().modes;
            assert_eq!(found.len(), 21);
            for r in 0..found.len() {
                assert!((found.omega[r] - all.omega[r]).abs() < 1e-9 * all.omega[20], "{r}: {}", found.omega[r]);
                let mass = &matrices.mass;
                let same: f64 = (0..300).map(|i| found.shapes[(i, r)] * mass[(i, i)] * all.shapes[(i, r)]).sum();
                assert!((same.abs() - 1.0).abs() < 1e-12, "{r}: {same}");
            }
        }
    }

    /// Modes that come in pairs: two equal chains side by side.
    #[test]
    fn finds_both_of_equal_modes() {
        let one = chain(150, 20.0);
        let part = one.matrices().unwrap();
        let twice =
            |a: &Mat<f64>| filled(300, 300, |i, j| if i / 150 == j / 150 { a[(i % 150, j % 150)] } else { 0.0 });
        let both = SystemMatrices { mass: twice(&part.mass), stiffness: twice(&part.stiffness) };
        let own = one.modes().unwrap();
        let found = LowestModes::new(&both, own.omega[9] * 1.0001, 4).unwrap().unwrap().modes;
        assert_eq!(found.len(), 20);
        for r in 0..20 {
            assert!((found.omega[r] / own.omega[r / 2] - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn rest_is_the_sum_over_the_other_modes() {
        let structure = chain(300, 50.0);
        let (matrices, all) = (structure.matrices().unwrap(), structure.modes().unwrap());
        let lowest = LowestModes::new(matrices, all.omega[60], 10).unwrap().unwrap();
        let (omega, m) = (all.omega[60] / 6.0, lowest.modes.len());
        let rest = lowest.rest(matrices, &[7, 200]);
        for (j, dof) in [7, 200].into_iter().enumerate() {
            let column = rest[j].at(omega);
            let exact = |i: usize| -> f64 {
                let term =
                    |r: usize| all.shapes[(i, r)] * all.shapes[(dof, r)] / (all.omega[r].powi(2) - omega * omega);
                (m..300).map(term).sum()
            };
            let largest = (0..300).map(|i| exact(i).abs()).fold(0.0, f64::max);
            for i in 0..300 {
                assert!((column[i] - exact(i)).abs() < 1e-4 * largest, "{i}");
            }
        }
    }
}

//! Free forces against one dense least squares problem of all forces and parameters, solved by singular values, and against the
//! force of a dashpot in closed form.

use super::super::cell::{Cell, dot};
use super::super::location::Spot;
use super::Screen;
use crate::common::models::{source, three_masses};
use crate::common::runs::displacements_run;
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::Predictor;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::correction::{Correction, with_corrections};
use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::effects::{Effect, Leg};
use crate::structure::imported::{ImportedDof, ImportedParameters};
use crate::structure::{Direction, Part};
use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::{Arc, OnceLock};

const RUNS: usize = 3;
const HARMONICS: usize = 3;
const CHANNELS: usize = 4;
const SPOTS: usize = 5;
/// Updating parameters, and parameters of each run, which are another number for each harmonic.
const COMMON: usize = 2;
const OWN: usize = 2;
const REFERENCE: [f64; COMMON] = [0.4, -0.7];
const MISFIT: f64 = 2.5;

/// A screen of random residuals and columns; parameters are free at all harmonics but the last if they are to be.
fn screen(with_parameters: bool) -> Screen {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut list = |scale: f64| -> Vec<c64> {
        let mut number = || scale * (2.0 * random.random::<f64>() - 1.0);
        (0..CHANNELS).map(|_| c64::new(number(), number())).collect()
    };
    let mut cell = |h: usize| {
        let residual = list(3.0);
        let columns: Vec<Vec<c64>> = (0..SPOTS).map(|_| list(1.0)).collect();
        let free = with_parameters && h + 1 < HARMONICS;
        let slopes = if free { (0..COMMON).map(|_| list(0.8)).collect() } else { Vec::new() };
        let own = if free { (0..OWN).map(|_| list(0.6)).collect() } else { Vec::new() };
        Cell {
            total: dot(&residual, &residual).re,
            products: columns.iter().map(|a| dot(a, &residual)).collect(),
            squares: columns.iter().map(|a| dot(a, a).re).collect(),
            residual,
            columns,
            slopes,
            own,
            gram: OnceLock::new(),
        }
    };
    let cells = (0..RUNS).map(|_| (0..HARMONICS).map(&mut cell).collect()).collect();
    let spots = (0..SPOTS).map(|first| Spot::Leg(Leg { first, second: None })).collect();
    let reference = if with_parameters { REFERENCE.to_vec() } else { Vec::new() };
    Screen { spots, cells, reference, common: OnceLock::new(), without_prior: 0, misfit: MISFIT }
}

/// All rows at once: real and imaginary parts of every cell, priors behind; unknown are the changes of the common parameters, those
/// of each run, and real and imaginary part of the force of every spot, run and harmonic.
struct Dense {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    common: usize,
    own: usize,
}

impl Dense {
    fn new(screen: &Screen, spots: &[usize]) -> Self {
        let (common, own) = if screen.reference.is_empty() { (0, 0) } else { (COMMON, OWN) };
        let cells = RUNS * HARMONICS;
        let unknowns = common + cells * own + 2 * cells * spots.len();
        let rows = 2 * CHANNELS * cells + common + cells * own;
        let mut dense = Self { matrix: DMatrix::zeros(rows, unknowns), right: DVector::zeros(rows), common, own };
        for (r, run) in screen.cells.iter().enumerate() {
            for (h, cell) in run.iter().enumerate() {
                let row = 2 * CHANNELS * (r * HARMONICS + h);
                dense.place(row, None, &cell.residual);
                cell.slopes.iter().enumerate().for_each(|(k, b)| dense.place(row, Some(k), b));
                cell.own
                    .iter()
                    .enumerate()
                    .for_each(|(k, v)| dense.place(row, Some(common + (r * HARMONICS + h) * own + k), v));
                for (s, &spot) in spots.iter().enumerate() {
                    let column = dense.force(s, r, h);
                    let turned: Vec<c64> = cell.columns[spot].iter().map(|a| a * c64::new(0.0, 1.0)).collect();
                    dense.place(row, Some(column), &cell.columns[spot]);
                    dense.place(row, Some(column + 1), &turned);
                }
            }
        }
        // Parameters have unit prior deviations, by which as much is meant as what is left per datum.
        let (weight, first) = (MISFIT.sqrt(), 2 * CHANNELS * cells);
        for k in 0..common + cells * own {
            dense.matrix[(first + k, k)] = weight;
            dense.right[first + k] = if k < common { -weight * screen.reference[k] } else { 0.0 };
        }
        dense
    }

    /// Column of the real part of the force of the spot number `s`.
    fn force(&self, s: usize, r: usize, h: usize) -> usize {
        self.common + RUNS * HARMONICS * self.own + 2 * ((s * RUNS + r) * HARMONICS + h)
    }

    /// Writes complex values as the rows from `row` of a column, or of the right-hand side.
    fn place(&mut self, row: usize, column: Option<usize>, values: &[c64]) {
        for (i, value) in values.iter().enumerate() {
            for (part, x) in [value.re, value.im].into_iter().enumerate() {
                match column {
                    Some(k) => self.matrix[(row + 2 * i + part, k)] = x,
                    None => self.right[row + 2 * i + part] = x,
                }
            }
        }
    }

    /// Solution and squared residual.
    fn solve(&self) -> (DVector<f64>, f64) {
        if self.matrix.ncols() == 0 {
            return (DVector::zeros(0), self.right.norm_squared());
        }
        let x = self.matrix.clone().svd(true, true).solve(&self.right, 1e-12).expect("both sides");
        let left = (&self.matrix * &x - &self.right).norm_squared();
        (x, left)
    }

    /// Covariance of all unknowns for residuals of unit variance.
    fn covariance(&self) -> DMatrix<f64> {
        (self.matrix.transpose() * &self.matrix).try_inverse().expect("independent columns")
    }
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} for {expected}");
}

#[test]
fn what_free_forces_leave_is_what_dense_least_squares_leaves() {
    for with_parameters in [false, true] {
        let screen = screen(with_parameters);
        close(screen.nothing(), Dense::new(&screen, &[]).solve().1);
        for placing in screen.singles().into_iter().chain(screen.pairs(SPOTS * SPOTS)) {
            close(placing.chi_square, Dense::new(&screen, &placing.spots).solve().1);
        }
        let all = screen.pairs(SPOTS * SPOTS);
        assert_eq!(all.len(), SPOTS * (SPOTS - 1) / 2);
        assert!(all.windows(2).all(|pair| pair[0].chi_square <= pair[1].chi_square));
    }
}

#[test]
fn free_forces_and_parameters_are_those_of_dense_least_squares() {
    for (with_parameters, spots) in [(false, vec![2]), (false, vec![0, 3]), (true, vec![1]), (true, vec![4, 2])] {
        let screen = screen(with_parameters);
        let dense = Dense::new(&screen, &spots);
        let (x, _) = dense.solve();
        for (k, u) in screen.updated(&spots).into_iter().enumerate() {
            close(u, screen.reference[k] + x[k]);
        }
        let forces = screen.forces(&spots);
        for s in 0..spots.len() {
            for r in 0..RUNS {
                for h in 0..HARMONICS {
                    let column = dense.force(s, r, h);
                    let found = forces[s][r][h].value;
                    close(found.re, x[column]);
                    close(found.im, x[column + 1]);
                }
            }
        }
    }
}

/// The weight of a force is one over its variance where no parameter is free, other forces of its cell being free.
#[test]
fn weights_of_free_forces_are_inverse_variances() {
    let screen = screen(false);
    for spots in [vec![3], vec![1, 4]] {
        let dense = Dense::new(&screen, &spots);
        let (covariance, forces) = (dense.covariance(), screen.forces(&spots));
        for s in 0..spots.len() {
            let column = dense.force(s, 1, 1);
            close(forces[s][1][1].weight, covariance[(column, column)].recip());
        }
    }
}

/// How a force follows a change of the common parameters, those of the runs fitted anew, and how these alone scatter it.
#[test]
fn a_force_follows_the_parameters_as_in_dense_least_squares() {
    let (screen, spot) = (screen(true), 3);
    let freedom = screen.freedom(spot).expect("free parameters");
    let dense = Dense::new(&screen, &[spot]);
    let held = dense.matrix.columns(COMMON, dense.matrix.ncols() - COMMON).into_owned();
    let covariance = (held.transpose() * &held).try_inverse().expect("independent columns");
    assert!(freedom.runs.iter().all(|run| run[HARMONICS - 1].is_none()));
    for (r, h) in (0..RUNS).flat_map(|r| (0..HARMONICS - 1).map(move |h| (r, h))) {
        let found = freedom.runs[r][h].as_ref().expect("a place that is seen");
        let column = dense.force(0, r, h) - COMMON;
        for k in 0..COMMON {
            // What the change of a parameter takes from the rows of the data; its prior holds no other unknown.
            let right = -dense.matrix.column(k);
            let x = held.clone().svd(true, true).solve(&right, 1e-12).expect("both sides");
            close(found.common[k].re, x[column]);
            close(found.common[k].im, x[column + 1]);
        }
        let noise = screen.cells[r][h].squares[spot].recip();
        close(found.own[0], covariance[(column, column)] - noise);
        close(found.own[1], covariance[(column, column + 1)]);
        close(found.own[2], covariance[(column + 1, column + 1)] - noise);
    }
    // Information on the common parameters: the inverse of their block of the whole covariance.
    let block = dense.covariance().view((0, 0), (COMMON, COMMON)).into_owned();
    let information = block.try_inverse().expect("a covariance");
    for i in 0..COMMON {
        for j in 0..COMMON {
            close(freedom.information[(i, j)], information[(i, j)]);
        }
    }
}

/// A law of the whole structure is one column more at the fundamentals of all runs, without a prior.
#[test]
fn a_law_of_the_whole_structure_is_fitted_as_in_dense_least_squares() {
    for with_parameters in [false, true] {
        let screen = screen(with_parameters);
        // Any columns will do: those of another place of each run, two thousand times as large.
        let columns: Vec<Vec<c64>> =
            screen.cells.iter().map(|run| run[0].columns[2].iter().map(|a| *a * 2e3).collect()).collect();
        let mut dense = Dense::new(&screen, &[]);
        let last = dense.matrix.ncols();
        dense.matrix = dense.matrix.insert_column(last, 0.0);
        for (r, column) in columns.iter().enumerate() {
            dense.place(2 * CHANNELS * r * HARMONICS, Some(last), column);
        }
        let (x, left) = dense.solve();
        let found = screen.beside_whole(&columns).expect("columns that are not zero");
        close(found.value * 2e3, x[last] * 2e3);
        close(found.chi_square, left);
        for (k, u) in found.updated.into_iter().enumerate() {
            close(u, screen.reference[k] + x[k]);
        }
    }
    let silent = vec![vec![c64::new(0.0, 0.0); CHANNELS]; RUNS];
    assert!(screen(true).beside_whole(&silent).is_none());
}

/// A chain that hides a dashpot `c` between two masses: the force there is `i w c (X_2 - X_1)`, and no other place explains as much.
#[test]
fn the_free_force_of_a_hidden_dashpot_is_its_own() {
    let (structure, omegas, c, known) = (three_masses([1.0; 3]), [46.0, 52.0, 110.0, 170.0], 0.6, 0.8);
    let matrices = structure.matrices().expect("a chain has matrices").clone();
    let motion = |w: f64| {
        let mut z =
            DMatrix::from_fn(3, 3, |i, j| c64::new(matrices.stiffness[(i, j)] - w * w * matrices.mass[(i, j)], 0.0));
        z[(0, 0)] += c64::new(0.0, w * known);
        for (i, j, sign) in [(1, 1, 1.0), (2, 2, 1.0), (1, 2, -1.0), (2, 1, -1.0)] {
            z[(i, j)] += c64::new(0.0, sign * w * c);
        }
        let force = DVector::from_fn(3, |i, _| c64::new(if i == 2 { 2.0 } else { 0.0 }, 0.0));
        z.lu().solve(&force).expect("a damped structure").as_slice().to_vec()
    };
    let runs = omegas.map(|w| displacements_run(w, (2, 2.0), &motion(w), 1e-4));
    let sources = [source(Effect::Viscous, &[0], &[known])];
    let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
    let data = Data::new(&problem).expect("runs");
    let predictor = Arc::new(Predictor::new(&structure, sources.to_vec(), &data).expect("a model"));
    let control = Control::unattended();
    let reference = ReferenceModel::new(predictor, &data, &control, &|_| {}).expect("predictions");
    let screen = reference.view(None).expect("receptances").screen;
    let singles = screen.singles();
    let best = singles[0].spots[0];
    assert_eq!(screen.spots[best], Spot::Leg(Leg { first: 1, second: Some(2) }));
    assert!(singles[0].chi_square < 1e-3 && singles[1].chi_square > 10.0, "{singles:?}");
    for (w, force) in omegas.iter().zip(&screen.forces(&[best])[0]) {
        let x = motion(*w);
        let expected = c64::new(0.0, w * c) * (x[1] - x[2]);
        assert!((force[0].value - expected).norm() < 1e-6 * expected.norm(), "{} for {expected}", force[0].value);
    }
}

/// Which DOFs of matrices without lines are neighbours follows from the stiffness: the places are those of the model as it is stated, however
/// it is updated, for they are numbered.
#[test]
fn the_places_of_an_updated_model_are_those_of_the_stated_one() {
    // A rotation beside the chain: where there is one no springs are known, and modes are wrong.
    let chain = three_masses([1.0; 3]).matrices().expect("a chain has matrices").clone();
    let beside = |part: &Mat<f64>, own: f64| {
        Mat::from_fn(4, 4, |i, j| if i.max(j) < 3 { part[(i, j)] } else { f64::from(u8::from(i == j)) * own })
    };
    let dof = |(label, node, direction): (&str, &str, Direction)| ImportedDof {
        label: label.into(),
        node: node.into(),
        direction,
    };
    let dofs =
        [("1", "1", Direction::Z), ("2", "2", Direction::Z), ("3", "3", Direction::Z), ("3r", "3", Direction::Ry)];
    let (mass, stiffness) = (beside(&chain.mass, 1.0), beside(&chain.stiffness, 1e6));
    let dofs = Some(dofs.into_iter().map(dof).collect());
    let parameters = ImportedParameters { mass, stiffness, nodes: None, dofs, lines: Vec::new() };
    let structure = parameters.build(&[]).expect("matrices");
    let zero = c64::new(0.0, 0.0);
    let motion = [c64::new(1.0, 0.1), zero, c64::new(0.5, 0.2), zero];
    let omegas = structure.modes().expect("modes").omega.clone();
    let runs = [0.98, 1.03].map(|ratio| displacements_run(ratio * omegas[1], (2, 2.0), &motion, 1e-4));
    let problem = Problem { structure: &structure, sources: &[], runs: &runs };
    let data = Data::new(&problem).expect("runs");
    let predictor = Arc::new(Predictor::new(&structure, Vec::new(), &data).expect("a model"));
    let control = Control::unattended();
    let stated = ReferenceModel::new(predictor, &data, &control, &|_| {}).expect("predictions");
    let parameter = UpdatingParameter::Structure(Part::Mode(1));
    let corrections = [Correction { parameter, factor: 1.05, deviation: 0.0 }];
    let updating = with_corrections(Updating::all(&structure, &[], &data), &corrections);
    let updated = stated.updated(&updating, &[], &Vec::new()).expect("an updated model");
    assert_ne!(updated.predictor.structure().neighbours(), structure.neighbours());
    let spots = |model: &ReferenceModel| model.view(None).expect("receptances").screen.spots;
    assert_eq!(spots(&updated), spots(&stated));
}

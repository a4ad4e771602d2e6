//! Branch and bound against looking at every set.

use crate::random::{generator, matrix, vector};
use dashpot::control::Control;
use dashpot::math::subsets::{Ranking, SubsetError, SubsetProblem, branch_and_bound, exhaustive};
use faer::{Mat, MatRef};

fn problem<'a>(a: MatRef<'a, f64>, b: &'a [f64], size: usize, keep: usize, forced: &'a [usize]) -> SubsetProblem<'a> {
    SubsetProblem { a, b, size, keep, forced, node_limit: u64::MAX }
}

/// Positive columns, `true_size` of them in use, and relative noise.
fn planted(seed: u64, rows: usize, columns: usize, true_size: usize, noise: f64) -> (Mat<f64>, Vec<f64>) {
    let mut rng = generator(seed);
    let a = matrix(&mut rng, rows, columns, 0.0, 1.0);
    let error = vector(&mut rng, rows, -noise, noise);
    let step = columns / true_size;
    let used = |i: usize| (0..true_size).map(|k| (k + 1) as f64 * a[(i, k * step + 1)]).sum::<f64>();
    let b = (0..rows).map(|i| used(i) * (1.0 + error[i])).collect();
    (a, b)
}

fn same(one: &Ranking, other: &Ranking) {
    assert!(one.proved && other.proved);
    assert_eq!(one.sets.len(), other.sets.len());
    for (x, y) in one.sets.iter().zip(&other.sets) {
        assert!((x.residual_norm - y.residual_norm).abs() < 1e-9, "{x:?} {y:?}");
        assert_eq!(x.columns, y.columns);
    }
}

#[test]
fn same_ranking_as_exhaustive() {
    for seed in 0..12 {
        for (rows, columns, size) in [(8, 14, 3), (5, 12, 4), (20, 14, 4), (3, 10, 2), (6, 9, 1)] {
            let (a, b) = planted(seed, rows, columns, 3, 0.1);
            let question = problem(a.as_ref(), &b, size, 7, &[]);
            same(
                &branch_and_bound(&question, &Control::unattended()).unwrap(),
                &exhaustive(&question, &Control::unattended()).unwrap(),
            );
        }
    }
}

#[test]
fn same_ranking_with_columns_of_any_sign() {
    for seed in 100..112 {
        let mut rng = generator(seed);
        let a = matrix(&mut rng, 9, 13, -1.0, 1.0);
        let b = vector(&mut rng, 9, -1.0, 1.0);
        for size in 1..6 {
            let question = problem(a.as_ref(), &b, size, 5, &[]);
            same(
                &branch_and_bound(&question, &Control::unattended()).unwrap(),
                &exhaustive(&question, &Control::unattended()).unwrap(),
            );
        }
    }
}

#[test]
fn same_ranking_with_forced_columns() {
    for seed in 200..210 {
        let mut rng = generator(seed);
        let a = matrix(&mut rng, 9, 12, -0.5, 1.0);
        let b = vector(&mut rng, 9, 0.0, 1.0);
        for (size, forced) in [(1, vec![4]), (2, vec![4]), (4, vec![0, 7]), (4, vec![11])] {
            let question = problem(a.as_ref(), &b, size, 5, &forced);
            let fast = branch_and_bound(&question, &Control::unattended()).unwrap();
            same(&fast, &exhaustive(&question, &Control::unattended()).unwrap());
            assert!(fast.sets.iter().all(|set| forced.iter().all(|f| set.columns.contains(f))));
        }
    }
}

#[test]
fn exact_data_give_back_the_true_set() {
    let (a, b) = planted(7, 12, 40, 5, 0.0);
    let found = branch_and_bound(&problem(a.as_ref(), &b, 5, 3, &[]), &Control::unattended()).unwrap();
    assert!(found.proved);
    assert_eq!(found.sets[0].columns, [1, 9, 17, 25, 33]);
    for (k, x) in found.sets[0].coefficients.iter().enumerate() {
        assert!((x - (k + 1) as f64).abs() < 1e-9);
    }
    assert!(found.sets[0].angle < 1e-12 && found.sets[1].angle > 1e-4);
}

/// Sets of neighbours: with one column a place off, its neighbour in truth is best a place off to the other side, so that
/// only both together move to the truth.
#[test]
fn two_neighbouring_columns_are_found_together_without_a_tree() {
    let bump = |i: usize, j: usize| (-((4.0 * i as f64 - j as f64) / 12.0).powi(2)).exp();
    let a = Mat::from_fn(50, 190, bump);
    for truth in [[41, 52, 120, 133], [60, 68, 110, 150], [30, 90, 97, 160], [60, 66, 72, 150]] {
        let b: Vec<f64> =
            (0..50).map(|i| truth.iter().zip([2.0, 1.0, 1.5, 0.7]).map(|(&j, c)| c * bump(i, j)).sum()).collect();
        let question = SubsetProblem { node_limit: 1, ..problem(a.as_ref(), &b, 4, 3, &[]) };
        let found = branch_and_bound(&question, &Control::unattended()).unwrap();
        assert_eq!(found.sets[0].columns, truth, "{:?}", found.sets[0]);
    }
}

#[test]
fn collinear_zero_and_repeated_columns() {
    let (plain, b) = planted(9, 8, 10, 3, 0.05);
    let a = Mat::from_fn(8, 13, |i, j| match j {
        10 => 0.0,
        11 => 3.0 * plain[(i, 1)],
        12 => plain[(i, 1)] + plain[(i, 4)],
        _ => plain[(i, j)],
    });
    let question = problem(a.as_ref(), &b, 3, 1, &[]);
    let fast = branch_and_bound(&question, &Control::unattended()).unwrap();
    let slow = exhaustive(&question, &Control::unattended()).unwrap();
    assert!((fast.sets[0].residual_norm - slow.sets[0].residual_norm).abs() < 1e-12);
}

#[test]
fn limits_and_errors() {
    let (a, b) = planted(3, 8, 40, 5, 0.2);
    let limited = SubsetProblem { node_limit: 10, ..problem(a.as_ref(), &b, 5, 2, &[]) };
    let found = branch_and_bound(&limited, &Control::unattended()).unwrap();
    assert!(!found.proved && found.sets.len() == 2);
    let control = Control::unattended();
    control.cancel();
    assert!(matches!(branch_and_bound(&limited, &control), Err(SubsetError::Cancelled(_))));
    let forced = problem(a.as_ref(), &b, 2, 1, &[99]);
    assert_eq!(exhaustive(&forced, &Control::unattended()), Err(SubsetError::Forced { column: 99, columns: 40 }));
    assert!(matches!(
        branch_and_bound(&problem(a.as_ref(), &b, 41, 1, &[]), &Control::unattended()),
        Err(SubsetError::Size { .. })
    ));
}

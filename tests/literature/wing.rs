//! The Goland wing of section 5.3: tables 5.12 and 5.13.

use dashpot::structure::Structure;
use dashpot::structure::damped_modes::{DampedMode, damped_modes};
use dashpot::structure::wing::WingParameters;
use faer::Mat;

/// Pairs of nodes whose vertical motions the fourteen dashpots join.
pub const PAIRS: [(usize, usize); 14] = [
    (1, 4),
    (5, 8),
    (9, 12),
    (13, 16),
    (17, 20),
    (21, 24),
    (25, 28),
    (32, 35),
    (36, 39),
    (40, 43),
    (44, 47),
    (48, 51),
    (52, 55),
    (56, 59),
];
/// 200 lb s/ft, N s/m; the thesis prints 2919.
pub const COEFFICIENT: f64 = 200.0 * 4.448_221_615_260_5 / 0.3048;

pub fn vertical(structure: &Structure, node: usize) -> usize {
    structure.dof(&format!("{node}z")).unwrap()
}

pub fn damping(structure: &Structure, dashpots: &[(usize, usize, f64)]) -> Mat<f64> {
    let mut c = Mat::zeros(structure.len(), structure.len());
    for &(first, second, value) in dashpots {
        let (i, j) = (vertical(structure, first), vertical(structure, second));
        c[(i, i)] += value;
        c[(j, j)] += value;
        c[(i, j)] -= value;
        c[(j, i)] -= value;
    }
    c
}

pub fn modes(structure: &Structure, c: &Mat<f64>) -> Vec<DampedMode> {
    let matrices = structure.matrices().unwrap();
    damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), c.as_ref()).unwrap()
}

#[test]
fn table_5_12_frequencies_and_ratios() {
    let wing = WingParameters::goland().build(&[]).unwrap();
    assert_eq!((wing.len(), wing.nodes().len()), (180, 66));
    let truth: Vec<_> = PAIRS.iter().map(|&(i, j)| (i, j, COEFFICIENT)).collect();
    let found = modes(&wing, &damping(&wing, &truth));
    let printed = [
        (1.967, 0.021_636),
        (4.047, 0.009_169),
        (9.650, 0.019_158),
        (13.272, 0.0),
        (13.449, 0.026_271),
        (17.997, 0.023_350),
        (23.887, 0.029_190),
        (29.939, 0.045_236),
        (31.015, 0.049_506),
        (35.194, 0.056_917),
    ];
    for (r, (mode, (hz, zeta))) in found.iter().zip(printed).enumerate() {
        assert!((mode.frequency_hz - hz).abs() < 6e-4, "mode {}: {} Hz", r + 1, mode.frequency_hz);
        assert!((mode.damping_ratio - zeta).abs() < 5e-5 * zeta + 6e-7, "mode {}: {}", r + 1, mode.damping_ratio);
    }
}

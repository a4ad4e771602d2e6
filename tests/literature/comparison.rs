//! The numerical comparison of section 3.3.6: tables 3.1 and 3.2 in all columns, and the errors of figures 3.6 to 3.13.

use super::energy_support::cantilever;
use dashpot::classical::adhikari_woodhouse::{original, projection_error};
use dashpot::classical::errors::{generalised_mac, mac_error, matrix_error};
use dashpot::classical::frf_inverse::frf_inverse;
use dashpot::classical::lancaster::lancaster;
use dashpot::classical::{Damping, ModalData};
use dashpot::math::eigen::{least_eigenvalue, real_general};
use dashpot::structure::damped_modes::{DampedMode, damped_modes};
use dashpot::structure::modes::Modes;
use dashpot::structure::{Structure, SystemMatrices};
use faer::{Mat, c64};

/// Table 3.1, rad/s: exact, Lancaster, inverse of the receptance, perturbation.
const FREQUENCIES: [[f64; 4]; 20] = [
    [65.45, 65.45, 65.45, 65.45],
    [410.16, 410.16, 410.16, 410.16],
    [1148.71, 1148.71, 1148.71, 1148.71],
    [2252.59, 2252.59, 2252.59, 2252.60],
    [3729.53, 3729.53, 3729.53, 3729.53],
    [5587.26, 5587.26, 5587.26, 5587.31],
    [7839.20, 7839.20, 7839.20, 7839.24],
    [10_502.37, 10_502.37, 10_502.37, 10_502.46],
    [13_579.43, 13_579.43, 13_579.43, 13_579.51],
    [16_881.19, 16_881.19, 16_881.19, 16_881.35],
    [22_468.11, 22_468.12, 22_468.11, 22_468.32],
    [27_144.31, 27_144.30, 27_144.31, 27_145.03],
    [32_905.22, 32_905.22, 32_905.22, 32_906.51],
    [39_714.40, 39_714.40, 39_714.40, 39_718.82],
    [47_722.70, 47_722.70, 47_722.70, 47_743.74],
    [57_076.72, 57_076.73, 57_076.73, 57_189.76],
    [67_741.22, 67_741.23, 67_741.22, 67_789.80],
    [79_084.58, 79_084.65, 79_084.63, 79_272.22],
    [89_058.18, 89_058.08, 89_058.11, 88_698.73],
    [111_455.14, 111_455.07, 111_455.15, 111_265.52],
];

/// Table 3.2, in millionths: the same columns.
const RATIOS: [[f64; 4]; 20] = [
    [36_247.0, 36_247.0, 36_247.0, 36_247.0],
    [2208.0, 2208.0, 2208.0, 2208.0],
    [2140.0, 2140.0, 2140.0, 2140.0],
    [711.0, 711.0, 711.0, 711.0],
    [281.0, 281.0, 281.0, 281.0],
    [433.0, 0.0, 0.0, 553.0],
    [243.0, 0.0, 0.0, 292.0],
    [97.0, 0.0, 0.0, 301.0],
    [224.0, 0.0, 0.0, 201.0],
    [186.0, 0.0, 0.0, 195.0],
    [22.0, 0.0, 0.0, 171.0],
    [27.0, 0.0, 0.0, 304.0],
    [66.0, 0.0, 0.0, 428.0],
    [31.0, 0.0, 0.0, 729.0],
    [27.0, 0.0, 0.0, 2977.0],
    [40.0, 0.0, 0.0, 9675.0],
    [15.0, 0.0, 0.0, 4627.0],
    [4.0, 0.0, 0.0, 4859.0],
    [4.0, 0.0, 0.0, 134_941.0],
    [6.0, 0.0, 0.0, 7014.0],
];

struct Beam {
    structure: Structure,
    truth: Mat<f64>,
    exact: Vec<DampedMode>,
    undamped: Modes,
}

impl Beam {
    fn new() -> Self {
        let structure = cantilever(10);
        let mut truth = Mat::zeros(20, 20);
        for (label, c) in [(3, 0.2), (13, 0.5), (17, 0.15)] {
            truth[(label - 1, label - 1)] = c;
        }
        let undamped = structure.modes().unwrap();
        let exact = modes_of(&structure, &truth);
        Self { structure, truth, exact, undamped }
    }

    fn matrices(&self) -> &SystemMatrices {
        self.structure.matrices().unwrap()
    }

    fn measured(&self, count: usize) -> ModalData {
        ModalData::from_modes(&self.exact, count)
    }

    /// Lancaster, inverse of the receptance, perturbation.
    fn all(&self, count: usize) -> [Damping; 3] {
        let (m, data) = (self.matrices().mass.as_ref(), self.measured(count));
        [lancaster(m, &data).unwrap(), frf_inverse(&self.undamped, &data).unwrap(), original(m, &data).unwrap()]
    }

    fn eps_c(&self, count: usize) -> [f64; 3] {
        self.all(count).map(|found| matrix_error(self.truth.as_ref(), found.viscous.as_ref()))
    }
}

fn modes_of(structure: &Structure, c: &Mat<f64>) -> Vec<DampedMode> {
    let matrices = structure.matrices().unwrap();
    damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), c.as_ref()).unwrap()
}

/// Poles above the real axis of a damping matrix that need not be symmetric, as the perturbation's is not: those of the
/// state matrix in undamped modal coordinates, ascending.
fn poles(beam: &Beam, c: &Mat<f64>) -> Vec<c64> {
    let modal = beam.undamped.shapes.transpose() * c * &beam.undamped.shapes;
    let mut state = Mat::<f64>::zeros(40, 40);
    for r in 0..20 {
        state[(r, 20 + r)] = beam.undamped.omega[r];
        state[(20 + r, r)] = -beam.undamped.omega[r];
        for p in 0..20 {
            state[(20 + r, 20 + p)] = -modal[(r, p)];
        }
    }
    let mut values = real_general(state.as_ref()).unwrap().0;
    values.retain(|v| v.im > 0.0);
    values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    values
}

#[test]
fn tables_3_1_and_3_2_with_five_measured_modes() {
    let beam = Beam::new();
    let [a, b, c] = beam.all(5).map(|found| found.viscous);
    for (column, matrix) in [&beam.truth, &a, &b, &c].into_iter().enumerate() {
        for (r, pole) in poles(&beam, matrix).iter().enumerate() {
            // Modes 18 to 20 differ by up to 0.1 rad/s between two computations of the thesis' own model; so do, by 0.013,
            // frequencies from 11 on where C was identified.
            let tolerance = if r >= 17 {
                0.1
            } else if column > 0 && r >= 10 {
                0.013
            } else {
                0.0061
            };
            let (omega, printed) = (pole.norm(), FREQUENCIES[r][column]);
            assert!((omega - printed).abs() < tolerance, "column {column}, mode {}: {omega} {printed}", r + 1);
            let (zeta, printed) = (-pole.re / omega, 1e-6 * RATIOS[r][column]);
            assert!((zeta - printed).abs() < 5.1e-7, "column {column}, mode {}: {zeta} {printed}", r + 1);
        }
    }
}

#[test]
fn figure_3_12_errors_of_the_matrix() {
    let beam = Beam::new();
    let printed = [
        (1, [97.47, 87.05, 99.99]),
        (5, [89.58, 53.93, 99.98]),
        (10, [29.84, 2.90, 99.97]),
        (15, [9.76, 0.82, 83.38]),
        (19, [1.30, 0.03, 20.51]),
        (20, [0.0, 0.0, 0.0]),
    ];
    for (count, expected) in printed {
        for (found, value) in beam.eps_c(count).into_iter().zip(expected) {
            let tolerance = f64::max(0.006, 6e-4 * value);
            assert!((found - value).abs() < tolerance, "{count} modes: {found} {value}");
        }
    }
}

#[test]
fn figure_3_13_projection_error() {
    let beam = Beam::new();
    for (count, value) in [(1, 85.3), (5, 25.1), (10, 1.29), (15, 0.94), (19, 0.28), (20, 0.0)] {
        let found = projection_error(beam.matrices().mass.as_ref(), &beam.measured(count)).unwrap();
        assert!((found - value).abs() < if value > 10.0 { 0.051 } else { 0.0055 }, "{count} modes: {found} {value}");
    }
}

/// Figures 3.6 to 3.8: no error with all modes; the inverse of the receptance returns the measured modes with excellent
/// accuracy, the perturbation is the worst.
#[test]
fn figures_3_6_to_3_8_mac_errors() {
    let beam = Beam::new();
    let matrices = beam.matrices();
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let error = |found: &Damping| {
        let modes = modes_of(&beam.structure, &found.viscous);
        let mac = generalised_mac(m, k, (&modes, found.viscous.as_ref()), (&beam.exact, beam.truth.as_ref()));
        mac_error(mac.as_ref())
    };
    for found in beam.all(20) {
        let largest = error(&found).norm_max();
        assert!(largest < 1e-6, "{largest:.2e}");
    }
    for count in [5, 10, 15] {
        let [lancaster, inverse, perturbation] = beam.all(count).map(|found| error(&found));
        let (a, b, c) = (lancaster.norm_l2(), inverse.norm_l2(), perturbation.norm_l2());
        assert!(b < a && a < c, "{count} modes: {a:.2e} {b:.2e} {c:.2e}");
    }
    let five = error(&beam.all(5)[1]);
    assert!(five.submatrix(0, 0, 5, 5).norm_max() < 1e-4, "{:.2e}", five.submatrix(0, 0, 5, 5).norm_max());
}

#[test]
fn figure_3_10_places_of_the_dashpots_from_five_modes() {
    let beam = Beam::new();
    let [_, inverse, _] = beam.all(5);
    for (label, value) in [(13, 0.3365), (3, 0.1568), (17, 0.1062)] {
        assert!((inverse.viscous[(label - 1, label - 1)] - value).abs() < 6.5e-5);
    }
    let least = least_eigenvalue(inverse.viscous.as_ref());
    assert!((least + 0.151).abs() < 6e-4, "{least}");
}

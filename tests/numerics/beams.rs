//! Beam frequencies against the roots of the frequency equations, and the residuals of the eigenvectors.

use crate::random::{generator, positive};
use dashpot::math::eigen::generalised_symmetric;
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::modes::mac_real;
use faer::Mat;

fn beam(supports: Supports, elements: usize) -> (BeamParameters, Structure) {
    let parameters = BeamParameters {
        length: 0.8,
        breadth: 0.03,
        depth: 0.005,
        youngs_modulus: 210e9,
        density: 7800.0,
        elements,
        supports,
    };
    let structure = parameters.build(&[]).unwrap();
    (parameters, structure)
}

/// Roots beta L of the frequency equations (Blevins), first three elastic modes, and the number of rigid ones.
fn roots(supports: Supports) -> ([f64; 3], usize) {
    use std::f64::consts::PI;
    match supports {
        Supports::ClampedFree => ([1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613], 0),
        Supports::FreeFree => ([4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_67], 2),
        Supports::PinnedPinned => ([PI, 2.0 * PI, 3.0 * PI], 0),
        Supports::ClampedClamped => ([4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_67], 0),
        Supports::ClampedPinned => ([3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_03], 0),
    }
}

#[test]
fn frequencies_converge_to_the_closed_form_for_all_supports() {
    for supports in Supports::ALL {
        let (p, structure) = beam(supports, 20);
        let modes = structure.modes().unwrap();
        let (expected, rigid) = roots(supports);
        let unit = (p.youngs_modulus * p.depth * p.depth / (12.0 * p.density)).sqrt() / (p.length * p.length);
        assert!(modes.omega[..rigid].iter().all(|&w| w == 0.0), "{supports:?} {:?}", modes.omega);
        for (r, root) in expected.iter().enumerate() {
            let ratio = modes.omega[rigid + r] / (root * root * unit);
            // Hermite cubics: from above, error about (beta l)^4 / 1440 in omega.
            let bound = (root / 20.0).powi(4) / 1440.0 * 1.5 + 1e-9;
            assert!(ratio > 1.0 - 1e-8 && ratio - 1.0 < bound, "{supports:?} {r}: {}", ratio - 1.0);
        }
    }
}

#[test]
fn pinned_shapes_are_sines() {
    let (_, structure) = beam(Supports::PinnedPinned, 16);
    let modes = structure.modes().unwrap();
    let rows = structure.translations();
    for r in 0..3 {
        let shape: Vec<f64> = rows.iter().map(|&i| modes.shapes[(i, r)]).collect();
        let sine: Vec<f64> =
            (1..16).map(|k| (std::f64::consts::PI * (r + 1) as f64 * f64::from(k) / 16.0).sin()).collect();
        assert!((mac_real(&shape, &sine) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn eigenvectors_are_mass_normalised_and_leave_no_residual() {
    let mut rng = generator(5);
    for n in [1, 2, 7, 30] {
        let (k, m) = (positive(&mut rng, n, 0.1), positive(&mut rng, n, 0.5));
        let eigen = generalised_symmetric(k.as_ref(), m.as_ref()).unwrap();
        let x = &eigen.vectors;
        let omega = Mat::from_fn(n, n, |i, j| if i == j { eigen.values[i] } else { 0.0 });
        let size = eigen.values[n - 1];
        assert!((x.transpose() * &m * x - Mat::<f64>::identity(n, n)).norm_max() < 1e-11);
        assert!((&k * x - &m * x * omega).norm_max() < 1e-11 * size * m.norm_max());
        assert!(eigen.values.windows(2).all(|w| w[0] <= w[1]));
    }
}

#[test]
fn fine_meshes_keep_their_lowest_modes() {
    let (p, structure) = beam(Supports::ClampedFree, 150);
    let modes = structure.modes().unwrap();
    let unit = (p.youngs_modulus * p.depth * p.depth / (12.0 * p.density)).sqrt() / (p.length * p.length);
    assert!((modes.omega[0] / (1.875_104_068_711_961_f64.powi(2) * unit) - 1.0).abs() < 1e-5);
}

//! Loss factors and hysteretic elements in records: closed form, stepping of all degrees of freedom, complex modes.

use crate::common::models::{oscillator, short_cantilever, source, whole};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, Quantity};
use dashpot::response::linear_matrices::LinearMatrices;
use dashpot::response::time_integration::TimeModel;
use dashpot::response::transient::{SampledForces, TransientModel, TransientParameter, TransientSetup};
use dashpot::structure::Structure;

const STEP: f64 = 2e-4;
const SAMPLES: usize = 1500;

/// Displacements at rows of a structure that starts in its first three modes, without a force.
fn free(
    structure: &Structure,
    sources: &[Source],
    rows: &[usize],
    parameters: &[TransientParameter],
) -> [Vec<Vec<f64>>; 2] {
    let modes = structure.modes().unwrap();
    let channel = |&dof: &usize| Channel { quantity: Quantity::Displacement, dof, label: dof.to_string() };
    let channels: Vec<Channel> = rows.iter().map(channel).collect();
    let setup = TransientSetup {
        structure,
        modes: &modes,
        kept: structure.len(),
        sources,
        drives: &[],
        channels: &channels,
        factors: [1.0; 2],
        mode_stiffness: &[],
        mode_damping: &[],
        shape_errors: &[],
        parts: &[],
        directions: &[],
        step: [STEP; 2],
    };
    let model = TransientModel::new(&setup).unwrap();
    let forces = SampledForces {
        step: STEP,
        samples: SAMPLES,
        forces: Vec::new(),
        substeps: 1,
        every: 1,
        step_lengths: Vec::new(),
    };
    let mut initial = vec![0.0; 2 * structure.len()];
    initial.iter_mut().zip([1e-3, 4e-4, 1e-4]).take(structure.len()).for_each(|(y, start)| *y = start);
    let response = model.predict(&forces, &initial, parameters).unwrap();
    let derivatives = response.derivatives.into_iter().flatten().collect();
    [response.channels, derivatives]
}

/// Root of the squared difference over that of the first.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let square = |list: &mut dyn Iterator<Item = f64>| list.map(|x| x * x).sum::<f64>();
    (square(&mut a.iter().zip(b).map(|(a, b)| a - b)) / square(&mut a.iter().copied())).sqrt()
}

/// `x = X e^(-eta w t / 2) cos(w_d t + ..)`: an oscillator of loss factor `eta` rings as one of damping ratio `eta / 2`.
#[test]
fn a_loss_factor_rings_down_with_half_of_it_as_damping_ratio() {
    let (eta, omega) = (0.04, 200.0_f64);
    let structure = oscillator(1.0, omega * omega);
    for damper in [whole(Effect::LossFactor, eta), source(Effect::Hysteretic, &[0], &[eta * omega * omega])] {
        let [found, _] = free(&structure, &[damper], &[0], &[]);
        let (zeta, start) = (eta / 2.0, found[0][0]);
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let exact = |n: usize| {
            let t = STEP * n as f64;
            let phase = damped * t;
            start * (-zeta * omega * t).exp() * (phase.cos() + zeta * omega / damped * phase.sin())
        };
        let exact: Vec<f64> = (0..SAMPLES).map(exact).collect();
        assert!(apart(&exact, &found[0]) < 1e-9, "{:.1e}", apart(&exact, &found[0]));
    }
}

/// The loss factor of a range of elements, a hysteretic element and a spring beside them: modes with residual shapes against steps of all
/// degrees of freedom by another scheme.
#[test]
fn structural_damping_against_steps_of_all_degrees_of_freedom() {
    let structure = short_cantilever(4);
    let sources = [
        Source::known(Effect::LossFactor, Place::Whole(Some([1, 2])), &[0.05]),
        Source::known(Effect::LossFactor, Place::Whole(None), &[0.01]),
        source(Effect::Hysteretic, &[2, 6], &[80.0]),
        source(Effect::Stiffness, &[4], &[200.0]),
    ];
    let rows = [2, 6];
    let [found, _] = free(&structure, &sources, &rows, &[]);
    let modes = structure.modes().unwrap();
    let start = |i: usize| [1e-3, 4e-4, 1e-4].iter().enumerate().map(|(r, q)| q * modes.shapes[(i, r)]).sum::<f64>();
    let displacement: Vec<f64> = (0..structure.len()).map(start).collect();
    let mut model = TimeModel::under_force(&structure, &sources, None, STEP).unwrap();
    model.start(&displacement, &vec![0.0; structure.len()]);
    let mut stepped = vec![Vec::new(); 2];
    for _ in 0..SAMPLES {
        rows.iter().zip(&mut stepped).for_each(|(&row, list)| list.push(model.displacement(row)));
        model.advance().unwrap();
    }
    for (one, other) in stepped.iter().zip(&found) {
        assert!(apart(one, other) < 1e-6, "{:.1e}", apart(one, other));
    }
}

/// Poles of `det(M s^2 + K + i H) = 0` by the energy of the undamped mode, `2 zeta_r = phi_r^T H phi_r / omega_r^2`: each mode alone rings
/// with that damping ratio.
#[test]
fn each_mode_loses_what_its_complex_stiffness_takes() {
    let structure = short_cantilever(4);
    let sources = [
        Source::known(Effect::LossFactor, Place::Whole(Some([1, 1])), &[0.02]),
        source(Effect::Hysteretic, &[6], &[40.0]),
    ];
    let loss = LinearMatrices::new(&structure, &sources).unwrap().hysteretic;
    let modes = structure.modes().unwrap();
    for r in 0..2 {
        let shape = modes.shape(r);
        let taken: f64 = (0..shape.len())
            .flat_map(|i| (0..shape.len()).map(move |j| (i, j)))
            .map(|(i, j)| shape[i] * loss[(i, j)] * shape[j])
            .sum();
        let zeta = 0.5 * taken / modes.omega[r].powi(2);
        let mut model = TimeModel::under_force(&structure, &sources, None, STEP).unwrap();
        model.start(&shape, &vec![0.0; shape.len()]);
        let energy = |model: &TimeModel| {
            let matrices = structure.matrices().unwrap();
            let n = structure.len();
            let form = |m: &faer::Mat<f64>, y: &dyn Fn(usize) -> f64| -> f64 {
                (0..n).map(|i| (0..n).map(|j| y(i) * m[(i, j)] * y(j)).sum::<f64>()).sum()
            };
            form(&matrices.mass, &|i| model.velocity(i)) + form(&matrices.stiffness, &|i| model.displacement(i))
        };
        let before = energy(&model);
        let periods = 20.0;
        let steps = (periods * std::f64::consts::TAU / modes.omega[r] / STEP).round() as usize;
        (0..steps).for_each(|_| model.advance().unwrap());
        let found = (before / energy(&model)).ln() / (2.0 * modes.omega[r] * STEP * steps as f64);
        assert!((found / zeta - 1.0).abs() < 0.01, "mode {r}: {found} for {zeta}");
    }
}

/// Derivatives by the loss factor, all stiffness and all mass against central differences.
#[test]
fn derivatives_of_structural_damping() {
    let structure = short_cantilever(4);
    let with = |eta: f64| [whole(Effect::LossFactor, eta), source(Effect::Hysteretic, &[4], &[30.0 * eta])];
    let parameters = [0, 1].map(|source| TransientParameter::Source { source, parameter: 0 });
    let [_, derivatives] = free(&structure, &with(0.02), &[6], &parameters);
    let width = 1e-5;
    let [up, down] = [width, -width].map(|by| free(&structure, &with(0.02 + by), &[6], &[])[0][0].clone());
    let differences: Vec<f64> = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * width)).collect();
    let found: Vec<f64> = derivatives[0].iter().zip(&derivatives[1]).map(|(a, b)| a + 30.0 * b).collect();
    assert!(apart(&differences, &found) < 1e-4, "{:.1e}", apart(&differences, &found));
}

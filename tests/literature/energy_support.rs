//! The cantilever of section 5.2 and its runs, computed directly from the linear model.

pub(crate) use crate::common::models::cantilever;
pub(crate) use crate::common::runs::{channel, run};
use dashpot::balance::{Expansion, Weights};
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::identify::{Outcome, SelectionStep, Settings};
use dashpot::measurement::{Quantity, Run};
use dashpot::structure::Structure;
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// The thesis' settings: single-mode expansion, rows as they are, five best single columns.
pub(crate) fn thesis_settings() -> Settings {
    Settings {
        harmonics: 1,
        expansion: Expansion::SingleMode,
        keep: 5,
        weights: Weights::None,
        max_sources: 4,
        stop_angle_deg: 0.001,
    }
}

/// Candidates of a law at every DOF.
pub(crate) fn each_dof(structure: &Structure, effect: Effect) -> Vec<Source> {
    (0..structure.len()).map(|dof| Source::candidate(effect, Place::Dofs(vec![dof]))).collect()
}

/// Gives the candidate at a DOF (1-based label) another state.
pub(crate) fn force_candidate(sources: &mut [Source], label: usize) {
    sources.iter_mut().filter(|s| s.place == Place::Dofs(vec![label - 1])).for_each(|s| s.state = State::Forced);
}

/// Displacement under a unit force at DOF 19 with dashpots (label, N s/m) to the ground: an LU of its own, not the engine's.
pub(crate) fn displacement(structure: &Structure, dashpots: &[(usize, f64)], omega: f64) -> Vec<c64> {
    let matrices = structure.matrices().unwrap();
    let n = structure.len();
    let mut z =
        Mat::from_fn(n, n, |i, j| c64::new(matrices.stiffness[(i, j)] - omega * omega * matrices.mass[(i, j)], 0.0));
    for &(label, c) in dashpots {
        z[(label - 1, label - 1)] += c64::new(0.0, omega * c);
    }
    let x = z.partial_piv_lu().solve(Mat::from_fn(n, 1, |i, _| c64::new(if i == 18 { 1.0 } else { 0.0 }, 0.0)));
    (0..n).map(|i| x[(i, 0)]).collect()
}

/// Runs at the first eight undamped natural frequencies, unit force at DOF 19, accelerometers at 7, 11, 19.
pub(crate) fn resonant_runs(structure: &Structure, dashpots: &[(usize, f64)]) -> Vec<Run> {
    let modes = structure.modes().unwrap();
    (0..8)
        .map(|r| {
            let omega = modes.omega[r];
            let x = displacement(structure, dashpots, omega);
            let mut channels = vec![channel(Quantity::Force, 18, vec![c64::new(1.0, 0.0)], 0.0)];
            for dof in [6, 10, 18] {
                channels.push(channel(Quantity::Acceleration, dof, vec![-x[dof] * omega * omega], 0.0));
            }
            run(format!("mode {}", r + 1), omega, channels)
        })
        .collect()
}

/// Labels of a step's sources (1-based) and their coefficients.
pub(crate) fn told(step: &SelectionStep, sources: &[Source]) -> (Vec<usize>, Vec<f64>) {
    let label = |s: usize| if let Place::Dofs(dofs) = &sources[s].place { dofs[0] + 1 } else { 0 };
    (step.sources.iter().map(|e| label(e.source)).collect(), step.sources.iter().map(|e| e.coefficient).collect())
}

/// Checks one step against printed places, coefficients and angle.
pub(crate) fn assert_step(
    outcome: &Outcome,
    sources: &[Source],
    places: &[usize],
    coefficients: &[f64],
    angle_deg: f64,
    tolerance: f64,
) {
    let step = outcome.steps.iter().find(|s| s.count == places.len()).unwrap();
    let (labels, values) = told(step, sources);
    assert_eq!(labels, places, "at {} deg", step.angle_deg);
    for (value, printed) in values.iter().zip(coefficients) {
        assert!((value - printed).abs() <= tolerance, "{labels:?}: {values:?} instead of {coefficients:?}");
    }
    assert!((step.angle_deg - angle_deg).abs() <= 6e-4, "{labels:?}: {} deg", step.angle_deg);
}

//! The energy error of `compare` and the row of `identify` are one number where all DOFs are measured: the same runs, amplitudes, sensors
//! and energies.

use dashpot::balance::Expansion;
use dashpot::control::Control;
use dashpot::diagnosis::{Problem, compare};
use dashpot::effects::Source;
use dashpot::exchange::{Project, project::load};
use dashpot::identify::identify;
use dashpot::measurement::Quantity;
use std::path::Path;

fn sample(name: &str) -> Project {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name).join("project.toml");
    load(&path, &Control::unattended()).unwrap()
}

fn points() -> Project {
    sample("five-masses-points")
}

/// Largest difference of the two energy errors, over the used runs.
fn difference(project: &Project) -> f64 {
    let control = Control::unattended();
    let found = identify(&project.structure, &project.sources, &project.runs, &project.settings, &control).unwrap();
    let effects: Vec<Source> = found
        .accepted_step()
        .sources
        .iter()
        .map(|estimate| project.sources[estimate.source].with_coefficient(estimate.coefficient))
        .collect();
    let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
    let compared = compare(&problem, &effects, &control).unwrap();
    assert!(found.runs.len() > 2);
    let of_run = |row: &dashpot::identify::RunOutcome| {
        let error = ((row.input_energy - row.identified_energy) / row.input_energy).abs();
        let other = compared.runs.iter().find(|run| run.index == row.run).unwrap();
        assert!(other.used);
        (error - other.energy_error).abs()
    };
    found.runs.iter().map(of_run).fold(0.0, f64::max)
}

/// Both sum the same numbers; only the order of products differs.
const LAST_DIGIT: f64 = 1e-13;

#[test]
fn the_energy_error_is_that_of_the_row_of_identify() {
    let worst = difference(&points());
    assert!(worst < LAST_DIGIT, "{worst:e}");
}

/// With mass and stiffness stated, the response is predicted, and the energies are still those of the measured motion.
#[test]
fn the_energy_error_of_a_model_with_matrices_is_that_of_the_row() {
    let mut project = sample("five-masses");
    project.settings.expansion = Expansion::None;
    let worst = difference(&project);
    assert!(worst < LAST_DIGIT, "{worst:e}");
}

#[test]
fn a_dof_with_two_sensors_is_read_alike() {
    let mut project = points();
    for run in &mut project.runs {
        let motion = run.fit.channels.iter().find(|fit| fit.channel.quantity != Quantity::Force).cloned();
        let mut second = motion.unwrap();
        second.amplitudes.iter_mut().for_each(|amplitude| *amplitude *= 1.01);
        run.fit.channels.push(second);
    }
    let worst = difference(&project);
    assert!(worst < LAST_DIGIT, "{worst:e}");
}

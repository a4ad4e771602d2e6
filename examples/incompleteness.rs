//! Study of incompleteness (figures 3.6 to 3.13): errors of the classical methods against the number of measured modes and of
//! sensors, on the cantilever with three dashpots, as CSV on standard output.
//!
//! ```sh
//! cargo run --release --example incompleteness > incompleteness.csv
//! ```
//!
//! Columns: `modes`, `sensors`, `method`, `eps_c_percent` (3.135), `eps_p_percent` (3.117, perturbation only), `mac_error`
//! (largest entry of 3.134) and `mac_error_measured` (of the measured modes only). Shapes at fewer sensors are expanded to
//! all DOFs by the model's modes, lowest first.

use dashpot::classical::adhikari_woodhouse::{original, projection_error, symmetric};
use dashpot::classical::errors::{generalised_mac, mac_error, matrix_error};
use dashpot::classical::{ClassicalError, Damping, ModalData};
use dashpot::classical::{frf_inverse, ibrahim, lancaster, minas_inman, pilkey_inman, resonant};
use dashpot::math::eigen::symmetrised;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::damped_modes::{DampedMode, damped_modes_from};
use dashpot::structure::modes::Modes;
use dashpot::structure::{Structure, StructureError};
use faer::{Mat, c64};

struct Study {
    structure: Structure,
    model: Modes,
    truth: Mat<f64>,
    exact: Vec<DampedMode>,
}

fn study() -> Result<Study, StructureError> {
    let beam = BeamParameters {
        length: 0.56,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: 69e9,
        density: 2700.0,
        elements: 10,
        supports: Supports::ClampedFree,
    };
    let structure = beam.build(&[])?;
    let model = structure.modes()?;
    let mut truth = Mat::zeros(20, 20);
    for (label, c) in [(3, 0.2), (13, 0.5), (17, 0.15)] {
        truth[(label - 1, label - 1)] = c;
    }
    let exact = damped_modes_from(&model, truth.as_ref())?;
    Ok(Study { structure, model, truth, exact })
}

/// Shapes of the lowest modes as `sensors` translations, spread over the beam from the tip, show them.
fn measured(study: &Study, modes: usize, sensors: usize) -> Result<ModalData, ClassicalError> {
    let whole = ModalData::from_modes(&study.exact, modes);
    if sensors == study.structure.len() {
        return Ok(whole);
    }
    let translations = study.structure.translations();
    let at: Vec<usize> =
        (0..sensors).map(|k| translations[translations.len() - 1 - k * translations.len() / sensors]).rev().collect();
    let mut shapes = Mat::<c64>::zeros(study.structure.len(), modes);
    for p in 0..modes {
        let values: Vec<c64> = at.iter().map(|&dof| whole.shapes[(dof, p)]).collect();
        for (i, value) in resonant::expanded(&study.model, &at, &values, p)?.into_iter().enumerate() {
            shapes[(i, p)] = value;
        }
    }
    Ok(ModalData { poles: whole.poles, shapes, scaled: true })
}

fn row(study: &Study, modes: usize, sensors: usize, name: &str, found: &Damping, eps_p: Option<f64>) {
    let c = symmetrised(found.viscous.as_ref());
    let Some(matrices) = study.structure.matrices() else { return };
    let Ok(own) = damped_modes_from(&study.model, c.as_ref()) else { return };
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let mac = generalised_mac(m, k, (&own, c.as_ref()), (&study.exact, study.truth.as_ref()));
    let error = mac_error(mac.as_ref());
    let count = modes.min(error.nrows()).min(error.ncols());
    println!(
        "{modes},{sensors},{name},{:.4e},{},{:.4e},{:.4e}",
        matrix_error(study.truth.as_ref(), found.viscous.as_ref()),
        eps_p.map_or(String::new(), |e| format!("{e:.4e}")),
        error.norm_max(),
        error.submatrix(0, 0, count, count).norm_max()
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let study = study()?;
    let Some(matrices) = study.structure.matrices() else { return Ok(()) };
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    println!("modes,sensors,method,eps_c_percent,eps_p_percent,mac_error,mac_error_measured");
    for sensors in [20, 10, 5, 3] {
        for modes in (1..=20).filter(|&modes| sensors == 20 || modes <= sensors) {
            let data = measured(&study, modes, sensors)?;
            let eps_p = projection_error(m, &data)?;
            let all = [
                ("lancaster", lancaster::lancaster(m, &data)),
                ("pilkey-inman-direct", pilkey_inman::direct(m, k, &data)),
                ("frf-inverse", frf_inverse::frf_inverse(&study.model, &data)),
                ("perturbation", original(m, &data)),
                ("perturbation-symmetric", symmetric(m, &data)),
                ("ibrahim", ibrahim::ibrahim(m, &study.model, &data)),
                ("minas-inman", minas_inman::minas_inman(m, k, &data)),
            ];
            for (name, found) in all {
                match found {
                    Ok(found) => {
                        row(&study, modes, sensors, name, &found, (name == "perturbation").then_some(eps_p));
                    }
                    Err(error) => eprintln!("{modes} modes, {sensors} sensors, {name}: {error}"),
                }
            }
        }
    }
    Ok(())
}

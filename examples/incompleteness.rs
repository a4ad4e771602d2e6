//! Study of incompleteness (figures 3.6 to 3.13): errors of the classical methods against the number of measured modes and of
//! sensors, on the cantilever with three dashpots, as CSV on standard output.
//!
//! ```sh
//! cargo run --release --example incompleteness > incompleteness.csv
//! ```
//!
//! Columns: `modes`, `sensors`, `method`, `eps_c_percent` (3.135), `eps_p_percent` (3.117, a property of the measured modes),
//! `mac_error` (largest entry of 3.134) and `mac_error_measured` (of the measured modes only).
//! `dashpot methods FILE --incompleteness` does the same for the structure of a project.

use dashpot::classical::incompleteness::{Grid, METHODS, incompleteness, spread_sensors};
use dashpot::control::Control;
use dashpot::session::workers::Threads;
use dashpot::structure::beam::{BeamParameters, Supports};
use faer::Mat;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
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
    let mut truth = Mat::zeros(20, 20);
    for (label, c) in [(3, 0.2), (13, 0.5), (17, 0.15)] {
        truth[(label - 1, label - 1)] = c;
    }
    let mut sensors: Vec<Vec<usize>> = vec![(0..structure.len()).collect()];
    sensors.extend([10, 5, 3].map(|count| spread_sensors(&structure, count)));
    let grid = Grid { sensors, modes: (1..=20).collect(), mac: true };
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let study = incompleteness(&structure, truth.as_ref(), &grid, &control)?;
    println!("modes,sensors,method,eps_c_percent,eps_p_percent,mac_error,mac_error_measured");
    for case in &study.cases {
        let (modes, sensors) = (case.modes, study.sensors[case.sensors].len());
        for (method, found) in METHODS.iter().zip(&case.methods) {
            match found {
                Ok(e) => {
                    let [all, measured] =
                        [e.mac, e.mac_measured].map(|v| v.map_or(String::new(), |v| format!("{v:.4e}")));
                    println!(
                        "{modes},{sensors},{},{:.4e},{:.4e},{all},{measured}",
                        method.title().replace(',', ""),
                        e.eps_c,
                        case.eps_p
                    );
                }
                Err(why) => eprintln!("{modes} modes, {sensors} sensors, {}: {why}", method.title()),
            }
        }
    }
    Ok(())
}

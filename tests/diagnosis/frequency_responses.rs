//! Frequency responses to two forces, measured one after the other: noise in proportion to the response and no coherence, each force read
//! with a gain of its own, a structure that is a little stiffer in the second test, and a model 2 % off. Truth: dynamic stiffness, inverted.

use super::random::Random;
use dashpot::cli::answer;
use nalgebra::{Complex, DMatrix};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write;

const MASSES: [f64; 4] = [1.0, 1.2, 0.9, 1.1];
const GROUND: [f64; 4] = [8000.0, 0.0, 0.0, 3000.0];
const COUPLING: [f64; 3] = [20000.0, 25000.0, 18000.0];
/// What the model states too large or too small, of all masses, ground springs and couplings in turn.
const OFF: [f64; 3] = [0.02, -0.015, 0.02];
const DAMPING: [f64; 2] = [0.25, 6e-5];
/// Gain of each force and stiffness of its test.
const TESTS: [(usize, f64, f64); 2] = [(1, 1.01, 1.0), (3, 0.992, 1.0005)];
const NOISE: f64 = 0.01;
const LINES: usize = 800;

/// Accelerances of all masses to the force at `reference` (from 0 on) where the dynamic stiffness at mass 3 is larger by `hidden`.
fn accelerance(omega: f64, reference: usize, stiffer: f64, hidden: Complex<f64>) -> Vec<Complex<f64>> {
    let n = MASSES.len();
    let mut stiffness = DMatrix::<f64>::from_diagonal(&GROUND.to_vec().into());
    for (i, k) in COUPLING.into_iter().enumerate() {
        stiffness[(i, i)] += k;
        stiffness[(i + 1, i + 1)] += k;
        stiffness[(i, i + 1)] -= k;
        stiffness[(i + 1, i)] -= k;
    }
    let dynamic = DMatrix::from_fn(n, n, |i, j| {
        let mass = if i == j { MASSES[i] } else { 0.0 };
        let (k, c) = (stiffer * stiffness[(i, j)], DAMPING[0] * mass + DAMPING[1] * stiffness[(i, j)]);
        let at_place = if (i, j) == (2, 2) { hidden } else { Complex::default() };
        Complex::new(k - omega * omega * mass, omega * c) + at_place
    });
    let inverse = dynamic.try_inverse().unwrap();
    (0..n).map(|i| inverse[(i, reference)] * -omega * omega).collect()
}

/// What is said of the responses where a Maxwell element of this stiffness, N/m, and dashpot, N s/m, is at mass 3.
fn diagnosed(maxwell: [f64; 2]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(5);
    let gains: Vec<f64> = MASSES.iter().map(|_| 1.0 + 0.01 * random.normal()).collect();
    let mut table = String::from("\"Frequency [Hz]\"");
    for (reference, ..) in TESTS {
        for response in 1..=MASSES.len() {
            for part in ["Real", "Imag"] {
                write!(table, ",\"H({response},{}) {part} [(m/s^2)/N]\"", reference + 1).unwrap();
            }
        }
    }
    for line in 0..LINES {
        let frequency = 5.0 + 40.0 * line as f64 / LINES as f64;
        let omega = TAU * frequency;
        let [k, c] = maxwell;
        let dashpot = Complex::new(0.0, omega * c);
        let hidden = if k > 0.0 { dashpot * k / (dashpot + k) } else { Complex::default() };
        write!(table, "\n{frequency}").unwrap();
        for (reference, gain, stiffer) in TESTS {
            for (h, sensor) in accelerance(omega, reference, stiffer, hidden).into_iter().zip(&gains) {
                let noise = Complex::new(random.normal(), random.normal()) * (NOISE / 2.0_f64.sqrt());
                let read = h * (noise + 1.0) * *sensor / gain;
                write!(table, ",{:e},{:e}", read.re, read.im).unwrap();
            }
        }
    }
    std::fs::write(folder.path().join("responses.csv"), table).unwrap();
    let stated = |values: &[f64], off: f64| -> Vec<f64> {
        values.iter().enumerate().map(|(i, v)| v * (1.0 + off * [1.0, -0.6, 0.3, -1.0][i])).collect()
    };
    let project = format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = {:?}\nground_stiffness = {:?}\ncoupling_stiffness = {:?}\n\
         [[source]]\nlaw = \"mass_proportional\"\nstate = \"known\"\nalpha = {:?}\n\
         [[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = {:?}\n[[frf]]\nfile = \"responses.csv\"\n",
        stated(&MASSES, OFF[0]),
        stated(&GROUND, OFF[1]),
        stated(&COUPLING, OFF[2]),
        0.9 * DAMPING[0],
        1.1 * DAMPING[1],
    );
    let path = folder.path().join("project.toml");
    std::fs::write(&path, project).unwrap();
    let words = ["dashpot", "diagnose", "--json"].into_iter().map(Into::into);
    serde_json::from_str(&answer(words.chain([path.into()])).unwrap()).unwrap()
}

#[test]
fn nothing_is_missing_where_the_noise_is_in_proportion_to_the_response() {
    let said = diagnosed([0.0, 0.0]);
    assert_eq!(said["verdict"], "detuned", "{}", said["suggestions"]);
}

#[test]
fn a_maxwell_element_is_told_from_responses_to_two_forces() {
    let said = diagnosed([2000.0, 12.0]);
    let first = &said["suggestions"][0];
    assert_eq!(said["verdict"], "missing", "{first}");
    assert!(first["effect"] == "maxwell" && first["dofs"][0] == "3", "{first}");
    assert!(first["probability"].as_f64().unwrap() > 0.9, "{first}");
    let stiffness = first["parameters"]["stiffness"].as_f64().unwrap();
    assert!((stiffness / 2000.0 - 1.0).abs() < 0.1, "{stiffness} N/m");
}

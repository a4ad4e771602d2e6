//! Base excitation: transmissibility in closed form, and damping found on a shaker table.

use crate::{json, refused, said};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

/// One mass on a spring and a dashpot, both on the base; `m = 2 kg`, `k = 5000 N/m`, `c = 6 N s/m`.
fn one_mass(response: &str, runs: &str) -> String {
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2.0]\nground_stiffness = [5000.0]\ncoupling_stiffness = []\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 6.0\n[base]\nresponse = \"{response}\"\n{runs}\
         [simulate]\nchannels = [\"base@x [m/s^2]\", \"acc@1 [m/s^2]\", \"disp@1 [m]\"]\nsamples = 400\nperiods = 10\n"
    )
}

fn recipe(frequencies: &[f64], direction: &str) -> String {
    let run = |(i, f): (usize, &f64)| {
        format!("[[run]]\nfile = \"run-{i}.csv\"\nfrequency = {f:?}\nbase = \"{direction}\"\nbase_m_s2 = 3.0\n")
    };
    frequencies.iter().enumerate().map(run).collect()
}

/// `cos` and `sin` of a channel of a run in `harmonics.csv`.
fn amplitude(folder: &Path, run: usize, channel: &str) -> [f64; 2] {
    let text = fs::read_to_string(folder.join("harmonics.csv")).unwrap();
    let begin = format!("run-{run}.csv,");
    let row =
        text.lines().find(|l| l.starts_with(&begin) && l.contains(&format!(",{channel} [")) && l.contains("],1,"));
    let cells: Vec<&str> = row.unwrap().split(',').collect();
    [4, 5].map(|k| cells[k].parse().unwrap())
}

#[test]
fn transmissibility_of_one_mass() {
    let frequencies = [3.0, 7.9, 8.0, 20.0];
    let (natural, zeta) = (50.0, 6.0 / (2.0 * (5000.0_f64 * 2.0).sqrt()));
    for response in ["absolute", "relative"] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("t.toml"), one_mass(response, &recipe(&frequencies, "x"))).unwrap();
        said(&["simulate", "t.toml", "--out", ".", "--as", "harmonics"], folder.path());
        for (run, frequency) in frequencies.iter().enumerate() {
            let r = TAU * frequency / natural;
            let below = (1.0 - r * r).hypot(2.0 * zeta * r);
            // Rao, Mechanical Vibrations, 3.6: absolute and relative motion over that of the base.
            let exact = if response == "absolute" { 1.0_f64.hypot(2.0 * zeta * r) / below } else { r * r / below };
            for channel in ["acc@1", "disp@1"] {
                let [cos, sin] = amplitude(folder.path(), run, channel);
                let scale = if channel == "acc@1" { 3.0 } else { 3.0 / (TAU * frequency).powi(2) };
                let ratio = cos.hypot(sin) / scale;
                assert!((ratio / exact - 1.0).abs() < 1e-9, "{response} {channel} {frequency} Hz: {ratio} {exact}");
            }
            let [cos, sin] = amplitude(folder.path(), run, "base@x");
            assert!((cos - 3.0).abs() < 1e-9 && sin.abs() < 1e-9);
        }
    }
}

/// A cantilever on a shaker table with a dashpot, friction and a loss factor.
const TABLE: &str = r#"[project]
format = 1
[structure]
kind = "beam"
length = 0.56
breadth = 0.04
depth = 0.004
youngs_modulus = 69e9
density = 2700.0
elements = 10
supports = "clamped-free"
[[source]]
law = "stiffness_proportional"
state = "known"
beta = 2e-5
"#;

const HIDDEN: &str = "[[source]]\nlaw = \"viscous\"\ndofs = [7]\nstate = \"known\"\nc = 0.2\n\
    [[source]]\nlaw = \"viscous\"\ndofs = [15]\nstate = \"known\"\nc = 0.1\n";

#[test]
fn dashpots_are_found_on_a_shaker_table() {
    let folder = tempfile::tempdir().unwrap();
    let frequencies = [9.0, 10.0, 10.3, 10.6, 12.0, 60.0, 64.0, 66.0, 68.0, 175.0, 182.0, 190.0];
    let simulate =
        "[simulate]\nchannels = [\"base@z [m/s^2]\", \"acc@5 [m/s^2]\", \"acc@11 [m/s^2]\", \"acc@19 [m/s^2]\"]\n";
    let truth = format!("{TABLE}{HIDDEN}{}{simulate}", recipe(&frequencies, "z"));
    fs::write(folder.path().join("truth.toml"), truth).unwrap();
    said(&["simulate", "truth.toml", "--out", ".", "--noise", "0.01", "--seed", "3"], folder.path());
    let candidates = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n";
    let runs: String = (0..frequencies.len())
        .map(|i| format!("[[run]]\nfile = \"run-{i}.csv\"\nfrequency = {:?}\n", frequencies[i]))
        .collect();
    fs::write(folder.path().join("p.toml"), format!("{TABLE}{candidates}{runs}")).unwrap();
    let found = json(&["identify", "p.toml", "--json"], folder.path());
    let viscous: Vec<(String, f64)> = found["sources"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|s| s["law"] == "viscous" || s["effect"] == "viscous")
        .map(|s| (s["dofs"][0].as_str().unwrap().to_owned(), s["parameters"]["c"].as_f64().unwrap()))
        .collect();
    let labels: Vec<&str> = viscous.iter().map(|(label, _)| label.as_str()).collect();
    assert_eq!(labels, ["7", "15"], "{found}");
    assert!((viscous[0].1 - 0.2).abs() < 0.01 && (viscous[1].1 - 0.1).abs() < 0.01, "{viscous:?}");
    // The true model agrees with its records as far as noise lets it.
    fs::write(folder.path().join("known.toml"), format!("{TABLE}{HIDDEN}{runs}")).unwrap();
    let compared = json(&["compare", "known.toml", "--json"], folder.path());
    let (error, floor) = (compared["error"].as_f64().unwrap(), compared["noise_floor"].as_f64().unwrap());
    assert!(error < 1.5 * floor && floor < 0.01, "{error} {floor}");
}

#[test]
fn what_cannot_be_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let write_model = |text: &str| fs::write(folder.path().join("t.toml"), text).unwrap();
    write_model(&format!("{TABLE}{}[simulate]\nchannels = [\"acc@19 [m/s^2]\"]\n", recipe(&[3.0], "x")));
    assert!(
        refused(&["simulate", "t.toml", "--out", "."], folder.path())
            .ends_with("no DOF of the structure moves along x; correct `base` of the run")
    );
    write_model(&one_mass("absolut", &recipe(&[3.0], "x")));
    assert!(
        refused(&["simulate", "t.toml", "--out", "."], folder.path())
            .starts_with("t.toml:14: `response = \"absolut\"` is not understood")
    );
    write_model(&one_mass("absolute", &recipe(&[3.0], "x").replace("base_m_s2 = 3.0\n", "")));
    assert!(
        refused(&["simulate", "t.toml", "--out", "."], folder.path()).contains("`base` is there without `base_m_s2`")
    );
}

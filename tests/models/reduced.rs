//! A beam of 400 degrees of freedom as files of CalculiX's form, reduced in the project: what is simulated on the whole is
//! found on the reduced model, and the error is told.

use crate::common::models::cantilever;
use crate::{json, said};
use faer::Mat;
use std::fs;
use std::path::Path;

fn write_model(folder: &Path) {
    let structure = cantilever(200);
    let matrices = structure.matrices().unwrap();
    let text = |a: &Mat<f64>| -> String {
        let places = (0..400).flat_map(|j| (j..400).map(move |i| (i, j)));
        places.filter(|&p| a[p] != 0.0).map(|(i, j)| format!("{} {} {:e}\n", j + 1, i + 1, a[(i, j)])).collect()
    };
    fs::write(folder.join("beam.mas"), text(&matrices.mass)).unwrap();
    fs::write(folder.join("beam.sti"), text(&matrices.stiffness)).unwrap();
    let dofs: String = (1..=200).map(|n| format!("{n}.3\n{n}.5\n")).collect();
    fs::write(folder.join("beam.dof"), dofs).unwrap();
    let nodes: String = (1..=200).map(|n| format!("{n}, {}, 0, 0\n", 0.0028 * f64::from(n))).collect();
    let elements: String = (1..200).map(|n| format!("{n}, {n}, {}\n", n + 1)).collect();
    fs::write(folder.join("beam.inp"), format!("*NODE\n{nodes}*ELEMENT, TYPE=B31\n{elements}")).unwrap();
}

const HEAD: &str =
    "[project]\nformat = 1\n[structure]\nkind = \"matrices\"\nmass = \"beam.mas\"\nstiffness = \"beam.sti\"\n";
const REDUCE: &str = "[structure.reduce]\nup_to_hz = 8000.0\nband_hz = 700.0\n\
    dofs = [\"20z\", \"40z\", \"60z\", \"80z\", \"100z\", \"120z\", \"140z\", \"160z\", \"180z\"]\n";
const KNOWN: &str = "[[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = 2e-5\n";
const HIDDEN: &str = "[[source]]\nlaw = \"viscous\"\ndofs = [\"80z\"]\nstate = \"known\"\nc = 0.2\n\
    [[source]]\nlaw = \"viscous\"\ndofs = [\"160z\"]\nstate = \"known\"\nc = 0.1\n";
const FREQUENCIES: [f64; 12] = [9.0, 10.0, 10.3, 10.6, 12.0, 60.0, 64.0, 66.0, 68.0, 175.0, 182.0, 190.0];

fn runs(force: &str) -> String {
    let run = |(i, f): (usize, &f64)| format!("[[run]]\nfile = \"run-{i}.csv\"\nfrequency = {f:?}\n{force}");
    FREQUENCIES.iter().enumerate().map(run).collect()
}

#[test]
fn dashpots_of_the_whole_model_are_found_on_the_reduced_one() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path());
    let put = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    let force = "force_dof = \"200z\"\nforce_n = 2.0\n";
    let simulate = "[simulate]\nchannels = [\"force@200z [N]\", \"acc@50z [m/s^2]\", \"acc@120z [m/s^2]\", \"acc@200z [m/s^2]\"]\n";
    put("truth.toml", format!("{HEAD}{KNOWN}{HIDDEN}{}{simulate}", runs(force)));
    said(&["simulate", "truth.toml", "--out", ".", "--noise", "0.01"], folder.path());
    let candidates = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n";
    put("p.toml", format!("{HEAD}{REDUCE}{KNOWN}{candidates}{}", runs("")));
    let found = json(&["identify", "p.toml", "--json"], folder.path());
    let reduction = &found["reduction"];
    assert_eq!(reduction["from_dofs"], 400);
    // Nine named, and the sensors 50z and 200z (120z is among them).
    assert_eq!(reduction["kept_dofs"], 11);
    let error = reduction["worst_frequency_error"].as_f64().unwrap();
    assert!(error.abs() < 1e-3, "{error}");
    assert_eq!(reduction["modes"].as_array().unwrap().len(), 5);
    let labels: Vec<&str> = found["sources"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|s| s["law"] == "viscous" || s["effect"] == "viscous")
        .map(|s| s["dofs"][0].as_str().unwrap())
        .collect();
    assert_eq!(labels, ["80z", "160z"], "{}", found["sources"]);
    let text = said(&["identify", "p.toml"], folder.path());
    assert!(text.contains("reduced by craig-bampton from 400 degrees of freedom to 11 and "), "{text}");
    let compared = json(&["compare", "p.toml", "--json"], folder.path());
    assert_eq!(compared["reduction"]["method"], "craig-bampton");
}

/// Natural frequencies of the structure of a project, Hz.
fn frequencies_hz(folder: &Path, text: &str) -> Vec<f64> {
    fs::write(folder.join("f.toml"), text).unwrap();
    let plan = dashpot::exchange::project::open(&folder.join("f.toml")).unwrap();
    let modes = plan.structure.modes().unwrap();
    modes.omega.iter().map(|omega| omega / std::f64::consts::TAU).collect()
}

#[test]
fn corrections_hold_for_finite_element_files_whole_and_reduced() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path());
    let csv = |a: &Mat<f64>| -> String {
        let row = |i: usize| (0..a.ncols()).map(|j| format!("{:e}", a[(i, j)])).collect::<Vec<_>>().join(",") + "\n";
        (0..a.nrows()).map(row).collect()
    };
    let small = cantilever(10);
    let matrices = small.matrices().unwrap();
    fs::write(folder.path().join("m.csv"), csv(&matrices.mass)).unwrap();
    fs::write(folder.path().join("k.csv"), csv(&matrices.stiffness)).unwrap();
    let plain = HEAD.replace("beam.mas", "m.csv").replace("beam.sti", "k.csv");
    let reduce = "[structure.reduce]\nup_to_hz = 8000.0\nband_hz = 700.0\ndofs = [\"9\", \"19\"]\n";
    for shape in [HEAD.to_owned(), format!("{HEAD}{REDUCE}"), plain.clone(), format!("{plain}{reduce}")] {
        let correction = "[[structure.correction]]\nwhat = \"stiffness\"\nfactor = 0.25\n";
        let mode = "[[structure.correction]]\nwhat = \"mode\"\nmode = 2\nfactor = 1.21\n";
        let as_it_is = frequencies_hz(folder.path(), &shape);
        let corrected = frequencies_hz(folder.path(), &format!("{shape}{correction}{mode}"));
        for (mode, expected) in [0.5, 0.55, 0.5].into_iter().enumerate() {
            let ratio = corrected[mode] / as_it_is[mode];
            assert!((ratio - expected).abs() < 1e-6, "mode {}: {ratio}, {shape}", mode + 1);
        }
        let line = format!("{shape}{mode}").lines().count() - 3;
        let unknown = format!("{shape}{}", mode.replace("mode = 2", "mode = 900"));
        let said = refused(&["compare", "f.toml"], folder.path(), &unknown);
        assert!(said.starts_with(&format!("f.toml:{line}: `mode = 900`")), "{said}");
    }
}

fn refused(arguments: &[&str], folder: &Path, text: &str) -> String {
    fs::write(folder.join("f.toml"), text).unwrap();
    crate::refused(arguments, folder)
}

//! Files of laboratories, made here: stepped sine, imposed motion, decays, strains, responses without DOFs.

use super::{dashpot, imported, json};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Amplitude of the acceleration (m/s^2) and phase of the displacement (rad) of 2 kg on a spring at 80 Hz, damping ratio 0.01.
fn resonance(frequency_hz: f64, force: f64) -> (f64, f64) {
    let (omega, natural) = (TAU * frequency_hz, TAU * 80.0);
    let (re, im) = (natural * natural - omega * omega, 0.02 * natural * omega);
    (omega * omega * force / 2.0 / re.hypot(im), -im.atan2(re))
}

#[test]
fn a_stepped_sine_table_of_levels_is_recognised() {
    let mut text = "level,frequency_hz,force_n,acceleration_m_s2,phase_rad\n".to_owned();
    for (level, force) in [(1, 0.5), (2, 2.0)] {
        for step in 0..15 {
            let frequency = 78.6 + 0.2 * f64::from(step);
            let (acceleration, phase) = resonance(frequency, force);
            text.push_str(&format!("{level},{frequency},{force},{acceleration},{phase}\n"));
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "steps.csv", &text, &[]);
    assert!(said.contains("stepped sine, 30 runs at 2 levels from 78.6 to 81.4 Hz"), "{said}");
    assert!(
        project.contains("force = \"force@1 [N]\"") && project.contains("response = \"acc@1 [m/s^2]\""),
        "{project}"
    );
    assert!(
        project.contains("phase_of = \"disp\"") && project.contains("moves 2.000 kg here at 80.00 Hz"),
        "{project}"
    );
    let out = folder.path().join("project.toml").display().to_string();
    let identified = json(&["identify", "--json", &out]);
    let c = identified["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / (2.0 * 0.01 * 2.0 * TAU * 80.0) - 1.0).abs() < 1e-3, "{c}");
    let contents = json(&["contents", "--json", &folder.path().join("steps.csv").display().to_string()]);
    assert_eq!(contents["looks_like"], "stepped sine, 30 runs at 2 levels from 78.6 to 81.4 Hz");
}

#[test]
fn a_motion_that_is_run_up_held_and_run_down_is_cut_to_its_steady_part() {
    let mut text = "time [s],displacement [mm],force [N]\n".to_owned();
    for i in 0..4000 {
        let t = f64::from(i) / 200.0;
        let size = (t / 4.0).min(1.0).min((20.0 - t) / 4.0);
        let (x, v) = (size * (TAU * t).sin(), size * TAU * (TAU * t).cos());
        text.push_str(&format!("{t},{},{}\n", 10.0 * x, 50.0 * x + 2.0 * v));
    }
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "damper.csv", &text, &[]);
    assert!(said.contains("force@1: the file says no DOF: it is taken to act at DOF 1"), "{said}");
    assert!(project.contains("start_s = ") && project.contains("end_s = "), "{project}");
    let out = folder.path().join("project.toml").display().to_string();
    let identified = json(&["identify", "--json", &out]);
    let c = identified["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / 200.0 - 1.0).abs() < 0.01, "{c}");
}

/// A decay of an angle: 0.4 Hz, damping ratio 0.01.
fn roll(t: f64) -> f64 {
    let omega = TAU * 0.4;
    0.1 * (-0.01 * omega * t).exp() * (omega * t).cos()
}

#[test]
fn a_decay_without_a_model_becomes_one_mass_on_a_spring() {
    let mut text = "time,x,phi,theta\n".to_owned();
    for i in 0..3000 {
        let t = f64::from(i) / 20.0;
        text.push_str(&format!("{t},-33.4,{},{}\n", roll(t), 1e-4 * (f64::from(i * 7919 % 1000) / 1000.0 - 0.5)));
    }
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "roll.csv", &text, &[]);
    assert!(said.contains("one mass of 1 kg on a spring at 0.40000 Hz, by \"phi\""), "{said}");
    assert!(project.contains("kind = \"decay\"") && project.contains("kind = \"chain\""), "{project}");
    let out = folder.path().join("project.toml").display().to_string();
    let identified = json(&["identify", "--json", &out]);
    let c = identified["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / (2.0 * 0.01 * TAU * 0.4) - 1.0).abs() < 0.02, "{c}");
    assert!(json(&["compare", "--json", &out])["error"].is_number());
}

#[test]
fn strains_are_displacements_with_a_factor_to_fill_in() {
    let mut text = "time [s],Voltage [Volts],Strain_0 [Strain],Strain_1 [Strain]\n".to_owned();
    for i in 0..4000 {
        let t = f64::from(i) / 20.0;
        text.push_str(&format!("{t},1.0,{},{}\n", 1e-3 * roll(t), 1e-9 * f64::from(i % 2)));
    }
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "ring.csv", &text, &[]);
    assert!(said.contains("factor is 1 m a Strain, fill in its own"), "{said}");
    assert!(project.contains("name = \"Strain_0\"") && project.contains("factor = 1.0"), "{project}");
}

#[test]
fn a_universal_file_of_responses_without_dofs_is_numbered() {
    let values: String = (1..=40)
        .map(|i| {
            let (a, phase) = resonance(70.0 + 0.5 * f64::from(i), 1.0);
            format!(" {:.5e} {:.5e}\n", a * (phase + PI).cos(), a * (phase + PI).sin())
        })
        .collect();
    let axis = |kind: u8, unit: &str| format!("{kind:10}    0    0    0 NONE                 {unit:<20}\n");
    let text = format!(
        "    -1\n    58\nref\nNONE\n23-Mar-17 19:02:23\nRecord 1\nH1\n    4         0    0         0 NONE               0   0 NONE               0   0\n         5        40         1 7.05000e+01  5.00000e-01  0.00000e+00\n{}{}{}{}{values}    -1\n",
        axis(18, "Hz"),
        axis(12, "m/s^2"),
        axis(13, "N"),
        axis(0, "NONE"),
    );
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "h.uff", &text, &[]);
    assert!(said.contains("the responses are numbered 1 to 1 in their order, all driven at 1"), "{said}");
    assert!(project.contains("responses = [\"1\"]"), "{project}");
}

/// A function of a resonance at DOF 1 over itself, whose axes say these types and units.
fn without_units(types: [u8; 2], units: [&str; 2]) -> String {
    let values: String = (1..=40)
        .map(|i| {
            let (a, phase) = resonance(70.0 + 0.5 * f64::from(i), 1.0);
            format!(" {:.5e} {:.5e}\n", a * (phase + PI).cos(), a * (phase + PI).sin())
        })
        .collect();
    let axis = |kind: u8, unit: &str| format!("{kind:10}    0    0    0 NONE                 {unit:<20}\n");
    format!(
        "    -1\n    58\nref\nNONE\n23-Mar-17 19:02:23\nRecord 1\nH1\n    4         0    0         0 NONE               1   3 NONE               1   3\n         5        40         1 7.05000e+01  5.00000e-01  0.00000e+00\n{}{}{}{}{values}    -1\n",
        axis(18, "NONE"),
        axis(types[0], units[0]),
        axis(types[1], units[1]),
        axis(0, "NONE"),
    )
}

/// Programs write NONE for a unit, or nothing: SI then is assumed and said, by the type of the data or by `--form`.
#[test]
fn functions_without_units_are_taken_as_si_and_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for unit in ["NONE", ""] {
        let (_, project) = imported(folder.path(), "typed.uff", &without_units([12, 13], [unit; 2]), &[]);
        assert!(!project.contains("scale ="), "{project}");
        let (typed, again) = (folder.path().join("typed.uff"), folder.path().join("again.toml"));
        let command = [Path::new("import"), &typed, Path::new("--out"), &again];
        let done = std::process::Command::new(env!("CARGO_BIN_EXE_dashpot")).args(command).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(said.contains("1 of 1 functions name no unit: assumed to be in SI"), "{said}");
        let bare = without_units([0, 0], [unit; 2]);
        let (_, project) = imported(folder.path(), "bare.uff", &bare, &["--form", "accelerance"]);
        assert!(project.contains("form = \"accelerance\""), "{project}");
        assert!(!project.contains("scale ="), "{project}");
        let file = folder.path().join("bare.uff").display().to_string();
        let out = folder.path().join("none.toml").display().to_string();
        let error = dashpot(&["import", &file, "--out", &out]).unwrap_err();
        assert!(error.contains("`form` and `scale`") && error.contains("--form and --scale"), "{error}");
    }
}

#[test]
fn complex_values_without_frequencies_need_their_step() {
    let value = |i: i32| {
        let (a, phase) = resonance(0.5 * f64::from(i), 1.0);
        format!("({:?}{:+?}j)\n", a * (phase + PI).cos(), a * (phase + PI).sin())
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("point.txt");
    std::fs::write(&file, (0..400).map(value).collect::<String>()).unwrap();
    let (file, out) = (file.display().to_string(), folder.path().join("p.toml").display().to_string());
    let error = dashpot(&["import", &file, "--out", &out]).unwrap_err();
    assert!(error.contains("no frequencies; give their step by --step-hz"), "{error}");
    let said = dashpot(&["import", &file, "--out", &out, "--step-hz", "0.5", "--form", "accelerance"]).unwrap();
    assert!(said.contains("1 function at 1 DOF"), "{said}");
}

#[test]
fn what_is_no_measurement_is_said_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let said = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        let out = folder.path().join("none.toml");
        let error = dashpot(&["import", &file.display().to_string(), "--out", &out.display().to_string()]).unwrap_err();
        assert!(!error.contains('\n') && !out.exists(), "{error}");
        error
    };
    let nodes =
        "    -1\n    15\n         1         0         0         0  0.00000E+00  0.00000E+00  0.00000E+00\n    -1\n";
    assert!(said("nodes.uff", nodes).contains("holds geometry and no measurement"));
    let sound = "time [s],Mic [Pa]\n0,1\n0.1,2\n0.2,1\n0.3,2\n";
    assert!(said("sound.csv", sound).contains("\"Mic\" (Pa is no unit of a force or of a motion)"));
    let untimed = "Acc 1 [g],Force 1 [N]\n0,1\n0.1,2\n0.2,1\n0.3,2\n";
    assert!(said("untimed.csv", untimed).contains("give it by --sampling-hz"));
    let spectrum = "Frequency [Hz],Pilot [g^2/Hz]\n1,1\n2,2\n3,1\n4,2\n";
    assert!(said("psd.csv", spectrum).contains("holds spectra without phases"));
}

//! The values on the screen are those of `dashpot identify --json`: text of the accessibility tree against the document.

use crate::support::{Sample, beam, chain, open, settle};
use dashpot::display::format;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use serde_json::Value;
use std::process::Command;

/// The document that a command prints for a sample.
fn printed(command: &str, sample: &Sample) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_dashpot")).arg(command).arg(&sample.path).arg("--json").output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn look(harness: &mut Harness<'_, App>, stage: Stage, pane: Pane) {
    harness.state_mut().view.stage = stage;
    harness.state_mut().desk.set_open(stage, pane, true);
    settle(harness);
}

/// How many nodes say exactly this.
fn said(harness: &Harness<'_, App>, text: &str) -> usize {
    harness.query_all_by_label(text).count()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn coefficient(source: &Value) -> String {
    let (value, deviation) = (&source["parameters"]["c"], &source["standard_deviation"]["c"]);
    format::with_deviation(number(value), number(deviation), "N s/m")
}

fn check(sample: &Sample) {
    let json = printed("identify", sample);
    let mut harness = open(sample, Theme::Light);
    look(&mut harness, Stage::Measure, Pane::Runs);
    for run in json["runs"].as_array().unwrap() {
        let hertz = format!("{} Hz", format::significant(number(&run["frequency_hz"]), 4));
        assert!(said(&harness, &hertz) > 0, "{hertz}");
        assert!(said(&harness, &format::percent(number(&run["noise_ratio"]))) > 0, "{run}");
    }
    look(&mut harness, Stage::Select, Pane::Steps);
    for step in json["selection"].as_array().unwrap() {
        let angle = format!("{}°", format::significant(number(&step["angle_deg"]), 4));
        assert!(said(&harness, &angle) > 0, "{angle}");
        assert!(said(&harness, &format::percent(number(&step["relative_error"]))) > 0, "{step}");
        let sources = step["sources"].as_array().unwrap();
        for source in sources {
            // To three digits; the unit stands once behind them all.
            let value = format::significant(number(&source["parameters"]["c"]), 3);
            assert!(harness.query_all_by_label_contains(&value).count() > 0, "{value}");
        }
    }
    look(&mut harness, Stage::Result, Pane::Values);
    for source in json["sources"].as_array().unwrap() {
        assert!(said(&harness, &coefficient(source)) > 0, "{source}");
        assert!(said(&harness, &format::percent(0.01 * number(&source["energy_percent"]))) > 0, "{source}");
    }
    look(&mut harness, Stage::Result, Pane::Energy);
    for dof in json["energy_percent"].as_array().unwrap().iter().filter(|dof| number(&dof["percent"]) > 1e-9) {
        let percent = format::percent(0.01 * number(&dof["percent"]));
        let line = format!("DOF {}: {percent}", dof["dof"].as_str().unwrap());
        assert_eq!(said(&harness, &line), 1, "{line}");
    }
    look(&mut harness, Stage::Result, Pane::Damping);
    for mode in json["modes"].as_array().unwrap() {
        let [ratio, deviation] = ["damping_ratio", "standard_deviation"].map(|key| 100.0 * number(&mode[key]));
        for (value, digits) in [(ratio, format::supported(ratio, deviation)), (deviation, 2)] {
            let line = format!("{} %", format::significant(value, digits));
            assert!(said(&harness, &line) > 0, "{line}");
        }
        let hertz = format::with_unit(number(&mode["frequency_hz"]), "Hz");
        assert!(said(&harness, &hertz) > 0, "{hertz}");
    }
    let accepted = json["accepted"].as_u64().unwrap() as usize;
    let step = json["selection"].as_array().unwrap().iter().find(|s| s["count"] == accepted).unwrap();
    let error = format!("energy error {}", format::percent(number(&step["relative_error"])));
    harness.get_by_label_contains(&error);
}

#[test]
fn a_beam_shows_the_values_of_the_command_line() {
    check(&beam());
}

#[test]
fn a_chain_shows_the_values_of_the_command_line() {
    check(&chain());
}

#[test]
fn the_classical_methods_are_those_of_the_command_line() {
    let sample = chain();
    let json = printed("methods", &sample);
    let mut harness = open(&sample, Theme::Light);
    look(&mut harness, Stage::Result, Pane::Methods);
    let (mut ran, mut refused) = (0, 0);
    for method in json["methods"].as_array().unwrap() {
        let name = method["name"].as_str().unwrap();
        if method["ran"].as_bool().unwrap() {
            assert!(said(&harness, name) > 0, "{name}");
            let first = method["modes"].as_array().unwrap().iter().find(|m| m["mode"] == 1);
            if let Some(mode) = first {
                let ratio = format::significant(100.0 * number(&mode["damping_ratio"]), 3);
                assert!(said(&harness, &ratio) > 0, "{name} {ratio}");
            }
            ran += 1;
        } else {
            let line = format!("{name}: {}", method["reason"].as_str().unwrap());
            assert!(said(&harness, &line) > 0, "{line}");
            refused += 1;
        }
    }
    assert!(ran >= 3 && refused >= 3, "{ran} ran, {refused} cannot");
}

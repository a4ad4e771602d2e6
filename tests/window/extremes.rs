//! Pictures of what is seldom: one mass, a matrix of thirty, long names, a test on a shaker table, sensors of records over time.

use crate::common::models::chain as chain_of;
use crate::legible::faults;
use crate::records::sample;
use crate::support::{Sample, beam, open, open_sized, settle, write};
use dashpot::effects::{Effect, Place, Source};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::fmt::Write as _;

/// Shows a pane of a stage, sees that it can be read, and pictures it.
fn picture(harness: &mut Harness<'static, App>, stage: Stage, pane: Pane, name: &str) {
    harness.state_mut().view.stage = stage;
    settle(harness);
    harness.state_mut().desk.set_open(stage, pane, true);
    settle(harness);
    harness.remove_cursor();
    settle(harness);
    let title = harness.state().document.as_ref().map(|d| d.project.title.clone()).unwrap_or_default();
    let faults = faults(&harness.output().shapes, |words: &str| words == title);
    assert!(faults.is_empty(), "{name}: {faults:#?}");
    harness.snapshot(name);
}

/// So many masses in a row with known dashpots in the gaps, of which every seventh and the one to the ground are to be found.
fn row(count: usize) -> Sample {
    let [masses, gaps] = [vec![1.0; count], vec![2000.0; count - 1]];
    let mut ground = vec![0.0; count];
    ground[0] = 3000.0;
    let structure = chain_of(&masses, &ground, &gaps);
    let mut head = format!(
        "[project]\nformat = 1\ntitle = \"{count} in a row\"\n[structure]\nkind = \"chain\"\nmasses = {masses:?}\n\
         ground_stiffness = {ground:?}\ncoupling_stiffness = {gaps:?}\n[[source]]\nlaw = \"viscous\"\ndofs = [1]\n\
         state = \"candidate\"\n"
    );
    let mut truth = vec![Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[2.0])];
    for k in 1..count {
        let c = 0.5 + 0.1 * k as f64;
        truth.push(Source::known(Effect::Viscous, Place::Dofs(vec![k - 1, k]), &[c]));
        let known =
            if k % 7 == 0 { "state = \"candidate\"\n".to_string() } else { format!("state = \"known\"\nc = {c}\n") };
        write!(head, "[[source]]\nlaw = \"viscous\"\ndofs = [{k}, {}]\n{known}", k + 1).unwrap();
    }
    write(&head, &structure, &truth, count - 1, &(0..count).collect::<Vec<_>>())
}

#[test]
fn one_mass() {
    let sample = row(1);
    let mut harness = open(&sample, Theme::Light);
    picture(&mut harness, Stage::Result, Pane::Energy, "one-mass");
}

#[test]
fn a_matrix_of_thirty_degrees_of_freedom() {
    let sample = row(30);
    let mut harness = open_sized(&sample, Theme::Dark, [1280.0, 800.0]);
    picture(&mut harness, Stage::Result, Pane::Damping, "thirty-masses-dark");
}

/// Names of one series differ at their ends, which are not cut off.
#[test]
fn long_names() {
    let sample = beam();
    let folder = sample.path.parent().unwrap();
    let mut text = std::fs::read_to_string(&sample.path).unwrap();
    for k in 1..=4 {
        let name = format!("2026-03-17 bracket B12 after retightening of the bolts, sine {k}.csv");
        std::fs::rename(folder.join(format!("run-0{k}.csv")), folder.join(&name)).unwrap();
        text = text.replace(&format!("run-0{k}.csv"), &name);
    }
    let title = "Bracket B12 of the second prototype after retightening of all bolts with the new torque";
    std::fs::write(&sample.path, text.replace("Test beam", title)).unwrap();
    let mut harness = open_sized(&sample, Theme::Light, [1024.0, 700.0]);
    picture(&mut harness, Stage::Measure, Pane::Runs, "long-names");
    assert!(harness.query_all_by_label_contains("sine 3.csv").next().is_some());
}

/// The base moves: no exciter acts on any mass.
#[test]
fn a_structure_on_a_shaker_table() {
    let sample = sample("shaker-table");
    let mut harness = open(&sample, Theme::Light);
    picture(&mut harness, Stage::Measure, Pane::Record, "shaker-table");
    assert_eq!(harness.query_all_by_label_contains(", exciter").count(), 0);
}

/// Records over time have their sensors on the schematic as runs have.
#[test]
fn sensors_of_a_decay() {
    let sample = sample("decay-friction");
    let mut harness = open(&sample, Theme::Light);
    picture(&mut harness, Stage::Measure, Pane::Record, "decay-measure");
    assert!(harness.query_all_by_label_contains("DOF 13, translation z, node 7, measured acc").next().is_some());
    assert_eq!(harness.query_all_by_label_contains(", exciter").count(), 0);
}

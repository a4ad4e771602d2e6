//! The pictures of `docs/first-hour.md`, made by the program on the sample that the page walks through;
//! `UPDATE_SNAPSHOTS=1` makes them anew.

use crate::support::{settle, start};
use dashpot::window::App;
use dashpot::window::app::ask::Ask;
use dashpot::window::app::commands::Command;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};

struct Walk {
    harness: Harness<'static, App>,
    results: SnapshotResults,
}

impl Walk {
    fn picture(&mut self, name: &str) {
        self.harness.remove_cursor();
        settle(&mut self.harness);
        let options =
            SnapshotOptions::new().output_path("docs/pictures/first-hour").threshold(0.6).max_failed_pixels(10);
        self.results.add(self.harness.try_snapshot_options(name, &options));
    }

    fn click(&mut self, role: Role, label: &str) {
        self.harness.get_by_role_and_label(role, label).click();
        settle(&mut self.harness);
    }
}

#[test]
fn every_step_of_the_first_hour() {
    let mut walk = Walk { harness: start(), results: SnapshotResults::new() };
    // The card of the sample stands below the fold of the start screen: its file is opened as a click on it would.
    let ctx = walk.harness.ctx.clone();
    walk.harness.state_mut().open(&ctx, "sample-data/cantilever-friction/project.toml".into());
    settle(&mut walk.harness);
    walk.picture("1-measure");
    walk.click(Role::Tab, "Structure");
    walk.picture("2-structure");
    walk.click(Role::Tab, "Explain");
    walk.harness.get_by_label_contains("Suggestion 1: Coulomb friction at DOF");
    walk.picture("3-missing");
    walk.click(Role::Button, "Try");
    walk.picture("4-try");
    walk.click(Role::Button, "Add");
    walk.harness.get_by_label_contains("The model now explains the data");
    walk.picture("5-explained");
    walk.harness.state_mut().answer(&ctx, Ask::Command(Command::Report));
    walk.harness.run_steps(3);
    for (field, text) in [("Test object", "Cantilever 40 x 4 mm, No. 7"), ("Tested by", "A. Engineer")] {
        walk.click(Role::TextInput, field);
        walk.harness.event(egui::Event::Text(text.to_owned()));
        walk.harness.run_steps(2);
    }
    walk.click(Role::Button, "Cancel");
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report.html");
    walk.harness.state_mut().desk.set_open(Stage::Explain, Pane::Missing, true);
    let document = walk.harness.state().document.as_ref().unwrap();
    let known = dashpot::report::Known {
        outcome: None,
        comparison: walk.harness.state().derived.explained.comparison(document).cloned(),
        diagnosis: walk.harness.state().derived.explained.diagnosis(document).cloned(),
        ledger: Vec::new(),
    };
    let control = dashpot::control::Control::unattended();
    dashpot::report::write(&document.project, known, &dashpot::report::Request::default(), &report, &control).unwrap();
    assert!(std::fs::read_to_string(&report).unwrap().contains("Coulomb friction"));
    // What was added here is not kept beside the sample.
    walk.harness.state().document.as_ref().unwrap().forget().unwrap();
}

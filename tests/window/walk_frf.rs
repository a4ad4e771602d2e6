//! The pictures of `docs/walk-frf.md`: from a Universal File of responses and a NASTRAN model to the map of damping, in the
//! window, with nothing typed. `UPDATE_SNAPSHOTS=1` makes them anew.

use crate::importing::{press, shown, target_named};
use crate::support::{drop_files, settle, start};
use dashpot::window::App;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use std::path::Path;

struct Walk {
    harness: Harness<'static, App>,
    results: SnapshotResults,
}

impl Walk {
    fn picture(&mut self, name: &str) {
        self.harness.remove_cursor();
        settle(&mut self.harness);
        // It names the folder of the test, another one every time.
        self.harness.state_mut().messages.clear();
        self.harness.run_steps(2);
        let options = SnapshotOptions::new().output_path("docs/pictures/walk-frf").threshold(0.6).max_failed_pixels(10);
        self.results.add(self.harness.try_snapshot_options(name, &options));
    }

    fn stage(&mut self, name: &str) {
        self.harness.get_by_role_and_label(Role::Tab, name).click();
        settle(&mut self.harness);
    }
}

#[test]
fn every_step_from_two_files_to_the_map_of_damping() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["hammer.uff", "model.bdf"].map(|name| folder.path().join(name));
    for file in &files {
        let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/hammer-frf");
        std::fs::copy(sample.join(file.file_name().unwrap()), file).unwrap();
    }
    let mut walk = Walk { harness: start(), results: SnapshotResults::new() };
    drop_files(&mut walk.harness, &files);
    shown(&mut walk.harness);
    let target = target_named(&mut walk.harness, "measurements/hammer.toml".to_owned());
    walk.picture("1-files");
    target_named(&mut walk.harness, target);
    press(&mut walk.harness, "Make the project");
    walk.picture("2-responses");
    walk.stage("Structure");
    walk.picture("3-model");
    walk.stage("Select");
    walk.picture("4-select");
    walk.stage("Result");
    walk.picture("5-result");
    let document = walk.harness.state().document.as_ref().unwrap();
    let found = dashpot::identify::identify(
        &document.project.structure,
        &document.project.sources,
        &document.project.runs,
        &document.project.settings,
        &dashpot::control::Control::unattended(),
    )
    .unwrap();
    let accepted: Vec<f64> = found.sources.iter().map(|e| e.coefficient).filter(|c| *c > 0.0).collect();
    assert_eq!(accepted.len(), 2, "{accepted:?}");
    assert!((accepted[0] - 0.5).abs() < 0.01 && (accepted[1] - 0.2).abs() < 0.01, "{accepted:?}");
}

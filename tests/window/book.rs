//! The pictures of the pages of `docs/stages`, made by the program on a sample; `UPDATE_SNAPSHOTS=1` makes them anew.

use crate::support::{settle, start_sized};
use dashpot::window::app::view::Stage;
use egui_kittest::kittest::Queryable;
use egui_kittest::{SnapshotOptions, SnapshotResults};

#[test]
fn pictures_of_the_stages() {
    let mut harness = start_sized([1280.0, 800.0]);
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, "sample-data/cantilever-case-1/project.toml".into());
    settle(&mut harness);
    let mut results = SnapshotResults::new();
    for stage in Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain) {
        harness.get_by_role_and_label(egui::accesskit::Role::Tab, stage.label()).click();
        settle(&mut harness);
        harness.remove_cursor();
        settle(&mut harness);
        let options = SnapshotOptions::new().output_path("docs/pictures/stages").threshold(0.6).max_failed_pixels(10);
        results.add(harness.try_snapshot_options(stage.label().to_lowercase(), &options));
    }
}

//! Every stage at the smallest size of the window, at that of a small laptop and with large words: nothing is cut off,
//! nothing overlaps.

use crate::friction::friction;
use crate::legible::faults;
use crate::support::{Sample, beam, chain, open_sized, settle};
use dashpot::window::frame::panes::Pane;
use dashpot::window::view::Stage;
use egui::Theme;
use egui_kittest::SnapshotResults;

/// The smallest window.
const SMALLEST: [f32; 2] = [1024.0, 700.0];
/// A small laptop.
const LAPTOP: [f32; 2] = [1280.0, 800.0];
/// A screen of 1600 by 1080 pixels with words of 150 %.
const LARGE_WORDS: [f32; 2] = [1066.0, 720.0];

/// Every pane of `stages` at a size is legible; a picture of each stage is taken where it is asked for.
fn look(sample: &Sample, stages: &[Stage], size: [f32; 2], taken: bool) -> SnapshotResults {
    let mut harness = open_sized(sample, Theme::Light, size);
    let mut results = SnapshotResults::new();
    let mut found = Vec::new();
    for &stage in stages {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        harness.remove_cursor();
        settle(&mut harness);
        if taken {
            results.add(harness.try_snapshot(format!("{}-{}", stage.label().to_lowercase(), size[0])));
        }
        let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
        for pane in panes {
            harness.state_mut().desk.set_open(stage, pane, true);
            settle(&mut harness);
            let faults = faults(&harness.output().shapes);
            found.extend(faults.into_iter().map(|f| format!("{stage:?}, {pane:?}: {f}")));
        }
    }
    found.sort();
    found.dedup();
    assert!(found.is_empty(), "{size:?}: {found:#?}");
    results
}

fn stages() -> Vec<Stage> {
    Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain).collect()
}

#[test]
fn stages_at_1024_by_700() {
    drop(look(&beam(), &stages(), SMALLEST, true));
    drop(look(&chain(), &stages(), SMALLEST, false));
}

#[test]
fn stages_at_1280_by_800() {
    drop(look(&beam(), &stages(), LAPTOP, true));
}

#[test]
fn stages_with_large_words() {
    drop(look(&beam(), &stages(), LARGE_WORDS, false));
}

#[test]
fn stages_at_the_size_of_the_other_pictures() {
    drop(look(&beam(), &stages(), [1440.0, 900.0], false));
    drop(look(&chain(), &stages(), [1440.0, 900.0], false));
}

#[test]
fn explain_at_1024_by_700_and_1280_by_800() {
    let sample = friction();
    for size in [SMALLEST, LAPTOP] {
        drop(look(&sample, &[Stage::Explain], size, true));
    }
}

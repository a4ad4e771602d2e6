//! Every stage at the smallest size of the window, at that of a small laptop and with large words: nothing is cut off,
//! nothing overlaps.

use crate::friction::friction;
use crate::legible::faults;
use crate::support::{Sample, beam, chain, open_sized, settle};
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::SnapshotResults;
use egui_kittest::kittest::Queryable;

/// The smallest window.
const SMALLEST: [f32; 2] = [1024.0, 700.0];
/// A small laptop.
const LAPTOP: [f32; 2] = [1280.0, 800.0];
/// A screen of 1600 by 1080 pixels with words of 150 %.
const LARGE_WORDS: [f32; 2] = [1066.0, 720.0];
/// A large screen.
const LARGE: [f32; 2] = [1920.0, 1080.0];
/// A screen of 1920 by 1080 pixels with words of 200 % and of 80 %.
const LARGEST_WORDS: [f32; 2] = [960.0, 540.0];
const SMALLEST_WORDS: [f32; 2] = [2400.0, 1350.0];

/// Pictures of `stages` at a size.
fn pictures(sample: &Sample, stages: &[Stage], size: [f32; 2]) -> SnapshotResults {
    let mut harness = open_sized(sample, Theme::Light, size);
    let mut results = SnapshotResults::new();
    for &stage in stages {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        harness.remove_cursor();
        settle(&mut harness);
        results.add(harness.try_snapshot(format!("{}-{}", stage.label().to_lowercase(), size[0])));
    }
    results
}

/// In every pane of `stages` at a size no words are cut off or lie on others.
fn legible(sample: &Sample, stages: &[Stage], size: [f32; 2]) {
    let mut harness = open_sized(sample, Theme::Light, size);
    let mut found = Vec::new();
    for &stage in stages {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        harness.remove_cursor();
        let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
        for pane in panes {
            harness.state_mut().desk.set_open(stage, pane, true);
            settle(&mut harness);
            // The title of the project stands in a field with a cursor.
            let title = harness.state().document.as_ref().map(|d| d.project.title.clone()).unwrap_or_default();
            let scrolls = |words: &str| words == title;
            let faults = faults(&harness.output().shapes, scrolls);
            found.extend(faults.into_iter().map(|f| format!("{stage:?}, {pane:?}: {f}")));
        }
    }
    found.sort();
    found.dedup();
    assert!(found.is_empty(), "{size:?}: {found:#?}");
}

fn stages() -> Vec<Stage> {
    Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain).collect()
}

#[test]
fn pictures_at_1024_by_700() {
    drop(pictures(&beam(), &stages(), SMALLEST));
}

#[test]
fn pictures_at_1280_by_800() {
    drop(pictures(&beam(), &stages(), LAPTOP));
}

#[test]
fn pictures_of_explain_at_1024_by_700() {
    drop(pictures(&friction(), &[Stage::Explain], SMALLEST));
}

#[test]
fn pictures_of_explain_at_1280_by_800() {
    drop(pictures(&friction(), &[Stage::Explain], LAPTOP));
}

/// The stages with most in them; at 200 % they are as large as the pictures are small.
#[test]
fn pictures_with_words_of_200_per_cent() {
    let mut results = pictures(&beam(), &[Stage::Select, Stage::Result], LARGEST_WORDS);
    results.extend(pictures(&friction(), &[Stage::Explain], LARGEST_WORDS));
}

#[test]
fn pictures_with_words_of_150_per_cent() {
    let mut results = pictures(&beam(), &[Stage::Result], LARGE_WORDS);
    results.extend(pictures(&friction(), &[Stage::Explain], LARGE_WORDS));
}

#[test]
fn pictures_with_words_of_80_per_cent() {
    let mut results = pictures(&beam(), &[Stage::Result], SMALLEST_WORDS);
    results.extend(pictures(&friction(), &[Stage::Explain], SMALLEST_WORDS));
}

#[test]
fn legible_on_a_large_screen() {
    legible(&beam(), &stages(), LARGE);
    legible(&friction(), &[Stage::Explain], LARGE);
}

#[test]
fn legible_when_small() {
    legible(&chain(), &stages(), SMALLEST);
    legible(&friction(), &[Stage::Explain], SMALLEST);
}

#[test]
fn legible_with_words_of_200_per_cent() {
    legible(&beam(), &stages(), LARGEST_WORDS);
    legible(&friction(), &[Stage::Explain], LARGEST_WORDS);
}

#[test]
#[ignore = "three minutes: every stage of every structure at every size; the three above are the extremes"]
fn legible_at_every_size() {
    for size in [SMALLEST, LAPTOP, [1440.0, 900.0], LARGE, LARGE_WORDS, LARGEST_WORDS, SMALLEST_WORDS] {
        legible(&beam(), &stages(), size);
        legible(&chain(), &stages(), size);
        legible(&friction(), &[Stage::Explain], size);
    }
}

/// A tab that has no room stands in a list, and comes to the front from there.
#[test]
fn tabs_without_room_are_in_a_list() {
    let sample = beam();
    let mut harness = open_sized(&sample, Theme::Light, SMALLEST);
    harness.state_mut().view.stage = Stage::Result;
    settle(&mut harness);
    assert!(harness.query_by_role_and_label(Role::Tab, "Change").is_none());
    harness.get_by_label_contains(" more").click();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Change").click();
    settle(&mut harness);
    harness.get_by_label_contains("What changed?");
    assert!(harness.query_by_role_and_label(Role::Tab, "Change").is_some(), "the chosen tab has room");
}

//! German: every stage and pane has no English left, can be read, and goes back to English without loss; the numbers have a comma
//! on the screen and a point in files.

use crate::friction::friction;
use crate::legible::faults;
use crate::support::{Sample, beam, chain, detuned, open, open_sized, settle, start_sized};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use dashpot::window::language::{self, Language};
use egui::Theme;
use egui::accesskit::Role;
use egui::epaint::Shape;
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotResults};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;

const SMALLEST: [f32; 2] = [1024.0, 700.0];
const LAPTOP: [f32; 2] = [1280.0, 800.0];

/// A window in German.
fn german(sample: &Sample, size: [f32; 2]) -> Harness<'static, App> {
    language::choose(Language::German);
    open_sized(sample, Theme::Light, size)
}

fn collect(shape: &Shape, all: &mut BTreeSet<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, all)),
        Shape::Text(text) => drop(all.insert(text.galley.text().to_owned())),
        _ => {}
    }
}

/// All that is written on the screen.
fn written(harness: &Harness<'_, App>) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    harness.output().shapes.iter().for_each(|s| collect(&s.shape, &mut all));
    all
}

/// The catalogue, English and German.
fn pairs() -> Vec<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/locales/de.toml");
    let parts: BTreeMap<String, BTreeMap<String, String>> =
        toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    parts.into_values().flatten().collect()
}

fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(|c: char| !c.is_alphabetic()).filter(|w| w.chars().count() > 2).map(str::to_lowercase)
}

/// Words that stand in the English of the catalogue and nowhere in the German.
fn english_words() -> HashSet<String> {
    let pairs = pairs();
    let german: HashSet<String> = pairs.iter().flat_map(|(_, german)| words(german).collect::<Vec<_>>()).collect();
    pairs.iter().flat_map(|(english, _)| words(english).collect::<Vec<_>>()).filter(|w| !german.contains(w)).collect()
}

/// Words in the names of files and channels.
const NAMES: [&str; 3] = ["run", "csv", "toml"];

/// What is written in English in any pane of `stages`.
fn left(sample: &Sample, stages: &[Stage]) -> BTreeSet<String> {
    let english = english_words();
    let mut harness = german(sample, [1440.0, 900.0]);
    let mut found = BTreeSet::new();
    for &stage in stages {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
        for pane in panes {
            harness.state_mut().desk.set_open(stage, pane, true);
            settle(&mut harness);
            let title = harness.state().document.as_ref().map(|d| d.project.title.clone()).unwrap_or_default();
            // Names of channels and the title of the project are the user's.
            let name = |w: &str| w.contains('@') || NAMES.iter().any(|n| w.contains(n));
            let own = |text: &String| {
                let said = text.replace(&title, "");
                let mut words = said.split_whitespace().filter(|w| !name(w)).flat_map(|w| words(w).collect::<Vec<_>>());
                words.any(|w| english.contains(&w))
            };
            found.extend(written(&harness).into_iter().filter(own).map(|text| format!("{stage:?}, {pane:?}: {text}")));
        }
    }
    found
}

#[test]
fn no_english_is_left_between_german_words() {
    let energy: Vec<Stage> = Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain).collect();
    let mut found = left(&beam(), &energy);
    found.extend(left(&chain(), &energy));
    found.extend(left(&friction(), &[Stage::Explain]));
    found.extend(left(&detuned(), &[Stage::Explain]));
    assert!(found.is_empty(), "{found:#?}");
}

/// Pictures of `stages` at a size.
fn pictures(sample: &Sample, stages: &[Stage], size: [f32; 2]) -> SnapshotResults {
    let mut harness = german(sample, size);
    let mut results = SnapshotResults::new();
    for &stage in stages {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        harness.remove_cursor();
        settle(&mut harness);
        results.add(harness.try_snapshot(format!("german-{}-{}", stage.label().to_lowercase(), size[0])));
    }
    results
}

fn stages() -> Vec<Stage> {
    Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain).collect()
}

#[test]
fn german_pictures_at_1024_by_700() {
    drop(pictures(&beam(), &stages(), SMALLEST));
}

#[test]
fn german_pictures_at_1280_by_800() {
    drop(pictures(&beam(), &stages(), LAPTOP));
}

#[test]
fn german_pictures_of_explain() {
    let mut results = pictures(&friction(), &[Stage::Explain], SMALLEST);
    results.extend(pictures(&friction(), &[Stage::Explain], LAPTOP));
}

/// German words are longer: nothing is cut off, nothing lies on other words.
#[test]
fn german_is_legible_when_small() {
    let mut found = Vec::new();
    for (sample, stages) in [(beam(), stages()), (chain(), stages()), (friction(), vec![Stage::Explain])] {
        let mut harness = german(&sample, SMALLEST);
        let title = harness.state().document.as_ref().map(|d| d.project.title.clone()).unwrap_or_default();
        for stage in stages {
            harness.state_mut().view.stage = stage;
            settle(&mut harness);
            harness.remove_cursor();
            let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
            for pane in panes {
                harness.state_mut().desk.set_open(stage, pane, true);
                settle(&mut harness);
                let faults = faults(&harness.output().shapes, |words| words == title);
                found.extend(faults.into_iter().map(|f| format!("{stage:?}, {pane:?}: {f}")));
            }
        }
    }
    found.sort();
    found.dedup();
    assert!(found.is_empty(), "{found:#?}");
}

/// The entries of a menu of the bar, one below the other.
fn choose_in_menu(harness: &mut Harness<'_, App>, entries: [&str; 3]) {
    for (k, entry) in entries.into_iter().enumerate() {
        if k < 2 {
            harness.get_by_role_and_label(Role::Button, entry).click();
        } else {
            harness.get_by_label(entry).click();
        }
        harness.run_steps(3);
    }
    harness.key_press(egui::Key::Escape);
    harness.key_press(egui::Key::Escape);
    harness.remove_cursor();
    settle(harness);
}

#[test]
fn there_and_back_without_loss() {
    let sample = beam();
    let before = std::fs::read_to_string(&sample.path).unwrap();
    let mut harness = open(&sample, Theme::Light);
    harness.remove_cursor();
    settle(&mut harness);
    let english = written(&harness);
    assert_eq!(language::now(), Language::English, "headless windows are in English");
    choose_in_menu(&mut harness, ["View", "Language", "Deutsch"]);
    assert_eq!(language::now(), Language::German);
    let german = written(&harness);
    assert!(german.contains("Datei") && german.contains("Messung"), "{german:#?}");
    // Names of files stay, numbers have a comma.
    assert!(german.contains("run-01.csv"));
    assert!(german.iter().any(|t| t.contains(',') && t.ends_with("Hz")), "{german:#?}");
    choose_in_menu(&mut harness, ["Ansicht", "Sprache (Language)", "English"]);
    assert_eq!(written(&harness), english);
    assert!(!harness.state().document.as_ref().unwrap().session().is_dirty());
    assert_eq!(std::fs::read_to_string(&sample.path).unwrap(), before);
}

#[test]
fn numbers_are_typed_with_a_comma_and_saved_with_a_point() {
    let sample = beam();
    let mut harness = german(&sample, [1440.0, 900.0]);
    harness.state_mut().view.stage = Stage::Structure;
    harness.state_mut().desk.set_open(Stage::Structure, Pane::Parameters, true);
    settle(&mut harness);
    for (typed, saved) in [("0,55", "length = 0.55"), ("0.6", "length = 0.6")] {
        let field = harness.get_by_role_and_label(Role::SpinButton, "Länge");
        field.click();
        harness.run_steps(2);
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run_steps(2);
        harness.key_press(egui::Key::Enter);
        settle(&mut harness);
        let text = harness.state().document.as_ref().unwrap().session().document().file().to_toml().unwrap();
        assert!(text.contains(saved), "{typed}: {text}");
    }
}

#[test]
fn copied_tables_keep_the_point() {
    let mut harness = german(&beam(), [1440.0, 900.0]);
    harness.state_mut().view.stage = Stage::Result;
    harness.state_mut().desk.set_open(Stage::Result, Pane::Values, true);
    settle(&mut harness);
    harness.get_by_label("Tabelle kopieren").click();
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|c| match c {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.unwrap();
    assert!(copied.starts_with("law\tplace\tstate\tcoefficient"), "{copied}");
    assert!(copied.contains('.') && !copied.lines().skip(1).any(|line| line.contains(',')), "{copied}");
}

#[test]
fn the_start_screen_is_german() {
    language::choose(Language::German);
    let harness = start_sized(LAPTOP);
    let english = english_words();
    let left: Vec<String> = written(&harness).into_iter().filter(|t| words(t).any(|w| english.contains(&w))).collect();
    assert!(left.is_empty(), "{left:#?}");
}

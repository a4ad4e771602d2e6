//! The keyboard alone: Tab reaches every control, one sees where it is, the space bar and Enter click it.

use crate::friction::friction;
use crate::names::CONTROLS;
use crate::support::{Sample, beam, open, settle, start};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use egui::accesskit::Role;
use egui::{Key, Rect, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::collections::BTreeSet;

/// More presses than any stage has controls.
const MOST: usize = 400;

/// A control by what is known of it.
type Control = (String, String);

/// Role and name of every control that can be used, and where each is.
fn controls(harness: &Harness<'_, App>) -> Vec<(Control, Rect, bool)> {
    let all = harness.root().children_recursive();
    let known = all.filter_map(|node| {
        let access = node.accesskit_node();
        let named = (format!("{:?}", access.role()), access.label().or_else(|| access.value()).unwrap_or_default());
        let usable = CONTROLS.contains(&access.role()) && !access.is_disabled();
        usable.then(|| (named, node.rect(), access.is_focused()))
    });
    known.collect()
}

/// What is drawn over and beside a place.
fn drawn(harness: &Harness<'_, App>, rect: Rect) -> Vec<String> {
    let near = |s: &&egui::epaint::ClippedShape| s.shape.visual_bounding_rect().intersects(rect.expand(3.0));
    harness.output().shapes.iter().filter(near).map(|s| format!("{:?}", s.shape)).collect()
}

/// Presses Tab until the focus is where it began; what had it, and what showed nothing of it.
fn walk(harness: &mut Harness<'_, App>) -> (BTreeSet<Control>, Vec<Control>) {
    let (mut reached, mut unseen) = (BTreeSet::new(), Vec::new());
    let mut last: Option<(Control, Rect, Vec<String>)> = None;
    for _ in 0..MOST {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        if let Some((control, rect, with)) = last.take()
            && drawn(harness, rect) == with
        {
            unseen.push(control);
        }
        let Some((control, rect, _)) = controls(harness).into_iter().find(|(_, _, focused)| *focused) else { continue };
        reached.insert(control.clone());
        let with = drawn(harness, rect);
        last = Some((control, rect, with));
    }
    (reached, unseen)
}

fn everything_is_reached(harness: &mut Harness<'_, App>, place: &str) {
    harness.remove_cursor();
    harness.run_steps(3);
    let all: BTreeSet<Control> = controls(harness).into_iter().map(|(control, _, _)| control).collect();
    assert!(all.len() > 6, "{place}: {all:?}");
    let (reached, unseen) = walk(harness);
    let missed: Vec<&Control> = all.difference(&reached).collect();
    assert!(missed.is_empty(), "{place}: not reached {missed:#?}");
    assert!(unseen.is_empty(), "{place}: the focus is not seen on {unseen:#?}");
}

#[test]
fn the_start_screen_by_keyboard() {
    everything_is_reached(&mut start(), "start screen");
}

fn stage(sample: &Sample, stage: Stage) {
    let mut harness = open(sample, Theme::Light);
    harness.state_mut().view.stage = stage;
    settle(&mut harness);
    everything_is_reached(&mut harness, stage.label());
}

#[test]
fn measure_and_structure_by_keyboard() {
    stage(&beam(), Stage::Measure);
    stage(&beam(), Stage::Structure);
}

#[test]
fn pattern_and_select_by_keyboard() {
    stage(&beam(), Stage::Pattern);
    stage(&beam(), Stage::Select);
}

#[test]
fn result_by_keyboard() {
    stage(&beam(), Stage::Result);
}

#[test]
fn explain_by_keyboard() {
    stage(&friction(), Stage::Explain);
}

/// The way to a suggestion and into the project without a pointer.
#[test]
fn an_effect_is_added_without_a_pointer() {
    let sample = friction();
    let mut harness = open(&sample, Theme::Light);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num6);
    settle(&mut harness);
    for _ in 0..MOST {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        let at_add = harness.get_by_role_and_label(Role::Button, "Add").accesskit_node().is_focused();
        if at_add {
            break;
        }
    }
    harness.key_press(Key::Space);
    settle(&mut harness);
    assert!(!harness.state().view.animate, "the space bar clicks what has the focus");
    harness.get_by_label_contains("The model now explains the data");
}

/// From the focus of a key to an entry of a menu and of a menu within; what the arrows do elsewhere they do not do meanwhile.
#[test]
fn the_menus_without_a_pointer() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    settle(&mut harness);
    harness.remove_cursor();
    let press = |harness: &mut Harness<'_, App>, keys: &[Key]| {
        for key in keys {
            harness.key_press(*key);
            harness.run_steps(3);
        }
    };
    press(&mut harness, &[Key::F10]);
    assert!(harness.get_by_role_and_label(Role::Button, "File").accesskit_node().is_focused());
    press(&mut harness, &[Key::ArrowRight, Key::ArrowRight]);
    assert!(harness.get_by_role_and_label(Role::Button, "View").accesskit_node().is_focused());
    press(&mut harness, &[Key::Enter]);
    assert!(harness.query_by_label_contains("Reset layout").is_some(), "the menu is open");
    let run = harness.state().view.run;
    press(&mut harness, &[Key::ArrowDown, Key::ArrowDown, Key::ArrowDown]);
    assert_eq!(harness.state().view.run, run, "arrows walk through the menu and choose no run");
    press(&mut harness, &[Key::Enter]);
    assert_eq!(harness.state().view.stage, Stage::Pattern);
    assert!(harness.query_by_label_contains("Reset layout").is_none(), "the menu is closed");
    // A menu within it, upwards from the last entry.
    press(&mut harness, &[Key::F10, Key::ArrowRight, Key::ArrowRight, Key::Enter]);
    for _ in 0..MOST {
        press(&mut harness, &[Key::ArrowDown]);
        if harness.get_by_label_contains("Text size").accesskit_node().is_focused() {
            break;
        }
    }
    press(&mut harness, &[Key::ArrowRight]);
    assert!(harness.query_by_label("80 %").is_some(), "the menu within is open");
    press(&mut harness, &[Key::ArrowDown, Key::Enter]);
    assert!((harness.ctx.zoom_factor() - 0.9).abs() < 1e-6, "{}", harness.ctx.zoom_factor());
    press(&mut harness, &[Key::F10, Key::Enter]);
    assert!(harness.query_by_label_contains("Open recent").is_some());
    press(&mut harness, &[Key::Escape]);
    assert!(harness.query_by_label_contains("Open recent").is_none(), "Escape closes");
}

//! Heat map, spectrogram and error map: a box is zoomed into, back and all again; two cursors and their difference.

use crate::records::sample;
use crate::support::{Sample, beam, detuned, open, settle};
use crate::zoom::{copied, press, zoom};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::stages::explain::look::RecordTab;
use egui::accesskit::Role;
use egui::epaint::Shape;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Theme, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

/// All that is written in an area.
fn written(harness: &Harness<'_, App>, area: Rect) -> Vec<String> {
    fn collect(shape: &Shape, area: Rect, all: &mut Vec<String>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, area, all)),
            Shape::Text(text) if area.contains(text.pos) => all.push(text.galley.text().to_owned()),
            _ => {}
        }
    }
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| collect(&s.shape, area, &mut all));
    all
}

/// Clicks with Shift.
fn mark(harness: &mut Harness<'_, App>, pos: Pos2) {
    harness.event(Event::PointerMoved(pos));
    harness.run_steps(1);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::SHIFT);
        harness.event_modifiers(Event::PointerButton { pos, button, pressed, modifiers }, modifiers);
        harness.run_steps(1);
    }
    harness.run_steps(2);
}

fn said(harness: &Harness<'_, App>, area: Rect, begin: &str) -> String {
    written(harness, area).into_iter().find(|text| text.starts_with(begin)).unwrap_or_default()
}

fn image(harness: &Harness<'_, App>, name: &str) -> Rect {
    let images = harness.root().children_recursive();
    let named = |n: &egui_kittest::Node<'_>| {
        let access = n.accesskit_node();
        access.role() == Role::Image && access.label().is_some_and(|label| label.starts_with(name))
    };
    images.filter(named).map(|n| n.rect()).next().unwrap()
}

fn stage(sample: &Sample, stage: Stage) -> Harness<'static, App> {
    let mut harness = open(sample, Theme::Light);
    // Comparison and plots do not wait for the search.
    harness.state_mut().view.limit_s = Some(1e-3);
    harness.state_mut().view.stage = stage;
    settle(&mut harness);
    harness
}

/// The matrix of two dashpots: the second cell alone, and both compared.
#[test]
fn a_heat_map_is_zoomed_and_read() {
    let sample = beam();
    let mut harness = stage(&sample, Stage::Result);
    let area = image(&harness, "Matrix");
    let number = |harness: &Harness<'_, App>| written(harness, area).iter().filter(|t| *t == "0.300").count();
    assert_eq!(number(&harness), 1);
    let place = |name: &str| {
        let pos = |shape: &Shape| match shape {
            Shape::Text(text) if text.galley.text() == name && area.contains(text.pos) => Some(text.pos),
            _ => None,
        };
        let all: Vec<Shape> = harness.output().shapes.iter().map(|s| s.shape.clone()).collect();
        all.iter().find_map(|shape| match shape {
            Shape::Vec(shapes) => shapes.iter().find_map(pos),
            other => pos(other),
        })
    };
    let second = place("0.800").unwrap() + vec2(10.0, 5.0);
    let first = place("0.300").unwrap() + vec2(10.0, 5.0);
    mark(&mut harness, first);
    mark(&mut harness, second);
    assert!(said(&harness, area, "1:").starts_with("1:  Column 3   Row 3   0.3000"), "{:?}", written(&harness, area));
    assert!(said(&harness, area, "Δ:").starts_with("Δ:  0.5000"), "{:?}", written(&harness, area));
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("heat-map-cursors");
    mark(&mut harness, second);
    assert_eq!(said(&harness, area, "Δ:"), "", "the third takes them away");
    zoom(&mut harness, second - vec2(12.0, 12.0), second + vec2(12.0, 12.0));
    assert_eq!(number(&harness), 0, "{:?}", written(&harness, area));
    press(&mut harness, Key::Backspace, Modifiers::NONE);
    assert_eq!(number(&harness), 1);
}

#[test]
fn a_spectrogram_is_zoomed_and_read() {
    let sample = sample("sweep-cubic");
    let mut harness = stage(&sample, Stage::Explain);
    harness.get_by_role_and_label(Role::Button, RecordTab::Spectrogram.label()).click();
    settle(&mut harness);
    let area = image(&harness, "Spectrogram");
    let whole = written(&harness, area);
    zoom(&mut harness, area.center(), area.center() + vec2(90.0, 40.0));
    let part = written(&harness, area);
    assert_ne!(whole, part);
    mark(&mut harness, area.center() - vec2(60.0, 20.0));
    mark(&mut harness, area.center() + vec2(40.0, 20.0));
    let difference = said(&harness, area, "Δ:");
    assert!(difference.contains(" s ") && difference.contains(" Hz ") && difference.ends_with(" dB"), "{difference}");
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("spectrogram-zoomed");
    let full = copied(&mut harness);
    assert!(full.is_none(), "nothing is under the pointer");
    mark(&mut harness, area.center());
    assert_eq!(said(&harness, area, "Δ:"), "", "the third takes them away");
    press(&mut harness, Key::Backspace, Modifiers::NONE);
    harness.remove_cursor();
    harness.run_steps(3);
    let labels = |texts: &[String]| texts.iter().filter(|t| t.parse::<f64>().is_ok()).cloned().collect::<Vec<_>>();
    assert_eq!(labels(&written(&harness, area)), labels(&whole));
}

#[test]
fn the_error_map_is_zoomed_and_read() {
    let sample = detuned();
    let mut harness = stage(&sample, Stage::Explain);
    harness.remove_cursor();
    harness.run_steps(2);
    let cells = |harness: &Harness<'_, App>| harness.query_all_by_label_contains(": error ").count();
    let all = cells(&harness);
    assert_eq!(all, 12, "four runs, three channels");
    let area = image(&harness, "Error map");
    let cell = |harness: &Harness<'_, App>, words: &str| {
        harness.get_all_by_label_contains(words).next().unwrap().rect().center()
    };
    let (one, other) = (cell(&harness, "Run 2, "), cell(&harness, "Run 4, "));
    let selected = harness.state().view.run;
    mark(&mut harness, one);
    mark(&mut harness, other);
    assert_eq!(harness.state().view.run, selected, "with Shift no cell is chosen");
    // What is read stands beside the map: no cell is covered.
    let around = Rect::from_min_max(area.right_top(), area.right_bottom() + vec2(300.0, 0.0));
    assert!(said(&harness, around, "1:").starts_with("1:  Run 2   acc@"), "{:?}", written(&harness, around));
    assert!(said(&harness, around, "Δ:").ends_with(" %"), "{:?}", written(&harness, around));
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("error-map-cursors");
    let between = Rect::from_two_pos(one, other);
    zoom(&mut harness, between.min - vec2(6.0, 2.0), between.max + vec2(6.0, 2.0));
    let part = cells(&harness);
    assert!(part < all && part > 0, "{part} of {all}");
    let text = copied(&mut harness).expect("the map under the pointer is copied");
    assert!(text.starts_with("channel\trun "), "{text}");
    press(&mut harness, Key::Backspace, Modifiers::NONE);
    harness.remove_cursor();
    harness.run_steps(2);
    assert_eq!(cells(&harness), all);
}

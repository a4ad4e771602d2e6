//! What is in sight of a plot: zoomed, back, on again, typed; and its values copied with one key.

use crate::support::{beam, open, settle};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, OutputCommand, PointerButton, Pos2, Theme, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// Middle of the plot of frequencies at the stage Structure, 1440 by 900.
const MIDDLE: Pos2 = pos2(800.0, 640.0);

fn structure() -> (crate::support::Sample, Harness<'static, App>) {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Structure;
    settle(&mut harness);
    (sample, harness)
}

pub(crate) fn press(harness: &mut Harness<'_, App>, key: Key, modifiers: Modifiers) {
    harness.event(Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers });
    harness.run_steps(3);
}

/// Drags with the right button: zooms into a box.
pub(crate) fn zoom(harness: &mut Harness<'_, App>, from: Pos2, to: Pos2) {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(from));
    harness.run_steps(1);
    harness.event(button(from, true));
    harness.run_steps(1);
    // The box begins where the pointer is once it is known that it drags.
    for share in [0.1, 0.5, 1.0] {
        harness.event(Event::PointerMoved(from + share * (to - from)));
        harness.run_steps(1);
    }
    harness.event(button(to, false));
    harness.run_steps(3);
}

/// What the table of the plot under the pointer holds: only what is in sight is copied of a function, all of points.
pub(crate) fn copied(harness: &mut Harness<'_, App>) -> Option<String> {
    harness.event(Event::Copy);
    harness.step();
    harness.output().platform_output.commands.iter().find_map(|c| match c {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

/// The last label of the axis of x that is drawn: tells how far the plot reaches.
fn labels(harness: &Harness<'_, App>) -> Vec<String> {
    fn collect(shape: &egui::Shape, all: &mut Vec<String>) {
        match shape {
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, all)),
            egui::Shape::Text(text) if text.pos.y > 780.0 && text.pos.y < 850.0 => {
                all.push(text.galley.text().to_owned());
            }
            _ => {}
        }
    }
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| collect(&s.shape, &mut all));
    all.retain(|text| text.parse::<f64>().is_ok());
    all
}

#[test]
fn a_zoom_goes_back_and_on_by_keys() {
    let (_sample, mut harness) = structure();
    let full = labels(&harness);
    assert!(full.len() > 2, "{full:?}");
    zoom(&mut harness, MIDDLE, MIDDLE + egui::vec2(120.0, 60.0));
    let part = labels(&harness);
    assert_ne!(full, part);
    press(&mut harness, Key::Backspace, Modifiers::NONE);
    assert_eq!(labels(&harness), full);
    press(&mut harness, Key::Backspace, Modifiers::SHIFT);
    assert_eq!(labels(&harness), part);
}

#[test]
fn limits_are_typed() {
    let (_sample, mut harness) = structure();
    harness.event(Event::PointerMoved(MIDDLE));
    harness.run_steps(1);
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos: MIDDLE,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.run_steps(2);
    }
    harness.get_by_label_contains("Axis limits").click();
    harness.run_steps(3);
    let field = harness.get_by_role_and_label(Role::SpinButton, "Frequency, to");
    field.click();
    harness.run_steps(3);
    press(&mut harness, Key::A, Modifiers::COMMAND);
    harness.event(Event::Text("50".to_owned()));
    harness.run_steps(2);
    press(&mut harness, Key::Enter, Modifiers::NONE);
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::Button, "Close").click();
    harness.run_steps(3);
    let ends: Vec<f64> = labels(&harness).iter().map(|l| l.parse().unwrap()).collect();
    assert!(ends.iter().all(|v| *v <= 50.0) && ends.iter().any(|v| *v > 20.0), "{ends:?}");
}

#[test]
fn one_key_copies_the_plot_or_the_table_under_the_pointer() {
    let (_sample, mut harness) = structure();
    harness.event(Event::PointerMoved(MIDDLE));
    harness.run_steps(2);
    let text = copied(&mut harness).expect("the plot is copied");
    assert!(text.contains("Frequency (Hz)"), "{text}");
    harness.event(Event::PointerMoved(pos2(200.0, 600.0)));
    harness.run_steps(2);
    let text = copied(&mut harness).expect("the table is copied");
    assert!(text.starts_with("mode\tfrequency (Hz)\n1\t1.306"), "{text}");
}

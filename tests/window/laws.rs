//! The page of laws: every law on a small structure.

use crate::support::{beam, open, settle, start};
use dashpot::effects::Effect;
use dashpot::window::App;
use dashpot::window::learn::lesson::{Lesson, System};
use egui::{Key, Modifiers, Theme, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn picture(harness: &mut Harness<'_, App>, name: &str) {
    harness.remove_cursor();
    settle(harness);
    harness.snapshot(name);
}

#[test]
fn laws_are_learnt_before_a_project_is_open() {
    let mut harness = start();
    harness.get_by_role_and_label(Role::Button, "Laws of damping").click();
    settle(&mut harness);
    harness.get_by_label("grows with the amplitude to the power 2.00");
    picture(&mut harness, "laws");
    harness.state_mut().learn.lesson = Lesson::new(System::OneMass, Effect::Coulomb);
    settle(&mut harness);
    harness.get_by_label("grows with the amplitude to the power 1.00");
    harness.get_by_role_and_label(Role::Slider, "Force").focus();
    let before = harness.state().learn.lesson.parameters[0];
    harness.key_press(Key::ArrowRight);
    settle(&mut harness);
    assert!(harness.state().learn.lesson.parameters[0] > before);
    harness.get_by_role_and_label(Role::Button, "Close").click();
    settle(&mut harness);
    harness.get_by_label("Take the tour");
}

#[test]
fn the_page_of_three_masses_comes_and_goes_over_a_project() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Dark);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    settle(&mut harness);
    harness.state_mut().learn.lesson = Lesson::new(System::ThreeMasses, Effect::CubicStiffness);
    picture(&mut harness, "laws-dark");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Tab, "Explain");
}

//! Random pointer and key events: nothing panics, the document stays valid, undo leads back to the start.

use crate::support::{beam, open};
use dashpot::window::view::Stage;
use egui::{Event, Key, Modifiers, PointerButton, Theme, pos2};

/// Events a stage; the full number runs where `DASHPOT_EVENTS` is at hand through the ignored test below.
const FEW: usize = 300;
const MANY: usize = 20_000;

/// A small generator, the same on every machine.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
}

fn event(dice: &mut Dice) -> Event {
    const KEYS: [Key; 12] = [
        Key::ArrowUp,
        Key::ArrowDown,
        Key::ArrowLeft,
        Key::ArrowRight,
        Key::Tab,
        Key::Enter,
        Key::Delete,
        Key::Space,
        Key::S,
        Key::Z,
        Key::Escape,
        Key::F1,
    ];
    let pos = pos2(dice.below(1440) as f32, (70 + dice.below(800)) as f32);
    match dice.below(4) {
        0 | 1 => Event::PointerMoved(pos),
        2 => {
            let pressed = dice.below(2) == 0;
            Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
        }
        _ => {
            let key = KEYS[dice.below(KEYS.len() as u64) as usize];
            let modifiers = if dice.below(3) == 0 { Modifiers::COMMAND } else { Modifiers::NONE };
            Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
        }
    }
}

fn storm(stage: Stage, count: usize) {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let start = harness.state().document.as_ref().unwrap().project.sources.clone();
    harness.state_mut().view.stage = stage;
    let mut dice = Dice(stage as u64 + 7);
    for _ in 0..count {
        harness.event(event(&mut dice));
        harness.step();
        let document = harness.state().document.as_ref().unwrap();
        for source in &document.project.sources {
            source.check_on(&document.project.structure).unwrap();
        }
    }
    let document = harness.state_mut().document.as_mut().unwrap();
    while document.undo().is_some() {}
    assert_eq!(document.project.sources, start, "{stage:?}");
}

#[test]
fn random_events_leave_every_stage_standing() {
    for stage in Stage::ALL {
        storm(stage, FEW);
    }
}

#[test]
#[ignore = "minutes: the full number of events"]
fn very_many_random_events_leave_every_stage_standing() {
    for stage in Stage::ALL {
        storm(stage, MANY);
    }
}

//! Random pointer and key events: nothing panics, the document stays valid, undo leads back to the start.

use crate::support::{Sample, beam, open, settle};
use dashpot::effects::Source;
use dashpot::window::App;
use dashpot::window::view::Stage;
use egui::{Event, Key, Modifiers, PointerButton, Theme, pos2};
use egui_kittest::Harness;
use std::path::{Path, PathBuf};

/// Events a stage; the full number is in the ignored tests below.
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

/// What was open when the document had no history: its file and its sources.
type Start = (Option<PathBuf>, Vec<Source>);

/// Keys reach everything, menus and templates included, so that another document may be open in the end.
fn look(harness: &mut Harness<'_, App>, sample: &Sample, start: &mut Start) {
    let Some(document) = &harness.state().document else {
        // What was saved before it was closed is the new start.
        start.0 = Some(PathBuf::new());
        let ctx = harness.ctx.clone();
        harness.state_mut().open(&ctx, sample.path.clone());
        return settle(harness);
    };
    let (session, project) = (document.session(), &document.project);
    for source in &project.sources {
        source.check_on(&project.structure).unwrap();
    }
    if session.history().is_empty() {
        let now: Start = (session.path().map(Path::to_path_buf), project.sources.clone());
        assert!(now.0 != start.0 || now.1 == start.1, "undo led elsewhere than to the start");
        *start = now;
    }
}

fn storm(stage: Stage, count: usize) {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let document = harness.state().document.as_ref().unwrap();
    let mut start = (document.session().path().map(Path::to_path_buf), document.project.sources.clone());
    harness.state_mut().view.stage = stage;
    let mut dice = Dice(stage as u64 + 7);
    for _ in 0..count {
        harness.event(event(&mut dice));
        harness.step();
        look(&mut harness, &sample, &mut start);
    }
    let document = harness.state_mut().document.as_mut().unwrap();
    while document.undo().is_some() {}
    assert_eq!(document.project.sources, start.1, "{stage:?}");
}

#[test]
fn random_events_leave_every_stage_standing() {
    for stage in Stage::ALL {
        storm(stage, FEW);
    }
}

/// One test a stage, so that they run side by side.
macro_rules! storms {
    ($($name:ident: $stage:ident),*) => {
        $(#[test]
        #[ignore = "minutes: the full number of events"]
        fn $name() {
            storm(Stage::$stage, MANY);
        })*
    };
}

storms!(
    very_many_events_at_measure: Measure,
    very_many_events_at_structure: Structure,
    very_many_events_at_pattern: Pattern,
    very_many_events_at_select: Select,
    very_many_events_at_result: Result,
    very_many_events_at_explain: Explain
);

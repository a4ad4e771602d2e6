//! Random events: pointer, wheel, keys, text, sizes of the window, stages, files dropped. Nothing panics, no frame takes long,
//! the document stays valid, undo leads back to the start, memory does not grow.

use crate::support::{Sample, beam, drop_files, open_unseen, settle};
use dashpot::effects::Source;
use dashpot::session::Session;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Theme, TouchPhase, pos2, vec2};
use egui_kittest::Harness;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Events a stage: ten thousand over all stages; `DASHPOT_EVENTS` sets those of the ignored tests below.
const FEW: usize = 1_700;
const MANY: usize = 20_000;
/// Longest frame, time of the processor; four times as much where nothing is optimised.
const LONGEST: Duration = Duration::from_millis(if cfg!(debug_assertions) { 400 } else { 100 });
/// Most that memory may grow over the second half of the events, bytes.
const GROWTH: u64 = 50 << 20;

/// A small generator, the same on every machine.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
}

fn event(dice: &mut Dice) -> Event {
    const KEYS: [Key; 16] = [
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
        Key::Backspace,
        Key::C,
        Key::D,
        Key::End,
    ];
    let pos = pos2(dice.below(1440) as f32, (70 + dice.below(800)) as f32);
    match dice.below(20) {
        0..=8 => Event::PointerMoved(pos),
        9..=13 => {
            let pressed = dice.below(2) == 0;
            let button = if dice.below(4) == 0 { PointerButton::Secondary } else { PointerButton::Primary };
            let modifiers = if dice.below(5) == 0 { Modifiers::SHIFT } else { Modifiers::NONE };
            Event::PointerButton { pos, button, pressed, modifiers }
        }
        14 => {
            let delta = vec2(0.0, dice.below(200) as f32 - 100.0);
            let modifiers = if dice.below(6) == 0 { Modifiers::COMMAND } else { Modifiers::NONE };
            Event::MouseWheel {
                unit: MouseWheelUnit::Point,
                delta,
                phase: TouchPhase::Move,
                source: MouseWheelSource::Unknown,
                modifiers,
            }
        }
        15 => Event::Text(["1", "-", "e9", "0.5", "DOF", "\u{3b6}", "nan"][dice.below(7) as usize].to_owned()),
        16 => Event::Copy,
        _ => {
            let key = KEYS[dice.below(KEYS.len() as u64) as usize];
            let modifiers = if dice.below(3) == 0 { Modifiers::COMMAND } else { Modifiers::NONE };
            Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
        }
    }
}

/// Now and then something larger: another size, another stage, files on the window.
fn upheaval(harness: &mut Harness<'_, App>, dice: &mut Dice, files: &[PathBuf]) {
    match dice.below(400) {
        0 => {
            harness.set_size(vec2(700.0 + dice.below(1300) as f32, 500.0 + dice.below(700) as f32));
        }
        1..=3 => harness.state_mut().view.stage = Stage::ALL[dice.below(6) as usize],
        4 => drop_files(harness, &files[dice.below(files.len() as u64) as usize..][..1]),
        _ => {}
    }
}

/// Files that are and are not measurements.
fn files(sample: &Sample) -> Vec<PathBuf> {
    let folder = sample.path.parent().unwrap();
    let bad = [
        ("empty.csv", ""),
        ("words.csv", "time [s],force@9 [N]\n0,oops\n"),
        ("noise.uff", "\u{1}\u{2}-1\n58"),
        ("what.xyz", "?"),
    ];
    for (name, text) in bad {
        std::fs::write(folder.join(name), text).unwrap();
    }
    std::fs::copy(folder.join("run-01.csv"), folder.join("again.csv")).unwrap();
    let names = bad.iter().map(|(name, _)| *name).chain(["again.csv", "gone.csv", "project.toml"]);
    names.map(|name| folder.join(name)).collect()
}

/// Time of the processor that this thread has taken; of the clock where the system does not say.
pub(crate) fn spent(start: Instant) -> Duration {
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = own.and_then(|text| text.split(' ').next()?.parse().ok());
    own.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Memory of this process, bytes; nothing where the system does not say.
fn memory() -> u64 {
    let pages = std::fs::read_to_string("/proc/self/statm").ok();
    pages.and_then(|text| text.split(' ').nth(1)?.parse::<u64>().ok()).map_or(0, |pages| 4096 * pages)
}

/// What was open when the document had no history: its file and its sources.
type Start = (Option<PathBuf>, Vec<Source>);

/// Keys reach everything, menus and templates included, so that another document may be open in the end.
fn look(harness: &mut Harness<'_, App>, sample: &Sample, start: &mut Start) {
    // The start screen opens the samples of this repository in place: nothing is to be changed or saved there.
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data");
    let own = |session: &Session| session.path().is_none_or(|path| !path.starts_with(&samples));
    let Some(document) = harness.state().document.as_ref().filter(|document| own(document.session())) else {
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
        // A project that is dropped on the window after it was saved is opened anew, with what was saved.
        assert!(now.0 != start.0 || now.1 == start.1 || !session.is_dirty(), "undo led elsewhere than to the start");
        *start = now;
    }
}

fn storm(stage: Stage, count: usize) {
    let sample = beam();
    // The dialogs of the window begin there: what is saved by chance is not to land in this repository.
    std::env::set_current_dir(sample.path.parent().unwrap()).unwrap();
    let mut harness = open_unseen(&sample, Theme::Light);
    let document = harness.state().document.as_ref().unwrap();
    let mut start = (document.session().path().map(Path::to_path_buf), document.project.sources.clone());
    harness.state_mut().view.stage = stage;
    let files = files(&sample);
    let mut dice = Dice(stage as u64 + 7);
    let (clock, mut longest, mut half) = (Instant::now(), (Duration::ZERO, 0), 0);
    for k in 0..count {
        if k == count / 2 {
            half = memory();
        }
        upheaval(&mut harness, &mut dice, &files);
        harness.event(event(&mut dice));
        let before = spent(clock);
        harness.step();
        longest = longest.max((spent(clock).saturating_sub(before), k));
        look(&mut harness, &sample, &mut start);
    }
    let grown = memory().saturating_sub(half);
    println!(
        "{stage:?}: {count} events, longest frame {:?} at event {}, memory + {} MB",
        longest.0,
        longest.1,
        grown >> 20
    );
    assert!(longest.0 < LONGEST, "{stage:?}: a frame of {:?} at event {}", longest.0, longest.1);
    assert!(count < MANY || grown < GROWTH, "{stage:?}: memory grew by {grown} bytes");
    if harness.state().document.is_none() {
        look(&mut harness, &sample, &mut start);
    }
    let document = harness.state_mut().document.as_mut().unwrap();
    while document.undo().is_some() {}
    assert_eq!(document.project.sources, start.1, "{stage:?}");
}

/// Two tests a stage, so that they run side by side: few events, and the full number.
macro_rules! storms {
    ($($few:ident, $many:ident: $stage:ident),*) => {
        $(#[test]
        fn $few() {
            storm(Stage::$stage, FEW);
        }

        #[test]
        #[ignore = "minutes: the full number of events"]
        fn $many() {
            let count = std::env::var("DASHPOT_EVENTS").ok().and_then(|n| n.parse().ok());
            storm(Stage::$stage, count.unwrap_or(MANY));
        })*
    };
}

storms!(
    events_at_measure, very_many_events_at_measure: Measure,
    events_at_structure, very_many_events_at_structure: Structure,
    events_at_pattern, very_many_events_at_pattern: Pattern,
    events_at_select, very_many_events_at_select: Select,
    events_at_result, very_many_events_at_result: Result,
    events_at_explain, very_many_events_at_explain: Explain
);

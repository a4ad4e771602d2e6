//! Undo of every step back to the start and redo to the end: the same document and, to the byte, the same pictures.

use crate::support::{chain, open, settle};
use dashpot::effects::{Effect, Family, State};
use dashpot::session::{Command, Setting};
use dashpot::window::App;
use dashpot::window::app::Ask;
use dashpot::window::app::view::Stage;
use dashpot::window::document::edits::Edit;
use egui::Theme;
use egui_kittest::Harness;
use std::collections::BTreeMap;

/// What the document says and what the window shows.
type Seen = (String, Vec<u8>);

fn seen(harness: &mut Harness<'_, App>) -> Seen {
    settle(harness);
    // Nothing is selected, so that the picture is of the document alone.
    (harness.state_mut().view.source, harness.state_mut().view.dof) = (None, None);
    harness.remove_cursor();
    settle(harness);
    let file = harness.state().document.as_ref().unwrap().session().document().file().to_toml().unwrap();
    (file, harness.render().unwrap().into_raw())
}

fn script() -> Vec<Edit> {
    let run = |k: usize| format!("run-0{k}.csv");
    vec![
        Edit::Draw(Effect::Coulomb, vec![1]),
        Edit::Draw(Effect::Viscous, vec![0, 3]),
        Edit::Cycle(1),
        Edit::DrawFamily(Effect::Viscous, Family::EachTranslation),
        Edit::SetState(0, State::Off),
        Edit::Do(Command::SetStructureParameter { name: "masses[2]".into(), value: 2.05 }),
        Edit::Do(Command::SetStructureParameters(BTreeMap::from([("ground_stiffness[1]".to_owned(), 4100.0)]))),
        Edit::UseRun(run(2), false),
        Edit::Do(Command::SetRunLevel { file: run(1), level: Some(3) }),
        Edit::Do(Command::SetSensor { channel: "acc@2".into(), delay: Some(1e-5), gain: None }),
        Edit::Do(Command::SetSetting(Setting::Harmonics(5))),
        Edit::Do(Command::SetSetting(Setting::MaxSources(3))),
        Edit::Do(Command::SetTitle("Another title".into())),
        Edit::Force(vec![2]),
        Edit::ClearCandidates,
        Edit::Do(Command::RemoveRun(run(4))),
    ]
}

#[test]
fn undo_to_the_start_and_redo_to_the_end_show_the_same_pictures() {
    let sample = chain();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Pattern;
    let mut states = vec![seen(&mut harness)];
    for edit in script() {
        let ctx = harness.ctx.clone();
        harness.state_mut().answer(&ctx, Ask::Edit(edit.clone()));
        let now = seen(&mut harness);
        assert!(harness.state().message.is_none(), "{edit:?}: {:?}", harness.state().message);
        assert_ne!(now.0, states.last().unwrap().0, "{edit:?} changed nothing");
        states.push(now);
    }
    assert_eq!(harness.state().document.as_ref().unwrap().session().history().len(), script().len());
    for k in (0..states.len() - 1).rev() {
        harness.state_mut().document.as_mut().unwrap().undo().unwrap();
        let now = seen(&mut harness);
        assert_eq!(now.0, states[k].0, "undo to state {k}");
        assert!(now.1 == states[k].1, "undo to state {k} looks different");
    }
    assert!(!harness.state().document.as_ref().unwrap().session().is_dirty());
    for k in 1..states.len() {
        harness.state_mut().document.as_mut().unwrap().redo().unwrap();
        let now = seen(&mut harness);
        assert_eq!(now.0, states[k].0, "redo to state {k}");
        assert!(now.1 == states[k].1, "redo to state {k} looks different");
    }
}

//! The laws of undo, over random sequences of commands, many of which are refused.

use crate::support::session;
use dashpot::exchange::project::ProjectFile;
use dashpot::session::history::Gesture;
use dashpot::session::{Command, Session};
use proptest::prelude::*;
use serde_json::{Value, json};

fn command(value: Value) -> Command {
    serde_json::from_value(value).unwrap()
}

fn at() -> impl Strategy<Value = Value> {
    let law = prop::sample::select(vec!["viscous", "coulomb", "iwan", "loss_factor", "delay"]);
    let dofs = prop::collection::vec(0..9_u8, 0..3);
    (law, dofs).prop_map(|(law, dofs)| json!({"law": law, "dofs": dofs.iter().map(u8::to_string).collect::<Vec<_>>()}))
}

fn any_command() -> impl Strategy<Value = Command> {
    let state = || prop::sample::select(vec!["known", "candidate", "forced", "off", "reference"]);
    let family = || prop::sample::select(vec!["each-translation", "each-dof", "each-pair", "chain"]);
    let law = || prop::sample::select(vec!["viscous", "coulomb", "loss_factor", "gain"]);
    let run = || prop::sample::select(vec!["run-01.csv", "run-02.csv", "run-03.csv"]);
    let number = prop::sample::select(vec!["length", "depth", "elements", "colour"]);
    prop_oneof![
        at().prop_map(|source| json!({"add_source": source})),
        at().prop_map(|source| json!({"remove_source": source})),
        (at(), state()).prop_map(|(source, state)| json!({"set_source_state": {"source": source, "state": state}})),
        (at(), -1.0..9.0).prop_map(|(s, c)| json!({"set_source_parameters": {"source": s, "parameters": {"c": c}}})),
        (law(), family()).prop_map(|(law, family)| json!({"add_candidates": {"law": law, "where": family}})),
        (law(), family()).prop_map(|(law, family)| json!({"remove_candidates": {"law": law, "where": family}})),
        (number, prop::sample::select(vec![-1.0, 0.5, 2.0, 3.0, 5.0]))
            .prop_map(|(name, value)| json!({"set_structure_parameter": {"name": name, "value": value}})),
        (0..9_u8, prop::option::of(-0.1..1.0))
            .prop_map(|(dof, mass)| json!({"set_lumped_mass": {"dof": dof.to_string(), "mass": mass}})),
        run().prop_map(|run| json!({"import_runs": [run]})),
        run().prop_map(|run| json!({"remove_run": run})),
        (run(), any::<bool>()).prop_map(|(run, used)| json!({"set_run_use": {"file": run, "use": used}})),
        (run(), -1.0..100.0).prop_map(|(run, hz)| json!({"set_run_frequency": {"file": run, "frequency": hz}})),
        (0..1500_u32).prop_map(|n| json!({"set_setting": {"harmonics": n}})),
        (0..4_u8).prop_map(|n| json!({"set_title": format!("title {n} \"quoted\"\n")})),
        (0..9_u8).prop_map(|dof| json!({"set_sensor": {"channel": format!("acc@{dof}"), "delay": 1e-4, "gain": null}})),
    ]
    .prop_map(command)
}

/// The document can be written, read again as the same, and built from nothing.
fn assert_valid(session: &Session) {
    let file = session.document().file();
    let read = ProjectFile::parse(&file.to_toml().unwrap(), "project.toml").unwrap().0;
    assert_eq!(&read, file.as_ref());
    let again = dashpot::session::Document::new(read, session.document().folder()).unwrap();
    assert_eq!(again.sources(), session.document().sources());
    assert_eq!(again.structure(), session.document().structure());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_sequence_can_be_undone_and_redone(commands in prop::collection::vec((any_command(), 0..4_u64), 1..40)) {
        let mut session = session();
        let start = session.document().clone();
        let mut done = 0;
        for (command, gesture) in &commands {
            let before = session.document().clone();
            let count = session.history().len();
            let gesture = (*gesture == 0).then_some(Gesture(7));
            if session.apply_in(command, gesture).is_err() {
                prop_assert_eq!(session.document(), &before);
                prop_assert_eq!(session.history().len(), count);
            } else if session.document() != &before {
                done += 1;
                prop_assert!(session.history().redo_label().is_none());
            }
        }
        assert_valid(&session);
        let end = session.document().clone();
        let steps = session.history().len();
        prop_assert!(steps <= done);
        for _ in 0..steps {
            let label = session.history().undo_label().map(str::to_owned);
            prop_assert_eq!(session.undo(), label);
            assert_valid(&session);
        }
        prop_assert_eq!(session.undo(), None);
        prop_assert_eq!(session.document(), &start);
        for _ in 0..steps {
            prop_assert!(session.redo().is_some());
        }
        prop_assert_eq!(session.redo(), None);
        prop_assert_eq!(session.document(), &end);
    }

    #[test]
    fn a_new_action_clears_redo(first in any_command(), second in any_command()) {
        let mut session = session();
        prop_assume!(session.apply(&first).is_ok() && !session.history().is_empty());
        session.undo();
        prop_assert!(session.history().redo_label().is_some());
        let before = session.document().clone();
        let changed = session.apply(&second).is_ok() && session.document() != &before;
        prop_assert_eq!(session.history().redo_label().is_none(), changed);
    }

    #[test]
    fn commands_survive_json(command in any_command()) {
        let text = serde_json::to_string(&command).unwrap();
        prop_assert_eq!(serde_json::from_str::<Command>(&text).unwrap(), command);
    }
}

#[test]
fn a_drag_is_undone_at_once() {
    let mut session = session();
    let start = session.document().clone();
    for (value, gesture) in [(0.6, 1), (0.7, 1), (0.8, 1), (0.9, 2)] {
        let drag = command(json!({"set_structure_parameter": {"name": "length", "value": value}}));
        session.apply_in(&drag, Some(Gesture(gesture))).unwrap();
    }
    assert_eq!(session.history().len(), 2);
    assert_eq!(session.undo().as_deref(), Some("change length"));
    assert_eq!(session.undo().as_deref(), Some("change length"));
    assert_eq!(session.document(), &start);
}

//! Scripts, refusals with their reasons, families that are written out when one member is changed.

use crate::support::{BEAM, session};
use dashpot::effects::{Effect, Place, State};
use dashpot::session::Session;
use dashpot::session::script::{parse, play};

fn refused(script: &str) -> String {
    play(&mut session(), &parse(script).unwrap()).unwrap_err().to_string()
}

#[test]
fn a_script_says_what_a_hand_does() {
    let mut session = session();
    let script = r#"[
        {"add_source": {"law": "viscous", "dofs": ["5", "7"]}},
        {"set_source_state": {"source": {"law": "viscous", "dofs": ["7", "5"]}, "state": "forced"}},
        "undo", "redo",
        {"set_setting": {"stop_angle_deg": 0.1}}
    ]"#;
    let labels = play(&mut session, &parse(script).unwrap()).unwrap();
    assert_eq!(labels[0], "add viscous dashpot");
    assert_eq!(labels[2], "undo make viscous dashpot forced");
    assert_eq!(session.document().sources()[1].state, State::Forced);
    assert_eq!(session.document().file().analysis.stop_angle_deg, 0.1);
}

#[test]
fn a_source_drawn_twice_is_refused_with_a_reason() {
    let twice = r#"[{"add_source": {"law": "coulomb", "dofs": ["5", "7"]}},
                    {"add_source": {"law": "coulomb", "dofs": ["7", "5"]}}]"#;
    let said = refused(twice);
    assert!(said.contains("step 2") && said.contains("already drawn"), "{said}");
}

#[test]
fn refusals_name_what_would_do() {
    for (script, word) in [
        (r#"[{"add_source": {"law": "viscous", "dofs": ["99"]}}]"#, "99"),
        (r#"[{"add_source": {"law": "delay"}}]"#, "channel"),
        (r#"[{"remove_source": {"law": "iwan", "dofs": ["3"]}}]"#, "not drawn: Iwan joint at DOF 3"),
        (r#"[{"set_structure_parameter": {"name": "colour", "value": 1}}]"#, "youngs_modulus"),
        (r#"[{"set_structure_parameter": {"name": "length", "value": -1}}]"#, "length"),
        (r#"[{"set_run_use": {"file": "x.csv", "use": false}}]"#, "x.csv"),
        (r#"[{"import_runs": ["run-01.csv"]}]"#, "already"),
        (r#"[{"rule_out": {"law": "coulomb", "dofs": ["99"]}}]"#, "99"),
        (r#"[{"rule_out": {"law": "delay", "dofs": ["3"]}}]"#, "channel"),
        (r#"[{"allow": {"law": "coulomb", "dofs": ["3"]}}]"#, "not ruled out"),
        (r#"["undo"]"#, "nothing to undo"),
    ] {
        let said = refused(script);
        assert!(said.contains(word), "{said}");
    }
    assert!(parse(r#"["jump"]"#).unwrap_err().to_string().contains("step 1"));
    assert!(parse(r#"[{"add_sauce": {}}]"#).unwrap_err().to_string().contains("add_sauce"));
}

#[test]
fn a_member_of_a_family_can_be_changed_alone() {
    let mut session = session();
    let script = r#"[{"add_candidates": {"law": "coulomb", "where": "each-translation"}},
                     {"set_source_state": {"source": {"law": "coulomb", "dofs": ["5"]}, "state": "off"}}]"#;
    play(&mut session, &parse(script).unwrap()).unwrap();
    let states: Vec<State> = session.document().sources().iter().skip(1).map(|source| source.state).collect();
    assert_eq!(states, [State::Candidate, State::Candidate, State::Off, State::Candidate]);
    session.undo();
    assert_eq!(session.document().file().candidates.len(), 1);
}

#[test]
fn revisions_count_only_the_parts_that_changed() {
    let mut session = session();
    let before = session.revisions();
    play(&mut session, &parse(r#"[{"set_title": "x"}]"#).unwrap()).unwrap();
    let titled = session.revisions();
    assert_eq!((titled.any, titled.sources, titled.structure), (before.any + 1, before.sources, before.structure));
    play(&mut session, &parse(r#"[{"add_source": {"law": "coulomb", "dofs": ["3"]}}]"#).unwrap()).unwrap();
    let drawn = session.revisions();
    assert_eq!((drawn.sources, drawn.measurements), (titled.sources + 1, titled.measurements));
    session.undo();
    assert_eq!(session.revisions().sources, drawn.sources + 1);
}

#[test]
fn what_is_ruled_out_is_undone_saved_and_goes_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, BEAM).unwrap();
    let mut session = Session::open(&path).unwrap();
    let script = r#"[{"rule_out": {"law": "coulomb", "dofs": ["7"]}},
                     {"rule_out": {"law": "viscous", "dofs": ["5", "3"]}},
                     {"rule_out": {"law": "gain", "channel": "acc@7"}},
                     {"rule_out": {"law": "loss_factor"}}]"#;
    assert_eq!(play(&mut session, &parse(script).unwrap()).unwrap()[0], "rule out Coulomb friction");
    let all = session.document().ruled_out().clone();
    assert_eq!(all[0].place, Place::Dofs(vec![6]));
    assert_eq!((all[1].place.clone(), all[2].effect), (Place::Dofs(vec![4, 2]), Effect::Gain));
    assert_eq!(session.document().sources().len(), 1, "what is ruled out is no source");
    let twice = r#"[{"rule_out": {"law": "viscous", "dofs": ["3", "5"]}}]"#;
    assert!(play(&mut session, &parse(twice).unwrap()).unwrap_err().to_string().contains("already"));

    session.save().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("[[ruled_out]]"), "{text}");
    assert_eq!(Session::open(&path).unwrap().document().ruled_out(), &all);

    assert_eq!(session.undo().unwrap(), "rule out loss factor");
    assert_eq!(session.document().ruled_out().len(), 3);
    play(&mut session, &parse(r#"[{"allow": {"law": "coulomb", "dofs": ["7"]}}]"#).unwrap()).unwrap();
    assert_eq!(session.document().ruled_out().len(), 2);
    session.undo();
    // With fewer elements there is no DOF 7 any more: neither a reason to refuse the change nor to keep what was said of it.
    play(&mut session, &parse(r#"[{"set_structure_parameter": {"name": "elements", "value": 3}}]"#).unwrap()).unwrap();
    assert!(session.document().ruled_out().iter().all(|s| s.effect == Effect::Viscous));
    session.undo();
    assert_eq!(session.document().ruled_out().len(), 3);
}

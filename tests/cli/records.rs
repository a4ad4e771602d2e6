//! What `identify`, `compare` and `diagnose` say of records that are not steady.

use super::{dashpot, json, text};
use std::fs;

const MODEL: &str = "[project]\nformat = 1\ntitle = \"Struck\"\n[structure]\nkind = \"chain\"\nmasses = [2, 3, 1.5]\n\
    ground_stiffness = [4e4, 0, 3e4]\ncoupling_stiffness = [6e4, 5e4]\n\
    [[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 10\n";

/// A double hit of a model that lacks nothing: the flag is told, and that nothing is missing; a record that is not used says why.
#[test]
fn a_double_hit_is_told_and_nothing_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = "[[run]]\nfile = \"hit.csv\"\nkind = \"transient\"\nexcitation = { kind = \"impulse\", dof = 1, \
        peak_n = 200.0, width_s = 0.006, at_s = 0.1, again_s = 0.2, duration_s = 4.0 }\n[simulate]\n\
        channels = [\"force@1 [N]\", \"acc@1 [m/s^2]\", \"acc@2 [m/s^2]\", \"acc@3 [m/s^2]\"]\nrate_hz = 512.0\n";
    fs::write(folder.path().join("recipe.toml"), format!("{MODEL}{recipe}")).unwrap();
    let made = dashpot(&["simulate", "recipe.toml", "--out", "made", "--noise", "0.005"], folder.path());
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let runs = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\
        [[run]]\nfile = \"made/hit.csv\"\nkind = \"transient\"\n\
        [[run]]\nfile = \"made/again.csv\"\nkind = \"transient\"\nuse = false\n";
    fs::copy(folder.path().join("made/hit.csv"), folder.path().join("made/again.csv")).unwrap();
    fs::write(folder.path().join("p.toml"), format!("{MODEL}{runs}")).unwrap();

    let compared = json(&["compare", "p.toml", "--json"], folder.path());
    assert_eq!(compared["records"][0]["findings"][0]["flag"], "double-hit");
    assert_eq!(compared["record_findings"][0]["used"], true);
    assert!(compared["record_findings"][1]["why_not_used"].as_str().unwrap().contains("switched off"));
    let words = text(&dashpot(&["compare", "p.toml"], folder.path()).stdout);
    assert!(words.contains("strikes 2 times") && words.contains("not used: it is switched off"), "{words}");

    let diagnosed = json(&["diagnose", "p.toml", "--json"], folder.path());
    assert_eq!(diagnosed["verdict"], "adequate");
    assert_eq!(diagnosed["record_findings"][0]["findings"][0]["flag"], "double-hit");
    let words = text(&dashpot(&["diagnose", "p.toml"], folder.path()).stdout);
    assert!(words.contains("strikes 2 times"), "{words}");
}

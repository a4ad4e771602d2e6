//! The walk of the documents: every command of it runs, and it finds what it promises.

use super::{dashpot, json};
use std::path::Path;

#[test]
fn every_command_of_the_walk_from_responses_to_the_map_of_damping_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/walk-frf.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["hammer.uff", "model.bdf"] {
        std::fs::copy(root.join("sample-data/hammer-frf").join(name), folder.path().join(name)).unwrap();
    }
    let files = ["hammer.uff", "model.bdf", "walk.toml", "shares.svg", "matrix.svg", "report.html", "damping.bdf"];
    let mut ran = 0;
    for line in page.lines().filter_map(|line| line.strip_prefix("dashpot ")) {
        let place = |word: &str| {
            if files.contains(&word) { folder.path().join(word).display().to_string() } else { word.to_owned() }
        };
        let words: Vec<String> = line.split_whitespace().map(place).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        dashpot(&words).unwrap_or_else(|error| panic!("{line}: {error}"));
        ran += 1;
    }
    assert_eq!(ran, 8);
    let project = folder.path().join("walk.toml");
    assert!(std::fs::read_to_string(&project).unwrap().contains("\"6:+Z\" = \"106z\""));
    let identified = json(&["identify", "--json", &project.display().to_string()]);
    let found: Vec<(String, f64)> = identified["sources"]
        .as_array()
        .unwrap()
        .iter()
        .map(|source| (source["dofs"][0].to_string(), source["parameters"]["c"].as_f64().unwrap()))
        .collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].1 - 0.5).abs() < 0.002 && (found[1].1 - 0.2).abs() < 0.002, "{found:?}");
    assert!(found[0].0.contains("103z") && found[1].0.contains("107z"), "{found:?}");
    for name in files {
        assert!(folder.path().join(name).exists(), "{name}");
    }
}

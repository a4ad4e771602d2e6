//! The book of docs/: every page is in its list of chapters, every link and picture is there, what is made of the program is
//! what the program says; `UPDATE_DOCS=1` writes that anew.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// All pages, by their paths below `docs`.
fn pages(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|e| e == "md") {
            found.insert(path.strip_prefix(docs()).unwrap().to_str().unwrap().replace('\\', "/"));
        }
    }
}

/// Targets of the links and pictures of a page, fenced blocks left out.
fn links(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut fenced = false;
    for line in text.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        }
        let mut rest = if fenced { "" } else { line };
        while let Some(at) = rest.find("](") {
            rest = &rest[at + 2..];
            let Some(end) = rest.find(')') else { break };
            found.push(rest[..end].to_owned());
        }
    }
    found
}

/// The name that a heading has in links.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    kept.chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

fn anchors(text: &str) -> BTreeSet<String> {
    text.lines().filter_map(|line| Some(anchor(line.strip_prefix('#')?.trim_start_matches('#')))).collect()
}

#[test]
fn every_page_is_a_chapter_and_every_chapter_a_page() {
    let mut all = BTreeSet::new();
    pages(&docs(), &mut all);
    assert!(all.remove("SUMMARY.md"));
    let summary = fs::read_to_string(docs().join("SUMMARY.md")).unwrap();
    let listed = links(&summary);
    let chapters: BTreeSet<String> = listed.iter().cloned().collect();
    assert_eq!(listed.len(), chapters.len(), "no chapter stands twice");
    assert_eq!(all, chapters);
}

#[test]
fn every_link_and_every_picture_is_there() {
    let mut all = BTreeSet::new();
    pages(&docs(), &mut all);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<PathBuf> = all.iter().map(|page| docs().join(page)).collect();
    files.extend(["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|name| root.join(name)));
    let (mut broken, mut seen) = (Vec::new(), 0);
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        for link in links(&text).into_iter().filter(|l| !l.starts_with("http")) {
            seen += 1;
            let (path, heading) = link.split_once('#').map_or((link.as_str(), None), |(p, h)| (p, Some(h)));
            let target = if path.is_empty() { file.clone() } else { file.parent().unwrap().join(path) };
            let there = target.exists();
            let named =
                |h: &str| !there || !target.is_file() || anchors(&fs::read_to_string(&target).unwrap()).contains(h);
            if !there || !heading.is_none_or(named) {
                broken.push(format!("{}: {link}", file.display()));
            }
            // A book holds what lies below its folder.
            let inside = |t: &Path| t.canonicalize().is_ok_and(|t| t.starts_with(docs().canonicalize().unwrap()));
            if there && file.starts_with(docs()) && !inside(&target) {
                broken.push(format!("{}: {link} lies outside the book", file.display()));
            }
        }
    }
    assert!(seen > 60, "only {seen} links were seen");
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn the_page_of_commands_is_what_the_parser_says() {
    let (path, page) = (docs().join("command-line.md"), dashpot::cli::manual());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "docs/command-line.md is not what the parser says: UPDATE_DOCS=1 writes it anew");
    for command in ["identify", "diagnose", "report", "plot", "import", "simulate", "change"] {
        assert!(page.contains(&format!("\n## {command}\n")), "{command}");
    }
    assert!(page.contains("| `--noise NOISE` |") && page.contains("(default: 0)"), "{page}");
}

#[test]
fn every_sample_has_its_story_and_every_flag_its_line() {
    let stories = fs::read_to_string(docs().join("samples.md")).unwrap();
    let samples = fs::read_dir(docs().join("../sample-data")).unwrap();
    let names: BTreeSet<String> = samples.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    let told: BTreeSet<String> =
        stories.lines().filter_map(|line| line.strip_prefix("## ")).map(str::to_owned).collect();
    assert_eq!(names, told);
    for story in stories.split("\n## ").skip(1) {
        for part in ["**Question.**", "**Do.**", "**See.**"] {
            assert!(story.contains(part), "{part} is not in {}", story.lines().next().unwrap());
        }
    }
    let page = fs::read_to_string(docs().join("stages/measure.md")).unwrap();
    for flag in dashpot::measurement::Flag::ALL {
        let words = dashpot::display::words::flag(flag);
        assert!(page.contains(&format!("\n| {words} | ")), "{words} has no line in docs/stages/measure.md");
    }
}

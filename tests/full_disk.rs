//! A disk that takes no more: every command that writes a file ends with one line, and leaves what was there before. The shell's limit on the
//! size of files stands for the disk: writing beyond it fails as on a full one.
#![cfg(unix)]
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the program where a file can grow to 512 bytes at most.
fn on_a_full_disk(arguments: &str, folder: &Path) -> Output {
    // With the signal ignored the write fails with an error, as on a full disk.
    let script = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" {arguments}");
    Command::new("sh").args(["-c", &script, env!("CARGO_BIN_EXE_dashpot")]).current_dir(folder).output().unwrap()
}

fn sample(folder: &Path) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/cantilever-harmonics");
    for entry in fs::read_dir(sample).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
    }
}

#[test]
fn nothing_is_lost_where_the_disk_is_full() {
    let folder = tempfile::tempdir().unwrap();
    sample(folder.path());
    fs::write(folder.path().join("script.json"), "[]").unwrap();
    let writes = [
        ("report project.toml --out out.html", "out.html"),
        ("report project.toml --out out.pdf", "out.pdf"),
        ("plot project.toml --what bode --out out.svg", "out.svg"),
        ("plot project.toml --what bode --out out.csv", "out.csv"),
        ("export project.toml --to csv --out out.csv", "out.csv"),
        ("export project.toml --to json --out out.json", "out.json"),
        ("convert harmonics.csv out.csv", "out.csv"),
        ("simulate truth.toml --out . --as harmonics", "harmonics.csv"),
        ("run script.json project.toml --out out.toml", "out.toml"),
    ];
    for (arguments, out) in writes {
        let target = folder.path().join(out);
        if out.starts_with("out.") {
            fs::write(&target, "what was there before").unwrap();
        }
        let before = fs::read(&target).unwrap();
        let names = |folder: &Path| fs::read_dir(folder).unwrap().count();
        let count = names(folder.path());
        let done = on_a_full_disk(arguments, folder.path());
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{arguments}: {said}");
        assert_eq!(said.trim().lines().count(), 1, "{arguments}: {said}");
        assert!(said.contains(out) || said.contains("script"), "{arguments} does not name its file: {said}");
        assert!(fs::read(&target).unwrap() == before, "{arguments}: {out} is not as it was");
        assert_eq!(names(folder.path()), count, "{arguments} leaves something behind");
    }
}

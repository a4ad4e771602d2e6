//! Damaged files through `contents` and `import`: one line each, never a panic, and no project that does not open.

use super::dashpot;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Good files that are damaged: those of the readers' corpus, and some of our own.
fn good() -> Vec<(String, Vec<u8>)> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/datafiles/tests/corpus");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(corpus).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end != "json"));
    paths.sort();
    let named = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    let mut files: Vec<(String, Vec<u8>)> = paths.iter().map(|p| (named(p), std::fs::read(p).unwrap())).collect();
    let rows = |row: &dyn Fn(f64) -> String| (0..120).map(|i| row(f64::from(i) / 100.0)).collect::<String>();
    let own = rows(&|t| format!("{t},{},{}\n", (30.0 * t).sin(), (30.0 * t).cos()));
    files.push(("own.csv".into(), format!("time [s],force@1 [N],acc@2 [m/s^2]\n{own}").into_bytes()));
    let decay = rows(&|t| format!("{t};{}\n", (-t).exp() * (60.0 * t).cos()).replace('.', ","));
    files.push(("decay.csv".into(), format!("Zeit [s];Beschleunigung [g]\n{decay}").into_bytes()));
    let steps = rows(&|t| format!("1,{},2.0,{},-1.5\n", 80.0 + t, 3.0 + t));
    files.push(("steps.csv".into(), format!("level,frequency_hz,force,acceleration,phase_rad\n{steps}").into_bytes()));
    files
}

/// The same damages of every file, by number; none where it cannot be damaged so.
fn damaged(bytes: &[u8], how: usize, random: &mut ChaCha8Rng) -> Option<Vec<u8>> {
    let text = || String::from_utf8(bytes.to_vec()).ok();
    let lines = |text: &str, change: &dyn Fn(usize, &str) -> String| {
        text.lines().enumerate().map(|(i, line)| change(i, line) + "\n").collect::<String>().into_bytes()
    };
    let some = |text: &str| text.find(|c: char| c.is_ascii_digit());
    match how {
        0 => Some(bytes[..bytes.len() / 3].to_vec()),
        1 => Some(bytes[..bytes.len() * 9 / 10].to_vec()),
        2 => {
            let mut bytes = bytes.to_vec();
            for _ in 0..20 {
                let at = random.random_range(0..bytes.len());
                bytes[at] = random.random();
            }
            Some(bytes)
        }
        3 => {
            let (from, length) = (random.random_range(0..bytes.len()), bytes.len() / 20 + 1);
            Some([&bytes[..from], &bytes[(from + length).min(bytes.len())..]].concat())
        }
        4 => Some([bytes, &bytes[bytes.len() / 2..]].concat()),
        5 => {
            text().map(|text| lines(&text, &|i, line| if i % 9 == 8 { "NaN,nan;NaN\tinf".into() } else { line.into() }))
        }
        6 => text().map(|text| lines(&text, &|i, line| if i % 7 == 6 { format!("{line},4,5") } else { line.into() })),
        7 => text().map(|text| lines(&text, &|_, line| line.split([',', ';', '\t']).take(1).collect())),
        8 => text().map(|text| lines(&text, &|i, line| if i > 1 { String::new() } else { line.into() })),
        9 => text().map(|text| text.replace('1', "1e999").into_bytes()),
        10 => text().map(|text| [b"\xe4\xf6\xfc\xb0 ".as_slice(), text.as_bytes()].concat()),
        11 => {
            text().and_then(|text| some(&text).map(|at| format!("{}9999999{}", &text[..at], &text[at..]).into_bytes()))
        }
        12 => text()
            .map(|text| lines(&text, &|_, line| format!("{line}{}{line}", if line.contains(';') { ';' } else { ',' }))),
        _ => None,
    }
}

/// Runs the program; a panic is a failure of the test, an error must be one line that says more than the name of the file.
fn one_line(words: &[&str], file: &Path, what: &str) -> bool {
    let answered = catch_unwind(AssertUnwindSafe(|| dashpot(words)));
    let Ok(answer) = answered else { panic!("{what}: {words:?} panicked") };
    let Err(error) = answer else { return true };
    assert!(!error.trim().is_empty() && !error.contains('\n'), "{what}: {error}");
    let name = file.file_name().unwrap().to_string_lossy().into_owned();
    assert!(error.contains(&name) || error.contains("project.toml"), "{what} is not named: {error}");
    assert!(error.len() > file.display().to_string().len() + 15, "{what}: {error}");
    false
}

#[test]
fn every_damaged_file_is_a_project_that_opens_or_one_line() {
    let mut random = ChaCha8Rng::seed_from_u64(15);
    let (mut files, mut refused) = (0, 0);
    for (name, bytes) in good() {
        for how in 0..13 {
            let Some(damaged) = damaged(&bytes, how, &mut random) else { continue };
            let folder = tempfile::tempdir().unwrap();
            let (file, out) = (folder.path().join(&name), folder.path().join("project.toml"));
            std::fs::write(&file, damaged).unwrap();
            let what = format!("{name}, damage {how}");
            let (shown, to) = (file.display().to_string(), out.display().to_string());
            files += 1;
            one_line(&["contents", "--json", &shown], &file, &what);
            one_line(&["contents", &shown], &file, &what);
            let made = one_line(&["import", &shown, "--out", &to], &file, &what);
            assert_eq!(made, out.exists(), "{what}: a project stands for what was {made}");
            refused += usize::from(!made);
            one_line(&["import", &shown, "--out", &to, "--sampling-hz", "1000", "--step-hz", "1"], &file, &what);
        }
    }
    assert!(files >= 300 && refused >= 150, "{files} files, {refused} refused");
}

//! What is needed to compute the same again: settings, version, files.

use super::page::Page;
use super::request::{Origin, Request};
use super::section::Section;
use crate::display::{format, words};
use crate::exchange::Project;
use crate::math::bootstrap::DRAWS;
use sha2::{Digest as _, Sha256};
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;
use std::time::Duration;

/// Adds the chapter.
pub(super) fn chapter(page: &mut Page, p: &Project, request: &Request) {
    page.chapter(Section::Settings, "Settings");
    let rows: Vec<Vec<String>> = [analysis(p), search(request), program()]
        .concat()
        .into_iter()
        .map(|(name, value)| vec![name.to_owned(), value])
        .collect();
    page.table("Settings of the evaluation", &["Setting", "Value"], &rows);
    if request.holds(Section::Settings)
        && let Some(origin) = &request.origin
    {
        files(page, origin);
    }
}

fn analysis(p: &Project) -> Vec<(&'static str, String)> {
    let s = &p.settings;
    let keep = if s.keep == 0 { "all sets are looked at".to_owned() } else { s.keep.to_string() };
    vec![
        ("Harmonics fitted to every channel", s.harmonics.to_string()),
        ("Frequencies of steady runs", frequencies(p)),
        ("Expansion to all degrees of freedom", words::expansion(s.expansion).to_owned()),
        ("Weights of the energy equation", words::weights(s.weights).to_owned()),
        (
            "Criterion of the choice of sources",
            "angle between energies and columns, then chi-square and runs left out".to_owned(),
        ),
        ("Best single columns kept", keep),
        ("Most sources", s.max_sources.to_string()),
        ("Angle at which the selection stops", format!("{}°", format::significant(s.stop_angle_deg, 3))),
    ]
}

fn frequencies(p: &Project) -> String {
    let all = || p.runs.iter().filter(|run| run.enabled).map(crate::measurement::Run::frequency_hz);
    let (least, most) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
    match all().count() {
        0 => "none".to_owned(),
        1 => format::with_unit(least, "Hz"),
        n => format!("{n} from {} to {}", format::with_unit(least, "Hz"), format::with_unit(most, "Hz")),
    }
}

fn search(request: &Request) -> Vec<(&'static str, String)> {
    let seconds = |limit: Duration| format::with_unit(limit.as_secs_f64(), "s");
    vec![
        ("Time limit of the search", request.limit.map_or_else(|| "none".to_owned(), seconds)),
        ("Criterion of the search", "Bayesian information criterion and predictions of runs left out".to_owned()),
        ("Random numbers", format!("ChaCha8, seed 1, {DRAWS} draws of the bootstrap")),
    ]
}

fn program() -> Vec<(&'static str, String)> {
    let profile = if cfg!(debug_assertions) { "with debug assertions" } else { "release" };
    vec![("Program", format!("Dashpot {}", env!("CARGO_PKG_VERSION"))), ("Build", profile.to_owned())]
}

/// The project file and the files that it names, with what tells whether they are still the same.
fn files(page: &mut Page, origin: &Origin) {
    let mut rows = Vec::new();
    if let Some(path) = &origin.path {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        rows.push(row(name, path));
    }
    rows.extend(origin.file.named_files().into_iter().map(|name| row(name.to_owned(), &origin.folder.join(name))));
    if !rows.is_empty() {
        page.sentence(
            "The report was made from these files. A file is the same where its SHA-256 is (sha256sum FILE).",
        );
        page.table("Files", &["File", "Bytes|", "SHA-256"], &rows);
    }
}

fn row(name: String, path: &Path) -> Vec<String> {
    match fingerprint(path) {
        Ok((size, hash)) => vec![name, size.to_string(), hash],
        Err(error) => vec![name, String::new(), format!("cannot be read ({error})")],
    }
}

/// Size in bytes and SHA-256 of a file, in hexadecimal digits.
fn fingerprint(path: &Path) -> io::Result<(u64, String)> {
    let mut file = File::open(path)?;
    let (mut hash, mut size, mut buffer) = (Sha256::new(), 0, vec![0; 1 << 16]);
    loop {
        let read = file.read(&mut buffer)?;
        if read == 0 {
            break;
        }
        hash.update(&buffer[..read]);
        size += read as u64;
    }
    Ok((size, hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::fingerprint;

    /// FIPS 180-4: the digests of the empty message and of "abc", and of a million letters `a`.
    #[test]
    fn the_hash_is_that_of_the_standard() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x");
        let expect = |bytes: &[u8], digest: &str| {
            std::fs::write(&path, bytes).unwrap();
            assert_eq!(fingerprint(&path).unwrap(), (bytes.len() as u64, digest.to_owned()));
        };
        expect(b"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        expect(b"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        expect(&vec![b'a'; 1_000_000], "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    }
}

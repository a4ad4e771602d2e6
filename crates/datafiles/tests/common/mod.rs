//! The corpus, and reading all of a file.

use dashpot_datafiles::{Error, open};
use std::path::{Path, PathBuf};

/// Files of the corpus, in the order of their names.
pub(crate) fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end != "json"));
    files.sort();
    files
}

/// Opens a file and reads every channel and abscissa of it; what is read must be what was listed.
pub(crate) fn read_all(path: &Path) -> Result<usize, Error> {
    let file = open(path)?;
    let mut read = 0;
    for (s, set) in file.contents().sets.iter().enumerate() {
        for (c, channel) in set.channels.iter().enumerate() {
            if let Ok(values) = file.read(s, c) {
                assert_eq!(values.len() as u64, channel.count, "{}: {}", path.display(), channel.name);
                read += 1;
            }
            let _ = file.axis(s, c);
        }
    }
    Ok(read)
}

/// One line that names the file and says more than that.
pub(crate) fn check(error: &Error) {
    let text = error.to_string();
    assert!(!text.contains('\n') && text.len() > error.file.len() + 20, "{text}");
    assert!(text.starts_with(&error.file), "{text}");
}

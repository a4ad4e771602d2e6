//! What is left of a program that broke down: a report with the last commands and where it happened, beside the list of
//! recent files; the next start says so. No data of the user are written.

use super::app::App;
use crate::session::recent::Recent;
use crate::session::save::autosave_path;
use std::backtrace::Backtrace;
use std::collections::VecDeque;
use std::fmt::Write as _;
use std::panic::PanicHookInfo;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Commands that are kept.
const KEPT: usize = 40;
/// Name of a report that was not told yet, and of the last that was.
const NEW: &str = "crash-new.txt";
const TOLD: &str = "crash.txt";

static LAST: Mutex<VecDeque<String>> = Mutex::new(VecDeque::new());

/// Remembers what was asked for: its kind, never its data.
pub(crate) fn remember(what: &str) {
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if last.len() == KEPT {
        last.pop_front();
    }
    last.push_back(what.to_owned());
}

/// From now on a panic of the thread that draws leaves a report in `folder`. Panics of jobs are told in the window, which
/// goes on.
pub fn watch(folder: PathBuf) {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        usual(info);
        if std::thread::current().name() == Some("main") {
            let text = report(info, &Backtrace::force_capture());
            // There is nobody left to tell that it cannot be written.
            #[allow(clippy::disallowed_methods, reason = "a panic is no time for an atomic write")]
            let _ = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(folder.join(NEW), text));
        }
    }));
}

fn report(info: &PanicHookInfo<'_>, trace: &Backtrace) -> String {
    let place = info.location().map_or_else(|| "an unknown place".to_owned(), ToString::to_string);
    let message = info.payload_as_str().unwrap_or("no message");
    // A lock that the panic itself holds must not hold up the report.
    let last = LAST.try_lock().map(|l| l.iter().cloned().collect::<Vec<_>>()).unwrap_or_default();
    text(&place, message, &last, &trace.to_string())
}

fn text(place: &str, message: &str, last: &[String], trace: &str) -> String {
    let mut text =
        format!("dashpot {}\n{message}\nat {place}\n\nlast commands, newest last\n", env!("CARGO_PKG_VERSION"));
    for command in last {
        let _ = writeln!(text, "  {command}");
    }
    let _ = write!(text, "\n{trace}");
    text
}

/// The report of the last start, where it broke down; told once.
pub(crate) fn left_behind(folder: &Path) -> Option<PathBuf> {
    let told = folder.join(TOLD);
    std::fs::rename(folder.join(NEW), &told).ok()?;
    Some(told)
}

impl App {
    /// Says that the last start broke down, where it did, and offers the project that was open then where unsaved changes of it
    /// were kept.
    pub fn tell_of_crash(&mut self, folder: &Path) {
        let Some(report) = left_behind(folder) else { return };
        let last = self.recent.as_ref().and_then(|recent: &Recent| recent.files().first().cloned());
        let kept = last.filter(|file| autosave_path(file).is_file());
        let what_next = match &kept {
            Some(_) => "Unsaved changes were kept: Restore opens the project with them.",
            None => "Nothing was left unsaved.",
        };
        self.offer(
            format!("Dashpot broke down last time; what led to it is in {}. {what_next}", report.display()),
            kept,
        );
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "tests")]
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{KEPT, LAST, left_behind, remember, text};

    #[test]
    fn a_report_names_place_message_and_the_last_commands() {
        (0..2 * KEPT).for_each(|k| remember(&format!("command {k}")));
        assert_eq!(LAST.lock().unwrap().len(), KEPT);
        let said = text("src/a.rs:1:2", "index out of bounds", &["Undo".to_owned()], "0: main");
        assert!(
            said.contains("index out of bounds\nat src/a.rs:1:2")
                && said.contains("  Undo\n")
                && said.ends_with("0: main")
        );
    }

    #[test]
    fn a_report_is_told_once() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(left_behind(folder.path()), None);
        std::fs::write(folder.path().join("crash-new.txt"), "x").unwrap();
        assert_eq!(left_behind(folder.path()), Some(folder.path().join("crash.txt")));
        assert_eq!(left_behind(folder.path()), None);
    }
}

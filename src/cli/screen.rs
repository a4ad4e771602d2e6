//! What asks for the window or for a picture of it: read here like every command, done by the program that has a window.

use clap::Args;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// A window, which the command line itself does not know.
pub trait Screen {
    /// Opens it and returns when it is closed.
    ///
    /// # Errors
    /// One line that says what is wrong and how to mend it.
    fn open(&self, asked: &Window) -> Result<(), String>;

    /// Draws a stage without a display.
    ///
    /// # Errors
    /// One line that says what is wrong and how to mend it.
    fn picture(&self, asked: &Picture) -> Result<(), String>;
}

/// What is to be open in the window.
#[derive(Debug, Args)]
pub struct Window {
    /// Project file, or a file of measurements; without it, the start screen
    pub file: Option<PathBuf>,
    /// Writes what the window shows once everything has settled, says how long the first frame took, and closes
    #[arg(long, value_name = "PNG", hide = true)]
    pub photograph: Option<PathBuf>,
}

/// What is to be drawn.
#[derive(Debug, Args)]
pub struct Picture {
    /// Project file, or a file of measurements; without it, the start screen
    pub file: Option<PathBuf>,
    /// Stage: start, measure, structure, pattern, select, result or explain
    #[arg(long, default_value = "measure")]
    pub stage: String,
    /// PNG file to write
    #[arg(long)]
    pub out: PathBuf,
    /// Width x height in pixels
    #[arg(long, default_value = "1600x1000", value_parser = size)]
    pub size: [u32; 2],
    /// Theme
    #[arg(long, default_value = "light", value_parser = ["light", "dark"])]
    pub theme: String,
    /// Pane that is to be in front, such as bode, nyquist, hysteresis, record or parameters; matrix is drawn in space; time,
    /// spectrum, spectrogram and amplitude are those of a record in the stage explain
    #[arg(long)]
    pub pane: Option<String>,
    /// Folder that takes every plot on the screen as SVG and PNG
    #[arg(long)]
    pub plots: Option<PathBuf>,
}

/// The arguments with the command `window` where they have none and name a file to open, or nothing.
pub(super) fn with_command(arguments: Vec<OsString>) -> Vec<OsString> {
    let opens = arguments.get(1).is_none_or(|first| is_project(first) || is_file(first) || first == "--photograph");
    if !opens {
        return arguments;
    }
    let mut all = arguments;
    all.insert(all.len().min(1), "window".into());
    all
}

/// Whether an argument is the name of a file that is there, and no command.
fn is_file(argument: &OsStr) -> bool {
    let path = Path::new(argument);
    path.extension().is_some() && path.is_file()
}

fn is_project(argument: &OsStr) -> bool {
    Path::new(argument).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let fault = || "write width x height in pixels, from 640x480 to 8000x8000, such as 1600x1000".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(fault)?;
    let parse = |t: &str| t.parse::<u32>().map_err(|_| fault());
    let [width, height] = [parse(width)?, parse(height)?];
    let fits = (640..=8000).contains(&width) && (480..=8000).contains(&height);
    if fits { Ok([width, height]) } else { Err(fault()) }
}

#[cfg(test)]
mod tests {
    use super::{size, with_command};
    use std::ffi::OsString;

    #[test]
    fn sizes_are_read_or_refused_in_one_line() {
        assert_eq!(size("1600x1000"), Ok([1600, 1000]));
        for bad in ["1600", "0x10", "x", "99999x99999", "-1x700"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_file_or_nothing_opens_the_window() {
        let with = |words: &[&str]| {
            let words: Vec<OsString> = words.iter().map(Into::into).collect();
            with_command(words).into_iter().map(|w| w.into_string().unwrap_or_default()).collect::<Vec<_>>()
        };
        assert_eq!(with(&["dashpot"]), ["dashpot", "window"]);
        assert_eq!(with(&["dashpot", "a.TOML"]), ["dashpot", "window", "a.TOML"]);
        assert_eq!(with(&["dashpot", "Cargo.lock"]), ["dashpot", "window", "Cargo.lock"]);
        assert_eq!(with(&["dashpot", "identify", "a.toml"]), ["dashpot", "identify", "a.toml"]);
        assert_eq!(with(&["dashpot", "identfy"]), ["dashpot", "identfy"]);
    }
}

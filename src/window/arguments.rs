//! Arguments that ask for the window or for a picture of it.

use super::picture::{Picture, picture};
use super::view::Stage;
use clap::Parser;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Opens the window.
#[derive(Debug, Parser)]
#[command(name = "dashpot")]
struct WindowArguments {
    /// Project file, or a file of measurements; without it, the start screen.
    file: Option<PathBuf>,
    /// Writes what the window shows once everything has settled, says how long the first frame took, and closes.
    #[arg(long, value_name = "PNG", hide = true)]
    photograph: Option<PathBuf>,
}

/// Draws a stage of the window without a display.
#[derive(Debug, Parser)]
#[command(name = "dashpot picture")]
struct PictureArguments {
    /// Project file, or a file of measurements; without it, the start screen.
    file: Option<PathBuf>,
    /// Stage: start, measure, structure, pattern, select, result or explain.
    #[arg(long, default_value = "measure")]
    stage: String,
    /// PNG file to write.
    #[arg(long)]
    out: PathBuf,
    /// Width x height in pixels.
    #[arg(long, default_value = "1600x1000", value_parser = size)]
    size: [u32; 2],
    /// Theme: light or dark.
    #[arg(long, default_value = "light", value_parser = ["light", "dark"])]
    theme: String,
    /// Pane that is to be in front, such as bode, nyquist, hysteresis, record or parameters; matrix is drawn in space; time,
    /// spectrum, spectrogram and amplitude are those of a record in the stage explain.
    #[arg(long)]
    pane: Option<String>,
    /// Folder that takes every plot on the screen as SVG and PNG.
    #[arg(long)]
    plots: Option<PathBuf>,
}

/// Does what the arguments ask for, where they ask for the window: none, a project file or `picture`.
pub fn run(arguments: &[OsString]) -> Option<ExitCode> {
    match arguments.get(1..).unwrap_or_default() {
        [] => Some(code(super::open(None, None))),
        [first, ..] if first == "picture" => {
            Some(PictureArguments::try_parse_from(&arguments[1..]).map_or_else(|e| usage(&e), |a| code(draw(a))))
        }
        [first, ..] if is_project(first) || is_file(first) || first == "--photograph" => {
            let opened = |a: WindowArguments| code(super::open(a.file, a.photograph));
            Some(WindowArguments::try_parse_from(arguments).map_or_else(|e| usage(&e), opened))
        }
        _ => None,
    }
}

fn usage(error: &clap::Error) -> ExitCode {
    let _ = error.print();
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// Whether an argument is the name of a file that is there, and no command.
fn is_file(argument: &OsString) -> bool {
    let path = std::path::Path::new(argument);
    path.extension().is_some() && path.is_file()
}

fn is_project(argument: &OsString) -> bool {
    PathBuf::from(argument).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

fn draw(arguments: PictureArguments) -> Result<(), String> {
    let stage = match arguments.stage.as_str() {
        "start" => Stage::Measure,
        name => Stage::from_name(name).ok_or_else(|| {
            let known: Vec<String> = Stage::ALL.iter().map(|s| s.label().to_lowercase()).collect();
            format!("--stage {name}: there is no such stage; choose start, {}", known.join(", "))
        })?,
    };
    picture(&Picture {
        file: arguments.file.filter(|_| arguments.stage != "start"),
        stage,
        pane: arguments.pane,
        size: arguments.size,
        dark: arguments.theme == "dark",
        out: arguments.out,
        plots: arguments.plots,
    })
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let fault = || "write width x height in pixels, from 640x480 to 8000x8000, such as 1600x1000".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(fault)?;
    let parse = |t: &str| t.parse::<u32>().map_err(|_| fault());
    let [width, height] = [parse(width)?, parse(height)?];
    let fits = (640..=8000).contains(&width) && (480..=8000).contains(&height);
    if fits { Ok([width, height]) } else { Err(fault()) }
}

fn code(result: Result<(), String>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::size;

    #[test]
    fn sizes_are_read_or_refused_in_one_line() {
        assert_eq!(size("1600x1000"), Ok([1600, 1000]));
        for bad in ["1600", "0x10", "x", "99999x99999", "-1x700"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}

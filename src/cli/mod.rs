//! The command line: arguments in, a table or one JSON document out.
//!
//! Exit status: 0 done, 1 the input is at fault (one line on standard error), 2 wrong usage.

mod argument_values;
mod arguments;
mod arguments_import;
mod arguments_report;
mod build;
mod change;
mod channel_faults;
mod compare;
mod contents;
mod convert;
mod corrected;
mod diagnose;
mod export;
mod identified;
mod identify;
mod identify_json;
mod identify_table;
mod import;
mod incompleteness;
mod manual;
mod mended_first;
mod methods;
mod moving_base;
mod play;
mod plot;
mod plot_kinds;
mod plot_records;
mod recorded_base;
mod records;
mod reduction;
mod remarks;
mod report;
mod run_differences;
mod run_faults;
mod run_flags;
mod screen;
mod simulate;
mod simulate_component;
mod simulate_frf;
mod simulate_write;
mod source_json;
mod table;

pub use manual::manual;
pub use screen::{Picture, Screen, Window};

use arguments::{Arguments, Command};
use clap::Parser;
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

/// Runs the program on its arguments, the first of which is its name; with a window a file or nothing opens it.
pub fn run(arguments: impl IntoIterator<Item = OsString>, screen: Option<&dyn Screen>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let arguments = if screen.is_some() { screen::with_command(arguments) } else { arguments };
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to standard output with status 0, wrong usage to standard error with status 2.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match execute(&arguments.command, screen) {
        Ok(text) => print(&text),
        Err(error) => {
            eprintln!("{}", one_line(&error));
            ExitCode::from(1)
        }
    }
}

/// What the program would print for these arguments, or the one line of its error: for programs that ask many times.
pub fn answer(arguments: impl IntoIterator<Item = OsString>) -> Result<String, String> {
    let arguments = Arguments::try_parse_from(arguments).map_err(|error| error.to_string())?;
    execute(&arguments.command, None).map_err(|error| one_line(&error))
}

fn execute(command: &Command, screen: Option<&dyn Screen>) -> anyhow::Result<String> {
    let window = || screen.ok_or("there is no window here: it comes with the feature `window` of the program");
    match command {
        Command::Identify(arguments) => identify::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Change(arguments) => change::run(arguments),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Amplitude(arguments) => records::amplitude(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Methods(arguments) if arguments.incompleteness => incompleteness::run(arguments),
        Command::Methods(arguments) => methods::run(arguments),
        Command::Convert(arguments) => convert::run(arguments),
        Command::Contents(arguments) => contents::run(arguments),
        Command::Import(arguments) => import::run(arguments),
        Command::Build(arguments) => build::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Plot(arguments) => plot::run(arguments),
        Command::Run(arguments) => play::run(arguments),
        Command::Window(asked) => done(window().map_err(str::to_owned).and_then(|screen| screen.open(asked))),
        Command::Picture(asked) => done(window().map_err(str::to_owned).and_then(|screen| screen.picture(asked))),
    }
}

/// What is said of what the window did: nothing, or its error.
fn done(result: Result<(), String>) -> anyhow::Result<String> {
    result.map(|()| String::new()).map_err(anyhow::Error::msg)
}

/// Prints to standard output; a reader that has left early, such as `head`, is no failure.
fn print(text: &str) -> ExitCode {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("standard output cannot be written: {error}");
            ExitCode::from(1)
        }
    }
}

/// The whole chain of an error in one line.
fn one_line(error: &anyhow::Error) -> String {
    let mut parts: Vec<String> = Vec::new();
    for cause in error.chain() {
        let text = cause.to_string();
        // Transparent errors repeat their cause's words.
        if parts.last().is_none_or(|last| !last.ends_with(&text)) {
            parts.push(text);
        }
    }
    parts.join(": ").split_whitespace().collect::<Vec<_>>().join(" ")
}

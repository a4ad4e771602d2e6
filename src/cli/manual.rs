//! The page of all commands, made of what the parser knows: `docs/command-line.md`.

use super::arguments::Arguments;
use clap::{Arg, Command, CommandFactory};
use std::fmt::Write as _;

const HEAD: &str = "# Command line\n\n\
    Made of the program's own parser by `UPDATE_DOCS=1 cargo test --no-default-features --test docs`; `dashpot COMMAND --help` says the\n\
    same. Results go to standard output, as a table or with `--json` as one JSON document ([its keys](formats.md)); one line that says\n\
    what is wrong goes to standard error. Exit status: 0 done, 1 the input is at fault, 2 wrong usage.\n\n\
    `dashpot` alone or with a file opens the window, where the program was built with it.\n";

/// All commands with their arguments, as Markdown.
pub fn manual() -> String {
    let mut program = Arguments::command();
    program.build();
    let mut page = HEAD.to_owned();
    for command in program.get_subcommands().filter(|c| c.get_name() != "help") {
        section(&mut page, command);
    }
    page
}

fn section(page: &mut String, command: &Command) {
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let _ = write!(page, "\n## {}\n\n{about}.\n\n", command.get_name());
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").split_whitespace().collect::<Vec<_>>().join(" ");
    let _ = write!(page, "```sh\n{usage}\n```\n\n| | |\n|---|---|\n");
    let mut arguments: Vec<&Arg> =
        command.get_arguments().filter(|a| !a.is_hide_set() && a.get_id() != "help").collect();
    arguments.sort_by_key(|a| !a.is_positional());
    for argument in arguments {
        let _ = writeln!(page, "| `{}` | {} |", written(argument), said(argument));
    }
}

/// `--out <DIR>`, `FILE`, `--json`.
fn written(argument: &Arg) -> String {
    let takes = argument.get_action().takes_values();
    let names = argument.get_value_names().unwrap_or_default();
    let value = names.iter().map(|n| n.as_str().to_uppercase()).collect::<Vec<_>>().join(" ");
    let many = if takes && argument.get_num_args().is_some_and(|n| n.max_values() > 1) { "..." } else { "" };
    match (argument.get_long(), takes) {
        (None, _) => format!("{value}{many}"),
        (Some(long), true) => format!("--{long} {value}{many}"),
        (Some(long), false) => format!("--{long}"),
    }
}

/// What it does, the values it takes and the one that it has by itself.
fn said(argument: &Arg) -> String {
    let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
    let mut text = help.replace('\n', " ").replace('|', "\\|");
    if argument.get_action().takes_values() {
        let values: Vec<String> =
            argument.get_possible_values().iter().map(|v| format!("`{}`", v.get_name())).collect();
        if !values.is_empty() {
            let _ = write!(text, ": {}", values.join(", "));
        }
        let defaults: Vec<_> = argument.get_default_values().iter().map(|v| v.to_string_lossy()).collect();
        if !defaults.is_empty() {
            let _ = write!(text, " (default: {})", defaults.join(", "));
        }
    }
    text
}

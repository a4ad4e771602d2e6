//! The one table of commands: label, tooltip and keys once; menus, buttons and keys read it.

use crate::window::frame::menu_bar;
use egui::{Key, KeyboardShortcut, Modifiers};

/// What a menu entry, a button or a key can ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the table below says what each does")]
pub enum Command {
    Open,
    Import,
    Save,
    SaveAs,
    Report,
    Close,
    Quit,
    Undo,
    Redo,
    RemoveSelected,
    ClearCandidates,
    Cancel,
    Theme,
    LessMotion,
    Shape,
    Animate,
    Measure,
    Structure,
    Pattern,
    Select,
    Result,
    Explain,
    StepBack,
    StepOn,
    StepEnd,
    PreviousRun,
    NextRun,
    ResetLayout,
    Messages,
    Menus,
    Tour,
    Laws,
    Keys,
    About,
}

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// What is asked for.
    pub command: Command,
    /// Label in menus; ends in an ellipsis where it asks for more.
    pub label: &'static str,
    /// What it does, in one sentence.
    pub tooltip: &'static str,
    /// Keys.
    pub keys: Option<KeyboardShortcut>,
}

#[expect(clippy::unnecessary_wraps, reason = "a command may have no keys")]
const fn ctrl(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

#[expect(clippy::unnecessary_wraps, reason = "a command may have no keys")]
const fn ctrl_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

#[expect(clippy::unnecessary_wraps, reason = "a command may have no keys")]
const fn plain(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn entry(command: Command, label: &'static str, tooltip: &'static str, keys: Option<KeyboardShortcut>) -> Entry {
    Entry { command, label, tooltip, keys }
}

/// All commands.
pub const TABLE: [Entry; 34] = [
    entry(Command::Open, "Open…", "Opens a project file.", ctrl(Key::O)),
    entry(
        Command::Import,
        "Import measurements…",
        "Shows what is in measurement files and makes a project of them, or adds them to this one.",
        ctrl(Key::I),
    ),
    entry(Command::Save, "Save", "Writes the project to its file.", ctrl(Key::S)),
    entry(
        Command::SaveAs,
        "Save as…",
        "Writes the project under another name and goes on with that.",
        ctrl_shift(Key::S),
    ),
    entry(Command::Report, "Report…", "Writes all results with their plots into one PDF or HTML file.", ctrl(Key::R)),
    entry(Command::Close, "Close project", "Goes back to the start screen.", ctrl(Key::W)),
    entry(Command::Quit, "Quit", "Closes the window.", ctrl(Key::Q)),
    entry(Command::Undo, "Undo", "Takes back the last edit.", ctrl(Key::Z)),
    entry(Command::Redo, "Redo", "Repeats the edit that was taken back.", ctrl_shift(Key::Z)),
    entry(Command::RemoveSelected, "Remove source", "Takes the selected source away.", plain(Key::Delete)),
    entry(
        Command::ClearCandidates,
        "Clear candidates",
        "Takes all candidates away; known and forced sources stay.",
        None,
    ),
    entry(Command::Cancel, "Cancel", "Gives up what is being computed.", ctrl(Key::Period)),
    entry(Command::Theme, "Dark theme", "Changes between light and dark.", ctrl(Key::D)),
    entry(
        Command::LessMotion,
        "Less motion",
        "Leaves out transitions and stops the schematic; on from the start where the desktop asks for it.",
        None,
    ),
    entry(Command::Shape, "Deflect the schematic", "Shows the shape of the selected run or mode.", plain(Key::S)),
    entry(Command::Animate, "Animate", "Moves the shape on the schematic.", plain(Key::Space)),
    entry(Command::Measure, "Measure", "Records, their fits and what is wrong with them.", ctrl(Key::Num1)),
    entry(Command::Structure, "Structure", "Natural frequencies and mode shapes.", ctrl(Key::Num2)),
    entry(Command::Pattern, "Pattern", "Draws where energy may be lost.", ctrl(Key::Num3)),
    entry(Command::Select, "Select", "Which sources, step by step.", ctrl(Key::Num4)),
    entry(Command::Result, "Result", "Damping matrix, energy, frequency responses.", ctrl(Key::Num5)),
    entry(Command::Explain, "Explain", "Where the model fails, and what it lacks.", ctrl(Key::Num6)),
    entry(Command::StepBack, "Step back", "Looks at the set with one source less.", plain(Key::ArrowLeft)),
    entry(Command::StepOn, "Step", "Looks at the set with one source more.", plain(Key::ArrowRight)),
    entry(Command::StepEnd, "To the best set", "Looks at the accepted set again.", plain(Key::End)),
    entry(Command::PreviousRun, "Previous run", "Selects the run above.", plain(Key::ArrowUp)),
    entry(Command::NextRun, "Next run", "Selects the run below.", plain(Key::ArrowDown)),
    entry(Command::ResetLayout, "Reset layout", "Puts the panes of this stage back to where they were at first.", None),
    entry(Command::Messages, "Messages", "Lists all that was said.", ctrl(Key::M)),
    entry(
        Command::Menus,
        "Menus",
        "Moves the focus to the menus: arrows walk through them, Enter opens and chooses, Escape closes.",
        plain(Key::F10),
    ),
    entry(Command::Tour, "Tour", "Ten steps through the program on a sample.", None),
    entry(Command::Laws, "Laws of damping", "What each law looks like on a small structure.", ctrl(Key::L)),
    entry(Command::Keys, "Keys", "Lists all keys.", plain(Key::F1)),
    entry(Command::About, "About Dashpot", "What the program is and what it rests on.", None),
];

impl Command {
    /// The row of a command.
    pub fn entry(self) -> &'static Entry {
        // Every command has a row; a test holds it.
        TABLE.iter().find(|e| e.command == self).unwrap_or(&TABLE[0])
    }
}

/// Commands whose keys were pressed in this frame; each press counts once.
pub fn pressed(ctx: &egui::Context) -> Vec<Command> {
    let typing = ctx.egui_wants_keyboard_input();
    // What has the focus is clicked by the space bar, as everywhere.
    let focused = ctx.memory(|m| m.focused().is_some());
    // Letters and arrows belong to a menu that is open.
    let in_menus = menu_bar::has_keys(ctx);
    let is_taken = |k: &KeyboardShortcut| {
        let clicks = focused && k.logical_key == Key::Space;
        let plain = !k.modifiers.any();
        clicks || (plain && (typing || (in_menus && !is_function(k.logical_key))))
    };
    let wanted = |e: &&Entry| e.keys.is_some_and(|k| !is_taken(&k));
    // Longer combinations first, so that Ctrl+Shift+Z is not taken for Ctrl+Z.
    let mut rows: Vec<&Entry> = TABLE.iter().filter(wanted).collect();
    rows.sort_by_key(|e| e.keys.map(|k| !k.modifiers.shift));
    rows.iter()
        .filter(|e| e.keys.is_some_and(|k| ctx.input_mut(|i| i.consume_shortcut(&k))))
        .map(|e| e.command)
        .collect()
}

/// Whether a key writes nothing and walks nowhere.
fn is_function(key: Key) -> bool {
    matches!(key, Key::F1 | Key::F10)
}

#[cfg(test)]
mod tests {
    use super::{Command, TABLE};
    use std::collections::HashSet;

    #[test]
    fn every_command_stands_once_and_no_keys_stand_twice() {
        let commands: HashSet<Command> = TABLE.iter().map(|e| e.command).collect();
        assert_eq!(commands.len(), TABLE.len());
        let keys: Vec<_> = TABLE.iter().filter_map(|e| e.keys).collect();
        for (i, a) in keys.iter().enumerate() {
            assert!(!keys[i + 1..].contains(a), "{a:?} stands twice");
        }
        for entry in &TABLE {
            assert_eq!(entry.command.entry().label, entry.label);
            assert!(entry.tooltip.ends_with('.'), "{}", entry.tooltip);
        }
    }
}

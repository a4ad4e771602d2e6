//! A file is chosen inside the window, where the desktop has no dialogs of its own.

use crate::window::app::ask::Ask;
use crate::window::appearance::theme::{size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::files::{self, Pick};
use crate::window::language::{t, tr};
use egui::{Button, Context, Frame, Id, Label, Margin, Modal, RichText, ScrollArea, TextEdit, Ui};
use std::path::{Path, PathBuf};

/// Size of the list of files, points.
const LIST: [f32; 2] = [520.0, 280.0];

/// A dialog that is open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choosing {
    pick: Pick,
    folder: PathBuf,
    name: String,
    entries: Vec<Entry>,
    /// Why the last choice was none.
    fault: Option<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Entry {
    name: String,
    is_folder: bool,
}

impl Choosing {
    /// A dialog that starts in a folder.
    pub fn new(pick: Pick, folder: PathBuf, name: String) -> Self {
        let mut dialog = Self { pick, folder, name, entries: Vec::new(), fault: None };
        dialog.list();
        dialog
    }

    /// Reads the folder: folders first, then files that may be meant, by their names.
    fn list(&mut self) {
        let endings = files::endings(self.pick);
        let entry = |e: std::fs::DirEntry| {
            let name = e.file_name().into_string().ok()?;
            let is_folder = e.path().is_dir();
            let ending = Path::new(&name).extension().and_then(|x| x.to_str()).map(str::to_lowercase);
            let meant = is_folder || endings.is_empty() || ending.is_some_and(|x| endings.contains(&x.as_str()));
            (meant && !name.starts_with('.')).then_some(Entry { name, is_folder })
        };
        match std::fs::read_dir(&self.folder) {
            Ok(all) => {
                self.entries = all.filter_map(Result::ok).filter_map(entry).collect();
                self.entries.sort_by_key(|e| (!e.is_folder, e.name.to_lowercase()));
                self.fault = None;
            }
            Err(error) => self.fault = Some(format!("{}: {error}; choose another folder", self.folder.display())),
        }
    }

    fn go(&mut self, folder: PathBuf) {
        self.folder = folder;
        self.list();
    }

    /// The file that is named, where it can be taken.
    fn chosen(&mut self) -> Option<PathBuf> {
        let path = self.folder.join(self.name.trim());
        if self.name.trim().is_empty() {
            self.fault = Some("Name a file, or click one in the list.".to_owned());
        } else if path.is_dir() {
            self.name.clear();
            self.go(path);
        } else if !self.pick.writes() && !path.is_file() {
            self.fault = Some(format!("{}: there is no such file", path.display()));
        } else {
            return Some(path);
        }
        None
    }
}

/// Shows the dialog while one is open.
pub(crate) fn show(ctx: &Context, choosing: &mut Option<Choosing>, asks: &mut Vec<Ask>) {
    let Some(dialog) = choosing else { return };
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
    let mut ended = false;
    let modal = Modal::new(Id::unique("choose a file")).frame(frame).show(ctx, |ui| {
        ui.set_width(LIST[0]);
        ui.label(RichText::new(tr(files::title(dialog.pick))).size(size::HEADING));
        folder(ui, dialog);
        entries(ui, dialog);
        let label = ui.hint("File name");
        let field = ui.add(TextEdit::singleline(&mut dialog.name).desired_width(f32::INFINITY)).labelled_by(label.id);
        let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if let Some(fault) = &dialog.fault {
            ui.colored_label(ui.palette().error, tr(fault));
        }
        ui.add_space(space::S);
        ui.horizontal(|ui| {
            if (ui.primary("Choose").clicked() || entered)
                && let Some(path) = dialog.chosen()
            {
                asks.push(Ask::Picked(dialog.pick, vec![path]));
                ended = true;
            }
            if ui.button(t!("Cancel")).clicked() {
                asks.push(Ask::Picked(dialog.pick, Vec::new()));
                ended = true;
            }
        });
    });
    if modal.should_close() && !ended {
        asks.push(Ask::Picked(dialog.pick, Vec::new()));
    }
    if ended || modal.should_close() {
        *choosing = None;
    }
}

fn folder(ui: &mut Ui, dialog: &mut Choosing) {
    ui.horizontal(|ui| {
        let parent = dialog.folder.parent().map(Path::to_path_buf);
        if ui.add_enabled(parent.is_some(), Button::new(t!("Up"))).on_hover_text(t!("The folder above.")).clicked()
            && let Some(parent) = parent
        {
            dialog.go(parent);
        }
        ui.add(Label::new(dialog.folder.display().to_string()).truncate());
    });
}

fn entries(ui: &mut Ui, dialog: &mut Choosing) {
    let mut into = None;
    ScrollArea::vertical().max_height(LIST[1]).min_scrolled_height(LIST[1]).auto_shrink(false).show(ui, |ui| {
        for entry in &dialog.entries {
            let text = if entry.is_folder { format!("{}/", entry.name) } else { entry.name.clone() };
            if ui.selectable_label(!entry.is_folder && entry.name == dialog.name, tr(text)).clicked() {
                if entry.is_folder {
                    into = Some(dialog.folder.join(&entry.name));
                } else {
                    dialog.name.clone_from(&entry.name);
                }
            }
        }
        if dialog.entries.is_empty() {
            ui.hint("No folders and no files of that kind here.");
        }
    });
    if let Some(folder) = into {
        dialog.go(folder);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "tests")]
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::Choosing;
    use crate::window::files::Pick;

    #[test]
    fn folders_come_first_and_only_what_can_be_meant_is_listed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.toml", "a.pdf", ".hidden.toml"] {
            std::fs::write(folder.path().join(name), "x").unwrap();
        }
        std::fs::create_dir(folder.path().join("z")).unwrap();
        let mut dialog = Choosing::new(Pick::Open, folder.path().to_owned(), String::new());
        let names: Vec<&str> = dialog.entries.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(names, ["z", "b.toml"]);
        assert_eq!(dialog.chosen(), None);
        dialog.name = "gone.toml".to_owned();
        assert_eq!(dialog.chosen(), None);
        assert!(dialog.fault.as_ref().unwrap().contains("there is no such file"));
        dialog.name = "b.toml".to_owned();
        assert_eq!(dialog.chosen(), Some(folder.path().join("b.toml")));
        let mut dialog = Choosing::new(Pick::SaveAs, folder.path().to_owned(), "project.toml".to_owned());
        assert_eq!(dialog.chosen(), Some(folder.path().join("project.toml")));
        dialog.name = "z".to_owned();
        assert_eq!(dialog.chosen(), None);
        assert!(dialog.folder.ends_with("z"), "a folder is entered");
    }
}

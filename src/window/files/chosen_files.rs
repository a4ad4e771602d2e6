//! Files that the user chooses: by a dialog of the desktop or of the window, and what is done with them.

use crate::session::states::Against;
use crate::window::app::App;
use crate::window::app::leaving::Leave;
use crate::window::files::import::is_project;
use crate::window::files::{self, Pick};
use crate::window::frame::choose::Choosing;
use egui::Context;
use std::path::{Path, PathBuf};
use std::time::Duration;

impl App {
    /// Does what files were chosen for.
    pub(crate) fn picked(&mut self, ctx: &Context, pick: Pick, paths: Vec<PathBuf>) {
        let Some(first) = paths.first().cloned() else {
            if let Pick::Plot(_) = pick {
                self.exports.give_up();
            }
            return;
        };
        match pick {
            Pick::Open if is_project(&first) => self.leave(ctx, Leave::Open(first)),
            Pick::Open | Pick::Import => self.import(ctx, &paths),
            Pick::Model => self.lay_under(ctx, paths),
            Pick::SaveAs => self.save_as(&first),
            Pick::Export(format) => self.export(ctx, format, first),
            Pick::Report => self.report(ctx, first),
            Pick::Logo => {
                if let Some(choice) = &mut self.reporting {
                    choice.take_logo(first);
                }
            }
            Pick::Plot(_) => {
                let started = self.exports.write_to(ctx, first);
                self.note(started);
            }
            Pick::EarlierState => self.view.against = Some(Against::Project(first)),
        }
    }

    /// Saves under another name.
    pub(crate) fn save_as(&mut self, path: &Path) {
        let Some(document) = &mut self.document else { return };
        let saved = document.save_as(path);
        if let (Some(recent), Ok(())) = (&mut self.recent, &saved) {
            let kept = recent.add(path).map_err(|e| e.to_string());
            self.note(kept);
        }
        match saved {
            Ok(()) => self.say(format!("Saved as {}.", path.display())),
            Err(error) => self.fail(error),
        }
    }

    /// Shows a dialog of the desktop, or where it has none one of the window.
    pub(crate) fn pick(&mut self, ctx: &Context, pick: Pick) {
        self.pick_named(ctx, pick, files::proposal(pick));
    }

    /// The same with a proposal for the name of the file.
    fn pick_named(&mut self, ctx: &Context, pick: Pick, name: String) {
        if self.own_dialogs {
            let beside = self.document.as_ref().and_then(|d| d.session().path()?.parent().map(Path::to_path_buf));
            let folder = beside.filter(|f| f.is_dir()).or_else(|| std::env::current_dir().ok()).unwrap_or_default();
            self.choosing = Some(Choosing::new(pick, std::path::absolute(&folder).unwrap_or(folder), name));
            return;
        }
        let asked = self.jobs.pick(ctx, pick, name);
        self.note(asked);
    }

    /// Takes what a dialog of the desktop gave; one that was never shown is made up for in the window, from now on.
    pub fn closed(&mut self, ctx: &Context, pick: Pick, name: String, paths: Vec<PathBuf>, open: Duration) {
        if paths.is_empty() && open < files::SHOWN {
            self.own_dialogs = true;
            return self.pick_named(ctx, pick, name);
        }
        self.picked(ctx, pick, paths);
    }

    /// Asks where a plot is to be written, one plot at a time.
    pub(crate) fn ask_for_plot(&mut self, ctx: &Context) {
        if self.choosing.is_some() || self.jobs.is_asking() {
            return;
        }
        if let Some((kind, name)) = self.exports.wants_file() {
            self.pick_named(ctx, Pick::Plot(kind), name);
        }
    }
}

//! The window: reads the document, draws it, and turns gestures into edits. Holds no physics.

pub mod app;
pub mod appearance;
pub(crate) mod background;
pub mod crash;
pub mod document;
pub mod explained;
pub mod files;
pub mod frame;
pub mod headless;
pub mod importing;
pub mod language;
pub mod learn;
pub mod plots;
pub(crate) mod schematic;
pub(crate) mod solid;
pub mod stages;

pub use app::App;
pub use headless::photograph::Photograph;
pub use headless::picture::{Picture, picture};

use crate::session::recent::Recent;
use language::Language;
use std::path::PathBuf;

/// Opens the window, with a project or on the start screen, and returns when it is closed. With `photograph` it writes
/// what it shows there once everything has settled, and closes by itself.
///
/// # Errors
/// One line that says why no window could be opened.
pub fn open(file: Option<PathBuf>, photograph: Option<PathBuf>) -> Result<(), String> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("Dashpot")
        .with_app_id("dashpot")
        .with_icon(frame::icons::application())
        .with_inner_size([1440.0, 900.0])
        .with_min_inner_size([960.0, 640.0]);
    let persist_window = photograph.is_none();
    let options = eframe::NativeOptions { viewport, persist_window, ..eframe::NativeOptions::default() };
    let create = move |cc: &eframe::CreationContext<'_>| {
        appearance::theme::install(&cc.egui_ctx);
        let mut app = App::default();
        if let Some(desk) = cc.storage.and_then(|storage| eframe::get_value(storage, "desk")) {
            app.desk = desk;
        }
        app.view.limit_s = cc.storage.and_then(|storage| eframe::get_value(storage, "limit_s")).flatten();
        let less: Option<bool> = cc.storage.and_then(|storage| eframe::get_value(storage, "less_motion")).flatten();
        app.set_less_motion(&cc.egui_ctx, less.unwrap_or_else(appearance::motion::is_unwanted));
        let units = cc.storage.and_then(|storage| eframe::get_value(storage, "units"));
        crate::display::units::choose(units.unwrap_or_default());
        let language: Option<Language> =
            cc.storage.and_then(|storage| eframe::get_value(storage, "language")).flatten();
        // Photographs are in English, like all that is made without a user.
        if photograph.is_none() {
            language::choose(language.unwrap_or_else(Language::of_system));
        }
        app.recent = eframe::storage_dir("dashpot").map(|folder| Recent::load(&folder.join("recent.json")));
        if let Some(folder) = eframe::storage_dir("dashpot") {
            app.tell_of_crash(&folder);
            crash::watch(folder);
        }
        app.own_dialogs = !files::desktop_has_dialogs();
        app.photograph = photograph.map(Photograph::new);
        if let Some(file) = file {
            app.open(&cc.egui_ctx, file);
        }
        Ok(Box::new(app) as Box<dyn eframe::App>)
    };
    eframe::run_native("dashpot", options, Box::new(create)).map_err(|error| refusal(&error))
}

/// Why no window could be opened and what helps, in one sentence.
fn refusal(error: &eframe::Error) -> String {
    let text = error.to_string();
    match error {
        eframe::Error::Wgpu(_) => format!(
            "no window could be opened because there is no graphics adapter: install libvulkan1 and mesa-vulkan-drivers, which \
             hold one in software ({text})"
        ),
        _ => format!(
            "no window could be opened: {text}; the command line needs none, and `dashpot picture` draws without a display"
        ),
    }
}

//! The window: reads the document, draws it, and turns gestures into edits. Holds no physics.

pub mod app;
pub mod arguments;
pub mod commands;
pub mod derived;
pub mod document;
pub mod format;
pub mod forward;
pub mod frame;
pub mod offscreen;
pub mod photograph;
pub mod picture;
pub mod plots;
pub mod schematic;
pub mod solid;
pub mod stages;
pub mod theme;
pub mod view;
pub mod widgets;
pub mod words;

pub use app::App;
pub use photograph::Photograph;
pub use picture::{Picture, picture};

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
        .with_inner_size([1440.0, 900.0])
        .with_min_inner_size([960.0, 640.0]);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let create = move |cc: &eframe::CreationContext<'_>| {
        theme::install(&cc.egui_ctx);
        let mut app = App::default();
        app.photograph = photograph.map(Photograph::new);
        if let Some(file) = file {
            app.open(&cc.egui_ctx, file);
        }
        Ok(Box::new(app) as Box<dyn eframe::App>)
    };
    eframe::run_native("dashpot", options, Box::new(create))
        .map_err(|error| format!("no window could be opened: {error}; `dashpot picture` draws without a display"))
}

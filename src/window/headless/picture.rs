//! A stage drawn without a display, by the same code as the window, through wgpu.

use crate::window::app::App;
use crate::window::app::view::Stage;
use crate::window::appearance::theme;
use crate::window::frame::panes::Pane;
use crate::window::headless::offscreen::Offscreen;
use crate::window::plots::export;
use crate::window::stages::explain::look::RecordTab;
use egui::{Context, Theme};
use std::path::PathBuf;

/// What to draw.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Project; `None` draws the start screen.
    pub file: Option<PathBuf>,
    /// Stage.
    pub stage: Stage,
    /// Pane that is to be in front, by name; `matrix` shows the matrix as bars in space; at the stage Explain `time`, `spectrum`,
    /// `spectrogram` and `amplitude` show that plot of a record that is not steady.
    pub pane: Option<String>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Dark theme.
    pub dark: bool,
    /// PNG file to write.
    pub out: PathBuf,
    /// Folder that takes every plot on the screen as SVG and PNG.
    pub plots: Option<PathBuf>,
}

/// The stage of that name; `None` is the start screen.
///
/// # Errors
/// One line that names the stages there are.
pub fn stage(name: &str) -> Result<Option<Stage>, String> {
    if name == "start" {
        return Ok(None);
    }
    let known = || Stage::ALL.iter().map(|s| s.label().to_lowercase()).collect::<Vec<_>>().join(", ");
    let found = Stage::from_name(name);
    found.map(Some).ok_or_else(|| format!("--stage {name}: there is no such stage; choose start, {}", known()))
}

/// Draws a picture and writes it.
///
/// # Errors
/// One line that says what is wrong and how to mend it: the project, the adapter, the file.
pub fn picture(picture: &Picture) -> Result<(), String> {
    let ctx = Context::default();
    theme::install(&ctx);
    ctx.set_theme(if picture.dark { Theme::Dark } else { Theme::Light });
    let mut app = App::default();
    if let Some(file) = &picture.file {
        app.open(&ctx, file.clone());
        app.settle(&ctx)?;
    }
    app.view.stage = picture.stage;
    if let Some(name) = &picture.pane {
        app.view.matrix_in_space = name == "matrix";
        let tab = RecordTab::from_name(name).filter(|_| picture.stage == Stage::Explain);
        app.view.explain.record_tab = tab.unwrap_or_default();
        let pane = match (name.as_str(), tab) {
            ("matrix", _) => Pane::Matrix,
            (_, Some(_)) => Pane::Cell,
            _ => Pane::from_name(name)?,
        };
        app.desk.set_open(picture.stage, pane, true);
    }
    let [width, height] = picture.size;
    app.exports.folder.clone_from(&picture.plots);
    let offscreen = Offscreen::new(picture.size, 1.0)?;
    let mut frame = |ui: &mut egui::Ui| {
        app.frame(ui);
        app.running().is_some() || app.exports.busy()
    };
    let pixels = offscreen.settle(&ctx, &mut frame)?;
    if picture.plots.is_some() {
        for title in export::shown(&ctx) {
            export::want(&ctx, &title, export::Kind::Svg);
            export::want(&ctx, &title, export::Kind::Png);
        }
        offscreen.settle(&ctx, &mut frame)?;
        app.settle(&ctx)?;
    }
    let image = image::RgbaImage::from_raw(width, height, pixels).ok_or("the picture has the wrong size")?;
    image.save(&picture.out).map_err(|e| format!("{}: cannot be written ({e})", picture.out.display()))
}

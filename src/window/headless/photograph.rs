//! A photograph that the window takes of itself: for tests on a real display.

use egui::{ColorImage, Context, ViewportCommand};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Frames that must pass undisturbed before the picture is taken.
const QUIET: usize = 10;

/// A window that shows itself, writes what it shows, and closes.
#[derive(Debug)]
pub struct Photograph {
    out: PathBuf,
    started: Instant,
    first: Option<Duration>,
    frames: usize,
    quiet: usize,
    asked: bool,
}

impl Photograph {
    /// To be written to `out`; made when the graphics adapter is ready.
    pub fn new(out: PathBuf) -> Self {
        Self { out, started: Instant::now(), first: None, frames: 0, quiet: 0, asked: false }
    }

    /// Called at the start of every frame; `busy` while something is computed.
    pub fn frame(&mut self, ctx: &Context, busy: bool) {
        // At the start of the second frame the first one has been shown.
        if self.frames == 1 && self.first.is_none() {
            let first = self.started.elapsed();
            eprintln!("first frame shown after {} ms", first.as_millis());
            self.first = Some(first);
        }
        self.frames += 1;
        self.quiet = if busy { 0 } else { self.quiet + 1 };
        if self.quiet >= QUIET && !self.asked {
            self.asked = true;
            let (out, frames, close) = (self.out.clone(), self.frames, ctx.clone());
            ctx.request_screenshot(move |image| {
                match write(&image, &out) {
                    Ok(()) => eprintln!("photograph written after {frames} frames"),
                    Err(error) => eprintln!("{error}"),
                }
                close.send_viewport_cmd(ViewportCommand::Close);
            });
        }
        ctx.request_repaint();
    }
}

fn write(image: &ColorImage, out: &std::path::Path) -> Result<(), String> {
    let [width, height] = image.size;
    let bytes = image.pixels.iter().flat_map(egui::Color32::to_array).collect();
    let picture =
        image::RgbaImage::from_raw(width as u32, height as u32, bytes).ok_or("the picture has the wrong size")?;
    picture.save(out).map_err(|e| format!("{}: cannot be written ({e})", out.display()))
}

//! Copying values and writing plots to files: a context menu on each plot, and a list of what is on the screen for the menu.
//!
//! A plot is asked for by its title; it answers at its next frame with its drawing and its values, so that nothing is
//! prepared that nobody wants. Dialogs and writing run in the background.

use crate::exchange::atomic::write_atomically;
use crate::plots::drawing::Drawing;
use crate::plots::figure::csv;
use crate::plots::sheet::Sheet;
use crate::plots::svg;
use crate::session::jobs::Job;
use crate::window::app::repaint::request_repaint;
use crate::window::appearance::theme::Palette;
use crate::window::appearance::widgets::UiExt;
use crate::window::headless::offscreen::Offscreen;
use crate::window::language::{t, tr};
use crate::window::solid::paint::graphics;
use egui::{Context, Id, Key, KeyboardShortcut, Modifiers, Rect, Response, Ui, Vec2, vec2};
use egui_wgpu::RenderState;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Size of an exported plot in points; a PNG has twice as many pixels.
const PAPER: Vec2 = vec2(900.0, 560.0);
/// Pixels of a PNG a point.
const FINE: f32 = 2.0;

/// Keys that copy the values of the plot under the pointer, else of the one that has the keyboard's focus.
pub(super) const COPY: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::C);
/// Longest wait for a file that is being written when the window closes.
const PATIENCE: Duration = Duration::from_secs(3);

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Scalable vector graphics.
    Svg,
    /// Pixels.
    Png,
    /// Values.
    Csv,
}

impl Kind {
    /// Ending of its files.
    pub(crate) fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Svg => &["svg"],
            Self::Png => &["png"],
            Self::Csv => &["csv"],
        }
    }
}

/// Titles that were asked for and as what.
type Wanted = Vec<(String, Kind)>;
/// A plot or a table that waits to be written, with its values.
#[derive(Debug, Clone)]
struct Asked {
    title: String,
    kind: Kind,
    /// None of a table.
    drawing: Option<Drawing>,
    /// Columns separated by tabs.
    table: String,
}
type Ready = Vec<Asked>;

fn wanted_id() -> Id {
    Id::NULL.with("wanted plot")
}

fn shown_id() -> Id {
    Id::NULL.with("shown plots")
}

fn ready_id() -> Id {
    Id::NULL.with("drawn plots")
}

fn over_id() -> Id {
    Id::NULL.with("plot under the pointer")
}

fn pointed_id() -> Id {
    Id::NULL.with("pointed at")
}

fn focused_id() -> Id {
    Id::NULL.with("plot with the focus")
}

fn said_id() -> Id {
    Id::NULL.with("copied values")
}

/// Asks the plot of that title for its drawing.
pub fn want(ctx: &Context, title: &str, kind: Kind) {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Wanted>(wanted_id()).push((title.to_owned(), kind)));
    ctx.request_repaint();
}

/// Titles of the plots on the screen, in the order in which they were drawn.
pub fn shown(ctx: &Context) -> Vec<String> {
    recent(ctx, shown_id())
}

/// Titles that were registered in a list in this frame or the one before.
pub(super) fn recent(ctx: &Context, list: Id) -> Vec<String> {
    let now = ctx.cumulative_frame_nr();
    let list: Vec<(u64, String)> = ctx.data(|d| d.get_temp(list)).unwrap_or_default();
    list.into_iter().filter(|(frame, _)| now - frame <= 1).map(|(_, title)| title).collect()
}

pub(super) fn register(ctx: &Context, list: Id, title: &str) {
    let now = ctx.cumulative_frame_nr();
    ctx.data_mut(|d| {
        let list: &mut Vec<(u64, String)> = d.get_temp_mut_or_default(list);
        list.retain(|(frame, other)| now - frame <= 1 && other != title);
        list.push((now, title.to_owned()));
    });
}

/// Offers a sheet of plots for copying and export.
pub(crate) fn offer_sheet(ui: &Ui, responses: &[Response], sheet: Sheet) {
    let title = sheet.title.clone();
    let draw = |palette: &Palette| sheet.drawing(PAPER, palette);
    offer(ui, responses, &title, &draw, &|| sheet.table());
}

/// Offers whatever can be drawn and tabled for copying and export.
pub fn offer(
    ui: &Ui,
    responses: &[Response],
    title: &str,
    draw: &dyn Fn(&Palette) -> Drawing,
    table: &dyn Fn() -> String,
) {
    let ctx = ui.ctx();
    register(ctx, shown_id(), title);
    for response in responses {
        response.context_menu(|ui| menu(ui, title, table, response));
    }
    let hovered = responses.iter().any(Response::hovered);
    if hovered {
        let now = ctx.cumulative_frame_nr();
        ctx.data_mut(|d| d.insert_temp(over_id(), now));
        point(ctx);
    }
    let focused = !hovered && responses.iter().any(|r| is_focused(ctx, r.rect));
    if focused {
        let now = ctx.cumulative_frame_nr();
        ctx.data_mut(|d| d.insert_temp(focused_id(), now));
    }
    if (hovered || focused) && copied(ctx) {
        copy(ctx, title, table());
    }
    for kind in take_requests(ctx, title) {
        let drawing = Some(draw(ui.palette()));
        ask(ctx, Asked { title: title.to_owned(), kind, drawing, table: table() });
    }
}

/// Notes that the pointer is over a plot or a table.
pub(super) fn point(ctx: &Context) {
    let now = ctx.cumulative_frame_nr();
    ctx.data_mut(|d| d.insert_temp(pointed_id(), now));
}

/// Whether the keyboard's focus lies within `area` and the pointer over no plot or table: what is pointed at goes before.
pub(super) fn is_focused(ctx: &Context, area: Rect) -> bool {
    let now = ctx.cumulative_frame_nr();
    let pointed = ctx.data(|d| d.get_temp::<u64>(pointed_id())).is_some_and(|frame| now - frame <= 1);
    let place = || ctx.memory(egui::Memory::focused).and_then(|id| ctx.read_response(id)).map(|r| r.rect.center());
    !pointed && place().is_some_and(|at| area.contains(at))
}

/// Whether a plot that was drawn in this frame has the keyboard's focus.
pub(super) fn plot_has_focus(ctx: &Context) -> bool {
    let now = ctx.cumulative_frame_nr();
    ctx.data(|d| d.get_temp::<u64>(focused_id())) == Some(now)
}

/// Whether the pointer is over a plot that was drawn in this frame.
pub(super) fn over_plot(ctx: &Context) -> bool {
    let now = ctx.cumulative_frame_nr();
    ctx.data(|d| d.get_temp::<u64>(over_id())) == Some(now)
}

/// The kinds of files that were asked of a title, which are not asked again.
pub(super) fn take_requests(ctx: &Context, title: &str) -> Vec<Kind> {
    let wanted: Wanted = ctx.data(|d| d.get_temp(wanted_id())).unwrap_or_default();
    let (own, others): (Wanted, Wanted) = wanted.into_iter().partition(|(t, _)| t == title);
    if !own.is_empty() {
        ctx.data_mut(|d| d.insert_temp(wanted_id(), others));
    }
    own.into_iter().map(|(_, kind)| kind).collect()
}

fn ask(ctx: &Context, asked: Asked) {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Ready>(ready_id()).push(asked));
    ctx.request_repaint();
}

/// Has a table written as CSV.
pub(super) fn write_table(ctx: &Context, title: &str, table: String) {
    ask(ctx, Asked { title: title.to_owned(), kind: Kind::Csv, drawing: None, table });
}

/// Puts values on the clipboard and says so.
pub(super) fn copy(ctx: &Context, title: &str, table: String) {
    let rows = table.lines().filter(|line| !line.is_empty()).count();
    ctx.data_mut(|d| d.insert_temp(said_id(), format!("Copied: {title}, {rows} lines.")));
    ctx.copy_text(table);
}

/// Whether the keys to copy were pressed outside a field of text and without words marked that would be copied.
pub fn copied(ctx: &Context) -> bool {
    let pressed = || ctx.input(|i| i.events.iter().any(|e| matches!(e, egui::Event::Copy)));
    let marked = || ctx.plugin::<egui::text_selection::LabelSelectionState>().lock().has_selection();
    !ctx.text_edit_focused() && pressed() && !marked()
}

fn menu(ui: &mut Ui, title: &str, table: &dyn Fn() -> String, plot: &Response) {
    let copy = egui::Button::new(t!("Copy values")).shortcut_text(ui.ctx().format_shortcut(&COPY));
    let copy = ui.add(copy).on_hover_text(t!("As a table with tabs, for a spreadsheet."));
    copy.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, t!("Copy values")));
    if copy.clicked() {
        self::copy(ui.ctx(), title, table());
        ui.close();
    }
    let kinds = [(Kind::Svg, "Export as SVG…"), (Kind::Png, "Export as PNG…"), (Kind::Csv, "Export values as CSV…")];
    for (kind, label) in kinds {
        if ui.button(tr(label)).clicked() {
            want(ui.ctx(), title, kind);
            ui.close();
        }
    }
    super::zoom::menu(ui, plot);
    ui.separator();
    ui.hint("Drag pans, right drag zooms a box, double click shows all.");
    ui.hint("Shift and click sets two cursors, a third takes them away.");
}

/// What became of an export, in one line; failed where the second is true.
pub type Ending = (String, bool);

/// Exports under way.
#[derive(Debug, Default)]
pub struct Exports {
    /// Where files go without a dialog; `None` asks.
    pub folder: Option<PathBuf>,
    /// What waits for the name of its file; the first is asked for.
    waiting: VecDeque<Asked>,
    jobs: Vec<Job<(), Result<PathBuf, String>>>,
}

impl Exports {
    /// Starts what was asked for; gives back how an export ended, once.
    pub fn poll(&mut self, ctx: &Context) -> Option<Ending> {
        if let Some(said) = ctx.data_mut(|d| d.remove_temp::<String>(said_id())) {
            return Some((said, false));
        }
        let ready: Ready = ctx.data_mut(|d| d.remove_temp(ready_id())).unwrap_or_default();
        for asked in ready {
            let Some(folder) = &self.folder else {
                self.waiting.push_back(asked);
                continue;
            };
            let path = folder.join(name_of(&asked));
            if let Err(error) = self.start(ctx, asked, path) {
                return Some((error, true));
            }
        }
        let (k, result) = self.jobs.iter().enumerate().find_map(|(k, job)| Some((k, job.poll()?)))?;
        self.jobs.swap_remove(k);
        match result {
            Ok(Ok(path)) => Some((format!("Written: {}", path.display()), false)),
            Ok(Err(error)) => Some((error, true)),
            Err(error) => Some((error.to_string(), true)),
        }
    }

    fn start(&mut self, ctx: &Context, asked: Asked, path: PathBuf) -> Result<(), String> {
        let Asked { kind, drawing, table, .. } = asked;
        let state = graphics(ctx);
        let work = move |_: &crate::control::Control| {
            let written = match drawing.filter(|_| kind != Kind::Csv) {
                Some(drawing) => write(&drawing, kind, &path, state),
                None => write_bytes(&path, csv(&table).as_bytes()),
            };
            written.map(|()| path)
        };
        self.jobs.push(Job::start("Exporting", (), request_repaint(ctx), work).map_err(|e| e.to_string())?);
        Ok(())
    }

    /// Kind and proposed name of the file that is to be asked for next.
    pub(crate) fn wants_file(&self) -> Option<(Kind, String)> {
        self.waiting.front().map(|asked| (asked.kind, name_of(asked)))
    }

    /// Writes what waited for its file.
    ///
    /// # Errors
    /// One line, where no thread can be started.
    pub(crate) fn write_to(&mut self, ctx: &Context, path: PathBuf) -> Result<(), String> {
        self.waiting.pop_front().map_or(Ok(()), |asked| self.start(ctx, asked, path))
    }

    /// Forgets what waited for its file.
    pub(crate) fn give_up(&mut self) {
        self.waiting.pop_front();
    }

    /// Whether a file is being written or asked for.
    pub fn busy(&self) -> bool {
        !self.jobs.is_empty() || !self.waiting.is_empty()
    }
}

/// Name of the file by the title.
fn name_of(asked: &Asked) -> String {
    format!("{}.{}", file_name(&asked.title), asked.kind.endings()[0])
}

/// A title as the name of a file: letters and figures in lower case, all else as single hyphens.
pub fn file_name(title: &str) -> String {
    let words = title.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join("-")
}

/// Writes a drawing to a file; blocks.
///
/// # Errors
/// One line: the file, or the adapter where pixels are asked for.
pub fn write(drawing: &Drawing, kind: Kind, path: &Path, state: Option<RenderState>) -> Result<(), String> {
    let bytes = match kind {
        Kind::Svg => svg::write(drawing).into_bytes(),
        Kind::Png => png(drawing, state)?,
        Kind::Csv => return Err("a drawing has no values of its own; ask the plot for them".to_owned()),
    };
    write_bytes(path, &bytes)
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write_atomically(path, bytes).map_err(|e| format!("{}: cannot be written ({e})", path.display()))
}

/// The drawing as a PNG file.
///
/// # Errors
/// One line where there is no adapter.
pub fn png(drawing: &Drawing, state: Option<RenderState>) -> Result<Vec<u8>, String> {
    let pixels = [drawing.size.x * FINE, drawing.size.y * FINE].map(|v| v.round() as u32);
    let offscreen = Offscreen::beside(state, pixels, FINE)?;
    let ctx = Context::default();
    crate::window::appearance::theme::install(&ctx);
    let rgba = offscreen.settle(&ctx, &mut |ui| {
        let painter = ui.painter();
        painter.rect_filled(ui.max_rect().expand(100.0), 0.0, drawing.ground);
        drawing.paint(painter, egui::Pos2::ZERO);
        false
    })?;
    let image = image::RgbaImage::from_raw(pixels[0], pixels[1], rgba).ok_or("the picture has the wrong size")?;
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).map_err(|e| e.to_string())?;
    Ok(bytes.into_inner())
}

impl Drop for Exports {
    /// Files that are being written are finished: their jobs hold the graphics device, which must not be left to them.
    fn drop(&mut self) {
        for job in &self.jobs {
            drop(job.wait(PATIENCE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn titles_make_names_of_files() {
        assert_eq!(file_name("Bode diagram, Receptance of DOF 7 (z)"), "bode-diagram-receptance-of-dof-7-z");
    }
}

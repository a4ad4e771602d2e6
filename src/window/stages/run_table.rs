//! Order and filter of the table of runs.

use crate::display::{glossary, words};
use crate::exchange::Project;
use crate::measurement::Run;
use crate::window::appearance::theme::{self, space};
use crate::window::appearance::widgets::{UiExt, explained, shortened};
use crate::window::language::{t, tf, tr};
use egui::{Align, Label, Layout, Response, RichText, Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

/// Runs from which on the table has a filter.
const MANY: usize = 12;

/// By what the runs stand in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Key {
    #[default]
    Project,
    File,
    Frequency,
    Level,
    Noise,
    Harmonics,
    Flags,
}

/// Order and filter.
#[derive(Debug, Clone, Default)]
pub struct Order {
    /// By what.
    pub key: Key,
    /// Whether the largest stands first.
    pub falling: bool,
    /// Whether runs of one level stand together, in this order each.
    pub by_level: bool,
    /// Words that file, level or flags of a run must hold.
    pub filter: String,
}

impl Order {
    /// The runs that are shown, in their order; `harmonics` is the share of higher harmonics of a run.
    pub fn rows(&self, p: &Project, harmonics: impl Fn(&Run) -> Option<f64>) -> Vec<usize> {
        let wanted = self.filter.trim().to_lowercase();
        let mut rows: Vec<usize> =
            (0..p.runs.len()).filter(|&r| wanted.is_empty() || holds(&p.runs[r], &wanted)).collect();
        let number = |r: usize| {
            let run = &p.runs[r];
            match self.key {
                Key::Project | Key::File => r as f64,
                Key::Frequency => run.fit.omega,
                Key::Level => run.level.map_or(f64::NEG_INFINITY, |l| l as f64),
                Key::Noise => run.noise_ratio,
                Key::Harmonics => harmonics(run).unwrap_or(-1.0),
                Key::Flags => run.findings.len() as f64,
            }
        };
        match self.key {
            Key::Project => {}
            Key::File => rows.sort_by(|&a, &b| p.runs[a].file.cmp(&p.runs[b].file)),
            _ => {
                // Each number is made once: the harmonics of a run go through all its channels.
                let mut numbered: Vec<(f64, usize)> = rows.iter().map(|&r| (number(r), r)).collect();
                numbered.sort_by(|a, b| a.0.total_cmp(&b.0));
                rows = numbered.into_iter().map(|(_, r)| r).collect();
            }
        }
        if self.falling {
            rows.reverse();
        }
        if self.by_level {
            rows.sort_by_key(|&r| p.runs[r].level);
        }
        rows
    }

    /// A field for the filter, where there are many runs, whether they stand together by level, and how many are shown.
    pub fn field(&mut self, ui: &mut Ui, p: &Project, shown: usize) {
        let all = p.runs.len();
        if all < MANY {
            return;
        }
        ui.horizontal(|ui| {
            let label = ui.hint("Filter");
            let field =
                egui::TextEdit::singleline(&mut self.filter).hint_text(t!("file, level or flag")).desired_width(150.0);
            ui.add(field).labelled_by(label.id);
            let levels = p.runs.iter().any(|r| r.level != p.runs[0].level);
            if levels {
                ui.checkbox(&mut self.by_level, t!("By level"))
                    .on_hover_text(t!("Runs of one force level stand together."));
            }
            ui.hint(if shown == all { format!("{all} runs") } else { format!("{shown} of {all} runs") });
        });
        ui.add_space(space::XS);
    }

    /// The head of a column: a click brings the runs into its order, another turns it round, a third gives the project's.
    pub fn head(&mut self, ui: &mut Ui, name: &str, key: Key, right: bool) -> Response {
        let layout = if right { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
        let response = ui
            .with_layout(layout, |ui| {
                ui.add_space(if right { space::XS } else { 0.0 });
                let colour = if self.key == key { ui.palette().accent } else { ui.palette().weak };
                let text = RichText::new(tr(name)).size(theme::size::SMALL).color(colour);
                let response = ui.add(Label::new(text).selectable(false).sense(Sense::click()));
                if self.key == key {
                    mark(ui, &response, self.falling);
                }
                response
            })
            .inner;
        let response = explained(response, glossary::meaning(name));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, tf!("Sort by {}", name.trim().to_lowercase())));
        if response.clicked() {
            (self.key, self.falling) = match (self.key == key, self.falling) {
                (false, _) => (key, false),
                (true, false) => (key, true),
                (true, true) => (Key::Project, false),
            };
        }
        response
    }
}

/// A triangle under the head by which the runs stand in order: up where the least stands first.
fn mark(ui: &Ui, head: &Response, falling: bool) {
    let (centre, up) = (head.rect.center_bottom() + vec2(0.0, 3.0), if falling { 2.5 } else { -2.5 });
    let corners = vec![centre + vec2(0.0, up), centre + vec2(-4.0, -up), centre + vec2(4.0, -up)];
    ui.painter().add(Shape::convex_polygon(corners, ui.palette().accent, Stroke::NONE));
}

/// Whether file, level or a flag of a run hold the words.
fn holds(run: &Run, wanted: &str) -> bool {
    let level = run.level.map_or_else(String::new, |l| format!("level {l}"));
    let flags = run.findings.iter().any(|f| words::flag(f.flag).contains(wanted));
    run.file.to_lowercase().contains(wanted) || level.contains(wanted) || flags
}

/// Length of the folder in which all runs lie, which says nothing of any: the names have its room.
pub fn common_folder(p: &Project) -> usize {
    let Some(first) = p.runs.first().map(|r| r.file.as_str()) else { return 0 };
    let folder = first.rfind(['/', '\\']).map_or(0, |at| at + 1);
    if p.runs.iter().all(|r| r.file.starts_with(&first[..folder])) { folder } else { 0 }
}

/// The name of a file without the `folder` that all share, which says nothing of any.
pub(super) fn file_name(ui: &mut Ui, file: &str, folder: usize) {
    let name = file.get(folder..).unwrap_or(file);
    let short = shortened(ui, name, theme::font(theme::size::BODY), ui.available_width());
    ui.label(short).on_hover_text(file);
}

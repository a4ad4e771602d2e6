//! The start screen: samples as cards, and the way to a file.

use crate::window::app::Ask;
use crate::window::commands::Command;
use crate::window::templates;
use crate::window::theme::{self, Palette, size, space};
use crate::window::widgets::UiExt;
use egui::{CentralPanel, Frame, Margin, Rect, RichText, Role, Sense, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use std::path::{Path, PathBuf};

/// A sample project.
struct Sample {
    folder: &'static str,
    title: &'static str,
    sentence: &'static str,
    picture: fn(&egui::Painter, &Palette, Rect),
}

const SAMPLES: [Sample; 6] = [
    Sample {
        folder: "cantilever-case-2",
        title: "Cantilever, unequal dashpots",
        sentence: "Four dampers that differ a hundredfold, three accelerometers, 5 % noise. The tour is on this one.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[]),
    },
    Sample {
        folder: "cantilever-case-1",
        title: "Cantilever, equal dashpots",
        sentence: "Four equal dampers on an aluminium strip: find them among twenty candidates.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[]),
    },
    Sample {
        folder: "cantilever-case-1a",
        title: "Cantilever, one place known",
        sentence: "The same test, but one damper's place is known: it is forced and its value identified.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[2]),
    },
    Sample {
        folder: "cantilever-case-2-rounded",
        title: "Cantilever, beside the resonances",
        sentence: "Driven at rounded frequencies, where one mode does not describe the shape.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[]),
    },
    Sample {
        folder: "five-masses",
        title: "Five masses",
        sentence: "A chain with known dashpots to the ground and two unknown ones between masses.",
        picture: chain,
    },
    Sample {
        folder: "five-masses-points",
        title: "Five points, no model",
        sentence: "Energy balance alone: no mass and no stiffness is known, and the dashpots are still found.",
        picture: points,
    },
];

/// Where samples are looked for: beside the program, at and above the working directory.
pub fn samples_folder() -> Option<PathBuf> {
    let here = std::env::current_dir().ok();
    let program = std::env::current_exe().ok();
    let roots = here.iter().chain(program.iter()).flat_map(|p| p.ancestors().take(5));
    roots.map(|root| root.join("sample-data")).find(|folder| folder.is_dir())
}

/// Shows the start screen.
pub fn show(ui: &mut Ui, recent: &[PathBuf], asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let desk = Frame::new().fill(palette.desk).inner_margin(Margin::same(space::XL as i8));
    CentralPanel::default().frame(desk).show(ui, |ui| {
        let width = ui.available_width().min(1080.0);
        let margin = 0.5 * (ui.available_width() - width);
        ui.horizontal_top(|ui| {
            ui.add_space(margin);
            ui.vertical(|ui| {
                ui.set_width(width);
                heading(ui, asks);
                cards(ui, width, asks);
                files(ui, recent, asks);
            });
        });
    });
}

fn heading(ui: &mut Ui, asks: &mut Vec<Ask>) {
    ui.add_space(space::L);
    ui.label(RichText::new("Dashpot").size(size::TITLE));
    ui.label(
        RichText::new("Where does the structure lose its energy, how much, and by which mechanism?")
            .color(ui.palette().weak),
    );
    ui.add_space(space::L);
    ui.horizontal(|ui| {
        if ui.primary("Open a project…").on_hover_text(Command::Open.entry().tooltip).clicked() {
            asks.push(Ask::Command(Command::Open));
        }
        ui.menu_button("New…", |ui| {
            for (k, template) in templates::ALL.iter().enumerate() {
                if ui.button(template.name).clicked() {
                    asks.push(Ask::New(k));
                    ui.close();
                }
            }
        });
        if ui.button("Take the tour").on_hover_text(Command::Tour.entry().tooltip).clicked() {
            asks.push(Ask::Command(Command::Tour));
        }
        ui.hint("or drop its file on this window, or begin with a sample");
    });
    ui.add_space(space::L);
}

fn cards(ui: &mut Ui, width: f32, asks: &mut Vec<Ask>) {
    let folder = samples_folder();
    let gap = 14.0;
    let card_width = (width - 2.0 * gap) / 3.0;
    for row in SAMPLES.chunks(3) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for sample in row {
                let file = folder.as_deref().map(|f| f.join(sample.folder).join("project.toml"));
                if card(ui, card_width, sample, file.as_deref())
                    && let Some(file) = file
                {
                    asks.push(Ask::Open(file));
                }
            }
        });
        ui.add_space(gap);
    }
    if folder.is_none() {
        ui.hint("The samples are not here: start the program in its own folder, where sample-data lies.");
    }
}

/// The files opened last.
fn files(ui: &mut Ui, recent: &[PathBuf], asks: &mut Vec<Ask>) {
    if recent.is_empty() {
        return;
    }
    ui.add_space(space::S);
    ui.title("Opened last", "");
    for path in recent.iter().take(5) {
        if ui.link(path.display().to_string()).clicked() {
            asks.push(Ask::Open(path.clone()));
        }
    }
}

fn card(ui: &mut Ui, width: f32, sample: &Sample, file: Option<&Path>) -> bool {
    let palette = ui.palette();
    let present = file.is_some_and(Path::exists);
    let sense = if present { Sense::click() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(width, 188.0), sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, present, sample.title));
    let lit = response.hovered() && present || response.has_focus();
    let line = theme::hair(if lit { palette.accent } else { palette.line });
    ui.painter().rect(rect, 8.0, palette.pane, line, StrokeKind::Inside);
    let picture = Rect::from_min_max(rect.left_top() + vec2(12.0, 12.0), pos2(rect.right() - 12.0, rect.top() + 112.0));
    ui.painter().rect_filled(picture, 5.0, palette.canvas);
    (sample.picture)(&ui.painter_at(picture), palette, picture);
    let text = |size: f32, string: &str, colour| {
        ui.painter().layout(string.to_owned(), theme::font(size), colour, width - 28.0)
    };
    let title = text(size::HEADING, sample.title, palette.ink);
    let sentence = text(size::BODY - 0.5, sample.sentence, palette.weak);
    let at = pos2(rect.left() + 14.0, picture.bottom() + 10.0);
    let below = at + vec2(0.0, title.size().y + 4.0);
    ui.painter().galley(at, title, palette.ink);
    ui.painter().galley(below, sentence, palette.weak);
    response.clicked()
}

/// Dashpots stand at nodes of ten; those whose place is known are drawn in ink.
fn beam(painter: &egui::Painter, palette: &Palette, r: Rect, dashpots: &[usize], known: &[usize]) {
    use crate::effects::Effect;
    use crate::window::schematic::symbols;
    let axis = r.top() + 40.0;
    let (left, right) = (r.left() + 34.0, r.right() - 24.0);
    let at = |k: usize| left + (right - left) * k as f32 / 10.0;
    let lift = |k: f32| 15.0 * (k / 10.0).powi(2);
    let curve = (0..=40).map(|k| pos2(left + (right - left) * k as f32 / 40.0, axis - lift(k as f32 / 4.0))).collect();
    symbols::ground(painter, pos2(left, axis), egui::Vec2::LEFT, 36.0, theme::bold(palette.ink));
    painter.add(egui::Shape::line(curve, egui::Stroke::new(4.0, palette.ink)));
    for &k in dashpots {
        let (top, foot) = (pos2(at(k), axis - lift(k as f32)), pos2(at(k), r.bottom() - 12.0));
        let colour = if known.contains(&k) { palette.accent } else { palette.model };
        symbols::draw(painter, Effect::Viscous, [top, foot], theme::pen(colour));
        symbols::ground(painter, foot, egui::Vec2::DOWN, 20.0, theme::hair(colour));
    }
    for k in [4, 6, 10] {
        let body = Rect::from_center_size(pos2(at(k), axis - lift(k as f32) - 6.0), vec2(10.0, 7.0));
        painter.rect_filled(body, 1.5, palette.measured);
    }
}

fn chain(painter: &egui::Painter, palette: &Palette, r: Rect) {
    use crate::effects::Effect;
    use crate::window::schematic::symbols;
    let step = (r.width() - 30.0) / 5.2;
    let x = |k: f32| r.left() + 16.0 + step * k;
    let y = r.center().y;
    symbols::ground(painter, pos2(x(0.0), y), egui::Vec2::LEFT, 40.0, theme::bold(palette.ink));
    for k in 0..5 {
        let k = k as f32;
        let (from, to) = (if k == 0.0 { x(0.0) } else { x(k) + 11.0 }, x(k + 1.0) - 13.0);
        symbols::draw(painter, Effect::Stiffness, [pos2(from, y - 9.0), pos2(to, y - 9.0)], theme::pen(palette.ink));
        if k == 2.0 || k == 4.0 {
            symbols::draw(
                painter,
                Effect::Viscous,
                [pos2(from, y + 10.0), pos2(to, y + 10.0)],
                theme::pen(palette.model),
            );
        }
        let mass = Rect::from_center_size(pos2(x(k + 1.0) - 1.0, y), vec2(24.0, 40.0));
        painter.rect(mass, 3.0, palette.raised, theme::bold(palette.ink), StrokeKind::Middle);
    }
}

fn points(painter: &egui::Painter, palette: &Palette, r: Rect) {
    use crate::effects::Effect;
    use crate::window::schematic::symbols;
    let step = (r.width() - 60.0) / 4.0;
    let at = |k: usize| pos2(r.left() + 30.0 + step * k as f32, r.center().y);
    for k in [1, 3] {
        symbols::draw(painter, Effect::Viscous, [at(k), at(k + 1)], theme::pen(palette.model));
    }
    for k in 0..5 {
        painter.circle(at(k), 10.0, palette.raised, theme::bold(palette.measured));
    }
}

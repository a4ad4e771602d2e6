//! The start screen: samples as cards, and the way to a file.

use super::cards::{self, Sample, card};
use crate::window::app::Ask;
use crate::window::app::commands::Command;
use crate::window::appearance::theme::{Palette, size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::document::templates;
use crate::window::language::{t, tr};
use egui::{CentralPanel, Frame, Margin, RichText, ScrollArea, Ui};
use std::path::PathBuf;

/// Largest width of all, least width of a card, and room between cards, points.
const WIDEST: f32 = 1400.0;
const CARD: f32 = 264.0;
const GAP: f32 = 14.0;

/// Where samples are looked for: beside the program, at and above the working directory, and where a package puts them.
pub(crate) fn samples_folder() -> Option<PathBuf> {
    let here = std::env::current_dir().ok();
    let program = std::env::current_exe().ok();
    let roots = here.iter().chain(program.iter()).flat_map(|p| p.ancestors().take(5));
    let places = roots.flat_map(|root| [root.join("sample-data"), root.join("share/dashpot/sample-data")]);
    places.into_iter().find(|folder| folder.is_dir())
}

/// The project file of a sample, copied to the user's own folder where that of the program may not be written: a sample is
/// there to be tried and changed.
fn own_copy(project: PathBuf) -> PathBuf {
    let copied = || {
        let folder = project.parent()?;
        if tempfile::tempfile_in(folder).is_ok() {
            return None;
        }
        let own = eframe::storage_dir("dashpot")?.join("samples").join(folder.file_name()?);
        std::fs::create_dir_all(&own).ok()?;
        for entry in std::fs::read_dir(folder).ok()?.flatten().filter(|e| e.path().is_file()) {
            let to = own.join(entry.file_name());
            if !to.exists() {
                crate::exchange::atomic::write_atomically(&to, &std::fs::read(entry.path()).ok()?).ok()?;
            }
        }
        Some(own.join(project.file_name()?))
    };
    copied().unwrap_or(project)
}

/// Shows the start screen.
pub(crate) fn show(ui: &mut Ui, recent: &[PathBuf], asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let desk = Frame::new().fill(palette.desk).inner_margin(Margin::same(space::XL as i8));
    CentralPanel::default().frame(desk).show(ui, |ui| {
        let width = ui.available_width().min(WIDEST);
        let margin = 0.5 * (ui.available_width() - width);
        ui.horizontal_top(|ui| {
            ui.add_space(margin);
            ui.vertical(|ui| {
                ui.set_width(width);
                heading(ui, asks);
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    files(ui, recent, asks);
                    samples(ui, width, asks);
                });
            });
        });
    });
}

fn heading(ui: &mut Ui, asks: &mut Vec<Ask>) {
    ui.add_space(space::L);
    ui.label(RichText::new(t!("Dashpot")).size(size::TITLE));
    ui.label(
        RichText::new(t!("Where does the structure lose its energy, how much, and by which mechanism?"))
            .color(ui.palette().weak),
    );
    ui.add_space(space::L);
    ui.horizontal_wrapped(|ui| {
        if ui.primary("Open a project…").on_hover_text(tr(Command::Open.entry().tooltip)).clicked() {
            asks.push(Ask::Command(Command::Open));
        }
        if ui.button(t!("Import measurements…")).on_hover_text(tr(Command::Import.entry().tooltip)).clicked() {
            asks.push(Ask::Command(Command::Import));
        }
        ui.menu_button(t!("New…"), |ui| {
            for (k, template) in templates::ALL.iter().enumerate() {
                if ui.button(tr(template.name)).clicked() {
                    asks.push(Ask::New(k));
                    ui.close();
                }
            }
        });
        if ui.button(t!("Take the tour")).on_hover_text(tr(Command::Tour.entry().tooltip)).clicked() {
            asks.push(Ask::Command(Command::Tour));
        }
        if ui.button(t!("Laws of damping")).on_hover_text(tr(Command::Laws.entry().tooltip)).clicked() {
            asks.push(Ask::Command(Command::Laws));
        }
        ui.hint("or drop files on this window, or begin with a sample");
    });
    ui.add_space(space::L);
}

fn samples(ui: &mut Ui, width: f32, asks: &mut Vec<Ask>) {
    let folder = samples_folder();
    let columns = ((width + GAP) / (CARD + GAP)).floor().max(1.0);
    let card_width = (width - (columns - 1.0) * GAP) / columns;
    let groups: [(&str, &[Sample]); 3] = [
        ("Where is the energy lost?", &cards::DAMPERS),
        ("What does the model lack?", &cards::HIDDEN),
        ("What do decays, hammers and sweeps tell?", &cards::RECORDS),
    ];
    for (title, samples) in groups {
        ui.title(title, "");
        ui.add_space(space::XS);
        for row in samples.chunks(columns as usize) {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = GAP;
                for sample in row {
                    let file = folder.as_deref().map(|f| f.join(sample.folder).join("project.toml"));
                    if card(ui, card_width, sample, file.as_deref())
                        && let Some(file) = file
                    {
                        asks.push(Ask::Open(own_copy(file)));
                    }
                }
            });
            ui.add_space(GAP);
        }
    }
    if folder.is_none() {
        ui.hint("The samples are not here: start the program in its own folder, where sample-data lies.");
    }
}

/// The files opened last: who comes back looks for them first.
fn files(ui: &mut Ui, recent: &[PathBuf], asks: &mut Vec<Ask>) {
    if recent.is_empty() {
        return;
    }
    ui.title("Opened last", "");
    for path in recent.iter().take(5) {
        if ui.link(path.display().to_string()).clicked() {
            asks.push(Ask::Open(path.clone()));
        }
    }
    ui.add_space(space::L);
}

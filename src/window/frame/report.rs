//! What a report is to be: title page, sections, time of the search, tables.

use crate::window::app::ask::Ask;
use crate::window::appearance::theme::{size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::files::Pick;
use crate::window::frame::report_choice::ReportChoice;
use crate::window::language::{t, tr};
use egui::{Button, Context, DragValue, Frame, Grid, Id, Margin, Modal, RichText, ScrollArea, TextEdit, Ui};

/// Width of the dialog, points.
const WIDTH: f32 = 460.0;
/// Width of its fields, points.
const FIELD: f32 = 300.0;

/// Shows the dialog while it is open.
pub(crate) fn show(ctx: &Context, reporting: &mut Option<ReportChoice>, asks: &mut Vec<Ask>) {
    let Some(choice) = reporting else { return };
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
    let room = ctx.content_rect().height() - 150.0;
    let mut ended = false;
    let modal = Modal::new(Id::unique("report")).frame(frame).show(ctx, |ui| {
        ui.set_width(WIDTH);
        ui.label(RichText::new(t!("Report")).size(size::HEADING));
        ScrollArea::vertical().max_height(room).show(ui, |ui| {
            title_page(ui, choice, asks);
            ui.add_space(space::S);
            sections(ui, choice);
            ui.add_space(space::S);
            rest(ui, choice);
        });
        ui.add_space(space::S);
        ui.horizontal(|ui| {
            let any = choice.sections.iter().any(|(_, wanted)| *wanted);
            ui.add_enabled_ui(any, |ui| {
                let write = ui.primary("Write…").on_disabled_hover_text(t!("Choose at least one section."));
                if write.clicked() {
                    asks.push(Ask::Report(Box::new(choice.request())));
                    ended = true;
                }
            });
            ended |= ui.button(t!("Cancel")).clicked();
        });
    });
    if ended || modal.should_close() {
        *reporting = None;
    }
}

/// What stands on the title page; it is kept in the project.
fn title_page(ui: &mut Ui, choice: &mut ReportChoice, asks: &mut Vec<Ask>) {
    ui.hint("What stands on the title page is kept in the project.");
    Grid::new("title page").num_columns(2).spacing([space::M, space::XS]).show(ui, |ui| {
        field(ui, t!("Title"), &mut choice.title);
        field(ui, t!("Test object"), &mut choice.object);
        field(ui, t!("Tested by"), &mut choice.tester);
        field(ui, t!("Organisation"), &mut choice.organisation);
        field(ui, t!("Logo (PNG)"), &mut choice.logo);
        ui.label("");
        if ui.button(t!("Choose a picture…")).clicked() {
            asks.push(Ask::Pick(Pick::Logo));
        }
        ui.end_row();
    });
}

fn field(ui: &mut Ui, name: &str, text: &mut String) {
    let label = ui.label(name);
    ui.add(TextEdit::singleline(text).desired_width(FIELD)).labelled_by(label.id);
    ui.end_row();
}

fn sections(ui: &mut Ui, choice: &mut ReportChoice) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(t!("Sections")).strong());
        for (name, wanted) in [(t!("All"), true), (t!("None"), false)] {
            if ui.add(Button::new(name).small()).clicked() {
                choice.sections.iter_mut().for_each(|(_, own)| *own = wanted);
            }
        }
    });
    Grid::new("sections").num_columns(2).spacing([space::M, space::XS]).show(ui, |ui| {
        for pair in choice.sections.chunks_mut(2) {
            for (section, wanted) in pair {
                ui.checkbox(wanted, tr(section.words()));
            }
            ui.end_row();
        }
    });
}

fn rest(ui: &mut Ui, choice: &mut ReportChoice) {
    ui.horizontal(|ui| {
        let label = ui.label(t!("Time of the search"));
        ui.add(DragValue::new(&mut choice.limit_s).range(1.0..=3600.0).suffix(" s"))
            .labelled_by(label.id)
            .on_hover_text(t!("After so many seconds the search for what is missing answers with the best so far."));
    });
    ui.checkbox(&mut choice.tables, t!("Tables and values of the figures as CSV in a ZIP file beside it"));
}

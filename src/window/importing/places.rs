//! Frequency responses: their DOFs, what they relate, their averages.

use super::draft::Responses;
use super::mapping::sense;
use crate::exchange::frf::Form;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tf, tr};
use egui::{Align, ComboBox, DragValue, Label, Layout, Role, TextEdit, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder};

/// Shows what is decided of frequency responses.
pub(super) fn show(ui: &mut Ui, responses: &mut Responses) {
    options(ui, responses);
    for what in &responses.assumed {
        ui.hint(format!("Assumed: {what}."));
    }
    ui.add_space(space::S);
    if responses.places.is_empty() {
        lists(ui, responses);
        return;
    }
    let height = ui.available_height();
    TableBuilder::new(ui)
        .id_salt("places")
        .striped(true)
        .max_scroll_height(height)
        .auto_shrink(false)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::remainder().at_least(120.0).clip(true))
        .column(Column::exact(110.0))
        .column(Column::exact(60.0))
        .header(space::ROW, |mut header| {
            for name in ["Point in the file", "DOF", "Sense"] {
                header.col(|ui| drop(ui.hint(name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW + 4.0, responses.places.len(), |mut line| {
                let place = &mut responses.places[line.index()];
                let name = place.name.clone();
                line.col(|ui| {
                    ui.add(Label::new(&name).truncate().selectable(false));
                });
                line.col(|ui| {
                    let field = ui.add(TextEdit::singleline(&mut place.label).desired_width(96.0));
                    field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, tf!("DOF of {name}")));
                });
                line.col(|ui| {
                    let mut sign = place.reversed.then_some(-1);
                    sense(ui, &mut sign, &name);
                    place.reversed = sign.is_some();
                });
            });
        });
}

/// What the functions relate, and their averages.
fn options(ui: &mut Ui, responses: &mut Responses) {
    ui.horizontal_wrapped(|ui| {
        let label = ui.hint("They are");
        let word = responses.form.map_or("as their units say", |form| Form::WORDS[form as usize]);
        let combo = ComboBox::from_id_salt("form").width(150.0).selected_text(tr(word)).show_ui(ui, |ui| {
            ui.selectable_value(&mut responses.form, None, t!("as their units say"));
            for word in Form::WORDS {
                ui.selectable_value(&mut responses.form, Form::from_word(word), tr(word));
            }
        });
        combo.response.labelled_by(label.id);
        ui.add_space(space::M);
        let label = ui.hint("Averages");
        let drag = DragValue::new(&mut responses.averages)
            .range(0..=1_000_000)
            .custom_formatter(|value, _| if value < 1.0 { t!("not known").to_owned() } else { format!("{value}") });
        ui.add(drag).labelled_by(label.id);
    });
}

/// Labels of functions that the file does not name.
fn lists(ui: &mut Ui, responses: &mut Responses) {
    ui.hint("The file does not name where its functions were measured: write the DOFs in their order, with commas.");
    ui.add_space(space::XS);
    for (name, text) in [("Responses", &mut responses.responses), ("Driven at", &mut responses.references)] {
        ui.horizontal(|ui| {
            let label = ui.hint(name);
            ui.add(TextEdit::singleline(text).desired_width(ui.available_width() - 8.0)).labelled_by(label.id);
        });
    }
}

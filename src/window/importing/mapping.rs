//! The table of what the channels of records are.

use super::draft::ChannelRow;
use crate::measurement::Quantity;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{numbers, t, tf, tr};
use egui::{Align, ComboBox, DragValue, Label, Layout, Response, Role, TextEdit, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};

/// Quantities and their words on the screen.
const QUANTITIES: [(Quantity, &str); 5] = [
    (Quantity::Force, "force"),
    (Quantity::Acceleration, "acceleration"),
    (Quantity::Velocity, "velocity"),
    (Quantity::Displacement, "displacement"),
    (Quantity::Base, "base motion"),
];
/// Columns; the first says whether the channel is imported.
const COLUMNS: [&str; 8] = ["Use", "Channel", "Quantity", "DOF", "Sense", "Unit", "Factor", "Delay, ms"];

/// Shows the table.
pub(super) fn show(ui: &mut Ui, rows: &mut [ChannelRow], unit_of: impl Fn(&str) -> String) {
    let height = ui.available_height();
    TableBuilder::new(ui)
        .id_salt("mapping")
        .striped(true)
        .max_scroll_height(height)
        .auto_shrink(false)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(28.0))
        .column(Column::remainder().at_least(84.0).clip(true))
        .column(Column::exact(118.0))
        .column(Column::exact(58.0))
        .column(Column::exact(40.0))
        .column(Column::exact(66.0))
        .column(Column::exact(74.0))
        .column(Column::exact(58.0))
        .header(space::ROW, |mut header| {
            for name in COLUMNS {
                header.col(|ui| drop(ui.hint(name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW + 4.0, rows.len(), |mut line| {
                let k = line.index();
                one(&mut line, k, &mut rows[k], &unit_of);
            });
        });
}

fn one(line: &mut TableRow<'_, '_>, k: usize, row: &mut ChannelRow, unit_of: &impl Fn(&str) -> String) {
    let name = row.table.name.clone();
    let used = row.used;
    line.col(|ui| {
        let check = ui.checkbox(&mut row.used, "");
        check.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, used, tf!("Use {name}")));
    });
    line.col(|ui| {
        let colour = if used { ui.palette().ink } else { ui.palette().weak };
        let text = egui::RichText::new(&name).color(colour);
        let label = ui.add(Label::new(text).truncate().selectable(false));
        if !row.note.is_empty() {
            label.on_hover_text(tf!("{name}: {}", row.note));
        }
    });
    line.col(|ui| {
        let word =
            QUANTITIES.iter().find(|(quantity, _)| *quantity == row.table.quantity).map_or("", |(_, word)| *word);
        let combo = ComboBox::from_id_salt(("quantity", k)).width(108.0).selected_text(tr(word)).show_ui(ui, |ui| {
            for (quantity, word) in QUANTITIES {
                ui.selectable_value(&mut row.table.quantity, quantity, tr(word));
            }
        });
        named(&combo.response, Role::ComboBox, "Quantity", &name);
    });
    line.col(|ui| {
        let field = ui.add(TextEdit::singleline(&mut row.table.dof).desired_width(46.0));
        named(&field, Role::TextInput, "DOF", &name);
    });
    line.col(|ui| sense(ui, &mut row.table.sign, &name));
    line.col(|ui| {
        let mut unit = row.table.unit.clone().unwrap_or_default();
        let field = ui.add(TextEdit::singleline(&mut unit).desired_width(54.0).hint_text(unit_of(&name)));
        named(&field, Role::TextInput, "Unit", &name);
        row.table.unit = (!unit.trim().is_empty()).then_some(unit);
    });
    line.col(|ui| {
        let mut factor = row.table.factor.unwrap_or(1.0);
        let speed = 0.005 * factor.abs().max(1e-6);
        let drag = ui.add(
            DragValue::new(&mut factor)
                .speed(speed)
                .max_decimals(9)
                .custom_formatter(|v, _| numbers::editable(v))
                .custom_parser(numbers::typed),
        );
        named(&drag, Role::SpinButton, "Factor", &name);
        // Zero would hide the channel.
        let kept = row.table.factor.is_some() || factor != 1.0;
        row.table.factor = (kept && factor != 0.0).then_some(factor);
    });
    line.col(|ui| {
        let mut late = 1e3 * row.table.delay.unwrap_or(0.0);
        let drag = ui.add(DragValue::new(&mut late).speed(0.001).max_decimals(4).custom_parser(numbers::typed));
        named(&drag, Role::SpinButton, "Delay", &name);
        row.table.delay = (late != 0.0).then_some(1e-3 * late);
    });
}

/// A button that turns the sense round.
pub(super) fn sense(ui: &mut Ui, sign: &mut Option<i64>, name: &str) {
    let against = *sign == Some(-1);
    let button = ui.button(if against { " − " } else { " + " });
    button.widget_info(|| WidgetInfo::selected(Role::Button, true, against, tf!("Sense of {name}")));
    if button.on_hover_text(t!("Turns it round.")).clicked() {
        *sign = (!against).then_some(-1);
    }
}

fn named(response: &Response, role: Role, what: &str, channel: &str) {
    response.widget_info(|| WidgetInfo::labeled(role, true, tf!("{what} of {channel}")));
}

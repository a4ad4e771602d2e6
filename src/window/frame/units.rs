//! The menu of units: chosen once, shown everywhere on the screen; files stay SI.

use crate::display::units::{self, Acceleration, Damping, Force, Frequency, Length, Units};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tr};
use egui::Ui;

/// Shows the choices, a group a quantity.
pub(crate) fn menu(ui: &mut Ui) {
    let mut chosen = units::now();
    group(
        ui,
        "Length",
        &mut chosen.length,
        &[(Length::Metre, "m"), (Length::Millimetre, "mm"), (Length::Micrometre, "µm"), (Length::Inch, "in")],
    );
    group(
        ui,
        "Acceleration",
        &mut chosen.acceleration,
        &[(Acceleration::OfLength, "as length, per s²"), (Acceleration::FreeFall, "g")],
    );
    group(
        ui,
        "Force",
        &mut chosen.force,
        &[(Force::Newton, "N"), (Force::Kilonewton, "kN"), (Force::PoundForce, "lbf")],
    );
    group(ui, "Frequency", &mut chosen.frequency, &[(Frequency::Hertz, "Hz"), (Frequency::RadianPerSecond, "rad/s")]);
    group(ui, "Damping of modes", &mut chosen.damping, &Damping::ALL.map(|d| (d, d.words()[0])));
    ui.separator();
    if ui.button(t!("SI units")).clicked() {
        chosen = Units::default();
        ui.close();
    }
    ui.hint("Amplitudes are peak values. Files stay in SI units.");
    if chosen != units::now() {
        units::choose(chosen);
        // Plots start afresh: their ranges belong to the old units.
        ui.ctx().data_mut(egui::util::IdTypeMap::remove_by_type::<egui_plot::PlotMemory>);
        ui.ctx().request_repaint();
    }
}

fn group<T: Copy + PartialEq>(ui: &mut Ui, name: &str, chosen: &mut T, all: &[(T, &str)]) {
    ui.hint(name);
    ui.horizontal(|ui| {
        for (value, label) in all {
            ui.radio_value(chosen, *value, tr(*label));
        }
    });
}

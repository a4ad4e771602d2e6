//! Charts of the engine's results in their panes.

use super::show::Stack;
use crate::display::words;
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::measurement::ChannelFit;
use crate::plots::bode::Diagram;
use crate::plots::pyramid::Pyramid;
use crate::plots::{angle as angles, energy as energies, spectrum as spectra};
use crate::window::appearance::widgets::UiExt;
use egui::Ui;
use std::sync::Arc;

/// Shows the chart with the step that is looked at as a filled point.
pub(crate) fn angle(ui: &mut Ui, outcome: &Outcome, current: usize, limit_deg: f64) {
    let figures = vec![(angles::figure(ui.palette(), outcome, current, limit_deg), 1.0)];
    Stack { id: "angle", title: "Angle against number of sources", figures, keys: true }.show(ui);
}

/// Shows the chart for one step of the selection.
pub(crate) fn energy(ui: &mut Ui, p: &Project, outcome: &Outcome, current: usize) {
    let figures = vec![(energies::figure(ui.palette(), p, outcome, current), 1.0)];
    Stack { id: "energy", title: "Energy per period and run", figures, keys: true }.show(ui);
}

/// Shows a spectrum with the harmonics that were fitted.
pub(crate) fn spectrum(ui: &mut Ui, id: &str, spectrum: &Arc<Pyramid>, fit: &ChannelFit, omega: f64, unit: &str) {
    let figures = vec![(spectra::figure(ui.palette(), spectrum, fit, omega, unit), 1.0)];
    Stack { id, title: &words::capital(id), figures, keys: true }.show(ui);
}

impl Diagram<'_> {
    /// Magnitude and phase over frequency, both axes of frequency logarithmic and linked.
    pub(crate) fn bode(&self, ui: &mut Ui) {
        let [magnitude, phase] = self.bode_figures(ui.palette());
        let figures = vec![(magnitude, 0.60), (phase, 0.40)];
        Stack { id: "bode", title: &self.title("Bode diagram"), figures, keys: true }.show(ui);
    }

    /// Imaginary over real part within a band about `centre` (rad/s).
    pub(crate) fn nyquist(&self, ui: &mut Ui, centre: f64) {
        let figures = vec![(self.nyquist_figure(ui.palette(), centre), 1.0)];
        Stack { id: "nyquist", title: &self.title("Nyquist diagram"), figures, keys: true }.show(ui);
    }
}

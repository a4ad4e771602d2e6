//! Measured against model in the cell that was clicked: along frequency, along level, over a period, as a loop.

use super::look::{Look, Tab};
use crate::diagnosis::Comparison;
use crate::display::format;
use crate::exchange::Project;
use crate::plots::channel_response::ChannelResponse;
use crate::plots::cycle::Cycle;
use crate::plots::figure::Figure;
use crate::plots::response_curve::{Curve, levels, neighbourhood};
use crate::plots::samples;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::plots::show::Stack;
use egui::{Align, Layout, Ui};

/// What is shown of one cell.
pub(super) struct Detail<'a> {
    /// The project.
    pub project: &'a Project,
    /// Model against measurement.
    pub comparison: &'a Comparison,
    /// The same with the effect on trial.
    pub trial: Option<&'a Comparison>,
    /// Selected run.
    pub run: usize,
    /// Selected channel.
    pub channel: &'a str,
    /// The model's curves near the run, one a level.
    pub curves: &'a [Curve],
    /// The curves with the effect on trial.
    pub trial_curves: &'a [Curve],
}

impl Detail<'_> {
    /// Shows tabs and the plot that is chosen.
    pub(super) fn show(&self, ui: &mut Ui, look: &mut Look) {
        let p = self.project;
        let Some(run) = p.runs.get(self.run) else { return };
        let level = run.level.map_or_else(String::new, |l| format!(", level {l}"));
        let frequency = format::with_unit(run.frequency_hz(), "Hz");
        let remarks = [&level, ""].map(|level| format!("run {}, {frequency}{level}", self.run + 1));
        if look.in_bar[1] {
            ui.title(self.channel, &remarks[0]);
        } else {
            ui.horizontal(|ui| {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| self.title_beside(ui, look, &remarks));
            });
        }
        let Some(now) = samples::channel(self.comparison, self.run, self.channel) else {
            ui.empty("Nothing to compare", "This run does not have the channel.");
            return;
        };
        let trial = self.trial.and_then(|c| samples::channel(c, self.run, self.channel));
        let index = samples::index(p, self.run, self.channel);
        let Some(fitted) = index.and_then(|k| run.fit.channels.get(k)) else { return };
        let rotation = p.structure.dofs().get(now.dof).is_some_and(|d| d.direction.is_rotation());
        let cycle = Cycle { run: self.run, fit: &run.fit, now, trial, quantity: fitted.channel.quantity, rotation };
        match look.tab {
            Tab::Time => shown(ui, &cycle.title("one period"), vec![(cycle.time(ui.palette()), 1.0)]),
            Tab::Loop => match cycle.hysteresis(ui.palette()) {
                Some(figure) => shown(ui, &cycle.title("loop"), vec![(figure, 1.0)]),
                None => ui.empty("No force", "The run has no force channel."),
            },
            Tab::Frequency | Tab::Level => self.along(ui, look.tab),
        }
    }

    /// Channel and run beside the switches: they say no more than there is room for.
    fn title_beside(&self, ui: &mut Ui, look: &mut Look, remarks: &[String]) {
        super::switches::tabs(ui, look);
        ui.add_space(space::M);
        let room = ui.available_width() - width(ui, self.channel, theme::font(size::HEADING)) - space::M;
        let fits = |remark: &&String| width(ui, remark, theme::font(size::SMALL)) <= room;
        let remark = remarks.iter().find(fits).map_or("", String::as_str);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = space::S;
            ui.title(self.channel, remark);
        });
    }

    fn along(&self, ui: &mut Ui, tab: Tab) {
        let list = samples::samples(self.project, self.comparison, self.trial, self.channel);
        let near = neighbourhood(self.project, self.run).map(|(near, _)| near).unwrap_or_default();
        let response = ChannelResponse {
            name: self.channel,
            samples: &list,
            run: self.run,
            levels: &levels(self.project, &near),
            channel: samples::index(self.project, self.run, self.channel).unwrap_or(0),
            unit: samples::unit(self.project, self.run, self.channel),
            curves: self.curves,
            trial: self.trial_curves,
        };
        if tab == Tab::Frequency {
            return shown(ui, &response.title("frequency"), response.over_frequency(ui.palette()));
        }
        if let Some(figures) = response.over_level(ui.palette()) {
            return shown(ui, &response.title("level"), figures);
        }
        let frequency = self.project.runs.get(self.run).map_or(0.0, crate::measurement::Run::frequency_hz);
        let frequency = format::with_unit(frequency, "Hz");
        ui.empty("One level only", &format!("At {frequency} there is no run at another force."));
    }
}

fn shown(ui: &mut Ui, title: &str, figures: Vec<(Figure, f32)>) {
    Stack { id: title, title, figures, keys: true }.show(ui);
}

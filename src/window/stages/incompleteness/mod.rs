//! What modes and sensors that were not measured cost the classical methods: errors of each against the number of both.

pub(crate) mod choice;

use crate::window::language::{t, tr};
use choice::{Along, Choice, Error};

use crate::classical::incompleteness::{Case, Incompleteness, METHODS};
use crate::classical::method::Method;
use crate::plots::figure::{Axis, Figure, Look, Ticks};
use crate::window::appearance::theme::{Palette, size};
use crate::window::appearance::widgets::UiExt;
use crate::window::background::derived::Derived;
use crate::window::document::Document;
use crate::window::plots::show::Stack;
use egui::{Color32, Label, RichText, Ui};

/// Least error on the logarithmic axis, per cent: what is below it is as good as none.
const LEAST: f64 = 1e-3;
/// DOFs that are named one by one.
const NAMED: usize = 8;

/// Shows the plot under its choices.
pub(crate) fn show(ui: &mut Ui, document: &Document, derived: &mut Derived, choice: &mut Choice) {
    let study = match derived.incompleteness(ui.ctx(), document) {
        Some(Ok(study)) => study,
        Some(Err(error)) => return ui.empty("Nothing to study", &error),
        None => return ui.empty("The study is running", "Its progress is in the bar below."),
    };
    choice.set = choice.set.min(study.sensors.len().saturating_sub(1));
    let with_mac = study.cases.iter().flat_map(|c| &c.methods).flatten().any(|e| e.mac.is_some());
    ui.horizontal_wrapped(|ui| {
        ui.hint("Along");
        for (value, name) in [(Along::Modes, "modes"), (Along::Sensors, "sensors")] {
            ui.selectable_value(&mut choice.along, value, tr(name));
        }
        ui.separator();
        ui.hint("Error of");
        ui.selectable_value(&mut choice.error, Error::Matrix, t!("damping matrix"));
        ui.add_enabled_ui(with_mac, |ui| {
            ui.selectable_value(&mut choice.error, Error::Mac, t!("modes (MAC)"))
                .on_disabled_hover_text(t!("The structure has too many DOFs for the modes of every matrix."));
        });
    });
    if choice.along == Along::Modes {
        ui.horizontal_wrapped(|ui| {
            ui.hint("Measured DOFs");
            for (k, set) in study.sensors.iter().enumerate() {
                let names = names(&document.project.structure, set);
                ui.selectable_value(&mut choice.set, k, set.len().to_string()).on_hover_text(tr(names));
            }
        });
    }
    let remark = remark(&study, *choice);
    ui.add(Label::new(RichText::new(tr(remark)).size(size::SMALL).color(ui.palette().weak)).truncate());
    let figure = figure(&study, *choice, ui.palette());
    let id = format!("incompleteness {choice:?}");
    let title = "Errors of the classical methods with incomplete data";
    Stack { id: &id, title, figures: vec![(figure, 1.0)], keys: true }.show(ui);
}

fn names(structure: &crate::structure::Structure, set: &[usize]) -> String {
    let first: Vec<&str> = set.iter().take(NAMED).map(|&dof| structure.label(dof)).collect();
    first.join(", ") + if set.len() > NAMED { ", …" } else { "" }
}

fn remark(study: &Incompleteness, choice: Choice) -> String {
    let how = "exact modes without noise: what is lost is lost by what was not measured";
    match (choice.along, common_modes(study)) {
        (Along::Sensors, Some(modes)) => format!("{modes} modes measured; {how}"),
        _ => format!("{} DOFs measured; {how}", study.sensors.get(choice.set).map_or(0, Vec::len)),
    }
}

/// The largest number of modes that every set of sensors allows.
fn common_modes(study: &Incompleteness) -> Option<usize> {
    let most = |set: usize| study.cases.iter().filter(|c| c.sensors == set).map(|c| c.modes).max();
    let least = (0..study.sensors.len()).map(most).collect::<Option<Vec<_>>>()?.into_iter().min()?;
    Some(least)
}

/// Errors of all methods as a plot.
fn figure(study: &Incompleteness, choice: Choice, palette: &Palette) -> Figure {
    let modes = common_modes(study);
    let chosen = |c: &&Case| match choice.along {
        Along::Modes => c.sensors == choice.set,
        Along::Sensors => Some(c.modes) == modes,
    };
    let x = |c: &Case| match choice.along {
        Along::Modes => c.modes as f64,
        Along::Sensors => study.sensors[c.sensors].len() as f64,
    };
    let curve = |value: &dyn Fn(&Case) -> Option<f64>| {
        let point = |c: &Case| Some([x(c), value(c)?.max(LEAST)]);
        let mut points: Vec<[f64; 2]> = study.cases.iter().filter(chosen).filter_map(point).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    };
    let (name, unit) = match choice.error {
        Error::Matrix => ("Error", "%"),
        Error::Mac => ("MAC error", ""),
    };
    let axis = match choice.along {
        Along::Modes => "Measured modes",
        Along::Sensors => "Measured DOFs",
    };
    let title = format!("{name} against {}", axis.to_lowercase());
    let most = study.cases.iter().filter(chosen).map(x).fold(1.0, f64::max);
    let across = Axis::new(axis, "").ticks(Ticks::Whole).include(&[0.7, most + 0.3]);
    let mut figure = Figure::new(&title, across, Axis::log(name, unit));
    for (k, method) in METHODS.into_iter().enumerate() {
        let (colour, line) = look(method, palette);
        let points = curve(&|c| choice.of(c.methods[k].as_ref().ok()?));
        figure = figure.points(method.title(), colour, line, points.clone()).points(
            method.title(),
            colour,
            Look::Dots(2.5),
            points,
        );
    }
    if choice.error == Error::Matrix {
        figure = figure.points("Projection error", palette.weak, Look::Dotted(1.6), curve(&|c| Some(c.eps_p)));
    }
    figure.series.retain(|s| !s.points(f64::NEG_INFINITY, f64::INFINITY, 1).is_empty());
    figure
}

/// One colour a family of methods, broken for its second member.
fn look(method: Method, palette: &Palette) -> (Color32, Look) {
    match method {
        Method::Lancaster => (palette.measured, Look::Line(1.8)),
        Method::PilkeyInmanDirect => (palette.measured, Look::Dashed(1.8)),
        Method::AdhikariWoodhouse => (palette.accent, Look::Line(1.8)),
        Method::AdhikariWoodhouseSymmetric => (palette.accent, Look::Dashed(1.8)),
        Method::Ibrahim => (palette.model, Look::Line(1.8)),
        Method::MinasInman => (palette.missing, Look::Line(1.8)),
        _ => (palette.ink, Look::Line(1.4)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::classical::incompleteness::{Grid, incompleteness};
    use crate::common::models;
    use crate::control::Control;
    use faer::Mat;

    fn study() -> Incompleteness {
        let structure = models::chain(&[1.0, 2.0, 1.5, 1.0], &[1e4; 4], &[2e4; 3]);
        let truth = Mat::from_fn(4, 4, |i, j| if i == j { 1.0 + i as f64 } else { 0.0 });
        let control = Control::unattended();
        incompleteness(&structure, truth.as_ref(), &Grid::new(&structure, &[]), &control).unwrap()
    }

    #[test]
    fn errors_are_drawn_along_modes_and_along_sensors() {
        let study = study();
        let along = figure(&study, Choice::default(), Palette::light());
        let lancaster = along.series.iter().find(|s| s.name == Method::Lancaster.title()).unwrap();
        let values = lancaster.points(0.0, 10.0, 10);
        let expected = study.eps_c(0, Method::Lancaster);
        assert_eq!(values.len(), expected.len());
        assert!(values.iter().zip(&expected).all(|(a, b)| a[0] == b[0] && (a[1] - b[1].max(LEAST)).abs() < 1e-12));
        let across = figure(&study, Choice { along: Along::Sensors, ..Choice::default() }, Palette::light());
        let counts = across.series[0].points(0.0, 10.0, 10);
        assert_eq!(counts.len(), study.sensors.len(), "{counts:?}");
    }
}

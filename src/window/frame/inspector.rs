//! What is selected, with every value and its unit.

use crate::effects::{Place, State};
use crate::exchange::Project;
use crate::window::app::{App, Ask};
use crate::window::document::Edit;
use crate::window::theme::space;
use crate::window::view::Stage;
use crate::window::widgets::UiExt;
use crate::window::{format, words};
use egui::{DragValue, ScrollArea, Ui};

/// Shows the inspector.
pub fn show(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let Some(document) = &app.document else { return };
    let p = &document.project;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match (app.view.source, app.view.dof) {
        (Some(source), _) if source < p.sources.len() => self::source(ui, p, source, asks),
        (_, Some(dof)) if dof < p.structure.len() => self::dof(ui, p, dof),
        _ if app.view.stage == Stage::Measure && app.view.run < p.runs.len() => run(ui, p, app.view.run, asks),
        _ => project(ui, p),
    });
}

fn project(ui: &mut Ui, p: &Project) {
    ui.title("Project", "");
    ui.add_space(space::XS);
    ui.label(&p.title);
    if !p.notes.is_empty() {
        ui.hint(&p.notes);
    }
    ui.add_space(space::S);
    ui.pair("Structure", words::kind(p.structure.kind()));
    ui.pair("Degrees of freedom", p.structure.len().to_string());
    ui.pair("Nodes", p.structure.nodes().len().to_string());
    ui.pair("Runs", p.runs.len().to_string());
    for state in [State::Candidate, State::Forced, State::Known, State::Reference, State::Off] {
        let count = p.sources.iter().filter(|s| s.state == state).count();
        if count > 0 {
            ui.pair(&format!("Sources, {}", words::state(state)), count.to_string());
        }
    }
    ui.add_space(space::M);
    ui.title("Analysis", "");
    ui.pair("Harmonics fitted", p.settings.harmonics.to_string());
    ui.pair("Most sources", p.settings.max_sources.to_string());
    ui.pair("Best single columns kept", p.settings.keep.to_string());
    ui.pair("Stops below", format!("{}°", format::significant(p.settings.stop_angle_deg, 2)));
    ui.add_space(space::M);
    ui.hint("Select a DOF, a source or a run to see its values.");
}

fn run(ui: &mut Ui, p: &Project, index: usize, asks: &mut Vec<Ask>) {
    let r = &p.runs[index];
    ui.title(&format!("Run {}", index + 1), &r.file);
    ui.add_space(space::XS);
    let mut used = r.enabled;
    if ui.checkbox(&mut used, "Used in the analysis").changed() {
        asks.push(Ask::Edit(Edit::UseRun(index, used)));
    }
    ui.pair("Frequency", frequency(r));
    ui.pair("Period", format::prefixed(r.fit.period(), "s"));
    if let Some(level) = r.level {
        ui.pair("Force level", level.to_string());
    }
    ui.pair("Noise over signal", format::percent(r.noise_ratio));
    if let Some(record) = &r.record {
        ui.pair("Samples a channel", record.time().len().to_string());
        let span = record.time().last().unwrap_or(&0.0) - record.time().first().unwrap_or(&0.0);
        ui.pair("Duration", format::prefixed(span, "s"));
        ui.pair("Periods", format::significant(span / r.fit.period(), 3));
    }
    ui.add_space(space::M);
    ui.title("What is wrong", "");
    if r.findings.is_empty() {
        ui.hint("Nothing was found wrong with this record.");
    }
    for finding in &r.findings {
        ui.add_space(space::XS);
        ui.pill(words::flag(finding.flag), ui.palette().warning);
        ui.label(&finding.reason);
    }
}

/// Frequency with its deviation where it was estimated.
pub fn frequency(run: &crate::measurement::Run) -> String {
    let hertz = std::f64::consts::TAU;
    format::with_deviation(run.fit.omega / hertz, run.fit.omega_deviation / hertz, "Hz")
}

fn dof(ui: &mut Ui, p: &Project, dof: usize) {
    let d = &p.structure.dofs()[dof];
    let node = &p.structure.nodes()[d.node];
    ui.title(&format!("DOF {}", d.label), if d.direction.is_rotation() { "rotation" } else { "translation" });
    ui.add_space(space::XS);
    ui.pair("Node", node.label.clone());
    for (name, value) in ["x", "y", "z"].into_iter().zip(node.position) {
        ui.pair(name, format::with_unit(value, "m"));
    }
    if let Some(m) = p.structure.matrices() {
        let unit = if d.direction.is_rotation() { ("kg·m²", "N·m/rad") } else { ("kg", "N/m") };
        ui.pair("Mass on the diagonal", format::with_unit(m.mass[(dof, dof)], unit.0));
        ui.pair("Stiffness on the diagonal", format::with_unit(m.stiffness[(dof, dof)], unit.1));
    }
    ui.add_space(space::M);
    ui.title("Sources here", "");
    let here = |s: &&crate::effects::Source| matches!(&s.place, Place::Dofs(dofs) if dofs.contains(&dof));
    let mut any = false;
    for source in p.sources.iter().filter(here) {
        any = true;
        ui.pair(words::effect(source.effect), words::place(&p.structure, &source.place));
    }
    if !any {
        ui.hint("None.");
    }
}

fn source(ui: &mut Ui, p: &Project, index: usize, asks: &mut Vec<Ask>) {
    let s = &p.sources[index];
    ui.title("Source", words::effect(s.effect));
    ui.add_space(space::XS);
    let place = words::place(&p.structure, &s.place);
    let ground = matches!(&s.place, Place::Dofs(d) if d.len() == 1);
    ui.pair("Place", if ground { format!("DOF {place}") } else { place });
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        for state in [State::Candidate, State::Forced, State::Known, State::Off] {
            if ui.selectable_label(s.state == state, words::state(state)).clicked() {
                asks.push(Ask::Edit(Edit::SetState(index, state)));
            }
        }
    });
    ui.hint(match s.state {
        State::Candidate => "May be selected; its value is identified.",
        State::Forced => "Always selected; its value is identified.",
        State::Known => "In the model at the value below.",
        State::Off => "Ignored.",
        State::Reference => "Only shown beside the result: a known truth.",
    });
    ui.add_space(space::S);
    for (k, parameter) in s.effect.parameters().iter().enumerate() {
        if parameter.linear && matches!(s.state, State::Candidate | State::Forced) {
            ui.pair(parameter.name, "identified");
            continue;
        }
        let mut value = s.parameters[k];
        let changed = ui
            .horizontal(|ui| {
                ui.hint(parameter.name);
                let speed = (0.01 * value.abs()).max(1e-6);
                let suffix = format!(" {}", format::pretty_unit(parameter.unit));
                ui.add(DragValue::new(&mut value).speed(speed).suffix(suffix).max_decimals(6)).changed()
            })
            .inner;
        if changed {
            asks.push(Ask::Edit(Edit::SetParameter(index, k, value)));
        }
    }
    ui.add_space(space::M);
    if ui.button("Remove source").clicked() {
        asks.push(Ask::Edit(Edit::Remove(index)));
    }
}

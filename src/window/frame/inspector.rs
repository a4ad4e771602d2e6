//! What is selected, with every value and its unit.

use crate::balance::{Expansion, Weights};
use crate::display::{format, words};
use crate::effects::{Place, State};
use crate::exchange::Project;
use crate::exchange::project::ProjectFile;
use crate::identify::Settings;
use crate::session::{Command, Setting};
use crate::window::app::ask::Ask;
use crate::window::app::view::{Stage, View};
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::document::Document;
use crate::window::document::edits::Edit;
use crate::window::language::{t, tr};
use egui::{ScrollArea, Ui};

/// Shows the inspector.
pub(crate) fn show(ui: &mut Ui, document: &Document, view: &View, asks: &mut Vec<Ask>) {
    let p = &document.project;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match (view.source, view.dof) {
        (Some(source), _) if source < p.sources.len() => self::source(ui, p, source, asks),
        (_, Some(dof)) if dof < p.structure.len() => {
            self::dof(ui, p, dof);
            sensors(ui, p, document.session().document().file(), dof, asks);
        }
        _ if view.stage == Stage::Measure && view.run < p.runs.len() => run(ui, p, view.run, asks),
        _ => project(ui, p, asks),
    });
}

fn set(asks: &mut Vec<Ask>, command: Command) {
    asks.push(Ask::Edit(Edit::Do(command)));
}

fn project(ui: &mut Ui, p: &Project, asks: &mut Vec<Ask>) {
    ui.title("Project", "");
    let mut title = p.title.clone();
    let field = ui.add(egui::TextEdit::singleline(&mut title).desired_width(f32::INFINITY));
    field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, t!("Title")));
    if field.changed() {
        set(asks, Command::SetTitle(title));
    }
    if !p.notes.is_empty() {
        ui.hint(&p.notes);
    }
    ui.add_space(space::S);
    ui.pair("Structure", words::kind(p.structure.kind()));
    ui.pair("Degrees of freedom", p.structure.len().to_string());
    ui.pair("Nodes", p.structure.nodes().len().to_string());
    if !p.runs.is_empty() || p.transient_runs.is_empty() {
        ui.pair("Runs", p.runs.len().to_string());
    }
    if !p.transient_runs.is_empty() {
        ui.pair("Records over time", p.transient_runs.len().to_string());
    }
    for state in [State::Candidate, State::Forced, State::Known, State::Reference, State::Off] {
        let count = p.sources.iter().filter(|s| s.state == state).count();
        if count > 0 {
            ui.pair(&format!("Sources, {}", state.word()), count.to_string());
        }
    }
    ui.add_space(space::M);
    analysis(ui, &p.settings, asks);
    ui.add_space(space::M);
    ui.hint("Select a DOF, a source or a run to see and change its values.");
}

fn analysis(ui: &mut Ui, s: &Settings, asks: &mut Vec<Ask>) {
    ui.title("Analysis", "");
    let counts: [(&str, usize, fn(usize) -> Setting); 3] = [
        ("Harmonics fitted", s.harmonics, Setting::Harmonics),
        ("Sources at most", s.max_sources, Setting::MaxSources),
        ("Sets kept (0: all)", s.keep, Setting::Keep),
    ];
    for (name, value, setting) in counts {
        if let Some(new) = ui.quantity(name, value as f64, "") {
            set(asks, Command::SetSetting(setting(new.round().max(0.0) as usize)));
        }
    }
    if let Some(new) = ui.quantity("Stop angle", s.stop_angle_deg, "°") {
        set(asks, Command::SetSetting(Setting::StopAngleDeg(new)));
    }
    let expansions = [Expansion::Auto, Expansion::None, Expansion::SingleMode, Expansion::Modes, Expansion::Dynamic];
    if let Some(new) = ui.choice("Expansion", s.expansion, &expansions, words::expansion) {
        set(asks, Command::SetSetting(Setting::Expansion(new)));
    }
    let weights = [Weights::Auto, Weights::None, Weights::Energy, Weights::Noise];
    if let Some(new) = ui.choice("Weights", s.weights, &weights, words::weights) {
        set(asks, Command::SetSetting(Setting::Weights(new)));
    }
}

fn run(ui: &mut Ui, p: &Project, index: usize, asks: &mut Vec<Ask>) {
    let r = &p.runs[index];
    ui.title(&format!("Run {}", index + 1), &r.file);
    ui.add_space(space::XS);
    let mut used = r.enabled;
    if ui.checkbox(&mut used, t!("Used in the analysis")).changed() {
        asks.push(Ask::Edit(Edit::UseRun(r.file.clone(), used)));
    }
    ui.pair("Frequency", frequency(r));
    if r.record.is_some() {
        adjust(ui, r, asks);
    }
    ui.pair("Period", format::prefixed(r.fit.period(), "s"));
    ui.pair("Noise over signal", words::noise(r));
    if let Some(record) = &r.record {
        ui.pair("Samples per channel", record.time().len().to_string());
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
        ui.label(tr(&finding.reason));
    }
}

/// What can be said about a run: its frequency, its level, whether it belongs to the project at all.
fn adjust(ui: &mut Ui, r: &crate::measurement::Run, asks: &mut Vec<Ask>) {
    let hertz = r.fit.omega / std::f64::consts::TAU;
    let file = || r.file.clone();
    if let Some(new) = ui.quantity("Fit frequency", hertz, "Hz") {
        set(asks, Command::SetRunFrequency { file: file(), frequency: (new > 0.0).then_some(new) });
    }
    if let Some(new) = ui.quantity("Force level", r.level.unwrap_or(0) as f64, "") {
        set(asks, Command::SetRunLevel { file: file(), level: (new != 0.0).then_some(new.round() as i64) });
    }
    ui.add_space(space::XS);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.y = space::S;
        if ui.button(t!("Estimate the frequency")).clicked() {
            set(asks, Command::SetRunFrequency { file: file(), frequency: None });
        }
        if ui.button(t!("Remove run")).clicked() {
            set(asks, Command::RemoveRun(file()));
        }
    });
}

/// Known errors of the channels of a DOF.
fn sensors(ui: &mut Ui, p: &Project, file: &ProjectFile, dof: usize, asks: &mut Vec<Ask>) {
    let mut names: Vec<String> = Vec::new();
    let steady = p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
    let over_time = p.transient_runs.iter().flat_map(crate::measurement::TransientRun::channels);
    for channel in steady.chain(over_time).filter(|c| c.dof == dof) {
        let name = channel.to_string();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for channel in names {
        ui.add_space(space::S);
        ui.title(&channel, "known errors of the channel");
        let table = file.sensor.iter().find(|t| t.channel == channel);
        let (delay, gain) = (table.and_then(|t| t.delay), table.and_then(|t| t.gain));
        if let Some(new) = ui.quantity(&format!("Delay of {channel}"), delay.unwrap_or(0.0), "s") {
            let delay = (new != 0.0).then_some(new);
            set(asks, Command::SetSensor { channel: channel.clone(), delay, gain });
        }
        if let Some(new) = ui.quantity(&format!("Gain of {channel}"), gain.unwrap_or(1.0), "") {
            let gain = (new != 1.0).then_some(new);
            set(asks, Command::SetSensor { channel: channel.clone(), delay, gain });
        }
    }
}

/// Frequency with its deviation where it was estimated.
pub(crate) fn frequency(run: &crate::measurement::Run) -> String {
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
        ui.pair(source.effect.noun(), source.place.cell(&p.structure));
    }
    if !any {
        ui.hint("None.");
    }
}

fn source(ui: &mut Ui, p: &Project, index: usize, asks: &mut Vec<Ask>) {
    let s = &p.sources[index];
    ui.title("Source", s.effect.noun());
    ui.add_space(space::XS);
    let place = s.place.cell(&p.structure);
    let ground = matches!(&s.place, Place::Dofs(d) if d.len() == 1);
    ui.pair("Place", if ground { format!("DOF {place}") } else { place });
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        for state in [State::Candidate, State::Forced, State::Known, State::Off] {
            if ui.selectable_label(s.state == state, tr(state.word())).clicked() {
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
        if parameter.linear && s.state.is_sought() {
            ui.pair(parameter.name, "identified");
            continue;
        }
        if let Some(value) = ui.quantity(parameter.name, s.parameters[k], parameter.unit) {
            asks.push(Ask::Edit(Edit::SetParameter(index, k, value)));
        }
    }
    ui.add_space(space::M);
    if ui.button(t!("Remove source")).clicked() {
        asks.push(Ask::Edit(Edit::Remove(index)));
    }
}

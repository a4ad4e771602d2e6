//! A report of a project in one HTML file: what was measured, what was identified and how well, with its plots.

mod html;

use super::forward;
use super::plots::bode::Diagram;
use super::plots::figure::Figure;
use super::plots::heatmap::{HeatMap, occupied};
use super::plots::sheet::{Panel, Sheet};
use super::plots::{angle, energy};
use super::stages::coefficient;
use super::theme::Palette;
use super::{format, words};
use crate::control::Control;
use crate::diagnosis::{Problem, compare};
use crate::exchange::Project;
use crate::exchange::atomic::write_atomically;
use crate::identify::results::ModeResult;
use crate::identify::{Outcome, identify};
use crate::measurement::Quantity;
use crate::response::frequency_response::Quantity as Response;
use egui::vec2;
use html::Page;
use std::f64::consts::TAU;
use std::path::Path;

/// Natural frequencies that are listed.
const MOST_MODES: usize = 12;

/// Reads a project, identifies and writes the report; blocks.
///
/// # Errors
/// One line: the project, the identification or the file.
pub fn report(file: &Path, out: &Path) -> Result<(), String> {
    let control = Control::unattended();
    let project = crate::exchange::project::load(file, &control).map_err(|e| e.to_string())?;
    let outcome = identify(&project.structure, &project.sources, &project.runs, &project.settings, &control)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    write(&project, &outcome, out, &control).map(drop)
}

/// Writes the report of what was identified; says what was written.
///
/// # Errors
/// One line: the file.
pub fn write(project: &Project, outcome: &Outcome, out: &Path, control: &Control) -> Result<String, String> {
    let text = document(project, outcome, control);
    write_atomically(out, text.as_bytes()).map_err(|e| format!("{}: cannot be written ({e})", out.display()))?;
    Ok(format!("Written: {}.", out.display()))
}

/// The whole file.
pub fn document(project: &Project, outcome: &Outcome, control: &Control) -> String {
    let mut page = Page::default();
    if !project.notes.is_empty() {
        page.sentence(&project.notes);
    }
    page.remark(&format!(
        "Dashpot {}. All values in SI units; ± is one standard deviation.",
        env!("CARGO_PKG_VERSION")
    ));
    structure(&mut page, project);
    runs(&mut page, project, outcome);
    identified(&mut page, project, outcome);
    responses(&mut page, project, outcome, control);
    agreement(&mut page, project, control);
    page.finish(&project.title)
}

fn structure(page: &mut Page, p: &Project) {
    page.chapter("Structure");
    page.sentence(&format!(
        "{}, {} degrees of freedom.",
        words::capital(words::kind(p.structure.kind())),
        p.structure.len()
    ));
    if let Ok(modes) = p.structure.modes() {
        let row = |r: usize| vec![(r + 1).to_string(), format::with_unit(modes.frequency_hz(r), "Hz")];
        let rows: Vec<Vec<String>> = (0..modes.len().min(MOST_MODES)).map(row).collect();
        page.table(&["Mode", "Natural frequency|"], &rows);
    }
}

fn runs(page: &mut Page, p: &Project, outcome: &Outcome) {
    page.chapter("Measurements");
    let row = |run: &crate::measurement::Run| {
        let level = run.level.map_or_else(String::new, |l| l.to_string());
        let flags: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
        let used = if run.enabled { flags.join("; ") } else { "not used".to_owned() };
        vec![
            run.file.clone(),
            format::with_unit(run.frequency_hz(), "Hz"),
            level,
            format::percent(run.noise_ratio),
            used,
        ]
    };
    let rows: Vec<Vec<String>> = p.runs.iter().map(row).collect();
    page.table(&["Run", "Frequency|", "Level|", "Noise|", "Remarks"], &rows);
    figure(page, energy::figure(Palette::paper(), p, outcome, outcome.accepted));
}

fn identified(page: &mut Page, p: &Project, outcome: &Outcome) {
    page.chapter("Where the energy is lost");
    let step = outcome.accepted_step();
    page.sentence(&format!(
        "{} explain{} the energies to {} (angle {}°).",
        words::counted(step.count, "source"),
        if step.count == 1 { "s" } else { "" },
        format::percent(step.relative_error),
        format::significant(step.angle_deg, 4)
    ));
    let rows = outcome.sources.iter().filter_map(|e| {
        let s = p.sources.get(e.source)?;
        Some(vec![
            words::capital(words::effect(s.effect)),
            words::place(&p.structure, &s.place),
            words::state(s.state).to_owned(),
            coefficient(s, e),
            format::percent(0.01 * e.energy_percent),
        ])
    });
    page.table(&["Law", "Place", "State", "Coefficient|", "Energy|"], &rows.collect::<Vec<_>>());
    outcome.warnings.iter().for_each(|w| page.warning(w));
    figure(page, angle::figure(Palette::paper(), outcome, outcome.accepted, p.settings.stop_angle_deg));
    let (matrix, title) = if outcome.results.others.is_empty() {
        (&outcome.results.viscous, "Damping matrix")
    } else {
        (&outcome.results.equivalent_viscous, "Damping matrix, viscous of equal energy")
    };
    let rows = occupied(matrix);
    if !rows.is_empty() {
        let labels: Vec<String> = p.structure.dofs().iter().map(|d| d.label.clone()).collect();
        let map = HeatMap { matrix, rows: &rows, labels: &labels, unit: "N s/m", scale: None };
        page.drawing(&map.paper(title, Palette::paper()));
    }
    ratios(page, outcome);
}

fn ratios(page: &mut Page, outcome: &Outcome) {
    if outcome.results.modes.is_empty() {
        return;
    }
    page.chapter("Damping ratios");
    let row = |(r, mode): (usize, &ModeResult)| {
        vec![
            (r + 1).to_string(),
            format::with_unit(mode.frequency_hz, "Hz"),
            format::with_deviation(100.0 * mode.damping_ratio, 100.0 * mode.damping_ratio_deviation, "%"),
            mode.half_power_ratio.map_or_else(|| "–".to_owned(), format::percent),
        ]
    };
    let rows: Vec<Vec<String>> = outcome.results.modes.iter().take(MOST_MODES).enumerate().map(row).collect();
    page.table(&["Mode", "Frequency|", "Damping ratio|", "From half-power points|"], &rows);
}

fn responses(page: &mut Page, p: &Project, outcome: &Outcome, control: &Control) {
    let channels = || p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
    let excitation = channels().find(|c| c.quantity == Quantity::Force).map(|c| c.dof);
    let sensor = channels().filter(|c| c.quantity != Quantity::Force).map(|c| c.dof).next_back();
    let (Some(excitation), Some(sensor)) = (excitation, sensor) else { return };
    let omega = forward::frequencies(p, outcome);
    let sources = forward::acting(p, outcome);
    let Ok(response) = forward::receptance(&p.structure, &sources, omega, [sensor, excitation], control) else {
        return;
    };
    page.chapter("Frequency response of the identified model");
    let diagram = Diagram { project: p, response: &response, quantity: Response::Receptance };
    sheet(page, &diagram.title("Bode diagram"), diagram.bode_figures(Palette::paper()).into());
    let centre = p.runs.iter().find(|r| r.enabled).map_or(1.0, |r| r.fit.omega);
    let title = format!("Nyquist diagram near {}", format::with_unit(centre / TAU, "Hz"));
    sheet(page, &title, vec![diagram.nyquist_figure(Palette::paper(), centre)]);
}

/// How well the model as it stands predicts the measured responses.
fn agreement(page: &mut Page, p: &Project, control: &Control) {
    let problem = Problem { structure: &p.structure, sources: &p.sources, runs: &p.runs };
    let known = p.sources.iter().any(|s| s.state == crate::effects::State::Known);
    if !known {
        return;
    }
    page.chapter("Model of the known sources against the measurement");
    match compare(&problem, &[], control) {
        Ok(found) => page.sentence(&format!(
            "Error of the responses {}, of the energies {}; noise alone would leave {}.",
            format::percent(found.error),
            format::percent(found.energy_error),
            format::percent(found.noise_floor)
        )),
        Err(error) => page.warning(&error.to_string()),
    }
}

fn figure(page: &mut Page, figure: Figure) {
    let title = figure.title.clone();
    sheet(page, &title, vec![figure]);
}

fn sheet(page: &mut Page, title: &str, figures: Vec<Figure>) {
    let square = figures.iter().any(|figure| figure.square);
    let size = if square { vec2(640.0, 600.0) } else { vec2(900.0, 300.0 + 220.0 * (figures.len() - 1) as f32) };
    let panels = figures.into_iter().map(|figure| Panel { bounds: figure.bounds(), figure }).collect();
    let sheet = Sheet { title: title.to_owned(), columns: 1, panels };
    page.drawing(&sheet.drawing(size, Palette::paper()));
}

//! Chapters of what was identified: sources, damping matrix, damping ratios, frequency responses.

use super::content::Content;
use super::figures::{MOST_MODES, figure, sheet};
use super::page::Page;
use super::section::Section;
use crate::control::Control;
use crate::display::{format, words};
use crate::effects::{Source, State};
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::identify::results::ModeResult;
use crate::measurement::Quantity;
use crate::plots::bode::Diagram;
use crate::plots::heatmap::{HeatMap, occupied};
use crate::plots::style::Palette;
use crate::plots::{angle, energy, forward};
use crate::response::frequency_response::ResponseForm as Response;
use std::f64::consts::TAU;

/// Adds them.
pub(super) fn chapters(page: &mut Page, content: &Content<'_>, control: &Control) {
    let p = content.project;
    page.chapter(Section::Energy, "Where the energy is lost");
    match &content.outcome {
        Ok(outcome) => {
            // The energies of records over time are those of windows, not of periods and runs.
            if !outcome.runs.is_empty() {
                figure(page, energy::figure(Palette::light(), p, outcome, outcome.accepted));
            }
            identified(page, p, outcome);
            ratios(page, outcome);
        }
        Err(_) if states_all(p) => {
            page.sentence("No source was identified: the project states all of its sources with their sizes.");
        }
        Err(reason) => {
            page.sentence(&format!("No sources were identified: {reason}."));
        }
    }
    responses(page, content, control);
}

/// Whether a project states what dissipates and leaves none of it to be identified.
fn states_all(p: &Project) -> bool {
    let open = |s: &Source| s.state.is_sought();
    p.sources.iter().any(|s| s.state == State::Known) && !p.sources.iter().any(open)
}

fn identified(page: &mut Page, p: &Project, outcome: &Outcome) {
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
            s.effect.title().to_owned(),
            s.place.cell(&p.structure),
            s.state.word().to_owned(),
            words::coefficient(s, e),
            format::percent(0.01 * e.energy_percent),
        ])
    });
    page.table("Identified sources", &["Law", "Place", "State", "Coefficient|", "Energy|"], &rows.collect::<Vec<_>>());
    outcome.warnings.iter().for_each(|w| page.warning(w));
    figure(page, angle::figure(Palette::light(), outcome, outcome.accepted, p.settings.stop_angle_deg));
    let (matrix, title) = if outcome.results.others.is_empty() {
        (&outcome.results.viscous, "Damping matrix")
    } else {
        (&outcome.results.equivalent_viscous, "Damping matrix, viscous of equal energy")
    };
    let rows = occupied(matrix);
    if !rows.is_empty() {
        let labels: Vec<String> = p.structure.dofs().iter().map(|d| d.label.clone()).collect();
        let map = HeatMap { matrix, rows: &rows, columns: &rows, labels: &labels, unit: "N s/m", scale: None };
        page.drawing(&map.paper(title, Palette::light()), &map.table());
    }
}

fn ratios(page: &mut Page, outcome: &Outcome) {
    if outcome.results.modes.is_empty() {
        return;
    }
    page.chapter(Section::Ratios, "Damping ratios");
    let row = |(r, mode): (usize, &ModeResult)| {
        vec![
            (r + 1).to_string(),
            format::with_unit(mode.frequency_hz, "Hz"),
            format::with_deviation(100.0 * mode.damping_ratio, 100.0 * mode.damping_ratio_deviation, "%"),
            mode.half_power_ratio.map_or_else(|| "–".to_owned(), format::percent),
        ]
    };
    let rows: Vec<Vec<String>> = outcome.results.modes.iter().take(MOST_MODES).enumerate().map(row).collect();
    page.table(
        "Damping ratios of the identified model",
        &["Mode", "Frequency|", "Damping ratio|", "From half-power points|"],
        &rows,
    );
}

/// Of the identified model; of the known sources where nothing was identified.
fn responses(page: &mut Page, content: &Content<'_>, control: &Control) {
    let p = content.project;
    let channels = || p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
    let excitation = channels().find(|c| c.quantity == Quantity::Force).map(|c| c.dof);
    let sensor = channels().filter(|c| c.quantity != Quantity::Force).map(|c| c.dof).next_back();
    let (Some(excitation), Some(sensor)) = (excitation, sensor) else { return };
    let (omega, sources, title) = if let Ok(o) = &content.outcome {
        (forward::frequencies(p, o), forward::acting(p, o), "Frequency response of the identified model")
    } else {
        let title = "Frequency response of the linear part of the known sources";
        (forward::frequencies_of_modes(p), forward::known(p), title)
    };
    let Ok(response) = forward::receptance(&p.structure, &sources, omega, [sensor, excitation], control) else {
        return;
    };
    page.chapter(Section::Responses, title);
    let diagram = Diagram { project: p, response: &response, quantity: Response::Receptance };
    sheet(page, &diagram.title("Bode diagram"), diagram.bode_figures(Palette::light()).into());
    let centre = p.runs.iter().find(|r| r.enabled).map_or(1.0, |r| r.fit.omega);
    let title = format!("Nyquist diagram near {}", format::with_unit(centre / TAU, "Hz"));
    sheet(page, &title, vec![diagram.nyquist_figure(Palette::light(), centre)]);
}

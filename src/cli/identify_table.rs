//! `identify` for a reader: runs, selection, sources, energy, modes, each a table with units.

use super::table::{number, significant, table};
use crate::effects::{Source, State};
use crate::exchange::Project;
use crate::identify::outcome::WindowOutcome;
use crate::identify::{Estimate, Outcome, SelectionStatus, SelectionStep};
use crate::structure::Structure;
use faer::Mat;
use std::f64::consts::TAU;

/// Shares of energy below this many per cent are summed up.
const LEAST_SHARE: f64 = 0.05;
/// Modes that are printed; `--json` has all.
const MOST_MODES: usize = 10;
/// DOFs up to which the matrix is printed in full; `--json` and `export` have all.
const MOST_DOFS: usize = 8;

/// The whole report.
pub(super) fn report(project: &Project, outcome: &Outcome) -> String {
    let parts = [
        format!("{}\n", project.title),
        super::reduction::text(&project.structure),
        runs(project, outcome),
        records(project, outcome),
        selection(project, outcome),
        format!("Accepted: {} sources. {}\n{}", outcome.accepted_step().count, outcome.reason, above_noise(outcome)),
        sources(project, outcome),
        indistinguishable(project, outcome),
        energy(project, outcome),
        modes(outcome),
        matrix(&project.structure, &outcome.results.viscous),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

/// What is said where no set of the candidates explains the measurement.
fn above_noise(outcome: &Outcome) -> &'static str {
    match outcome.status {
        SelectionStatus::AboveNoise => {
            "These candidates alone do not explain what was measured; `dashpot diagnose` looks for other laws, and for errors of\n\
             the model and of channels.\n"
        }
        _ => "",
    }
}

fn head(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|&cell| cell.to_owned()).collect()
}

/// The runs that are not steady, each with the energies over all its windows.
fn records(project: &Project, outcome: &Outcome) -> String {
    let mut rows =
        vec![head(&["record", "kind", "from s", "to s", "windows", "modes", "input J", "released J", "identified J"])];
    let mut reasons = String::new();
    for (index, run) in project.transient_runs.iter().enumerate() {
        let found = outcome.records.iter().find(|record| record.record == index);
        let windows = found.map_or(&[][..], |record| &record.windows);
        let sum = |of: fn(&WindowOutcome) -> f64| number(windows.iter().map(of).sum());
        let modes =
            found.map_or(String::new(), |r| r.modes.iter().map(ToString::to_string).collect::<Vec<_>>().join(","));
        rows.push(vec![
            run.file.clone(),
            run.kind.name().to_owned(),
            significant(run.time()[0], 4),
            significant(run.time()[run.len() - 1], 4),
            windows.len().to_string(),
            modes,
            sum(|w| w.input_energy),
            sum(|w| w.released_energy),
            sum(|w| w.identified_energy),
        ]);
        for finding in &run.findings {
            reasons.push_str(&format!("  {}: {}\n", run.file, finding.reason));
        }
    }
    if rows.len() == 1 { String::new() } else { format!("Records\n{}{reasons}", table(&rows)) }
}

fn runs(project: &Project, outcome: &Outcome) -> String {
    if project.runs.is_empty() {
        return String::new();
    }
    let mut rows = vec![head(&["run", "Hz", "level", "input J", "identified J", "noise %", "flags"])];
    let mut reasons = String::new();
    for (index, run) in project.runs.iter().enumerate() {
        let found = outcome.runs.iter().find(|r| r.run == index);
        let energy = |value: Option<f64>| value.map_or("not used".to_owned(), number);
        let flags: Vec<String> = run
            .findings
            .iter()
            .map(|f| serde_json::to_value(f.flag).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default())
            .collect();
        rows.push(vec![
            run.file.clone(),
            significant(run.fit.omega / TAU, 6),
            run.level.map_or("-".to_owned(), |level| level.to_string()),
            energy(found.map(|r| r.input_energy)),
            energy(found.map(|r| r.identified_energy)),
            significant(100.0 * run.noise_ratio, 2),
            flags.join(" "),
        ]);
        for (finding, flag) in run.findings.iter().zip(&flags) {
            reasons.push_str(&format!("  {} {flag}: {}\n", run.file, finding.reason));
        }
    }
    format!("Runs\n{}{reasons}", table(&rows))
}

fn selection(project: &Project, outcome: &Outcome) -> String {
    let mut rows = vec![head(&["", "count", "angle deg", "energy error %", "sources"])];
    for (index, step) in outcome.steps.iter().enumerate() {
        rows.push(vec![
            if index == outcome.accepted { ">".to_owned() } else { String::new() },
            step.count.to_string(),
            number(step.angle_deg),
            significant(100.0 * step.relative_error, 3),
            set(project, step),
        ]);
    }
    format!("Selection\n{}", table(&rows))
}

fn set(project: &Project, step: &SelectionStep) -> String {
    let estimate_in_words = |estimate: &Estimate| {
        let source = &project.sources[estimate.source];
        format!("{}: {}", source.phrase(&project.structure), number(estimate.coefficient))
    };
    step.sources.iter().map(estimate_in_words).collect::<Vec<_>>().join(", ")
}

fn sources(project: &Project, outcome: &Outcome) -> String {
    let mut rows = vec![head(&["law", "place", "", "value", "deviation", "unit", "energy %", "reference"])];
    let references: Vec<&Source> = project.sources.iter().filter(|s| s.state == State::Reference).collect();
    for estimate in &outcome.sources {
        let source = &project.sources[estimate.source];
        let reference = references.iter().find(|r| r.effect == source.effect && r.place.is_same(&source.place));
        rows.push(vec![
            source.effect.noun().to_owned(),
            source.place.cell(&project.structure),
            if source.state == State::Known { "known" } else { "identified" }.to_owned(),
            number(estimate.coefficient),
            if source.state == State::Known { "-".to_owned() } else { significant(estimate.deviation, 2) },
            unit(source).to_owned(),
            significant(estimate.energy_percent, 3),
            reference.map_or("-".to_owned(), |r| number(r.coefficient())),
        ]);
    }
    let found = |reference: &Source| {
        let same = |e: &&Estimate| {
            let source = &project.sources[e.source];
            source.effect == reference.effect && source.place.is_same(&reference.place)
        };
        outcome.sources.iter().find(same).is_some()
    };
    let mut text = format!("Sources\n{}", table(&rows));
    for missing in references.iter().filter(|reference| !found(reference)) {
        let (name, value) = (missing.phrase(&project.structure), number(missing.coefficient()));
        text.push_str(&format!("  reference not found: {name}: {value} {}\n", unit(missing)));
    }
    text
}

fn unit(source: &Source) -> &'static str {
    source.effect.coefficient().map_or("", |k| source.effect.parameters()[k].unit)
}

fn indistinguishable(project: &Project, outcome: &Outcome) -> String {
    let name = |index: usize| project.sources[index].phrase(&project.structure);
    let lines = outcome.collinear.iter().filter(|group| !group.others.is_empty()).map(|group| {
        let others: Vec<String> = group.others.iter().map(|&(index, _)| name(index)).collect();
        format!("  {} could as well be {}\n", name(group.source), others.join(" or "))
    });
    let text: String = lines.collect();
    if text.is_empty() { text } else { format!("What the data cannot tell apart\n{text}") }
}

fn energy(project: &Project, outcome: &Outcome) -> String {
    // Shares of degrees of freedom are those of steady runs; of records alone there are none.
    if project.runs.is_empty() {
        return String::new();
    }
    let mut rows = vec![head(&["DOF", "energy %"])];
    let mut rest = 0.0;
    for (dof, &percent) in project.structure.dofs().iter().zip(&outcome.results.energy_percent) {
        if percent.abs() >= LEAST_SHARE {
            rows.push(vec![dof.label.clone(), significant(percent, 3)]);
        } else {
            rest += percent;
        }
    }
    rows.push(vec!["others".to_owned(), significant(rest, 3)]);
    format!("Energy dissipated at each degree of freedom\n{}", table(&rows))
}

fn modes(outcome: &Outcome) -> String {
    if outcome.results.modes.is_empty() {
        return String::new();
    }
    let mut rows = vec![head(&["mode", "Hz", "damping ratio", "deviation", "half-power"])];
    for (index, mode) in outcome.results.modes.iter().take(MOST_MODES).enumerate() {
        rows.push(vec![
            (index + 1).to_string(),
            significant(mode.frequency_hz, 5),
            number(mode.damping_ratio),
            significant(mode.damping_ratio_deviation, 2),
            mode.half_power_ratio.map_or("-".to_owned(), number),
        ]);
    }
    let more = outcome.results.modes.len().saturating_sub(MOST_MODES);
    let note = if more > 0 { format!("  {more} more modes are in --json\n") } else { String::new() };
    format!("Damped modes of the identified model\n{}{note}", table(&rows))
}

fn matrix(structure: &Structure, c: &Mat<f64>) -> String {
    if c.nrows() > MOST_DOFS || c.norm_max() == 0.0 {
        return String::new();
    }
    let mut rows =
        vec![std::iter::once(String::new()).chain(structure.dofs().iter().map(|d| d.label.clone())).collect()];
    for (i, dof) in structure.dofs().iter().enumerate() {
        let cells = (0..c.ncols()).map(|j| number(c[(i, j)]));
        rows.push(std::iter::once(dof.label.clone()).chain(cells).collect());
    }
    format!("Viscous damping matrix, N s/m\n{}", table(&rows))
}

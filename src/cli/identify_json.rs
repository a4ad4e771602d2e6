//! `identify --json`, to the letter of the contract; numbers in SI units and full precision.

use super::source_json::{estimate, of_law};
use crate::exchange::Project;
use crate::identify::outcome::WindowOutcome;
use crate::identify::{Outcome, SelectionStep};
use crate::measurement::TransientRun;
use faer::Mat;
use serde_json::{Map, Value, json};

/// The whole document.
pub(super) fn document(project: &Project, outcome: &Outcome) -> Value {
    let labels: Vec<&str> = project.structure.dofs().iter().map(|dof| dof.label.as_str()).collect();
    let known = |e: &crate::identify::Estimate| estimate(e, &project.sources, &project.structure);
    let energy = labels.iter().zip(&outcome.results.energy_percent);
    json!({
        "title": project.title,
        "runs": runs(project, outcome),
        "records": records(project, outcome),
        "selection": outcome.steps.iter().map(|step| selection(project, step)).collect::<Vec<_>>(),
        "accepted": outcome.accepted_step().count,
        "status": outcome.status,
        "reason": outcome.reason,
        "sources": outcome.sources.iter().map(known).collect::<Vec<_>>(),
        "matrix": matrices(&labels, outcome),
        "energy_percent": energy.map(|(dof, percent)| json!({"dof": dof, "percent": percent})).collect::<Vec<_>>(),
        "modes": modes(outcome),
        "indistinguishable": indistinguishable(project, outcome),
        "warnings": outcome.warnings,
        "reduction": super::reduction::document(&project.structure),
    })
}

fn modes(outcome: &Outcome) -> Vec<Value> {
    let numbered = outcome.results.modes.iter().enumerate();
    numbered
        .map(|(index, mode)| {
            json!({"mode": index + 1, "frequency_hz": mode.frequency_hz, "damping_ratio": mode.damping_ratio,
                   "standard_deviation": mode.damping_ratio_deviation, "half_power_ratio": mode.half_power_ratio})
        })
        .collect()
}

/// Every run of the project; energies of those that are not used are null.
fn runs(project: &Project, outcome: &Outcome) -> Vec<Value> {
    let used = |index: usize| outcome.runs.iter().find(|run| run.run == index);
    project
        .runs
        .iter()
        .enumerate()
        .map(|(index, run)| {
            let found = used(index);
            let flags: Vec<_> = run.findings.iter().map(|finding| finding.flag).collect();
            let reasons: Vec<&str> = run.findings.iter().map(|finding| finding.reason.as_str()).collect();
            json!({
                "file": run.file,
                "frequency_hz": run.fit.omega / std::f64::consts::TAU,
                "level": run.level,
                "used": found.is_some(),
                "input_energy_j": found.map(|f| f.input_energy),
                "identified_energy_j": found.map(|f| f.identified_energy),
                "noise_ratio": run.noise_ratio,
                "flags": flags,
                "reasons": reasons,
            })
        })
        .collect()
}

/// Every run that is not steady; windows of those that are not used are null.
fn records(project: &Project, outcome: &Outcome) -> Vec<Value> {
    let window = |w: &WindowOutcome| {
        json!({"start_s": w.span_s[0], "end_s": w.span_s[1], "input_energy_j": w.input_energy,
               "released_energy_j": w.released_energy, "stored_energy_j": w.stored_energy,
               "identified_energy_j": w.identified_energy, "standard_deviation_j": w.deviation})
    };
    let record_in_json = |(index, run): (usize, &TransientRun)| {
        let found = outcome.records.iter().find(|record| record.record == index);
        let windows = found.map(|record| record.windows.iter().map(window).collect::<Vec<_>>());
        json!({
            "file": run.file,
            "kind": run.kind,
            "start_s": run.time()[0],
            "end_s": run.time()[run.len() - 1],
            "level": run.level,
            "session": run.session,
            "used": found.is_some(),
            "modes": found.map(|record| &record.modes),
            "dominant_mode": found.map(|record| record.dominant),
            "corner_hz": found.map(|record| record.corner_hz),
            "windows": windows,
            "flags": run.findings.iter().map(|finding| finding.flag).collect::<Vec<_>>(),
            "reasons": run.findings.iter().map(|finding| finding.reason.as_str()).collect::<Vec<_>>(),
        })
    };
    project.transient_runs.iter().enumerate().map(record_in_json).collect()
}

fn selection(project: &Project, step: &SelectionStep) -> Value {
    let alternatives = step.alternatives.iter().map(|alternative| {
        let sources: Vec<Value> = alternative
            .sources
            .iter()
            .map(|&index| Value::Object(of_law(&project.sources[index], &project.structure)))
            .collect();
        json!({"angle_deg": alternative.angle_deg, "sources": sources})
    });
    let sources = step.sources.iter().map(|e| estimate(e, &project.sources, &project.structure));
    json!({
        "count": step.count,
        "angle_deg": step.angle_deg,
        "relative_error": step.relative_error,
        "chi_square": step.chi_square,
        "degrees_of_freedom": step.freedom,
        "condition": step.condition,
        "proved_best": step.proved,
        "sources": sources.collect::<Vec<_>>(),
        "alternatives": alternatives.collect::<Vec<_>>(),
    })
}

fn matrices(labels: &[&str], outcome: &Outcome) -> Value {
    let mut map = Map::new();
    map.insert("dofs".into(), json!(labels));
    map.insert("viscous".into(), rows(&outcome.results.viscous));
    map.insert("equivalent_viscous".into(), rows(&outcome.results.equivalent_viscous));
    for law in &outcome.results.others {
        map.insert(law.effect.name().into(), rows(&law.matrix));
    }
    Value::Object(map)
}

fn rows(matrix: &Mat<f64>) -> Value {
    let row = |i: usize| (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect::<Vec<_>>();
    json!((0..matrix.nrows()).map(row).collect::<Vec<_>>())
}

fn indistinguishable(project: &Project, outcome: &Outcome) -> Vec<Value> {
    let named = |index: usize| Value::Object(of_law(&project.sources[index], &project.structure));
    outcome
        .collinear
        .iter()
        .map(|group| {
            let others: Vec<Value> = group.others.iter().map(|&(index, _)| named(index)).collect();
            json!({"source": named(group.source), "others": others})
        })
        .collect()
}

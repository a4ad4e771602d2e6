//! Decays and transients in `compare` and `diagnose`, and `dashpot amplitude`: frequency and damping ratio against amplitude.

use super::arguments::Analysis;
use super::table::{number, table};
use crate::control::Control;
use crate::diagnosis::records::RecordComparison;
use crate::diagnosis::records::amplitude::{AmplitudePoint, Line, line};
use crate::diagnosis::records::compare::{ModeCurve, OneRecord, RecordPart};
use crate::exchange::{Project, project::load};
use crate::measurement::{Quantity, TransientRun};
use crate::plots::amplitude_curve::slopes;
use crate::session::validation::compared_with_records;
use crate::session::workers::Threads;
use anyhow::{Context, bail};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// Compares the records of a project, if it has any that are not steady.
pub(super) fn compared(project: &Project, file: &Path, control: &Control) -> anyhow::Result<Option<RecordComparison>> {
    compared_with_records(project, control).with_context(|| file.display().to_string())
}

/// Keys `records` of `compare --json`.
pub(super) fn document(project: &Project, comparison: &RecordComparison) -> Vec<Value> {
    let part = |name: &'static str| {
        move |p: &RecordPart| {
            let [from, to] = p.range;
            let keys = if name == "s" { ["from_s", "to_s"] } else { ["from_hz", "to_hz"] };
            json!({keys[0]: from, keys[1]: to, "amplitude": p.size, "error": p.error})
        }
    };
    let record_in_json = |r: &OneRecord| {
        let run = &project.transient_runs[r.index];
        let channel = |(name, [error, floor]): &(String, [f64; 2])| json!({"channel": name, "error": error, "noise_floor": floor});
        json!({
            "file": run.file, "kind": run.kind.name(), "from_s": run.time()[0], "to_s": run.time()[run.len() - 1],
            "error": r.error, "noise_floor": r.noise_floor,
            "findings": super::run_flags::findings(&run.findings),
            "channels": r.channels.iter().map(channel).collect::<Vec<_>>(),
            "times": r.times.iter().map(part("s")).collect::<Vec<_>>(),
            "bands": r.bands.iter().map(part("Hz")).collect::<Vec<_>>(),
            "curves": r.curves.iter().map(curve).collect::<Vec<_>>(),
        })
    };
    comparison.records.iter().map(record_in_json).collect()
}

fn curve(curve: &ModeCurve) -> Value {
    let points = |list: &[AmplitudePoint]| -> Vec<Value> {
        let point_in_json = |p: &AmplitudePoint| {
            json!({"time_s": p.time_s, "amplitude": p.amplitude, "frequency_hz": p.frequency_hz,
                   "damping_ratio": p.damping_ratio, "amplitude_deviation": p.amplitude_deviation,
                   "frequency_deviation_hz": p.frequency_deviation_hz, "damping_deviation": p.damping_deviation})
        };
        list.iter().map(point_in_json).collect()
    };
    json!({"channel": curve.channel, "frequency_hz": curve.frequency_hz, "measured": points(&curve.measured),
           "model": points(&curve.model), "model_over_amplitude": points(&curve.model_over_amplitude), "lines": lines(&curve.measured)})
}

/// Straight lines through a curve: damping ratio over amplitude, squared frequency over squared amplitude, logarithms.
fn lines(points: &[AmplitudePoint]) -> Value {
    let line_in_json = |found: Option<Line>| {
        found.map(|l| json!({"offset": l.offset, "slope": l.slope, "offset_deviation": l.deviations[0], "slope_deviation": l.deviations[1]}))
    };
    let [ratio, square, slope] = fitted(points);
    json!({
        "damping_ratio_over_amplitude": line_in_json(ratio),
        "frequency_squared_over_amplitude_squared": line_in_json(square),
        "logarithms_of_damping_ratio_over_amplitude": line_in_json(slope),
    })
}

fn fitted(points: &[AmplitudePoint]) -> [Option<Line>; 3] {
    let ratio: Vec<[f64; 3]> = points.iter().map(|p| [p.amplitude, p.damping_ratio, p.damping_deviation]).collect();
    let square = |p: &AmplitudePoint| {
        [p.amplitude.powi(2), p.frequency_hz.powi(2), 2.0 * p.frequency_hz * p.frequency_deviation_hz]
    };
    let square: Vec<[f64; 3]> = points.iter().map(square).collect();
    let seen = points.iter().filter(|p| p.damping_ratio > 3.0 * p.damping_deviation);
    let slope: Vec<[f64; 3]> =
        seen.map(|p| [p.amplitude.ln(), p.damping_ratio.ln(), p.damping_deviation / p.damping_ratio]).collect();
    [line(&ratio), line(&square), line(&slope)]
}

/// The records in words.
pub(super) fn text(project: &Project, comparison: &RecordComparison) -> String {
    let mut rows = vec![["record", "kind", "error %", "noise floor %", "worst channel"].map(str::to_owned).to_vec()];
    for r in &comparison.records {
        let run = &project.transient_runs[r.index];
        let worst = r.channels.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let worst = worst.map_or_else(String::new, |(name, [e, _])| format!("{name} {}", number(100.0 * e)));
        let [error, floor] = [r.error, r.noise_floor].map(|x| number(100.0 * x));
        rows.push(vec![run.file.clone(), run.kind.name().to_owned(), error, floor, worst]);
    }
    let [error, floor] = [comparison.error, comparison.noise_floor].map(|x| number(100.0 * x));
    format!("\n{}\nerror of the records {error} %, noise floor {floor} %\n", table(&rows))
}

/// `dashpot amplitude`: curves of every record that is not steady, in its channel of greatest response.
pub(super) fn amplitude(arguments: &Analysis) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let project = load(&arguments.file, &control)?;
    let name = arguments.file.display();
    let Some(comparison) = compared(&project, &arguments.file, &control)? else {
        bail!("{name}: amplitude curves need a structure with matrices and a run of kind \"decay\" or \"transient\"");
    };
    if arguments.json {
        let curves_of = |r: &OneRecord| {
            let curves: Vec<Value> = r.curves.iter().map(curve).collect();
            json!({"file": project.transient_runs[r.index].file, "curves": curves})
        };
        let records: Vec<Value> = comparison.records.iter().map(curves_of).collect();
        let document = json!({"title": project.title, "records": records});
        return Ok(format!("{}\n", serde_json::to_string_pretty(&document)?));
    }
    let mut text = format!("{}\n", project.title);
    for r in &comparison.records {
        for curve in &r.curves {
            text.push_str(&curve_text(&project.transient_runs[r.index], curve));
        }
    }
    Ok(text)
}

fn curve_text(run: &TransientRun, curve: &ModeCurve) -> String {
    let quantity = curve.channel.split('@').next().and_then(Quantity::from_word);
    let amplitude = quantity.map_or_else(|| "A".to_owned(), |q| format!("A, {} (peak)", q.si_unit(false)));
    let head = ["s", &amplitude, "Hz", "+-", "damping ratio %", "+-", "model Hz", "model %"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for p in &curve.measured {
        let same = curve.model.iter().find(|m| m.time_s == p.time_s);
        let cell = |x: Option<f64>| x.map_or_else(String::new, number);
        rows.push(vec![
            number(p.time_s),
            number(p.amplitude),
            number(p.frequency_hz),
            number(p.frequency_deviation_hz),
            number(100.0 * p.damping_ratio),
            number(100.0 * p.damping_deviation),
            cell(same.map(|m| m.frequency_hz)),
            cell(same.map(|m| 100.0 * m.damping_ratio)),
        ]);
    }
    let mut text =
        format!("\n{}, {} near {} Hz\n{}", run.file, curve.channel, number(curve.frequency_hz), table(&rows));
    let [ratio, square, slope] = fitted(&curve.measured);
    if let Some(l) = ratio {
        text.push_str(&format!("damping ratio = {} + {} A\n", number(l.offset), number(l.slope)));
    }
    if let Some(l) = square {
        text.push_str(&format!("f^2 = {} + {} A^2 (Hz^2)\n", number(l.offset), number(l.slope)));
    }
    if let Some(l) = slope {
        let laws: Vec<String> = slopes().into_iter().map(|(law, slope)| format!("{slope} {}", law.noun())).collect();
        text.push_str(&format!("the damping ratio goes with A^{} ({})\n", number(l.slope), laws.join(", ")));
    }
    text
}

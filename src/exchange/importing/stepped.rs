//! Import of a stepped-sine table: a project with `[[harmonics]]`, one run a row.

use super::amplitude_tables;
use super::error::{ImportError, Result};
use super::model::head;
use super::request::{Imported, Request};
use super::text::{comment, named, points};
use crate::control::Control;
use crate::exchange::mapping::Stepped;
use crate::exchange::project::plan;
use crate::measurement::{Quantity, Run};
use faer::c64;
use std::path::Path;

/// Share of the scatter of the dynamic mass that a mass and a spring must explain to be told.
const EXPLAINED: f64 = 0.9;

/// The project of the table `table`.
pub(super) fn import(request: &Request, table: &Stepped, out: &Path, control: &Control) -> Result<Imported> {
    if let Some(amplitudes) = &table.amplitudes {
        return amplitude_tables::import(request, table, amplitudes, out, control);
    }
    let (mut head, tables) = project(request, table, out)?;
    let loaded =
        plan(&format!("{head}{tables}"), out).and_then(|plan| plan.load(control)).map_err(ImportError::Unwritten)?;
    if !request.has_model()
        && let Some([mass, stiffness]) = oscillator(&loaded.runs)
    {
        let hint = comment(&format!(
            "By the real part of force over acceleration one mode moves {mass:.3} kg here at {:.2} Hz. With it as a model, in \
             place of `kind` and `dofs` below, `compare` and `diagnose` work on amplitudes too:",
            (stiffness / mass).sqrt() / std::f64::consts::TAU
        ));
        let chain = format!(
            "# kind = \"chain\"\n# masses = [{mass:.4}]\n# ground_stiffness = [{stiffness:.5e}]\n# coupling_stiffness = []\n"
        );
        head = head.replacen("[structure]\n", &format!("[structure]\n{hint}{chain}"), 1);
        plan(&format!("{head}{tables}"), out).map_err(ImportError::Unwritten)?;
    }
    let assumed = table.assumed.iter().map(|what| format!("assumed: {what}\n")).collect::<String>();
    let summary = format!("{assumed}{} is in {}\n", table.words(), out.display());
    Ok(Imported { head, tables, summary, remarks: Vec::new() })
}

/// Head and tables of the project.
fn project(request: &Request, table: &Stepped, out: &Path) -> Result<(String, String)> {
    let head = head(request, out, &points(&table.dofs), 2.0 * table.band_hz[1])?;
    let mut text = comment(&format!("{}.", table.words()));
    for what in &table.assumed {
        text.push_str(&comment(&format!("Assumed: {what}.")));
    }
    for file in &request.files {
        text.push_str(&format!("[[harmonics]]\nfile = {}\n", toml::Value::from(named(file, out)?)));
        let keys = [("force", &table.force), ("response", &table.response)];
        for (key, value) in keys.into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?))) {
            text.push_str(&format!("{key} = {}\n", toml::Value::from(value.as_str())));
        }
        if let Some(quantity) = table.phase_of {
            text.push_str(&format!("phase_of = \"{}\"\n", quantity.word()));
        }
        text.push('\n');
    }
    Ok((head, text))
}

/// Mass (kg) and stiffness (N/m) of the one mode that the runs show, by least squares of `Re(F / A) = m - k / omega^2`.
fn oscillator(runs: &[Run]) -> Option<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for run in runs {
        let channels = &run.fit.channels;
        let [force, motion] = [true, false]
            .map(|of_force| channels.iter().find(|channel| (channel.channel.quantity == Quantity::Force) == of_force));
        let (force, motion) = (force?, motion?);
        let turns = motion.channel.quantity.derivatives()? - 2;
        if force.channel.dof != motion.channel.dof || channels.len() != 2 {
            return None;
        }
        let acceleration = motion.amplitudes[0] * c64::new(0.0, run.fit.omega).powi(-turns);
        points.push([-1.0 / run.fit.omega.powi(2), (force.amplitudes[0] / acceleration).re]);
    }
    let n = points.len() as f64;
    let mean = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
    let moment = |i: usize, j: usize| points.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
    let stiffness = moment(0, 1) / moment(0, 0);
    let mass = mean[1] - stiffness * mean[0];
    let explained = stiffness * moment(0, 1) / moment(1, 1);
    let inside = {
        let omega = (stiffness / mass).sqrt();
        let least = runs.iter().map(|run| run.fit.omega).fold(f64::INFINITY, f64::min);
        let most = runs.iter().map(|run| run.fit.omega).fold(0.0, f64::max);
        omega > 0.9 * least && omega < 1.1 * most
    };
    (mass > 0.0 && explained > EXPLAINED && inside).then_some([mass, stiffness])
}

//! `dashpot methods --incompleteness`: errors of the classical methods against the number of modes and sensors measured.

use super::arguments::Methods;
use super::identify::identified;
use super::table::{significant, table};
use crate::classical::FrequencyResponses;
use crate::classical::incompleteness::{
    Case, Grid, Incompleteness, METHODS, MatrixErrors, incompleteness, known_damping,
};
use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::session::workers::Threads;
use anyhow::Context;
use serde_json::{Map, Value, json};
use std::sync::Arc;

pub(super) fn run(arguments: &Methods) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let context = || arguments.file.display().to_string();
    let project = load(&arguments.file, &control)?;
    let known = known_damping(&project.structure, &project.sources);
    let (truth, of) = match known {
        Some(c) => (c, "known"),
        // Without a known damping that of the energy balance shows what could be found on this structure.
        None => (identified(&arguments.file, None)?.1.results.equivalent_viscous, "identified"),
    };
    let own = FrequencyResponses::from_runs(&project.runs).map_or_else(Vec::new, |r| r.sensors);
    let grid = Grid::new(&project.structure, &own);
    let study = incompleteness(&project.structure, truth.as_ref(), &grid, &control).with_context(context)?;
    Ok(if arguments.json { format!("{:#}\n", document(&project, &study, of)) } else { report(&project, &study, of) })
}

fn report(project: &Project, study: &Incompleteness, of: &str) -> String {
    let mut text = format!("{}\n\neps_C %, and eps_p %, where the damping is the {of} one\n", project.title);
    for (s, sensors) in study.sensors.iter().enumerate() {
        text +=
            &format!("\n{} of {} DOFs measured: {}\n", sensors.len(), project.structure.len(), names(project, sensors));
        let mut head = vec!["modes".to_owned()];
        head.extend(METHODS.iter().map(|method| method.title().to_owned()));
        head.push("eps_p %".to_owned());
        let rows = std::iter::once(head).chain(study.cases.iter().filter(|case| case.sensors == s).map(row));
        text += &table(&rows.collect::<Vec<_>>());
    }
    text
}

fn row(case: &Case) -> Vec<String> {
    let error =
        |found: &Result<MatrixErrors, String>| found.as_ref().map_or("-".to_owned(), |e| significant(e.eps_c, 3));
    let mut cells = vec![case.modes.to_string()];
    cells.extend(case.methods.iter().map(error));
    cells.push(significant(case.eps_p, 3));
    cells
}

/// Labels of the sensors, the first ones where they are many.
fn names(project: &Project, sensors: &[usize]) -> String {
    let label = |&dof: &usize| project.structure.label(dof).to_owned();
    let first: Vec<String> = sensors.iter().take(12).map(label).collect();
    first.join(" ") + if sensors.len() > 12 { " ..." } else { "" }
}

fn document(project: &Project, study: &Incompleteness, of: &str) -> Value {
    let labels =
        |sensors: &Vec<usize>| json!(sensors.iter().map(|&dof| project.structure.label(dof)).collect::<Vec<_>>());
    let mut curves = Vec::new();
    for case in &study.cases {
        let methods = case.methods.iter().zip(METHODS).map(|(found, method)| {
            let mut map = Map::new();
            map.insert("method".into(), json!(method));
            match found {
                Ok(e) => {
                    map.insert("eps_c_percent".into(), json!(e.eps_c));
                    map.insert("mac_error".into(), json!(e.mac));
                    map.insert("mac_error_measured".into(), json!(e.mac_measured));
                }
                Err(why) => drop(map.insert("reason".into(), json!(why))),
            }
            Value::Object(map)
        });
        let methods: Vec<Value> = methods.collect();
        let sensors = labels(&study.sensors[case.sensors]);
        curves.push(json!({"sensors": sensors, "modes": case.modes, "eps_p_percent": case.eps_p, "methods": methods}));
    }
    json!({"title": project.title, "damping": of, "cases": curves})
}

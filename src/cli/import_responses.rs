//! `dashpot import` of frequency responses: a project with `[[frf]]`, its DOFs those of the file or of a model.

use super::arguments::Import;
use super::import::{head, named, write};
use super::import_model::{Point, model, places};
use crate::control::Control;
use crate::exchange::frf::pair_in_name;
use crate::exchange::project::plan;
use anyhow::ensure;
use dashpot_datafiles::{DataFile, Kind, Values, open};
use std::collections::BTreeMap;
use std::path::Path;

/// Whether a file has frequency responses.
pub(super) fn has_responses(file: &Path) -> anyhow::Result<bool> {
    let opened = open(file)?;
    let sets = &opened.contents().sets;
    Ok(sets.iter().any(|set| set.kind == Kind::Frf && set.channels.iter().any(|channel| channel.complex)))
}

/// Writes the project of frequency responses.
pub(super) fn run(arguments: &Import) -> anyhow::Result<String> {
    let Some(out) = arguments.out.as_ref().filter(|_| !arguments.propose) else {
        anyhow::bail!(
            "{}: frequency responses need no [[channel]]; write the project by --out",
            arguments.files[0].display()
        );
    };
    let (text, summary) = project(arguments, out)?;
    let project = plan(&text, out)?.load(&Control::unattended())?;
    for remark in &project.remarks {
        eprintln!("{remark}");
    }
    write(out, &text)?;
    Ok(format!("{summary}, {} runs of one line each, are in {}\n", project.runs.len(), out.display()))
}

/// The text of the project and what is in it in words.
fn project(arguments: &Import, out: &Path) -> anyhow::Result<(String, String)> {
    let files: Vec<DataFile> = arguments.files.iter().map(|file| open(file)).collect::<Result<_, _>>()?;
    let mut names: Vec<String> = arguments.responses.iter().chain(&arguments.references).cloned().collect();
    let (mut count, mut highest) = (0, 0.0_f64);
    for file in &files {
        for set in file.contents().sets.iter().filter(|set| set.kind == Kind::Frf) {
            for channel in set.channels.iter().filter(|channel| channel.complex) {
                count += 1;
                if let Some(step) = channel.axis.step() {
                    highest = highest.max(step * channel.count as f64);
                }
                if arguments.responses.is_empty() {
                    names.extend(pair(channel).into_iter().flatten());
                }
            }
        }
    }
    let points = points(&names, &files)?;
    let mut labels: Vec<String> = Vec::new();
    let mut dofs: BTreeMap<String, String> = BTreeMap::new();
    match model(arguments)? {
        Some(model) => {
            for (point, label) in
                points.iter().zip(places(&points.iter().map(|p| p.1.clone()).collect::<Vec<_>>(), &model)?)
            {
                if label != format!("{}{}", point.1.node, point.1.direction) {
                    dofs.insert(point.0.clone(), label);
                }
            }
        }
        None => {
            for (name, point) in &points {
                let label = format!("{}{}", point.node, point.direction);
                if label != *name {
                    dofs.insert(name.clone(), label.clone());
                }
                if !labels.contains(&label) {
                    labels.push(label);
                }
            }
        }
    }
    ensure!(
        arguments.mass.is_some() || !labels.is_empty(),
        "{}: neither names nor file say the DOFs of the functions; give them by --responses and --references",
        arguments.files[0].display()
    );
    let up_to = if highest > 0.0 { 2.0 * highest } else { 2000.0 };
    let mut text = head(arguments, out, &labels, up_to)?;
    for file in &arguments.files {
        text.push_str(&table(arguments, &named(file, out)?, &dofs));
    }
    Ok((text, format!("{count} functions at {} DOFs", points.len())))
}

/// The `[[frf]]` of a file.
fn table(arguments: &Import, file: &str, dofs: &BTreeMap<String, String>) -> String {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let list = |labels: &[String]| labels.iter().map(|label| quoted(label)).collect::<Vec<_>>().join(", ");
    let mut text = format!("[[frf]]\nfile = {}\n", quoted(file));
    if let Some(form) = &arguments.form {
        text.push_str(&format!("form = {}\n", quoted(form)));
    }
    match arguments.averages {
        Some(averages) => text.push_str(&format!("averages = {averages}\n")),
        None => text.push_str("# averages = 8                    # with the coherences it gives the deviations\n"),
    }
    if !arguments.responses.is_empty() {
        text.push_str(&format!("responses = [{}]\n", list(&arguments.responses)));
    }
    if !arguments.references.is_empty() {
        text.push_str(&format!("references = [{}]\n", list(&arguments.references)));
    }
    if !dofs.is_empty() {
        text.push_str("\n[frf.dofs]\n");
        dofs.iter().for_each(|(name, label)| text.push_str(&format!("{} = {}\n", quoted(name), quoted(label))));
    }
    text + "\n"
}

/// Names of response and reference of a function.
fn pair(channel: &dashpot_datafiles::Channel) -> Option<[String; 2]> {
    match (channel.attribute("response"), channel.attribute("reference")) {
        (Some(response), Some(reference)) => Some([response.to_owned(), reference.to_owned()]),
        _ => pair_in_name(&channel.name),
    }
}

/// The points that the names stand for, each once, by the name of its positive direction.
fn points(names: &[String], files: &[DataFile]) -> anyhow::Result<Vec<(String, Point)>> {
    let mut positions: BTreeMap<String, [f64; 3]> = BTreeMap::new();
    for file in files {
        positions_in(file, &mut positions)?;
    }
    let mut points: Vec<(String, Point)> = Vec::new();
    for name in names {
        // `ENTITY 12:+Z`, `acc@12`: what stands in front is no part of the place.
        let plain = name.rsplit([' ', '@']).next().unwrap_or_default().trim_start_matches('-').replace(":-", ":+");
        let digits = plain.find(|c: char| !c.is_ascii_digit()).unwrap_or(plain.len());
        let direction: String =
            plain[digits..].chars().filter(char::is_ascii_alphabetic).collect::<String>().to_lowercase();
        let node = if digits > 0 { plain[..digits].to_owned() } else { plain.clone() };
        let direction = if digits > 0 { direction } else { String::new() };
        let position = positions.get(&node).copied();
        if points.iter().all(|(known, _)| *known != plain) {
            points.push((plain, Point { node, direction, position }));
        }
    }
    Ok(points)
}

/// Nodes of a file with their positions.
fn positions_in(file: &DataFile, positions: &mut BTreeMap<String, [f64; 3]>) -> anyhow::Result<()> {
    for (s, set) in file.contents().sets.iter().enumerate().filter(|(_, set)| set.kind == Kind::Geometry) {
        let column = |name: &str| -> anyhow::Result<Option<Vec<f64>>> {
            let Some(c) = set.channels.iter().position(|channel| channel.name == name) else { return Ok(None) };
            match file.read(s, c)? {
                Values::Real(values) => Ok(Some(values)),
                Values::Complex(_) => Ok(None),
            }
        };
        if let (Some(node), Some(x), Some(y), Some(z)) = (column("node")?, column("x")?, column("y")?, column("z")?) {
            for (i, node) in node.iter().enumerate() {
                positions.insert(format!("{node}"), [x[i], y[i], z[i]]);
            }
        }
    }
    Ok(())
}

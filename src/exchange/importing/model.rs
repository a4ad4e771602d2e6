//! A finite-element model under the measurements, reduced where it is large.

use super::error::{ImportError, Result};
use super::request::Request;
use super::text::named;
use crate::exchange::matrices::model::{Model, ModelFiles, read_model};
use std::collections::BTreeMap;
use std::path::Path;

/// Degrees of freedom from which on a model is reduced.
const LARGE: usize = 300;
/// Lengths of a file over those of the model that are tried: m, mm, inches, each in either.
const SCALES: [f64; 5] = [1.0, 1e-3, 1e3, 0.0254, 1.0 / 0.0254];
/// Largest distance of a measured point and its node, as a share of the size of the model.
const NEAR: f64 = 0.02;

/// The model of the request, if they name one.
pub(super) fn model(request: &Request) -> Result<Option<Model>> {
    let Some(mass) = &request.mass else { return Ok(None) };
    let matrices: [&Path; 2] = [mass, request.stiffness.as_deref().unwrap_or(mass)];
    let nodes = request.nodes.as_deref();
    let model = read_model(ModelFiles { matrices, names: [None, None], nodes, dofs: None, lines: None })?;
    Ok(Some(model))
}

/// Table `[structure]` of the model, if there is one; `up_to_hz` is twice the highest frequency that is measured.
pub(super) fn structure(request: &Request, out: &Path, up_to_hz: f64) -> Result<Option<String>> {
    let (Some(mass), Some(model)) = (&request.mass, model(request)?) else { return Ok(None) };
    let stiffness = request.stiffness.as_ref().unwrap_or(mass);
    let quoted = |file: &Path| -> Result<String> { Ok(toml::Value::from(named(file, out)?).to_string()) };
    let mut text =
        format!("[structure]\nkind = \"matrices\"\nmass = {}\nstiffness = {}\n", quoted(mass)?, quoted(stiffness)?);
    if let Some(nodes) = &request.nodes {
        text.push_str(&format!("nodes = {}\n", quoted(nodes)?));
    }
    if model.system.mass.size() > LARGE {
        // Of a step that is no binary number the rate ends in roundings.
        text.push_str(&format!(
            "\n[structure.reduce]\nup_to_hz = {}\n",
            toml::Value::Float((1e6 * up_to_hz).round() / 1e6)
        ));
    }
    Ok(Some(text))
}

/// Head of a project with the structure of the model that is given, else of the template, else with `own`, and candidates.
pub(super) fn head(request: &Request, out: &Path, own: &str, up_to_hz: f64) -> Result<String> {
    let title = request.files[0].file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    if let (None, Some(kept)) = (&request.mass, &request.kept) {
        return kept.head(out, &title);
    }
    let structure = structure(request, out, up_to_hz)?.unwrap_or_else(|| own.to_owned());
    Ok(format!(
        "[project]\nformat = 1\ntitle = {}\n\n{structure}\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\n",
        toml::Value::from(title)
    ))
}

/// What stands in a project of frequency responses on a model, beside the candidates that are proposed: dashpots alone take over
/// what the material loses, as several that nobody built.
pub(super) const MATERIAL: &str = "# Material and joints lose energy too. Where dashpots come out that nobody built, let the whole structure lose some:\n\
                                   # [[source]]\n# law = \"loss_factor\"\n# state = \"candidate\"\n\n";

/// Least reach of points given in another unit than the model, over its size.
const SPANNED: f64 = 0.1;

/// A measured point: name of its node, direction such as `z`, position where the file has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub node: String,
    pub direction: String,
    pub position: Option<[f64; 3]>,
}

/// Labels in the model of the measured points, in their order: the node of the same number, unless positions say another.
///
/// # Errors
/// One sentence for a point that is not in the model.
pub(super) fn places(points: &[Point], model: &Model) -> Result<Vec<String>> {
    let dofs = model.dofs.as_ref().ok_or_else(|| {
        ImportError::Said("the model does not name its degrees of freedom; give a file that does".to_owned())
    })?;
    let labels: std::collections::HashSet<&str> = dofs.iter().map(|dof| dof.label.as_str()).collect();
    let nodes: Vec<(&str, [f64; 3])> =
        model.nodes.iter().flatten().map(|node| (node.label.as_str(), node.position)).collect();
    let by_place = nearest(points, &nodes, &labels);
    let label_of = |point: &Point| {
        let own = format!("{}{}", point.node, point.direction);
        if let Some(node) = by_place.get(&own) {
            return Ok(format!("{node}{}", point.direction));
        }
        if labels.contains(own.as_str()) {
            return Ok(own);
        }
        Err(ImportError::Said(match point.direction.as_str() {
            "" => format!(
                "point {own} of the measurement has no direction, and the model no DOF of that name; name the DOFs of the \
                 functions by --responses and --references, such as --responses {own}z, or under [frf.dofs] of a --map"
            ),
            direction if nodes.is_empty() => format!(
                "point {} direction {direction} is not in the model by its number, and the model has no places of nodes; give its \
                 --nodes (.inp, .bdf or a table), or name the DOFs by --responses and --references",
                point.node
            ),
            direction => format!(
                "point {} direction {direction} is not in the model, neither by its number nor by its place; say it under \
                 [frf.dofs] of a --map, or name the DOFs by --responses and --references",
                point.node
            ),
        }))
    };
    points.iter().map(label_of).collect()
}

/// Nodes of the model at the places of the points; empty where positions do not fit the model in any unit.
fn nearest(
    points: &[Point],
    nodes: &[(&str, [f64; 3])],
    labels: &std::collections::HashSet<&str>,
) -> BTreeMap<String, String> {
    let mut extent: f64 = 0.0;
    for axis in 0..3 {
        let values = || nodes.iter().map(|(_, x)| x[axis]);
        extent = extent.max(values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min));
    }
    if extent.is_nan() || extent <= 0.0 || points.iter().any(|point| point.position.is_none()) {
        return BTreeMap::new();
    }
    let nodes_at_scale = |scale: f64| -> Option<BTreeMap<String, String>> {
        let mut found = BTreeMap::new();
        // Whatever lies near the origin fits in some unit: points in another must span some of the model.
        let reach = points.iter().filter_map(|p| p.position).flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        if scale != 1.0 && reach * scale < SPANNED * extent {
            return None;
        }
        for point in points {
            let position = point.position?.map(|x| x * scale);
            let distance = |x: &[f64; 3]| (0..3).map(|i| (x[i] - position[i]).powi(2)).sum::<f64>().sqrt();
            let has = |node: &&(&str, [f64; 3])| labels.contains(format!("{}{}", node.0, point.direction).as_str());
            let (node, x) = nodes.iter().filter(has).min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1)))?;
            if distance(x) > NEAR * extent {
                return None;
            }
            found.insert(format!("{}{}", point.node, point.direction), (*node).to_owned());
        }
        Some(found)
    };
    SCALES.iter().find_map(|&scale| nodes_at_scale(scale)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::*;

    #[test]
    fn points_are_found_by_their_places_in_another_unit() {
        let nodes = [("101", [0.0, 0.0, 0.0]), ("102", [0.5, 0.0, 0.0]), ("103", [1.0, 0.0, 0.0])];
        let labels = ["101z", "102z", "103z"].into_iter().collect();
        let point =
            |node: &str, x: f64| Point { node: node.into(), direction: "z".into(), position: Some([x, 1.0, 0.0]) };
        let found = nearest(&[point("1", 500.0), point("2", 1000.0)], &nodes, &labels);
        assert_eq!(found.get("1z").map(String::as_str), Some("102"));
        assert_eq!(found.get("2z").map(String::as_str), Some("103"));
        assert!(nearest(&[point("1", 0.3)], &nodes, &labels).is_empty());
    }

    /// A model without places, as Abaqus writes its matrices, cannot know the points of a test by theirs: what is missing is said.
    #[test]
    fn a_model_without_places_asks_for_its_nodes() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("beam.mtx");
        std::fs::write(&file, "101,3, 101,3, 2.0\n101,3, 102,3, -1.0\n102,3, 102,3, 1.0\n").unwrap();
        let matrices: [&Path; 2] = [&file, &file];
        let files = ModelFiles { matrices, names: [None, None], nodes: None, dofs: None, lines: None };
        let model = read_model(files).unwrap();
        let point = Point { node: "1".into(), direction: "z".into(), position: Some([0.2, 0.0, 0.0]) };
        let told = places(&[point], &model).unwrap_err().to_string();
        assert!(told.contains("--nodes"), "{told}");
    }
}

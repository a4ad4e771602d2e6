//! Modes and operating shapes of other programs (data sets 55 and 2414) beside those found here.

use super::{BEAM, CANDIDATES, CHANNELS, file, hammered};
use dashpot::cli::answer;
use dashpot::control::Control;
use dashpot::exchange::project::load;
use dashpot::structure::damped_modes::{DampedMode, damped_modes_from};
use faer::Mat;
use serde_json::Value;
use std::path::Path;
use uff::{Set, Shape, ShapeHeader, Summary, Values};

/// Labels of the sensors of the test.
const SENSORS: [&str; 4] = ["7", "11", "15", "19"];

/// The complex modes of the truth: the beam with its two dashpots.
fn truth(folder: &Path) -> Vec<DampedMode> {
    let project = load(&file(folder, "beam.toml", &[BEAM, "[[frf]]\nfile = \"hammer.uff\"\n"]), &Control::unattended());
    let structure = project.unwrap().structure;
    let mut c = Mat::zeros(structure.len(), structure.len());
    for (label, value) in [("5", 0.5), ("13", 0.2)] {
        let dof = structure.dof(label).unwrap();
        c[(dof, dof)] = value;
    }
    let modes = damped_modes_from(&structure.modes().unwrap(), c.as_ref()).unwrap();
    modes.into_iter().filter(|mode| mode.lambda.im > 0.0).take(3).collect()
}

/// The modes at the sensors as data sets 55, in a scale and phase of their own; zeros in the other directions.
fn write(folder: &Path, modes: &[DampedMode]) {
    let responses = uff::File::open(folder.join("hammer.uff")).unwrap();
    let mut dofs: Vec<(i64, i64)> = Vec::new();
    for entry in responses.sets() {
        if let Summary::Function(header) = &entry.summary {
            let dof = (header.response.node, header.response.direction);
            if !dofs.contains(&dof) {
                dofs.push(dof);
            }
        }
    }
    let rows: Vec<usize> = SENSORS.iter().map(|label| label.parse::<usize>().unwrap() - 1).collect();
    let set = |mode: &DampedMode| {
        let turned = |row: usize| {
            let value = mode.shape[row] * faer::c64::new(0.3, -0.8);
            [value.re, value.im]
        };
        let values = dofs.iter().zip(&rows).flat_map(|(&(_, direction), &row)| {
            (1..=3).map(move |d| if d == direction.abs() { turned(row) } else { [0.0, 0.0] })
        });
        let header = ShapeHeader {
            id: Default::default(),
            model: 1,
            analysis: 3,
            characteristic: 2,
            quantity: 8,
            complex: true,
            per_node: 3,
            integers: vec![0, 1],
            reals: vec![mode.lambda.re, mode.lambda.im, 0.0, 0.0, 0.0, 0.0],
        };
        let nodes = dofs.iter().map(|(node, _)| *node).collect();
        Set::Shape(Shape { header, nodes, values: Values::Complex(values.collect()) })
    };
    let sets: Vec<Set> = modes.iter().map(set).collect();
    std::fs::write(folder.join("modes.uff"), uff::to_bytes(&sets).unwrap()).unwrap();
}

fn json(words: &[&str]) -> Value {
    serde_json::from_str(&answer(["dashpot"].iter().chain(words).map(Into::into)).unwrap()).unwrap()
}

#[test]
fn a_modal_model_stands_beside_the_modes_as_measured() {
    let folder = hammered("0.002", CHANNELS);
    let modes = truth(folder.path());
    write(folder.path(), &modes);
    let tables = "[[frf]]\nfile = \"hammer.uff\"\nlines = 400\n[[modes]]\nfile = \"modes.uff\"\n";
    let path = file(folder.path(), "project.toml", &[BEAM, CANDIDATES, tables]).display().to_string();
    let found = json(&["methods", &path, "--json"]);
    let shapes = found["reference_shapes"].as_array().unwrap();
    assert_eq!(shapes.len(), 3, "{found}");
    let mut seen = 0;
    for (shape, mode) in shapes.iter().zip(&modes) {
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        assert_eq!((shape["kind"].as_str(), shape["shape"].as_array().map(Vec::len)), (Some("complex mode"), Some(4)));
        assert!((number(&shape["frequency_hz"]) / mode.frequency_hz - 1.0).abs() < 1e-5, "{shape}");
        assert!((number(&shape["damping_ratio"]) / mode.damping_ratio - 1.0).abs() < 1e-4, "{shape}");
        let (ours, model) = (&shape["measured"], &shape["model"]);
        assert!(number(&model["mac"]) > 0.99, "{shape}");
        // The lines of a flat beam are too far apart to show its lowest modes.
        if ours.is_null() {
            continue;
        }
        seen += 1;
        assert!(number(&ours["mac"]) > 0.999, "{shape}");
        assert!((number(&ours["frequency_hz"]) / mode.frequency_hz - 1.0).abs() < 2e-3, "{shape}");
        assert!((number(&ours["damping_ratio"]) / mode.damping_ratio - 1.0).abs() < 0.1, "{shape}");
    }
    assert!(seen >= 1, "{}: {shapes:?}", found["modes_from"]);
    let table = answer(["dashpot", "methods", &path].map(Into::into)).unwrap();
    assert!(table.contains("Modes of other programs") && table.contains("modes.uff, set 1 (complex mode)"), "{table}");
}

#[test]
fn a_modal_model_among_imported_files_becomes_reference() {
    let folder = hammered("0.002", CHANNELS);
    write(folder.path(), &truth(folder.path()));
    let path = |name: &str| folder.path().join(name).display().to_string();
    let words =
        ["dashpot", "import", &path("modes.uff"), &path("hammer.uff"), "--averages", "8", "--out", &path("made.toml")];
    let said = answer(words.map(Into::into)).unwrap();
    assert!(said.contains("3 modes or operating shapes stand beside ours"), "{said}");
    let text = std::fs::read_to_string(folder.path().join("made.toml")).unwrap();
    assert!(text.contains("[[modes]]\nfile = \"modes.uff\"") && !text.contains("[[frf]]\nfile = \"modes"), "{text}");
    let project = load(&folder.path().join("made.toml"), &Control::unattended()).unwrap();
    assert_eq!(project.reference_shapes.iter().map(|shape| shape.at.len()).collect::<Vec<_>>(), [4, 4, 4]);
}

#[test]
fn shapes_that_cannot_be_laid_on_the_structure_are_said() {
    let folder = hammered("0", CHANNELS);
    let modes = "[[frf]]\nfile = \"hammer.uff\"\n[[modes]]\nfile = \"";
    let error = |name: &str| {
        let path = file(folder.path(), "project.toml", &[BEAM, modes, name, "\"\n"]);
        load(&path, &Control::unattended()).unwrap_err().to_string()
    };
    let said = error("hammer.uff");
    assert!(said.contains("hammer.uff: has no modes or operating shapes at nodes with a frequency"), "{said}");
    let said = error("none.uff");
    assert!(said.contains(": the record none.uff is not there"), "{said}");
    let header = ShapeHeader {
        id: Default::default(),
        model: 1,
        analysis: 2,
        characteristic: 2,
        quantity: 8,
        complex: false,
        per_node: 3,
        integers: vec![0, 1],
        reals: vec![12.5, 1.0, 0.01, 0.0],
    };
    let shape = Shape { header, nodes: vec![7001], values: Values::Real(vec![1.0, 2.0, 3.0]) };
    std::fs::write(folder.path().join("far.uff"), uff::to_bytes(&[Set::Shape(shape)]).unwrap()).unwrap();
    let said = error("far.uff");
    assert!(said.contains("far.uff: has no shape at a DOF of the structure") && !said.contains('\n'), "{said}");
}

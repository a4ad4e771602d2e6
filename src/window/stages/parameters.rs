//! The parameters of the structure, each a value that can be edited with its unit beside it.

use crate::display::words;
use crate::exchange::project::file::{ProjectFile, Shape};
use crate::session::Command;
use crate::structure::beam::{BeamParameters, Supports};
use crate::structure::chain::ChainParameters;
use crate::window::app::ask::Ask;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::document::Document;
use crate::window::document::edits::Edit;
use crate::window::language::tf;
use egui::{ScrollArea, Ui};

/// Shows the pane; a lumped mass may be added at the DOF that is selected.
pub(crate) fn show(ui: &mut Ui, document: &Document, selected: Option<usize>, asks: &mut Vec<Ask>) {
    let file = document.session().document().file().clone();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(ui.available_width().min(460.0));
        match &file.structure.shape {
            Shape::Beam(beam) => self::beam(ui, beam, asks),
            Shape::Chain(chain) => self::chain(ui, chain, asks),
            Shape::Matrices(m) => {
                ui.hint("Mass and stiffness come from files beside the project.");
                let none = "–".to_owned();
                for (name, value) in [
                    ("Mass matrix", &m.mass),
                    ("Stiffness matrix", &m.stiffness),
                    ("Nodes", m.nodes.as_ref().unwrap_or(&none)),
                    ("Degrees of freedom", m.dofs.as_ref().unwrap_or(&none)),
                    ("Lines", m.lines.as_ref().unwrap_or(&none)),
                ] {
                    ui.pair(name, value.as_str());
                }
            }
            Shape::Points(points) => {
                ui.hint("Points have no mass and no stiffness: the energy balance needs none.");
                ui.pair("Points", points.dofs.len().to_string());
            }
            Shape::Component(component) => {
                ui.hint("A component in a testing machine: its displacement is imposed, its force measured.");
                ui.pair("Moving mass", format!("{} kg", component.mass));
            }
        }
        masses(ui, &file, selected.map(|d| document.project.structure.label(d)), asks);
    });
}

fn set(asks: &mut Vec<Ask>, name: String, value: f64) {
    asks.push(Ask::Edit(Edit::Do(Command::SetStructureParameter { name, value })));
}

fn beam(ui: &mut Ui, beam: &BeamParameters, asks: &mut Vec<Ask>) {
    for (label, name, value, unit) in [
        ("Length", "length", beam.length, "m"),
        ("Breadth", "breadth", beam.breadth, "m"),
        ("Depth, in the direction of bending", "depth", beam.depth, "m"),
        ("Young's modulus", "youngs_modulus", beam.youngs_modulus, "Pa"),
        ("Density", "density", beam.density, "kg/m^3"),
        ("Elements", "elements", beam.elements as f64, ""),
    ] {
        if let Some(new) = ui.quantity(label, value, unit) {
            set(asks, name.to_owned(), if name == "elements" { new.round() } else { new });
        }
    }
    if let Some(supports) = ui.choice("Ends, left and right", beam.supports, &Supports::ALL, words::supports) {
        asks.push(Ask::Edit(Edit::Do(Command::SetSupports(supports))));
    }
}

fn chain(ui: &mut Ui, chain: &ChainParameters, asks: &mut Vec<Ask>) {
    let lists = [
        ("Masses", "masses", &chain.masses, "kg"),
        ("Springs to the ground", "ground_stiffness", &chain.ground_stiffness, "N/m"),
        ("Springs between masses", "coupling_stiffness", &chain.coupling_stiffness, "N/m"),
    ];
    for (title, name, values, unit) in lists {
        ui.title(title, "");
        for (k, &value) in values.iter().enumerate() {
            let label = match name {
                "masses" => format!("Mass {}", k + 1),
                "ground_stiffness" => format!("Ground to {}", k + 1),
                _ => format!("{} to {}", k + 1, k + 2),
            };
            if let Some(new) = ui.quantity(&label, value, unit) {
                set(asks, format!("{name}[{}]", k + 1), new);
            }
        }
        ui.add_space(space::S);
    }
}

/// Lumped masses; one can be added at the DOF that is selected.
fn masses(ui: &mut Ui, file: &ProjectFile, selected: Option<&str>, asks: &mut Vec<Ask>) {
    if matches!(file.structure.shape, Shape::Points(_) | Shape::Component(_)) {
        return;
    }
    ui.add_space(space::S);
    ui.title("Lumped masses", "");
    let set = |dof: &str, mass: Option<f64>| Ask::Edit(Edit::Do(Command::SetLumpedMass { dof: dof.to_owned(), mass }));
    for lumped in &file.structure.lumped_mass {
        if let Some(new) = ui.quantity(&format!("At DOF {}", lumped.dof), lumped.mass, "kg") {
            asks.push(set(&lumped.dof, (new != 0.0).then_some(new)));
        }
    }
    match selected {
        Some(dof) if file.structure.lumped_mass.iter().all(|l| l.dof != dof) => {
            if ui.button(tf!("Add a mass at DOF {dof}")).clicked() {
                asks.push(set(dof, Some(0.1)));
            }
        }
        _ if file.structure.lumped_mass.is_empty() => drop(ui.hint("None. Select a DOF on the schematic to add one.")),
        _ => drop(ui.hint("A mass of 0 kg is taken off.")),
    }
}

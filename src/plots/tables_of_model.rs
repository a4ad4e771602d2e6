//! Tables of the model and of what a search says of it, as text with tabs: SI units, all digits.

use super::tables::table;
use crate::diagnosis::Diagnosis;
use crate::diagnosis::result::Suggestion;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::scatter::{Estimated, Scatter};
use crate::display::{findings, words};
use crate::effects::Source;
use crate::exchange::project::file::{ProjectFile, Shape};
use crate::structure::Structure;

/// Suggestions, best first, one line a suggestion.
pub fn suggestions(structure: &Structure, list: &[Suggestion]) -> String {
    let line = |s: &Suggestion| {
        let source = &s.added.source;
        let parameters = source.effect.parameters().iter().zip(&source.parameters).zip(&s.added.deviations);
        let said = |((p, value), deviation): ((&crate::effects::Parameter, &f64), &f64)| {
            format!("{} {value:e} +- {deviation:e} {}", p.name, p.unit).trim_end().to_owned()
        };
        let parameters: Vec<String> = parameters.map(said).collect();
        let (law, place) = (source.effect.name(), source.place.cell(structure));
        let (chance, after, held) = (s.probability, s.error_after, s.held_out_error_after);
        format!("{law}\t{place}\t{chance:e}\t{after:e}\t{held:e}\t{}", parameters.join("; "))
    };
    table("law\tplace\tprobability\terror with it\terror on left-out runs\tparameters", list.iter().map(line))
}

/// Corrections of the model, then what the data say of channels and runs, one line each: a value and its standard deviation.
pub fn corrections(
    structure: &Structure,
    known: &[Source],
    diagnosis: &Diagnosis,
    scatter: Option<&Scatter>,
) -> String {
    let mut lines: Vec<String> = Vec::new();
    let of_model = |c: &Correction| {
        let what = findings::corrected(structure, known, &c.parameter);
        format!("{what}\tfactor\t{:e}\t{:e}", c.factor, c.deviation)
    };
    lines.extend(diagnosis.corrections.iter().map(of_model));
    let mut add = |what: &str, quantity: &str, e: Estimated| {
        lines.push(format!("{what}\t{quantity}\t{:e}\t{:e}", e.value, e.deviation));
    };
    for channel in scatter.iter().flat_map(|s| &s.channels) {
        add(&channel.channel, "gain less one", channel.gain);
        if let Some(delay) = channel.delay {
            add(&channel.channel, "delay (s)", delay);
        }
    }
    for run in scatter.iter().flat_map(|s| &s.runs) {
        let name = format!("run {}", run.run + 1);
        add(&name, "relative shift of frequencies", run.frequency);
        add(&name, "relative change of amplitude", run.amplitude);
        add(&name, "phase (rad)", run.phase);
    }
    table("what\tquantity\tvalue\tstandard deviation", lines.into_iter())
}

/// Parameters of the structure and its lumped masses, one line each; names of files of a model that is imported.
pub fn parameters(file: &ProjectFile) -> String {
    let number = |name: &str, value: f64, unit: &str| format!("{name}\t{value:e}\t{unit}");
    let list = |name: &str, values: &[f64], unit: &str| -> Vec<String> {
        values.iter().enumerate().map(|(k, v)| number(&format!("{name}[{}]", k + 1), *v, unit)).collect()
    };
    let mut lines = match &file.structure.shape {
        Shape::Beam(b) => vec![
            number("length", b.length, "m"),
            number("breadth", b.breadth, "m"),
            number("depth", b.depth, "m"),
            number("youngs_modulus", b.youngs_modulus, "Pa"),
            number("density", b.density, "kg/m^3"),
            format!("elements\t{}\t", b.elements),
            format!("supports\t{}\t", words::supports(b.supports)),
        ],
        Shape::Chain(c) => [
            list("masses", &c.masses, "kg"),
            list("ground_stiffness", &c.ground_stiffness, "N/m"),
            list("coupling_stiffness", &c.coupling_stiffness, "N/m"),
        ]
        .concat(),
        Shape::Matrices(m) => vec![format!("mass\t{}\t", m.mass), format!("stiffness\t{}\t", m.stiffness)],
        Shape::Points(p) => vec![format!("points\t{}\t", p.dofs.len())],
        Shape::Component(c) => vec![number("mass", c.mass, "kg")],
    };
    let lumped = &file.structure.lumped_mass;
    lines.extend(lumped.iter().map(|l| number(&format!("lumped mass at DOF {}", l.dof), l.mass, "kg")));
    table("parameter\tvalue\tunit", lines.into_iter())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::parameters;
    use crate::exchange::project::ProjectFile;

    #[test]
    fn parameters_stand_line_by_line_with_their_units() {
        let text = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.5]\nground_stiffness = [9.0, 0.0]\n\
                    coupling_stiffness = [4.0]\n[[structure.lumped_mass]]\ndof = \"2\"\nmass = 0.5\n";
        let file = ProjectFile::parse(text, "p.toml").unwrap().0;
        let lines: Vec<String> = parameters(&file).lines().map(str::to_owned).collect();
        assert_eq!(lines[2], "masses[2]\t2.5e0\tkg");
        assert_eq!(lines[5], "coupling_stiffness[1]\t4e0\tN/m");
        assert_eq!(lines[6], "lumped mass at DOF 2\t5e-1\tkg");
    }
}

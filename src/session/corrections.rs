//! The corrections of the model that a search found as commands: other numbers of the structure and of its known sources.

use super::command::{Command, SourceAt};
use super::document::Document;
use crate::diagnosis::result::Verdict;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::Source;
use crate::exchange::project::correction::{CorrectionTable, FACTORS};
use crate::exchange::project::file::{Shape, StructureTable};
use crate::structure::{Part, Structure};
use std::collections::BTreeMap;

/// How corrections are taken over.
#[derive(Debug, Default)]
pub(crate) struct Adopted {
    /// The commands that do it, to be undone together.
    pub commands: Vec<Command>,
    /// Which corrections the project has no number for, by their place in the list.
    pub left: Vec<usize>,
    /// The correction that no model needs, for which none is taken over: they were fitted together.
    pub impossible: Option<usize>,
}

/// Largest factor on a stiffness or a mass, and inverse of the smallest, that is taken over from a search which explains nothing:
/// models are not wrong by more, and there such factors only follow what is missing.
const MOST: f64 = 7.0;

/// [`adopt`] for all corrections of a search that ended with `verdict`.
pub(crate) fn adopt_all(
    corrections: &[Correction],
    verdict: Verdict,
    known: &[Source],
    document: &Document,
) -> Adopted {
    let unexplained = verdict == Verdict::Unexplained;
    match corrections.iter().position(|correction| !is_possible(correction, unexplained)) {
        None => adopt(corrections, known, document),
        impossible => Adopted { impossible, ..Adopted::default() },
    }
}

/// Whether a model may be off by a correction. Supports give way to nothing, and damping is often but guessed.
fn is_possible(correction: &Correction, unexplained: bool) -> bool {
    let factor = correction.factor;
    let bounded = match correction.parameter {
        UpdatingParameter::Structure(part) => {
            !matches!(part, Part::Support(_) | Part::ModeDamping(_) | Part::ModeDampingPerOctave(_))
        }
        _ => false,
    };
    FACTORS.contains(&factor) && !(unexplained && bounded && factor.ln().abs() > MOST.ln())
}

/// Multiplies what the project states by the factors of `corrections`; `known` are the sources that act in the model.
pub(crate) fn adopt(corrections: &[Correction], known: &[Source], document: &Document) -> Adopted {
    let (structure, table) = (document.structure(), &document.file().structure);
    let mut adopted = Adopted::default();
    let mut numbers = Numbers { table, values: BTreeMap::new() };
    let mut tables = Vec::new();
    for (k, correction) in corrections.iter().enumerate() {
        let factor = correction.factor;
        match &correction.parameter {
            UpdatingParameter::Structure(part) => {
                if *part == Part::Mass {
                    adopted.commands.extend(lumped(table, factor));
                }
                if !numbers.part(*part, factor) {
                    tables.push(CorrectionTable::of(structure, *part, factor));
                }
            }
            UpdatingParameter::Known(index) => match known.get(*index) {
                Some(source) => adopted.commands.push(resized(source, factor, structure)),
                None => adopted.left.push(k),
            },
            UpdatingParameter::Gain(_)
            | UpdatingParameter::ForceGain(_)
            | UpdatingParameter::Delay(_)
            | UpdatingParameter::Session(_) => {
                adopted.left.push(k);
            }
        }
    }
    if !tables.is_empty() {
        adopted.commands.push(Command::CorrectStructure(tables));
    }
    if !numbers.values.is_empty() {
        adopted.commands.push(Command::SetStructureParameters(numbers.values));
    }
    adopted
}

/// Numbers of the structure under their keys as they will be.
struct Numbers<'a> {
    table: &'a StructureTable,
    values: BTreeMap<String, f64>,
}

impl Numbers<'_> {
    fn scale(&mut self, key: String, value: f64, factor: f64) {
        *self.values.entry(key).or_insert(value) *= factor;
    }

    fn list(&mut self, name: &str, values: &[f64], factor: f64) {
        for (k, &value) in values.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            self.scale(format!("{name}[{}]", k + 1), value, factor);
        }
    }

    /// Whether the project has a number for the part.
    fn part(&mut self, part: Part, factor: f64) -> bool {
        match part {
            Part::Stiffness => self.stiffness(factor),
            Part::Mass => self.mass(factor),
            Part::GroundSpring(dof) => self.spring("ground_stiffness", dof, factor),
            Part::Coupling([first, second]) if second == first + 1 => self.spring("coupling_stiffness", first, factor),
            Part::PointMass(dof) if self.table.lumped_mass.is_empty() => self.spring("masses", dof, factor),
            _ => false,
        }
    }

    fn stiffness(&mut self, factor: f64) -> bool {
        match &self.table.shape {
            Shape::Beam(beam) => self.scale("youngs_modulus".to_owned(), beam.youngs_modulus, factor),
            Shape::Chain(chain) => {
                self.list("ground_stiffness", &chain.ground_stiffness, factor);
                self.list("coupling_stiffness", &chain.coupling_stiffness, factor);
            }
            Shape::Matrices(_) | Shape::Points(_) | Shape::Component(_) => return false,
        }
        true
    }

    fn mass(&mut self, factor: f64) -> bool {
        match &self.table.shape {
            Shape::Beam(beam) => self.scale("density".to_owned(), beam.density, factor),
            Shape::Chain(chain) => self.list("masses", &chain.masses, factor),
            Shape::Matrices(_) | Shape::Points(_) | Shape::Component(_) => return false,
        }
        true
    }

    /// Number `k` of a list of a chain.
    fn spring(&mut self, name: &str, k: usize, factor: f64) -> bool {
        let Shape::Chain(chain) = &self.table.shape else { return false };
        let list = match name {
            "ground_stiffness" => &chain.ground_stiffness,
            "coupling_stiffness" => &chain.coupling_stiffness,
            _ => &chain.masses,
        };
        let Some(&value) = list.get(k) else { return false };
        self.scale(format!("{name}[{}]", k + 1), value, factor);
        true
    }
}

/// Lumped masses belong to all mass, where density or masses do.
fn lumped(table: &StructureTable, factor: f64) -> Vec<Command> {
    if !matches!(table.shape, Shape::Beam(_) | Shape::Chain(_)) {
        return Vec::new();
    }
    let scaled = |mass: f64| Some(mass * factor);
    let scaled_mass =
        |l: &crate::structure::LumpedMass| Command::SetLumpedMass { dof: l.dof.clone(), mass: scaled(l.mass) };
    table.lumped_mass.iter().map(scaled_mass).collect()
}

/// A known source of another size: its coefficient, or stiffness and force together.
fn resized(source: &Source, factor: f64, structure: &Structure) -> Command {
    let effect = source.effect;
    let parameters = effect
        .scaled()
        .iter()
        .map(|&k| (effect.parameters()[k].name.to_owned(), source.parameters[k] * factor))
        .collect();
    Command::SetSourceParameters { source: SourceAt::of(source, structure), parameters }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

    use super::*;
    use crate::effects::State;
    use crate::session::Session;

    const CHAIN: &str = "[project]\nformat = 1\ntitle = \"Chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
                         ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
                         [[structure.lumped_mass]]\ndof = 2\nmass = 0.5\n\
                         [[source]]\nlaw = \"viscous\"\ndofs = [1, 2]\nstate = \"known\"\nc = 2.0\n";

    fn correction(parameter: UpdatingParameter, factor: f64) -> Correction {
        Correction { parameter, factor, deviation: 0.01 }
    }

    #[test]
    fn corrections_that_no_model_needs_are_not_taken_over() {
        let structure = |part: Part, factor: f64| correction(UpdatingParameter::Structure(part), factor);
        for (one, explained, unexplained) in [
            (structure(Part::Mass, 1.2), true, true),
            (structure(Part::Mass, 8.0), true, false),
            (structure(Part::Coupling([0, 1]), 0.1), true, false),
            (structure(Part::Mass, -0.3), false, false),
            (correction(UpdatingParameter::Known(0), -0.3), false, false),
            (correction(UpdatingParameter::Known(0), 20.0), true, true),
            (correction(UpdatingParameter::Known(0), f64::NAN), false, false),
        ] {
            assert_eq!([false, true].map(|u| is_possible(&one, u)), [explained, unexplained], "{one:?}");
        }
    }

    #[test]
    fn one_that_is_impossible_leaves_out_those_that_were_fitted_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let d = Session::open(&path).unwrap().document().clone();
        let corrections = [
            correction(UpdatingParameter::Structure(Part::Stiffness), 1.1),
            correction(UpdatingParameter::Structure(Part::Mass), 8.0),
        ];
        let adopted = adopt_all(&corrections, Verdict::Unexplained, &[], &d);
        assert!(adopted.commands.is_empty() && adopted.impossible == Some(1));
        assert_eq!(adopt_all(&corrections, Verdict::Detuned, &[], &d).commands.len(), 2);
    }

    #[test]
    fn corrections_multiply_what_the_project_states() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let d = Session::open(&path).unwrap().document().clone();
        let list = [
            correction(UpdatingParameter::Structure(Part::Stiffness), 1.1),
            correction(UpdatingParameter::Structure(Part::Mass), 0.9),
            correction(UpdatingParameter::Structure(Part::Coupling([0, 1])), 1.2),
            correction(UpdatingParameter::Known(0), 1.5),
            correction(UpdatingParameter::Gain("acc@1".to_owned()), 1.01),
        ];
        let known: Vec<Source> = d.sources().iter().filter(|s| s.state == State::Known).cloned().collect();
        let adopted = adopt(&list, &known, &d);
        assert_eq!(adopted.left, [4], "a gain is no number of the model");
        let d = adopted.commands.iter().fold(d, |d, command| d.after(command).unwrap());
        let stiffness = d.structure().matrices().unwrap().stiffness.clone();
        assert!((stiffness[(0, 1)] + 50.0 * 1.1 * 1.2).abs() < 1e-9 && (stiffness[(0, 0)] - 176.0).abs() < 1e-9);
        let mass = d.structure().matrices().unwrap().mass.clone();
        assert!((mass[(1, 1)] - 2.25).abs() < 1e-12 && (mass[(0, 0)] - 0.9).abs() < 1e-12);
        assert!((d.sources()[0].parameters[0] - 3.0).abs() < 1e-12);
    }
}

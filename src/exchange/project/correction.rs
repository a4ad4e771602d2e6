//! Tables `[[structure.correction]]`: factors on parts of the structure for which the project has no number of its own,
//! such as the stiffness of a mode or of a range of elements; what model updating found.

use super::error::{ProjectError, TableProblem};
use super::keys_of::keys_of;
use super::label::Label;
use super::lines::Lines;
use super::reader::Table;
use crate::structure::{Part, Structure};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Factors that may correct a part: a bolt that is all loose leaves a trace of its stiffness, a clamp that is meant to be rigid has no measure.
pub(crate) const FACTORS: RangeInclusive<f64> = 1e-9..=1e9;

/// Kinds of parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Corrected {
    Stiffness,
    Mass,
    Mode,
    ModeCoupling,
    ModeDamping,
    ModeDampingPerOctave,
    Spring,
    PointMass,
    ElementStiffness,
    ElementMass,
    Support,
}

impl Corrected {
    /// Whether a part of this kind is named by `key`.
    fn takes(self, key: &str) -> Result<(), TableProblem> {
        let own = match self {
            Self::Stiffness | Self::Mass => "",
            Self::Mode | Self::ModeDamping | Self::ModeDampingPerOctave => "mode",
            Self::ModeCoupling => "modes",
            Self::Spring | Self::PointMass => "dofs",
            Self::ElementStiffness | Self::ElementMass => "elements",
            Self::Support => "node",
        };
        let table = format!("[[structure.correction]] of what = \"{}\"", keys_of::<Self>()[self as usize]);
        let hint = if own.is_empty() { "leave it out".to_owned() } else { format!("its part is named by `{own}`") };
        let problem = TableProblem::UnknownKey { table, key: key.to_owned(), hint };
        if own == key { Ok(()) } else { Err(problem) }
    }
}

/// Table `[[structure.correction]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrectionTable {
    /// Kind of part.
    pub what: Corrected,
    /// DOFs of a spring (one: to the ground) or of a mass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
    /// First and last element, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[i64; 2]>,
    /// Mode, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<i64>,
    /// Two modes that are coupled, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<[i64; 2]>,
    /// Node of a support.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<Label>,
    /// Factor, positive.
    pub factor: f64,
}

impl CorrectionTable {
    /// The table of a part of `structure`.
    pub fn of(structure: &Structure, part: Part, factor: f64) -> Self {
        let label = |dof: usize| Label(structure.label(dof).to_owned());
        let plain = |what| Self { what, dofs: Vec::new(), elements: None, mode: None, modes: None, node: None, factor };
        let elements = |range: [usize; 2]| Some(range.map(|e| e as i64 + 1));
        match part {
            Part::Stiffness => plain(Corrected::Stiffness),
            Part::Mass => plain(Corrected::Mass),
            Part::Mode(mode) => Self { mode: Some(mode as i64 + 1), ..plain(Corrected::Mode) },
            Part::ModeCoupling(pair) => {
                Self { modes: Some(pair.map(|mode| mode as i64 + 1)), ..plain(Corrected::ModeCoupling) }
            }
            Part::ModeDamping(mode) => Self { mode: Some(mode as i64 + 1), ..plain(Corrected::ModeDamping) },
            Part::ModeDampingPerOctave(mode) => {
                Self { mode: Some(mode as i64 + 1), ..plain(Corrected::ModeDampingPerOctave) }
            }
            Part::GroundSpring(dof) => Self { dofs: vec![label(dof)], ..plain(Corrected::Spring) },
            Part::Coupling(pair) => Self { dofs: pair.map(label).to_vec(), ..plain(Corrected::Spring) },
            Part::PointMass(dof) => Self { dofs: vec![label(dof)], ..plain(Corrected::PointMass) },
            Part::ElementStiffness(range) => Self { elements: elements(range), ..plain(Corrected::ElementStiffness) },
            Part::ElementMass(range) => Self { elements: elements(range), ..plain(Corrected::ElementMass) },
            Part::Support(held) => {
                Self { node: structure.held_node(held).map(|n| Label(n.to_owned())), ..plain(Corrected::Support) }
            }
        }
    }

    /// The part of `structure` that it names.
    ///
    /// # Errors
    /// [`TableProblem`] where the structure has no such part.
    pub fn part(&self, structure: &Structure) -> Result<Part, TableProblem> {
        let missing = |key, example: &str| TableProblem::MissingKey {
            table: "[[structure.correction]]".to_owned(),
            key,
            example: example.to_owned(),
        };
        let dof =
            |label: &Label| structure.require_dof(&label.0).map_err(|error| TableProblem::Structure(Box::new(error)));
        let range = || -> Result<[usize; 2], TableProblem> {
            let [first, last] = self.elements.ok_or_else(|| missing("elements", "elements = [1, 4]"))?;
            let count = structure.elements().len() as i64;
            if first >= 1 && first <= last && last <= count {
                return Ok([first as usize - 1, last as usize - 1]);
            }
            let value = format!("[{first}, {last}]");
            Err(TableProblem::OutOfRange { key: "elements".into(), value, range: "first to last element of the beam" })
        };
        let number = |key: &str, mode: i64| {
            let within = mode >= 1 && mode <= structure.len() as i64;
            let (value, range) = (mode.to_string(), "1 to the number of DOFs");
            if within { Ok(mode as usize - 1) } else { Err(TableProblem::OutOfRange { key: key.into(), value, range }) }
        };
        let mode = || self.mode.ok_or_else(|| missing("mode", "mode = 2")).and_then(|mode| number("mode", mode));
        let modes = || match self.modes.ok_or_else(|| missing("modes", "modes = [1, 3]"))? {
            [first, second] if first == second => {
                let (value, range) = (format!("[{first}, {second}]"), "two different modes");
                Err(TableProblem::OutOfRange { key: "modes".into(), value, range })
            }
            [first, second] => Ok([number("modes", first)?, number("modes", second)?]),
        };
        Ok(match self.what {
            Corrected::Stiffness => Part::Stiffness,
            Corrected::Mass => Part::Mass,
            Corrected::Mode => Part::Mode(mode()?),
            Corrected::ModeCoupling => Part::ModeCoupling(modes()?),
            Corrected::ModeDamping => Part::ModeDamping(mode()?),
            Corrected::ModeDampingPerOctave => Part::ModeDampingPerOctave(mode()?),
            Corrected::Spring => match &self.dofs[..] {
                [one] => Part::GroundSpring(dof(one)?),
                [first, second] => Part::Coupling([dof(first)?, dof(second)?]),
                _ => return Err(missing("dofs", "dofs = [2, 3]")),
            },
            Corrected::PointMass => match &self.dofs[..] {
                [one] => Part::PointMass(dof(one)?),
                _ => return Err(missing("dofs", "dofs = [2]")),
            },
            Corrected::ElementStiffness => Part::ElementStiffness(range()?),
            Corrected::ElementMass => Part::ElementMass(range()?),
            Corrected::Support => {
                let node = self.node.as_ref().ok_or_else(|| missing("node", "node = \"0\""))?;
                let held = structure.supports().into_iter().find(|&h| structure.held_node(h) == Some(&node.0));
                let value = node.0.clone();
                Part::Support(held.ok_or(TableProblem::OutOfRange {
                    key: "node".into(),
                    value,
                    range: "the node of a clamped or pinned end of the beam",
                })?)
            }
        })
    }
}

/// Reads the tables of `[structure]`.
pub(super) fn parse(structure: &Table<'_>, lines: &mut Lines) -> Result<Vec<CorrectionTable>, ProjectError> {
    let mut tables = Vec::new();
    for table in structure.tables("correction", "[[structure.correction]]")? {
        table.only_in::<CorrectionTable>(&[])?;
        let what: Corrected = table.need("what", "what = \"mode\"", table.variant("what")?)?;
        let dofs: Vec<_> = table.labels("dofs")?.unwrap_or_default().into_iter().map(Label).collect();
        let factor = table.need("factor", "factor = 1.02", table.number("factor")?)?;
        if !FACTORS.contains(&factor) {
            let (key, value, range) = ("factor".to_owned(), factor.to_string(), "from 1e-9 to 1e9");
            return Err(table.error("factor", TableProblem::OutOfRange { key, value, range }));
        }
        let (elements, mode) = (super::keys::elements(&table)?, table.whole("mode")?);
        let modes = super::keys::modes(&table)?;
        let node = table.label("node")?.map(Label);
        let stated = [("dofs", !dofs.is_empty()), ("elements", elements.is_some()), ("mode", mode.is_some())];
        for (key, _) in stated
            .into_iter()
            .chain([("modes", modes.is_some()), ("node", node.is_some())])
            .filter(|(_, is_there)| *is_there)
        {
            what.takes(key).map_err(|problem| table.error(key, problem))?;
        }
        tables.push(CorrectionTable { what, dofs, elements, mode, modes, node, factor });
        lines.note(&table);
    }
    Ok(tables)
}

/// The structure with its corrections.
///
/// # Errors
/// The number of the table, from 0, and what is wrong with it.
pub(crate) fn corrected(structure: Structure, tables: &[CorrectionTable]) -> Result<Structure, (usize, TableProblem)> {
    if tables.is_empty() {
        return Ok(structure);
    }
    let factor_of = |(k, table): (usize, &CorrectionTable)| {
        Ok((table.part(&structure).map_err(|problem| (k, problem))?, table.factor))
    };
    let factors = tables.iter().enumerate().map(factor_of).collect::<Result<Vec<_>, _>>()?;
    Ok(structure.with_factors(&factors))
}

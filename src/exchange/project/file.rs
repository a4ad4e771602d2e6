//! The project file as plain data, one field a key, as it is written; where each part stood is in [`Lines`].

use super::correction::CorrectionTable;
use super::ruled_out::RuledOutTable;
use crate::effects::family::Family;
use crate::effects::{Effect, State};
use crate::identify::Settings;
use crate::structure::LumpedMass;
use crate::structure::beam::BeamParameters;
use crate::structure::chain::ChainParameters;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// The newest format that is understood.
pub const FORMAT: u64 = 1;

/// A project file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProjectFile {
    /// Table `[project]`.
    pub project: Header,
    /// Table `[structure]`.
    pub structure: StructureTable,
    /// Tables `[[source]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub source: Vec<SourceTable>,
    /// Tables `[[candidates]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<CandidatesTable>,
    /// Tables `[[sensor]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensor: Vec<SensorTable>,
    /// Tables `[[ruled_out]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ruled_out: Vec<RuledOutTable>,
    /// Tables `[[run]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub run: Vec<RunTable>,
    /// Tables `[[harmonics]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<HarmonicsTable>,
    /// Table `[analysis]`.
    #[serde(skip_serializing_if = "is_default")]
    pub analysis: Settings,
    /// Table `[simulate]`.
    #[serde(skip_serializing_if = "is_default")]
    pub simulate: SimulateTable,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Table `[project]`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Header {
    /// Version of the format.
    pub format: u64,
    /// Title.
    pub title: String,
    /// Free text.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub notes: String,
}

/// Table `[structure]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StructureTable {
    /// Kind and its keys.
    #[serde(flatten)]
    pub shape: Shape,
    /// Tables `[[structure.lumped_mass]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lumped_mass: Vec<LumpedMass>,
    /// Tables `[[structure.correction]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub correction: Vec<CorrectionTable>,
}

/// Kinds of structure.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Shape {
    /// Uniform beam.
    Beam(BeamParameters),
    /// Chain of masses.
    Chain(ChainParameters),
    /// Matrices from files.
    Matrices(MatricesTable),
    /// Points without matrices.
    Points(PointsTable),
}

/// Files of a structure that is given by its matrices, relative to the project.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct MatricesTable {
    /// Mass matrix.
    pub mass: String,
    /// Stiffness matrix.
    pub stiffness: String,
    /// Table of nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<String>,
    /// Table of DOFs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dofs: Option<String>,
    /// Table of lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines: Option<String>,
}

/// Measured points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointsTable {
    /// Labels.
    pub dofs: Vec<Label>,
    /// Positions, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positions: Option<Vec<[f64; 3]>>,
}

/// A DOF label; one that is a number is written without quotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label(pub String);

impl Serialize for Label {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.parse::<i64>() {
            Ok(number) if number.to_string() == self.0 => serializer.serialize_i64(number),
            _ => serializer.serialize_str(&self.0),
        }
    }
}

/// Table `[[source]]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SourceTable {
    /// Law.
    pub law: Effect,
    /// DOFs; none for a law of the whole structure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
    /// First and last beam element, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements: Option<[i64; 2]>,
    /// What identification may do with it.
    pub state: State,
    /// Parameters by name.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
}

/// Table `[[candidates]]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CandidatesTable {
    /// Law.
    pub law: Effect,
    /// Key `where`.
    #[serde(rename = "where")]
    pub family: Family,
    /// Values of parameters that are not identified, by name.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
}

/// Table `[[sensor]]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensorTable {
    /// Channel, such as `acc@7`.
    pub channel: String,
    /// How late it is recorded, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay: Option<f64>,
    /// How many times too large it reads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
}

/// Table `[[run]]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunTable {
    /// Record, relative to the project.
    pub file: String,
    /// Frequency, Hz; estimated where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
    /// Label of the force level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<i64>,
    /// Key `use`.
    #[serde(rename = "use", skip_serializing_if = "Clone::clone")]
    pub enabled: bool,
    /// DOF of the force in a recipe.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_dof: Option<Label>,
    /// Amplitude of the force in a recipe, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_n: Option<f64>,
}

/// Table `[[harmonics]]`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct HarmonicsTable {
    /// File of fitted coefficients, relative to the project.
    pub file: String,
}

/// Table `[simulate]`: what `simulate` records.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SimulateTable {
    /// Channels with their units, such as `acc@7 [m/s^2]`; empty: the force and every translation's acceleration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<String>,
    /// Samples a channel.
    pub samples: usize,
    /// Periods in the record.
    pub periods: usize,
    /// Whether the motion is stepped through time until it is periodic, rather than found by harmonic balance.
    #[serde(default)]
    pub integrate: bool,
}

impl Default for SimulateTable {
    fn default() -> Self {
        Self { channels: Vec::new(), samples: 1000, periods: 20, integrate: false }
    }
}

impl ProjectFile {
    /// The file's text.
    ///
    /// # Errors
    /// Only if TOML cannot hold the data, which no project that was read can cause.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }
}

/// Line, from 1, of every part of a project file, for messages about what is found wrong later.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lines {
    /// Keys of `[structure]`; the empty key is its head.
    pub structure: BTreeMap<String, usize>,
    /// Tables `[[structure.lumped_mass]]`.
    pub lumped_mass: Vec<usize>,
    /// Tables `[[structure.correction]]`.
    pub correction: Vec<usize>,
    /// Keys of each `[[source]]`; the empty key is its head.
    pub source: Vec<BTreeMap<String, usize>>,
    /// Keys of each `[[candidates]]`.
    pub candidates: Vec<BTreeMap<String, usize>>,
    /// Tables `[[sensor]]`.
    pub sensor: Vec<usize>,
    /// Keys of each `[[ruled_out]]`.
    pub ruled_out: Vec<BTreeMap<String, usize>>,
    /// Keys of each `[[run]]`.
    pub run: Vec<BTreeMap<String, usize>>,
    /// Tables `[[harmonics]]`.
    pub harmonics: Vec<usize>,
    /// Table `[simulate]`.
    pub simulate: usize,
}

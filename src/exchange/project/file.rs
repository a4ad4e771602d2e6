//! The project file as plain data, one field a key, as it is written; where each part stood is in [`Lines`]. TOML has no null: keys whose
//! field is `None` are not written.

use super::correction::CorrectionTable;
use super::excitation::ExcitationTable;
use super::frf::FrfTable;
pub use super::label::Label;
pub use super::lines::Lines;
pub use super::modes::ModesTable;
pub use super::reduce::ReduceTable;
pub use super::report::ReportTable;
use super::ruled_out::RuledOutTable;
use crate::effects::family::Family;
use crate::effects::{Effect, State};
use crate::exchange::mapping::ChannelTable;
use crate::identify::Settings;
use crate::measurement::{Kind, Quantity};
use crate::structure::LumpedMass;
use crate::structure::beam::BeamParameters;
use crate::structure::chain::ChainParameters;
use crate::structure::component::ComponentParameters;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;

/// The newest format that is understood.
pub const FORMAT: u64 = 1;

/// A project file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Tables `[[channel]]`: how the channels of laboratory files are read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub channel: Vec<ChannelTable>,
    /// Tables `[[run]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub run: Vec<RunTable>,
    /// Tables `[[harmonics]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<HarmonicsTable>,
    /// Tables `[[frf]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frf: Vec<FrfTable>,
    /// Tables `[[modes]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<ModesTable>,
    /// Table `[base]`.
    #[serde(skip_serializing_if = "is_default")]
    pub base: BaseTable,
    /// Table `[analysis]`.
    #[serde(skip_serializing_if = "is_default")]
    pub analysis: Settings,
    /// Table `[simulate]`.
    #[serde(skip_serializing_if = "is_default")]
    pub simulate: SimulateTable,
    /// Table `[report]`.
    #[serde(skip_serializing_if = "is_default")]
    pub report: ReportTable,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Table `[project]`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// One component whose displacement is imposed.
    Component(ComponentParameters),
}

/// Files of a structure that is given by its matrices, relative to the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MatricesTable {
    /// Mass matrix.
    pub mass: String,
    /// Stiffness matrix.
    pub stiffness: String,
    /// Table of nodes.
    pub nodes: Option<String>,
    /// Table of DOFs.
    pub dofs: Option<String>,
    /// Table of lines.
    pub lines: Option<String>,
    /// Name of the mass matrix in a file of several.
    pub mass_name: Option<String>,
    /// Name of the stiffness matrix in a file of several.
    pub stiffness_name: Option<String>,
    /// Table `[structure.reduce]`.
    pub reduce: Option<ReduceTable>,
}

/// Measured points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointsTable {
    /// Labels.
    pub dofs: Vec<Label>,
    /// Positions, m.
    pub positions: Option<Vec<[f64; 3]>>,
}

/// Table `[[source]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceTable {
    /// Law.
    pub law: Effect,
    /// DOFs; none for a law of the whole structure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
    /// First and last beam element, from 1.
    pub elements: Option<[i64; 2]>,
    /// What identification may do with it.
    pub state: State,
    /// Parameters by name.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
}

/// Table `[[candidates]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensorTable {
    /// Channel, such as `acc@7`.
    pub channel: String,
    /// How late it is recorded, s.
    pub delay: Option<f64>,
    /// How many times too large it reads.
    pub gain: Option<f64>,
}

impl SensorTable {
    /// The errors it states, each with its value: the keys are names of laws.
    pub fn errors(&self) -> impl Iterator<Item = (Effect, f64)> {
        let values = [("delay", self.delay), ("gain", self.gain)];
        values.into_iter().filter_map(|(key, value)| Some((Effect::from_name(key)?, value?)))
    }
}

/// Table `[[run]]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RunTable {
    /// Record, relative to the project.
    pub file: String,
    /// Frequency, Hz; estimated where it is left out.
    pub frequency: Option<f64>,
    /// Kind of the run.
    #[serde(skip_serializing_if = "Kind::is_steady")]
    pub kind: Kind,
    /// First instant of the part that is used, s.
    pub start_s: Option<f64>,
    /// Last instant of the part that is used, s.
    pub end_s: Option<f64>,
    /// Time constant of an exponential window over the motion, s.
    pub exponential_window_s: Option<f64>,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Name of the session it was measured in.
    pub session: Option<String>,
    /// Key `use`: `false` leaves the run out, `true` takes it even where it is flagged.
    #[serde(rename = "use")]
    pub enabled: Option<bool>,
    /// DOF of the force in a recipe.
    pub force_dof: Option<Label>,
    /// Amplitude of the force in a recipe, N.
    pub force_n: Option<f64>,
    /// Share by which all natural frequencies are higher in this run of a recipe.
    pub frequency_shift: Option<f64>,
    /// What is done to the structure in a recipe of a test that is not steady.
    pub excitation: Option<ExcitationTable>,
    /// Set of a laboratory file, where it has several with the channels of the mapping.
    pub set: Option<String>,
    /// Sets of a laboratory file in which every data set is one channel: one a `[[channel]]`, in their order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<String>,
    /// DOFs of channels in this run, by the names of the channels in the file: where a roving hammer or sensor was.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub dofs: BTreeMap<String, Label>,
    /// Sampling rate of a laboratory file without time, Hz.
    pub sampling_hz: Option<f64>,
    /// Direction in which the base moves in a recipe: `x`, `y` or `z`.
    pub base: Option<String>,
    /// Amplitude of the base's acceleration in a recipe, m/s^2.
    pub base_m_s2: Option<f64>,
    /// Whether the motions of the record are absolute or relative to the base; as `[base]` says unless given.
    pub response: Option<BaseResponse>,
}

/// Table `[base]`: a structure on a moving base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct BaseTable {
    /// What the motions of the records are.
    pub response: BaseResponse,
}

/// What a sensor on a structure with a moving base shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BaseResponse {
    /// The motion in space: accelerometers.
    #[default]
    Absolute,
    /// The motion against the base: displacement sensors on the table.
    Relative,
}

/// Table `[[harmonics]]`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HarmonicsTable {
    /// File of fitted coefficients, relative to the project.
    pub file: String,
    /// Channel of the column `force` of a stepped-sine table, with its unit, such as `force@1 [N]`.
    pub force: Option<String>,
    /// Channel of its columns `amplitude` and `phase_deg`, such as `acc@7 [g]`.
    pub response: Option<String>,
    /// Quantity whose phases a stepped-sine table gives (`disp`, `vel`, `acc`), where it is not that of the channel.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "word")]
    pub phase_of: Option<Quantity>,
    /// Label of the force level of all its runs that name none.
    pub level: Option<i64>,
    /// Name of the session of all its runs that name none.
    pub session: Option<String>,
    /// Key `use`, as at `[[run]]`.
    #[serde(rename = "use")]
    pub enabled: Option<bool>,
    /// Sheet, group or block of the file that is the table.
    pub set: Option<String>,
    /// `[harmonics.phases]`: the column of the phase of each `[[channel]]` of a table in a laboratory file.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub phases: BTreeMap<String, String>,
}

#[allow(clippy::trivially_copy_pass_by_ref, clippy::ref_option, reason = "serde passes references to fields")]
fn word<S: Serializer>(quantity: &Option<Quantity>, serializer: S) -> Result<S::Ok, S::Error> {
    quantity.map(Quantity::word).serialize(serializer)
}

/// Table `[simulate]`: what `simulate` records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Samples a second of tests that are not steady, Hz.
    pub rate_hz: Option<f64>,
    /// Bits of the converter; exact without.
    pub bits: Option<u32>,
    /// Whether signals are filtered against aliasing before they are sampled.
    #[serde(skip_serializing_if = "Clone::clone")]
    pub filter: bool,
}

impl Default for SimulateTable {
    fn default() -> Self {
        Self {
            channels: Vec::new(),
            samples: 1000,
            periods: 20,
            integrate: false,
            rate_hz: None,
            bits: None,
            filter: true,
        }
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

    /// What is stated of a channel.
    pub(crate) fn sensor_at(&self, channel: &str) -> Option<&SensorTable> {
        self.sensor.iter().find(|table| table.channel.trim() == channel.trim())
    }

    /// Whether runs of this kind are fitted as steady states; loops of a component are compared as they are, whatever they
    /// are called.
    pub fn is_steady(&self, kind: Kind) -> bool {
        kind.is_steady() && !matches!(self.structure.shape, Shape::Component(_))
    }
}

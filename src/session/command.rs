//! Every change of a document, as data: a click, a line of a script and a test say the same words.
//!
//! In JSON a command is an object with one key, such as `{"add_source": {"law": "viscous", "dofs": ["3"]}}`.

use crate::balance::{Expansion, Weights};
use crate::effects::{Effect, Family, Source, State, WrittenPlace};
use crate::exchange::project::correction::CorrectionTable;
use crate::exchange::project::file::ReportTable;
use crate::exchange::project::ruled_out::RuledOutTable;
use crate::structure::Structure;
use crate::structure::beam::Supports;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A source to draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceSpec {
    /// The law.
    pub law: Effect,
    /// Labels of its DOFs; none for a law of the whole structure.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<String>,
    /// First and last beam element, from 1, of a law of the whole structure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[i64; 2]>,
    /// What identification may do with it; a candidate where nothing is said.
    #[serde(default = "candidate")]
    pub state: State,
    /// Parameters by name, SI units.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, f64>,
}

fn candidate() -> State {
    State::Candidate
}

/// Which source of the document: its law and its place. The state is needed only where a known source and a sought one of
/// the same law lie on top of each other.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceAt {
    /// The law.
    pub law: Effect,
    /// Labels of its DOFs, in either direction.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<String>,
    /// First and last beam element, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[i64; 2]>,
    /// Its state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<State>,
}

impl SourceAt {
    /// The source where it acts; an error of a channel has no DOFs.
    pub fn of(source: &Source, structure: &Structure) -> Self {
        let WrittenPlace { dofs, elements, .. } = source.place.written(structure);
        Self { law: source.effect, dofs, elements, state: Some(source.state) }
    }
}

/// What is wrong with channels, and how the records name theirs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mending {
    /// Channels, such as `acc@7`: those that read `factor` times too large, the two that are exchanged, or one and its
    /// name at the DOF where it is.
    pub channels: Vec<String>,
    /// How many times too large they read, negative where they are reversed; none where they are exchanged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// How many seconds the channel is recorded late, beside what is stated of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub late: Option<f64>,
    /// Whether the first channel is where the second is said to be.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub elsewhere: bool,
    /// Labels of the DOFs where the forces of frequency responses act, which stay when sensors are put elsewhere.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub driven: Vec<String>,
    /// Names of the channels of the records, for a project that has no `[[channel]]` yet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<String>,
}

/// A setting of the analysis and its new value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// Harmonics fitted to each channel.
    Harmonics(usize),
    /// Expansion to all DOFs.
    Expansion(Expansion),
    /// Best single columns kept; 0 = all sets.
    Keep(usize),
    /// Weights of the rows.
    Weights(Weights),
    /// Most sources in a set.
    MaxSources(usize),
    /// Angle in degrees below which the search stops.
    StopAngleDeg(f64),
}

/// A change of the document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[expect(missing_docs, reason = "fields are those of the project file, whose format is documented")]
pub enum Command {
    /// Names the project.
    SetTitle(String),
    /// Replaces the free text.
    SetNotes(String),
    /// Replaces what stands on the title page of reports.
    SetReport(ReportTable),
    /// Draws a source. Refused where the same one is drawn already.
    AddSource(SourceSpec),
    /// Takes a source out.
    RemoveSource(SourceAt),
    /// Makes a source known, candidate, forced, off or reference. To force a source is to set it `forced`.
    SetSourceState { source: SourceAt, state: State },
    /// Sets parameters by name; those not named stay.
    SetSourceParameters { source: SourceAt, parameters: BTreeMap<String, f64> },
    /// Draws a family of candidates.
    AddCandidates {
        law: Effect,
        #[serde(rename = "where")]
        family: Family,
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        parameters: BTreeMap<String, f64>,
    },
    /// Takes a family out.
    RemoveCandidates {
        law: Effect,
        #[serde(rename = "where")]
        family: Family,
    },
    /// Sets a number of the structure by its key, such as `length` or `masses[2]` (counted from 1).
    SetStructureParameter { name: String, value: f64 },
    /// Sets several numbers of the structure at once.
    SetStructureParameters(BTreeMap<String, f64>),
    /// Holds the ends of the beam otherwise.
    SetSupports(Supports),
    /// Sets the lumped mass at a DOF, kg; none takes it off.
    SetLumpedMass { dof: String, mass: Option<f64> },
    /// Multiplies parts of the structure that have no number of their own by factors.
    CorrectStructure(Vec<CorrectionTable>),
    /// Adds records; paths are relative to the project.
    ImportRuns(Vec<String>),
    /// Adds measurements as the tables `[[channel]]`, `[[run]]`, `[[harmonics]]` and `[[frf]]` of a TOML text; paths are relative
    /// to the project.
    ImportTables(String),
    /// Takes a run out; its record stays where it is.
    RemoveRun(String),
    /// Uses a run or not.
    SetRunUse {
        file: String,
        #[serde(rename = "use")]
        enabled: bool,
    },
    /// Sets the frequency of a run, Hz; none estimates it from the record.
    SetRunFrequency { file: String, frequency: Option<f64> },
    /// Labels the force level of a run.
    SetRunLevel { file: String, level: Option<i64> },
    /// States the known errors of a channel: delay in s and gain; none of both forgets them.
    SetSensor { channel: String, delay: Option<f64>, gain: Option<f64> },
    /// Mends what channels were found to read wrongly in their mapping.
    MendChannels(Mending),
    /// States that an effect at its place is not what the model lacks: the search suggests others.
    RuleOut(RuledOutTable),
    /// Takes that back.
    Allow(RuledOutTable),
    /// Changes a setting of the analysis.
    SetSetting(Setting),
}

impl Command {
    /// What the command does in a few words, as shown after "Undo".
    pub fn label(&self) -> String {
        match self {
            Self::SetTitle(_) => "change title".into(),
            Self::SetNotes(_) => "change notes".into(),
            Self::SetReport(_) => "change title page".into(),
            Self::AddSource(spec) => format!("add {}", spec.law.noun()),
            Self::RemoveSource(at) => format!("remove {}", at.law.noun()),
            Self::SetSourceState { source, state } => format!("make {} {}", source.law.noun(), state.word()),
            Self::SetSourceParameters { source, .. } => format!("change {}", source.law.noun()),
            Self::AddCandidates { law, .. } => format!("add {} candidates", law.noun()),
            Self::RemoveCandidates { law, .. } => format!("remove {} candidates", law.noun()),
            Self::SetStructureParameter { name, .. } => format!("change {}", name.replace('_', " ")),
            Self::SetStructureParameters(_) => "change structure".into(),
            Self::SetSupports(_) => "change supports".into(),
            Self::SetLumpedMass { mass: Some(_), .. } => "set lumped mass".into(),
            Self::SetLumpedMass { mass: None, .. } => "remove lumped mass".into(),
            Self::CorrectStructure(_) => "correct structure".into(),
            Self::ImportRuns(files) => counted("import", files.len(), "run"),
            Self::ImportTables(_) => "import measurements".into(),
            Self::RemoveRun(_) => "remove run".into(),
            Self::SetRunUse { enabled: true, .. } => "use run".into(),
            Self::SetRunUse { enabled: false, .. } => "leave out run".into(),
            Self::SetRunFrequency { .. } => "change frequency of run".into(),
            Self::SetRunLevel { .. } => "change level of run".into(),
            Self::SetSensor { channel, .. } => format!("change sensor {channel}"),
            Self::MendChannels(mending) => counted("mend", mending.channels.len(), "channel"),
            Self::RuleOut(at) => format!("rule out {}", at.law.noun()),
            Self::Allow(at) => format!("allow {} again", at.law.noun()),
            Self::SetSetting(_) => "change setting".into(),
        }
    }
}

fn counted(verb: &str, count: usize, noun: &str) -> String {
    if count == 1 { format!("{verb} {noun}") } else { format!("{verb} {count} {noun}s") }
}

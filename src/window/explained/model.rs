//! What a comparison depends on, as a key: two documents with the same model and the same measurements share their results.

use crate::effects::{Kind, Source, State};
use crate::exchange::mapping::ChannelTable;
use crate::exchange::project::file::{BaseTable, HarmonicsTable, RunTable, SensorTable, StructureTable};
use crate::exchange::project::frf::FrfTable;
use crate::session::Document;
use crate::structure::Structure;
use std::sync::Arc;

/// Model and measurements of a document.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    structure: StructureTable,
    runs: Vec<RunTable>,
    responses: Vec<FrfTable>,
    fitted: Vec<HarmonicsTable>,
    channels: Vec<ChannelTable>,
    base: BaseTable,
    sensors: Vec<SensorTable>,
    harmonics: usize,
    /// Sources that act in the model.
    pub known: Vec<Source>,
}

/// A model shared by everything that was computed from it.
#[derive(Debug, Clone)]
pub struct Key(pub Arc<Model>);

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

/// What a search depends on: the model, and what it is not to suggest.
#[derive(Debug, Clone)]
pub(crate) struct Search {
    /// Model and measurements.
    pub model: Key,
    ruled_out: Arc<Vec<Source>>,
}

impl PartialEq for Search {
    fn eq(&self, other: &Self) -> bool {
        let among = |list: &[Source], source: &Source| list.iter().any(|s| s.is_same(source));
        self.model == other.model
            && self.ruled_out.len() == other.ruled_out.len()
            && self.ruled_out.iter().all(|source| among(&other.ruled_out, source))
    }
}

impl Search {
    /// The search on the model of `model` for what `document` has not ruled out.
    pub(crate) fn new(model: Key, document: &Document) -> Self {
        Self { model, ruled_out: Arc::clone(document.ruled_out()) }
    }

    /// What it is not to suggest.
    pub(crate) fn ruled_out(&self) -> &[Source] {
        &self.ruled_out
    }
}

impl Key {
    /// The key of a document.
    pub fn new(document: &Document) -> Self {
        let file = document.file();
        let acts = |s: &&Source| s.state == State::Known && !matches!(s.effect.kind(), Kind::Channel(_));
        Self(Arc::new(Model {
            structure: file.structure.clone(),
            runs: file.run.clone(),
            responses: file.frf.clone(),
            fitted: file.harmonics.clone(),
            channels: file.channel.clone(),
            base: file.base,
            sensors: file.sensor.clone(),
            harmonics: file.analysis.harmonics,
            known: document.sources().iter().filter(acts).cloned().collect(),
        }))
    }
}

/// Channels that are read otherwise than before, in words. Where no mapping is written channels are read as they are.
fn remapped(before: &[ChannelTable], now: &[ChannelTable]) -> Vec<String> {
    let plain = |t: &ChannelTable| t.sign.is_none() && t.factor.is_none() && t.delay.is_none() && t.channel() == t.name;
    let known = |t: &&ChannelTable| if before.is_empty() { plain(t) } else { before.contains(t) };
    now.iter().filter(|t| !known(t)).map(|t| format!("{} read anew", t.channel())).collect()
}

/// Tables of the measurements but the mapping of their channels, and the number of harmonics.
type Measured<'a> = (&'a [RunTable], &'a [FrfTable], &'a [HarmonicsTable], BaseTable, usize);

impl Model {
    fn measured(&self) -> Measured<'_> {
        (&self.runs, &self.responses, &self.fitted, self.base, self.harmonics)
    }

    /// What was changed on the way from `before` to this, in a few words.
    pub fn change(&self, before: &Self, structure: &Structure) -> String {
        let same_laws = self.known.len() == before.known.len()
            && self.known.iter().zip(&before.known).all(|(now, then)| now.is_same(then));
        if self.structure != before.structure && self.known != before.known && same_laws {
            return "model corrected".to_owned();
        }
        let mut said: Vec<String> = Vec::new();
        let name = |s: &Source| s.phrase(structure);
        let twin = |list: &[Source], s: &Source| list.iter().find(|other| other.is_same(s)).cloned();
        // What came and went first: where there is much to say, the rest is only counted.
        let new = self.known.iter().filter(|s| twin(&before.known, s).is_none());
        said.extend(new.map(|s| format!("+ {}", name(s))));
        let gone = before.known.iter().filter(|s| twin(&self.known, s).is_none());
        said.extend(gone.map(|s| format!("− {}", name(s))));
        let changed = |s: &&Source| twin(&before.known, s).is_some_and(|old| old.parameters != s.parameters);
        said.extend(self.known.iter().filter(changed).map(|s| format!("{} changed", name(s))));
        for sensor in &self.sensors {
            if !before.sensors.contains(sensor) {
                said.push(format!("{} corrected", sensor.channel));
            }
        }
        let lost = |s: &&SensorTable| !self.sensors.iter().any(|other| other.channel == s.channel);
        said.extend(before.sensors.iter().filter(lost).map(|s| format!("{} not corrected", s.channel)));
        if self.structure != before.structure {
            said.push("structure changed".to_owned());
        }
        said.extend(remapped(&before.channels, &self.channels));
        if self.measured() != before.measured() {
            said.push("measurements changed".to_owned());
        }
        match said.len() {
            0 => "the same model".to_owned(),
            1..=2 => said.join(", "),
            many => format!("{} and {} more changes", said[0], many - 1),
        }
    }
}

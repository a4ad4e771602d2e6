//! Tables of measurements on their own: what an import adds to a project that is there.

use super::error::ProjectError;
use super::file::{HarmonicsTable, Lines, ModesTable, ProjectFile, RunTable};
use super::frf::{self, FrfTable};
use super::reader::{Origin, Table};
use super::{channel, modes, runs};
use crate::exchange::mapping::ChannelTable;
use serde::Deserialize;

/// Measurements and how they are read.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
pub struct MeasurementTables {
    /// Tables `[[channel]]`.
    pub channel: Vec<ChannelTable>,
    /// Tables `[[run]]`.
    pub run: Vec<RunTable>,
    /// Tables `[[harmonics]]`.
    pub harmonics: Vec<HarmonicsTable>,
    /// Tables `[[frf]]`.
    pub frf: Vec<FrfTable>,
    /// Tables `[[modes]]`.
    pub modes: Vec<ModesTable>,
}

impl MeasurementTables {
    /// Reads the tables of a text that is called `file` in messages.
    ///
    /// # Errors
    /// [`ProjectError`] with the line of the first thing that is wrong.
    pub fn parse(text: &str, file: &str) -> Result<Self, ProjectError> {
        let origin = Origin { file, text };
        let document = origin.document()?;
        let root = Table::root(origin, document.get_ref());
        root.only_in::<Self>(&[])?;
        let mut lines = Lines::default();
        Ok(Self {
            channel: channel::parse(&root, &mut lines)?,
            run: runs::runs(&root, &mut lines)?,
            harmonics: runs::harmonics(&root, &mut lines)?,
            frf: frf::parse(&root, &mut lines)?,
            modes: modes::parse(&root, &mut lines)?,
        })
    }
}

impl ProjectFile {
    /// Adds measurements. A channel that the project reads already is read as the new table says.
    ///
    /// # Errors
    /// The name of the first file that is in the project already (of a run: with the same set and the same part).
    pub fn add_measurements(&mut self, tables: MeasurementTables) -> Result<(), String> {
        let key = |run: &RunTable| (run.file.clone(), run.set.clone(), run.sets.clone(), run.start_s.map(f64::to_bits));
        for run in &tables.run {
            if self.run.iter().any(|other| key(other) == key(run)) {
                return Err(run.file.clone());
            }
        }
        let files = tables.frf.iter().map(|table| &table.file).chain(tables.harmonics.iter().map(|table| &table.file));
        for file in files {
            let known = self.frf.iter().map(|table| &table.file).chain(self.harmonics.iter().map(|table| &table.file));
            if known.into_iter().any(|other| other == file) {
                return Err(file.clone());
            }
        }
        for table in tables.channel {
            self.channel.retain(|other| (&other.name, &other.set) != (&table.name, &table.set));
            self.channel.push(table);
        }
        self.run.extend(tables.run);
        self.harmonics.extend(tables.harmonics);
        self.frf.extend(tables.frf);
        // Reference data may come again with further measurements.
        self.modes.retain(|known| tables.modes.iter().all(|table| table.file != known.file));
        self.modes.extend(tables.modes);
        Ok(())
    }
}

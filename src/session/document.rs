//! The saved, undoable project, always valid: a change that would break it is refused with its reason.

use super::refusal::Refusal;
use super::save::SaveError;
use crate::classical::reference_shapes::ReferenceShape;
use crate::effects::Source;
use crate::exchange::project::lines::At;
use crate::exchange::project::reference_shapes::reference_shapes;
use crate::exchange::project::sources::sources;
use crate::exchange::project::structure::structure;
use crate::exchange::project::{Lines, Plan, ProjectError, ProjectFile};
use crate::structure::Structure;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Counts the changes of each part of a document, so that a result knows what it was computed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub struct Revisions {
    /// Any part.
    pub any: u64,
    /// Structure.
    pub structure: u64,
    /// Runs, sensors and how records are fitted.
    pub measurements: u64,
    /// Sources and families.
    pub sources: u64,
    /// Effects that are ruled out.
    pub ruled_out: u64,
    /// Settings.
    pub settings: u64,
}

impl Revisions {
    /// Counts what differs between two states of a document.
    pub fn advance(&mut self, old: &ProjectFile, new: &ProjectFile) {
        let step = |differs: bool, count: &mut u64| *count += u64::from(differs);
        step(old != new, &mut self.any);
        step(old.structure != new.structure, &mut self.structure);
        let fitted = |f: &ProjectFile| f.analysis.harmonics;
        let mapped = old.channel != new.channel || old.base != new.base;
        let measured = mapped
            || old.run != new.run
            || old.harmonics != new.harmonics
            || old.frf != new.frf
            || old.modes != new.modes
            || old.sensor != new.sensor;
        step(measured || fitted(old) != fitted(new), &mut self.measurements);
        step(old.source != new.source || old.candidates != new.candidates, &mut self.sources);
        step(old.ruled_out != new.ruled_out, &mut self.ruled_out);
        step(old.analysis != new.analysis, &mut self.settings);
    }
}

/// A project file with what follows from it at once: its structure and its sources. Cloning shares everything.
#[derive(Debug, Clone)]
pub struct Document {
    file: Arc<ProjectFile>,
    structure: Arc<Structure>,
    sources: Arc<Vec<Source>>,
    ruled_out: Arc<Vec<Source>>,
    reference_shapes: Arc<Vec<ReferenceShape>>,
    folder: PathBuf,
}

impl PartialEq for Document {
    /// Two documents are equal if their files are.
    fn eq(&self, other: &Self) -> bool {
        self.file == other.file
    }
}

impl Document {
    /// Checks the file and builds what follows from it; `folder` is where the project's files are.
    pub fn new(file: ProjectFile, folder: &Path) -> Result<Self, Refusal> {
        let structure = structure(&file.structure, folder, &[], At::NOWHERE)?;
        let shapes = reference_shapes(&file, &structure, folder, At::NOWHERE)?;
        Self::on(Arc::new(structure), Arc::new(shapes), file, folder)
    }

    /// The document with another file; the structure is rebuilt only if it changed.
    pub fn with(&self, file: ProjectFile) -> Result<Self, Refusal> {
        if file.structure != self.file.structure {
            return Self::new(file, &self.folder);
        }
        let shapes = if file.modes == self.file.modes && file.frf == self.file.frf {
            self.reference_shapes.clone()
        } else {
            Arc::new(reference_shapes(&file, &self.structure, &self.folder, At::NOWHERE)?)
        };
        Self::on(self.structure.clone(), shapes, file, &self.folder)
    }

    fn on(
        structure: Arc<Structure>,
        reference_shapes: Arc<Vec<ReferenceShape>>,
        mut file: ProjectFile,
        folder: &Path,
    ) -> Result<Self, Refusal> {
        let sources = Arc::new(sources(&file, &structure, At::NOWHERE)?);
        // What was said of a place goes with the place.
        file.ruled_out.retain(|table| table.source(&structure).is_ok());
        let ruled_out = file.ruled_out.iter().filter_map(|table| table.source(&structure).ok()).collect();
        let (file, ruled_out, folder) = (Arc::new(file), Arc::new(ruled_out), folder.to_owned());
        Ok(Self { file, structure, sources, ruled_out, reference_shapes, folder })
    }

    /// What the loader of projects plans for the file as it is now, on the structure that is built; `path` is what messages call it.
    ///
    /// # Errors
    /// [`ProjectError`] for what does not hold of its runs and sensors.
    pub(crate) fn plan(&self, path: &Path) -> Result<Plan, ProjectError> {
        Plan::new(ProjectFile::clone(&self.file), Structure::clone(&self.structure), Lines::default(), path)
    }

    /// The project file as data.
    pub fn file(&self) -> &Arc<ProjectFile> {
        &self.file
    }

    /// The project file as it is written into `folder`: its records and matrices named from there.
    ///
    /// # Errors
    /// [`SaveError::Disk`] where the folder does not exist.
    pub fn file_in(&self, folder: &Path) -> Result<ProjectFile, SaveError> {
        self.file.relocated(&self.folder, folder).map_err(|error| SaveError::Disk {
            action: "save the project",
            reason: error.to_string(),
            path: folder.into(),
        })
    }

    /// The structure with its lumped masses.
    pub fn structure(&self) -> &Arc<Structure> {
        &self.structure
    }

    /// Sources: those drawn one by one, then the members of the families.
    pub fn sources(&self) -> &Arc<Vec<Source>> {
        &self.sources
    }

    /// Effects at places that the user has ruled out; their parameters mean nothing.
    pub fn ruled_out(&self) -> &Arc<Vec<Source>> {
        &self.ruled_out
    }

    /// Modes and operating shapes of other programs.
    pub fn reference_shapes(&self) -> &Arc<Vec<ReferenceShape>> {
        &self.reference_shapes
    }

    /// Folder of the project, to which its files are relative.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

impl From<Plan> for Document {
    fn from(plan: Plan) -> Self {
        Self {
            folder: plan.path.parent().unwrap_or(Path::new("")).to_owned(),
            file: Arc::new(plan.file),
            structure: Arc::new(plan.structure),
            sources: Arc::new(plan.sources),
            ruled_out: Arc::new(plan.ruled_out),
            reference_shapes: Arc::new(plan.reference_shapes),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    const TWICE: &str = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1.0]\nground_stiffness = [1.0]\n\
        coupling_stiffness = []\n[[sensor]]\nchannel = \"acc@1\"\ngain = 1.1\n[[sensor]]\nchannel = \"acc@1\"\ngain = 1.2\n";

    /// A project that was changed since it was read is in no text: there are no lines that a message could name.
    #[test]
    fn what_is_wrong_with_a_changed_project_is_said_without_lines() {
        let (file, lines) = ProjectFile::parse(TWICE, "p.toml").unwrap();
        let document = Document::new(file, Path::new("")).unwrap();
        let said = document.plan(Path::new("p.toml")).unwrap_err().to_string();
        assert_eq!(said, "p.toml: the gain of \"acc@1\" is given twice; leave one out");
        let (file, structure) = (ProjectFile::clone(document.file()), Structure::clone(document.structure()));
        let said = Plan::new(file, structure, lines, Path::new("p.toml")).unwrap_err().to_string();
        assert_eq!(said, "p.toml:11: the gain of \"acc@1\" is given twice, first in line 8; leave one out");
    }
}

//! The files that a project is made of.

use super::file::{ProjectFile, Shape};

impl ProjectFile {
    /// All files that the project names as its data, as they are written there, each once: matrices, records, harmonics,
    /// frequency responses, modes.
    pub fn named_files(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        if let Shape::Matrices(table) = &self.structure.shape {
            names.extend([table.mass.as_str(), &table.stiffness]);
            names.extend([&table.nodes, &table.dofs, &table.lines].into_iter().flatten().map(String::as_str));
        }
        names.extend(self.run.iter().map(|run| run.file.as_str()));
        names.extend(self.harmonics.iter().map(|table| table.file.as_str()));
        for table in &self.frf {
            names.push(&table.file);
            names.extend(table.further_files.iter().map(String::as_str));
        }
        names.extend(self.modes.iter().map(|table| table.file.as_str()));
        let mut seen = std::collections::HashSet::new();
        names.retain(|name| seen.insert(*name));
        names
    }
}

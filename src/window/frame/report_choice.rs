//! What a report is to be, as it is chosen in the window.

use crate::exchange::project::file::{ProjectFile, ReportTable};
use crate::report::{SEARCH_S, Section};
use std::path::PathBuf;

/// What was decided.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportRequest {
    /// What stands on the title page.
    pub heading: ReportTable,
    /// Sections; none for all.
    pub sections: Vec<Section>,
    /// Time of the search, s.
    pub limit_s: f64,
    /// Whether the tables are written beside the report.
    pub tables: bool,
}

/// The dialog that asks for it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportChoice {
    /// Title; empty for that of the project.
    pub title: String,
    /// What was tested.
    pub object: String,
    /// Who tested it.
    pub tester: String,
    /// For whom.
    pub organisation: String,
    /// PNG picture, relative to the project.
    pub logo: String,
    /// The sections, and whether each is part of it.
    pub sections: [(Section, bool); Section::ALL.len()],
    /// Time of the search, s.
    pub limit_s: f64,
    /// Whether the tables are written beside the report.
    pub tables: bool,
}

impl ReportChoice {
    /// All sections, with what the project says of its title page.
    pub fn of(file: &ProjectFile) -> Self {
        let said = |text: &Option<String>| text.clone().unwrap_or_default();
        let table = &file.report;
        Self {
            title: said(&table.title),
            object: said(&table.object),
            tester: said(&table.tester),
            organisation: said(&table.organisation),
            logo: said(&table.logo),
            sections: Section::ALL.map(|section| (section, true)),
            limit_s: SEARCH_S,
            tables: true,
        }
    }

    /// Takes a file as the logo.
    pub fn take_logo(&mut self, path: PathBuf) {
        self.logo = path.display().to_string();
    }

    /// What is decided.
    pub fn request(&self) -> ReportRequest {
        let said = |text: &String| Some(text.trim().to_owned()).filter(|t| !t.is_empty());
        let all = self.sections.iter().all(|(_, wanted)| *wanted);
        let chosen = self.sections.iter().filter(|(_, wanted)| *wanted && !all);
        ReportRequest {
            heading: ReportTable {
                title: said(&self.title),
                object: said(&self.object),
                tester: said(&self.tester),
                organisation: said(&self.organisation),
                logo: said(&self.logo),
            },
            sections: chosen.map(|(section, _)| *section).collect(),
            limit_s: self.limit_s,
            tables: self.tables,
        }
    }
}

//! How a report is to be: title page, chosen sections, time of the search, tables beside it.

use super::section::Section;
use crate::exchange::project::file::{ProjectFile, ReportTable};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Seconds after which the search of a report answers with the best so far, unless asked otherwise.
pub const SEARCH_S: f64 = 30.0;

/// Where a project came from.
#[derive(Debug, Clone)]
pub struct Origin {
    /// The project file; `None` where it was never saved.
    pub path: Option<PathBuf>,
    /// Folder to which its files are relative.
    pub folder: PathBuf,
    /// The project file as data.
    pub file: Arc<ProjectFile>,
}

/// Where the tables of a report are written as CSV.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Tables {
    /// Beside the report, `NAME-tables.zip`.
    #[default]
    Beside,
    /// In this ZIP file.
    In(PathBuf),
    /// Nowhere.
    None,
}

impl Tables {
    /// The ZIP file of a report at `out`.
    pub fn path(&self, out: &Path) -> Option<PathBuf> {
        match self {
            Self::Beside => {
                let stem = out.file_stem().unwrap_or_default().to_string_lossy();
                Some(out.with_file_name(format!("{stem}-tables.zip")))
            }
            Self::In(path) => Some(path.clone()),
            Self::None => None,
        }
    }
}

/// How a report is to be.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// What stands on the title page instead of what the project says.
    pub heading: ReportTable,
    /// Sections; none for all.
    pub sections: Vec<Section>,
    /// Time after which the search answers with the best so far; none for as long as it takes.
    pub limit: Option<Duration>,
    /// Tables and values of figures as CSV.
    pub tables: Tables,
    /// Where the project came from.
    pub origin: Option<Origin>,
    /// When it is made, seconds since the beginning of 1970 (UTC); none for a report without a date.
    pub made_s: Option<f64>,
}

impl Request {
    /// Whether a section is part of the report.
    pub fn holds(&self, section: Section) -> bool {
        self.sections.is_empty() || self.sections.contains(&section)
    }

    /// Whether the report needs the search for what the model lacks.
    pub(super) fn needs_search(&self) -> bool {
        Section::ALL.into_iter().any(|section| section.needs_search() && self.holds(section))
    }

    /// What stands on the title page: as asked for, else as the project says. The path of the logo leads from here.
    pub(super) fn title_page(&self) -> ReportTable {
        let own = self.origin.as_ref().map(|origin| {
            let logo = origin.file.report.logo.as_ref();
            let logo = logo.map(|name| origin.folder.join(name).display().to_string());
            ReportTable { logo, ..origin.file.report.clone() }
        });
        let (asked, own) = (self.heading.clone(), own.unwrap_or_default());
        // An empty text is as good as none.
        let said = |text: Option<String>| text.filter(|t| !t.trim().is_empty());
        ReportTable {
            title: said(asked.title).or(said(own.title)),
            object: said(asked.object).or(said(own.object)),
            tester: said(asked.tester).or(said(own.tester)),
            organisation: said(asked.organisation).or(said(own.organisation)),
            logo: said(asked.logo).or(said(own.logo)),
        }
    }
}

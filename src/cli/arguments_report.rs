//! Arguments of `dashpot report`.

use super::argument_values::seconds;
use crate::report::{SEARCH_S, Section};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Report {
    /// Project file
    pub file: PathBuf,
    /// File to write: .html, or .pdf
    #[arg(long)]
    pub out: PathBuf,
    /// Sections, separated by commas; all unless given: structure, measurements, energy, ratios, responses, comparison, missing,
    /// next-test, ledger, methods, settings
    #[arg(long, value_delimiter = ',', value_parser = Section::parse)]
    pub sections: Vec<Section>,
    /// Seconds after which the search for what is missing answers with the best so far
    #[arg(long, value_name = "SECONDS", default_value_t = SEARCH_S, value_parser = seconds)]
    pub limit: f64,
    /// Title; as the project says unless given, like all that follows ([report] in the project)
    #[arg(long)]
    pub title: Option<String>,
    /// What was tested: name, drawing number, serial number
    #[arg(long)]
    pub object: Option<String>,
    /// Who tested it
    #[arg(long)]
    pub tester: Option<String>,
    /// For whom
    #[arg(long)]
    pub organisation: Option<String>,
    /// PNG picture on the title page
    #[arg(long, value_name = "FILE")]
    pub logo: Option<PathBuf>,
    /// ZIP file of all tables and the values of all figures as CSV; beside the report, NAME-tables.zip, unless given
    #[arg(long, value_name = "FILE")]
    pub tables: Option<PathBuf>,
    /// Write no tables beside the report
    #[arg(long, conflicts_with = "tables")]
    pub no_tables: bool,
}

#[cfg(test)]
mod tests {
    use super::{Report, Section};
    use clap::{Args as _, Command};

    #[test]
    fn the_help_names_all_sections() {
        let help = Report::augment_args(Command::new("report")).render_long_help().to_string();
        let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
        let names = Section::ALL.map(Section::name).join(", ");
        assert!(words.contains(&names), "{names}");
    }
}

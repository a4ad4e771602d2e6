//! The chapters of a report, by the names under which they are chosen.

/// A chapter of a report. Which of them there are depends on what the project holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// Structure with its natural frequencies and known sources.
    Structure,
    /// Runs and records with their flags.
    Measurements,
    /// What was identified: energies, coefficients, damping matrix.
    Energy,
    /// Damping ratios.
    Ratios,
    /// Frequency responses.
    Responses,
    /// Model against measurement.
    Comparison,
    /// What the model lacks.
    Missing,
    /// The test worth doing next.
    NextTest,
    /// The models that were looked at.
    Ledger,
    /// Methods and their sources.
    Methods,
    /// Settings, version and files: what is needed to compute the same again.
    Settings,
}

impl Section {
    /// All, in their order.
    pub const ALL: [Self; 11] = [
        Self::Structure,
        Self::Measurements,
        Self::Energy,
        Self::Ratios,
        Self::Responses,
        Self::Comparison,
        Self::Missing,
        Self::NextTest,
        Self::Ledger,
        Self::Methods,
        Self::Settings,
    ];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Structure => "structure",
            Self::Measurements => "measurements",
            Self::Energy => "energy",
            Self::Ratios => "ratios",
            Self::Responses => "responses",
            Self::Comparison => "comparison",
            Self::Missing => "missing",
            Self::NextTest => "next-test",
            Self::Ledger => "ledger",
            Self::Methods => "methods",
            Self::Settings => "settings",
        }
    }

    /// In words, for a list to choose from.
    pub fn words(self) -> &'static str {
        match self {
            Self::Structure => "Structure",
            Self::Measurements => "Measurements",
            Self::Energy => "Where the energy is lost",
            Self::Ratios => "Damping ratios",
            Self::Responses => "Frequency responses",
            Self::Comparison => "Model against the measurement",
            Self::Missing => "What is missing?",
            Self::NextTest => "Next test",
            Self::Ledger => "Ledger",
            Self::Methods => "Methods and references",
            Self::Settings => "Settings",
        }
    }

    /// Whether it needs the search for what the model lacks.
    pub(super) fn needs_search(self) -> bool {
        matches!(self, Self::Missing | Self::NextTest | Self::Ledger)
    }

    /// A name on the command line.
    ///
    /// # Errors
    /// One line with all names.
    pub fn parse(name: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|section| section.name() == name.trim());
        found.ok_or_else(|| format!("there is no section `{}`; there are {names}", name.trim()))
    }
}

//! What is asked: columns, known sources, runs in use.

use super::error::IdentifyError;
use super::measurements::Measurements;
use super::ratios::Ratios;
use super::settings::Settings;
use super::window_columns::WindowColumns;
use crate::balance::expansion::modal_model::ModalModel;
use crate::balance::{Expander, Expansion, Measured, Weights};
use crate::control::Control;
use crate::effects::{Source, State as SourceState};
use crate::measurement::{Flag, Run};
use crate::structure::Structure;

/// The question in the form in which the solver takes it.
pub(crate) struct Problem<'a> {
    pub structure: &'a Structure,
    pub sources: &'a [Source],
    pub settings: &'a Settings,
    /// Sources that may be selected, at unit coefficient.
    pub columns: Vec<Source>,
    /// Index of each column in `sources`.
    pub column_source: Vec<usize>,
    /// Columns that are in every set.
    pub forced: Vec<usize>,
    /// Sources in the model at their values.
    pub known: Vec<Source>,
    /// Index of each known source in `sources`.
    pub known_source: Vec<usize>,
    pub measured: Vec<Measured>,
    /// Index of each run in use in `runs`.
    pub run_index: Vec<usize>,
    pub expander: Expander<'a>,
    /// Damping ratios beside the runs.
    pub ratios: Option<Ratios>,
    /// Windows of records that are not steady.
    pub windows: WindowColumns,
    pub warnings: Vec<String>,
    pub control: Control,
}

impl<'a> Problem<'a> {
    /// Sorts sources and runs.
    pub(super) fn new(
        structure: &'a Structure,
        sources: &'a [Source],
        given: Measurements<'_>,
        settings: &'a Settings,
        control: &Control,
    ) -> Result<Self, IdentifyError> {
        let (mut warnings, runs) = (Vec::new(), given.runs);
        let run_index = runs_in_use(runs, &mut warnings);
        if run_index.is_empty() && given.transient_runs.iter().all(|run| !run.enabled) {
            return Err(IdentifyError::NoRuns);
        }
        let per_unit_force = run_index.iter().any(|&r| runs[r].per_unit_force);
        let measured: Result<Vec<Measured>, _> = run_index.iter().map(|&r| Measured::new(&runs[r])).collect();
        let mut measured = measured?;
        // Without steady runs there is no harmonic to expand.
        let expansion = if measured.is_empty() { Expansion::None } else { settings.expansion };
        let expander = Expander::new(structure, expansion, &measured)?;
        if let Some(truncation) = expander.model().map(ModalModel::truncation).filter(|part| *part > 0.0) {
            measured.iter_mut().for_each(|run| run.limit_range(truncation, structure));
        }
        let mut problem = Self {
            structure,
            sources,
            settings,
            columns: Vec::new(),
            column_source: Vec::new(),
            forced: Vec::new(),
            known: Vec::new(),
            known_source: Vec::new(),
            measured,
            run_index,
            expander,
            ratios: None,
            windows: WindowColumns::default(),
            warnings,
            control: control.clone(),
        };
        problem.sort_sources(per_unit_force)?;
        problem.ratios = Ratios::new(structure, [&problem.known, &problem.columns], given.ratios)?;
        let (known, columns) = (&problem.known, &problem.columns);
        problem.windows = WindowColumns::new(structure, known, columns, given.transient_runs, control)?;
        problem.check_counts()?;
        Ok(problem)
    }

    /// Sorts the sources; laws that depend on the amplitude are left out where the runs have none.
    fn sort_sources(&mut self, per_unit_force: bool) -> Result<(), IdentifyError> {
        let mut left_out: Vec<&str> = Vec::new();
        for (index, source) in self.sources.iter().enumerate() {
            let acts = matches!(source.state, SourceState::Known | SourceState::Candidate | SourceState::Forced);
            if !(per_unit_force && !source.effect.is_linear() && acts) {
                self.sort_source(index, source)?;
                continue;
            }
            if source.state == SourceState::Forced {
                let why = "it depends on the amplitude, which frequency responses do not have";
                return Err(self.impossible(source, why));
            }
            left_out.push(source.effect.name());
        }
        self.warn_of_amplitude(left_out);
        if self.columns.is_empty() { Err(IdentifyError::NoCandidates) } else { Ok(()) }
    }

    fn warn_of_amplitude(&mut self, mut left_out: Vec<&str>) {
        left_out.sort_unstable();
        left_out.dedup();
        if !left_out.is_empty() {
            self.warnings.push(format!(
                "{}: left out, for frequency responses are per unit force and cannot tell laws that depend on the \
                 amplitude; measure runs at known forces for them",
                left_out.join(", ")
            ));
        }
    }

    /// Takes one source among the known ones or the columns, by its state.
    fn sort_source(&mut self, index: usize, source: &Source) -> Result<(), IdentifyError> {
        let identifiable = source.effect.dissipates() && source.effect.coefficient().is_some();
        match source.state {
            SourceState::Known => {
                self.known.push(source.clone());
                self.known_source.push(index);
            }
            SourceState::Forced if !identifiable => {
                return Err(self.impossible(source, "it takes out no energy in proportion to a coefficient"));
            }
            SourceState::Candidate | SourceState::Forced if identifiable => {
                if source.state == SourceState::Forced {
                    self.forced.push(self.columns.len());
                }
                self.columns.push(source.with_coefficient(1.0));
                self.column_source.push(index);
            }
            _ => {}
        }
        Ok(())
    }

    fn impossible(&self, source: &Source, reason: &str) -> IdentifyError {
        IdentifyError::ForcedImpossible { source_name: source.phrase(self.structure), reason: reason.to_owned() }
    }

    fn check_counts(&self) -> Result<(), IdentifyError> {
        let (forced, runs, max_sources) = (self.forced.len(), self.equations(), self.settings.max_sources);
        if forced > runs {
            return Err(IdentifyError::TooManyForced { forced, runs });
        }
        if forced > max_sources || max_sources == 0 {
            return Err(IdentifyError::MaxSources { max_sources, forced });
        }
        Ok(())
    }

    /// Energies and damping ratios.
    pub(super) fn equations(&self) -> usize {
        self.measured.len() + self.windows.len() + self.ratios.as_ref().map_or(0, Ratios::len)
    }

    /// Whether deviations are known from the data in every run.
    pub(super) fn is_noisy(&self) -> bool {
        self.measured.iter().all(|m| m.noisy)
    }

    /// Whether the rows' weights change with the coefficients.
    pub(super) fn weights_follow_coefficients(&self) -> bool {
        match self.settings.weights {
            Weights::Noise => true,
            Weights::Auto => self.is_noisy(),
            Weights::None | Weights::Energy => false,
        }
    }

    /// Known sources and the columns with positive coefficients, at their values.
    pub(super) fn acting(&self, coefficients: &[f64]) -> Vec<Source> {
        let identified = self.columns.iter().zip(coefficients).filter(|(_, c)| **c > 0.0);
        self.known.iter().cloned().chain(identified.map(|(source, &c)| source.with_coefficient(c))).collect()
    }
}

/// Enabled runs of a steady motion, or insisted on; if there is none, all enabled ones.
fn runs_in_use(runs: &[Run], warnings: &mut Vec<String>) -> Vec<usize> {
    let enabled: Vec<usize> = (0..runs.len()).filter(|&r| runs[r].enabled).collect();
    let used: Vec<usize> = enabled.iter().copied().filter(|&r| runs[r].is_used()).collect();
    if used.is_empty() && !enabled.is_empty() {
        warnings.push("no run has settled, so the energy balance may not hold; record longer".to_string());
        return enabled;
    }
    for &r in enabled.iter().filter(|r| !used.contains(r)) {
        let why = match runs[r].why_not_steady().map(|finding| finding.flag) {
            Some(Flag::NotPeriodic) => "not periodic",
            Some(Flag::DeadChannel) => "its force is zero",
            _ => "not settled",
        };
        warnings.push(format!("{}: {why}, so it is left out", runs[r].file));
    }
    used
}

//! Arguments of `dashpot import`.

use super::argument_values::positive;
use crate::exchange::frf::Form;
use clap::Args;
use clap::builder::PossibleValuesParser;
use dashpot_datafiles::Pairing;
use std::path::PathBuf;

#[derive(Debug, Clone, Args)]
pub(super) struct Import {
    /// Measurement files of one layout, one a run
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Template, or project, whose [[channel]] tables (of frequency responses: whose first [[frf]]) say what the channels are;
    /// proposed from the first file unless given. A project with a model keeps it: all but its measurements
    #[arg(long)]
    pub map: Option<PathBuf>,
    /// Project to write; the name of the first file in this folder unless given
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print the mapping as a template, or the project where there is none, and write nothing
    #[arg(long)]
    pub propose: bool,
    /// Sampling rate in Hz of files that do not say it
    #[arg(long, value_parser = positive)]
    pub sampling_hz: Option<f64>,
    /// Mass matrix of a finite-element model, or a file with mass and stiffness; without it the structure is its points
    #[arg(long)]
    pub mass: Option<PathBuf>,
    /// Stiffness matrix of the model, where it is not in the file of the mass
    #[arg(long, requires = "mass")]
    pub stiffness: Option<PathBuf>,
    /// Model file or table with the nodes of the model, where the matrices have none
    #[arg(long, requires = "mass")]
    pub nodes: Option<PathBuf>,
    /// Form of frequency responses whose unit the file does not say (then SI), such as accelerance
    #[arg(long, value_parser = PossibleValuesParser::new(Form::WORDS))]
    pub form: Option<String>,
    /// Step in Hz, from 0 Hz on, of frequency responses whose frequencies the file does not say
    #[arg(long, value_parser = positive)]
    pub step_hz: Option<f64>,
    /// Columns two by two as parts of frequency responses, where their names do not say it
    #[arg(long, value_parser = PossibleValuesParser::new(Pairing::WORDS))]
    pub columns: Option<String>,
    /// Factor from the numbers of frequency responses to SI (with --form), or on top of their units; negative reverses
    #[arg(long, allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// Averages of frequency responses
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub averages: Option<u32>,
    /// DOFs of the columns of an array of frequency responses, such as 1z,2z,3z; all responses to the first reference first
    #[arg(long, value_delimiter = ',', requires = "references")]
    pub responses: Vec<String>,
    /// DOFs that were driven, in the order of the columns of an array of frequency responses
    #[arg(long, value_delimiter = ',')]
    pub references: Vec<String>,
}

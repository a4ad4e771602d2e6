//! What can be asked on the command line.

use super::argument_values::{format, fraction, harmonics, noise, paper, positive, seconds};
use super::arguments_import::Import;
use super::arguments_report::Report;
use super::screen::{Picture, Window};
use crate::exchange::export::Format;
use crate::response::frequency_response::ResponseForm;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// What the window adds.
#[cfg(feature = "window")]
const WINDOW: &str = "`dashpot` alone or with a file opens the window: the same as `dashpot window [FILE]`.";

/// Tells where a structure loses its energy, how much and by which mechanism.
#[derive(Debug, Parser)]
#[command(name = "dashpot", version, arg_required_else_help = true)]
#[cfg_attr(feature = "window", command(after_help = WINDOW))]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Identify the sources of damping: matrix, energy shares, damping ratios
    Identify(Identify),
    /// Write identified matrices and sources for another program
    Export(Export),
    /// Compare the model with the measurement: error per run, channel and harmonic
    Compare(Analysis),
    /// Say what changed between two states: each source and mode with its deviations
    Change(ChangeStates),
    /// Name the effect that the model lacks, ranked, with evidence
    Diagnose(Diagnose),
    /// Frequency and damping ratio against amplitude, of decays and of what follows a hammer
    Amplitude(Analysis),
    /// Make records of the model of a project: steady states, decays, hammers, sweeps, noise, loops of a component
    Simulate(Simulate),
    /// Apply the classical methods side by side to the same runs
    Methods(Methods),
    /// Rewrite a measurement file of any format: as CSV in SI units, or as fitted harmonics
    Convert(Convert),
    /// List what is in measurement files of any format: sets, channels, units, steps, first values
    Contents(Contents),
    /// Make a project of measurement files where they lie, by a mapping of their channels
    Import(Import),
    /// Write a structure of a known kind as matrices with nodes, DOFs and lines
    Build(Build),
    /// Write all results with their plots into one HTML or PDF file
    Report(Report),
    /// Draw one plot as SVG, or write its values as CSV
    Plot(Plot),
    /// Play a script of commands on a project, as the window would do them
    Run(Run),
    /// Open the window on a project, on a file of measurements or on the start screen
    Window(Window),
    /// Draw a stage of the window without a display
    Picture(Picture),
}

#[derive(Debug, Args)]
pub(super) struct Identify {
    /// Project file
    pub file: PathBuf,
    /// Print one JSON document in place of a table
    #[arg(long)]
    pub json: bool,
    /// Damping ratios as further equations: `half-power` or `circle-fit` of the runs themselves, or a CSV file with
    /// columns `frequency_hz,damping_ratio,deviation`
    #[arg(long)]
    pub ratios: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct Analysis {
    /// Project file
    pub file: PathBuf,
    /// Print one JSON document in place of a table
    #[arg(long)]
    pub json: bool,
    /// Take what `identify` finds as known first
    #[arg(long)]
    pub identified: bool,
}

#[derive(Debug, Args)]
pub(super) struct ChangeStates {
    /// Project of the first state
    pub before: PathBuf,
    /// Project of the second state
    pub after: Option<PathBuf>,
    /// Two sessions of the first project in place of a second project
    #[arg(long, value_name = "FIRST,SECOND", value_delimiter = ',', conflicts_with = "after")]
    pub sessions: Vec<String>,
    /// Print one JSON document in place of tables
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(super) struct Methods {
    /// Project file
    pub file: PathBuf,
    /// Print one JSON document in place of a table
    #[arg(long)]
    pub json: bool,
    /// Errors of the methods against the number of modes and sensors measured, in place of the methods on the runs
    #[arg(long)]
    pub incompleteness: bool,
}

#[derive(Debug, Args)]
pub(super) struct Diagnose {
    /// Project file
    pub file: PathBuf,
    /// Print one JSON document in place of a table
    #[arg(long)]
    pub json: bool,
    /// Write the project with the best suggestion added
    #[arg(long)]
    pub apply: Option<PathBuf>,
    /// Take what `identify` finds as known first
    #[arg(long)]
    pub identified: bool,
    /// End the search after so many seconds with the best so far
    #[arg(long, value_name = "N", value_parser = seconds)]
    pub seconds: Option<f64>,
}

#[derive(Debug, Args)]
pub(super) struct Simulate {
    /// Project file with known sources, and a force and a frequency at each run
    pub file: PathBuf,
    /// Folder for the records; made if it is not there
    #[arg(long)]
    pub out: PathBuf,
    /// Standard deviation of white noise over the root mean square of each channel, such as 0.05
    #[arg(long, default_value_t = 0.0, value_parser = noise)]
    pub noise: f64,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Significant digits of the samples; as many as read back the same unless given
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=17))]
    pub digits: Option<u8>,
    /// What is written
    #[arg(long = "as", value_enum, default_value_t = Records::Time)]
    pub records: Records,
    /// How the motion is computed
    #[arg(long, value_enum, default_value_t = Method::Balance)]
    pub by: Method,
    /// Share of the periodic motion missing at the start of each record: 1 is from rest; implies `--by time`
    #[arg(long, default_value_t = 0.0, value_name = "FRACTION", value_parser = fraction)]
    pub transient: f64,
    /// Steps of the time integration a period
    #[arg(long, default_value_t = 4000, value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    pub steps: u32,
}

/// How simulated motions are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Harmonic balance: the periodic motion itself
    Balance,
    /// Time integration until the motion is periodic
    Time,
}

/// Form of simulated measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Records {
    /// A time record a run
    Time,
    /// One file of fitted harmonics, harmonics.csv
    Harmonics,
    /// A hammer test of each [[frf]]: frequency responses with coherence, as a Universal File
    Frf,
}

#[derive(Debug, Args)]
pub(super) struct Convert {
    /// Time record, harmonics or stepped-sine table: a CSV of the project's own form, or a measurement file of any format that
    /// `import` reads, whose channels are mapped as it maps them
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// File to write
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// What is written; the same as is read unless given
    #[arg(long = "as", value_enum)]
    pub records: Option<Records>,
    /// Fundamental frequency in Hz for harmonics; estimated from the record unless given
    #[arg(long, value_parser = positive)]
    pub frequency: Option<f64>,
    /// Harmonics that are fitted
    #[arg(long, default_value_t = 7, value_parser = harmonics)]
    pub harmonics: usize,
    /// Significant digits of the samples; as many as read back the same unless given
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=17))]
    pub digits: Option<u8>,
    /// Template, or project, whose [[channel]] tables say what the channels are; proposed from the file unless given
    #[arg(long)]
    pub map: Option<PathBuf>,
    /// Set of the run, of a file that holds several
    #[arg(long)]
    pub set: Option<String>,
    /// Sampling rate in Hz of a file that does not say it
    #[arg(long, value_parser = positive)]
    pub sampling_hz: Option<f64>,
}

#[derive(Debug, Args)]
pub(super) struct Contents {
    /// Measurement files, or folders of them
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print one JSON document in place of a tree
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(super) struct Build {
    /// Structure
    #[arg(value_enum)]
    pub kind: Buildable,
    /// Folder for the files; made if it is not there
    #[arg(long)]
    pub out: PathBuf,
}

/// Structures that `build` knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Buildable {
    /// The heavy Goland wing: a box of rods, shear panels and membranes with 180 DOFs
    Wing,
}

#[derive(Debug, Args)]
pub(super) struct Export {
    /// Project file
    pub file: PathBuf,
    /// Format
    #[arg(long, value_parser = format())]
    pub to: Format,
    /// File to write; formats that need several put the others beside it
    #[arg(long)]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub(super) struct Plot {
    /// Project file
    pub file: PathBuf,
    /// What is plotted
    #[arg(long, value_enum)]
    pub what: PlotKind,
    /// File to write: .svg for the plot, .csv for its values
    #[arg(long)]
    pub out: PathBuf,
    /// Run, or record that is not steady, by its number in the project, from 1; the first that is used unless given
    #[arg(long)]
    pub run: Option<usize>,
    /// Channel such as acc@7, of plots of one channel; the first motion unless given
    #[arg(long)]
    pub channel: Option<String>,
    /// DOF of the response in Bode and Nyquist diagrams; that of the last sensor unless given
    #[arg(long)]
    pub dof: Option<String>,
    /// What is divided by the force in Bode and Nyquist diagrams
    #[arg(long, value_enum, default_value_t = ResponseQuantity::Receptance)]
    pub quantity: ResponseQuantity,
    /// Width x height of the paper in points, such as 900x520
    #[arg(long, value_parser = paper)]
    pub size: Option<[u32; 2]>,
    /// Colours: light or dark
    #[arg(long, default_value = "light", value_parser = ["light", "dark"])]
    pub theme: String,
}

/// Plots of `dashpot plot`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum PlotKind {
    /// Angle against number of sources
    Angle,
    /// Measured and identified energy of every run
    Energy,
    /// Energy by source
    Shares,
    /// Damping matrix
    Matrix,
    /// Magnitude and phase of the model with the measured points
    Bode,
    /// Imaginary over real part near a run
    Nyquist,
    /// Loops of force over displacement of a run
    Hysteresis,
    /// Time record of a channel with its fit and residual; of one that is not steady, with the model's record
    Record,
    /// Amplitude spectrum of a channel; of a record that is not steady, with those of the model and of what is left
    Spectrum,
    /// What the model leaves of a record that is not steady over time and frequency
    Spectrogram,
    /// Error of every channel in every run or record
    ErrorMap,
    /// Amplitude and phase of a channel of all runs over frequency, one curve a level
    Overview,
    /// Damping ratio and frequency over amplitude of a record that is not steady, measured and modelled
    Amplitude,
    /// Measured on modelled over frequency, one curve a level of force
    Channel,
    /// Measured on modelled over the level of force
    Level,
    /// Measured on modelled over one period
    Period,
    /// Measured on modelled as a loop of force over displacement
    Loop,
    /// The missing force at its place over displacement and velocity, after a search; --dof chooses among the suggestions
    RestoringForce,
}

/// What is divided by the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ResponseQuantity {
    /// Displacement over force
    Receptance,
    /// Velocity over force
    Mobility,
    /// Acceleration over force
    Accelerance,
}

impl ResponseQuantity {
    /// The same in the engine's terms.
    pub(super) fn quantity(self) -> ResponseForm {
        match self {
            Self::Receptance => ResponseForm::Receptance,
            Self::Mobility => ResponseForm::Mobility,
            Self::Accelerance => ResponseForm::Accelerance,
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct Run {
    /// Script: a JSON list of commands, see docs/formats.md
    pub script: PathBuf,
    /// Project file; it stays as it is
    pub file: PathBuf,
    /// Project file to write; standard output unless given
    #[arg(long)]
    pub out: Option<PathBuf>,
}

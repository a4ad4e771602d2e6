//! What the program says of a project, as its user reads it: the documents of `diagnose`, with the suggestion applied, and
//! of `compare` afterwards. Judging files and documents, not types, it stays the same whatever the search becomes.

use serde_json::Value;
use std::ffi::OsString;
use std::path::Path;
use std::time::Instant;

/// An effect at a place, named by its law and its DOFs or channel.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub effect: String,
    /// DOF labels, or one name of a channel.
    pub at: Vec<String>,
    /// Values by name, and deviations where they are told.
    pub parameters: Vec<(String, f64, f64)>,
    /// Probability told, if any.
    pub probability: Option<f64>,
}

impl Named {
    pub(crate) fn list(value: &Value) -> Vec<Self> {
        value.as_array().map_or_else(Vec::new, |list| list.iter().map(Self::new).collect())
    }

    pub(crate) fn new(value: &Value) -> Self {
        let text = |v: &Value| v.as_str().unwrap_or_default().to_string();
        let dofs = || value["dofs"].as_array().map_or_else(Vec::new, |d| d.iter().map(text).collect());
        let deviation = |name: &String| value["standard_deviation"][name].as_f64().unwrap_or(f64::INFINITY);
        let parameters = value["parameters"].as_object().into_iter().flatten();
        Self {
            effect: text(&value["effect"]),
            at: if value["channel"].is_string() { vec![text(&value["channel"])] } else { dofs() },
            parameters: parameters.map(|(k, v)| (k.clone(), v.as_f64().unwrap_or(f64::NAN), deviation(k))).collect(),
            probability: value["probability"].as_f64(),
        }
    }

    pub(crate) fn same_law(&self, other: &Self) -> bool {
        self.effect == other.effect
    }

    /// A chain may be read from either end.
    pub(crate) fn same_place(&self, other: &Self) -> bool {
        self.at == other.at || self.at.iter().eq(other.at.iter().rev())
    }

    pub(crate) fn same(&self, other: &Self) -> bool {
        self.same_law(other) && self.same_place(other)
    }

    pub(crate) fn of_channel(&self, channel: &str) -> bool {
        matches!(self.effect.as_str(), "gain" | "delay") && self.at.iter().any(|at| at == channel)
    }
}

impl std::fmt::Display for Named {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.effect, self.at.join("-"))?;
        self.parameters.iter().try_for_each(|(name, value, deviation)| {
            write!(f, " {name} {value:.4e}")?;
            if deviation.is_finite() { write!(f, "+-{deviation:.1e}") } else { Ok(()) }
        })
    }
}

/// The answer to one project.
pub(crate) struct Answer {
    pub document: Value,
    pub seconds: f64,
    /// Seconds of processor time of the whole program meanwhile, where the system tells them: of this project, where one is judged at
    /// a time. They stay what they are when other work shares the machine.
    pub processor_seconds: f64,
    /// Error by `compare` after `--apply`, or why there is none.
    pub after: Result<f64, String>,
}

/// Asks `diagnose`, applies what it suggests, and asks `compare` of the result.
pub(crate) fn ask(folder: &Path, options: &[String]) -> Result<Answer, String> {
    let project = folder.join("project.toml");
    let applied = folder.join("applied.toml");
    let _ = std::fs::remove_file(&applied);
    let (start, used) = (Instant::now(), processor_seconds());
    let mut words = words("diagnose", &project);
    words.extend(options.iter().map(OsString::from));
    let adding = [words.clone(), vec!["--apply".into(), applied.clone().into()]].concat();
    let (text, unwritten) = match dashpot::cli::answer(adding) {
        Ok(text) => (text, None),
        // What cannot be written is a fault of its own; the answer counts all the same.
        Err(error) => (dashpot::cli::answer(words).map_err(|_| error.clone())?, Some(error)),
    };
    let (seconds, processor_seconds) = (start.elapsed().as_secs_f64(), processor_seconds() - used);
    let after = match unwritten {
        Some(error) => Err(error),
        None => dashpot::cli::answer(self::words("compare", &applied)).and_then(|text| error_of(&text)),
    };
    Ok(Answer { document: parsed(&text)?, seconds, processor_seconds, after })
}

/// Processor time of this program, s, by `/proc` of Linux; NaN elsewhere.
fn processor_seconds() -> f64 {
    /// Ticks a second in which the kernel counts.
    const TICKS: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = |k: usize| text.rsplit(')').next()?.split_whitespace().nth(k)?.parse::<f64>().ok();
    ticks(11).zip(ticks(12)).map_or(f64::NAN, |(user, system)| (user + system) / TICKS)
}

fn words(command: &str, file: &Path) -> Vec<OsString> {
    vec!["dashpot".into(), command.into(), file.into(), "--json".into()]
}

fn parsed(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

fn error_of(text: &str) -> Result<f64, String> {
    parsed(text)?["error"].as_f64().ok_or_else(|| "compare tells no error".to_string())
}

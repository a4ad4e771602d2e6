//! Tables of results as text with tabs, for the clipboard: SI units, all digits.

use crate::display::words;
use crate::effects::Source;
use crate::exchange::Project;
use crate::identify::results::ModeResult;
use crate::identify::{Outcome, Step};
use crate::measurement::Run;
use crate::structure::modes::Modes;

fn table(head: &str, lines: impl Iterator<Item = String>) -> String {
    lines.fold(format!("{head}\n"), |text, line| text + &line + "\n")
}

/// The runs of a project with their quality.
pub fn runs(p: &Project) -> String {
    let line = |run: &Run| {
        let level = run.level.map_or_else(String::new, |l| l.to_string());
        let flags: Vec<&str> = run.findings.iter().map(|f| words::flag(f.flag)).collect();
        let (frequency, flags) = (run.frequency_hz(), flags.join(", "));
        let used = if run.enabled { "yes" } else { "no" };
        format!("{}\t{frequency:e}\t{level}\t{:e}\t{used}\t{flags}", run.file, run.noise_ratio)
    };
    table("file\tfrequency (Hz)\tlevel\tnoise over signal\tused\tflags", p.runs.iter().map(line))
}

/// Its sources with their states.
pub fn sources(p: &Project) -> String {
    let line = |s: &Source| {
        let place = words::place(&p.structure, &s.place);
        format!("{}\t{place}\t{}", words::effect(s.effect), s.state.word())
    };
    table("law\tplace\tstate", p.sources.iter().map(line))
}

/// Natural frequencies.
pub fn modes(modes: &Modes) -> String {
    let line = |k: usize| format!("{}\t{:e}", k + 1, modes.frequency_hz(k));
    table("mode\tfrequency (Hz)", (0..modes.len()).map(line))
}

/// The best set for every number of sources.
pub fn steps(p: &Project, outcome: &Outcome) -> String {
    let line = |step: &Step| {
        let sources = step.sources.iter().filter_map(|e| Some((p.sources.get(e.source)?, e)));
        let source_in_words = |(s, e): (&Source, &crate::identify::Estimate)| {
            let place = words::short_place(&p.structure, &s.place);
            format!("{} {place} {:e}", words::effect(s.effect), e.coefficient)
        };
        let which: Vec<String> = sources.map(source_in_words).collect();
        let per_row = step.chi_square / step.freedom.max(1) as f64;
        let (angle, error, which) = (step.angle_deg, step.relative_error, which.join("; "));
        format!("{}\t{which}\t{angle:e}\t{error:e}\t{per_row:e}", step.count)
    };
    let head = "sources\twhich, with coefficients\tangle (deg)\tenergy error\tchi-square per row";
    table(head, outcome.steps.iter().map(line))
}

/// What was identified, source by source.
pub fn coefficients(p: &Project, outcome: &Outcome) -> String {
    let line = |e: &crate::identify::Estimate| {
        let s = p.sources.get(e.source)?;
        let unit = s.effect.coefficient().map_or("", |k| s.effect.parameters()[k].unit);
        let (law, place, state) = (s.effect.name(), words::place(&p.structure, &s.place), s.state.word());
        let (value, deviation, share) = (e.coefficient, e.deviation, e.energy_percent);
        Some(format!("{law}\t{place}\t{state}\t{value:e}\t{deviation:e}\t{unit}\t{share}"))
    };
    let head = "law\tplace\tstate\tcoefficient\tdeviation\tunit\tenergy %";
    table(head, outcome.sources.iter().filter_map(line))
}

/// Damping ratios of the model with what was identified.
pub fn damping(outcome: &Outcome) -> String {
    let line = |(k, mode): (usize, &ModeResult)| {
        let half = mode.half_power_ratio.map_or_else(String::new, |r| format!("{r:e}"));
        let (frequency, ratio, deviation) = (mode.frequency_hz, mode.damping_ratio, mode.damping_ratio_deviation);
        format!("{}\t{frequency:e}\t{ratio:e}\t{deviation:e}\t{half}", k + 1)
    };
    let head = "mode\tfrequency (Hz)\tdamping ratio\tstandard deviation\thalf-power ratio";
    table(head, outcome.results.modes.iter().enumerate().map(line))
}

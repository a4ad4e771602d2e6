//! Tables of results as text with tabs, for the clipboard: SI units, all digits.

use crate::classical::side_by_side::{Ratio, SideBySide};
use crate::diagnosis::Comparison;
use crate::display::words;
use crate::effects::Source;
use crate::exchange::Project;
use crate::identify::change::Pair;
use crate::identify::results::ModeResult;
use crate::identify::{Outcome, SelectionStep};
use crate::measurement::Run;
use crate::session::states::Compared;
use crate::structure::modes::Modes;

pub(super) fn table(head: &str, lines: impl Iterator<Item = String>) -> String {
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
        let place = s.place.cell(&p.structure);
        format!("{}\t{place}\t{}", s.effect.noun(), s.state.word())
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
    let line = |step: &SelectionStep| {
        let sources = step.sources.iter().filter_map(|e| Some((p.sources.get(e.source)?, e)));
        let source_in_words = |(s, e): (&Source, &crate::identify::Estimate)| {
            let place = s.place.short_cell(&p.structure);
            format!("{} {place} {:e}", s.effect.noun(), e.coefficient)
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
        let (law, place, state) = (s.effect.name(), s.place.cell(&p.structure), s.state.word());
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

/// Damping ratios and errors of the classical methods, one line a method; those that cannot run say why.
pub fn methods(found: &SideBySide) -> String {
    let modes = found.measured;
    let row = |ratios: &[Ratio]| -> String {
        let cell = |mode| ratios.iter().find(|r| r.mode == mode).map_or_else(String::new, |r| format!("{:e}", r.ratio));
        (0..modes).map(|mode| format!("\t{}", cell(mode))).collect()
    };
    let line = |entry: &crate::classical::side_by_side::Entry| {
        let name = entry.method.title();
        match &entry.outcome {
            Ok(applied) => {
                let errors = applied.errors.map_or_else(|| "\t".to_owned(), |e| format!("{:e}\t{:e}", e.eps_c, e.mac));
                format!("{name}\t{errors}{}\t", row(&applied.ratios))
            }
            Err(why) => format!("{name}\t\t{}\t{why}", "\t".repeat(modes)),
        }
    };
    let own = |k: usize| found.modal.as_ref().filter(|m| k < m.len()).map(|m| format!("{:e}", m.damping_ratio(k)));
    let ratios: String = (0..modes).map(|k| format!("\t{}", own(k).unwrap_or_default())).collect();
    let measured = found.modal.is_some().then(|| format!("Complex modes as measured\t\t{ratios}\t"));
    let reference =
        (!found.reference_ratios.is_empty()).then(|| format!("Reference\t\t{}\t", row(&found.reference_ratios)));
    let names: String = (1..=modes).map(|mode| format!("\tdamping ratio of mode {mode}")).collect();
    let head = format!("method\terror of C (%)\tMAC error{names}\tcannot run because");
    table(&head, found.entries.iter().map(line).chain(measured).chain(reference))
}

/// What changed between two states: coefficients of sources, then damping ratios of modes.
pub fn change(compared: &Compared) -> String {
    let pair = |p: &Pair| {
        let Pair { values: [a, b], deviations: [da, db], difference, deviation, chance } = p;
        format!("{a:e}\t{da:e}\t{b:e}\t{db:e}\t{difference:e}\t{deviation:e}\t{chance:e}")
    };
    let source = |s: &crate::identify::change::SourceChange| {
        let name = s.source.title(&compared.structure);
        format!("{name}\t{}\t{}", crate::display::change::unit(s), pair(&s.coefficient))
    };
    let mode = |m: &crate::identify::change::ModeChange| {
        format!("damping ratio at {:e} Hz\t\t{}", m.frequency_hz[0], pair(&m.ratio))
    };
    let head = "what\tunit\tfirst\tits deviation\tsecond\tits deviation\tdifference\tits deviation\tchance";
    let change = &compared.change;
    table(head, change.sources.iter().map(source).chain(change.modes.iter().map(mode)))
}

/// Error of the model in every run and channel, with what noise alone would make.
pub fn errors(p: &Project, comparison: &Comparison) -> String {
    let of_run = |run: &crate::diagnosis::residual::comparison::RunComparison| {
        let (file, frequency) = p.runs.get(run.index).map_or(("", 0.0), |r| (r.file.as_str(), r.frequency_hz()));
        let level = p.runs.get(run.index).and_then(|r| r.level).map_or_else(String::new, |l| l.to_string());
        let start = format!("{file}\t{frequency:e}\t{level}");
        let used = if run.used { "yes" } else { "no" };
        let row = |what: &str, error: f64, floor: f64| format!("{start}\t{what}\t{error:e}\t{floor:e}\t{used}");
        if run.channels.is_empty() {
            return vec![row("energy", run.error, run.noise_floor)];
        }
        run.channels.iter().map(|c| row(&c.channel, c.error, c.noise_floor)).collect()
    };
    let head = "file\tfrequency (Hz)\tlevel\tchannel\terror\tnoise floor\tused";
    table(head, comparison.runs.iter().flat_map(of_run))
}

/// How well the motion at the sensors and elsewhere follows from what is measured, one line a run.
pub fn expansion(p: &Project, outcome: &Outcome) -> String {
    let line = |r: &crate::identify::RunOutcome| {
        let file = p.runs.get(r.run).map_or("", |run| run.file.as_str());
        format!("{file}\t{:e}\t{:e}\t{:e}", r.relative_misfit, r.misfit, r.expansion_error)
    };
    table("file\terror at sensors\tin deviations\terror at other DOFs", outcome.runs.iter().map(line))
}

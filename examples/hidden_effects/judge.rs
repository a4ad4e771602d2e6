//! Diagnoses a project and scores the answer against what was hidden.

use super::files::truth;
use dashpot::control::Control;
use dashpot::diagnosis::Problem;
use dashpot::diagnosis::diagnose::{Diagnosis, Suggestion, Verdict, diagnose};
use dashpot::effects::Source;
use dashpot::exchange::project::load;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

/// Counts over projects of one class.
#[derive(Debug, Default, Clone)]
pub struct Tally {
    pub projects: usize,
    pub effect: usize,
    pub top3: usize,
    pub place: usize,
    pub all: usize,
    pub adequate: usize,
    pub to_floor: usize,
    /// Projects whose first suggestion is right, and of those the parameters within three deviations.
    pub compared: usize,
    pub within: usize,
    /// Relative errors of parameters.
    pub errors: Vec<f64>,
    pub seconds: Vec<f64>,
}

impl Tally {
    pub fn add(&mut self, other: &Self) {
        self.projects += other.projects;
        self.effect += other.effect;
        self.top3 += other.top3;
        self.place += other.place;
        self.all += other.all;
        self.adequate += other.adequate;
        self.to_floor += other.to_floor;
        self.compared += other.compared;
        self.within += other.within;
        self.errors.extend(&other.errors);
        self.seconds.extend(&other.seconds);
    }

    pub fn row(&self) -> String {
        let n = self.projects.max(1) as f64;
        let share = |k: usize| format!("{:5.1}", 100.0 * k as f64 / n);
        let median = |list: &[f64]| {
            let mut list = list.to_vec();
            list.sort_by(f64::total_cmp);
            list.get(list.len() / 2).copied().unwrap_or(f64::NAN)
        };
        format!(
            "{:4} | {} | {} | {} | {} | {} | {} | {:3}/{:3} | {:7.3} | {:6.2}",
            self.projects,
            share(self.effect),
            share(self.top3),
            share(self.place),
            share(self.all),
            share(self.to_floor),
            share(self.adequate),
            self.within,
            self.compared,
            100.0 * median(&self.errors),
            median(&self.seconds),
        )
    }

    pub fn head() -> &'static str {
        "class      |    n | effect| top-3 | place | all   | floor | adequ.| within  | median% | seconds"
    }
}

/// All classes together against what is asked for: the first effect and its place where one is hidden, all effects where
/// two are, the error after everywhere.
pub fn totals(tallies: &BTreeMap<String, Tally>) -> String {
    let sum = |wanted: &dyn Fn(&str) -> bool| {
        let mut sum = Tally::default();
        tallies.iter().filter(|(class, _)| wanted(class)).for_each(|(_, tally)| sum.add(tally));
        sum
    };
    let (hidden, none) = (sum(&|class| class != "none"), sum(&|class| class == "none"));
    let (two, all) = (sum(&|class| class == "two"), sum(&|_| true));
    let close = hidden.errors.iter().filter(|&&e| e < 0.1).count();
    let lines = [
        ("effect first", hidden.effect, hidden.projects, ">= 95"),
        ("effect among the first three", hidden.top3, hidden.projects, ">= 99"),
        ("place exact or in its group", hidden.place, hidden.projects, ">= 95"),
        ("parameters within three deviations", hidden.within, hidden.compared, ">= 95"),
        ("parameters within 10 %", close, hidden.errors.len(), ""),
        ("two effects both found, no more", two.all, two.projects, ">= 85"),
        ("false alarms", none.projects - none.adequate, none.projects, "<= 3"),
        ("error after within 1.2 floors", all.to_floor, all.projects, ">= 95"),
    ];
    let line = |(what, count, of, asked): (&str, usize, usize, &str)| {
        let share = 100.0 * count as f64 / of.max(1) as f64;
        format!("{what:36} {count:4} of {of:4} {share:6.1} %  {asked}\n")
    };
    lines.map(line).concat()
}

/// Diagnoses the project in `folder`; the line to print and its score.
pub fn judge(folder: &Path) -> (String, Tally) {
    let hidden = truth(folder);
    let name = folder.file_name().unwrap().to_string_lossy().to_string();
    let mut tally = Tally { projects: 1, ..Tally::default() };
    let control = Control::unattended();
    let project = load(&folder.join("project.toml"), &control).unwrap();
    let start = Instant::now();
    let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
    let diagnosis = match diagnose(&problem, &control) {
        Ok(diagnosis) => diagnosis,
        Err(error) => return (format!("FAIL {name}: {error}"), tally),
    };
    let seconds = start.elapsed().as_secs_f64();
    tally.seconds.push(seconds);
    let mark = score(&hidden, &diagnosis, &mut tally);
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    let mut line = format!(
        "{mark} {seconds:5.2}s {name} | {} | {:.4} -> {:.4} floor {:.4} misfit {:.2} {} {}",
        hidden.iter().map(named).collect::<Vec<_>>().join(" + "),
        diagnosis.error_before,
        last.error,
        diagnosis.noise_floor,
        last.misfit,
        diagnosis.verdict.word(),
        if diagnosis.corrections.is_empty() { "" } else { "corrected" },
    );
    for s in diagnosis.suggestions.iter().take(if mark.trim() == "ok" { 1 } else { 4 }) {
        let d: Vec<String> = s.added.deviations.iter().map(|d| format!("{d:.1e}")).collect();
        let alike: Vec<String> =
            s.indistinguishable_from.iter().map(|s| format!("{} {:?}", s.effect, s.place)).collect();
        let _ = write!(
            line,
            "\n        p={:.3} err {:.4} held {:.4} {} +-{}  ~ {}",
            s.probability,
            s.error_after,
            s.held_out_error_after,
            named(&s.added.source),
            d.join(","),
            alike.join(", ")
        );
    }
    (line, tally)
}

fn score(hidden: &[Source], diagnosis: &Diagnosis, tally: &mut Tally) -> String {
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    tally.adequate = usize::from(diagnosis.verdict == Verdict::Adequate && diagnosis.suggestions.is_empty());
    tally.to_floor = usize::from(last.error <= 1.2 * diagnosis.noise_floor);
    if hidden.is_empty() {
        return if tally.adequate == 1 { "ok  " } else { "MISS" }.to_string();
    }
    let law = |s: &Suggestion| hidden.iter().any(|t| t.effect == s.added.source.effect);
    let first = diagnosis.suggestions.first();
    let right = first.is_some_and(law);
    let top3 = diagnosis.suggestions.iter().take(3).any(law);
    let at = |s: &Source| hidden.iter().any(|t| t.place.is_same(&s.place));
    let placed = first.is_some_and(|s| at(&s.added.source) || s.indistinguishable_from.iter().any(at));
    let all = hidden.iter().all(|t| last.added.iter().any(|a| a.source.is_same(t))) && last.added.len() == hidden.len();
    tally.effect = usize::from(right);
    tally.top3 = usize::from(top3);
    tally.place = usize::from(placed);
    tally.all = usize::from(all);
    let mut far = false;
    for (truth, added) in hidden.iter().filter_map(|t| Some((t, last.added.iter().find(|a| a.source.is_same(t))?))) {
        tally.compared += 1;
        let values = truth.parameters.iter().zip(&added.source.parameters).zip(&added.deviations);
        let good = values.clone().all(|((t, p), d)| (t - p).abs() <= 3.0 * d);
        tally.within += usize::from(good);
        far |= !good;
        // A gain is judged by its difference from one.
        tally.errors.extend(values.map(|((t, p), _)| ((p - t) / t).abs()));
    }
    let floor = tally.to_floor == 1;
    match (all, right && placed) {
        (true, _) if floor && !far => "ok  ",
        (true, _) if floor => "far ",
        (true, _) => "high",
        (_, true) => "part",
        _ => "MISS",
    }
    .to_string()
}

fn named(s: &Source) -> String {
    let values: Vec<String> = s.parameters.iter().map(|p| format!("{p:.4e}")).collect();
    format!("{} {:?} {}", s.effect.name(), s.place, values.join(" "))
}

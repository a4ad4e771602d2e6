//! Scores the answer to a project against what was hidden in it.
//!
//! What counts: the law first, or among three; the place, or its group; effects beside the hidden ones that are told;
//! false alarms, where nothing is hidden; parameters against their deviations; the error after Add against the one
//! promised; and, for every suggestion, the probability told against whether it was right.

use super::answer::{Answer, Named, ask};
use super::tally::{Added, Tally, Told};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

/// Probability from which on an effect counts as told.
const TOLD: f64 = 0.5;
/// How close the error after Add must be to the one promised.
const PROMISE: f64 = 0.02;

/// The line of a project and its score.
pub(crate) struct Judged {
    pub line: String,
    pub tally: Tally,
}

/// What is true of a project.
struct Truth {
    hidden: Vec<Named>,
    /// A sensor that is wrong: to name it is right.
    bad: Option<String>,
}

impl Truth {
    fn read(folder: &Path) -> Self {
        let text = std::fs::read_to_string(folder.join("truth.json")).unwrap();
        let truth: Value = serde_json::from_str(&text).unwrap();
        let bad = truth["measurement"]["bad_sensor"]["channel"].as_str().map(str::to_string);
        Self { hidden: Named::list(&truth["hidden"]), bad }
    }

    fn law(&self, told: &Named) -> bool {
        self.hidden.iter().any(|t| t.same_law(told)) || self.excused(told)
    }

    /// A bad sensor that is told.
    fn excused(&self, told: &Named) -> bool {
        self.bad.as_ref().is_some_and(|channel| told.of_channel(channel))
    }
}

/// One suggestion as told.
struct Suggestion {
    told: Named,
    alike: Vec<Named>,
    probability: f64,
    error_after: f64,
}

/// Diagnoses the project in `folder` and scores the answer.
pub(crate) fn judge(folder: &Path, name: &str, options: &[String]) -> Judged {
    let truth = Truth::read(folder);
    let mut tally = Tally { projects: 1, ..Tally::default() };
    tally.hidden = usize::from(!truth.hidden.is_empty());
    let answer = match ask(folder, options) {
        Ok(answer) => answer,
        Err(error) => {
            tally.failed = 1;
            return Judged { line: format!("FAIL {name}: {error}"), tally };
        }
    };
    tally.seconds.push(answer.seconds);
    let suggestions: Vec<Suggestion> = answer.document["suggestions"].as_array().map_or_else(Vec::new, |list| {
        list.iter()
            .map(|s| Suggestion {
                told: Named::new(s),
                alike: Named::list(&s["indistinguishable_from"]),
                probability: s["probability"].as_f64().unwrap_or(0.0),
                error_after: s["error_after"].as_f64().unwrap_or(f64::NAN),
            })
            .collect()
    });
    let verdict = answer.document["verdict"].as_str().unwrap_or("none").to_string();
    *tally.verdicts.entry(verdict.clone()).or_default() += 1;
    let mut marks = scored(&truth, &suggestions, &verdict, &answer, &mut tally);
    marks.extend(promised(&answer, &suggestions, &mut tally));
    Judged { line: line(name, &truth, &suggestions, &answer, &marks), tally }
}

/// Scores what is told; what was wrong, in words.
fn scored(truth: &Truth, suggestions: &[Suggestion], verdict: &str, answer: &Answer, tally: &mut Tally) -> Vec<String> {
    let mut marks = Vec::new();
    let first = suggestions.first();
    for s in suggestions {
        let law = truth.law(&s.told);
        let there = |n: &Named| truth.hidden.iter().any(|t| t.same(n)) || truth.excused(n);
        let place = there(&s.told) || s.alike.iter().any(there);
        tally.told.push(Told { probability: s.probability, law, place });
    }
    let steps = answer.document["steps"].as_array();
    let last = steps.and_then(|s| s.last()).map_or_else(Vec::new, |step| Named::list(&step["added"]));
    tally.to_floor = usize::from(to_floor(&answer.document));
    if truth.hidden.is_empty() {
        let named = first.is_some_and(|s| s.probability > TOLD && !truth.excused(&s.told));
        let alarm = matches!(verdict, "missing" | "undecided") && named;
        tally.alarms = usize::from(alarm);
        marks.extend(alarm.then(|| "ALARM".to_string()));
        return marks;
    }
    let at_right_place = |n: &Named| truth.hidden.iter().any(|t| t.same_place(n)) || truth.excused(n);
    let law = first.is_some_and(|s| truth.law(&s.told));
    let named = suggestions.iter().any(|s| truth.law(&s.told));
    let place = first.is_some_and(|s| at_right_place(&s.told) || s.alike.iter().any(at_right_place));
    tally.law = usize::from(law);
    tally.law_or_named = usize::from(law || (verdict == "undecided" && named));
    tally.among_three = usize::from(suggestions.iter().take(3).any(|s| truth.law(&s.told)));
    tally.place = usize::from(place);
    let further = last.iter().filter(|n| !truth.excused(n) && n.probability.is_none_or(|p| p > TOLD)).count();
    let needless = further > truth.hidden.len() && matches!(verdict, "missing" | "undecided");
    tally.needless = usize::from(needless);
    let found = |t: &Named| last.iter().any(|n| n.same(t));
    tally.all = usize::from(truth.hidden.iter().all(found) && !needless);
    marks.extend((!law).then(|| "LAW".to_string()));
    marks.extend((!place).then(|| "PLACE".to_string()));
    marks.extend(needless.then(|| "NEEDLESS".to_string()));
    // What Add would write is judged, the first suggestion, and the others of the set as the last step has them.
    for hidden in &truth.hidden {
        let told = first.map(|s| &s.told).filter(|n| n.same(hidden));
        if let Some(told) = told.or_else(|| last.iter().find(|n| n.same(hidden))) {
            marks.extend(compared(hidden, told, tally));
        }
    }
    marks
}

fn compared(hidden: &Named, told: &Named, tally: &mut Tally) -> Option<String> {
    let mut good = true;
    for (name, value, deviation) in &told.parameters {
        let Some((_, truth, _)) = hidden.parameters.iter().find(|(n, ..)| n == name) else { continue };
        // A parameter that is said to be unknown claims nothing.
        if deviation.is_finite() {
            tally.scores.push((value - truth) / deviation);
            good &= (value - truth).abs() <= 3.0 * deviation;
        }
        tally.errors.push(((value - truth) / truth).abs());
    }
    tally.compared += 1;
    tally.within += usize::from(good);
    (!good).then(|| "FAR".to_string())
}

/// What the answer says the error is once it is taken over: told as `error_promised`, else that of the suggestion or, of a
/// detuned model, of the last step.
fn promised(answer: &Answer, suggestions: &[Suggestion], tally: &mut Tally) -> Option<String> {
    let document = &answer.document;
    let last = || document["steps"].as_array()?.last()?["error"].as_f64();
    let corrected = document["corrections"].as_array().is_some_and(|c| !c.is_empty());
    let of_first = suggestions.first().map(|s| s.error_after);
    let promise = document["error_promised"].as_f64().or(of_first).or_else(|| last().filter(|_| corrected))?;
    let added = match &answer.after {
        Ok(error) if (error - promise).abs() <= PROMISE * promise => Added::AsPromised,
        Ok(_) => Added::Otherwise,
        Err(_) => Added::DoesNotOpen,
    };
    tally.added.push(added);
    match (&added, &answer.after) {
        (Added::AsPromised, _) => None,
        (_, Ok(error)) => Some(format!("ADD({promise:.4} became {error:.4})")),
        (_, Err(error)) => Some(format!("ADD({error})")),
    }
}

fn to_floor(document: &Value) -> bool {
    let last = document["steps"].as_array().and_then(|s| s.last()).and_then(|s| s["error"].as_f64());
    let floor = document["noise_floor"].as_f64();
    last.zip(floor).is_some_and(|(error, floor)| error <= 1.2 * floor)
}

fn line(name: &str, truth: &Truth, suggestions: &[Suggestion], answer: &Answer, marks: &[String]) -> String {
    let document = &answer.document;
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let last = document["steps"].as_array().and_then(|s| s.last()).cloned().unwrap_or_default();
    let mark = if marks.is_empty() { "ok".to_string() } else { marks.join(" ") };
    let hidden: Vec<String> = truth.hidden.iter().map(Named::to_string).collect();
    let mut line = format!(
        "{mark} | {:.2}s ({:.2} cpu) {name} | {} | {:.4} -> {:.4} floor {:.4} misfit {:.2} {}{}",
        answer.seconds,
        answer.processor_seconds,
        hidden.join(" + "),
        number(&document["error_before"]),
        number(&last["error"]),
        number(&document["noise_floor"]),
        number(&last["misfit"]),
        document["verdict"].as_str().unwrap_or("none"),
        if document["complete"] == Value::Bool(false) { " INCOMPLETE" } else { "" },
    );
    for s in suggestions.iter().take(if mark == "ok" { 1 } else { 4 }) {
        let alike: Vec<String> = s.alike.iter().map(|n| format!("{} {}", n.effect, n.at.join("-"))).collect();
        let _ = write!(line, "\n      p={:.3} err {:.4} {}", s.probability, s.error_after, s.told);
        if !alike.is_empty() {
            let _ = write!(line, "  ~ {}", alike.join(", "));
        }
    }
    let also: Vec<String> = Named::list(&last["added"]).iter().map(Named::to_string).collect();
    if also.len() > 1 {
        let _ = write!(line, "\n      together: {}", also.join(" + "));
    }
    line
}

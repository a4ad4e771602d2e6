//! Counts over the projects of a class, their table, and the figures beside what is asked for.

use super::reliability::{Bin, bins};
use std::collections::BTreeMap;

/// A suggestion: what probability it was told with, and whether it was right.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Told {
    pub probability: f64,
    pub law: bool,
    /// Law and place.
    pub place: bool,
}

/// What became of a suggestion that was taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Added {
    AsPromised,
    Otherwise,
    DoesNotOpen,
}

/// Counts over projects of one class.
#[derive(Debug, Default, Clone)]
pub(crate) struct Tally {
    pub projects: usize,
    /// Projects with something hidden.
    pub hidden: usize,
    pub failed: usize,
    pub law: usize,
    pub law_or_named: usize,
    pub among_three: usize,
    pub place: usize,
    pub all: usize,
    pub needless: usize,
    pub alarms: usize,
    pub to_floor: usize,
    /// Hidden effects that were found, and those with all parameters within three deviations.
    pub compared: usize,
    pub within: usize,
    /// Relative errors of parameters, and errors over the deviation told.
    pub errors: Vec<f64>,
    pub scores: Vec<f64>,
    pub seconds: Vec<f64>,
    pub told: Vec<Told>,
    pub added: Vec<Added>,
    pub verdicts: BTreeMap<String, usize>,
}

impl Tally {
    pub(crate) fn add(&mut self, other: &Self) {
        self.projects += other.projects;
        self.hidden += other.hidden;
        self.failed += other.failed;
        self.law += other.law;
        self.law_or_named += other.law_or_named;
        self.among_three += other.among_three;
        self.place += other.place;
        self.all += other.all;
        self.needless += other.needless;
        self.alarms += other.alarms;
        self.to_floor += other.to_floor;
        self.compared += other.compared;
        self.within += other.within;
        self.errors.extend(&other.errors);
        self.scores.extend(&other.scores);
        self.seconds.extend(&other.seconds);
        self.told.extend(&other.told);
        self.added.extend(&other.added);
        other.verdicts.iter().for_each(|(word, n)| *self.verdicts.entry(word.clone()).or_default() += n);
    }

    fn close(&self) -> usize {
        self.errors.iter().filter(|&&e| e < 0.1).count()
    }

    fn as_promised(&self) -> usize {
        self.added.iter().filter(|&&a| a == Added::AsPromised).count()
    }

    fn row(&self, class: &str) -> String {
        let percentage = |k: usize, n: usize| {
            if n == 0 { "    -".to_string() } else { format!("{:5.1}", 100.0 * k as f64 / n as f64) }
        };
        let none = self.projects - self.hidden;
        format!(
            "{class:8} {:4} {:4} | {} {} {} {} | {} {} | {} {} {} | {} {} {:6.2} | {} {} | {:6.2} {:6.2} {:6.2}",
            self.projects,
            self.failed,
            percentage(self.law, self.hidden),
            percentage(self.law_or_named, self.hidden),
            percentage(self.among_three, self.hidden),
            percentage(self.place, self.hidden),
            percentage(self.needless, self.hidden),
            percentage(self.alarms, none),
            percentage(self.within, self.compared),
            percentage(self.close(), self.errors.len()),
            format_args!("{:7.3}", 100.0 * quantile(&self.errors, 0.5)),
            percentage(self.as_promised(), self.added.len()),
            percentage(self.added.iter().filter(|&&a| a == Added::DoesNotOpen).count(), self.added.len()),
            scatter(&self.scores),
            percentage(self.all, self.hidden),
            percentage(self.to_floor, self.projects),
            quantile(&self.seconds, 0.5),
            quantile(&self.seconds, 0.9),
            quantile(&self.seconds, 1.0),
        )
    }
}

const HEAD: &str = "\
              projects  |      of those with an effect |  wrongly    |    parameters       |         Add         |  all      |        seconds
class       n fail | law   named three place | needl alarm | 3dev  10%   median% | asprm  bad  scatter | found floor | median   p90  worst";

/// The tables: by class, over all, verdicts, probabilities told against how often they were right.
pub(crate) fn report(tallies: &BTreeMap<String, Tally>) -> String {
    let sum = |wanted: &dyn Fn(&str) -> bool| {
        let mut sum = Tally::default();
        tallies.iter().filter(|(class, _)| wanted(class)).for_each(|(_, tally)| sum.add(tally));
        sum
    };
    let mut lines = format!("{HEAD}\n");
    tallies.iter().for_each(|(class, tally)| lines.push_str(&format!("{}\n", tally.row(class))));
    let is_laboratory = |class: &str| class.starts_with("lab") || class.starts_with("structural");
    let laboratory = sum(&is_laboratory);
    let all = sum(&|_| true);
    if laboratory.projects > 0 && laboratory.projects < all.projects {
        lines.push_str(&format!("{}\n", laboratory.row("all lab")));
        lines.push_str(&format!("{}\n", sum(&|class| !is_laboratory(class)).row("exact")));
    }
    lines.push_str(&format!("{}\n\n", all.row("all")));
    for (class, tally) in tallies {
        let words: Vec<String> = tally.verdicts.iter().map(|(word, n)| format!("{word} {n}")).collect();
        lines.push_str(&format!("{class:8} verdicts: {}\n", words.join(", ")));
    }
    lines.push_str(&format!(
        "\n{}\n{}",
        calibration(&all.told),
        asked(&sum(&|c| matches!(c, "lab1" | "lab2")), &sum(&|c| c == "lab3"), &laboratory)
    ));
    lines
}

/// How often suggestions told with a probability were right.
fn calibration(told: &[Told]) -> String {
    let row = |bin: &Bin| {
        let [from, to] = bin.range;
        let [mean, law, place] = [bin.told, bin.law, bin.place].map(|share| 100.0 * share);
        format!("{from:5.3}-{to:5.3} {:4}  {mean:6.1} %    {law:6.1} %    {place:6.1} %\n", bin.count)
    };
    let rows: String = bins(told).iter().map(row).collect();
    format!("told         n  mean told   law right   law and place right\n{rows}")
}

/// The laboratory beside what is asked for.
fn asked(two: &Tally, three: &Tally, all: &Tally) -> String {
    if all.projects == 0 {
        return String::new();
    }
    let sure: Vec<&Told> = all.told.iter().filter(|t| t.probability >= 0.9).collect();
    let near = all.added.len() - all.as_promised();
    let rows = [
        ("1 and 2 %: law first", two.law, two.hidden, ">= 90"),
        ("1 and 2 %: law among three", two.among_three, two.hidden, ">= 97"),
        ("1 and 2 %: place", two.place, two.hidden, ">= 90"),
        ("3 %: law first, or undecided with it named", three.law_or_named, three.hidden, ">= 85"),
        ("nothing missing: false alarms", all.alarms, all.projects - all.hidden, "<= 3"),
        ("needless further effects", all.needless, all.hidden, "<= 5"),
        ("parameters within 3 deviations", all.within, all.compared, ">= 95"),
        ("parameters within 10 %", all.close(), all.errors.len(), ">= 85"),
        ("told with 90 % and right (law)", sure.iter().filter(|t| t.law).count(), sure.len(), ">= 90"),
        ("error after Add not as promised", near, all.added.len(), "0"),
    ];
    let row = |(what, count, of, asked): (&str, usize, usize, &str)| {
        format!("{what:44} {count:4} of {of:4} {:6.1} %  {asked}\n", 100.0 * count as f64 / of.max(1) as f64)
    };
    let scatter =
        format!("{:44} {:.2}  within 1.5\n", "scatter of parameters over deviation told", scatter(&all.scores));
    let [median, late, worst] = [0.5, 0.9, 1.0].map(|q| quantile(&all.seconds, q));
    format!(
        "{}{scatter}{:44} {median:.2} / {late:.2} / {worst:.2}  0.5 / 2 / 10\n",
        rows.map(row).concat(),
        "seconds: median / p90 / worst"
    )
}

/// Actual scatter of parameters over the deviation told: median absolute score over that of a normal deviate.
fn scatter(scores: &[f64]) -> f64 {
    let sizes: Vec<f64> = scores.iter().map(|z| z.abs()).collect();
    quantile(&sizes, 0.5) / 0.6745
}

fn quantile(list: &[f64], share: f64) -> f64 {
    let mut list = list.to_vec();
    list.sort_by(f64::total_cmp);
    let at = (share * list.len() as f64) as usize;
    list.get(at.min(list.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

//! What a diagnosis says, in sentences.

use super::format::{self, in_words};
use crate::diagnosis::Diagnosis;
use crate::diagnosis::result::{Added, NextTest, TestKind, Verdict};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::diagnosis::updating::scatter::{Estimated, Scatter};
use crate::effects::{Place, Source};
use crate::structure::{Part, Structure};

/// How many times the noise floor an error must be to be more than noise.
const BEYOND: f64 = 1.2;

/// Share of the error that must be left at most for corrections to be worth telling.
const WORTH: f64 = 0.98;

/// Whether nothing is missing once the model is corrected, but the model as it stands does not explain the data.
pub fn is_detuned(diagnosis: &Diagnosis) -> bool {
    let beyond = diagnosis.error_before > BEYOND * diagnosis.noise_floor;
    let corrected = diagnosis.verdict == Verdict::Adequate && !diagnosis.corrections.is_empty() && beyond;
    corrected || diagnosis.verdict == Verdict::Detuned
}

/// Whether what is left is more than noise, but nothing that was searched takes anything of it away.
pub fn is_stuck(diagnosis: &Diagnosis) -> bool {
    let after = diagnosis.steps.last().map_or(diagnosis.noise_floor, |s| s.error);
    is_detuned(diagnosis) && after > WORTH * diagnosis.error_before
}

/// How much the natural frequencies differ from run to run: the root mean square of their shifts, and the run that is off most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSpread {
    /// Root mean square of the relative shifts.
    pub shift: f64,
    /// Index of the run that is off most.
    pub run: usize,
    /// Its relative shift.
    pub most: f64,
}

/// The spread of the runs where it is more than their deviations make: the mean square of shifts over deviations is one by
/// chance, with a deviation of `sqrt(2 / n)` for `n` runs; three of these beyond it are no chance.
pub fn spread_of_runs(scatter: &Scatter) -> Option<RunSpread> {
    let shifts: Vec<_> = scatter.runs.iter().map(|r| (r.run, r.frequency)).collect();
    let n = shifts.len() as f64;
    let mean = |value: &dyn Fn(Estimated) -> f64| shifts.iter().map(|(_, s)| value(*s).powi(2)).sum::<f64>() / n;
    let beyond_chance = mean(&Estimated::deviations) > 1.0 + 3.0 * (2.0 / n).sqrt();
    let (run, most) = shifts.iter().max_by(|a, b| a.1.value.abs().total_cmp(&b.1.value.abs()))?;
    let spread = RunSpread { shift: mean(&|s| s.value).sqrt(), run: *run, most: most.value };
    (shifts.len() > 2 && beyond_chance).then_some(spread)
}

/// What is left where no law and no correction takes any of it away, but the runs differ from each other.
pub fn scatter_sentence(diagnosis: &Diagnosis, spread: &RunSpread) -> String {
    let sign = if spread.most > 0.0 { "+" } else { "" };
    format!(
        "The error of {} is more than noise makes ({}), but it is neither a missing law nor a wrong number of the model: natural \
         frequencies differ by {} from run to run, in run {} by {sign}{}. A steady temperature, a set-up that is not touched between \
         runs, or a session for each assembly would lower it. Every run is in the pane Corrections.",
        in_words(diagnosis.error_before),
        format::percent(diagnosis.noise_floor),
        format::percent(spread.shift),
        spread.run + 1,
        format::percent(spread.most),
    )
}

/// On which runs was searched, where there are more than a search needs.
pub fn searched_runs(diagnosis: &Diagnosis) -> Option<String> {
    let count = diagnosis.runs.len();
    (count > 0).then(|| {
        format!("Searched on {count} runs, those along the curve of each level that tell most; errors are of all runs.")
    })
}

/// A test that is proposed: `62 Hz with 4 N at DOF 19`, `a decay released from 2 mm at DOF 7`.
pub fn next_test(structure: &Structure, test: &NextTest) -> String {
    let at = structure.dofs().get(test.force_dof).map_or("?", |d| d.label.as_str());
    let force = format::with_unit(test.force, "N");
    match test.kind {
        TestKind::Steady => format!("{} with {force} at DOF {at}", format::with_unit(test.frequency_hz, "Hz")),
        TestKind::Base { times } => {
            let frequency = format::with_unit(test.frequency_hz, "Hz");
            format!("{frequency} with {times} times the acceleration of the base that was the largest")
        }
        TestKind::Release { displacement_m } => {
            format!("a decay released from {} at DOF {at}, held by {force}", format::prefixed(displacement_m, "m"))
        }
        TestKind::Alike { times } => {
            let size = if times > 1.0 { "larger" } else { "smaller" };
            format!("the same test at DOF {at} with a {size} force, up to {force}")
        }
    }
}

/// An error that is larger than the noise floor by less than this factor is that of noise: the floor is a mean, noise scatters.
const ABOUT: f64 = 1.1;

/// What is said of a model with this error to which nothing is to be added.
pub fn explained(error: f64, noise_floor: f64) -> String {
    let (words, floor) = (in_words(error), format::percent(noise_floor));
    if error <= noise_floor * ABOUT {
        return format!("Its error of {words} is within what noise alone makes ({floor}). Nothing more is suggested.");
    }
    format!("Its error of {words} is more than noise alone makes ({floor}), but nothing more is suggested.")
}

/// What is said where all motions together are turned against the model.
fn turned(diagnosis: &Diagnosis, error: &str) -> String {
    let factors = &diagnosis.common_factors;
    let [first, last] = [factors.first(), factors.last()].map(|factor| {
        let [lead, hz] = factor.map_or([0.0; 2], |factor| [factor.lead_deg, factor.frequency_hz]);
        [format::significant(lead, 2), format::significant(hz, 3)]
    });
    format!(
        "The model is wrong by {error}, and no correction turns all motions together against the force: they lead it by {} degrees at {} Hz \
         and by {} at {} Hz beside the best ones. A high-pass (AC coupling) or a delay of the measuring chain does, or a law that is missing.",
        first[0], first[1], last[0], last[1]
    )
}

/// The verdict as a sentence.
pub fn sentence(diagnosis: &Diagnosis) -> String {
    sentence_of(diagnosis, [diagnosis.error_before, diagnosis.noise_floor])
}

/// The verdict as a sentence with an error of the model as it is and a noise floor, shares, that were computed elsewhere.
pub fn sentence_of(diagnosis: &Diagnosis, [before, noise_floor]: [f64; 2]) -> String {
    let times = before / noise_floor.max(f64::MIN_POSITIVE);
    let (error, floor) = (in_words(before), format::percent(noise_floor));
    match diagnosis.verdict {
        _ if is_stuck(diagnosis) => format!(
            "The error of {error} is more than noise makes ({floor}), but neither a law known here nor a correction of the \
             model takes anything of it away. Look at the error map for where and when it is largest; sensors there or runs at \
             other levels would tell more."
        ),
        Verdict::Adequate | Verdict::Detuned if is_detuned(diagnosis) => {
            let after = in_words(diagnosis.steps.last().map_or(diagnosis.noise_floor, |s| s.error));
            match diagnosis.test_errors {
                None => format!(
                    "It is only detuned: with the corrections below its error falls from {error} to {after} (noise {floor})."
                ),
                Some(test) => format!(
                    "It is only detuned: with the corrections below its error falls from {error} to {after} (noise {floor}). \
                     Of that {} is left where every record has frequencies of its own, which differ by {}, and every sensor a gain.",
                    in_words(test.error_left),
                    format::percent(test.frequency_scatter)
                ),
            }
        }
        Verdict::Adequate | Verdict::Detuned => explained(before, noise_floor),
        _ if before > 10.0 => {
            format!("The model is wrong by {error}: at these frequencies hardly anything in it takes out energy.")
        }
        Verdict::Missing => {
            format!("The model is wrong by {error}, {} times what noise alone makes.", format::significant(times, 2))
        }
        Verdict::Unexplained if !diagnosis.complete => format!(
            "The model is wrong by {error}, {} times the noise; time was up before the search found what mends it. Give it more \
             time.",
            format::significant(times, 2)
        ),
        Verdict::Unexplained if !diagnosis.common_factors.is_empty() => turned(diagnosis, &error),
        Verdict::Unexplained => format!(
            "The model is wrong by {error}, {} times the noise, and no law known here mends it: what the best leaves says \
             where to look, at other levels or with more sensors.",
            format::significant(times, 2)
        ),
        Verdict::Undecided => format!(
            "The model is wrong by {error}, {} times the noise, and these data cannot tell what would mend it.",
            format::significant(times, 2)
        ),
    }
}

/// A sentence of the evidence for `added` as it is read: values in the units that are shown.
pub fn evidence(sentence: &str, added: &Added) -> String {
    const FITTED: &str = "Fitted on the response: ";
    if !sentence.starts_with(FITTED) {
        return format::polished(sentence);
    }
    let parameters = added.source.effect.parameters().iter().zip(&added.source.parameters).zip(&added.deviations);
    let said = parameters
        .map(|((p, value), deviation)| format!("{} = {}", p.name, format::with_deviation(*value, *deviation, p.unit)));
    format!("{FITTED}{}.", said.collect::<Vec<_>>().join(", "))
}

/// What a correction corrects; `known` are the sources that act in the model, in the order of the project.
pub fn corrected(structure: &Structure, known: &[Source], parameter: &UpdatingParameter) -> String {
    match parameter {
        UpdatingParameter::Structure(part) => corrected_part(structure, *part),
        UpdatingParameter::Known(index) => {
            known.get(*index).map_or_else(|| "A known source".to_owned(), |s| s.title(structure))
        }
        UpdatingParameter::Gain(channel) | UpdatingParameter::ForceGain(channel) => format!("Gain of {channel}"),
        UpdatingParameter::Delay(channel) => format!("Delay of {channel}"),
        UpdatingParameter::Session(session) => format!("Stiffness of session {}", session + 1),
    }
}

fn corrected_part(structure: &Structure, part: Part) -> String {
    let place = |dofs: &[usize]| Place::Dofs(dofs.to_vec()).phrase(structure);
    let elements = |range: [usize; 2]| Place::Whole(Some(range)).phrase(structure);
    match part {
        Part::Stiffness => "All stiffness".to_owned(),
        Part::Mass => "All mass".to_owned(),
        Part::Mode(mode) => format!("Stiffness of mode {}", mode + 1),
        Part::ModeCoupling([first, second]) => format!("Coupling of modes {} and {}", first + 1, second + 1),
        Part::ModeDamping(mode) => format!("Damping of mode {}", mode + 1),
        Part::ModeDampingPerOctave(mode) => format!("Damping of mode {} an octave higher", mode + 1),
        Part::GroundSpring(dof) => format!("Spring {}", place(&[dof])),
        Part::Coupling(pair) => format!("Spring {}", place(&pair)),
        Part::PointMass(dof) => format!("Mass {}", place(&[dof])),
        Part::ElementStiffness(range) => format!("Stiffness {}", elements(range)),
        Part::ElementMass(range) => format!("Mass {}", elements(range)),
        Part::Support(held) => format!("Support at node {}", structure.held_node(held).unwrap_or_default()),
    }
}

/// At most so many corrections, those first that are most deviations from 1, in their own order.
pub fn telling(corrections: &[Correction], most: usize) -> Vec<&Correction> {
    let deviations = |c: &Correction| (c.factor - 1.0).abs() / c.deviation.max(f64::MIN_POSITIVE);
    let mut order: Vec<usize> = (0..corrections.len()).collect();
    order.sort_by(|&a, &b| deviations(&corrections[b]).total_cmp(&deviations(&corrections[a])));
    order.truncate(most);
    order.sort_unstable();
    order.into_iter().map(|k| &corrections[k]).collect()
}

/// A correction in words: what, and by how much with its deviation: `+2.00 ± 0.05 %`.
pub fn change(correction: &Correction) -> String {
    format::signed(100.0 * (correction.factor - 1.0), 100.0 * correction.deviation, "%")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Added, Estimated, Scatter, evidence, explained, spread_of_runs};
    use crate::diagnosis::updating::scatter::RunScatter;
    use crate::display::units::{Force, Frequency, Units, choose};
    use crate::effects::{Effect, Place, Source};

    fn scatter(shifts: &[f64], deviation: f64) -> Scatter {
        let still = Estimated { value: 0.0, deviation: 1.0 };
        let run = |(run, &value): (usize, &f64)| {
            let frequency = Estimated { value, deviation };
            RunScatter { run, frequency, amplitude: still, phase: still }
        };
        Scatter { channels: Vec::new(), runs: shifts.iter().enumerate().map(run).collect() }
    }

    #[test]
    fn runs_differ_where_their_shifts_are_more_than_chance() {
        let shifts = [1e-4, -2e-4, 5e-4, -3e-4, 2e-4, -1e-4];
        assert_eq!(spread_of_runs(&scatter(&shifts, 3e-4)), None, "within their deviations");
        let spread = spread_of_runs(&scatter(&shifts, 2e-5)).unwrap();
        assert_eq!((spread.run, spread.most), (2, 5e-4));
        assert!((spread.shift - (0.44e-6_f64 / 6.0).sqrt()).abs() < 1e-12, "{}", spread.shift);
        assert_eq!(spread_of_runs(&scatter(&shifts[..2], 1e-6)), None, "two runs are no scatter");
    }

    #[test]
    fn only_an_error_within_the_noise_is_said_to_be_within_it() {
        let within = explained(0.0156, 0.0156);
        assert_eq!(within, "Its error of 1.56 % is within what noise alone makes (1.56 %). Nothing more is suggested.");
        let beyond = explained(0.0235, 0.0156);
        assert_eq!(
            beyond,
            "Its error of 2.35 % is more than noise alone makes (1.56 %), but nothing more is suggested."
        );
    }

    #[test]
    fn evidence_is_told_in_the_units_that_are_shown() {
        let source = Source::known(Effect::Coulomb, Place::Dofs(vec![0]), &[2.0]);
        let added = Added { source, deviations: vec![0.1] };
        let sentence = "Fitted on the response: force = 2.00 +- 0.10 N.";
        assert_eq!(evidence(sentence, &added), "Fitted on the response: force = 2.00 ± 0.10 N.");
        choose(Units { force: Force::PoundForce, frequency: Frequency::Hertz, ..Units::default() });
        let shown = evidence(sentence, &added);
        choose(Units::default());
        // 1 lbf = 4.4482216 N.
        assert_eq!(shown, "Fitted on the response: force = 0.450 ± 0.022 lbf.");
        assert_eq!(evidence("Noise -2 of it.", &added), "Noise −2 of it.");
    }
}

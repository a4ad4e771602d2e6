//! What a diagnosis says: suggestions with their probabilities, steps, verdict, corrections and the next test.

use crate::diagnosis::channels::fault::ChannelFault;
use crate::diagnosis::run_fault::RunFault;
use crate::diagnosis::updating::correction::Correction;
use crate::effects::Source;

/// What the comparison of model and data says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The model agrees with the data to the noise.
    Adequate,
    /// An effect is missing, and it is named.
    Missing,
    /// The model disagrees, and the data cannot tell the suggestions apart.
    Undecided,
    /// What the model states is off, and nothing is missing.
    Detuned,
    /// Something is missing that no law known here, at any place, gives.
    Unexplained,
}

impl Verdict {
    /// Word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adequate => "adequate",
            Self::Missing => "missing",
            Self::Undecided => "undecided",
            Self::Detuned => "detuned",
            Self::Unexplained => "unexplained",
        }
    }
}

/// An effect with the standard deviations of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Added {
    /// Effect, place and parameters.
    pub source: Source,
    /// Standard deviation of every parameter.
    pub deviations: Vec<f64>,
}

/// One suggested effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// The effect.
    pub added: Added,
    /// Error of the model with this effect alone added.
    pub error_after: f64,
    /// The same on runs that were left out of the fit.
    pub held_out_error_after: f64,
    /// Probability among all that was looked at, 0 to 1.
    pub probability: f64,
    /// Why, in sentences with numbers.
    pub evidence: Vec<String>,
    /// Other effects or places that fit as well within the noise.
    pub indistinguishable_from: Vec<Source>,
}

/// The model on the way: effects added so far and the error with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Effects.
    pub added: Vec<Added>,
    /// Error, as in `compare`.
    pub error: f64,
    /// Squared residual per datum in units of the noise: 1 for a model that agrees.
    pub misfit: f64,
}

/// Kind of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TestKind {
    /// Steady state under a sine.
    Steady,
    /// Steady state under a sine of the base that the structure stands on.
    Base {
        /// Its acceleration over the largest of the runs.
        times: f64,
    },
    /// A decay after a DOF is let go from this displacement, m.
    Release {
        /// Displacement of the DOF, m.
        displacement_m: f64,
    },
    /// The same blow, sweep or noise as was recorded, so many times as large.
    Alike {
        /// Force over that of the record.
        times: f64,
    },
}

impl TestKind {
    /// Word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Steady | Self::Base { .. } => "steady",
            Self::Release { .. } => "decay",
            Self::Alike { .. } => "transient",
        }
    }
}

/// A run that would tell suggestions apart or pin a parameter down.
#[derive(Debug, Clone, PartialEq)]
pub struct NextTest {
    /// What kind of test.
    pub kind: TestKind,
    /// Frequency of a sine, Hz; of other tests that of the motion that stands out.
    pub frequency_hz: f64,
    /// Row of the DOF to be driven, or to be let go; on a moving base that of its largest load.
    pub force_dof: usize,
    /// Amplitude of the force, N; of a release the one that holds the DOF there.
    pub force: f64,
    /// What it would show.
    pub why: String,
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Error of the model as it is.
    pub error_before: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// Verdict.
    pub verdict: Verdict,
    /// Suggestions, best first; none if adequate.
    pub suggestions: Vec<Suggestion>,
    /// From the model as it is to the best one.
    pub steps: Vec<Step>,
    /// Errors of the records that are not steady, where a project has them beside steady runs.
    pub records: Option<RecordErrors>,
    /// Of records, what the test itself adds to the error of the last step, where that is much of it.
    pub test_errors: Option<TestErrors>,
    /// Tests worth doing next.
    pub next_test: Vec<NextTest>,
    /// What the model states wrongly, where the data demand it: corrections that were fitted beside the effects.
    pub corrections: Vec<Correction>,
    /// Factors that all motions have in common against the corrected model, by frequency, where they are larger than measuring
    /// chains and models out of tune make them: no correction is the answer then.
    pub common_factors: Vec<CommonFactor>,
    /// Reversed, exchanged and misread channels; all the rest is of the data with these mended.
    pub channel_faults: Vec<ChannelFault>,
    /// Runs that do not fit the others; all the rest is of the data without them.
    pub run_faults: Vec<RunFault>,
    /// Whether the search came to its end before its time was up ([`crate::control::Control::hurry`]).
    pub complete: bool,
    /// Numbers of the runs of the project that were searched where there are more than a search needs: those that tell most
    /// (its errors are of all runs); none where all were.
    pub runs: Vec<usize>,
}

/// One complex factor that all motions have in common against the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonFactor {
    /// Mean frequency of the runs that show it, Hz.
    pub frequency_hz: f64,
    /// Measured over predicted amplitude.
    pub gain: f64,
    /// Angle by which the measured motions lead, degrees.
    pub lead_deg: f64,
}

/// Errors of the records that are not steady.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordErrors {
    /// Of the model as it is.
    pub error_before: f64,
    /// With the first suggestion, or the set that it is of, added.
    pub error_after: f64,
    /// What noise alone would leave.
    pub noise_floor: f64,
}

/// What the test itself adds to what a model leaves of its records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TestErrors {
    /// Relative standard deviation of the natural frequencies from record to record: temperature, re-seating.
    pub frequency_scatter: f64,
    /// Error that is left where every record has frequencies and zeros, and every sensor a gain, of its own.
    pub error_left: f64,
}

impl Diagnosis {
    /// The answer where the model as it is agrees with the data, as the step `stated` says, from which every search begins.
    pub fn adequate(stated: Step, noise_floor: f64) -> Self {
        Self {
            error_before: stated.error,
            noise_floor,
            verdict: Verdict::Adequate,
            suggestions: Vec::new(),
            steps: vec![stated],
            records: None,
            test_errors: None,
            next_test: Vec::new(),
            corrections: Vec::new(),
            common_factors: Vec::new(),
            channel_faults: Vec::new(),
            run_faults: Vec::new(),
            complete: true,
            runs: Vec::new(),
        }
    }

    /// What is added with `source`: the whole set that its error is told with, else it alone.
    pub fn added_with(&self, source: &Source) -> Vec<Source> {
        match self.steps.last().filter(|_| self.is_told_with_its_set(source)) {
            Some(step) => step.added.iter().map(|added| added.source.clone()).collect(),
            None => vec![source.clone()],
        }
    }

    /// Makes this the answer to data whose channels had `faults`, with which the model agreed as `as_stated` says.
    pub(crate) fn follows(&mut self, as_stated: Step, mut faults: Vec<ChannelFault>) {
        self.error_before = as_stated.error;
        self.steps.insert(0, as_stated);
        if self.verdict == Verdict::Adequate {
            self.verdict = Verdict::Missing;
        }
        faults.append(&mut self.channel_faults);
        self.channel_faults = faults;
    }

    /// Whether `source` is of the set of the last step, and the error that is told of it is that of the set and of the corrections that
    /// were fitted beside it: where there are any, or where it is told of each of them.
    pub fn is_told_with_its_set(&self, source: &Source) -> bool {
        let Some(step) = self.steps.last() else { return false };
        let is_member = step.added.iter().any(|added| added.source.is_same(source));
        let told = self.suggestions.iter().find(|s| s.added.source.is_same(source));
        is_member && (!self.corrections.is_empty() || told.is_some_and(|told| told.error_after == step.error))
    }
}

/// Is told of suggestions as soon as there are any, before they are fitted to the end: their errors and probabilities are
/// provisional. It may be told several times; what it was told last replaces what it was told before.
pub type Early<'a> = dyn Fn(&[Suggestion]) + Sync + 'a;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Effect, Place};

    /// What is told with the error of a set is added with the set, corrected or not; what is told with its own error alone is added alone.
    #[test]
    fn a_member_that_is_told_with_its_set_is_added_with_it() {
        let source = |effect: Effect, size: f64| Source::known(effect, Place::Dofs(vec![0]), &[size]);
        let sources = [source(Effect::Coulomb, 2.0), source(Effect::CubicStiffness, 5e6), source(Effect::Viscous, 1.0)];
        let added = |k: usize| Added { source: sources[k].clone(), deviations: vec![0.1] };
        let suggestion = |k: usize, error_after: f64| Suggestion {
            added: added(k),
            error_after,
            held_out_error_after: error_after,
            probability: 0.5,
            evidence: Vec::new(),
            indistinguishable_from: Vec::new(),
        };
        let step = || Step { added: vec![added(0), added(1)], error: 0.03, misfit: 1.0 };
        let diagnosis = |own: f64| Diagnosis {
            verdict: Verdict::Missing,
            suggestions: vec![suggestion(0, own), suggestion(1, own), suggestion(2, 0.4)],
            ..Diagnosis::adequate(step(), 0.01)
        };
        assert_eq!(diagnosis(0.03).added_with(&sources[0]), sources[..2]);
        assert_eq!(diagnosis(0.2).added_with(&sources[0]), sources[..1]);
        assert_eq!(diagnosis(0.03).added_with(&sources[2]), sources[2..]);
    }
}

//! Settings of harmonic balance.

use crate::control::Control;

/// Newton steps from which on a response is given up where somebody waits for the best so far: without that of the model as it is there is
/// no answer at all.
const HURRIED: usize = 80;

/// How many harmonics, and how exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Harmonics of the first solution.
    pub harmonics: usize,
    /// Most harmonics; no more than `harmonics` keeps their number fixed and estimates the truncation error only.
    pub most_harmonics: usize,
    /// Harmonics whose change decides whether there are enough.
    pub watched: usize,
    /// Largest change of a watched harmonic from one number of harmonics to the next, relative to the largest amplitude.
    pub truncation: f64,
    /// Whether to estimate the truncation error where only one number of harmonics is solved (costs as much again).
    pub estimate: bool,
    /// Relative residual of the force balance.
    pub tolerance: f64,
    /// Newton steps for one number of harmonics from which on no new attempt is made and the response is given up.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: 7,
            most_harmonics: 127,
            watched: 7,
            truncation: 5e-5,
            estimate: true,
            tolerance: 1e-10,
            patience: usize::MAX,
        }
    }
}

impl Settings {
    /// Whether to make no further attempt after so many Newton steps: patience is at its end, or somebody who has little of
    /// it waits for the best so far.
    pub(crate) fn gives_up(&self, steps: usize, control: &Control) -> bool {
        steps > self.patience || (self.patience < usize::MAX && steps > HURRIED && control.is_late())
    }

    /// A fixed number of harmonics.
    pub fn fixed(harmonics: usize) -> Self {
        Self { harmonics, most_harmonics: harmonics, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Who asked for an answer at any price gets it; who has patience of a length is answered soon when time is up.
    #[test]
    fn patience_ends_by_steps_and_by_time() {
        let (control, patient) = (Control::unattended(), Settings { patience: 250, ..Settings::default() });
        assert!(!patient.gives_up(250, &control) && patient.gives_up(251, &control));
        control.hurry();
        assert!(!patient.gives_up(HURRIED, &control) && patient.gives_up(HURRIED + 1, &control));
        assert!(!Settings::default().gives_up(usize::MAX, &control));
    }
}

//! What changed between two states of a structure: before and after a bolt was tightened, before and after damage.
//!
//! Each state is identified by itself first. The sources that either accepted are then identified in both, so that every
//! coefficient has a value and a covariance in both states, and the two are held against each other:
//!
//! `d_k = c_k'' - c_k'`, `s_k^2 = s_k'^2 + s_k''^2`, `z_k = d_k / s_k`, and `X^2 = d^T (S' + S'')^-1 d` over all of them,
//!
//! with `c` the coefficients (units of the laws), `S` their covariances, `'` and `''` the states. Where nothing changed `z`
//! is standard normal and `X^2` has a chi-square distribution with as many degrees of freedom as there are sources. An error of
//! the model that is the same in both states leaves `d` alone to first order. Sources are called changed where their
//! probability of chance, after Holm's correction for their number, is below [`LEVEL`]. S. Holm, A simple sequentially
//! rejective multiple test procedure, Scandinavian Journal of Statistics 6 (1979) 65-70.

mod common;
mod condition;
mod test;

pub use condition::{ChangeError, Condition};
pub use test::LEVEL;

use super::identify_measured;
use super::outcome::Outcome;
use super::settings::Settings;
use crate::control::Control;
use crate::effects::Source;
use condition::NAMES;
use test::{chance, chi_square_of, holm};

/// A coefficient or a damping ratio in both states, with its standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// In the first and the second state.
    pub values: [f64; 2],
    /// Their standard deviations.
    pub deviations: [f64; 2],
    /// Second less first.
    pub difference: f64,
    /// Standard deviation of the difference.
    pub deviation: f64,
    /// Probability of a difference as large by noise alone, two-sided; corrected for the number of sources among these.
    pub chance: f64,
}

impl Pair {
    fn new(values: [f64; 2], deviations: [f64; 2]) -> Self {
        let (difference, deviation) = (values[1] - values[0], deviations[0].hypot(deviations[1]));
        Self { values, deviations, difference, deviation, chance: chance(difference, deviation) }
    }

    /// Whether noise alone hardly makes the difference.
    pub fn is_significant(&self) -> bool {
        self.chance < LEVEL
    }
}

/// A source in both states.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceChange {
    /// Law and place, in the DOFs of the first state.
    pub source: Source,
    /// Its coefficient.
    pub coefficient: Pair,
    /// Its share of the energy in both states, per cent.
    pub energy_percent: [f64; 2],
    /// Which states accepted it by themselves.
    pub accepted: [bool; 2],
}

/// A mode in both states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeChange {
    /// Frequencies of the identified models, Hz.
    pub frequency_hz: [f64; 2],
    /// Damping ratio.
    pub ratio: Pair,
}

/// What changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Sources that either state accepted.
    pub sources: Vec<SourceChange>,
    /// Modes, where both states have equally many.
    pub modes: Vec<ModeChange>,
    /// `X^2` over all sources; `None` where a coefficient is not determined.
    pub chi_square: Option<f64>,
    /// Probability of such an `X^2` by noise alone.
    pub chance: Option<f64>,
    /// Each state identified with the sources of both.
    pub outcomes: [Outcome; 2],
}

impl Change {
    /// Sources whose coefficients changed.
    pub fn changed(&self) -> impl Iterator<Item = &SourceChange> {
        self.sources.iter().filter(|s| s.coefficient.is_significant())
    }
}

/// Identifies both states and says what changed.
///
/// # Errors
/// [`ChangeError`]: which state cannot be identified, or which place it lacks; or cancelled.
pub fn change(states: [Condition<'_>; 2], control: &Control) -> Result<Change, ChangeError> {
    let identified = |k: usize, sources: &[Source], settings: &Settings| {
        let Condition { structure, measured, .. } = states[k];
        identify_measured(structure, sources, measured, settings, control)
            .map_err(|reason| ChangeError::State { state: NAMES[k], reason })
    };
    let alone = [0, 1].map(|k| identified(k, states[k].sources, states[k].settings));
    let [first, second] = alone;
    let alone = [first?, second?];
    let shared = common::accepted_by_either(&states, &alone)?;
    let settings = |k: usize| {
        let most = states[k].settings.max_sources.max(shared.len());
        Settings { max_sources: most, ..states[k].settings.clone() }
    };
    let sources = |k: usize| common::with_forced(states[k].sources, shared.iter().map(|s| &s.sources[k]));
    let outcomes = [identified(0, &sources(0), &settings(0))?, identified(1, &sources(1), &settings(1))?];
    Ok(compared(&shared, [sources(0), sources(1)], outcomes))
}

/// Both states with the same sources, held against each other.
fn compared(shared: &[common::Shared], sources: [Vec<Source>; 2], outcomes: [Outcome; 2]) -> Change {
    let found = |k: usize, s: &common::Shared| {
        let index =
            sources[k].iter().position(|o| o.state == crate::effects::State::Forced && o.is_same(&s.sources[k]));
        outcomes[k].accepted_step().sources.iter().position(|e| Some(e.source) == index)
    };
    let mut list = Vec::new();
    let mut places: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    for s in shared {
        let (Some(a), Some(b)) = (found(0, s), found(1, s)) else { continue };
        let [one, two] = [&outcomes[0].accepted_step().sources[a], &outcomes[1].accepted_step().sources[b]];
        places[0].push(a);
        places[1].push(b);
        list.push(SourceChange {
            source: s.sources[0].clone(),
            coefficient: Pair::new([one.coefficient, two.coefficient], [one.deviation, two.deviation]),
            energy_percent: [one.energy_percent, two.energy_percent],
            accepted: s.accepted,
        });
    }
    let corrected = holm(&list.iter().map(|s| s.coefficient.chance).collect::<Vec<_>>());
    list.iter_mut().zip(corrected).for_each(|(s, chance)| s.coefficient.chance = chance);
    let differences: Vec<f64> = list.iter().map(|s| s.coefficient.difference).collect();
    let covariance = |k: usize, i: usize, j: usize| outcomes[k].covariance[places[k][i]][places[k][j]];
    let total = |i: usize, j: usize| covariance(0, i, j) + covariance(1, i, j);
    let chi_square = chi_square_of(&differences, &total);
    let freedom = differences.len();
    let chance = chi_square.map(|x| crate::math::statistics::chi_square_tail(x, freedom));
    let modes = modes(&outcomes);
    Change { sources: list, modes, chi_square, chance, outcomes }
}

/// Modes by their numbers: the order of frequencies of a structure hardly changes with its damping.
fn modes(outcomes: &[Outcome; 2]) -> Vec<ModeChange> {
    let [first, second] = [&outcomes[0].results.modes, &outcomes[1].results.modes];
    if first.len() != second.len() {
        return Vec::new();
    }
    let mode_change = |(a, b): (&super::results::ModeResult, &super::results::ModeResult)| ModeChange {
        frequency_hz: [a.frequency_hz, b.frequency_hz],
        ratio: Pair::new([a.damping_ratio, b.damping_ratio], [a.damping_ratio_deviation, b.damping_ratio_deviation]),
    };
    first.iter().zip(second).map(mode_change).collect()
}

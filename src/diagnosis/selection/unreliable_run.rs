//! A run that does not fit the others: an amplifier set otherwise, the record of another test, a cable off. Like a channel that is
//! relied on and wrong it keeps any law from agreeing. Without it free forces at the best place, the updated model alone or what was
//! found leave far less than without any other run, and the same is left where it is kept and its force, its motions or one of them
//! are misread by a factor.

use crate::control::Control;
use crate::diagnosis::localisation::free_force::{Placing, Screen};
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::conclusion::Outcome;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::parameters::Updating;
use crate::diagnosis::updating::scales::Scales;

/// Squared residual per datum up to which the other runs leave noise.
const NOISE: f64 = 2.0;
/// How many times what is left without a run must be left with it, and without any other.
const MORE: f64 = 2.0;
/// The same where it is misread by no factor.
const PLAIN: f64 = 4.0;
/// Squared residual per datum that what was found may leave of the other runs: where it leaves more it is not what is missing.
const FOUND: f64 = 16.0;
/// How many times as much may be left where it is kept and misread by a factor.
const ALIKE: f64 = 1.3;
/// Least share by which it is misread: what drifts, scatters and is out of tune stays below.
const MISREAD: f64 = 0.1;

/// A run without which least is left.
struct Suspect {
    /// Its place among the runs.
    run: usize,
    /// Squared residual per datum that is left without it.
    left: f64,
    /// The least that is left with it or without any other.
    otherwise: f64,
}

impl Suspect {
    /// The suspect of `runs`, places among those that `screen` sees, by what `best` leaves.
    fn of(screen: &Screen, best: fn(&Screen) -> Placing, runs: &[usize], control: &Control) -> Option<Self> {
        let left = |screen: &Screen| best(screen).chi_square / screen.count().max(1) as f64;
        let without = |k: usize| (runs[k], left(&screen.without_run(runs[k])));
        let mut runs = control.map(runs.len(), without);
        runs.sort_by(|a, b| a.1.total_cmp(&b.1));
        let [(run, least), (_, next), ..] = runs[..] else { return None };
        Some(Self { run, left: least, otherwise: next.min(left(screen)) })
    }

    /// The place among the runs of that which is left out for `reason`: the suspect, or the one beside it where two do not fit.
    fn left_out(
        screen: &Screen,
        best: fn(&Screen) -> Placing,
        reason: fn(&Self, &Screen) -> bool,
        reference: &ReferenceModel,
    ) -> Option<usize> {
        let told = |suspect: &Self, screen: &Screen| suspect.otherwise > MORE * suspect.left && reason(suspect, screen);
        let data = reference.data;
        let runs: Vec<usize> = (0..data.runs.len()).filter(|&r| !data.kept.contains(&data.runs[r].index)).collect();
        let first = Self::of(screen, best, &runs, reference.control)?;
        if told(&first, screen) {
            return Some(first.run);
        }
        if !data.may_leave_out(2) {
            return None;
        }
        let rest = screen.without_run(first.run);
        let others = runs.into_iter().filter(|&run| run != first.run);
        let others: Vec<usize> = others.map(|run| run - usize::from(run > first.run)).collect();
        let second = Self::of(&rest, best, &others, reference.control).filter(|second| told(second, &rest))?;
        Some(second.run + usize::from(second.run >= first.run))
    }

    /// Whether without it noise is left, and far more otherwise.
    fn is_plain(&self) -> bool {
        self.otherwise > PLAIN * self.left.max(1.0) && (self.left < NOISE || self.otherwise > PLAIN * PLAIN * self.left)
    }

    /// Whether no more is left where its force, its motions or one of them are misread by a factor, beside what `best` leaves.
    fn is_misread(&self, screen: &Screen, best: fn(&Screen) -> Placing) -> bool {
        let spots = |wanted: fn(&Spot) -> bool| {
            (0..screen.spots.len()).filter(|&k| wanted(&screen.spots[k])).collect::<Vec<usize>>()
        };
        let responses = spots(|spot| matches!(spot, Spot::Response(_)));
        let each = responses.iter().map(|&spot| vec![spot]);
        let kinds = [spots(|spot| matches!(spot, Spot::Force(_))), responses.clone()].into_iter().chain(each);
        let explained = |channels: Vec<usize>| {
            let misread = screen.with_run_misread(self.run, &channels)?;
            let placing = best(&misread);
            let excess = misread.last_parameter(&placing)?;
            Some((placing.chi_square / misread.count().max(1) as f64, excess))
        };
        let likeliest = kinds.filter_map(explained).min_by(|a, b| a.0.total_cmp(&b.0));
        likeliest.is_some_and(|(left, excess)| left < ALIKE * self.left && excess.abs() > MISREAD)
    }
}

impl ReferenceModel<'_> {
    /// The run, by its number in the project, that does not fit the others whatever the model lacks at one of the places that `screen` sees
    /// from it.
    pub(super) fn unreliable_run(&self, screen: &Screen) -> Option<usize> {
        if !self.data.may_leave_out(1) || self.control.is_late() {
            return None;
        }
        let by_place =
            |suspect: &Suspect, screen: &Screen| suspect.is_plain() || suspect.is_misread(screen, Screen::best_place);
        let alone =
            |suspect: &Suspect, screen: &Screen| suspect.left < NOISE && suspect.is_misread(screen, Screen::no_place);
        let left_out = |best: fn(&Screen) -> Placing, reason: fn(&Suspect, &Screen) -> bool| {
            let enough = best(screen).chi_square > screen.count() as f64;
            enough.then(|| Suspect::left_out(screen, best, reason, self)).flatten()
        };
        let run = left_out(Screen::best_place, by_place).or_else(|| left_out(Screen::no_place, alone));
        run.map(|r| self.data.runs[r].index)
    }
}

impl Outcome<'_> {
    /// The run, by its number in the project, that does not fit the others beside what was found.
    pub(crate) fn unreliable_run(&self) -> Result<Option<usize>, DiagnosisError> {
        let reference = &self.reference;
        if !reference.data.may_leave_out(1) || reference.control.is_late() {
            return Ok(None);
        }
        let best = self.found.by_size.last().map(|sets| &sets.fits[0]);
        let (stated, known) = reference.predictor.stated();
        let all = || Updating::all(stated, known, reference.data);
        let updating =
            if self.found.updated { reference.linearisation.updating.with_scales(Scales::SEARCH) } else { all() };
        let (effects, starts) = best.map_or((&[][..], Vec::new()), |fit| (&fit.effects[..], fit.starts.clone()));
        let Some(beside) = if_possible(reference.updated(&updating, effects, &starts))? else { return Ok(None) };
        let screen = beside.view(best)?.screen;
        if screen.nothing() < NOISE * screen.count() as f64 {
            return Ok(None);
        }
        let reason =
            |suspect: &Suspect, screen: &Screen| suspect.left < FOUND && suspect.is_misread(screen, Screen::no_place);
        let run = Suspect::left_out(&screen, Screen::no_place, reason, &beside);
        Ok(run.map(|r| reference.data.runs[r].index))
    }
}

//! The model with updating parameters that do not stand in for what is missing: moved beside the place, then the law, that leaves
//! least at the measured motion.
//!
//! Beside free forces at a place the model is linear whatever the law, so that it arrives even where a law regressed on the
//! way is far off (friction that sticks). Once a law leaves about as little as free forces, the model is moved beside that:
//! it is the narrower hypothesis.

use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::channels::{ChannelFault, mended};
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search::RegressedSpots;
use crate::diagnosis::selection::short_list::Breadth;
use crate::diagnosis::selection::unreliable::Unreliable;
use crate::diagnosis::updating::parameters::Updating;

/// Steps of the model.
const STEPS: usize = 8;
/// Places beside which alone the model is moved, of each model that this starts from, and its steps there.
const PATHS: usize = 4;
const STEPS_OF_PLACE: usize = 12;
/// Squared residual per datum that a law may leave at the measured motion where the model is close enough to be refined.
const CLOSE: f64 = 2.0;
/// Share of its squared residual to which a step must bring the best place.
const FALLING: f64 = 0.9;
/// How many times what free forces leave the best law may leave where the model is moved beside it.
const BY_LAW: f64 = 2.0;
/// Share of what the best law leaves to which a doubt must bring it.
const RELIEVED: f64 = 0.25;

/// A model whose places were looked at.
struct Seen<'a> {
    reference: ReferenceModel<'a>,
    /// Squared residual that the best law leaves, with its penalty.
    least: f64,
    /// The same of free forces at the best place.
    free: f64,
    /// Laws at their places, best first.
    unfitted: Vec<UnfittedSet>,
    /// Standardised updating parameters that fit beside the best law or, where laws are far off, place.
    target: Vec<f64>,
    by_law: bool,
    /// Whether the best place is a response channel.
    at_channel: bool,
    /// Laws that were regressed, by spot.
    regressed: RegressedSpots,
}

impl<'a> Seen<'a> {
    /// The same model with all laws at all places that may be the best.
    fn seen_wider(self) -> Result<Seen<'a>, DiagnosisError> {
        self.reference.seen(Breadth::All, self.regressed)
    }

    /// How far the next step from `self` brought it to `there`, as a share of what was left.
    fn progress(&self, there: &Self) -> f64 {
        let by_law = there.least / self.least;
        if self.by_law { by_law } else { by_law.min(there.free / self.free) }
    }
}

impl<'a> ReferenceModel<'a> {
    /// The model with the updating parameters that fit best beside what leaves least at the measured motion, and the laws
    /// regressed there, best first; or the run or channel that does not fit the others, whatever the law.
    pub(crate) fn localised(
        &self,
    ) -> Result<Result<(ReferenceModel<'a>, Vec<UnfittedSet>), Unreliable>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let rigid = self.updated(&Updating::all(stated, known, self.data), &[], &Vec::new())?;
        if let Some(unreliable) = rigid.plainly_unreliable()? {
            return Ok(Err(unreliable));
        }
        let mut here = self.moved_beside(rigid)?;
        if here.least.min(here.free) > CLOSE * self.count() as f64
            && let Some(updating) = self.best_path(&here)?
        {
            let there = self.moved_beside(self.updated(&updating, &[], &Vec::new())?)?;
            here = if there.least < here.least { there } else { here };
        }
        if let Some(fault) = self.doubted(&here)? {
            return Ok(Err(Unreliable::Channel(fault)));
        }
        Ok(Ok((here.reference, here.unfitted)))
    }

    /// The run or the channel that plainly does not fit the others, whatever this model lacks at one place.
    fn plainly_unreliable(&self) -> Result<Option<Unreliable>, DiagnosisError> {
        let screen = self.view(None)?.screen;
        if let Some(run) = self.unreliable_run(&screen) {
            return Ok(Some(Unreliable::Run(run)));
        }
        Ok(self.unreliable_channel(&screen)?.map(Unreliable::Channel))
    }

    /// The model moved on from `updated` beside what leaves least at each step.
    fn moved_beside(&self, updated: ReferenceModel<'a>) -> Result<Seen<'a>, DiagnosisError> {
        // Laws of many parameters take long: they are looked at where the others lead no further.
        let mut breadth = Breadth::Near;
        let mut here = updated.seen(breadth, RegressedSpots::new())?;
        for _ in 0..STEPS {
            if here.least < CLOSE * self.count() as f64 || self.control.is_late() {
                break;
            }
            let moved = self.updated(&here.reference.towards(&here.target), &[], &Vec::new());
            let Some(there) = if_possible(moved)? else { break };
            let there = there.seen(breadth, RegressedSpots::new())?;
            let progress = here.progress(&there);
            if progress < 1.0 {
                here = there;
            }
            if progress < FALLING {
                continue;
            }
            if breadth == Breadth::All {
                break;
            }
            breadth = Breadth::All;
            let least = here.least;
            here = here.seen_wider()?;
            // The laws that were looked at lead no further than they did.
            if here.least > FALLING * least {
                break;
            }
        }
        if breadth == Breadth::Near && !self.control.is_late() {
            here = here.seen_wider()?;
        }
        Ok(here)
    }

    /// Where the model ends that is moved beside free forces at one place alone, of those that leave least to begin with; none where none
    /// comes nearer than `here`. A descent along whatever place leaves least at each step may lead from one false place to the next.
    fn best_path(&self, here: &Seen<'a>) -> Result<Option<Updating>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let rigid = Updating::all(stated, known, self.data);
        let mut starts = vec![rigid.clone(), here.reference.linearisation.updating.clone()];
        starts.extend(rigid.giving_way());
        let mut paths: Vec<(&Updating, usize)> = Vec::new();
        for start in &starts {
            let Some(reference) = if_possible(self.updated(start, &[], &Vec::new()))? else { continue };
            let placings = reference.view(None)?.screen.singles();
            paths.extend(placings.iter().take(PATHS).map(|placing| (start, placing.spots[0])));
        }
        let follow = |k: usize| self.moved_beside_place(paths[k].0.clone(), paths[k].1);
        let ends = self.control.map(paths.len(), follow).into_iter().collect::<Result<Vec<_>, _>>()?;
        let least = ends.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(least.filter(|(left, _)| *left < FALLING * here.free).map(|(_, updating)| updating))
    }

    /// The updating parameters that fit best beside free forces at the place number `spot`, from `updating` on, with what these leave.
    pub(super) fn moved_beside_place(
        &self,
        mut updating: Updating,
        spot: usize,
    ) -> Result<Option<(f64, Updating)>, DiagnosisError> {
        let mut best: Option<(f64, Updating)> = None;
        for _ in 0..STEPS_OF_PLACE {
            let Some(reference) = if_possible(self.updated(&updating, &[], &Vec::new()))? else { break };
            let screen = reference.view(None)?.screen;
            let left = screen.left_by(spot);
            let slow = best.as_ref().is_some_and(|(least, _)| left > FALLING * least);
            if best.as_ref().is_none_or(|(least, _)| left < *least) {
                best = Some((left, updating));
            }
            if slow || left < self.count() as f64 || self.control.is_late() {
                break;
            }
            updating = reference.towards(&screen.updated(&[spot]));
        }
        Ok(best)
    }

    /// This model with what the best law leaves, of which some were `regressed` before.
    fn seen(self, breadth: Breadth, regressed: RegressedSpots) -> Result<Seen<'a>, DiagnosisError> {
        let mut view = self.view(None)?;
        view.regressed = regressed;
        let mut unfitted = self.unfitted(&mut view, &[], breadth)?;
        unfitted.extend(self.whole_sets(&view).into_iter().map(|(set, _)| set));
        unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
        let placings = view.screen.singles();
        let free = placings.first().map_or(f64::INFINITY, |p| p.chi_square);
        let least = unfitted.first().map_or(f64::INFINITY, |best| best.score);
        let by_law = least < BY_LAW * free;
        let target = match (unfitted.first(), placings.first()) {
            (Some(best), _) if by_law => self.updated_beside(&mut view, best)?,
            (_, Some(place)) => Some(view.screen.updated(&place.spots)),
            _ => None,
        };
        let at_channel = placings.first().is_some_and(|p| matches!(view.screen.spots[p.spots[0]], Spot::Response(_)));
        let regressed = view.regressed;
        let target = target.unwrap_or_else(|| self.linearisation.updating.standardised());
        Ok(Seen { target, reference: self, least, free, by_law, at_channel, unfitted, regressed })
    }

    /// Whether a law regressed beside the model as it is would bring `evidence`.
    pub(super) fn is_law_expected(&self, evidence: f64) -> Result<bool, DiagnosisError> {
        let mut view = self.view(None)?;
        let bound = view.screen.nothing() - evidence;
        let unfitted = self.unfitted(&mut view, &[], Breadth::All)?;
        let whole = self.whole_sets(&view).into_iter().map(|(set, _)| set);
        Ok(unfitted.into_iter().chain(whole).any(|unfitted| unfitted.score < bound))
    }

    /// The channel whose readings, taken to scatter from run to run, let a law leave far less than any does while all channels
    /// are relied on; none where a law comes near.
    fn doubted(&self, here: &Seen) -> Result<Option<ChannelFault>, DiagnosisError> {
        let noise = CLOSE * self.count() as f64;
        let close = here.least < noise && here.by_law;
        let placed = here.free < noise && !here.at_channel;
        if close || placed || self.control.is_late() {
            return Ok(None);
        }
        let (before, determinant) = (here.least, here.reference.noise_determinant());
        let mut best: Option<(f64, ChannelFault)> = None;
        for fault in here.reference.suspects()? {
            let data = mended(self.data, std::slice::from_ref(&fault));
            let doubting = self.with_data(&data);
            let updated = doubting.updated(&here.reference.linearisation.updating, &[], &Vec::new())?;
            let seen = doubting.moved_beside(updated)?;
            let after = seen.least + seen.reference.noise_determinant() - determinant;
            let relieved = after < RELIEVED * before;
            if relieved && best.as_ref().is_none_or(|(least, _)| after < *least) {
                best = Some((after, fault));
            }
        }
        Ok(best.map(|(_, fault)| fault))
    }
}

//! The model with updating parameters that do not stand in for what is missing: moved beside the place, then the law, that leaves
//! least at the measured motion.
//!
//! Beside free forces at a place the model is linear whatever the law, so that it arrives even where a law regressed on the
//! way is far off (friction that sticks). Once a law leaves about as little as free forces, the model is moved beside that:
//! it is the narrower hypothesis.

use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::channels::{ChannelFault, Fault, mended};
use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search::{RegressedSpots, View};
use crate::diagnosis::selection::short_list::Breadth;
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
/// Channels that may be doubted, among the places that leave least.
const DOUBTED: usize = 4;
/// Share of what the best law leaves to which a doubt must bring it.
const RELIEVED: f64 = 0.5;
/// Share of its squared free errors which a gain or a delay may leave of a channel that is steady from run to run: then most of
/// them is the same in all runs, which looseness is not.
const STEADY: f64 = 0.25;
/// Bounds of the scatter of a doubted channel.
const SCATTER: [f64; 2] = [0.02, 0.3];

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
    /// Response channels among the best places, with the scatter of what they read, relative.
    suspects: Vec<(String, f64)>,
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
    /// regressed there, best first; or the channel that does not fit the others, whatever the law.
    pub(crate) fn localised(
        &self,
    ) -> Result<Result<(ReferenceModel<'a>, Vec<UnfittedSet>), ChannelFault>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let mut here = self.moved_beside(Updating::all(stated, known, self.data))?;
        if here.least.min(here.free) > CLOSE * self.count() as f64
            && let Some(updating) = self.best_path(&here)?
        {
            let there = self.moved_beside(updating)?;
            here = if there.least < here.least { there } else { here };
        }
        if let Some(fault) = self.doubted(&here)? {
            return Ok(Err(fault));
        }
        Ok(Ok((here.reference, here.unfitted)))
    }

    fn moved_beside(&self, updating: Updating) -> Result<Seen<'a>, DiagnosisError> {
        // Laws of many parameters take long: they are looked at where the others lead no further.
        let mut breadth = Breadth::Near;
        let mut here = self.updated(&updating, &[], &Vec::new())?.seen(breadth, RegressedSpots::new())?;
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
    fn moved_beside_place(
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
        let near = placings.iter().take(DOUBTED).map(|p| p.spots[0]);
        let suspects = near.filter_map(|spot| self.suspect(&view, spot, &unfitted)).collect();
        let regressed = view.regressed;
        let target = target.unwrap_or_else(|| self.linearisation.updating.standardised());
        Ok(Seen { target, reference: self, least, free, by_law, at_channel, unfitted, suspects, regressed })
    }

    /// The response channel of `spot` with the scatter of its free errors; none where they are of one gain or delay, which is no
    /// scatter from run to run.
    fn suspect(&self, view: &View, spot: usize, unfitted: &[UnfittedSet]) -> Option<(String, f64)> {
        let Spot::Response(name) = &view.screen.spots[spot] else { return None };
        let place = view.screen.spots[spot].place();
        let (forces, fields) = self.free(view, &[spot]);
        let law = unfitted.iter().find(|d| d.effects[0].place.is_same(&place));
        let steady = law.is_some_and(|law| {
            let expected = self.at_place(view, spot, &forces[0], &fields).forces_of(&law.effects[0]);
            let pairs =
                || forces[0].iter().zip(expected.iter().flatten()).filter_map(|(f, e)| f.first().zip(e.first()));
            let left: f64 = pairs().map(|(free, error)| (free.value - error).norm_sqr()).sum();
            left < STEADY * pairs().map(|(free, _)| free.value.norm_sqr()).sum::<f64>()
        });
        (!steady).then(|| (name.clone(), scatter(&forces[0])))
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
    /// are relied on; none where a law comes near, or where only two channels are.
    fn doubted(&self, here: &Seen) -> Result<Option<ChannelFault>, DiagnosisError> {
        let [responses, _] = self.data.channel_names();
        let noise = CLOSE * self.count() as f64;
        let close = here.least < noise && here.by_law;
        let placed = here.free < noise && !here.at_channel;
        if close || placed || responses.len() < 3 || self.control.is_late() {
            return Ok(None);
        }
        let before = here.least + self.noise_determinant();
        let mut best: Option<(f64, ChannelFault)> = None;
        for (name, scatter) in &here.suspects {
            let fault = unreliable(name, *scatter);
            let data = mended(self.data, std::slice::from_ref(&fault));
            let reference = ReferenceModel { data: &data, early: &|_| {}, ..self.shallow() };
            let seen = reference.moved_beside(here.reference.linearisation.updating.clone())?;
            let after = seen.least + seen.reference.noise_determinant() - here.reference.noise_determinant()
                + self.noise_determinant();
            let relieved = after - before < -(1.0 - RELIEVED) * here.least;
            if relieved && best.as_ref().is_none_or(|(least, _)| after < *least) {
                best = Some((after, fault));
            }
        }
        Ok(best.map(|(_, fault)| fault))
    }

    /// `ln det` of the noise of all runs.
    fn noise_determinant(&self) -> f64 {
        self.noise.runs.iter().map(crate::diagnosis::residual::whitening::Whitening::log_determinant).sum()
    }
}

/// Root mean square of the free relative errors of a channel.
fn scatter(errors: &[Vec<FreeForce>]) -> f64 {
    let first: Vec<f64> = errors.iter().filter_map(|list| list.first()).map(|free| free.value.norm()).collect();
    crate::math::statistics::root_mean_square(&first).clamp(SCATTER[0], SCATTER[1])
}

fn unreliable(name: &str, scatter: f64) -> ChannelFault {
    ChannelFault {
        fault: Fault::Unreliable(scatter),
        channels: vec![name.to_owned()],
        error_before: scatter,
        error_after: scatter,
        own_error: [scatter, scatter],
        frequencies: [0, 0],
    }
}

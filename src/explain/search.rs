//! The search for one more effect, or two at once: places first, then laws, then the fit on the response.

use super::compare::transfers;
use super::data::{Data, ExplainError};
use super::law::PlaceData;
use super::noise::Whitening;
use super::place::{Placing, Screen};
use super::predict::{FINAL, Predictor, RunPrediction, SEARCH};
use super::refit::{Bench, Refit};
use super::spots::{Receptances, Spot};
use crate::control::Control;
use crate::effects::{Effect, Place, Source, State, effect::Kind};
use crate::math::statistics::bayesian_information;

/// Places whose laws are looked at.
const PLACES: usize = 24;
/// Pairs of places whose laws are looked at.
const PAIRS: usize = 16;
/// Sets that are fitted on the response.
const REFITS: usize = 9;
/// Most laws of one place that are fitted on the response.
const LAWS_AT_ONE_PLACE: usize = 4;
/// Steps of a fit on the response.
const STEPS: usize = 12;

/// A set of effects with its score before it is fitted on the response.
#[derive(Debug, Clone)]
pub(crate) struct Draft {
    pub effects: Vec<Source>,
    pub score: f64,
}

/// Everything that a search needs about one base model.
pub(crate) struct Base<'a> {
    pub predictor: &'a Predictor,
    pub data: &'a Data,
    pub control: &'a Control,
    /// Predictions of the base model.
    pub predictions: Vec<RunPrediction>,
    /// Noise of the residuals.
    pub noise: Vec<Whitening>,
}

impl<'a> Base<'a> {
    /// The known model itself.
    pub fn new(predictor: &'a Predictor, data: &'a Data, control: &'a Control) -> Result<Self, ExplainError> {
        let bench = Bench { predictor, data, noise: &[], control };
        let predictions = bench.predict(&[], &FINAL, &[])?;
        let mut base = Self { predictor, data, control, predictions, noise: Vec::new() };
        base.noise = base.whitenings(&[], &base.predictions)?;
        Ok(base)
    }

    /// Noise of the residual of a model with `effects` and its predictions.
    pub fn whitenings(&self, effects: &[Source], of: &[RunPrediction]) -> Result<Vec<Whitening>, ExplainError> {
        let runs = self.data.runs.iter().enumerate();
        runs.map(|(r, run)| {
            let file = format!("number {}", run.index + 1);
            let failed = |reason| ExplainError::Response { file, reason };
            let a = transfers(self.predictor, r, run, effects, self.control).map_err(failed)?;
            Ok(Whitening::new(run, &a, &of[r].truncation))
        })
        .collect()
    }

    /// What fits on the response are made with.
    pub fn bench(&self) -> Bench<'_> {
        Bench { predictor: self.predictor, data: self.data, noise: &self.noise, control: self.control }
    }

    /// Number of real data.
    pub fn count(&self) -> usize {
        self.noise.iter().map(Whitening::len).sum()
    }

    /// The residual of the known model with `effects` seen from every place.
    fn screen(&self, effects: &[Source]) -> Result<(Screen, Receptances<'a>), ExplainError> {
        let mut receptances = Receptances::new(self.predictor, self.data, effects);
        let own;
        let predictions = if effects.is_empty() {
            &self.predictions
        } else {
            own = self.bench().predict(effects, &SEARCH, &[])?;
            &own
        };
        let args = (self.predictor, self.data, &self.noise);
        let screen = Screen::new(args.0, args.1, predictions, args.2, &mut receptances, self.control)?;
        Ok((screen, receptances))
    }

    /// Sets of `effects` and one more, fitted on the response, best first by evidence.
    pub fn singles(&self, effects: &[Source]) -> Result<Vec<Refit>, ExplainError> {
        let (screen, mut receptances) = self.screen(effects)?;
        let mut drafts = Vec::new();
        for placing in screen.singles().into_iter().take(PLACES) {
            self.control.check()?;
            for options in self.laws(&screen, &mut receptances, &placing, effects)? {
                drafts.extend(options.into_iter().map(|d| Draft { score: d.score + placing.chi_square, ..d }));
            }
        }
        let mut drafts = short_list(drafts, REFITS);
        drafts.iter_mut().for_each(|d| d.effects = joined(effects, &d.effects));
        let mut refits = self.refit_all(&drafts)?;
        refits.extend(self.whole(effects)?);
        Ok(self.ranked(refits))
    }

    /// Sets of two new effects at the pairs of places that explain most.
    pub fn pairs(&self, effects: &[Source]) -> Result<Vec<Refit>, ExplainError> {
        let (screen, mut receptances) = self.screen(effects)?;
        let mut drafts = Vec::new();
        for placing in screen.pairs(PAIRS) {
            self.control.check()?;
            let options = self.laws(&screen, &mut receptances, &placing, effects)?;
            let [first, second] = &options[..] else { continue };
            for a in first.iter().take(3) {
                for b in second.iter().take(3) {
                    let score = placing.chi_square + a.score + b.score;
                    drafts.push(Draft { effects: joined(&a.effects, &b.effects), score });
                }
            }
        }
        drafts.sort_by(|a, b| a.score.total_cmp(&b.score));
        drafts.truncate(REFITS);
        drafts.iter_mut().for_each(|d| d.effects = joined(effects, &d.effects));
        Ok(self.ranked(self.refit_all(&drafts)?))
    }

    /// The free force of the place of `source` when the model has `others`; none for whole-structure laws.
    pub fn place_data(&self, others: &[Source], source: &Source) -> Result<Option<PlaceData>, ExplainError> {
        let (screen, mut receptances) = self.screen(others)?;
        let Some(at) = screen.spots.iter().position(|spot| spot.place().is_same(&source.place)) else {
            return Ok(None);
        };
        let spots = vec![screen.spots[at].clone()];
        if let Spot::Leg(leg) = spots[0] {
            receptances.need_leg(leg, self.control)?;
        }
        Ok(Some(PlaceData::new(&receptances, self.data, &spots, &screen.forces(&[at]), 0)))
    }

    /// Fits the drafts on the response.
    pub fn refit_all(&self, drafts: &[Draft]) -> Result<Vec<Refit>, ExplainError> {
        drafts.iter().map(|draft| self.bench().refit(&draft.effects, STEPS, &SEARCH)).collect()
    }

    /// Laws fitted to the free forces of each spot of a placing, best first; the score is their misfit with its penalty.
    fn laws(
        &self,
        screen: &Screen,
        receptances: &mut Receptances,
        placing: &Placing,
        effects: &[Source],
    ) -> Result<Vec<Vec<Draft>>, ExplainError> {
        let spots: Vec<Spot> = placing.spots.iter().map(|&s| screen.spots[s].clone()).collect();
        for spot in &spots {
            if let Spot::Leg(leg) = spot {
                receptances.need_leg(*leg, self.control)?;
            }
        }
        let forces = screen.forces(&placing.spots);
        let mut all = Vec::with_capacity(spots.len());
        for own in 0..spots.len() {
            let data = PlaceData::new(receptances, self.data, &spots, &forces, own);
            let fits = Effect::ALL.into_iter().filter_map(|effect| data.fit(effect));
            let fresh = fits.filter(|fit| !effects.iter().any(|e| e.is_same(&fit.source)));
            let mut drafts: Vec<Draft> = fresh
                .map(|fit| {
                    let score = bayesian_information(fit.misfit, fit.source.parameters.len(), data.count());
                    Draft { effects: vec![fit.source], score }
                })
                .collect();
            drafts.sort_by(|a, b| a.score.total_cmp(&b.score));
            all.push(drafts);
        }
        Ok(all)
    }

    /// The laws of the whole structure, each from a light and a heavy start.
    fn whole(&self, effects: &[Source]) -> Result<Vec<Refit>, ExplainError> {
        let mut found = Vec::new();
        for effect in Effect::ALL.into_iter().filter(|e| matches!(e.kind(), Kind::Whole(_))) {
            let place = Place::Whole(None);
            if effects.iter().any(|e| e.effect == effect) {
                continue;
            }
            let omega = self.data.runs.iter().map(|r| r.omega.ln()).sum::<f64>() / self.data.runs.len() as f64;
            let unit = match effect {
                Effect::StiffnessProportional => (-omega).exp(),
                Effect::MassProportional => omega.exp(),
                _ => 1.0,
            };
            let start = Source { effect, place, state: State::Known, parameters: vec![3e-3 * unit] };
            found.push(self.bench().refit(&joined(effects, &[start]), STEPS, &SEARCH)?);
        }
        Ok(found)
    }

    /// Information criterion of a fit, its squared residual scaled by what the best model leaves beyond the noise.
    pub fn evidence(&self, refit: &Refit, scale: f64) -> f64 {
        bayesian_information(refit.chi_square / scale.max(1.0), refit.parameters, self.count())
    }

    /// Best first; what is over-fitted twice is left out.
    fn ranked(&self, mut refits: Vec<Refit>) -> Vec<Refit> {
        refits.retain(|r| r.chi_square.is_finite());
        let scale = scale_of(&refits, self.count());
        refits.sort_by(|a, b| self.evidence(a, scale).total_cmp(&self.evidence(b, scale)));
        refits
    }
}

/// Squared residual per datum of the best fit, at least 1.
pub(crate) fn scale_of(refits: &[Refit], count: usize) -> f64 {
    let least = refits.iter().map(|r| r.chi_square / count.saturating_sub(r.parameters).max(1) as f64);
    least.fold(f64::INFINITY, f64::min).clamp(1.0, 1e12)
}

fn joined(first: &[Source], second: &[Source]) -> Vec<Source> {
    first.iter().chain(second).cloned().collect()
}

/// The best drafts, no more than a few at one place.
fn short_list(mut drafts: Vec<Draft>, most: usize) -> Vec<Draft> {
    drafts.sort_by(|a, b| a.score.total_cmp(&b.score));
    let mut kept: Vec<Draft> = Vec::new();
    for draft in drafts {
        let here = kept.iter().filter(|k| k.effects[0].place == draft.effects[0].place).count();
        if here < LAWS_AT_ONE_PLACE {
            kept.push(draft);
        }
        if kept.len() == most {
            break;
        }
    }
    kept
}

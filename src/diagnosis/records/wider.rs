//! Laws that contain the one that fits best, begun where they do the same force: a fit that has gone to a law of one parameter does not
//! find from there what makes it another (friction that falls with speed, a slider that gives).

use super::data::RecordError;
use super::evidence::{AGREES, misfit};
use super::fit_motion::FitMotion;
use super::fitted::FittedRecords;
use super::laws::LAWS;
use super::problem::{FitProblem, Free};
use super::rivals::is_same_set;
use super::search::Search;
use crate::effects::{Effect, Leg, Source};
use crate::response::transient::force_along;
use dashpot_numerics::dot;

/// Shapes of a wider law from which fits begin.
const BEGUN: usize = 2;
/// Places of rivals at which the law of the best is tried, and the squared residual over that of the best, or over the noise, up to which
/// they are rivals.
const ELSEWHERE: usize = 2;
const NEAR: f64 = 4.0;

impl Search<'_> {
    /// The best of `found` with its last law replaced by wider ones, from where they leave least; on parts of records none where it
    /// leaves no more than noise.
    pub(super) fn begun_wider(&self, level: usize, found: &[FittedRecords]) -> Result<Vec<FittedRecords>, RecordError> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Ok(Vec::new()) };
        let wider: Vec<Effect> =
            law.effect.wider().into_iter().filter(|e| LAWS.contains(e) && *e != law.effect).collect();
        let explained = misfit(best) < AGREES && level + 1 < self.levels.len();
        if explained || wider.is_empty() || self.control.is_late() {
            return Ok(Vec::new());
        }
        self.begun_as(level, best, &wider)
    }

    /// The law of the best of `found` at the places of its nearest rivals, where it was not tried: what it is and where it acts is
    /// decided together, and a law that was widened at one place only would be sure of that place.
    pub(super) fn begun_elsewhere(
        &self,
        level: usize,
        found: &[FittedRecords],
    ) -> Result<Vec<FittedRecords>, RecordError> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Ok(Vec::new()) };
        let ends = level == 0 || level + 1 == self.levels.len();
        if !ends || self.control.is_late() {
            return Ok(Vec::new());
        }
        let mut places = vec![&law.place];
        let mut starts = Vec::new();
        for rival in found.iter().skip(1).filter(|f| f.chi_square < NEAR * best.chi_square.max(f.count as f64)) {
            let Some(other) = rival.effects.last() else { continue };
            let same_others =
                is_same_set(&rival.effects[..rival.effects.len() - 1], &best.effects[..best.effects.len() - 1]);
            let new = !places.iter().any(|p| p.is_same(&other.place));
            if places.len() > ELSEWHERE || !new || !same_others {
                continue;
            }
            places.push(&other.place);
            let tried = |f: &FittedRecords| {
                f.effects.last().is_some_and(|e| e.effect == law.effect && e.place.is_same(&other.place))
            };
            if !found.iter().any(tried) {
                starts.extend(self.begun_as(level, rival, &[law.effect])?);
            }
        }
        starts.retain(|s| !self.given_up.holds(&s.effects));
        Ok(starts)
    }

    /// `fit` with its last law replaced by others, each in the [`BEGUN`] shapes that leave least, doing the same force along the
    /// motion of the fit.
    fn begun_as(&self, level: usize, fit: &FittedRecords, laws: &[Effect]) -> Result<Vec<FittedRecords>, RecordError> {
        let Some((law, leg)) = fit.effects.last().and_then(|e| Some((e, e.place.legs().first().copied()?))) else {
            return Ok(Vec::new());
        };
        let records = &self.levels[level];
        let motion = FitMotion::new(records, fit, self.control)?;
        let Some(range) = motion.range(leg) else { return Ok(Vec::new()) };
        let alone = self.control.alone();
        let problem = FitProblem { records, free: Free::all(records), share: 1.0, control: &alone };
        let mut starts = Vec::new();
        for &effect in laws {
            let sources: Vec<Source> = effect
                .shapes(&range)
                .into_iter()
                .filter_map(|shape| self.alike(law, effect, shape, (leg, &motion, level)))
                .collect();
            let of = |k: usize| {
                let mut start = fit.clone();
                start.effects.pop();
                start.effects.push(sources[k].clone());
                let left = problem.left(&start).ok()?.chi_square;
                Some((left, start))
            };
            let mut all: Vec<(f64, FittedRecords)> =
                self.control.map(sources.len(), of).into_iter().flatten().collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            starts.extend(all.into_iter().take(BEGUN).map(|(_, start)| start));
        }
        Ok(starts)
    }

    /// A shape of a law scaled so that its force along the motion is that of `law`.
    fn alike(
        &self,
        law: &Source,
        effect: Effect,
        shape: Vec<f64>,
        (leg, motion, level): (Leg, &FitMotion, usize),
    ) -> Option<Source> {
        let mut source = Source { effect, parameters: shape, ..law.clone() };
        let (mut product, mut square) = (0.0, 0.0);
        for (r, record) in self.levels[level].list.iter().enumerate() {
            let [d, v, a] = motion.relative(leg, r)?;
            let along = [&d[..], &v, &a];
            let (own, wanted) = (force_along(&source, along, record.step)?, force_along(law, along, record.step)?);
            product += dot(&own, &wanted);
            square += dot(&own, &own);
        }
        let factor = product / square;
        effect.scaled().iter().for_each(|&k| source.parameters[k] *= factor);
        let allowed = source.parameters.iter().zip(effect.parameters()).all(|(v, p)| p.allows(*v));
        (factor.is_finite() && factor != 0.0 && allowed).then_some(source)
    }
}

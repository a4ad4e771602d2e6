//! Where fits of one effect more begin: what the equation of motion demands along the measured motion, else a grid of all laws.

use super::fit_motion::FitMotion;
use super::fitted::FittedRecords;
use super::localisation::{LocatedForce, locate};
use super::pruning::is_same_set;
use super::regression::{Regressed, Regression};
use super::search::Search;
use crate::effects::{Constant, Effect, Family, Motion, Place, Range, Source, State};
use std::f64::consts::TAU;

/// Places that a free force names, shapes of a law where no equation of motion sizes it.
const PLACES: usize = 2;
const SHAPES: usize = 5;
/// Laws that are fitted at the places that the equation of motion demands, from the best place on.
const QUOTAS: [usize; 3] = [usize::MAX, 3, 2];
/// Laws at other places that the equation of motion demands next.
const NEXT: usize = 4;
/// Places of a mass and of a spring that are fitted whatever else the equation of motion demands.
const CONSTANTS: usize = 2;
/// Starts by regression beside those that are scored, on the shortest parts and on longer ones.
const REGRESSED: [usize; 2] = [24, 8];
/// Share of what the equation of motion of several modes leaves that one effect more must take away, or none is looked for.
const NEEDED: f64 = 0.8;
/// Misfit of the equation of motion over the least one beyond which a law is not fitted to the response, at the best place and at
/// others.
const BEHIND: [f64; 2] = [16.0, 4.0];
/// Squared residual of a simpler law over that of the best up to which its fit has ended.
const ENDED: f64 = 1.02;
/// Force of a law at the start, as a share of the spring force there.
const SIZES: [f64; 2] = [0.01, 0.1];

impl Search<'_> {
    /// Fits that are to be begun, one law more each.
    pub(super) fn begun(&self, level: usize, best: &FittedRecords, base: &FittedRecords) -> Vec<FittedRecords> {
        let regression = Regression::new(self.records, base, self.control);
        let mut sources = self.beginnings(level, best, base, regression.as_ref());
        if regression.is_some() {
            sources.truncate(REGRESSED[usize::from(level > 0)]);
        }
        let start_with_law = |k: usize| {
            if let Some(regression) = &regression {
                return self.in_best_states(level, regression.tuned(base, Some(&sources[k])));
            }
            let mut start = base.clone();
            start.effects.push(sources[k].clone());
            start
        };
        self.control.map(sources.len(), start_with_law)
    }

    /// Laws at places from which fits begin: those that the equation of motion demands, else a grid of all.
    fn beginnings(
        &self,
        level: usize,
        best: &FittedRecords,
        base: &FittedRecords,
        regression: Option<&Regression<'_>>,
    ) -> Vec<Source> {
        // One mode alone shows no mass or spring beside its own stiffness.
        let seen = |s: &Source| self.records.kept > 1 || !s.effect.is_mass_or_spring();
        let open = |s: &Source| seen(s) && !base.effects.iter().chain(self.excluded).any(|e| e.is_same(s));
        let all = self.all_places();
        let located = self.places(best);
        let Some(regression) = regression else {
            let starts_at_place = |place: &Place| {
                let range = self.range(level, base, place);
                self.laws.iter().flat_map(move |&effect| self.starts(effect, place, &range)).collect::<Vec<Source>>()
            };
            return located.iter().flat_map(starts_at_place).filter(open).collect();
        };
        let mut ranked = regression.ranked(&all, &self.laws, self.control);
        ranked.retain(|r| open(&r.source));
        let least = ranked.first().map_or(0.0, |r| r.misfit);
        if !best.effects.is_empty() && self.records.kept > 1 && least > NEEDED * regression.misfit() {
            return Vec::new();
        }
        // At the best place more laws are fitted: what rises and falls with the amplitude is not told apart here.
        let place = ranked.first().map(|r| r.source.place.clone());
        let best_place = |r: &Regressed| place.as_ref().is_some_and(|p| p.is_same(&r.source.place));
        // Masses and springs look like the errors of the shapes that are taken out: only a fit tells them.
        let constant = |kind: Constant| {
            ranked.iter().filter(move |r| r.source.effect.adds_to(kind)).take(CONSTANTS).map(|r| r.source.clone())
        };
        let constants: Vec<Source> = constant(Constant::Mass).chain(constant(Constant::Stiffness)).collect();
        let near = |r: &Regressed, behind: f64| r.misfit <= (behind * least).max(regression.rows() as f64);
        ranked.retain(|r| near(r, BEHIND[usize::from(!best_place(r))]));
        let mut places: Vec<&Place> = Vec::new();
        for place in ranked.iter().map(|r| &r.source.place) {
            if places.len() < QUOTAS.len() && !places.iter().any(|p| p.is_same(place)) {
                places.push(place);
            }
        }
        let next = ranked.iter().filter(|r| !places.iter().any(|p| p.is_same(&r.source.place))).take(NEXT);
        let next: Vec<Source> = next.map(|r| r.source.clone()).collect();
        let quotas = places.iter().copied().zip(QUOTAS);
        let more =
            located.iter().filter(|p| !places.iter().any(|q| q.is_same(p))).map(|p| (p, QUOTAS[QUOTAS.len() - 1]));
        let best_at_place = |(place, quota): (&Place, usize)| {
            ranked
                .iter()
                .filter(|r| r.source.place.is_same(place))
                .take(quota)
                .map(|r| r.source.clone())
                .collect::<Vec<_>>()
        };
        let mut sources: Vec<Source> = quotas.chain(more).flat_map(best_at_place).collect();
        let further =
            next.into_iter().chain(constants).filter(|n| !sources.iter().any(|s| s.is_same(n))).collect::<Vec<_>>();
        sources.extend(further);
        sources
    }

    /// The best of `found` with each special case of its last law in place of that, where none is among them yet or one that was cut
    /// off far from where it ends: a slider whose spring is stiff, or a power law of exponent 1, says less plainly what a law of one
    /// parameter says.
    pub(super) fn special_case_starts(&self, level: usize, found: &[FittedRecords]) -> Vec<FittedRecords> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Vec::new() };
        let taken = |s: &Source| best.effects.iter().chain(self.excluded).any(|e| e.is_same(s));
        let allowed = |s: &Source| s.parameters.iter().zip(s.effect.parameters()).all(|(v, p)| p.allows(*v));
        let simpler: Vec<Source> =
            law.limits().filter(|s| self.laws.contains(&s.effect) && !taken(s) && allowed(s)).collect();
        if simpler.is_empty() {
            return Vec::new();
        }
        let motion = FitMotion::new(&self.levels[level], best, self.control).ok();
        let leg = law.place.legs().first().copied();
        // Far from the limit its own size is that at a speed or distance of one, which no motion need have.
        let of_its_force = |source: Source| {
            let along = leg
                .zip(motion.as_ref())
                .and_then(|(leg, motion)| self.with_equal_force(law, source.clone(), leg, motion, level));
            along.unwrap_or(source)
        };
        let in_place = |source: Source| {
            let mut start = best.clone();
            start.effects.pop();
            start.effects.push(source);
            start
        };
        let problem = self.problem(level, 1.0);
        let leaves_less = |start: &FittedRecords| {
            let same = |f: &&FittedRecords| is_same_set(&f.effects, &start.effects);
            let Some(own) = found.iter().find(same) else { return true };
            let ended = own.chi_square < ENDED * best.chi_square;
            !ended && problem.left(start).is_ok_and(|left| left.chi_square < own.chi_square)
        };
        simpler.into_iter().map(of_its_force).map(in_place).filter(leaves_less).collect()
    }

    /// Every place where a law may act.
    pub(super) fn all_places(&self) -> Vec<Place> {
        let structure = self.records.structure;
        Family::EachTranslation.places(structure).into_iter().chain(Family::EachPair.places(structure)).collect()
    }

    /// Places that matter beside what is in `best`, most likely first.
    fn places(&self, best: &FittedRecords) -> Vec<Place> {
        let mut all = self.all_places();
        // Corrections may have been bent to what is missing: the model is asked as it is, too.
        let located: Vec<LocatedForce> = locate(self.records, &all, best.stiffness);
        if located.is_empty() {
            all.truncate(2 * PLACES);
            return all;
        }
        let plain = locate(self.records, &all, 0.0);
        let mut places: Vec<Place> = Vec::new();
        for one in located.into_iter().take(PLACES).chain(plain.into_iter().take(PLACES)) {
            if !places.contains(&one.place) {
                places.push(one.place);
            }
        }
        places
    }

    /// Circular frequency (rad/s) at which a mode moves: its own, that of the motion where it moves as a rigid body.
    fn rate(&self, mode: usize) -> f64 {
        let own = self.records.modes.omega[mode];
        if own > 0.0 { own } else { TAU * self.records.list[0].dominant_hz }
    }

    /// Compliance of the structure along a place, m/N: static, but where it moves as a rigid body.
    fn compliance(&self, place: &Place) -> f64 {
        let (modes, legs) = (&self.records.modes, place.legs());
        let shape = |r: usize| legs.first().map_or(0.0, |leg| leg.relative(|i| modes.shapes[(i, r)]));
        (0..self.records.kept).map(|r| (shape(r) / self.rate(r)).powi(2)).sum()
    }

    /// Range of the motion at a place in the parts of the records.
    fn range(&self, level: usize, base: &FittedRecords, place: &Place) -> Range {
        let (modes, kept) = (&self.records.modes, self.records.kept);
        let legs = place.legs();
        let shape = |r: usize| legs.first().map_or(0.0, |leg| leg.relative(|i| modes.shapes[(i, r)]));
        let flexible = self.compliance(place);
        let sizes = |initial: &Vec<f64>| -> [f64; 2] {
            let amplitude_of_mode = |r: usize| shape(r).abs() * initial[r].hypot(initial[kept + r]);
            let d: f64 = (0..kept).map(amplitude_of_mode).sum();
            [d, (0..kept).map(|r| amplitude_of_mode(r) * self.rate(r)).sum()]
        };
        let mut all: Vec<[f64; 2]> = base.initial.iter().map(sizes).collect();
        for (record, size) in self.levels[level].list.iter().zip(&mut all) {
            // Driven records begin at rest: the static motion under the largest force stands for theirs, ten times raised.
            let force = record.forces.iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
            let driven = 3.0 * force * flexible;
            *size = [size[0].max(driven), size[1].max(driven * TAU * record.dominant_hz)];
        }
        let most = |k: usize| all.iter().map(|s| s[k]).fold(1e-12, f64::max);
        let least = all.iter().map(|s| s[0]).fold(f64::INFINITY, f64::min).max(1e-13);
        let omega = TAU * self.records.list[0].dominant_hz;
        Range { displacement: most(0), least, velocity: most(1), omega }
    }

    /// Starts of a law at a place: shapes, sized to a share of the spring force there.
    fn starts(&self, effect: Effect, place: &Place, range: &Range) -> Vec<Source> {
        let flexible = self.compliance(place);
        let (Some(law), true) = (effect.law(), flexible > 0.0) else { return Vec::new() };
        let spring = range.displacement / flexible;
        let motion = Motion::cosine(range.velocity / range.displacement, range.displacement, 64);
        let all = effect.shapes(range);
        let every = all.len().div_ceil(SHAPES);
        let mut starts = Vec::new();
        for shape in all.into_iter().step_by(every) {
            let mut force = vec![0.0; motion.len()];
            law.force(&shape, &motion, &mut force);
            let peak = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            for size in SIZES {
                let mut parameters = shape.clone();
                let factor = size * spring / peak.max(f64::MIN_POSITIVE);
                // A unit slider of this shape may not yield: then its own force sets the scale.
                effect.scaled().iter().for_each(|&k| parameters[k] *= factor);
                if parameters.iter().zip(law.parameters()).all(|(v, p)| p.allows(*v)) {
                    starts.push(Source { effect, place: place.clone(), state: State::Known, parameters });
                }
            }
        }
        starts
    }
}

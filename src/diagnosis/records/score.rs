//! What one law more at a place would take away of what a fit leaves, to first order (score test: Rao 1948).
//!
//! ```text
//! w = d y / d c at c = 0:  the linear model's record under the force of the law along the motion of the fit, c = 1
//! c = (w^T e - b^T A^-1 g) / (w^T w - b^T A^-1 b),      gain = c (w^T e - b^T A^-1 g)
//! ```
//!
//! `e` is what the fit leaves over the noise, `A` and `g` its normal equations, `b` the products of `w` with its derivatives:
//! corrections, shapes, offsets and initial states are free beside the law. No motion is expanded from few sensors, and a law that
//! is weak beside the errors of the model is weighed as the fit itself will weigh it; a fit that has lost the phase tells nothing.

use super::data::{RecordData, RecordDiagnosisError, Records};
use super::evidence::{evidence, scale};
use super::fit_motion::{FitMotion, MotionOfDof};
use super::fitted::FittedRecords;
use super::normal_equations::RecordDerivatives;
use super::problem::{FitProblem, Free};
use super::pruning::{MOST_OF_FAMILY, are_of_one_family};
use super::regression::foremost;
use super::search::Search;
use super::steps::Steps;
use super::variables::scales;
use crate::effects::{Effect, Leg, Place, Source, State};
use crate::response::transient::{Hold, TransientModel, TransientSetup, force_along};
use dashpot_numerics::{EquilibratedCholesky, dot};

/// Samples of all channels of a record that are looked at, about.
const MOST_SAMPLES: usize = 5000;
/// Share of the diagonal that is added to the normal equations, which need not tell all.
const RIDGE: f64 = 1e-9;

/// Starts that are taken, and how many of them may be of one law or at one place.
const TAKEN: usize = 10;
const MOST_ALIKE: usize = 3;
/// Shares of the way to where a law promises most at which a fit may begin.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];

/// A law at a place with the coefficient that fits best.
#[derive(Debug, Clone)]
pub(super) struct Scored {
    /// Effect, place and parameters.
    pub source: Source,
    /// Drop of the squared residual over the noise, to first order.
    pub gain: f64,
    /// Change of all variables of the fit that goes with it.
    change: Vec<f64>,
}

/// A fit with its equations, beside which laws are weighed.
pub(super) struct ScoreTest<'a> {
    records: &'a Records<'a>,
    fit: &'a FittedRecords,
    /// Sources of the linear part of the model.
    linear: Vec<Source>,
    motion: FitMotion,
    thinned: Vec<Thinned>,
    factored: EquilibratedCholesky,
    /// `A^-1 g`.
    step: Vec<f64>,
}

/// Derivatives of a record, of its samples one of `every`.
struct Thinned {
    derivatives: RecordDerivatives,
    every: usize,
}

impl<'a> ScoreTest<'a> {
    /// Of a fit on the records of `problem`, with what is free there.
    ///
    /// # Errors
    /// [`RecordDiagnosisError`]: a model that cannot be predicted, equations without a solution.
    pub(super) fn new(problem: &'a FitProblem<'a>, fit: &'a FittedRecords) -> Result<Self, RecordDiagnosisError> {
        let records = problem.records;
        let scales = scales(&fit.effects);
        let made = problem.control.map(records.list.len(), |r| -> Result<_, RecordDiagnosisError> {
            let mut derivatives = problem.derivatives(fit, &scales, r, Steps::Coarse)?;
            derivatives.left = problem.left_of(fit, r, Steps::Fine)?;
            Ok(Thinned::new(derivatives))
        });
        let thinned: Vec<Thinned> = made.into_iter().collect::<Result<_, _>>()?;
        let products = thinned.iter().map(|t| t.derivatives.products(t.every as f64)).collect();
        let normal = problem.assembled(fit, scale(fit), products);
        let factored =
            EquilibratedCholesky::new(normal.matrix.as_ref(), RIDGE).ok_or(RecordDiagnosisError::Singular)?;
        let step = factored.solve(&normal.gradient);
        let linear = fit.sources(records).into_iter().filter(|s| s.effect.is_linear()).collect();
        let motion = FitMotion::new(records, fit, problem.control)?;
        Ok(Self { records, fit, linear, motion, thinned, factored, step })
    }

    /// The motion of the fit.
    pub(super) fn motion(&self) -> &FitMotion {
        &self.motion
    }

    /// The same beside a fit without the force of one of its laws along the motion that it has with it, to first order; to be made of a
    /// problem in which no parameters of laws are free.
    pub(super) fn without(mut self, law: &Source) -> Result<Self, RecordDiagnosisError> {
        let leg = law.place.legs().first().copied().ok_or(RecordDiagnosisError::Singular)?;
        let mut back = vec![0.0; self.step.len()];
        for r in 0..self.thinned.len() {
            let (forced, record) = (self.forced(leg, r)?, &self.records.list[r]);
            let Thinned { derivatives, every } = &mut self.thinned[r];
            let channels = forced.under(law, record, *every).ok_or(RecordDiagnosisError::Singular)?;
            let mut by = vec![0.0; derivatives.count];
            for (c, y) in channels.iter().enumerate() {
                let sigma = record.sigma[c].iter().step_by(*every);
                let w: Vec<f64> = y.iter().zip(sigma).map(|(y, s)| y / s).collect();
                derivatives.left[c].iter_mut().zip(&w).for_each(|(left, w)| *left += w);
                let times = *every as f64;
                derivatives.channels[c].iter().for_each(|(k, column)| by[*k] += times * dot(&w, column));
            }
            derivatives.unknowns.iter().for_each(|(p, k, s)| back[*k] += s * by[*p]);
        }
        let more = self.factored.solve(&back);
        self.step.iter_mut().zip(more).for_each(|(step, more)| *step += more);
        Ok(self)
    }

    /// The best shape of each law at a place; none where the place does not move.
    pub(super) fn at(&self, place: &Place, laws: &[Effect]) -> Vec<Scored> {
        self.shapes_at(place, laws).into_iter().filter_map(|shapes| shapes.into_iter().next()).collect()
    }

    /// The shapes of each law at a place, best first; none where the place does not move.
    pub(super) fn shapes_at(&self, place: &Place, laws: &[Effect]) -> Vec<Vec<Scored>> {
        let Some(leg) = place.legs().first().copied() else { return Vec::new() };
        let made: Result<Vec<Forced>, RecordDiagnosisError> =
            (0..self.thinned.len()).map(|r| self.forced(leg, r)).collect::<Result<_, _>>();
        let (Ok(forced), Some(range)) = (made, self.motion.range(leg)) else { return Vec::new() };
        let all = |effect: &Effect| {
            let shapes = effect.shapes(&range).into_iter();
            let mut scored: Vec<Scored> =
                shapes.filter_map(|shape| self.scored(*effect, place, shape, &forced)).collect();
            scored.sort_by(|a, b| b.gain.total_cmp(&a.gain));
            scored
        };
        laws.iter().map(all).collect()
    }

    /// The linear model of record `r` under forces along a leg.
    fn forced(&self, leg: Leg, r: usize) -> Result<Forced, RecordDiagnosisError> {
        let record = &self.records.list[r];
        let drives: Vec<usize> = std::iter::once(leg.first).chain(leg.second).collect();
        let fit = self.fit;
        let parts = self.records.parts.logarithms(&fit.parts);
        let errors = self.records.shape_errors(record, &fit.shapes);
        let setup = self.records.setup(record, &self.linear, fit.factors(r), [&fit.modes, &fit.damping], &parts);
        let model = TransientModel::new(&TransientSetup { drives: &drives, shape_errors: &errors, ..setup })
            .map_err(|reason| RecordDiagnosisError::Model { file: record.file.clone(), reason })?;
        let motion = self.motion.relative(leg, r).ok_or(RecordDiagnosisError::Singular)?;
        Ok(Forced { model, motion, drives: drives.len() })
    }

    /// What a source of any size takes away.
    pub(super) fn gain(&self, source: &Source) -> Option<f64> {
        let leg = source.place.legs().first().copied()?;
        let forced: Vec<Forced> =
            (0..self.thinned.len()).map(|r| self.forced(leg, r)).collect::<Result<_, _>>().ok()?;
        self.scored(source.effect, &source.place, source.parameters.clone(), &forced).map(|scored| scored.gain)
    }

    /// A shape with the scale that fits best.
    fn scored(&self, effect: Effect, place: &Place, shape: Vec<f64>, forced: &[Forced]) -> Option<Scored> {
        let mut source = Source { effect, place: place.clone(), state: State::Known, parameters: shape };
        let mut against = vec![0.0; self.step.len()];
        let (mut product, mut square) = (0.0, 0.0);
        for (r, (Thinned { derivatives, every }, forced)) in self.thinned.iter().zip(forced).enumerate() {
            let record = &self.records.list[r];
            let channels = forced.under(&source, record, *every)?;
            let times = *every as f64;
            let mut by = vec![0.0; derivatives.count];
            for (c, y) in channels.iter().enumerate() {
                let sigma = &record.sigma[c];
                let w: Vec<f64> = y.iter().zip(sigma.iter().step_by(*every)).map(|(y, s)| y / s).collect();
                product += times * dot(&w, &derivatives.left[c]);
                square += times * dot(&w, &w);
                derivatives.channels[c].iter().for_each(|(k, column)| by[*k] += times * dot(&w, column));
            }
            derivatives.unknowns.iter().for_each(|(p, k, s)| against[*k] += s * by[*p]);
        }
        let beside = self.factored.solve(&against);
        let product = product - dot(&against, &self.step);
        let rest = square - dot(&against, &beside);
        let factor = product / rest;
        effect.scaled().iter().for_each(|&k| source.parameters[k] *= factor);
        let allowed = source.parameters.iter().zip(effect.parameters()).all(|(v, p)| p.allows(*v));
        (rest > 1e-9 * square && factor != 0.0 && allowed).then(|| {
            let change = self.step.iter().zip(&beside).map(|(own, by)| own - factor * by).collect();
            Scored { source, gain: factor * product, change }
        })
    }
}

/// A linear model that forces along a leg drive, and the motion along it.
struct Forced {
    model: TransientModel,
    motion: MotionOfDof,
    drives: usize,
}

impl Forced {
    /// What the channels show of the force of a source along the motion, one of `every` samples.
    fn under(&self, source: &Source, record: &RecordData, every: usize) -> Option<Vec<Vec<f64>>> {
        let [d, v, a] = &self.motion;
        let force = force_along(source, [d, v, a], record.force_step())?;
        let against: Vec<f64> = force.iter().map(|f| -f).collect();
        let forces = if self.drives > 1 { vec![against, force] } else { vec![against] };
        Some(self.model.forced(&forces, Hold::FirstOrder, record.force_step(), every * record.every))
    }
}

impl Thinned {
    fn new(mut derivatives: RecordDerivatives) -> Self {
        let samples: usize = derivatives.left.iter().map(Vec::len).sum();
        let every = samples.div_ceil(MOST_SAMPLES).max(1);
        if every > 1 {
            let thin = |list: &mut Vec<f64>| *list = list.iter().copied().step_by(every).collect();
            derivatives.channels.iter_mut().flatten().for_each(|(_, column)| thin(column));
            derivatives.left.iter_mut().for_each(thin);
        }
        Self { derivatives, every }
    }
}

impl Search<'_> {
    /// Starts of a fit with one law more: those at places that promise the best evidence beside `fit`, its variables moved with them; and
    /// the largest drop of the squared residual that any law promises, without bound where none can be weighed.
    pub(super) fn scored(
        &self,
        level: usize,
        fit: &FittedRecords,
        places: &[Place],
        laws: &[Effect],
    ) -> (Vec<FittedRecords>, f64) {
        if self.control.is_late() {
            return (Vec::new(), 0.0);
        }
        let records = &self.levels[level];
        let problem = FitProblem { records, free: Free::all(records), share: 1.0, control: self.control };
        let Ok(test) = ScoreTest::new(&problem, fit) else { return (Vec::new(), f64::INFINITY) };
        let open = |s: &Scored| !fit.effects.iter().chain(self.excluded).any(|e| e.is_same(&s.source));
        let scores_at = |places: &[Place], laws: &[Effect]| -> Vec<Scored> {
            self.control.map(places.len(), |k| test.at(&places[k], laws)).into_iter().flatten().filter(open).collect()
        };
        // Laws of several shapes are weighed at the places only where one of a single shape promises most.
        let (plain, shaped): (Vec<Effect>, Vec<Effect>) = laws.iter().partition(|e| e.parameters().len() == 1);
        let mut all = scores_at(places, &plain);
        all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        all.extend(scores_at(&foremost(all.iter().map(|s| &s.source.place)), &shaped));
        let unit = scale(fit);
        let worth = |s: &Scored| {
            let effects = fit.effects.iter().chain([&s.source]).cloned().collect();
            evidence(&FittedRecords { effects, chi_square: fit.chi_square - s.gain, ..fit.clone() }, unit)
        };
        let none = evidence(fit, unit);
        let most = all.iter().map(|s| s.gain).fold(0.0, f64::max);
        all.retain(|s| worth(s) < none);
        all.sort_by(|a, b| worth(a).total_cmp(&worth(b)));
        let scales = scales(&fit.effects);
        let chosen = diverse(all);
        (self.control.map(chosen.len(), |k| begun(&problem, fit, &scales, &chosen[k])), most)
    }
}

/// A fit with a law added and its variables moved as the law demands, as far as most is taken away: far from the fit nothing is linear.
fn begun(problem: &FitProblem, fit: &FittedRecords, scales: &[Vec<f64>], scored: &Scored) -> FittedRecords {
    let along = |share: f64| {
        let change: Vec<f64> = scored.change.iter().map(|c| share * c).collect();
        let mut start = problem.moved(fit, scales, &change);
        let mut source = scored.source.clone();
        source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= share);
        start.effects.push(source);
        start
    };
    let left = |start: &FittedRecords| problem.left(start).map_or(f64::INFINITY, |left| left.total(scale(fit)));
    let starts: Vec<(f64, FittedRecords)> = SHARES.map(along).into_iter().map(|s| (left(&s), s)).collect();
    let best = starts.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(|| along(1.0), |(_, start)| start)
}

/// The first of a list, no more of one law or one place than [`MOST_ALIKE`], and of laws of one family at a place no more than
/// [`MOST_OF_FAMILY`].
fn diverse(all: Vec<Scored>) -> Vec<Scored> {
    let mut taken: Vec<Scored> = Vec::new();
    for one in all {
        let of_law = taken.iter().filter(|t| t.source.effect == one.source.effect).count();
        let here: Vec<Effect> =
            taken.iter().filter(|t| t.source.place.is_same(&one.source.place)).map(|t| t.source.effect).collect();
        let of_family = here.iter().filter(|&&effect| are_of_one_family(effect, one.source.effect)).count();
        let few = of_law < MOST_ALIKE && here.len() < MOST_ALIKE && of_family < MOST_OF_FAMILY;
        if few && taken.len() < TAKEN {
            taken.push(one);
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::runs::uniform;
    use crate::control::Control;
    use crate::measurement::transient_run::TransientLabel;
    use crate::measurement::{Channel, Kind, Quantity, Record, TransientRun};
    use crate::response::transient::SampledForces;
    use crate::structure::Structure;
    use crate::structure::chain::ChainParameters;
    use std::sync::Arc;

    const STEP: f64 = 5e-3;
    const SAMPLES: usize = 2400;

    fn chain() -> Structure {
        let (masses, ground_stiffness) = (vec![2.0, 1.0, 1.5], vec![800.0, 0.0, 0.0]);
        ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1500.0, 900.0] }.build(&[]).unwrap()
    }

    fn source(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
        Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
    }

    /// A decay of the chain with these sources, all three displacements with 0.2 % of noise that is the same at every call.
    fn decay(structure: &Structure, sources: &[Source]) -> TransientRun {
        let modes = structure.modes().unwrap();
        let channel =
            |dof: usize| Channel { quantity: Quantity::Displacement, dof, label: structure.label(dof).into() };
        let channels: Vec<Channel> = (0..3).map(channel).collect();
        let forces = SampledForces {
            step: STEP,
            samples: SAMPLES,
            forces: Vec::new(),
            substeps: 4,
            every: 1,
            step_lengths: Vec::new(),
        };
        let model = TransientModel::new(&TransientSetup::stated(structure, &modes, sources, &channels, STEP)).unwrap();
        let mut rows = model.predict(&forces, &[0.02, -0.01, 0.005, 0.0, 0.0, 0.0], &[]).unwrap().channels;
        let mut uniform = uniform(1);
        rows.iter_mut().flatten().for_each(|y| *y += 4e-5 * uniform());
        let time = (0..SAMPLES).map(|k| STEP * k as f64).collect();
        let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(Record::new(time, channels, rows).unwrap()), &[]).unwrap()
    }

    /// Of a law that is little in the response, what the score promises is what a fit with the law takes away, and its coefficient is
    /// that of the fit; no other law at any place promises more.
    #[test]
    fn what_a_score_promises_is_what_a_fit_finds() {
        let structure = chain();
        let known = vec![source(Effect::Viscous, &[0], &[0.8])];
        let hidden = source(Effect::Quadratic, &[2], &[0.1]);
        let run = decay(&structure, &[known[0].clone(), hidden.clone()]);
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let free = Free { shifts: false, ..Free::all(&records) };
        let problem = FitProblem { records: &records, free, share: 1.0, control: &control };
        let fit = problem.improve(&FittedRecords::start(&records, &[]), 20).unwrap();
        let test = ScoreTest::new(&problem, &fit).unwrap();
        let laws = [Effect::Viscous, Effect::Coulomb, Effect::Quadratic, Effect::CubicStiffness];
        let places = [vec![0], vec![1], vec![2], vec![0, 1], vec![1, 2]].map(Place::Dofs);
        let mut all: Vec<Scored> = places.iter().flat_map(|place| test.at(place, &laws)).collect();
        all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let best = &all[0];
        assert!(best.source.is_same(&hidden), "{:?} {:?}", best.source.effect, best.source.place);

        let mut start = fit.clone();
        start.effects.push(best.source.clone());
        let with = problem.improve(&start, 20).unwrap();
        let [promised, found] = [best.source.parameters[0], with.effects[0].parameters[0]];
        assert!((promised / found - 1.0).abs() < 0.1, "{promised} for {found}");
        assert!((found / hidden.parameters[0] - 1.0).abs() < 0.05, "{found}");
        let total = |fit: &FittedRecords| fit.chi_square + scale(&with) * fit.prior;
        let taken = total(&fit) - total(&with);
        assert!((best.gain / taken - 1.0).abs() < 0.1, "{} for {taken}", best.gain);
    }
}

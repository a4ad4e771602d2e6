//! What the model lacks in its records: place before law, laws fitted on the record itself, sets grown effect by effect.
//!
//! 1. The model as it is, then corrected (stiffness, sizes of known sources, a shift a record).
//! 2. Places by a free force ([`super::localisation`]); every law at those that matter, from a small grid of shapes, on short
//!    parts; the best on longer parts and at last on whole records.
//! 3. What is left of a fit is coloured: differences of its squared residual are divided by its misfit and by the number of
//!    samples over which it stays alike, so that many samples of one error do not count as many.
//! 4. An effect is kept if it also predicts the last part of each record from a fit on the rest.

use super::compare::{floors, short, started};
use super::data::{RecordError, Records};
use super::evidence::{evidence, misfit, parameters, scale};
use super::fit::{Fit, FittedRecords, Free};
use super::localisation::{LocatedForce, locate};
use super::regression::Regression;
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::candidates::start_grids::{Range, scaled, shapes};
use crate::diagnosis::diagnose::{Added, Correction, Diagnosis, Early, Step, Suggestion, Verdict};
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Effect, Family, Motion, Place, Source, State};
use crate::math::statistics::{evidence_weights, root_mean_square};
use crate::structure::Part;
use std::f64::consts::TAU;

/// Laws that have a force in time.
const LAWS: [Effect; 13] = [
    Effect::Viscous,
    Effect::Coulomb,
    Effect::Quadratic,
    Effect::Stiffness,
    Effect::CubicStiffness,
    Effect::QuadraticStiffness,
    Effect::Mass,
    Effect::Power,
    Effect::ElasticSlider,
    Effect::Maxwell,
    Effect::Gap,
    Effect::Stribeck,
    Effect::Iwan,
];
/// Misfit (squared residual over noise) up to which a model agrees.
const AGREES: f64 = 1.15;
/// Places that are looked at, shapes of a law, fits that go on to longer parts and to whole records.
const PLACES: usize = 2;
const SHAPES: usize = 5;
const LONGER: usize = 7;
const WHOLE: usize = 4;
/// Ratio of the parts of a record on which a law is fitted one after the other.
const LADDER: f64 = 3.0;
/// Laws that are fitted at the places that the equation of motion demands, from the best place on.
const QUOTAS: [usize; 3] = [6, 3, 2];
/// Force of a law at the start, as a share of the spring force there.
const SIZES: [f64; 2] = [0.01, 0.1];
/// Most effects of a set.
const MOST_EFFECTS: usize = 3;
/// Share of each record that is fitted when the rest is to be predicted.
const LEARNT: f64 = 0.6;
/// Share by which the squared residual of a law of fewer parameters may be larger than that of another at its place, which
/// then is not told: records are not so exact that they could tell.
const PLAIN: f64 = 1.02;

/// Gain of evidence from which on an effect is kept, and the share of the error that it must take away.
const GAIN: f64 = 12.0;
const WORTH: f64 = 0.05;
/// Deviations from 0 at which a correction is told.
const MOVED: f64 = 4.0;
/// Most suggestions.
const MOST: usize = 8;

/// Finds what the model of `records` lacks; effects `excluded` are not suggested.
///
/// # Errors
/// [`RecordError`]: models that cannot be predicted, a search that was stopped.
pub fn diagnose_records(
    records: &Records,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, RecordError> {
    let search = Search { records, excluded, control };
    let bare = started(records, &[], control)?;
    let floors: Vec<f64> = records.list.iter().flat_map(floors).collect();
    let before = bare.error(records, 0.0, 1.0)?;
    let mut diagnosis = Diagnosis {
        error_before: before,
        noise_floor: root_mean_square(&floors),
        verdict: Verdict::Adequate,
        suggestions: Vec::new(),
        steps: vec![Step { added: Vec::new(), error: before, misfit: misfit(&bare) }],
        next_test: Vec::new(),
        corrections: Vec::new(),
        complete: true,
    };
    if misfit(&bare) < AGREES {
        return Ok(diagnosis);
    }
    let corrected = search.staged(&bare, &[0.4, 1.0], 6)?;
    let mut rungs = vec![vec![corrected]];
    loop {
        let best = &rungs[rungs.len() - 1][0];
        if misfit(best) < AGREES || best.effects.len() >= MOST_EFFECTS {
            break;
        }
        control.report(0.3 * rungs.len() as f64);
        let found = search.extended(best, &bare)?;
        let Some(top) = found.first() else { break };
        if !search.is_better(top, best)? {
            break;
        }
        early(&search.suggestions(&found)?);
        rungs.push(found);
    }
    search.conclude(&rungs, &mut diagnosis)?;
    control.report(1.0);
    Ok(diagnosis)
}

struct Search<'a> {
    records: &'a Records<'a>,
    excluded: &'a [Source],
    control: &'a Control,
}

impl Search<'_> {
    fn fit(&self, start: &FittedRecords, share: f64, iterations: usize) -> Result<FittedRecords, RecordError> {
        let fit = Fit { records: self.records, free: Free { corrections: true }, share, control: self.control };
        fit.improve(start, iterations)
    }

    fn staged(&self, start: &FittedRecords, shares: &[f64], iterations: usize) -> Result<FittedRecords, RecordError> {
        let mut fitted = start.clone();
        for &share in shares {
            fitted = self.fit(&fitted, share, iterations)?;
        }
        Ok(fitted)
    }

    /// Places that matter beside what is in `best`, most likely first.
    fn places(&self, best: &FittedRecords) -> Vec<Place> {
        let structure = self.records.structure;
        let mut all = Family::EachTranslation.places(structure);
        all.extend(Family::EachPair.places(structure));
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

    /// Fits of `best` with one effect more, best first.
    fn extended(&self, best: &FittedRecords, bare: &FittedRecords) -> Result<Vec<FittedRecords>, RecordError> {
        let first = short(self.records);
        // Short parts are followed from the linear model, whose stiffness is not bent to what is missing.
        let base = if best.effects.is_empty() { bare } else { best };
        let quiet =
            Fit { records: self.records, free: Free { corrections: false }, share: first, control: self.control };
        let base = quiet.improve(base, 3)?;
        let mut found: Vec<FittedRecords> = Vec::new();
        for source in self.beginnings(best, &base) {
            self.control.check()?;
            let mut start = base.clone();
            start.effects.push(source);
            // A start that runs away, or a mass that takes away all there is, is no start.
            let Ok(fitted) = self.fit(&start, first, 3) else { continue };
            let same =
                |o: &FittedRecords| o.effects.last().zip(fitted.effects.last()).is_some_and(|(a, b)| a.is_same(b));
            match found.iter_mut().find(|o| same(o)) {
                Some(own) if fitted.chi_square < own.chi_square => *own = fitted,
                Some(_) => {}
                None => found.push(fitted),
            }
        }
        let longer = 0.4_f64.max(first);
        let mut found = self.continued(found, LONGER, [first, longer], 6);
        found = self.continued(found, WHOLE, [longer, 1.0], 12);
        found.retain(|f| f.effects.last().is_some_and(|e| is_allowed(self.excluded, e, &last_deviations(f))));
        if let Some(least) = found.iter().map(|f| f.chi_square).min_by(f64::total_cmp) {
            let best = found.iter().find(|f| f.chi_square == least).map_or(1.0, scale);
            found.sort_by(|a, b| evidence(a, best).total_cmp(&evidence(b, best)));
            plainest(&mut found);
        }
        Ok(found)
    }

    /// Laws at places from which fits begin: those that the equation of motion demands, else a grid of all.
    fn beginnings(&self, best: &FittedRecords, base: &FittedRecords) -> Vec<Source> {
        let open = |s: &Source| !base.effects.iter().chain(self.excluded).any(|e| e.is_same(s));
        let structure = self.records.structure;
        let mut all = Family::EachTranslation.places(structure);
        all.extend(Family::EachPair.places(structure));
        let located = self.places(best);
        let Some(regression) = Regression::new(self.records, base, self.control) else {
            let of = |place: &Place| {
                let range = self.range(base, place);
                LAWS.iter().flat_map(move |&effect| self.starts(effect, place, &range)).collect::<Vec<Source>>()
            };
            return located.iter().flat_map(of).filter(open).collect();
        };
        let mut ranked = regression.ranked(&all, &LAWS, self.control);
        ranked.retain(|r| open(&r.source));
        let mut places: Vec<&Place> = Vec::new();
        for place in ranked.iter().map(|r| &r.source.place) {
            if places.len() < QUOTAS.len() && !places.iter().any(|p| p.is_same(place)) {
                places.push(place);
            }
        }
        let quotas = places.iter().copied().zip(QUOTAS);
        let more =
            located.iter().filter(|p| !places.iter().any(|q| q.is_same(p))).map(|p| (p, QUOTAS[QUOTAS.len() - 1]));
        let of = |(place, quota): (&Place, usize)| {
            ranked
                .iter()
                .filter(|r| r.source.place.is_same(place))
                .take(quota)
                .map(|r| r.source.clone())
                .collect::<Vec<_>>()
        };
        quotas.chain(more).flat_map(of).collect()
    }

    /// The best `count` fitted on longer and longer parts, so that none loses the phase.
    fn continued(
        &self,
        mut found: Vec<FittedRecords>,
        count: usize,
        [from, to]: [f64; 2],
        iterations: usize,
    ) -> Vec<FittedRecords> {
        found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
        found.truncate(count);
        let rising = |f: &FittedRecords| {
            let mut fitted = f.clone();
            let mut share = LADDER * from;
            while share < to {
                fitted = self.fit(&fitted, share, 4).ok()?;
                share *= LADDER;
            }
            self.fit(&fitted, to, iterations).ok()
        };
        found.iter().filter_map(rising).collect()
    }

    /// Range of the motion at a place in the short part of the records.
    fn range(&self, base: &FittedRecords, place: &Place) -> Range {
        let (modes, kept) = (&self.records.modes, self.records.kept);
        let legs = place.legs();
        let shape = |r: usize| legs.first().map_or(0.0, |leg| leg.relative(|i| modes.shapes[(i, r)]));
        let sizes = |initial: &Vec<f64>| -> [f64; 2] {
            let of = |r: usize| shape(r).abs() * initial[r].hypot(initial[kept + r]);
            let d: f64 = (0..kept).map(of).sum();
            [d, (0..kept).map(|r| of(r) * modes.omega[r].max(1e-3)).sum()]
        };
        let mut all: Vec<[f64; 2]> = base.initial.iter().map(sizes).collect();
        for (record, size) in self.records.list.iter().zip(&mut all) {
            // Driven records begin at rest: the static motion under the largest force stands for theirs, ten times raised.
            let force = record.forces.iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
            let flexible: f64 = (0..kept).map(|r| (shape(r) / modes.omega[r].max(1e-3)).powi(2)).sum();
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
        let (modes, kept) = (&self.records.modes, self.records.kept);
        let legs = place.legs();
        let shape = |r: usize| legs.first().map_or(0.0, |leg| leg.relative(|i| modes.shapes[(i, r)]));
        let flexible: f64 = (0..kept).map(|r| (shape(r) / modes.omega[r].max(1e-3)).powi(2)).sum();
        let (Some(law), true) = (effect.law(), flexible > 0.0) else { return Vec::new() };
        let spring = range.displacement / flexible;
        let motion = Motion::cosine(range.velocity / range.displacement, range.displacement, 64);
        let all = shapes(effect, range);
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
                scaled(effect).iter().for_each(|&k| parameters[k] *= factor);
                if parameters.iter().zip(law.parameters()).all(|(v, p)| p.allows(*v)) {
                    starts.push(Source { effect, place: place.clone(), state: State::Known, parameters });
                }
            }
        }
        starts
    }

    /// Whether a fit is better than the one before by evidence, by its error and by what it predicts.
    fn is_better(&self, new: &FittedRecords, old: &FittedRecords) -> Result<bool, RecordError> {
        let scale = scale(new);
        let gain = evidence(old, scale) - evidence(new, scale);
        let worth = 1.0 - (new.chi_square / old.chi_square).sqrt();
        if gain < GAIN || worth < WORTH {
            return Ok(false);
        }
        Ok(misfit(new) < AGREES || self.held_out(new)? < self.held_out(old)?)
    }

    /// Error on the last part of each record of a fit on the rest.
    fn held_out(&self, fit: &FittedRecords) -> Result<f64, RecordError> {
        match self.fit(fit, LEARNT, 5).and_then(|learnt| learnt.error(self.records, LEARNT, 1.0)) {
            Ok(error) => Ok(error),
            Err(RecordError::Model { .. } | RecordError::Singular) => Ok(f64::INFINITY),
            Err(other) => Err(other),
        }
    }

    #[allow(clippy::unused_self, reason = "one of the steps of the search")]
    fn added(&self, fit: &FittedRecords) -> Vec<Added> {
        let wide = scale(fit).sqrt();
        let mut at = 0;
        let of = |source: &Source| {
            let deviations = fit.deviations[at..at + source.parameters.len()].iter().map(|d| d * wide).collect();
            at += source.parameters.len();
            Added { source: source.clone(), deviations }
        };
        fit.effects.iter().map(of).collect()
    }

    /// Suggestions of the fits of one size, best first.
    fn suggestions(&self, found: &[FittedRecords]) -> Result<Vec<Suggestion>, RecordError> {
        let Some(best) = found.first() else { return Ok(Vec::new()) };
        let unit = scale(best);
        let criteria: Vec<f64> = found.iter().map(|f| evidence(f, unit)).collect();
        let weights = evidence_weights(&criteria);
        let mut list: Vec<Suggestion> = Vec::new();
        for (fit, weight) in found.iter().zip(&weights) {
            let error = fit.error(self.records, 0.0, 1.0)?;
            for added in self.added(fit) {
                if let Some(known) = list.iter_mut().find(|s| s.added.source.is_same(&added.source)) {
                    known.probability = (known.probability + weight).min(1.0);
                    continue;
                }
                if list.len() >= MOST {
                    continue;
                }
                let alike = |other: &&FittedRecords| (other.chi_square - fit.chi_square).abs() / unit < 9.0;
                let others = found.iter().filter(alike).filter_map(|f| f.effects.last());
                let indistinguishable_from =
                    others.filter(|o| !fit.effects.iter().any(|e| e.is_same(o))).cloned().collect();
                let words = vec![
                    added.source.effect.sentence().to_string(),
                    format!("With it the error of the records is {:.2} %.", 100.0 * error),
                ];
                list.push(Suggestion {
                    added,
                    error_after: error,
                    held_out_error_after: error,
                    probability: *weight,
                    evidence: words,
                    indistinguishable_from,
                });
            }
        }
        Ok(list)
    }

    fn conclude(&self, rungs: &[Vec<FittedRecords>], diagnosis: &mut Diagnosis) -> Result<(), RecordError> {
        for rung in rungs {
            let fit = &rung[0];
            let error = fit.error(self.records, 0.0, 1.0)?;
            diagnosis.steps.push(Step { added: self.added(fit), error, misfit: misfit(fit) });
        }
        let top = &rungs[rungs.len() - 1];
        diagnosis.corrections = corrections(self.records, &top[0]);
        if top[0].effects.is_empty() {
            diagnosis.verdict = if misfit(&top[0]) > AGREES {
                Verdict::Unexplained
            } else if diagnosis.corrections.is_empty() {
                Verdict::Adequate
            } else {
                Verdict::Detuned
            };
            return Ok(());
        }
        diagnosis.suggestions = self.suggestions(top)?;
        for suggestion in &mut diagnosis.suggestions {
            let own = |f: &&FittedRecords| f.effects.iter().any(|e| e.is_same(&suggestion.added.source));
            if let Some(fit) = top.iter().find(own) {
                suggestion.held_out_error_after = self.held_out(fit)?;
            }
        }
        let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
        diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
        Ok(())
    }
}

fn last_deviations(fit: &FittedRecords) -> Vec<f64> {
    let count = fit.effects.last().map_or(0, |e| e.parameters.len());
    let end = parameters(fit);
    fit.deviations[end - count..end].to_vec()
}

/// Corrections that moved, with their deviations.
fn corrections(records: &Records, fit: &FittedRecords) -> Vec<Correction> {
    let wide = scale(fit).sqrt();
    let first = parameters(fit);
    let modes = if records.kept > 1 { records.kept } else { 0 };
    let values =
        std::iter::once(fit.stiffness).chain(fit.known.iter().copied()).chain(fit.modes.iter().take(modes).copied());
    let names = std::iter::once(UpdatingParameter::Structure(Part::Stiffness))
        .chain((0..records.known.len()).map(UpdatingParameter::Known))
        .chain((0..modes).map(|r| UpdatingParameter::Structure(Part::Mode(r))));
    let of = |(k, (v, parameter)): (usize, (f64, UpdatingParameter))| {
        let deviation = fit.deviations.get(first + k).copied().unwrap_or(f64::NAN) * wide;
        (v.abs() > MOVED * deviation).then(|| Correction { parameter, factor: v.exp(), deviation: deviation * v.exp() })
    };
    values.zip(names).enumerate().filter_map(of).collect()
}

/// Takes out the fits whose last law has more parameters than another at the same place that leaves all but as little.
fn plainest(found: &mut Vec<FittedRecords>) {
    let simple: Vec<(f64, Source)> =
        found.iter().filter_map(|f| Some((f.chi_square, f.effects.last()?.clone()))).collect();
    let needless = |fit: &FittedRecords| {
        let Some(own) = fit.effects.last() else { return false };
        let plainer = |(chi, other): &(f64, Source)| {
            other.place.is_same(&own.place)
                && other.parameters.len() < own.parameters.len()
                && *chi <= PLAIN * fit.chi_square
        };
        simple.iter().any(plainer)
    };
    found.retain(|fit| !needless(fit));
}

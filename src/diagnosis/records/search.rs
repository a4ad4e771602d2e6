//! Fits of one effect more: laws at places from which fits begin, fitted on parts of the records, and carried on to longer ones.

use super::compare::first_states;
use super::data::{RecordData, RecordDiagnosisError, Records};
use super::evidence::{AGREES, GAIN, evidence, information, misfit, scale};
use super::fitted::FittedRecords;
use super::laws::laws_seen_in;
use super::problem::{FitProblem, Free};
use super::pruning::{PrunedSets, is_same_set};
use super::suggestions::{keep_parsimonious, last_deviations};
use crate::balance::windows::motion::Motion;
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Effect, Family, Place, Source};
use crate::structure::{Part, Structure};
use std::sync::OnceLock;

/// Rounds and steps in each of the fits of those that are followed, and how many are.
const FOLLOWING: [usize; 2] = [2, 4];
const FOLLOWED: usize = 6;
/// The best of them that are followed to their end, how many times at most, and the share that is left of their squared residual from
/// which on they have ended.
const ENDED: usize = 2;
const LONGEST: usize = 6;
const STILL: f64 = 0.9;
/// Steps with all derivatives.
const NEWTON: usize = 6;
/// Of the fits that are begun as neighbours of those that are there as many are followed: the others say much the same, and each costs
/// four times its beginning.
const FOLLOWED_BESIDE: usize = 3;
/// Share of what is left that the best further law must take away to first order to be looked for: one that is kept takes away more than a
/// quarter of it ([`super::diagnose`]), of which a first order may miss a third.
const PROMISED: f64 = 0.18;
/// Share of what a further law must gain to be kept, with what its parameter costs, that is seen to first order at least.
const FOUND: f64 = 0.67;
/// Modes up to which places tell little and one law is easily taken for another: there more is tried.
pub(super) const FEW_MODES: usize = 2;
/// Candidates of the best set beside which a further effect is looked for, and the squared residual over that of the best up to which.
const BESIDE: usize = 1;
const NEAR: f64 = 2.0;
/// Levels of parts on which effects are added; on whole records where there are no more levels than that, or nothing was found.
pub(super) const GROWING: usize = 2;
/// Starts of which a fit is begun.
const BEGUN: usize = 28;
/// Squared residual over the least one, or over that of half the noise, beyond which a fit is not followed further: after the
/// first steps, and on longer parts.
pub(super) const MOST_LEFT: [f64; 2] = [12.0, 3.0];
pub(super) const NOISE: f64 = 0.5;

/// The search for what is missing in some records.
pub(super) struct Search<'a> {
    /// Whole records, their samples weighted by how far they can be trusted.
    pub records: &'a Records<'a>,
    /// The same with the noise of their channels only, as they are compared.
    pub plain: &'a Records<'a>,
    /// The weighted records in parts of growing length, the whole last.
    pub levels: Vec<Records<'a>>,
    pub excluded: &'a [Source],
    /// The structure as it is stated, and its supports that were found to give way, as they do in that of the records.
    pub stated: &'a Structure,
    pub supports: &'a [Correction],
    pub control: &'a Control,
    /// Sets with a neighbour of the best law that left far too much on shorter segments, where no phase is lost.
    pub pruned: PrunedSets,
    /// Laws that are looked for.
    pub laws: Vec<Effect>,
    /// The motion of the modes as the sensors show it, once it was asked for.
    pub motions: OnceLock<Vec<(usize, Motion)>>,
}

/// Parts of the structure with their factors.
pub(super) fn factors_of(corrections: &[Correction]) -> Vec<(Part, f64)> {
    let structure_factor = |c: &Correction| match c.parameter {
        UpdatingParameter::Structure(part) => Some((part, c.factor)),
        _ => None,
    };
    corrections.iter().filter_map(structure_factor).collect()
}

/// Sets of growing size: the best of each as it stood when the next effect was found, of the last all that were followed, fitted
/// to the whole records.
pub(super) struct SetsBySize {
    pub earlier: Vec<(usize, FittedRecords)>,
    pub last: Vec<FittedRecords>,
}

impl<'a> Search<'a> {
    /// Of `weighted` records and the same `plain`, of the structure as it is `stated` with `supports` that give way.
    pub(super) fn new(
        weighted: &'a Records<'a>,
        plain: &'a Records<'a>,
        excluded: &'a [Source],
        stated: &'a Structure,
        supports: &'a [Correction],
        control: &'a Control,
    ) -> Self {
        let (levels, pruned, motions) = (weighted.levels(), PrunedSets::default(), OnceLock::new());
        let laws = laws_seen_in(plain);
        Self { records: weighted, plain, levels, excluded, stated, supports, control, pruned, laws, motions }
    }

    /// The structure as it is stated with its supports and other parts corrected.
    pub(super) fn structure_with(&self, factors: &[(Part, f64)]) -> Structure {
        let mut all = factors_of(self.supports);
        all.extend_from_slice(factors);
        self.stated.with_factors(&all)
    }
}

impl Search<'_> {
    /// `start` improved on the first `share` of every part of `level`, everything free, in some rounds of some steps.
    pub(super) fn fit(
        &self,
        level: usize,
        start: &FittedRecords,
        share: f64,
        rounds: [usize; 2],
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        self.problem(level, share).chord_fit(start, rounds)
    }

    /// A fit followed as long as it leaves clearly less: on longer parts of the records one that is on its way down loses the phase, and
    /// ends elsewhere.
    fn to_its_end(&self, level: usize, fit: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        let mut fit = fit.clone();
        for _ in 0..LONGEST {
            if misfit(&fit) < AGREES || self.control.is_late() {
                break;
            }
            let is_on_its_way = |next: &FittedRecords| next.chi_square < STILL * fit.chi_square;
            let mut next = self.fit(level, &fit, 1.0, FOLLOWING)?;
            if !is_on_its_way(&next) {
                // With all derivatives taken at every step.
                next = self.problem(level, 1.0).improve(&next, NEWTON)?;
            }
            let ended = !is_on_its_way(&next);
            fit = next;
            if ended {
                break;
            }
        }
        Ok(fit)
    }

    /// The whole records with the samples on which sets are fitted.
    pub(super) fn whole(&self) -> &Records<'_> {
        self.levels.last().unwrap_or(self.records)
    }

    /// The fit of the first `share` of every part of `level`, everything free.
    pub(super) fn problem(&self, level: usize, share: f64) -> FitProblem<'_> {
        let records = &self.levels[level];
        FitProblem { records, free: Free::all(records), share, control: self.control }
    }

    /// A fit of one level as the start of one of another: initial states that are not known yet are read from the first periods.
    pub(super) fn carried(
        &self,
        fit: &FittedRecords,
        from: usize,
        to: usize,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        let (known, records) = (&self.levels[from], &self.levels[to]);
        let same = |k: usize| {
            let wanted = &records.list[k];
            known.list.iter().position(|r| r.index == wanted.index && r.first_s == wanted.first_s)
        };
        let found: Vec<Option<usize>> = (0..records.list.len()).map(same).collect();
        let rest = vec![0.0; 2 * records.kept];
        let initial = found.iter().map(|k| k.map_or_else(|| rest.clone(), |k| fit.initial[k].clone())).collect();
        let shift = |wanted: &RecordData| {
            known.list.iter().position(|r| r.index == wanted.index).map_or(0.0, |k| fit.shifts[k])
        };
        let (shifts, offsets) = (records.list.iter().map(shift).collect(), records.no_offsets());
        let start = FittedRecords { offsets, shifts, initial, ..fit.clone() };
        if found.iter().all(Option::is_some) {
            return Ok(start);
        }
        let states = first_states(records, start.clone(), self.control)?.initial;
        let initial = found.iter().zip(states).map(|(k, own)| k.map_or(own, |k| fit.initial[k].clone())).collect();
        Ok(self.in_best_states(to, FittedRecords { initial, ..start }))
    }

    /// Initial states and effects only, nothing corrected.
    pub(super) fn quiet(&self, level: usize, start: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        FitProblem { records: &self.levels[level], free: Free::nothing(), share: 1.0, control: self.control }
            .improve(start, 3)
    }

    /// Fits of the best of `candidates` with one effect more, best first, and of those that leave hardly more: which of two laws comes
    /// first may be told by what comes second.
    pub(super) fn beside_candidates(
        &self,
        level: usize,
        candidates: &[FittedRecords],
        bare: &FittedRecords,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some(best) = candidates.first() else { return Ok(Vec::new()) };
        let mut found = self.extended(level, best, bare)?;
        let near = |f: &&FittedRecords| {
            self.records.kept <= FEW_MODES && !best.effects.is_empty() && f.chi_square < NEAR * best.chi_square
        };
        for candidate in candidates.iter().skip(1).filter(near).take(BESIDE) {
            for more in self.extended(level, candidate, bare)? {
                if !found.iter().any(|f| is_same_set(&f.effects, &more.effects)) {
                    found.push(more);
                }
            }
        }
        Ok(self.sorted(level, found))
    }

    /// Fits of `best` with one effect more, best first; `bare` is the model as it is, on the shortest parts.
    pub(super) fn extended(
        &self,
        level: usize,
        best: &FittedRecords,
        bare: &FittedRecords,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        // The first effect is looked for beside the model as it is, whose stiffness is not bent to what is missing.
        let base = if best.effects.is_empty() && level == 0 { bare } else { best };
        let (scored, gain) = self.scored(level, best, &self.all_places(), &self.laws);
        let several = self.records.kept > FEW_MODES && !best.effects.is_empty();
        if several && gain < PROMISED * best.chi_square {
            return Ok(Vec::new());
        }
        // Beside a fit that leaves no more than noise the first order holds.
        let unit = scale(best);
        if misfit(best) < AGREES && gain < FOUND * (GAIN + information(best, unit)) * unit {
            return Ok(Vec::new());
        }
        let mut starts = self.begun(level, best, base);
        starts.splice(0..0, scored);
        starts.retain(|s| s.effects.split_last().is_none_or(|(new, others)| !self.repeats(others, new)));
        let starts = self.nearest(level, starts, scale(best));
        let free = self.records.kept <= FEW_MODES && self.levels[level].list.iter().all(|r| r.forces.is_empty());
        let mut found: Vec<FittedRecords> = Vec::new();
        add_begun(&mut found, self.multi_start_fits(level, &starts, free));
        self.control.check()?;
        keep(&mut found, FOLLOWED, MOST_LEFT[0]);
        let follow = |k: usize| self.fit(level, &found[k], 1.0, FOLLOWING).ok();
        let mut followed: Vec<FittedRecords> = self.control.map(found.len(), follow).into_iter().flatten().collect();
        keep(&mut followed, FOLLOWED, MOST_LEFT[0]);
        self.control.check()?;
        let ended = self.control.map(followed.len().min(ENDED), |k| self.to_its_end(level, &followed[k]).ok());
        followed.iter_mut().zip(ended).for_each(|(own, ended)| *own = ended.unwrap_or_else(|| own.clone()));
        self.beside_neighbours(level, self.sorted(level, followed))
    }

    /// Whether an effect is of the law of one that is there, at the same place or a neighbouring one: together they would be one effect
    /// between both places, which a model that is off a little asks for at every place.
    fn repeats(&self, others: &[Source], new: &Source) -> bool {
        let dofs = |s: &Source| match &s.place {
            Place::Dofs(dofs) => dofs.clone(),
            _ => Vec::new(),
        };
        let pairs = Family::EachPair.places(self.records.structure);
        let near = |a: usize, b: usize| {
            let joins = |place: &Place| matches!(place, Place::Dofs(pair) if pair.contains(&a) && pair.contains(&b));
            a == b || pairs.iter().any(joins)
        };
        let same = |other: &&Source| other.effect == new.effect;
        others.iter().filter(same).any(|o| dofs(o).iter().any(|&a| dofs(new).iter().any(|&b| near(a, b))))
    }

    /// The starts that leave least before anything is fitted, [`BEGUN`] of them; those of other laws than they before others of the same.
    fn nearest(&self, level: usize, starts: Vec<FittedRecords>, unit: f64) -> Vec<FittedRecords> {
        let problem = self.problem(level, 1.0);
        let left = |k: usize| problem.left(&starts[k]).map_or(f64::INFINITY, |left| left.total(unit));
        let mut order: Vec<(f64, usize)> = self.control.map(starts.len(), left).into_iter().zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let law = |k: usize| starts[k].effects.last().map(|e| e.effect);
        let first_of_law = |n: &usize| !order[..*n].iter().any(|(_, k)| law(*k) == law(order[*n].1));
        let (firsts, others): (Vec<usize>, Vec<usize>) = (0..order.len()).partition(first_of_law);
        let mut taken: Vec<usize> = (0..order.len().min(BEGUN / 2)).collect();
        for n in firsts.into_iter().chain(others) {
            if taken.len() < BEGUN && !taken.contains(&n) {
                taken.push(n);
            }
        }
        taken.into_iter().map(|n| starts[order[n].1].clone()).collect()
    }

    /// Fits, best first, with those of neighbours in place of the last law of the best: its generalisations and its special cases.
    pub(super) fn beside_neighbours(
        &self,
        level: usize,
        mut found: Vec<FittedRecords>,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let mut generalised = Vec::new();
        // A generalisation may have come further than the special case to which it has converged, and that special case have others.
        for _ in 0..3 {
            let starts = self.neighbour_starts(level, &found, &mut generalised)?;
            if starts.is_empty() {
                break;
            }
            found = self.with_begun(level, found, &starts)?;
        }
        let mut elsewhere = self.starts_at_candidate_places(level, &found)?;
        if level < GROWING && !self.control.is_late() {
            elsewhere.extend(self.starts_of_equal_work(level, &found));
        }
        if !elsewhere.is_empty() {
            found = self.with_begun(level, found, &elsewhere)?;
            // At its new place it may be a special case as well.
            if !Self::is_generalised(&found, &generalised) {
                let starts = self.neighbour_starts(level, &found, &mut generalised)?;
                found = self.with_begun(level, found, &starts)?;
            }
        }
        let found = self.moved_along(level, found)?;
        let whole = level + 1 == self.levels.len();
        let found = if whole || self.is_freed_early() { self.with_best_freed(level, found)? } else { found };
        if whole { self.told_as_special_cases(level, found) } else { Ok(found) }
    }

    /// Fits with those that are begun at `starts`, best first; what leaves far too much is pruned.
    pub(super) fn with_begun(
        &self,
        level: usize,
        mut found: Vec<FittedRecords>,
        starts: &[FittedRecords],
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let fits = |list: &[FittedRecords], rounds| {
            self.control.map(list.len(), |k| self.fit(level, &list[k], 1.0, rounds).ok())
        };
        let mut begun = Vec::new();
        add_begun(&mut begun, self.multi_start_fits(level, starts, false));
        begun.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
        let least = found.iter().chain(&begun).map(|f| f.chi_square).fold(f64::INFINITY, f64::min);
        let is_near = |f: &&FittedRecords| f.chi_square <= MOST_LEFT[0] * least.max(NOISE * f.count as f64);
        let few = begun.iter().take(FOLLOWED_BESIDE).take_while(is_near).count();
        let others = begun.split_off(few);
        add_begun(&mut found, fits(&begun, FOLLOWING));
        add_begun(&mut found, others.into_iter().map(Some).collect());
        self.control.check()?;
        if !self.control.is_late() {
            self.pruned.add_all(&found, MOST_LEFT[0], NOISE);
        }
        Ok(self.sorted(level, found))
    }

    /// Those that may be told, by evidence; on whole records without those that a simpler law makes needless.
    pub(super) fn sorted(&self, level: usize, mut found: Vec<FittedRecords>) -> Vec<FittedRecords> {
        found.iter_mut().for_each(|fit| self.put_on_effect(fit));
        found.retain(|f| {
            f.effects.last().is_none_or(|e| !e.is_disguised() && is_allowed(self.excluded, e, &last_deviations(f)))
        });
        if let Some(least) = found.iter().map(|f| f.chi_square).min_by(f64::total_cmp) {
            let best = found.iter().find(|f| f.chi_square == least).map_or(1.0, scale);
            found.sort_by(|a, b| evidence(a, best).total_cmp(&evidence(b, best)));
            if level + 1 == self.levels.len() {
                keep_parsimonious(&mut found);
            }
        }
        found
    }
}

/// Adds fits that were begun, of each law at a place the best.
pub(super) fn add_begun(found: &mut Vec<FittedRecords>, begun: Vec<Option<FittedRecords>>) {
    for fitted in begun.into_iter().flatten() {
        let same = |o: &FittedRecords| o.effects.last().zip(fitted.effects.last()).is_some_and(|(a, b)| a.is_same(b));
        match found.iter_mut().find(|o| same(o)) {
            Some(own) if fitted.chi_square < own.chi_square => *own = fitted,
            Some(_) => {}
            None => found.push(fitted),
        }
    }
}

/// The best `count` by their squared residual, none of them `most` times the least.
pub(super) fn keep(found: &mut Vec<FittedRecords>, count: usize, most: f64) {
    found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    found.truncate(count);
    let least = found.first().map_or(0.0, |f| f.chi_square);
    found.retain(|f| f.chi_square <= most * least.max(NOISE * f.count as f64));
}

//! The stated fit: the corrections of a fit that a project file can state, so that the error that a search predicts is the one that
//! comparing the corrected project shows.
//!
//! A search varies all stiffness and that of every mode at once, which are nearly collinear. The fit is made again with all stiffness
//! alone, with all mass beside it, with modes alone and with neither, each beside the known sources that moved, and the one with the
//! most evidence is stated. Errors of shapes, offsets and a shift of every record, which no project states, stay free meanwhile, or the
//! corrections would absorb them; the error is predicted without them.

use super::compare::started_from;
use super::data::{RecordData, RecordDiagnosisError};
use super::evidence::{AGREES, information, misfit, parameters, scale};
use super::fitted::FittedRecords;
use super::problem::{FitProblem, Free, modes};
use super::restrictions::Restrictions;
use super::search::Search;
use crate::diagnosis::result::Added;
use crate::effects::{Place, Source};
use dashpot_numerics::dot;

/// Deviations from 0 at which a correction of a known source and of a mode is kept.
const MOVED: [f64; 2] = [4.0, 2.0];
/// Least change of a known source and of a mode that is stated.
const LEAST: [f64; 2] = [0.01, 1e-4];
/// Rounds and steps of the fits.
const ROUNDS: [usize; 2] = [2, 4];

/// Choices that are fitted, those first that cost least to first order. All gave the same verdicts on records of seeds 3400 to 3405.
const FITTED: usize = 3;

/// A choice of corrections that may stand for all of those of a fit.
struct Choice<'f> {
    fit: &'f FittedRecords,
    stiffness: bool,
    by_mode: bool,
    mass: bool,
    /// Corrections that are free, in the order of their variables.
    free: Vec<bool>,
}

impl Search<'_> {
    /// `fit` with the corrections that a project can state, its effects fitted beside them; `fit` itself where time is up.
    pub(super) fn stated_fit(&self, fit: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        if self.control.is_late() {
            return Ok(fit.clone());
        }
        let all = Restrictions::new(self, fit)?;
        let versions = self.by_sizes(fit);
        let mut best = self.plainest_choice(&all, versions.iter().flat_map(|(fit, sizes)| self.choices(fit, sizes)))?;
        // What agrees with the records only by sizes that are not sure each is stated with all of them.
        let enough = self.records.agreement(AGREES);
        if misfit(fit) <= enough && best.as_ref().is_some_and(|(stated, _)| misfit(stated) > enough) {
            let sizes = vec![true; fit.known.len() + self.records.damped()];
            let with_all = self.plainest_choice(&all, self.choices(fit, &sizes).into_iter())?;
            best = best.into_iter().chain(with_all).reduce(|a, b| if is_plainer(&b, &a) { b } else { a });
        }
        Ok(best.map_or_else(|| fit.clone(), |(fit, _)| fit))
    }

    /// The plainest fit, with its number of corrections, of those of some choices that cost least to first order.
    fn plainest_choice<'f>(
        &self,
        all: &Restrictions,
        choices: impl Iterator<Item = Choice<'f>>,
    ) -> Result<Option<(FittedRecords, usize)>, RecordDiagnosisError> {
        let mut best = None;
        let weights = all.information_of_shifts();
        let mut choices: Vec<(f64, Choice)> =
            choices.map(|choice| (self.first_order_cost(all, &choice.free), choice)).collect();
        choices.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (cost, choice) in choices.into_iter().take(FITTED) {
            // What costs more to first order than another does is not the plainest.
            let is_enough = |stated: &(FittedRecords, usize)| {
                is_plainest(&stated.0, choice.fit) || cost_of(stated, scale(choice.fit)) < cost
            };
            if best.as_ref().is_some_and(is_enough) {
                break;
            }
            self.fitted_as(&choice, &weights, &mut best)?;
        }
        Ok(best)
    }

    /// `fit` with the sizes of known sources that moved; where the damping of modes is free beside those of laws of the whole structure,
    /// which say much the same, once with these alone and once with that alone. Each with the sizes that are free.
    fn by_sizes(&self, fit: &FittedRecords) -> Vec<(FittedRecords, Vec<bool>)> {
        let first = parameters(fit);
        let wide = scale(fit).sqrt();
        // A law that contains the known one trades with it: neither can be stated without the other.
        let trades = |j: usize| {
            let known = &self.records.known[j];
            fit.effects.iter().any(|e| e.place.is_same(&known.place) && e.effect.contains(known.effect))
        };
        let moved = |j: usize| {
            if trades(j) {
                return fit.known[j].abs() > LEAST[0];
            }
            let deviation = fit.deviations.get(first + 1 + j).copied().unwrap_or(f64::INFINITY) * wide;
            fit.known[j].abs() > (MOVED[0] * deviation).max(LEAST[0])
        };
        let damped = self.records.damped();
        let is_whole = |j: &usize| damped > 0 && self.records.known[*j].place == Place::Whole(None);
        let version = |by_damping: bool| {
            let mut own = fit.clone();
            let free = |j: usize| if is_whole(&j) { !by_damping } else { moved(j) };
            let mut sizes: Vec<bool> = (0..fit.known.len()).map(free).collect();
            if by_damping {
                let stated = self.records.modal_damping(&vec![0.0; fit.known.len()]);
                let sized = self.records.modal_damping(&fit.known);
                // What is not damped, as a motion of the whole structure, has no factor.
                let damped = own.damping.iter_mut().zip(sized.iter().zip(&stated)).filter(|(_, (_, b))| **b > 0.0);
                damped.for_each(|(v, (a, b))| *v += (a / b).ln());
            } else {
                own.damping.fill(0.0);
            }
            own.known.iter_mut().zip(&sizes).filter(|(_, free)| !**free).for_each(|(v, _)| *v = 0.0);
            sizes.resize(fit.known.len() + damped, by_damping);
            (own, sizes)
        };
        if damped > 0 { vec![version(false), version(true)] } else { vec![version(false)] }
    }

    /// What may be free beside `sizes` of `fit`: nothing, all stiffness, the stiffness of modes, and these beside all mass.
    fn choices<'f>(&self, fit: &'f FittedRecords, sizes: &[bool]) -> Vec<Choice<'f>> {
        let count = modes(self.records);
        let choice = |stiffness: bool, by_mode: bool, mass: bool| {
            let sizes = sizes.iter().copied().chain(vec![by_mode; count]);
            let parts = vec![false; self.records.parts.len()];
            let free = std::iter::once(stiffness).chain(sizes).chain([mass]).chain(parts).collect();
            Choice { fit, stiffness, by_mode, mass, free }
        };
        let mut choices = vec![choice(false, false, false), choice(true, false, false)];
        if count > 0 {
            choices.push(choice(false, true, false));
        }
        // A motion without a force shows no mass.
        if self.records.list.iter().any(RecordData::shows_mass) {
            choices.push(choice(true, false, true));
            if self.records.has_one_shape() {
                choices.push(choice(false, false, true));
            }
            if fit.mass != 0.0 && count > 0 {
                choices.push(choice(false, true, true));
            }
        }
        choices
    }

    /// What a choice costs to first order, without those of its sizes and modes that would not stand out; less than any other where
    /// derivatives that run away tell nothing, so that it is fitted.
    fn first_order_cost(&self, all: &Restrictions, free: &[bool]) -> f64 {
        let Some(restricted) = all.with(free) else { return f64::NEG_INFINITY };
        let mut few = free.to_vec();
        for (k, (value, deviation)) in restricted.sizes.iter().enumerate() {
            few[1 + k] &= self.stands_out(k, *value, *deviation);
        }
        let without = if few == free { None } else { all.with(&few) };
        restricted.cost.min(without.map_or(f64::INFINITY, |w| w.cost))
    }

    /// Puts the plainest fit with a choice of corrections in place of `best`, where it is plainer.
    fn fitted_as(
        &self,
        choice: &Choice,
        weights: &[f64],
        best: &mut Option<(FittedRecords, usize)>,
    ) -> Result<(), RecordDiagnosisError> {
        let mut next = self.fitted_anew(&self.start_of(choice), choice.free.clone())?;
        let mut found = vec![(next.clone(), choice.free.clone())];
        let free = self.kept(&mut next, choice.free.clone());
        if choice.by_mode || free != choice.free {
            found.push((self.fitted_anew(&next, free.clone())?, free));
        }
        let first_mode = 1 + self.records.sizes();
        for (mut stated, free) in found {
            keep_deviations(&mut stated, choice.fit);
            if choice.stiffness || choice.by_mode {
                without_common_shift(&mut stated, choice.by_mode.then(|| &free[first_mode..]), weights);
            } else if common_shift(&stated, weights).abs() >= LEAST[1] {
                // What all records have in common is no scatter, and no project states it as that.
                continue;
            }
            let own = (stated, number(&free));
            if best.as_ref().is_none_or(|best| is_plainer(&own, best)) {
                *best = Some(own);
            }
        }
        Ok(())
    }

    /// Where the fit of a choice begins: what errors of parts and of all stiffness do to frequencies is done by what is free.
    fn start_of(&self, choice: &Choice) -> FittedRecords {
        let Choice { fit, by_mode, mass, .. } = choice;
        let by_parts = self.records.stiffness_by_parts(&fit.parts);
        // Where all mass is held, frequencies are as they were by less stiffness.
        let held = if *mass { fit.stiffness } else { fit.stiffness - fit.mass };
        let uniform = held + fit.modes[self.dominant()] + by_parts[self.dominant()];
        let mut start = FittedRecords::clone(fit);
        start.stiffness = if choice.stiffness { uniform } else { 0.0 };
        let of_modes = start.modes.iter_mut().zip(by_parts);
        of_modes.for_each(|(v, by_parts)| *v = if *by_mode { *v + by_parts + held } else { 0.0 });
        start.mass = if *mass { fit.mass } else { 0.0 };
        start.parts.fill(0.0);
        start
    }

    fn fitted_anew(
        &self,
        start: &FittedRecords,
        corrections: Vec<bool>,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        // The evidence of an effect is that of the fit in which all else was free, or it would absorb what is fixed here.
        let free = Free { corrections, shifts: true, shapes: !self.whole().has_one_shape(), effects: false };
        let problem = FitProblem { records: self.whole(), free, share: 1.0, control: self.control };
        match problem.chord_fit(start, ROUNDS) {
            // A start without its corrections may run away: then it does not compete.
            Err(RecordDiagnosisError::Model { .. }) => Ok(FittedRecords { chi_square: f64::INFINITY, ..start.clone() }),
            other => other,
        }
    }

    /// What of `free` moved among the sizes of known sources, the damping of modes and their stiffness; the rest is put back.
    fn kept(&self, fit: &mut FittedRecords, mut free: Vec<bool>) -> Vec<bool> {
        let (first, wide) = (parameters(fit) + 1, scale(fit).sqrt());
        let modes = fit.modes.iter_mut().take(modes(self.records));
        let values = fit.known.iter_mut().chain(&mut fit.damping).chain(modes);
        for (k, value) in values.enumerate() {
            let deviation = fit.deviations.get(first + k).copied().unwrap_or(f64::INFINITY) * wide;
            if free[1 + k] && !self.stands_out(k, *value, deviation) {
                (*value, free[1 + k]) = (0.0, false);
            }
        }
        free
    }

    /// Whether the size of a known source, the damping or the stiffness of a mode, of this number, is stated.
    fn stands_out(&self, k: usize, value: f64, deviation: f64) -> bool {
        let kind = usize::from(k >= self.records.sizes());
        value.abs() > (MOVED[kind] * deviation).max(LEAST[kind])
    }

    /// The mode that is nearest to the highest peak of the first record.
    fn dominant(&self) -> usize {
        let omega = std::f64::consts::TAU * self.records.list[0].dominant_hz;
        let off = |r: &usize| (self.records.modes.omega[*r] - omega).abs();
        (0..self.records.kept).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// What comparing the project shows with the corrections of `stated` and these effects, their parameters as they are.
    pub(super) fn predicted_error(
        &self,
        stated: &FittedRecords,
        effects: &[Source],
    ) -> Result<f64, RecordDiagnosisError> {
        let mut records = self.plain.clone();
        records.known.extend_from_slice(effects);
        let mut start = FittedRecords {
            stiffness: stated.stiffness,
            damping: stated.damping.clone(),
            modes: stated.modes.clone(),
            mass: stated.mass,
            ..FittedRecords::start(&records, &[])
        };
        start.known[..stated.known.len()].copy_from_slice(&stated.known);
        // From where comparing the project begins, or it might end elsewhere.
        let fitted = started_from(&records, start, &self.control.unhurried());
        match fitted.and_then(|fit| fit.error(&records, 0.0, 1.0)) {
            Err(RecordDiagnosisError::Model { .. }) => Ok(f64::INFINITY),
            other => other,
        }
    }
}

/// Gives the effects of the stated fit the deviations that they have in `fit`, on the scale of the former.
fn keep_deviations(stated: &mut FittedRecords, fit: &FittedRecords) {
    let share = (scale(fit) / scale(stated)).sqrt();
    let count = parameters(fit).min(stated.deviations.len());
    for (stated, own) in stated.deviations[..count].iter_mut().zip(&fit.deviations) {
        *stated = own * share;
    }
}

/// What the shifts of all records have in common: their mean, each weighted by what its record tells of it.
fn common_shift(stated: &FittedRecords, weights: &[f64]) -> f64 {
    let all: f64 = weights.iter().sum();
    if all > 0.0 { dot(&stated.shifts, weights) / all } else { 0.0 }
}

/// Puts what the shifts of all records have in common on the stiffness of the modes, of which these are `free`, or on all stiffness where
/// there is no list of them: the same model. A mode that was held is known as well as that is.
fn without_common_shift(stated: &mut FittedRecords, free: Option<&[bool]>, weights: &[f64]) {
    let common = common_shift(stated, weights);
    stated.shifts.iter_mut().for_each(|v| *v -= common);
    let Some(free) = free else {
        stated.stiffness += common;
        return;
    };
    stated.modes.iter_mut().for_each(|v| *v += common);
    let first = parameters(stated) + 1 + stated.known.len() + stated.damping.len();
    let deviation = weights.iter().sum::<f64>().sqrt().recip();
    let held = stated.deviations.iter_mut().skip(first).zip(free).take(stated.modes.len());
    held.filter(|(_, free)| !**free).for_each(|(own, _)| *own = deviation);
}

/// Number of corrections that are free.
fn number(free: &[bool]) -> usize {
    free.iter().filter(|f| **f).count()
}

/// Cost of a fit with its number of corrections on some scale.
fn cost_of((fit, count): &(FittedRecords, usize), unit: f64) -> f64 {
    fit.chi_square / unit + fit.prior + *count as f64 * information(fit, unit)
}

/// Whether the first of two fits, each with its number of corrections, has more evidence.
fn is_plainer(new: &(FittedRecords, usize), old: &(FittedRecords, usize)) -> bool {
    let unit = scale(if misfit(&new.0) < misfit(&old.0) { &new.0 } else { &old.0 });
    cost_of(new, unit) < cost_of(old, unit)
}

/// Whether no fit with a correction more can have more evidence than `stated`: even the one with `all` of them free leaves hardly less.
fn is_plainest(stated: &FittedRecords, all: &FittedRecords) -> bool {
    let unit = scale(all);
    stated.chi_square / unit + stated.prior <= all.chi_square / unit + information(all, unit)
}

/// The effects of a fit with their deviations, those of `stated` where they are its own.
pub(super) fn added_as_stated(stated: &[Added], added: &Added) -> Added {
    stated.iter().find(|t| t.source.is_same(&added.source)).unwrap_or(added).clone()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{chain, oscillator, source, whole};
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;

    /// Logarithm of the factor on a known dashpot that is stated beside `effect`, and whether it stays free: of two tenths, known to one.
    fn stated_beside(effect: Source) -> (f64, bool) {
        let structure = oscillator(1.0, 400.0);
        let wave = |n: usize| 1e-2 * (-1e-2 * n as f64).exp() * (0.2 * n as f64).cos();
        let run = decay(1e-2, vec![(0..400).map(wave).collect()]);
        let known = [source(Effect::Viscous, &[0], &[2.0])];
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let mut deviations = vec![0.1; effect.parameters.len() + 2];
        deviations.push(0.0);
        let start = FittedRecords::start(&records, &[effect]);
        let fit = FittedRecords { known: vec![0.2], chi_square: 400.0, count: 400, deviations, ..start };
        let (own, sizes) = search.by_sizes(&fit).swap_remove(0);
        (own.known[0], sizes[0])
    }

    /// Damping in proportion to stiffness does not damp the motion of a free structure as a whole, which keeps its damping of nothing while
    /// the size of the law becomes that of the other mode.
    #[test]
    fn a_free_structure_has_a_mode_without_damping() {
        let structure = chain(&[1.0, 2.0], &[0.0, 0.0], &[900.0]);
        let wave = |n: usize, dof: usize| {
            [1.0, -0.5][dof] * (-5e-3 * n as f64).exp() * (0.37 * n as f64).cos() + 1e-3 * n as f64
        };
        let run = decay(1e-2, (0..2).map(|dof| (0..400).map(|n| wave(n, dof)).collect()).collect());
        let known = [whole(Effect::StiffnessProportional, 1e-3)];
        let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let fit = FittedRecords { known: vec![0.2], ..FittedRecords::start(&records, &[]) };
        let (by_damping, _) = search.by_sizes(&fit).swap_remove(1);
        let [free, bent] = by_damping.damping[..] else { panic!("{:?}", by_damping.damping) };
        assert!(free.abs() < 0.21 && (bent - 0.2).abs() < 1e-9, "{:?}", by_damping.damping);
    }

    /// What all records have in common moves every mode; one that was held before is known as well as that.
    #[test]
    fn a_mode_that_was_held_is_known_as_well_as_the_common_shift() {
        let mut stated = FittedRecords {
            modes: vec![0.01, 0.0],
            shifts: vec![0.004, 0.0],
            ..FittedRecords::of_effects(vec![], 1.0)
        };
        stated.deviations = vec![1.0, 2e-3, 1.0];
        without_common_shift(&mut stated, Some(&[true, false]), &[300.0, 100.0]);
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(&stated.modes, &[0.013, 0.003]) && near(&stated.shifts, &[0.001, -0.003]), "{stated:?}");
        assert!(near(&stated.deviations, &[1.0, 2e-3, 0.05]), "{:?}", stated.deviations);
    }

    /// A power law of exponent 1 is the dashpot: what it takes over the dashpot loses, however uncertain the share of each.
    #[test]
    fn a_known_law_keeps_its_size_beside_one_that_contains_it() {
        assert_eq!(stated_beside(source(Effect::Power, &[0], &[0.4, 1.1])), (0.2, true));
        assert_eq!(stated_beside(source(Effect::Coulomb, &[0], &[0.4])), (0.0, false));
        let elsewhere = Source::known(Effect::Power, Place::Whole(None), &[0.4, 1.1]);
        assert_eq!(stated_beside(elsewhere), (0.0, false));
    }
}

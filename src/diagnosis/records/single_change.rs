//! One mass or spring in place of a stiffness of every mode.
//!
//! ```text
//! d ln omega_r^2 = a - m p_r^2   or   a + k p_r^2 / omega_r^2,    p_r = phi_r^T b        (first order)
//! ```
//!
//! Corrections mode by mode can stand for any change of mass and stiffness. Where all stiffness, all mass and the known sources do
//! not suffice, but one mass or spring at one place beside them does, that is said: one number in place of one a mode.

use super::data::{RecordDiagnosisError, Records};
use super::evidence::{AGREES, evidence, information, misfit, scale};
use super::fitted::FittedRecords;
use super::part_directions::PART;
use super::problem::{FitProblem, Free, PRIORS, modes};
use super::search::{Search, SetsBySize};
use crate::diagnosis::updating::part_error::{size_of, takes_away};
use crate::effects::{Constant, Effect, Family, Place, Source, State};
use crate::math::least_squares::LeastSquares;
use crate::structure::Part;
use faer::Mat;

/// Places and laws that are fitted, and the steps of their fits.
const FITTED: usize = 4;
const STEPS: usize = 10;
/// Fewest modes whose frequencies can tell a place.
const FEWEST_MODES: usize = 3;
/// Corrections over their prior deviations up to which they are errors as every model has them, which stand for nothing else.
const PLAUSIBLE: f64 = 2.0;
/// The largest from which on it is asked whether one mass or spring beside all corrections makes it ordinary.
const OUTLYING: f64 = 4.0;
/// Rounds and steps of a fit beside all corrections, times that it goes on, and the gain of evidence below which it does not.
const ROUNDS: [usize; 2] = [3, 4];
const AGAIN: usize = 6;
const LITTLE: f64 = 1.0;
/// Gain of evidence that is asked for.
const GAIN: f64 = 12.0;

impl Search<'_> {
    /// Fits of one mass or spring to whole records, best first, where `corrected` needs more than errors as every model has them and they do
    /// not: in place of the stiffness of single modes, else beside all corrections.
    pub(super) fn single_changes(&self, corrected: &FittedRecords) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let alone = self.changes_alone(corrected)?;
        if alone.is_empty() { self.changes_beside(corrected) } else { Ok(alone) }
    }

    /// Those beside all corrections, of which one is far beyond what is plausible.
    fn changes_beside(&self, corrected: &FittedRecords) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let level = self.levels.len() - 1;
        if misfit(corrected) > AGREES || !self.is_outlying(corrected) || self.control.is_late() {
            return Ok(Vec::new());
        }
        let laws: Vec<Effect> = self.laws.iter().copied().filter(|effect| effect.is_mass_or_spring()).collect();
        let mut starts = self.in_place_of_parts(corrected);
        starts.extend(self.scored(level, corrected, &self.all_places(), &laws).0);
        let unit = scale(corrected);
        // What corrections stand for goes over to the effect step by step: they hold each other along a valley of the priors.
        let fit = |k: usize| {
            let mut fit = self.fit(level, &starts[k], 1.0, ROUNDS).ok()?;
            for _ in 0..AGAIN {
                let next = self.fit(level, &fit, 1.0, ROUNDS).ok()?;
                let gain = evidence(&fit, unit) - evidence(&next, unit);
                fit = next;
                if gain < LITTLE {
                    break;
                }
            }
            Some(fit)
        };
        let mut found: Vec<FittedRecords> =
            self.control.map(starts.len().min(FITTED), fit).into_iter().flatten().collect();
        self.control.check()?;
        found.retain(|f| misfit(f) < AGREES && evidence(f, unit) + GAIN < evidence(corrected, unit));
        found.retain(|f| !f.effects.last().is_some_and(takes_away));
        found.sort_by(|a, b| evidence(a, unit).total_cmp(&evidence(b, unit)));
        Ok(found)
    }

    /// `corrected` with a mass or spring in place of each part that is corrected far beyond what is plausible.
    fn in_place_of_parts(&self, corrected: &FittedRecords) -> Vec<FittedRecords> {
        let (records, structure) = (self.records, self.records.structure);
        let in_place_of = |(p, (part, logarithm)): (usize, (Part, f64))| {
            let (kind, place) = match part {
                Part::PointMass(dof) => (Constant::Mass, vec![dof]),
                Part::GroundSpring(dof) => (Constant::Stiffness, vec![dof]),
                Part::Coupling(pair) => (Constant::Stiffness, pair.to_vec()),
                _ => return None,
            };
            let effect = self.laws.iter().copied().find(|e| e.is_mass_or_spring() && e.adds_to(kind))?;
            let size = size_of(structure, part) * logarithm.exp_m1();
            let mut start = corrected.clone();
            start.effects.push(Source::known(effect, Place::Dofs(place), &[size]));
            // The directions are orthogonal: what the part is wrong by, taken out of each.
            let weights = records.parts.weights.iter();
            start.parts.iter_mut().zip(weights).for_each(|(z, w)| *z -= w[p] * logarithm / PART.powi(2));
            (logarithm > OUTLYING * PART && size > 0.0).then_some(start)
        };
        let starts = records.parts.logarithms(&corrected.parts).into_iter().enumerate().filter_map(in_place_of);
        starts.filter(|s| !self.excluded.iter().any(|e| s.effects.iter().any(|own| own.is_same(e)))).collect()
    }

    /// Whether the best set of one mass or spring is more likely than `corrected`, which needs a correction far beyond what is plausible.
    pub(super) fn is_plainer(&self, by_size: &SetsBySize, corrected: &FittedRecords) -> bool {
        let unit = scale(corrected);
        let gain = |single: &FittedRecords| evidence(corrected, unit) - evidence(single, unit);
        self.is_outlying(corrected) && by_size.last.first().is_some_and(|single| gain(single) > GAIN)
    }

    /// Whether one correction of a fit of whole records is far beyond what is plausible.
    fn is_outlying(&self, fit: &FittedRecords) -> bool {
        let parts = self.records.parts.logarithms(&fit.parts);
        let most = parts.iter().map(|(_, v)| v.abs() / PART).fold(0.0, f64::max);
        largest_correction(fit).max(most) > OUTLYING
    }

    /// Those in place of the stiffness of single modes, which `corrected` needs.
    fn changes_alone(&self, corrected: &FittedRecords) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let records = self.whole();
        let fit = |start: &FittedRecords| {
            FitProblem { records, free: Free::but_modes(records), share: 1.0, control: self.control }
                .improve(start, STEPS)
        };
        if modes(records) < FEWEST_MODES || misfit(corrected) > AGREES || largest_correction(corrected) < PLAUSIBLE {
            return Ok(Vec::new());
        }
        let by_parts = records.stiffness_by_parts(&corrected.parts);
        let mean = corrected.modes.iter().chain(&by_parts).sum::<f64>() / corrected.modes.len() as f64;
        let plain = FittedRecords {
            stiffness: corrected.stiffness - corrected.mass + mean,
            modes: vec![0.0; records.kept],
            mass: 0.0,
            parts: vec![0.0; records.parts.len()],
            ..corrected.clone()
        };
        if misfit(&fit(&plain)?) < AGREES {
            return Ok(Vec::new());
        }
        let starts = changes(records, corrected);
        let begin = |k: usize| {
            let (stiffness, source) = &starts[k];
            let start = FittedRecords { stiffness: *stiffness, effects: vec![source.clone()], ..plain.clone() };
            fit(&start).ok()
        };
        let count = starts.len().min(FITTED);
        let mut found: Vec<FittedRecords> = self.control.map(count, begin).into_iter().flatten().collect();
        self.control.check()?;
        let unit = scale(corrected);
        let by_mode = evidence(corrected, unit) + modes(records) as f64 * information(corrected, unit);
        found.retain(|f| misfit(f) < AGREES && evidence(f, unit) + GAIN < by_mode);
        found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
        Ok(found)
    }
}

/// The largest correction of the stiffness of a mode or of a part over its prior deviation.
fn largest_correction(fit: &FittedRecords) -> f64 {
    let of_modes = fit.modes.iter().map(|v| v / PRIORS[3]);
    of_modes.chain(fit.parts.iter().copied()).fold(0.0, |most, v| most.max(v.abs()))
}

/// Masses and springs with the logarithm of all stiffness beside them, in the order in which they explain the stiffness of the
/// modes.
fn changes(records: &Records, corrected: &FittedRecords) -> Vec<(f64, Source)> {
    let structure = records.structure;
    let mut places = Family::EachTranslation.places(structure);
    places.extend(Family::EachPair.places(structure));
    let laws = || Effect::ALL.into_iter().filter(|effect| effect.is_mass_or_spring());
    let changes_at = |place| laws().filter_map(|law| change(records, corrected, law, place)).collect::<Vec<_>>();
    let mut all: Vec<(f64, f64, Source)> = places.iter().flat_map(changes_at).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.into_iter().map(|(_, stiffness, source)| (stiffness, source)).collect()
}

/// What a law at a place leaves of the stiffness of the modes, the logarithm of all stiffness beside it, and the law with its size.
fn change(records: &Records, corrected: &FittedRecords, effect: Effect, place: &Place) -> Option<(f64, f64, Source)> {
    let leg = place.legs().first().copied()?;
    let by = |r: usize| {
        let shape = leg.relative(|i| records.modes.shapes[(i, r)]);
        if effect.adds_to(Constant::Mass) { -shape * shape } else { (shape / records.modes.omega[r]).powi(2) }
    };
    let matrix = Mat::from_fn(records.kept, 2, |r, k| if k == 0 { 1.0 } else { by(r) });
    let by_parts = records.stiffness_by_parts(&corrected.parts);
    let all = corrected.stiffness - corrected.mass;
    let wanted: Vec<f64> = (0..records.kept).map(|r| all + corrected.modes[r] + by_parts[r]).collect();
    let solved = LeastSquares::new(matrix.as_ref()).ok()?.solve(&wanted).ok()?.x;
    let left: f64 = (0..records.kept).map(|r| (wanted[r] - solved[0] - solved[1] * by(r)).powi(2)).sum();
    let source = Source { effect, place: place.clone(), state: State::Known, parameters: vec![solved[1]] };
    left.is_finite().then_some((left, solved[0], source))
}

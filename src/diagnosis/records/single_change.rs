//! One mass or spring in place of a stiffness of every mode.
//!
//! ```text
//! d ln omega_r^2 = a - m p_r^2   or   a + k p_r^2 / omega_r^2,    p_r = phi_r^T b        (first order)
//! ```
//!
//! Corrections mode by mode can stand for any change of mass and stiffness. Where all stiffness, all mass and the known sources do
//! not suffice, but one mass or spring at one place beside them does, that is said: one number in place of one a mode.

use super::data::{RecordError, Records};
use super::evidence::{AGREES, evidence, information, misfit, scale};
use super::fitted::FittedRecords;
use super::problem::{FitProblem, Free, modes};
use super::search::Search;
use crate::effects::{Constant, Effect, Family, Place, Source, State};
use crate::math::least_squares::LeastSquares;
use faer::Mat;

/// Places and laws that are fitted, and the steps of their fits.
const FITTED: usize = 4;
const STEPS: usize = 10;
/// Fewest modes whose frequencies can tell a place.
const FEWEST_MODES: usize = 3;
/// Gain of evidence that is asked for.
const GAIN: f64 = 12.0;

impl Search<'_> {
    /// Fits of one mass or spring to whole records, best first, where `corrected` needs the stiffness of single modes and they do
    /// not.
    pub(super) fn single_changes(&self, corrected: &FittedRecords) -> Result<Vec<FittedRecords>, RecordError> {
        let records = self.whole();
        let fit = |start: &FittedRecords| {
            FitProblem { records, free: Free::but_modes(records), share: 1.0, control: self.control }
                .improve(start, STEPS)
        };
        if modes(records) < FEWEST_MODES || misfit(corrected) > AGREES {
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

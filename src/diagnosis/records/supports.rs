//! Supports that give way, where a model takes them for rigid: found before anything is looked for, because they move high modes
//! in ways that no error of the parts of a rigidly held structure resembles.
//!
//! ```text
//! f = k_s / (k_s + k_hh)      evidence of the corrected model over f, on the shortest parts
//! ```
//!
//! `k_s` is the spring in place of the support, `k_hh` the stiffness of the element there ([`Part::Support`]).

use super::data::RecordDiagnosisError;
use super::evidence::{evidence, scale};
use super::fitted::FittedRecords;
use super::model_updating::SHARES;
use super::problem::{FitProblem, Free};
use super::search::Search;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::structure::Part;

/// Factors that are tried.
const FACTORS: [f64; 6] = [0.9, 0.75, 0.55, 0.38, 0.22, 0.12];
/// Times that the distance to the neighbours of the best is halved.
const HALVINGS: usize = 3;
/// Rounds and steps of the fits.
const ROUNDS: [usize; 2] = [3, 3];
/// Gain of evidence by which supports must give way, and share of the squared residual that may be left.
const GAIN: f64 = 40.0;
const LEFT: f64 = 0.6;

/// A try: the factor, the fit with it.
type Tried = (f64, FittedRecords);

impl Search<'_> {
    /// Supports that give way, with their factors; empty where that explains nothing.
    pub(super) fn giving_way(&self, bare: &FittedRecords) -> Result<Vec<Correction>, RecordDiagnosisError> {
        let supports: Vec<Part> = self.records.structure.supports().into_iter().map(Part::Support).collect();
        if supports.is_empty() || self.records.kept < 2 {
            return Ok(Vec::new());
        }
        let base = self.carried(bare, self.levels.len() - 1, 0)?;
        let Some(rigid) = self.with_supports(&base, &[], 1.0) else { return Ok(Vec::new()) };
        let mut groups: Vec<Vec<Part>> = supports.iter().map(|s| vec![*s]).collect();
        if supports.len() > 1 {
            groups.push(supports);
        }
        let tries: Vec<(usize, f64)> = (0..groups.len()).flat_map(|g| FACTORS.map(|f| (g, f))).collect();
        let try_factor = |k: usize| {
            let (g, factor) = tries[k];
            Some((g, (factor, self.with_supports(&base, &groups[g], factor)?)))
        };
        let found: Vec<(usize, Tried)> = self.control.map(tries.len(), try_factor).into_iter().flatten().collect();
        self.control.check()?;
        // What is left decides what corrections cost: those of the fit that leaves least.
        let least = found.iter().min_by(|a, b| a.1.1.chi_square.total_cmp(&b.1.1.chi_square));
        let unit = least.map_or(1.0, |(_, (_, fit))| scale(fit));
        let worth = |(_, (_, fit)): &(usize, Tried)| evidence(fit, unit);
        let Some((g, best)) = found.into_iter().min_by(|a, b| worth(a).total_cmp(&worth(b))) else {
            return Ok(Vec::new());
        };
        // Between the factors that are tried high modes move by many widths of their resonances.
        let gain = |fit: &FittedRecords| evidence(&rigid, unit) - evidence(fit, unit);
        if gain(&best.1) < GAIN {
            return Ok(Vec::new());
        }
        let ((factor, best), deviation) = self.refined(&base, &groups[g], best);
        if best.chi_square > LEFT * rigid.chi_square {
            return Ok(Vec::new());
        }
        let correction = |part: &Part| Correction { parameter: UpdatingParameter::Structure(*part), factor, deviation };
        Ok(groups[g].iter().map(correction).collect())
    }

    /// The corrected model on the shortest parts with these supports at a factor; `None` where it runs away.
    fn with_supports(&self, base: &FittedRecords, supports: &[Part], factor: f64) -> Option<FittedRecords> {
        let factors: Vec<(Part, f64)> = supports.iter().map(|s| (*s, factor)).collect();
        let structure = self.records.structure.with_factors(&factors);
        let records = self.levels[0].on(&structure).ok()?;
        let start = FittedRecords { parts: vec![0.0; records.parts.len()], ..base.clone() };
        let free = Free { shifts: false, ..Free::all(&records) };
        let mut fitted = start;
        for share in SHARES {
            let problem = FitProblem { records: &records, free: free.clone(), share, control: self.control };
            fitted = problem.chord_fit(&fitted, ROUNDS).ok()?;
        }
        Some(fitted)
    }

    /// The best factor near one that was tried, with its fit, and its deviation by the curvature of the evidence.
    fn refined(&self, base: &FittedRecords, supports: &[Part], mut best: Tried) -> (Tried, f64) {
        let mut width = 0.4 * best.0.min(1.0 - best.0).max(0.1);
        let unit = scale(&best.1);
        let worth = |fit: &FittedRecords| evidence(fit, unit);
        let mut deviation = width;
        for _ in 0..HALVINGS {
            let sides = [best.0 - width, best.0 + width].map(|f| f.clamp(0.02, 0.99));
            let side_fit = |k: usize| Some((sides[k], self.with_supports(base, supports, sides[k])?));
            let found: Vec<Option<Tried>> = self.control.map(2, side_fit);
            let least = worth(&best.1);
            let worths = found.iter().map(|side| side.as_ref().map_or(f64::INFINITY, |(_, fit)| worth(fit)));
            let bent = (worths.sum::<f64>() - 2.0 * least) / (width * width);
            if bent.is_finite() && bent > 0.0 {
                deviation = (2.0 / bent).sqrt();
            }
            for side in found.into_iter().flatten() {
                if worth(&side.1) < worth(&best.1) {
                    best = side;
                }
            }
            width *= 0.5;
        }
        (best, deviation.max(width))
    }
}

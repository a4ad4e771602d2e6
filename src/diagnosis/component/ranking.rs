//! Single laws and sums in one order: by what they leave of loops that were left out.
//!
//! ```text
//! score_k = n ln(e_k^2) + p_k ln n     e_k: relative error of each record by laws fitted to the others, root mean square;
//!                                      n independent data, p_k parameters
//! ```
//!
//! The first term is minus twice the logarithm of the density of the left-out records with their common variance put at its best (Stone
//! 1977, Journal of the Royal Statistical Society B 39, 44), the second puts laws of more parameters behind those that predict as well,
//! as the information criterion does. Fits of too little evidence to be left out and predicted follow those of as many laws.

use super::fit::{Fitted, Ranked, error, freedom, improved};
use super::search::{Search, parameters};
use crate::balance::loops::ComponentError;
use crate::math::statistics::root_mean_square;

/// Fits of each number of laws that are left out and predicted, and the steps of their fits.
const PREDICTED: usize = 6;
const STEPS: usize = 8;
/// Share of the error of fewer laws that a sum may at most leave where it was left out: 0.8 takes away a third of its square.
const WORTH: f64 = 0.8;
/// Share of the error of a law of fewer parameters, where it was left out, that one of more may at most leave.
const PLAIN: f64 = 0.9;

impl Search<'_> {
    /// Fits in the order of their evidence, none left out.
    pub(super) fn by_evidence(&self, fits: &[Fitted]) -> Vec<Ranked> {
        fits.iter().map(|f| Ranked { fit: f.clone(), held_out: None, criterion: self.criterion(f) }).collect()
    }

    /// All fits, what is told first in front: fewer laws unless more predict clearly better, the others by what they
    /// predict.
    pub(super) fn ranked(&self, sizes: &[Vec<Fitted>]) -> Result<Vec<Ranked>, ComponentError> {
        let sizes: Vec<Vec<Ranked>> = sizes.iter().map(|fits| self.predicted(fits)).collect::<Result<_, _>>()?;
        let mut first: Option<&Ranked> = None;
        for more in sizes.iter().filter_map(|list| plainest(list)) {
            if first.is_none_or(|fewer| predicts(more) < WORTH * predicts(fewer)) {
                first = Some(more);
            }
        }
        let Some(first) = first.map(|ranked| ranked.fit.clone()) else { return Ok(Vec::new()) };
        let mut all: Vec<Ranked> = sizes.into_iter().flatten().collect();
        // What was predicted goes before what was not.
        let unseen = |r: &Ranked| r.held_out.is_none();
        all.sort_by(|a, b| unseen(a).cmp(&unseen(b)).then(a.criterion.total_cmp(&b.criterion)));
        let least = all.iter().map(|r| r.criterion).fold(f64::INFINITY, f64::min);
        if let Some(at) = all.iter().position(|r| r.fit == first) {
            let mut chosen = all.remove(at);
            chosen.criterion = least;
            all.insert(0, chosen);
        }
        Ok(all)
    }

    /// Fits of as many laws, the best by evidence left out and predicted.
    fn predicted(&self, fits: &[Fitted]) -> Result<Vec<Ranked>, ComponentError> {
        let mut list = self.by_evidence(fits);
        if self.all.len() < 2 {
            // There is nothing to leave out: errors of the fits stand for it.
            list.iter_mut().take(PREDICTED).for_each(|r| r.held_out = Some(r.fit.error(1)));
            return Ok(list);
        }
        for ranked in list.iter_mut().take(PREDICTED) {
            let held = self.held_out(&ranked.fit)?;
            ranked.held_out = Some(held);
            let n = freedom(self.all.len());
            ranked.criterion = n * held.powi(2).max(1e-12).ln() + parameters(&ranked.fit) as f64 * n.max(2.0).ln();
        }
        // What was not predicted is as far behind the last that was as its evidence is.
        let last = list.iter().rposition(|r| r.held_out.is_some());
        if let Some(last) = last {
            let (reference, own) = (list[last].criterion, self.criterion(&list[last].fit));
            list.iter_mut().skip(last + 1).for_each(|r| r.criterion += reference - own);
        }
        Ok(list)
    }

    /// Error of a set on each record, fitted to the others.
    fn held_out(&self, fit: &Fitted) -> Result<f64, ComponentError> {
        let held_out_error = |k: usize| {
            let others: Vec<usize> = self.all.iter().copied().filter(|&j| j != k).collect();
            let learnt = improved(self.loops, &fit.effects, &others, STEPS, self.control)?;
            error(self.loops, &learnt.effects, &[k])
        };
        let all = self.control.map(self.all.len(), held_out_error).into_iter().collect::<Result<Vec<f64>, _>>()?;
        Ok(root_mean_square(&all))
    }
}

/// Error where it was left out; infinite where that was not asked.
fn predicts(ranked: &Ranked) -> f64 {
    ranked.held_out.unwrap_or(f64::INFINITY)
}

/// What predicts best of fits of as many laws; another of less evidence has to predict clearly better, or nearly as well with fewer
/// parameters.
fn plainest(list: &[Ranked]) -> Option<&Ranked> {
    let mut found: Option<&Ranked> = None;
    for ranked in list {
        let better = |best: &Ranked| {
            let (held, least) = (predicts(ranked), predicts(best));
            held < WORTH * least || (parameters(&ranked.fit) < parameters(&best.fit) && PLAIN * held < least)
        };
        if found.is_none_or(better) {
            found = Some(ranked);
        }
    }
    found
}

//! Steps of a fit whose derivatives by corrections, shapes, offsets and initial states are held as they were where it began
//! (chord or simplified Newton method: Deuflhard, *Newton Methods for Nonlinear Problems*, 2011, section 2.1.2).
//!
//! ```text
//! J = [J_laws(x)  J_rest(x_0)],    e(x) exact at every step
//! ```
//!
//! The laws, which are what a search varies, are differentiated anew at every step, a few parameters each; all else, ten times
//! as many, moves a record nearly as it did at the beginning. A step then costs a fifth of a full one; where it begins anew
//! from what it has come to, the fit ends where one with full steps does.

use super::data::RecordError;
use super::fitted::FittedRecords;
use super::normal::{Normal, RecordDerivatives, RecordPart};
use super::problem::FitProblem;
use crate::response::transient::TransientParameter;
use dashpot_numerics::dot;

/// Most numbers of derivatives that are held: 160 MB.
const MOST: usize = 20_000_000;

/// Derivatives of all records at the beginning of a fit, with their products.
pub(super) struct Held {
    records: Vec<(RecordDerivatives, RecordPart)>,
    /// Number of the variables of the laws.
    laws: usize,
}

impl Held {
    /// At the start of a fit, with the equations there; `None` where they are too many to be held.
    pub(super) fn new(
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
    ) -> Result<Option<(Self, Normal)>, RecordError> {
        let samples: usize = problem.records.list.iter().map(|r| r.len() * r.channels.len()).sum();
        if samples * (problem.shared(at) + problem.local()) > MOST {
            return Ok(None);
        }
        let made = problem.control.map(problem.records.list.len(), |r| -> Result<_, RecordError> {
            let derivatives = problem.derivatives(at, scales, r)?;
            let part = derivatives.products(1.0);
            Ok((derivatives, part))
        });
        let records: Vec<(RecordDerivatives, RecordPart)> = made.into_iter().collect::<Result<_, _>>()?;
        let parts = records.iter().map(|(_, part)| part.clone()).collect();
        let normal = problem.assembled(at, unit, parts);
        Ok(Some((Self { records, laws: problem.first_correction(at) }, normal)))
    }

    /// The equations at another point, only the laws differentiated there.
    pub(super) fn normal(
        &self,
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
    ) -> Result<Normal, RecordError> {
        let parts = problem.control.map(self.records.len(), |r| self.renewed(problem, at, scales, r));
        Ok(problem.assembled(at, unit, parts.into_iter().collect::<Result<_, _>>()?))
    }

    /// Products of record `r` with the laws differentiated at `at`.
    fn renewed(
        &self,
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        r: usize,
    ) -> Result<RecordPart, RecordError> {
        let (held, before) = &self.records[r];
        let all = problem.unknowns(at, scales, r);
        let own: Vec<(TransientParameter, usize, f64)> = all.into_iter().filter(|(_, k, _)| *k < self.laws).collect();
        let parameters: Vec<TransientParameter> = own.iter().map(|(p, ..)| *p).collect();
        let (left, mut columns) = problem.responses(at, r, &parameters)?;
        let mut part = RecordPart { left, ..before.clone() };
        part.square = part.left.iter().flatten().map(|e| e * e).sum();
        // The derivatives by the laws come first, one a variable.
        let laws = own.len();
        part.unknowns.iter_mut().zip(&own).for_each(|(unknown, (_, k, slope))| *unknown = (unknown.0, *k, *slope));
        part.products.clear(laws);
        for (c, (channel, e)) in held.channels.iter().zip(&part.left).enumerate() {
            let law: Vec<Vec<f64>> = columns.iter_mut().map(|list| std::mem::take(&mut list[c])).collect();
            for (a, own) in law.iter().enumerate() {
                part.products.add_against(a, dot(own, e));
                for (b, other) in law.iter().enumerate().take(a + 1) {
                    part.products.add_product(a, b, dot(own, other));
                }
            }
            for (b, other) in channel.iter().filter(|(b, _)| *b >= laws) {
                part.products.add_against(*b, dot(other, e));
                law.iter().enumerate().for_each(|(a, own)| part.products.add_product(a, *b, dot(own, other)));
            }
        }
        Ok(part)
    }
}

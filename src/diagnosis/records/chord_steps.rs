//! Chord method (simplified Newton method: Deuflhard, *Newton Methods for Nonlinear Problems*, 2011, section 2.1.2): steps of a fit whose
//! derivatives by corrections, shapes, offsets and initial states are kept from the point where it started.
//!
//! ```text
//! J = [J_laws(x)  J_rest(x_0)],    e(x) exact at every step
//! ```
//!
//! The laws, a few parameters each, are differentiated anew at every step; the derivatives by all other variables, ten times as many,
//! hardly change on the way. A step costs a fifth of a full one, and with restarts the fit ends where one with full steps does. The kept
//! derivatives do not depend on the laws: fits of several laws at one place may share them.

use super::coarse_steps::Defect;
use super::data::RecordDiagnosisError;
use super::fitted::FittedRecords;
use super::normal_equations::{Normal, Products, RecordDerivatives, RecordPart};
use super::problem::FitProblem;
use super::steps::Steps;
use crate::response::transient::TransientParameter;
use dashpot_numerics::dot;

/// Most numbers of derivatives that are kept: 160 MB.
const MOST: usize = 20_000_000;

/// Derivatives of all records by all variables but those of the laws, with their products.
pub(super) struct ChordJacobian {
    records: Vec<RecordJacobian>,
}

/// The derivatives of one record.
struct RecordJacobian {
    /// Number of the derivative, of the variable behind those of the laws, and the factor between them.
    unknowns: Vec<(usize, usize, f64)>,
    /// Of each channel: numbers of derivatives with their samples, over the noise.
    channels: Vec<Vec<(usize, Vec<f64>)>>,
    products: Products,
}

impl ChordJacobian {
    /// At the start of a fit, with the normal equations there; `None` where there are too many derivatives to keep.
    pub(super) fn new(
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
        defect: &Defect,
    ) -> Result<Option<(Self, Normal)>, RecordDiagnosisError> {
        let samples: usize = problem.records.list.iter().map(|r| r.len() * r.channels.len()).sum();
        if samples * (problem.shared(at) + problem.local()) > MOST {
            return Ok(None);
        }
        let laws = problem.first_correction(at);
        let made = problem.control.map(problem.records.list.len(), |r| -> Result<_, RecordDiagnosisError> {
            let mut derivatives = problem.derivatives(at, scales, r, Steps::Coarse)?;
            defect.take_from(r, &mut derivatives.left);
            let part = derivatives.products(1.0);
            Ok((RecordJacobian::new(derivatives, &part.products, laws), part))
        });
        let made: Vec<(RecordJacobian, RecordPart)> = made.into_iter().collect::<Result<_, _>>()?;
        let (records, parts) = made.into_iter().unzip();
        Ok(Some((Self { records }, problem.assembled(at, unit, parts))))
    }

    /// The normal equations at another point, also one with other laws; only the laws are differentiated there.
    pub(super) fn normal(
        &self,
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
        defect: &Defect,
    ) -> Result<Normal, RecordDiagnosisError> {
        let renewed = |r: usize| self.records[r].renewed(problem, at, scales, r, defect);
        let parts = problem.control.map(self.records.len(), renewed);
        Ok(problem.assembled(at, unit, parts.into_iter().collect::<Result<_, _>>()?))
    }
}

impl RecordJacobian {
    /// Without what belongs to the first `laws` variables.
    fn new(derivatives: RecordDerivatives, products: &Products, laws: usize) -> Self {
        let RecordDerivatives { unknowns, channels, .. } = derivatives;
        // The derivatives by the laws come first, one a variable.
        let own = unknowns.iter().filter(|(_, k, _)| *k < laws).count();
        let others = unknowns.into_iter().filter(|(_, k, _)| *k >= laws);
        let kept = |columns: Vec<(usize, Vec<f64>)>| {
            columns.into_iter().filter(|(p, _)| *p >= own).map(|(p, list)| (p - own, list)).collect()
        };
        Self {
            unknowns: others.map(|(p, k, slope)| (p - own, k - laws, slope)).collect(),
            channels: channels.into_iter().map(kept).collect(),
            products: products.without(own),
        }
    }

    /// Products of record `r` with the laws differentiated at `at`.
    fn renewed(
        &self,
        problem: &FitProblem,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        r: usize,
        defect: &Defect,
    ) -> Result<RecordPart, RecordDiagnosisError> {
        let first = problem.first_correction(at);
        let all = problem.unknowns(at, scales, r);
        let own: Vec<(TransientParameter, usize, f64)> = all.into_iter().filter(|(_, k, _)| *k < first).collect();
        let parameters: Vec<TransientParameter> = own.iter().map(|(p, ..)| *p).collect();
        let (mut left, mut columns) = problem.responses(at, r, &parameters, Steps::Coarse)?;
        defect.take_from(r, &mut left);
        let laws = own.len();
        let mut products = self.products.behind(laws);
        for (c, (channel, e)) in self.channels.iter().zip(&left).enumerate() {
            let law: Vec<Vec<f64>> = columns.iter_mut().map(|list| std::mem::take(&mut list[c])).collect();
            for (a, own) in law.iter().enumerate() {
                products.add_against(a, dot(own, e));
                for (b, other) in law.iter().enumerate().take(a + 1) {
                    products.add_product(a, b, dot(own, other));
                }
            }
            for (b, other) in channel {
                products.add_against(laws + b, dot(other, e));
                law.iter().enumerate().for_each(|(a, own)| products.add_product(a, laws + b, dot(own, other)));
            }
        }
        let of_laws = own.iter().enumerate().map(|(p, (_, k, slope))| (p, *k, *slope));
        let others = self.unknowns.iter().map(|(p, k, slope)| (laws + p, first + k, *slope));
        let square = left.iter().flatten().map(|e| e * e).sum();
        Ok(RecordPart { unknowns: of_laws.chain(others).collect(), products, square, left })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::diagnosis::records::problem::Free;
    use crate::diagnosis::records::variables::scales;
    use crate::effects::{Effect, Place, Source};

    /// The equations with kept derivatives equal those with all derivatives: to the last digits where they were taken, and beside a power
    /// law of exponent 1, which moves the structure as the dashpot does, up to the errors of its steps in time.
    #[test]
    fn kept_derivatives_serve_another_law() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let wave = |dof: usize| (0..400).map(|n| 1e-2 * (0.12 * f64::from(n) + dof as f64).sin()).collect();
        let run = decay(4e-3, vec![wave(0), wave(1)]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let problem = FitProblem { records: &records, free: Free::all(&records), share: 1.0, control: &control };
        let fit = |effect: Effect, parameters: &[f64]| {
            let mut fit = FittedRecords::start(&records, &[]);
            fit.initial[0][0] = 1e-2;
            fit.effects = vec![Source::known(effect, Place::Dofs(vec![1]), parameters)];
            fit
        };
        let (dashpot, power) = (fit(Effect::Viscous, &[0.9]), fit(Effect::Power, &[0.9, 1.0]));
        let of_power = scales(&power.effects);
        let own = problem.normal(&power, &of_power, 1.0).unwrap();
        let largest = own.gradient.iter().fold(0.0_f64, |m, g| m.max(g.abs()));
        for (from, within) in [(&power, 1e-9), (&dashpot, 2e-2)] {
            let defect = problem.defect(&power).unwrap();
            let (chord, _) = ChordJacobian::new(&problem, from, &scales(&from.effects), 1.0, &defect).unwrap().unwrap();
            let shared = chord.normal(&problem, &power, &of_power, 1.0, &defect).unwrap();
            for (k, (a, b)) in own.gradient.iter().zip(&shared.gradient).enumerate() {
                assert!((a - b).abs() < within * largest, "{k}: {a} {b}");
                for j in 0..own.gradient.len() {
                    let size = (own.matrix[(k, k)] * own.matrix[(j, j)]).sqrt();
                    let (a, b) = (own.matrix[(k, j)], shared.matrix[(k, j)]);
                    assert!((a - b).abs() <= within * size, "{k} {j}: {a} {b} of {size}");
                }
            }
        }
    }
}

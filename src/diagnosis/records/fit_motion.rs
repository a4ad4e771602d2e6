//! The motion of a fit at the places where a law may act.

use super::data::{RecordDiagnosisError, Records};
use super::fitted::FittedRecords;
use crate::control::Control;
use crate::effects::{Leg, Range};
use crate::measurement::{Channel, Quantity};
use crate::response::transient::{TransientModel, TransientSetup};
use dashpot_numerics::dot;
use std::f64::consts::TAU;

/// Displacement (m), velocity (m/s) and acceleration (m/s^2) at every sample of the forces on a record.
pub(super) type MotionOfDof = [Vec<f64>; 3];

/// Motion of every translation in every record.
pub(super) struct FitMotion {
    /// `[record][row]`; none of a row that is no translation.
    rows: Vec<Vec<Option<MotionOfDof>>>,
    /// Frequency that stands out, rad/s.
    omega: f64,
}

impl FitMotion {
    /// Of a fit on its records.
    ///
    /// # Errors
    /// [`RecordDiagnosisError::Model`] where the model cannot be predicted.
    pub(super) fn new(records: &Records, fit: &FittedRecords, control: &Control) -> Result<Self, RecordDiagnosisError> {
        let rows = control.map(records.list.len(), |r| of_record(records, fit, r));
        let omega = TAU * records.list.first().map_or(1.0, |r| r.dominant_hz);
        Ok(Self { rows: rows.into_iter().collect::<Result<_, _>>()?, omega })
    }

    /// Relative motion along a leg in record `r`; none where it is no translation.
    pub(super) fn relative(&self, leg: Leg, r: usize) -> Option<MotionOfDof> {
        let motion_of_dof = |dof: usize| self.rows[r].get(dof).and_then(Option::as_ref);
        let mut relative = motion_of_dof(leg.first)?.clone();
        if let Some(second) = leg.second {
            for (own, other) in relative.iter_mut().zip(motion_of_dof(second)?) {
                own.iter_mut().zip(other).for_each(|(a, b)| *a -= b);
            }
        }
        Some(relative)
    }

    /// Root mean squares over all records of the displacement along a leg about its mean in each, m, and of its velocity, m/s; none where
    /// it is no translation.
    pub(super) fn sizes(&self, leg: Leg) -> Option<[f64; 2]> {
        let (mut squares, mut count) = ([0.0; 2], 0);
        for r in 0..self.rows.len() {
            let [d, v, _] = self.relative(leg, r)?;
            let mean = d.iter().sum::<f64>() / d.len().max(1) as f64;
            squares[0] += d.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
            squares[1] += dot(&v, &v);
            count += v.len();
        }
        Some(squares.map(|square| (square / count.max(1) as f64).sqrt()))
    }

    /// Range of the motion along a leg; none where nothing moves.
    pub(super) fn range(&self, leg: Leg) -> Option<Range> {
        let most = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let sizes: Vec<[f64; 2]> =
            (0..self.rows.len()).filter_map(|r| self.relative(leg, r).map(|[d, v, _]| [most(&d), most(&v)])).collect();
        let greatest = |k: usize| sizes.iter().map(|s| s[k]).fold(0.0, f64::max);
        // A record passes through many amplitudes.
        let least = 0.3 * sizes.iter().map(|s| s[0]).fold(f64::INFINITY, f64::min);
        let range = Range { displacement: greatest(0), least, velocity: greatest(1), omega: self.omega };
        (range.displacement > 0.0 && range.velocity > 0.0).then_some(range)
    }
}

fn of_record(
    records: &Records,
    fit: &FittedRecords,
    r: usize,
) -> Result<Vec<Option<MotionOfDof>>, RecordDiagnosisError> {
    let record = &records.list[r];
    let rows = records.structure.translations();
    let quantities = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
    let channel = |dof: usize| quantities.map(|quantity| Channel { quantity, dof, label: String::new() });
    let channels: Vec<Channel> = rows.iter().flat_map(|dof| channel(*dof)).collect();
    let (sources, parts) = (fit.sources(records), records.parts.logarithms(&fit.parts));
    let setup = records.setup(record, &sources, fit.factors(r), [&fit.modes, &fit.damping], &parts);
    let failed = |reason| RecordDiagnosisError::Model { file: record.file.clone(), reason };
    let model = TransientModel::new(&TransientSetup { channels: &channels, ..setup }).map_err(failed)?;
    let forces = record.excitation(model.is_linear());
    let mut lists = model.predict(&forces, &fit.initial[r], &[]).map_err(failed)?.channels.into_iter();
    let mut motion = vec![None; records.structure.len()];
    for dof in rows {
        motion[dof] = lists.next().zip(lists.next()).zip(lists.next()).map(|((d, v), a)| [d, v, a]);
    }
    Ok(motion)
}

//! The states in which records, and parts of them, begin, where a fit of a law that is strong may begin: the states of a fit without
//! the law are bent to what the law does, and far from its own a fit loses the phase within a few periods.

use super::data::{RecordData, RecordDiagnosisError, Records};
use super::fitted::FittedRecords;
use super::search::Search;
use crate::balance::windows::motion::Motion;
use crate::control::Control;
use crate::measurement::Quantity;
use dashpot_numerics::Cholesky;
use faer::Mat;
use std::f64::consts::TAU;

/// Share of the frequency of the motion below which that of a mode is none.
const RIGID: f64 = 1e-3;

/// Share of each part of the records that is fitted first where the phase is lost.
const FIRST: f64 = 0.35;
/// Rounds and steps of that fit on longer parts.
const IN_PHASE: [usize; 2] = [2, 4];

/// The motion of the modes as the sensors show it, each with the number of its run; none of runs whose sensors tell no mode.
pub(super) fn measured_motions(records: &Records, control: &Control) -> Vec<(usize, Motion)> {
    let motion_of_record = |r: &RecordData| Some((r.index, Motion::new(&records.modes, &r.run, control).ok()?));
    records.list.iter().filter_map(motion_of_record).collect()
}

/// The state in which a record, or a part of one, begins as the sensors show it; none where they do not.
fn measured_state(motions: &[(usize, Motion)], record: &RecordData, kept: usize) -> Option<Vec<f64>> {
    let (_, motion) = motions.iter().find(|(run, _)| *run == record.index)?;
    let sample = ((record.first_s - record.run.time()[0]) / motion.step).round() as usize;
    if !motion.usable.contains(&sample) {
        return None;
    }
    let mut state = vec![0.0; 2 * kept];
    for (r, &mode) in motion.band.modes.iter().enumerate().filter(|(_, mode)| **mode < kept) {
        state[mode] = motion.q[r][sample];
        state[kept + mode] = motion.v[r][sample] / motion.band.omega[r];
    }
    Some(state)
}

impl Records<'_> {
    /// Whether the motion is mostly that of a rigid body, which no spring brings back.
    pub(super) fn floats(&self) -> bool {
        let omega = TAU * self.list[0].dominant_hz;
        let off = |r: &usize| (self.modes.omega[*r] - omega).abs();
        let nearest = (0..self.kept).min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.is_some_and(|r| self.is_rigid(r, omega))
    }

    fn is_rigid(&self, mode: usize, omega: f64) -> bool {
        self.modes.omega[mode] < RIGID * omega
    }

    /// States in which the records begin at rest where their displacements show the rigid body to lie; at zero where there are none.
    pub(super) fn at_rest(&self) -> Vec<Vec<f64>> {
        let state_of_record = |record: &RecordData| {
            let omega = TAU * record.dominant_hz;
            let rigid: Vec<usize> = (0..self.kept).filter(|r| self.is_rigid(*r, omega)).collect();
            let shown = (0..record.channels.len()).filter(|&c| record.channels[c].quantity == Quantity::Displacement);
            let shown: Vec<usize> = shown.collect();
            let shape = |c: usize, r: usize| self.modes.shapes[(record.channels[shown[c]].dof, rigid[r])];
            let mut state = vec![0.0; 2 * self.kept];
            let rows = Mat::from_fn(shown.len(), rigid.len(), shape);
            let first = Mat::from_fn(shown.len(), 1, |c, _| record.samples[shown[c]][0]);
            let products = rows.transpose() * &rows;
            if let Some(lies) = Cholesky::new(products.as_ref()).map(|p| p.solve((rows.transpose() * &first).as_ref()))
            {
                rigid.iter().enumerate().for_each(|(k, &r)| state[r] = lies[(k, 0)]);
            }
            state
        };
        self.list.iter().map(state_of_record).collect()
    }
}

impl Search<'_> {
    /// A start whose parts of records begin each in the state that leaves least: that of the start, that which the sensors show, or at
    /// rest where a force acts. A strong linear effect needs it, too: beside states that are bent to its absence a fit drives its size away.
    pub(super) fn in_best_states(&self, level: usize, start: FittedRecords) -> FittedRecords {
        let (records, kept) = (&self.levels[level], self.records.kept);
        let problem = self.problem(level, 1.0);
        // Whoever waits for another to make them must not be lent to what makes them.
        let motions = self.motions.get_or_init(|| measured_motions(self.records, &self.control.alone()));
        let own = |k: usize| start.initial[k].clone();
        let shown = |k: usize| measured_state(motions, &records.list[k], kept).unwrap_or_else(|| own(k));
        let at_rest = |k: usize| if records.list[k].forces.is_empty() { own(k) } else { vec![0.0; 2 * kept] };
        let all = |state: &dyn Fn(usize) -> Vec<f64>| (0..records.list.len()).map(state).collect::<Vec<_>>();
        let residual_squares = |initial: Vec<Vec<f64>>| {
            let candidate = FittedRecords { initial, ..start.clone() };
            let left = problem.left(&candidate).ok()?;
            let squares = left.residual.iter().map(|record| record.iter().flatten().map(|e| e * e).sum::<f64>());
            Some((squares.collect::<Vec<f64>>(), candidate.initial))
        };
        let candidates: Vec<(Vec<f64>, Vec<Vec<f64>>)> =
            [all(&own), all(&shown), all(&at_rest)].into_iter().filter_map(residual_squares).collect();
        let best = |k: usize| candidates.iter().min_by(|a, b| a.0[k].total_cmp(&b.0[k])).map(|c| c.1[k].clone());
        let initial = (0..records.list.len()).map(|k| best(k).unwrap_or_else(|| own(k))).collect();
        FittedRecords { initial, ..start }
    }

    /// A start whose first periods are fitted before the whole parts where it leaves more than `most` of them: with a law that is not
    /// linear it has lost the phase on the way.
    pub(super) fn in_phase(
        &self,
        level: usize,
        start: FittedRecords,
        most: f64,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        let nonlinear = start.effects.iter().any(|e| !e.effect.is_linear());
        let lost = || self.problem(level, 1.0).left(&start).is_ok_and(|left| left.chi_square > most);
        if nonlinear && lost() { self.fit_first_periods(level, &start, IN_PHASE) } else { Ok(start) }
    }

    /// A fit of the first periods of each part of the records.
    pub(super) fn fit_first_periods(
        &self,
        level: usize,
        start: &FittedRecords,
        rounds: [usize; 2],
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        self.problem(level, FIRST).chord_fit(start, rounds)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::effects::{Effect, Place, Source};

    /// Two carriages that are coupled stiffly and driven slowly to and fro float, and begin at rest where their sensors show them; held by
    /// a spring to the ground they do not float.
    #[test]
    fn carriages_begin_where_they_lie() {
        let stroke = |n: usize| 0.1 + 0.05 * (2e-3 * n as f64).cos();
        let run = decay(1e-3, vec![(0..8000).map(stroke).collect(), (0..8000).map(stroke).collect()]);
        let begins_at = |ground: f64| {
            let structure = chain(&[2.0, 1.0], &[ground, 0.0], &[1500.0]);
            let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
            let state = records.at_rest().swap_remove(0);
            assert!(state[records.kept..].iter().all(|v| *v == 0.0));
            let shown = |dof: usize| (0..records.kept).map(|r| records.modes.shapes[(dof, r)] * state[r]).sum::<f64>();
            (records.floats(), [shown(0), shown(1)].map(|x| x - records.list[0].samples[0][0]))
        };
        let (floats, off) = begins_at(0.0);
        assert!(floats && off.iter().all(|x| x.abs() < 1e-9), "{floats} {off:?}");
        assert!(!begins_at(800.0).0);
    }

    /// The state at any sample of a free motion in both modes is that of the modes.
    #[test]
    fn sensors_show_the_state_of_the_modes() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let modes = structure.modes().unwrap();
        let step = 4e-3;
        let q = |n: usize, r: usize| {
            let (a, t) = ([0.02, 0.006][r], step * n as f64);
            let (decay, phase) = ((-0.25 * t).exp(), modes.omega[r] * t);
            [a * decay * phase.cos(), a * decay * (-0.25 * phase.cos() / modes.omega[r] - phase.sin())]
        };
        let shown = |n: usize, dof: usize| (0..2).map(|r| modes.shapes[(dof, r)] * q(n, r)[0]).sum();
        let run = decay(step, (0..2).map(|dof| (0..4000).map(|n| shown(n, dof)).collect()).collect());
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let motions = measured_motions(&records, &Control::unattended());
        let mut part = records.list[0].clone();
        part.first_s += 1500.0 * step;
        let state = measured_state(&motions, &part, 2).unwrap();
        for r in 0..2 {
            let [d, v] = q(1500, r);
            let size = d.hypot(v);
            assert!((state[r] - d).abs() < 0.02 * size && (state[2 + r] - v).abs() < 0.02 * size, "{state:?} {d} {v}");
        }
    }

    /// A start with a dashpot takes the state that the sensors show in place of one at which nothing moves.
    #[test]
    fn a_start_with_a_linear_effect_takes_the_state_that_sensors_show() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let modes = structure.modes().unwrap();
        let wave = |n: usize| (-1e-3 * n as f64).exp() * (4e-3 * modes.omega[0] * n as f64).cos();
        let shown = |dof: usize| (0..4000).map(|n| 0.02 * modes.shapes[(dof, 0)] * wave(n)).collect();
        let run = decay(4e-3, (0..2).map(shown).collect());
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let mut start = FittedRecords::start(&search.levels[0], &[]);
        start.effects = vec![Source::known(Effect::Viscous, Place::Dofs(vec![1]), &[0.7])];
        // The sensors do not tell the state at the very beginning.
        let left = |fit: &FittedRecords| {
            let left = search.problem(0, 1.0).left(fit).unwrap().residual;
            left.iter().skip(1).flatten().flatten().map(|e| e * e).sum::<f64>()
        };
        let before = left(&start);
        let begun = search.in_best_states(0, start);
        assert!(begun.initial.len() > 1 && left(&begun) < 0.2 * before, "{} {before}", left(&begun));
    }
}

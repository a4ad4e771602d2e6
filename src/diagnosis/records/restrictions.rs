//! What a fit would leave were some of its corrections held where the model states them, to first order (Wald test: Wald 1943).
//!
//! ```text
//! left(d) = left_0 - 2 g^T d + d^T N d,    d_c = -v_c of what is held at 0,    N d = g in what is free
//! ```
//!
//! `N` and `g` are the normal equations in which all is free. Found once, they weigh every choice of corrections, each of which
//! would ask for a fit of its own.

use super::data::RecordDiagnosisError;
use super::evidence::{information, scale};
use super::fitted::FittedRecords;
use super::normal_equations::{Left, Normal};
use super::problem::{FitProblem, Free, modes};
use super::search::Search;
use super::steps::Steps;
use super::variables::scales;
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;

/// Share of the diagonal that is added where equations would have no solution.
const RIDGE: f64 = 1e-9;

/// A fit to whole records with its normal equations by corrections, shifts, shapes, offsets and initial states, without priors.
pub(super) struct Restrictions<'a> {
    search: &'a Search<'a>,
    fit: &'a FittedRecords,
    normal: Normal,
}

/// A fit with some corrections held, to first order.
pub(super) struct Restricted {
    /// What is left and the priors over the unit of evidence, and what the free corrections themselves cost.
    pub cost: f64,
    /// Sizes of known sources, damping and stiffness of modes, each with its deviation.
    pub sizes: Vec<(f64, f64)>,
}

impl<'a> Restrictions<'a> {
    /// The equations at `fit`, whose effects are held.
    ///
    /// # Errors
    /// [`RecordDiagnosisError`]: a model that cannot be predicted.
    pub(super) fn new(search: &'a Search<'a>, fit: &'a FittedRecords) -> Result<Self, RecordDiagnosisError> {
        let count = Free::all(search.whole()).corrections.len();
        let problem = problem(search, vec![true; count]);
        let scales = scales(&fit.effects);
        let products = |r: usize| -> Result<_, RecordDiagnosisError> {
            let mut derivatives = problem.derivatives(fit, &scales, r, Steps::Coarse)?;
            derivatives.left = problem.left_of(fit, r, Steps::Fine)?;
            Ok(derivatives.products(1.0))
        };
        let parts = search.control.map(search.whole().list.len(), products);
        let size = problem.shared(fit) + search.whole().list.len() * problem.local();
        let mut normal = Normal { matrix: Mat::zeros(size, size), gradient: vec![0.0; size], left: Left::default() };
        for part in parts {
            normal.add(&part?);
        }
        Ok(Self { search, fit, normal })
    }

    /// With a choice of `free` corrections, the others at 0; `None` where the equations have no solution.
    pub(super) fn with(&self, free: &[bool]) -> Option<Restricted> {
        let (fit, unit) = (self.fit, scale(self.fit));
        let problem = problem(self.search, free.to_vec());
        let first = problem.first_correction(fit);
        let unused = problem.unused_shifts(fit);
        let is_held = |k: &usize| *k < first || unused.contains(k) || free.get(k - first).is_some_and(|free| !free);
        let (held, moving): (Vec<usize>, Vec<usize>) = (0..self.normal.gradient.len()).partition(is_held);
        let mut change = vec![0.0; self.normal.gradient.len()];
        let values = self.corrections();
        held.iter().filter_map(|k| Some((k, values.get(k.checked_sub(first)?)?))).for_each(|(k, v)| change[*k] = -v);
        let (mut matrix, mut gradient) = (self.normal.matrix.clone(), self.normal.gradient.clone());
        let priors = problem.priors(fit);
        let prior = unit * problem.prior_cost(fit, &priors);
        for (k, value, deviation) in priors {
            let weight = unit * deviation.powi(-2);
            matrix[(k, k)] += weight;
            gradient[k] -= weight * value;
        }
        let (more, deviations) =
            least(&matrix, &gradient, &moving, &mut change).filter(|(more, _)| more.is_finite())?;
        let count = free.iter().filter(|free| **free).count();
        let cost = (fit.chi_square + prior + more) / unit + count as f64 * information(fit, unit);
        let size = |k: usize| (values[k] + change[first + k], unit.sqrt() * deviations[first + k]);
        let last = 1 + self.search.whole().sizes() + modes(self.search.whole());
        Some(Restricted { cost, sizes: (1..last).map(size).collect() })
    }

    /// What every record tells of its own shift where its initial state and offsets are free: inverse variances.
    pub(super) fn information_of_shifts(&self) -> Vec<f64> {
        let problem = problem(self.search, vec![false; self.corrections().len()]);
        let (matrix, local) = (&self.normal.matrix, problem.local());
        let information_of_shift = |r: usize| {
            let first = problem.shared(self.fit) + r * local;
            let shift = problem.shift_variable(self.fit, r);
            let others: Vec<usize> = (first..first + local).filter(|k| *k != shift).collect();
            let beside: Vec<f64> = others.iter().map(|&k| matrix[(k, shift)]).collect();
            let taken = |factor: EquilibratedCholesky| dot(&beside, &factor.solve(&beside));
            (matrix[(shift, shift)] - factor_of(matrix, &others).map_or(0.0, taken)).max(0.0)
        };
        (0..self.search.whole().list.len()).map(information_of_shift).collect()
    }

    /// Values of all corrections, in the order of their variables.
    fn corrections(&self) -> Vec<f64> {
        let fit = self.fit;
        let sizes = fit.known.iter().chain(&fit.damping).chain(fit.modes.iter().take(modes(self.search.whole())));
        let all = std::iter::once(&fit.stiffness).chain(sizes).chain([&fit.mass]).chain(&fit.parts);
        all.copied().collect()
    }
}

fn problem<'a>(search: &'a Search<'_>, corrections: Vec<bool>) -> FitProblem<'a> {
    let free = Free { corrections, shifts: true, shapes: !search.whole().has_one_shape(), effects: false };
    FitProblem { records: search.whole(), free, share: 1.0, control: search.control }
}

/// The least of `-2 g^T d + d^T N d` where only what is `moving` differs from `change`, which becomes `d`; and the deviations
/// of all of it.
fn least(matrix: &Mat<f64>, gradient: &[f64], moving: &[usize], change: &mut [f64]) -> Option<(f64, Vec<f64>)> {
    let size = change.len();
    let row = |k: usize, change: &[f64]| (0..size).map(|j| matrix[(k, j)] * change[j]).sum::<f64>();
    let factor = factor_of(matrix, moving)?;
    let right: Vec<f64> = moving.iter().map(|&k| gradient[k] - row(k, change)).collect();
    let mut deviations = vec![0.0; size];
    for ((&k, value), deviation) in moving.iter().zip(factor.solve(&right)).zip(factor.deviations()) {
        (change[k], deviations[k]) = (value, deviation);
    }
    let turned: Vec<f64> = (0..size).map(|k| row(k, change)).collect();
    Some((dot(change, &turned) - 2.0 * dot(gradient, change), deviations))
}

/// Factors of the rows and columns of `matrix` that are `kept`.
fn factor_of(matrix: &Mat<f64>, kept: &[usize]) -> Option<EquilibratedCholesky> {
    let own = Mat::from_fn(kept.len(), kept.len(), |i, j| matrix[(kept[i], kept[j])]);
    EquilibratedCholesky::new(own.as_ref(), RIDGE)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{chain, source};
    use crate::common::runs::{decay, uniform};
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;
    use crate::measurement::TransientRun;

    /// Decays of a chain in both modes, as `truth` of `records` gives them, with noise that is the same at every call.
    fn decays(records: &Records, truth: &FittedRecords) -> Vec<TransientRun> {
        let mut uniform = uniform(1);
        let mut decay_of_record = |r: usize| {
            let mut rows = truth.predict(records, r, records.list[r].len(), &[]).unwrap().channels;
            rows.iter_mut().flatten().for_each(|y| *y += 4e-5 * uniform());
            decay(4e-3, rows)
        };
        (0..records.list.len()).map(&mut decay_of_record).collect()
    }

    /// What a choice of corrections costs to first order is what a fit with them costs, whether it holds what is off or not.
    #[test]
    fn a_choice_costs_what_its_fit_costs() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let known = [source(Effect::Viscous, &[0], &[1.6])];
        let wave = |n: usize| 1e-2 * (0.06 * n as f64).cos() + 1e-2 * (0.19 * n as f64).cos();
        let drawn = [800, 400].map(|samples| decay(4e-3, vec![(0..samples).map(wave).collect(); 2]));
        let drawn = Records::new(&structure, &known, &drawn).unwrap();
        let mut truth = FittedRecords { stiffness: 1e-3, modes: vec![1e-3, 0.0], ..FittedRecords::start(&drawn, &[]) };
        truth.initial.iter_mut().for_each(|state| state[..2].copy_from_slice(&[1e-2, 1e-2]));
        let runs = decays(&drawn, &truth);
        let (records, control) = (Records::new(&structure, &known, &runs).unwrap(), Control::unattended());
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let records = search.whole();
        let start = FittedRecords { initial: truth.initial, ..FittedRecords::start(records, &[]) };
        let fit = |corrections: Vec<bool>, start: &FittedRecords| {
            let free = Free { corrections, shifts: true, shapes: true, effects: false };
            FitProblem { records, free, share: 1.0, control: &control }.improve(start, 30).unwrap()
        };
        let count = Free::all(records).corrections.len();
        let all = fit(vec![true; count], &start);
        let restrictions = Restrictions::new(&search, &all).unwrap();
        let unit = scale(&all);
        let only = |which: &[usize]| (0..count).map(|k| which.contains(&k)).collect::<Vec<bool>>();
        let cost = |which: &[usize]| {
            let own = fit(only(which), &start);
            let actual = own.chi_square / unit + own.prior + which.len() as f64 * information(&all, unit);
            let first_order = restrictions.with(&only(which)).unwrap().cost;
            assert!((first_order / actual - 1.0).abs() < 0.1, "{which:?}: {first_order} for {actual}");
            actual
        };
        // All stiffness, the size of the dashpot, the stiffness of both modes.
        let [stiffness, modes, none] = [cost(&[0, 1]), cost(&[1, 2, 3]), cost(&[1])];
        assert!(modes < 0.5 * stiffness && modes < 0.5 * none, "{stiffness} {modes} {none}");
        // The phase that a frequency makes grows with time: twice the length tells it nearly eight times as well.
        let information = restrictions.information_of_shifts();
        assert!(information[0] > 4.0 * information[1] && information[0] < 16.0 * information[1], "{information:?}");
    }
}

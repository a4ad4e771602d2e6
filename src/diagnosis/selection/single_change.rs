//! One spring, mass or channel in place of many small corrections.
//!
//! ```text
//! r = B u + c theta + e,    u_k ~ N(0, s_k^2),    e ~ N(0, 1),    theta without a prior
//! E(s) = min |r - B u - c theta|^2 + |u / s|^2 + ln det(1 + s B^T P_c B s) + prior of the scales s + ln n
//! ```
//!
//! Corrections whose scale is estimated can stand for any change of stiffness and mass: they are then larger than models are
//! wrong by. Beside the one part that is changed their scale is small again, and so is `E`. Everything is linear about the model as
//! it was corrected, so that all places are looked at; the best are refined.

use crate::diagnosis::channels::fault::is_ordinary_gain;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::SEARCH;
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::measured_motion::MeasuredMotion;
use crate::diagnosis::updating::noise_model::LEAST_KNOWN;
use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::diagnosis::updating::scales::Scales;
use crate::effects::{Effect, Kind, Place, Source, State};
use dashpot_numerics::{Cholesky, dot};
use faer::Mat;

/// Places that leave least to a free force, at which it is looked for.
const PLACES: usize = 60;
/// Evidence behind that of the best within which others are refined.
const MARGIN: f64 = 20.0;
/// Most that are refined.
const FOLLOWED: usize = 3;
/// Rounds in which the scales are estimated.
const ROUNDS: usize = 12;
/// Times that a model is updated beside its candidate.
const UPDATES: usize = 6;

/// A single change with the evidence that it is estimated to bring.
#[derive(Debug)]
pub(super) struct SingleChange {
    pub source: Source,
    /// Updating parameters beside it.
    updating: Updating,
    /// Evidence that it brings.
    pub gain: f64,
}

impl<'a> ReferenceModel<'a> {
    /// The single changes that are estimated to bring `evidence` beside what the corrections of this model are reduced to, best first;
    /// none where the model has sources that are not linear.
    pub(super) fn single_changes(&self, evidence: f64) -> Result<Vec<SingleChange>, DiagnosisError> {
        if !self.predictor.known().iter().all(|source| source.effect.is_linear()) {
            return Ok(Vec::new());
        }
        let Some(seen) = MeasuredMotion::new(&self.predictor, self.data, &self.predictions, 1, self.control) else {
            return Ok(Vec::new());
        };
        let marginal = &self.noise.updating;
        let rows = marginal.without_reference(self.estimator().at_reference(&self.predictions));
        let model = Gram::new(&marginal.updating, marginal.slopes(), &rows);
        let without = model.estimated(None).cost - (self.count() as f64).ln();
        let mut changes = Vec::new();
        for unit in self.units()? {
            let fit = model.estimated(Some(&self.column(&seen, &unit)));
            let Some(source) = changed(unit, fit.value) else { continue };
            let gain = without - fit.cost;
            if gain > evidence && self.data.allows(&source) {
                let updating = marginal.updating.at(&fit.u).with_scales(fit.scales);
                changes.push(SingleChange { source, updating, gain });
            }
        }
        changes.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let best = changes.first().map_or(0.0, |c| c.gain);
        changes.retain(|c| c.gain > best - MARGIN);
        changes.truncate(FOLLOWED);
        Ok(changes)
    }

    /// The change refined with a model updated beside it.
    pub(super) fn refined_change(
        &self,
        change: &SingleChange,
    ) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
        let effects = std::slice::from_ref(&change.source);
        let reference = self.updated_as(&change.updating, effects, &Vec::new(), &SEARCH)?;
        let fit = reference.estimator().fit(effects, STEPS, &SEARCH, &[])?;
        reference.converged(fit, &SEARCH, UPDATES)
    }

    /// Linear laws of one parameter, at the places that leave least to a free force, and of the whole structure.
    fn units(&self) -> Result<Vec<Source>, DiagnosisError> {
        let places: Vec<Place> = {
            let view = self.view(None)?;
            let placings = view.screen.singles();
            placings.iter().take(PLACES).map(|p| view.screen.spots[p.spots[0]].place()).collect()
        };
        let [responses, forces] = self.data.channel_names();
        // One of several forces acts through a response of its own.
        let read = |name: &String| responses.len() > 1 && responses.contains(name) || forces == [name.clone()];
        let by_modes = self.linearisation.updating.is_by_modes();
        let mut units = Vec::new();
        for effect in Effect::ALL.into_iter().filter(|e| e.is_linear() && e.parameters().len() == 1) {
            let unit = |place: Place| Source { effect, place, state: State::Known, parameters: vec![1.0] };
            let may_act_at = |place: &&Place| match (effect.kind(), place) {
                // Corrections of modes do not stand for errors of one part: a spring or mass may be one.
                (Kind::Relative(_), Place::Dofs(_)) => !(by_modes && effect.is_mass_or_spring()),
                (Kind::Channel(law), Place::Channel(name)) => {
                    read(name) && (responses.contains(name) || law.neutral() != 0.0)
                }
                _ => false,
            };
            match effect.kind() {
                Kind::Whole(_) => units.push(unit(Place::Whole(None))),
                _ => units.extend(places.iter().filter(may_act_at).cloned().map(unit)),
            }
        }
        // More of what is known is a correction of that.
        units.retain(|unit| !self.predictor.known().iter().any(|known| known.is_same(unit)));
        Ok(units)
    }

    /// Whitened derivative of all runs by the parameter of a linear law; of a channel that multiplies what it reads, by the
    /// logarithm.
    fn column(&self, seen: &MeasuredMotion, unit: &Source) -> Vec<f64> {
        let (Kind::Channel(law), Place::Channel(name)) = (unit.effect.kind(), &unit.place) else {
            return self.linear_rows(seen, unit);
        };
        let mut rows = Vec::with_capacity(self.count());
        for (r, run) in self.data.runs.iter().enumerate() {
            let amplitudes = &self.linearisation.derivatives.amplitudes[r];
            let slope = |c: usize, h: usize| {
                // A force that is read too large stands for one that is smaller.
                let own = match &run.responses[c].name {
                    read if read == name => 1.0,
                    _ if run.forces.iter().any(|force| force.name == *name) => -1.0,
                    _ => 0.0,
                };
                amplitudes[c][h - 1] * law.transfer_derivative(law.neutral(), h as f64 * run.omega) * own
            };
            self.estimator().whitened(r, &mut rows, slope);
        }
        rows
    }
}

/// The effect with what a fit gives beyond none, of a channel that multiplies in the logarithm; none where that is no more than
/// what models and measuring chains are wrong by.
fn changed(unit: Source, value: f64) -> Option<Source> {
    let value = match unit.effect.kind() {
        Kind::Channel(law) if law.neutral() != 0.0 => law.neutral() * value.exp(),
        _ => value,
    };
    let source = Source { parameters: vec![value], ..unit };
    // What the model has too much of is corrected.
    let corrected = !matches!(source.effect.kind(), Kind::Channel(_)) && value <= 0.0;
    (!corrected && !is_ordinary_gain(&source)).then_some(source)
}

/// Products of the whitened derivatives by updating parameters with each other and with the residual.
struct Gram<'a> {
    updating: &'a Updating,
    slopes: &'a [Vec<f64>],
    rows: &'a [f64],
    product: Mat<f64>,
    right: Vec<f64>,
    square: f64,
}

/// Updating parameters and the parameter of a change with the most likely scales.
struct Estimate {
    cost: f64,
    value: f64,
    /// Updating parameters in units of their prior deviations before.
    u: Vec<f64>,
    scales: Scales,
}

impl<'a> Gram<'a> {
    fn new(updating: &'a Updating, slopes: &'a [Vec<f64>], rows: &'a [f64]) -> Self {
        let q = slopes.len();
        let product = Mat::from_fn(q, q, |i, j| dot(&slopes[i], &slopes[j]));
        let right = slopes.iter().map(|slope| dot(slope, rows)).collect();
        Self { updating, slopes, rows, product, right, square: dot(rows, rows) }
    }

    /// The fit beside a change whose derivative is `column` (none: without one).
    fn estimated(&self, column: Option<&[f64]>) -> Estimate {
        let size = column.map_or(0.0, |c| dot(c, c));
        let Some(column) = column.filter(|_| size > 0.0) else {
            return self.with_likely_scales(&self.product, &self.right, self.square);
        };
        let along: Vec<f64> = self.slopes.iter().map(|slope| dot(slope, column) / size.sqrt()).collect();
        let share = dot(column, self.rows) / size.sqrt();
        let product = Mat::from_fn(along.len(), along.len(), |i, j| self.product[(i, j)] - along[i] * along[j]);
        let right: Vec<f64> = self.right.iter().zip(&along).map(|(b, a)| b - a * share).collect();
        let fit = self.with_likely_scales(&product, &right, self.square - share * share);
        Estimate { value: (share - dot(&along, &fit.u)) / size.sqrt(), ..fit }
    }

    /// Scales by MacKay's iteration (Neural Computation 4, 1992, 415), class by class.
    fn with_likely_scales(&self, product: &Mat<f64>, right: &[f64], square: f64) -> Estimate {
        let q = right.len();
        let (start, classes) = (self.updating.scales.list(), self.classes());
        let mut scales = self.updating.scales;
        let mut best = Estimate { cost: f64::INFINITY, value: 0.0, u: vec![0.0; q], scales };
        for _ in 0..ROUNDS {
            let list = scales.list();
            let widths: Vec<f64> = classes.iter().map(|&class| list[class] / start[class]).collect();
            // A = 1 + W G W in the variables v = u / w.
            let unit = |i: usize, j: usize| f64::from(u8::from(i == j));
            let normal = Mat::from_fn(q, q, |i, j| widths[i] * product[(i, j)] * widths[j] + unit(i, j));
            let Some(factor) = Cholesky::new(normal.as_ref()) else { break };
            let mut sides = Mat::from_fn(q, q + 1, unit);
            (0..q).for_each(|i| sides[(i, q)] = widths[i] * right[i]);
            let solved = factor.solve(sides.as_ref());
            let explained: f64 = (0..q).map(|i| solved[(i, q)] * sides[(i, q)]).sum();
            let cost = square - explained + factor.log_determinant() + scales.prior_cost();
            if cost < best.cost {
                let u = (0..q).map(|i| widths[i] * solved[(i, q)]).collect();
                best = Estimate { cost, u, scales, ..best };
            }
            let mut next = list;
            for (class, scale) in next.iter_mut().enumerate() {
                let own = || (0..q).filter(|&k| classes[k] == class);
                let known: f64 = own().map(|k| 1.0 - solved[(k, k)]).sum();
                if known > LEAST_KNOWN {
                    *scale *= (own().map(|k| solved[(k, q)].powi(2)).sum::<f64>() / known).sqrt();
                }
            }
            scales = Scales::from_list(next);
        }
        best
    }

    fn classes(&self) -> Vec<usize> {
        self.updating.parameters.iter().map(UpdatingParameter::class).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::Part;

    const ROWS: [f64; 7] = [0.9, -1.3, 2.0, 0.7, -2.2, 1.1, 3.3];
    const COLUMN: [f64; 7] = [1.0, 0.3, -0.4, 2.0, 0.0, -1.0, 0.5];

    fn updating() -> Updating {
        let parameters = [0, 1].map(|spring| UpdatingParameter::Structure(Part::GroundSpring(spring))).into();
        Updating { parameters, values: vec![0.0; 2], spreads: vec![1.0; 2], ..Updating::default() }
            .with_scales(Scales::SEARCH)
    }

    fn slopes() -> Vec<Vec<f64>> {
        vec![vec![1.0, -2.0, 0.5, 0.0, 3.0, 1.0, 0.2], vec![0.0, 1.0, 1.5, -1.0, 0.4, 2.0, -0.7]]
    }

    /// Minus twice the logarithm of the marginal density (without `n ln 2 pi`) of the rows with corrections of the width `w`, by
    /// their dense covariance; with the column its parameter integrated out under a flat prior (restricted likelihood).
    fn dense(w: f64, column: Option<&[f64]>) -> f64 {
        let slopes = slopes();
        let covariance = Mat::from_fn(7, 7, |i, j| {
            slopes.iter().map(|s| w * w * s[i] * s[j]).sum::<f64>() + f64::from(u8::from(i == j))
        });
        let factor = Cholesky::new(covariance.as_ref()).unwrap();
        let inner = |a: &[f64], b: &[f64]| {
            let solved = factor.solve(Mat::from_fn(7, 1, |i, _| b[i]).as_ref());
            (0..7).map(|i| a[i] * solved[(i, 0)]).sum::<f64>()
        };
        let cost = inner(&ROWS, &ROWS) + factor.log_determinant();
        match column {
            None => cost,
            Some(c) => cost - inner(c, &ROWS).powi(2) / inner(c, c) + inner(c, c).ln() - dot(c, c).ln(),
        }
    }

    #[test]
    fn the_evidence_is_that_of_the_dense_covariance_and_no_scale_nearby_has_more() {
        let (updating, slopes) = (updating(), slopes());
        let model = Gram::new(&updating, &slopes, &ROWS);
        for column in [None, Some(&COLUMN[..])] {
            let fit = model.estimated(column);
            let scales = |model: f64| Scales { model, ..fit.scales };
            let cost = |m: f64| dense(m / Scales::SEARCH.model, column) + scales(m).prior_cost();
            let here = fit.scales.model;
            assert!((fit.cost - cost(here)).abs() < 1e-9, "{} {}", fit.cost, cost(here));
            // MacKay's iteration leaves the prior of the scales aside, and is towards the most likely scale, which may be none.
            for nearby in [0.5 * here, 2.0 * here] {
                assert!(fit.cost < cost(nearby) + 0.5, "{column:?}: {} at {here}, {}", fit.cost, cost(nearby));
            }
        }
    }

    #[test]
    fn a_change_beside_small_corrections_is_estimated_as_by_least_squares() {
        let (updating, slopes) = (updating(), slopes());
        let rows: Vec<f64> = COLUMN.iter().zip(&slopes[0]).map(|(c, s)| 12.0 * c + 0.1 * s).collect();
        let model = Gram::new(&updating, &slopes, &rows);
        let (without, with) = (model.estimated(None), model.estimated(Some(&COLUMN)));
        assert!((with.value - 12.0).abs() < 0.3 && with.u[0].abs() < 0.3, "{} {:?}", with.value, with.u);
        assert!(without.cost - with.cost > 10.0 && with.scales.model < without.scales.model);
    }

    #[test]
    fn gains_that_measuring_chains_have_are_no_change() {
        let gain = |value: f64| changed(Source::known(Effect::Gain, Place::Channel("acc@1".into()), &[1.0]), value);
        assert!(gain(0.05).is_none() && gain(-0.05).is_none());
        assert!((gain(-0.4).unwrap().parameters[0] - (-0.4_f64).exp()).abs() < 1e-12);
        let spring = |value: f64| changed(Source::known(Effect::Stiffness, Place::Dofs(vec![0]), &[1.0]), value);
        assert!(spring(-3.0).is_none() && spring(3.0).is_some());
    }
}

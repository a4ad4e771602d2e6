//! The search for one more effect, or two at once: places first, then laws, then the fit on the response.

use super::short_list::{Breadth, preselected_places, score_bound};
use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::candidates::identified_force::{LawFit, PlaceData};
use crate::diagnosis::candidates::start::{Fields, UnfittedSet};
use crate::diagnosis::localisation::cell::{FreeForce, shrunk};
use crate::diagnosis::localisation::free_force::{Placing, Screen};
use crate::diagnosis::localisation::location::{Receptances, Spot};
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::modal_expansion::DETUNING;
use crate::effects::{Place, Source};
use crate::math::statistics::bayesian_information;
use faer::{Mat, c64};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Places whose laws are looked at.
const PLACES: usize = 24;
/// Places whose laws are looked at while the model is still moved.
const NEAR: usize = 5;
/// Places whose laws are looked at before the others.
const AHEAD: usize = 2;
/// Scaled squared residual beyond the best law that a free force of a place may leave where its laws are looked at.
const MARGIN: f64 = 150.0;
/// Places at which the law found is tried too, where no law can tell them apart.
const ELSEWHERE: usize = 6;

/// The residual of a model seen from every place.
pub(crate) struct View<'a> {
    pub(crate) screen: Screen,
    receptances: Receptances<'a>,
    predictions: Vec<RunPrediction>,
    /// Spots whose simple laws have been regressed, each alone.
    pub(super) regressed: RegressedSpots,
}

/// Spots of one model by their number.
pub(super) type RegressedSpots = BTreeMap<usize, Arc<Regressed>>;

/// A spot with its free force and the laws of one or two parameters that were regressed on it.
pub(super) struct Regressed {
    data: PlaceData,
    fields: Arc<Fields>,
    simple: Vec<LawFit>,
}

impl ReferenceModel<'_> {
    /// The residual of the known model, or of a fit, seen from every place.
    pub(crate) fn view(&self, of: Option<&FittedModel>) -> Result<View<'_>, DiagnosisError> {
        let effects = of.map_or(&[][..], |fit| &fit.effects);
        let mut receptances = Receptances::new(&self.predictor, self.data, effects);
        let predictions = match of {
            None => self.predictions.clone(),
            Some(fit) => self.estimator().predict(effects, &FINAL, &fit.starts)?,
        };
        let noise = if self.linearisation.doubts_harmonics {
            Cow::Owned(self.noise_of_places(effects, &predictions)?)
        } else {
            Cow::Borrowed(&self.noise.runs)
        };
        let screen = Screen::new(
            &self.predictor,
            self.data,
            &predictions,
            &noise,
            &mut receptances,
            &self.linearisation,
            self.control,
        )?;
        Ok(View { screen, receptances, predictions, regressed: RegressedSpots::new() })
    }

    /// Laws at the places that explain most, regressed on the free forces there beside `effects`.
    pub(crate) fn unfitted(
        &self,
        view: &mut View,
        effects: &[Source],
        breadth: Breadth,
    ) -> Result<Vec<UnfittedSet>, DiagnosisError> {
        let placings = match breadth {
            Breadth::Near => view.screen.singles().into_iter().take(NEAR).collect(),
            _ => self.worth_while(view, effects)?,
        };
        let mut laws = self.all_laws(view, &placings, effects, Breadth::Simple)?;
        let wide = preselected_places(&placings, &laws);
        let chosen: Vec<Placing> = wide.iter().map(|&k| placings[k].clone()).collect();
        if breadth == Breadth::All && !self.control.is_late() {
            for (k, all) in wide.into_iter().zip(self.all_laws(view, &chosen, effects, Breadth::All)?) {
                laws[k] = all;
            }
        }
        let mut unfitted = Vec::new();
        for (placing, laws) in placings.iter().zip(laws) {
            let options = laws.into_iter().flatten();
            unfitted.extend(options.map(|d| UnfittedSet { score: d.score + placing.chi_square, ..d }));
        }
        Ok(unfitted)
    }

    /// Standardised updating parameters that fit best beside the laws of `unfitted` at their one place, whose forces are those at
    /// the measured motion; `None` where the place is not seen.
    pub(crate) fn updated_beside(
        &self,
        view: &mut View,
        unfitted: &UnfittedSet,
    ) -> Result<Option<Vec<f64>>, DiagnosisError> {
        let source = &unfitted.effects[0];
        if matches!(source.place, Place::Whole(_)) {
            let whole = self.whole_sets(view).into_iter().find(|(set, _)| set.effects[0].effect == source.effect);
            return Ok(whole.map(|(_, updated)| updated));
        }
        let Some(spot) = view.screen.spots.iter().position(|s| s.place().is_same(&source.place)) else {
            return Ok(None);
        };
        self.need(view, &[spot])?;
        let (forces, fields) = self.free(view, &[spot]);
        let data = self.at_place(view, spot, &forces[0], &fields);
        Ok(data.forces_of_all(&unfitted.effects).map(|forces| view.screen.updated_beside(spot, &forces)))
    }

    /// The free force of the place of `source` when the model has the other effects of `fit`; none for whole-structure
    /// laws.
    pub(crate) fn place_data(&self, fit: &FittedModel, source: &Source) -> Result<Option<PlaceData>, DiagnosisError> {
        let mut others = fit.clone();
        others.effects.retain(|e| !e.is_same(source));
        others.starts.clear();
        let mut view = self.view(Some(&others))?;
        let Some(at) = view.screen.spots.iter().position(|spot| spot.place().is_same(&source.place)) else {
            return Ok(None);
        };
        self.need(&mut view, &[at])?;
        let (forces, fields) = self.free(&view, &[at]);
        Ok(Some(self.at_place(&view, at, &forces[0], &fields)))
    }

    /// The set `best` with its effect `source` at other places that leave no more than `margin` beyond what its own place
    /// leaves to a free force.
    pub(crate) fn elsewhere(
        &self,
        best: &FittedModel,
        source: &Source,
        margin: f64,
    ) -> Result<Vec<FittedModel>, DiagnosisError> {
        let mut others = best.clone();
        others.effects.retain(|e| !e.is_same(source));
        others.starts.clear();
        let mut view = self.view(Some(&others))?;
        let placings = view.screen.singles();
        let place = |view: &View, p: &Placing| view.screen.spots[p.spots[0]].place();
        let Some(own) = placings.iter().find(|p| place(&view, p).is_same(&source.place)) else { return Ok(Vec::new()) };
        let near: Vec<Placing> = placings
            .iter()
            .filter(|p| p.chi_square < own.chi_square + margin && !place(&view, p).is_same(&source.place))
            .take(ELSEWHERE)
            .cloned()
            .collect();
        let mut unfitted = Vec::new();
        for options in self.all_laws(&mut view, &near, &others.effects, Breadth::All)? {
            let same = options.into_iter().flatten().find(|d| d.effects[0].effect == source.effect);
            unfitted.extend(same.map(|d| UnfittedSet { effects: joined(&others.effects, &d.effects), ..d }));
        }
        self.fit_all(&unfitted)
    }

    /// Computes the receptances of the spots.
    pub(crate) fn need(&self, view: &mut View, spots: &[usize]) -> Result<(), DiagnosisError> {
        for &s in spots {
            if let Spot::Leg(leg) = view.screen.spots[s] {
                view.receptances.need_leg(leg, self.control)?;
            }
        }
        Ok(())
    }

    /// Free forces of the spots of a placing, and the motion they imply; their receptances are there.
    pub(crate) fn free(&self, view: &View, spots: &[usize]) -> (Vec<Vec<Vec<FreeForce>>>, Fields) {
        let mut forces = view.screen.forces(spots);
        for (&s, list) in spots.iter().zip(&mut forces) {
            self.doubt_harmonics(view, s, list);
        }
        let n = self.predictor.structure().len();
        let field = |(r, run): (usize, &crate::diagnosis::residual::data::RunData)| {
            let response = &view.predictions[r].response;
            let mut field = Mat::from_fn(n, run.harmonics, |i, h| response.amplitude(i, h + 1));
            for (&s, list) in spots.iter().zip(&forces) {
                let Spot::Leg(leg) = view.screen.spots[s] else { continue };
                for h in 1..=run.harmonics {
                    let force = shrunk(&list[r], h);
                    for i in 0..n {
                        field[(i, h - 1)] -= leg.relative(|j| view.receptances.entry(r, h, i, j)) * force;
                    }
                }
            }
            for (k, expansion) in self.linearisation.derivatives.expansions.get(r).into_iter().flatten().enumerate() {
                if let Some(expansion) = expansion {
                    expansion.correct(run, k + 1, field.col_as_slice_mut(k));
                }
            }
            field
        };
        let fields: Vec<Mat<c64>> = self.data.runs.iter().enumerate().map(field).collect();
        (forces, fields)
    }

    /// Weights of the harmonics of free forces at spot `s` with what is known of the receptance there: resonances above the band are
    /// where the model says to some per cent, so that a force of the size of a harmonic, the fundamental over the order, is known to
    /// that share of it only.
    fn doubt_harmonics(&self, view: &View, s: usize, forces: &mut [Vec<FreeForce>]) {
        let Spot::Leg(leg) = view.screen.spots[s] else { return };
        if !self.linearisation.doubts_harmonics {
            return;
        }
        for (r, (run, list)) in self.data.runs.iter().zip(forces).enumerate() {
            let size = list.first().map_or(0.0, |first| first.value.norm());
            for (k, free) in list.iter_mut().enumerate().skip(1).filter(|(_, free)| free.weight > 0.0) {
                let share = DETUNING * view.receptances.sensitivity_to_stiffness(r, run, k + 1, leg);
                free.weight = 1.0 / (1.0 / free.weight + (share.min(1.0) * size / (k + 1) as f64).powi(2));
            }
        }
    }

    /// The free `forces` of spot `s` with the motion `fields` that they imply.
    pub(crate) fn at_place(&self, view: &View, s: usize, forces: &[Vec<FreeForce>], fields: &Fields) -> PlaceData {
        let spot = &view.screen.spots[s];
        let impedance = |(r, run): (usize, &crate::diagnosis::residual::data::RunData)| match spot {
            Spot::Leg(leg) => view.receptances.impedance(r, run, *leg),
            Spot::Response(_) | Spot::Force(_) => 0.0,
        };
        let impedances = self.data.runs.iter().enumerate().map(impedance).collect();
        let still = match spot {
            Spot::Leg(leg) if !self.data.runs.is_empty() => self.predictor.run(0).static_compliance(*leg),
            _ => 0.0,
        };
        PlaceData::new(self.data, spot, forces, fields, impedances, still, view.screen.freedom(s))
    }

    /// Places whose laws may become the best: what the best place leaves to its best law bounds what others may leave.
    fn worth_while(&self, view: &mut View, effects: &[Source]) -> Result<Vec<Placing>, DiagnosisError> {
        let mut placings = view.screen.singles();
        placings.truncate(PLACES);
        let first = &placings[..placings.len().min(AHEAD)];
        let scores = self.all_laws(view, first, effects, Breadth::Simple)?.into_iter().zip(first).filter_map(
            |(laws, placing)| {
                let best = laws.into_iter().flatten().map(|d| d.score).fold(f64::INFINITY, f64::min);
                (best < f64::INFINITY).then_some(best + placing.chi_square)
            },
        );
        let best = scores.fold(f64::INFINITY, f64::min);
        let bound = if self.linearisation.is_empty() {
            score_bound(best)
        } else {
            best + MARGIN * (best / self.count().max(1) as f64).max(1.0)
        };
        placings.retain(|p| p.chi_square < bound);
        Ok(placings)
    }

    /// Laws fitted to the free forces of each spot of every placing, best first; the score is their misfit with its penalty.
    pub(super) fn all_laws(
        &self,
        view: &mut View,
        placings: &[Placing],
        effects: &[Source],
        breadth: Breadth,
    ) -> Result<Vec<Vec<Vec<UnfittedSet>>>, DiagnosisError> {
        for placing in placings {
            self.need(view, &placing.spots)?;
        }
        let found = self.control.map(placings.len(), |k| {
            self.control.check()?;
            Ok::<_, DiagnosisError>(self.regressed(view, &placings[k]))
        });
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        for (placing, regressed) in placings.iter().zip(&found) {
            if let ([spot], [only]) = (&placing.spots[..], &regressed[..]) {
                view.regressed.insert(*spot, only.clone());
            }
        }
        let laws = |k: usize| found[k].iter().map(|regressed| self.laws(regressed, effects, breadth)).collect();
        Ok(self.control.map(placings.len(), laws))
    }

    /// The simple laws of each spot of a placing, those of single spots where they were regressed before.
    fn regressed(&self, view: &View, placing: &Placing) -> Vec<Arc<Regressed>> {
        if let [spot] = &placing.spots[..]
            && let Some(known) = view.regressed.get(spot)
        {
            return vec![known.clone()];
        }
        let (forces, fields) = self.free(view, &placing.spots);
        let fields = Arc::new(fields);
        let regressed_spot = |(&s, forces): (&usize, &Vec<Vec<FreeForce>>)| {
            let data = self.at_place(view, s, forces, &fields);
            let simple = data.simple_fits();
            Arc::new(Regressed { data, fields: fields.clone(), simple })
        };
        placing.spots.iter().zip(&forces).map(regressed_spot).collect()
    }

    /// The laws of `breadth` at a spot beside `effects`.
    fn laws(&self, regressed: &Regressed, effects: &[Source], breadth: Breadth) -> Vec<UnfittedSet> {
        let Regressed { data, fields, simple } = regressed;
        let fresh = |source: &Source| {
            self.data.allows(source) && !effects.iter().any(|e| e.is_same(source) || both_stick(e, source))
        };
        let fits = if breadth == Breadth::All { data.all_fits(simple.clone()) } else { simple.clone() };
        let unfitted = |fit: LawFit| {
            let score = bayesian_information(fit.misfit, fit.source.parameters.len(), data.count());
            UnfittedSet { effects: vec![fit.source], score, fields: fields.clone() }
        };
        let mut unfitted: Vec<UnfittedSet> = fits.into_iter().filter(|fit| fresh(&fit.source)).map(unfitted).collect();
        unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
        unfitted
    }
}

/// Whether both are friction at one place: which of them holds what it carries is not determined, and what both are together is another
/// law of friction.
fn both_stick(a: &Source, b: &Source) -> bool {
    a.place.is_same(&b.place) && [a, b].iter().all(|source| friction(source.effect).is_some())
}

pub(crate) fn joined(first: &[Source], second: &[Source]) -> Vec<Source> {
    first.iter().chain(second).cloned().collect()
}

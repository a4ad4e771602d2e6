//! Starts of fits: single laws, sums of two and of three, scaled to the force on the grid of their shapes.

use super::fit::{Fitted, residual, without_repeats};
use super::search::Search;
use crate::balance::loops::ComponentError;
use crate::effects::{Effect, Place, Source, State};
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;

/// Rows on which shapes are compared, and shapes a law that go into pairs.
const ROWS: usize = 4000;
const SHAPES: usize = 6;
/// Sums of two to which every other law is added.
const BASES: usize = 4;
/// Sums of which one law is exchanged for every other.
const EXCHANGED: usize = 3;
/// Fits of sums of which one law was exchanged.
const EXCHANGES: usize = 12;
/// Share of the diagonal that is added to the products of columns: two shapes may be all but one.
const RIDGE: f64 = 1e-9;

/// A law in one shape, its force in unit scale over rows of all records.
pub(super) struct Column {
    source: Source,
    rows: Vec<f64>,
    square: f64,
    against: f64,
}

impl Search<'_> {
    /// Every law in every shape.
    pub(super) fn columns(&self) -> Result<Vec<Column>, ComponentError> {
        let measured = Self::thinned(residual(self.loops, &[], &self.all)?);
        let range = self.loops.range();
        let mut columns = Vec::new();
        for (effect, _) in Effect::relative() {
            self.control.check()?;
            for parameters in effect.shapes(&range) {
                let source = Source { effect, place: Place::Dofs(vec![0]), state: State::Known, parameters };
                let taken = |list: &[Source]| list.iter().any(|s| s.is_same(&source));
                if taken(self.excluded) || self.loops.list[0].law_force(&source).is_none() {
                    continue;
                }
                // What is left with the law less what is left without it: its force, zero taken out, with a minus.
                let with = Self::thinned(residual(self.loops, std::slice::from_ref(&source), &self.all)?);
                let rows: Vec<f64> = measured.iter().zip(&with).map(|(m, w)| m - w).collect();
                let (square, against) = (dot(&rows, &rows), dot(&rows, &measured));
                if square > 0.0 && square.is_finite() {
                    columns.push(Column { source, rows, square, against });
                }
            }
        }
        Ok(columns)
    }

    fn thinned(rows: Vec<f64>) -> Vec<f64> {
        let every = (rows.len() / ROWS).max(1);
        rows.into_iter().step_by(every).collect()
    }

    /// The best shape of every law, best first.
    pub(super) fn single(columns: &[Column]) -> Vec<Vec<Source>> {
        let mut found: Vec<(f64, Source)> = Vec::new();
        for column in columns {
            let Some(source) = sized(&column.source, column.against / column.square) else { continue };
            let gain = column.against.powi(2) / column.square;
            match found.iter_mut().find(|(_, s)| s.effect == source.effect) {
                Some(own) if gain > own.0 => *own = (gain, source),
                Some(_) => {}
                None => found.push((gain, source)),
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().map(|(_, source)| vec![source]).collect()
    }

    /// The best pair of shapes of every pair of laws, best first.
    pub(super) fn pairs(columns: &[Column]) -> Vec<Vec<Source>> {
        let mut chosen: Vec<&Column> = Vec::new();
        for (effect, _) in Effect::relative() {
            let mut own: Vec<&Column> = columns.iter().filter(|c| c.source.effect == effect).collect();
            let every = own.len().div_ceil(SHAPES).max(1);
            own.sort_by(|a, b| (b.against.powi(2) / b.square).total_cmp(&(a.against.powi(2) / a.square)));
            let best = own.first().copied();
            chosen.extend(columns.iter().filter(|c| c.source.effect == effect).step_by(every));
            chosen.extend(best);
        }
        let mut found: Vec<(f64, Vec<Source>)> = Vec::new();
        for (i, a) in chosen.iter().enumerate() {
            for b in chosen.iter().skip(i + 1).filter(|b| b.source.effect != a.source.effect) {
                let product = dot(&a.rows, &b.rows);
                let determinant = a.square * b.square - product * product;
                if determinant < 1e-6 * a.square * b.square {
                    continue;
                }
                let s = (b.square * a.against - product * b.against) / determinant;
                let t = (a.square * b.against - product * a.against) / determinant;
                let (Some(first), Some(second)) = (sized(&a.source, s), sized(&b.source, t)) else { continue };
                let gain = s * a.against + t * b.against;
                let same = |set: &[Source]| set[0].effect == first.effect && set[1].effect == second.effect;
                match found.iter_mut().find(|(_, set)| same(set)) {
                    Some(own) if gain > own.0 => *own = (gain, vec![first, second]),
                    Some(_) => {}
                    None => found.push((gain, vec![first, second])),
                }
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().map(|(_, set)| set).collect()
    }

    /// The best shape of every law beside each of the best sums of two, best first.
    pub(super) fn triples(&self, columns: &[Column], pairs: &[Fitted]) -> Result<Vec<Vec<Source>>, ComponentError> {
        let bases = pairs.iter().filter(|f| f.effects.len() == 2).take(BASES);
        let found = bases.map(|f| self.beside(columns, &f.effects)).collect::<Result<Vec<_>, _>>()?;
        Ok(best_first(found.into_iter().flatten().collect()))
    }

    /// Sums with those that follow from the best of them by exchange of one law, by evidence.
    pub(super) fn with_exchanges(
        &self,
        columns: &[Column],
        mut fits: Vec<Fitted>,
    ) -> Result<Vec<Fitted>, ComponentError> {
        fits.extend(self.fitted(self.exchanges(columns, &fits)?, EXCHANGES)?);
        fits.sort_by(|a, b| self.criterion(a).total_cmp(&self.criterion(b)));
        Ok(without_repeats(fits))
    }

    /// The best sums of those in `fits` with one law exchanged for another, best first.
    fn exchanges(&self, columns: &[Column], fits: &[Fitted]) -> Result<Vec<Vec<Source>>, ComponentError> {
        let mut found = Vec::new();
        for fit in fits.iter().filter(|f| f.effects.len() > 1).take(EXCHANGED) {
            for k in 0..fit.effects.len() {
                let mut others = fit.effects.clone();
                others.remove(k);
                found.extend(self.beside(columns, &others)?);
            }
        }
        let is_fitted = |set: &[Source]| fits.iter().any(|fit| has_laws_of(set, &fit.effects));
        Ok(best_first(found).into_iter().filter(|set| !is_fitted(set)).collect())
    }

    /// The best shape of every other law beside the laws in `base`, all scaled anew, each with what it takes from the square.
    fn beside(&self, columns: &[Column], base: &[Source]) -> Result<Vec<(f64, Vec<Source>)>, ComponentError> {
        let measured = Self::thinned(residual(self.loops, &[], &self.all)?);
        let rows = |source: &Source| -> Result<Vec<f64>, ComponentError> {
            let with = Self::thinned(residual(self.loops, std::slice::from_ref(source), &self.all)?);
            Ok(measured.iter().zip(&with).map(|(m, w)| m - w).collect())
        };
        let base_rows = base.iter().map(rows).collect::<Result<Vec<_>, _>>()?;
        let mut best: Vec<(f64, Vec<Source>)> = Vec::new();
        for column in columns.iter().filter(|c| base.iter().all(|e| e.effect != c.source.effect)) {
            let all: Vec<&[f64]> = base_rows.iter().chain([&column.rows]).map(Vec::as_slice).collect();
            let Some((gain, scales)) = scales_of(&all, &measured) else { continue };
            let laws = base.iter().chain([&column.source]).zip(scales);
            let Some(set) = laws.map(|(law, scale)| sized(law, scale)).collect::<Option<Vec<Source>>>() else {
                continue;
            };
            match best.iter_mut().find(|(_, own)| own[base.len()].effect == column.source.effect) {
                Some(own) if gain > own.0 => *own = (gain, set),
                Some(_) => {}
                None => best.push((gain, set)),
            }
        }
        Ok(best)
    }
}

/// Whether a set has the laws of another, whatever their parameters.
fn has_laws_of(set: &[Source], other: &[Source]) -> bool {
    set.len() == other.len() && set.iter().all(|a| other.iter().any(|b| a.effect == b.effect))
}

/// Sets in the order of their gains, each set of laws once.
fn best_first(mut found: Vec<(f64, Vec<Source>)>) -> Vec<Vec<Source>> {
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut sets: Vec<Vec<Source>> = Vec::new();
    for (_, set) in found {
        if !sets.iter().any(|known| has_laws_of(&set, known)) {
            sets.push(set);
        }
    }
    sets
}

/// Scales of columns that fit `measured` best, and by how much its square falls.
fn scales_of(columns: &[&[f64]], measured: &[f64]) -> Option<(f64, Vec<f64>)> {
    let count = columns.len();
    let normal = Mat::from_fn(count, count, |i, j| dot(columns[i], columns[j]));
    let against: Vec<f64> = columns.iter().map(|column| dot(column, measured)).collect();
    let scales = EquilibratedCholesky::new(normal.as_ref(), RIDGE)?.solve(&against);
    Some((dot(&scales, &against), scales))
}

/// A law of unit scale at a scale; none where its parameters do not allow it.
fn sized(source: &Source, scale: f64) -> Option<Source> {
    let mut source = source.clone();
    source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= scale);
    let allowed = source.parameters.iter().zip(source.effect.parameters()).all(|(v, p)| p.allows(*v));
    (scale.is_finite() && scale != 0.0 && allowed).then_some(source)
}

//! Two laws at one place: the free force there regressed on the sum of both, for places where no law alone explains it, such as a
//! joint that slips and a part that stiffens with the amplitude.
//!
//! With the whitened free force `g` of the place and the whitened forces `F_a(p)` of a law of any shape `p` and `F_b` of a law of
//! one parameter, all at the measured motion,
//!
//! ```text
//! J(p) = min over s, t of | g - s F_a(p) - t F_b |^2
//! ```
//!
//! is linear for every shape of the start grid. The best shape of each two laws is then fitted in all parameters by Levenberg and
//! Marquardt's method.

use super::friction::friction;
use super::identified_force::PlaceData;
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::levenberg_marquardt::{Descent, Residual, descend};
use crate::effects::{Effect, Kind, Source, State};
use crate::math::statistics::bayesian_information;
use dashpot_numerics::dot;
use faer::{Mat, c64};
use std::convert::Infallible;

/// Pairs of laws that are fitted in all parameters.
const FITTED: usize = 8;
/// Shapes of a pair from which it is fitted: the sum of two laws has several minima, and of a measured bolted beam on three levels only the
/// third best shape led to the least.
const SHAPES: usize = 4;
/// Steps of each fit.
const STEPS: usize = 30;
/// Step of a variable for difference quotients; friction has kinks, and the step is to see past those of single samples.
const STEP: f64 = 1e-3;
/// Gain of the misfit per datum below which a fit has arrived: it is a start for a fit on the response.
const ENOUGH: f64 = 1.0;

/// Two laws fitted to the free force of a place.
#[derive(Debug, Clone)]
pub(crate) struct TwoLaws {
    /// Both with their parameters.
    pub sources: [Source; 2],
    /// Weighted squared difference of free force and the sum of both.
    pub misfit: f64,
}

impl TwoLaws {
    /// Misfit with what the number of parameters costs among `count` data.
    pub(crate) fn score(&self, count: usize) -> f64 {
        let parameters = self.sources.iter().map(|s| s.parameters.len()).sum();
        bayesian_information(self.misfit, parameters, count)
    }

    /// Whether it is of the same laws.
    fn is_same(&self, other: &Self) -> bool {
        (0..2).all(|k| self.sources[k].effect == other.sources[k].effect)
    }
}

/// A law of fixed shape with its whitened force at unit scale.
struct Shape {
    source: Source,
    force: Vec<f64>,
    /// Whether the force is in proportion to a scale.
    scales: bool,
}

impl PlaceData {
    /// Pairs of laws among those that `allowed` admits, fitted to the free force here, best first.
    pub(crate) fn two_laws(&self, allowed: impl Fn(&Source) -> bool) -> Vec<TwoLaws> {
        let Spot::Leg(_) = self.spot else { return Vec::new() };
        let measured = self.rows(1.0, |_, order| vec![c64::new(0.0, 0.0); order]);
        let laws = || Effect::ALL.into_iter().filter(|effect| matches!(effect.kind(), Kind::Relative(_)));
        let shapes: Vec<Shape> =
            laws().flat_map(|effect| self.shapes(effect)).filter(|shape| allowed(&shape.source)).collect();
        let simple = |shape: &&Shape| shape.scales && shape.source.parameters.len() == 1;
        let mut found: Vec<TwoLaws> = Vec::new();
        for b in shapes.iter().filter(simple) {
            for a in &shapes {
                let twice = a.source.effect == b.source.effect;
                // Of two laws of one parameter each, once.
                let seen = simple(&a) && position(a.source.effect) > position(b.source.effect);
                found.extend((!twice && !seen).then(|| scaled(&measured, a, b)).flatten());
            }
        }
        self.fitted(found)
    }

    /// Each of the best of `pairs` as it fits best in all parameters, best first.
    fn fitted(&self, pairs: Vec<TwoLaws>) -> Vec<TwoLaws> {
        let count = self.count();
        let fit = |shapes: Vec<TwoLaws>| {
            let fits = shapes.iter().filter_map(|shape| self.descended(&shape.sources));
            fits.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
        };
        let mut fitted: Vec<TwoLaws> = starts(pairs, count).into_iter().filter_map(fit).collect();
        fitted.sort_by(|a, b| a.score(count).total_cmp(&b.score(count)));
        fitted
    }

    fn descended(&self, sources: &[Source; 2]) -> Option<TwoLaws> {
        let (variables, start) = Variables::new(sources);
        let Ok(Descent { theta, chi_square, .. }) =
            descend(&mut Sum { data: self, variables: &variables }, &start, STEPS);
        let sources = <[Source; 2]>::try_from(variables.effects(&theta)).ok()?;
        chi_square.is_finite().then_some(TwoLaws { sources, misfit: chi_square })
    }

    /// The shapes of `effect` from which a fit may start, friction in the sizes that the free force suggests.
    fn shapes(&self, effect: Effect) -> Vec<Shape> {
        let Kind::Relative(law) = effect.kind() else { return Vec::new() };
        let rubs = friction(effect);
        let parameters = rubs.map_or_else(|| effect.shapes(&self.range), |rubbing| self.sizes(effect, rubbing));
        let shape = |parameters: Vec<f64>| {
            let force = self.rows(0.0, |r, order| match rubs {
                Some(rubbing) => self.held(rubbing, &parameters, r, order),
                None => self.at_motion(law, &parameters, &self.motions[r], order),
            });
            let source = Source { effect, place: self.spot.place(), state: State::Known, parameters };
            Shape { source, force: force.into_iter().map(|f| -f).collect(), scales: rubs.is_none() }
        };
        parameters.into_iter().map(shape).collect()
    }

    /// Harmonics of the sum of the forces of `sources`, effects that act here, at the motion of every run, `[run][harmonic]`, N; `None`
    /// where one of them cannot act here.
    pub(crate) fn forces_of_all(&self, sources: &[Source]) -> Option<Vec<Vec<c64>>> {
        let mut forces = sources.iter().map(|source| self.forces_of(source));
        let mut sum = forces.next()??;
        for other in forces {
            for (run, other) in sum.iter_mut().zip(other?) {
                run.iter_mut().zip(other).for_each(|(sum, force)| *sum += force);
            }
        }
        Some(sum)
    }

    /// Weighted differences between the free force and the sum of the forces of `sources`.
    fn left_by_sum(&self, sources: &[Source]) -> Vec<f64> {
        let forces = self.forces_of_all(sources).unwrap_or_default();
        self.rows(1.0, |r, _| forces[r].clone())
    }
}

/// Place of an effect in the table of laws.
fn position(effect: Effect) -> usize {
    Effect::ALL.iter().position(|other| *other == effect).unwrap_or(usize::MAX)
}

/// The best of `pairs`, each as the shapes from which it is fitted.
fn starts(mut pairs: Vec<TwoLaws>, count: usize) -> Vec<Vec<TwoLaws>> {
    pairs.sort_by(|a, b| a.score(count).total_cmp(&b.score(count)));
    let mut starts: Vec<Vec<TwoLaws>> = Vec::new();
    for pair in pairs {
        if let Some(known) = starts.iter().position(|shapes| shapes[0].is_same(&pair)) {
            starts[known].push(pair);
        } else if starts.len() < FITTED {
            starts.push(vec![pair]);
        }
    }
    starts.iter_mut().for_each(|shapes| shapes.truncate(SHAPES));
    starts
}

/// Both laws with the scales that leave least of `measured`, friction with its own size; none where one has an unphysical sign.
fn scaled(measured: &[f64], a: &Shape, b: &Shape) -> Option<TwoLaws> {
    let (aa, ab, bb) = (dot(&a.force, &a.force), dot(&a.force, &b.force), dot(&b.force, &b.force));
    let (ma, mb) = (dot(measured, &a.force), dot(measured, &b.force));
    let (s, t) = if a.scales {
        let determinant = aa * bb - ab * ab;
        ((ma * bb - mb * ab) / determinant, (mb * aa - ma * ab) / determinant)
    } else {
        (1.0, (mb - ab) / bb)
    };
    let signed = |shape: &Shape| shape.source.effect.parameters()[0].least < 0.0;
    let physical = |shape: &Shape, scale: f64| scale.is_finite() && scale != 0.0 && (scale > 0.0 || signed(shape));
    if !physical(a, s) || !physical(b, t) {
        return None;
    }
    let all = dot(measured, measured);
    let misfit = all - 2.0 * (s * ma + t * mb) + s * s * aa + 2.0 * s * t * ab + t * t * bb;
    (misfit < all).then(|| TwoLaws { sources: [times(&a.source, s), times(&b.source, t)], misfit })
}

/// A law whose force is `scale` times as large.
fn times(source: &Source, scale: f64) -> Source {
    let mut scaled = source.clone();
    source.effect.scaled().iter().for_each(|&k| scaled.parameters[k] *= scale);
    scaled
}

/// The regression of a sum of laws.
struct Sum<'a> {
    data: &'a PlaceData,
    variables: &'a Variables,
}

impl Residual for Sum<'_> {
    type Error = Infallible;

    fn enough(&self) -> f64 {
        ENOUGH
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        self.variables.bounds()
    }

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        Ok(self.data.left_by_sum(&self.variables.effects(theta)))
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let column = |k: usize| {
            let mut moved = theta.to_vec();
            moved[k] += STEP;
            self.data.left_by_sum(&self.variables.effects(&moved))
        };
        let columns: Vec<Vec<f64>> = (0..theta.len()).map(column).collect();
        Ok(Mat::from_fn(at.len(), columns.len(), |i, k| (columns[k][i] - at[i]) / STEP))
    }
}

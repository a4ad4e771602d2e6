//! The search for `points` structures, on the energies alone.
//!
//! ```text
//! e_r - sum of known = sum_j s_j G_rj(shape_j) + noise,      s_j >= 0
//! ```
//!
//! one column a law, place and shape of its grid. All columns and all pairs of columns are looked at; the best are
//! fitted in all their parameters. What takes no energy (springs, masses) cannot be seen.

use super::conclusion::conclude;
use super::evidence::{agrees, criterion};
use crate::control::Control;
use crate::diagnosis::channels::fault::is_ordinary_gain;
use crate::diagnosis::points::balance::{Balance, Column, Fitted};
use crate::diagnosis::points::uncertainty::Multiples;
use crate::diagnosis::residual::data::{DiagnosisError, Problem};
use crate::diagnosis::result::{Added, Diagnosis};
use crate::effects::{Kind, Source};
use crate::math::statistics::{bayesian_information, sum_of_squares};
use std::sync::OnceLock;

/// Sets that are fitted in all their parameters, at each number of effects.
const FITS: usize = 12;
/// Sets whose score is this many times that of the best are not fitted.
const SCORE_RATIO: f64 = 3.0;
/// Sets that are fitted even where time is up.
const LEAST: usize = 2;
/// Evidence that an effect must bring.
const EVIDENCE: f64 = 15.0;
/// Bounds of the gain of a channel: narrower than where shapes of motion tell it, since energies alone follow any factor.
const GAINS: [f64; 2] = [0.5, 2.0];

/// Squared residual and scales of one column or two with non-negative scales; none if a scale is not positive.
fn solve(columns: &[&Column], e: &[f64]) -> Option<(f64, Vec<f64>)> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let total = dot(e, e);
    match columns {
        [a] => {
            let s = dot(&a.weighted, e) / dot(&a.weighted, &a.weighted);
            (s > 0.0).then(|| (total - s * dot(&a.weighted, e), vec![s]))
        }
        [a, b] => {
            let (aa, bb, ab) =
                (dot(&a.weighted, &a.weighted), dot(&b.weighted, &b.weighted), dot(&a.weighted, &b.weighted));
            let (ae, be) = (dot(&a.weighted, e), dot(&b.weighted, e));
            let determinant = aa * bb - ab * ab;
            if determinant <= 1e-9 * aa * bb {
                return None;
            }
            let (s, t) = ((ae * bb - be * ab) / determinant, (be * aa - ae * ab) / determinant);
            (s > 0.0 && t > 0.0).then(|| (total - s * ae - t * be, vec![s, t]))
        }
        _ => None,
    }
}

/// Where the search with one set of multiples ended.
struct Ended {
    multiples: Multiples,
    /// What no effect leaves, and what the uncertainty costs in evidence.
    without: f64,
    cost: f64,
    /// Fits of each number of effects, best first.
    by_size: Vec<Vec<Fitted>>,
}

impl Ended {
    /// Squared residual of the best set of `size` effects with what its uncertainty costs, and what its parameters cost besides; the
    /// smaller the better.
    fn evidence(&self, size: usize, n: usize) -> Option<(f64, f64)> {
        if size == 0 {
            return Some((self.without + self.cost, 0.0));
        }
        let best = &self.by_size.get(size - 1)?[0];
        Some((best.chi_square + self.cost, criterion(best, n) - best.chi_square))
    }
}

/// Diagnoses a `points` problem.
pub(crate) fn diagnose(problem: &Problem, excluded: &[Source], control: &Control) -> Result<Diagnosis, DiagnosisError> {
    // What laws take out of the measured motion is the same whatever is uncertain.
    let shapes = OnceLock::new();
    let search_with = |k: usize| -> Result<Option<Ended>, DiagnosisError> {
        if k > 0 && control.is_late() {
            return Ok(None);
        }
        let multiples = Multiples::TRIED[k];
        let balance = Balance::new(problem, &[])?.with_uncertainty(multiples);
        let by_size = forward_selection(&balance, &shapes, excluded, control)?;
        Ok(Some(Ended { multiples, without: sum_of_squares(&balance.weighted()), cost: balance.cost(), by_size }))
    };
    let ended = control.map(Multiples::TRIED.len(), search_with).into_iter().collect::<Result<Vec<_>, _>>()?;
    let ended: Vec<Ended> = ended.into_iter().flatten().collect();
    let Some((best, size)) = decided(&ended, Balance::new(problem, &[])?.missing.len()) else {
        return Err(DiagnosisError::NoRuns);
    };
    let by_size = &best.by_size[..size];
    // The noise of the motion counts once it is known how much energy the new sources take.
    let effects: Vec<Source> =
        by_size.last().map(|r| r[0].added.iter().map(|a| a.source.clone()).collect()).unwrap_or_default();
    let balance = Balance::new(problem, &effects)?.with_uncertainty(best.multiples);
    let mut with_noise =
        if effects.is_empty() { Vec::new() } else { forward_selection(&balance, &shapes, excluded, control)? };
    with_noise.truncate(size);
    Ok(conclude(&balance, &with_noise))
}

/// The search and the number of effects that the energies speak for. Every effect must bring its evidence against fewer effects
/// beside any uncertainty, two that need each other twice as much: one that is needed only where the sensors are taken for exact is none.
fn decided(ended: &[Ended], n: usize) -> Option<(&Ended, usize)> {
    let best = |size: usize| {
        let of_search = |search| Some((search, Ended::evidence(search, size, n)?));
        let total = |(_, (left, penalty)): &(&Ended, (f64, f64))| left + penalty;
        ended.iter().filter_map(of_search).min_by(|a, b| total(a).total_cmp(&total(b)))
    };
    let (mut chosen, mut before) = best(0)?;
    let (mut size, mut next) = (0, 1);
    while let Some((search, (left, penalty))) = best(next) {
        let fit = &search.by_size[next - 1][0];
        let scale = (fit.chi_square / (n - fit.parameters).max(1) as f64).max(1.0);
        if (before.0 - left) / scale - (penalty - before.1) >= (next - size) as f64 * EVIDENCE {
            (chosen, before, size) = (search, (left, penalty), next);
        }
        next += 1;
    }
    Some((chosen, size))
}

fn forward_selection(
    balance: &Balance,
    shapes: &OnceLock<Vec<(Source, Vec<f64>)>>,
    excluded: &[Source],
    control: &Control,
) -> Result<Vec<Vec<Fitted>>, DiagnosisError> {
    let allowed = |source: &Source| !excluded.iter().any(|other| other.is_same(source));
    let e = balance.weighted();
    let n = e.len();
    let mut last = (e.iter().map(|x| x * x).sum::<f64>(), 0);
    let shapes = || shapes.get_or_init(|| balance.shapes());
    let mut columns = if agrees(last.0, n, 0) { Vec::new() } else { balance.columns(shapes()) };
    columns.retain(|column| allowed(&column.source));
    let mut by_size: Vec<Vec<Fitted>> = Vec::new();
    let mut asked = 0.0;
    for count in 1..=2 {
        control.check()?;
        if agrees(last.0, n, last.1) || columns.is_empty() {
            break;
        }
        let mut sets = unfitted(&columns, &e, count);
        sets.extend(with_faults(balance, by_size.last(), allowed));
        let fits = ranked(balance, &sets, control);
        let Some(best) = fits.first() else { break };
        let scale = (best.chi_square / (n - best.parameters).max(1) as f64).max(1.0);
        let penalty = (best.parameters as f64 - last.1 as f64) * (n as f64).ln();
        asked += EVIDENCE;
        // One effect alone may leave so much that it says nothing, where two leave no more than noise.
        if (last.0 - best.chi_square) / scale - penalty >= asked {
            (last, asked) = ((best.chi_square, best.parameters), 0.0);
        }
        by_size.push(fits);
    }
    // What brought no evidence is no effect.
    by_size.truncate(by_size.len() - (asked / EVIDENCE) as usize);
    Ok(by_size)
}

/// Score beyond which sets are not fitted where the best has the score `best`: their shapes are those of a grid.
fn score_bound(best: f64) -> f64 {
    SCORE_RATIO * best.abs() + 60.0
}

/// The best sets so far, each with one error of a channel more.
fn with_faults(balance: &Balance, last: Option<&Vec<Fitted>>, allowed: impl Fn(&Source) -> bool) -> Vec<Vec<Source>> {
    let before: Vec<Vec<Source>> = match last {
        None => vec![Vec::new()],
        Some(fits) => fits.iter().take(3).map(|f| f.added.iter().map(|a| a.source.clone()).collect()).collect(),
    };
    let mut sets = Vec::new();
    for set in before {
        let faults = balance.faults().into_iter().filter(&allowed);
        let fresh = faults.filter(|f| !set.iter().any(|s| s.is_same(f)));
        sets.extend(fresh.map(|f| set.iter().cloned().chain(std::iter::once(f)).collect()));
    }
    sets
}

/// The best sets of one column or two, with one shape a law and place.
fn unfitted(columns: &[Column], e: &[f64], count: usize) -> Vec<Vec<Source>> {
    let mut found: Vec<(f64, Vec<usize>, Vec<f64>)> = Vec::new();
    let mut consider = |set: Vec<usize>| {
        let chosen: Vec<&Column> = set.iter().map(|&k| &columns[k]).collect();
        if let Some((chi, scales)) = solve(&chosen, e) {
            let parameters: usize = chosen.iter().map(|c| c.source.parameters.len()).sum();
            found.push((bayesian_information(chi, parameters, e.len()), set, scales));
            if found.len() > 4000 {
                found.sort_by(|a, b| a.0.total_cmp(&b.0));
                found.truncate(400);
            }
        }
    };
    for i in 0..columns.len() {
        if count == 1 {
            consider(vec![i]);
        } else {
            for j in i + 1..columns.len() {
                if !columns[i].source.is_same(&columns[j].source) {
                    consider(vec![i, j]);
                }
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bound = score_bound(found.first().map_or(f64::INFINITY, |best| best.0));
    let mut sets: Vec<Vec<Source>> = Vec::new();
    for (_, set, scales) in found.into_iter().take_while(|(score, ..)| *score < bound) {
        let sources: Vec<Source> = set.iter().zip(&scales).map(|(&k, &s)| grown(&columns[k].source, s)).collect();
        let seen = |other: &Vec<Source>| other.iter().zip(&sources).all(|(a, b)| a.is_same(b));
        if !sets.iter().any(seen) {
            sets.push(sources);
        }
        if sets.len() == FITS {
            break;
        }
    }
    sets
}

fn grown(source: &Source, scale: f64) -> Source {
    let mut source = source.clone();
    source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= scale);
    source
}

fn ranked(balance: &Balance, unfitted: &[Vec<Source>], control: &Control) -> Vec<Fitted> {
    let n = balance.missing.len();
    let exact = balance.cost() == 0.0;
    let bounded = |added: &Added| is_bounded(added) && (exact || !is_ordinary_gain(&added.source));
    let enough = |f: &Fitted| f.parameters < n && f.chi_square.is_finite() && f.added.iter().all(bounded);
    let in_time = |k: usize| (k < LEAST || !control.is_late()).then(|| balance.fit(&unfitted[k]));
    let mut fits: Vec<Fitted> = control.map(unfitted.len(), in_time).into_iter().flatten().filter(enough).collect();
    fits.sort_by(|a, b| criterion(a, n).total_cmp(&criterion(b, n)));
    fits
}

/// Whether an error of a channel is one that channels have: a gain that makes all energy vanish explains anything.
fn is_bounded(added: &Added) -> bool {
    match added.source.effect.kind() {
        Kind::Channel(law) => law.turns_phase() || (GAINS[0]..=GAINS[1]).contains(&added.source.parameters[0]),
        _ => true,
    }
}

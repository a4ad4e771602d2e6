//! The run that would tell two models apart best: frequency and level of the largest expected difference in units of
//! noise, at the exciter and the sensors that are there.

use super::data::ExplainError;
use super::diagnose::NextTest;
use super::predict::SEARCH;
use super::search::Base;
use crate::effects::{Effect, Source, effect::Kind};
use crate::response::harmonic_balance::{Excitation, Response};
use faer::c64;
use std::f64::consts::TAU;

/// Frequencies looked at, and force levels relative to those of the tests.
const FREQUENCIES: usize = 9;
const LEVELS: [f64; 2] = [0.5, 2.0];

/// The test that separates the effects `best` from those of `rival`; none if nothing does.
pub(crate) fn next_test(base: &Base, best: &[Source], rival: &[Source]) -> Result<Option<NextTest>, ExplainError> {
    let data = base.data;
    let omegas = data.runs.iter().map(|r| r.omega);
    let (low, high) = omegas.fold((f64::INFINITY, 0.0_f64), |(l, h), w| (l.min(w), h.max(w)));
    let sizes = data.runs.iter().flat_map(|r| r.forces.iter().map(|f| (f.dof, f.size())));
    let Some((dof, force)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(None) };
    let mut found: Option<(f64, f64, f64)> = None;
    for k in 0..FREQUENCIES {
        let omega = 0.9 * low * (1.1 * high / (0.9 * low)).powf(k as f64 / (FREQUENCIES - 1) as f64);
        for level in LEVELS {
            base.control.check()?;
            let excitation = Excitation::sine(omega, dof, c64::new(level * force, 0.0));
            let respond = |effects: &[Source]| {
                let sources = base.predictor.sources(effects);
                base.predictor.run(0).respond(&sources, &excitation, &SEARCH, None, base.control).ok()
            };
            let (Some(a), Some(b)) = (respond(best), respond(rival)) else { continue };
            let gain = difference(base, &a, &b);
            if found.is_none_or(|(most, _, _)| gain > most) {
                found = Some((gain, omega, level * force));
            }
        }
    }
    let name = |effects: &[Source]| -> String {
        let names: Vec<&str> = effects.iter().map(|e| Effect::title(e.effect)).collect();
        names.join(" and ")
    };
    let channel = rival.iter().chain(best).any(|e| matches!(e.effect.kind(), Kind::Channel(_)));
    Ok(found.filter(|(gain, _, _)| *gain > 0.0 || channel).map(|(gain, omega, force)| NextTest {
        frequency_hz: omega / TAU,
        force_dof: dof,
        force,
        why: format!(
            "{} and {} differ there by {gain:.1} standard deviations of the measured channels",
            name(best),
            name(rival)
        ),
    }))
}

/// Difference of two responses at the sensors of the first run, in units of the noise that its channels had.
fn difference(base: &Base, a: &Response, b: &Response) -> f64 {
    let (run, noise) = (&base.data.runs[0], &base.noise[0]);
    let of = |c: usize| {
        let channel = &run.responses[c];
        let relative = noise.deviation(c, 1) / channel.size().max(f64::MIN_POSITIVE);
        let (x, y) = (a.amplitude(channel.dof, 1), b.amplitude(channel.dof, 1));
        let size = x.norm().max(y.norm());
        if size > 0.0 { ((x - y).norm() / (relative * size)).powi(2) } else { 0.0 }
    };
    run.alive.iter().map(|&c| of(c)).sum::<f64>().sqrt()
}

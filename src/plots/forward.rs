//! The forward model of what was identified, as the result shows it: frequency responses and steady states.

use super::bode::ReceptanceCurve;
use super::hysteresis::{self, HysteresisPlot};
use crate::balance::expansion::Acting;
use crate::balance::{Expander, Measured};
use crate::effects::{Source, State};
use crate::exchange::Project;
use crate::identify::{self, Outcome};
use crate::measurement::Quantity;
use crate::response::dynamic_stiffness::DynamicStiffness;
use crate::structure::modes::Modes;
use faer::c64;

/// The sources of the answer at their values; a law that is not linear stands as the dashpot that takes out as much energy.
pub fn acting(p: &Project, outcome: &Outcome) -> Vec<Source> {
    let source_of = |(k, estimate): (usize, &identify::Estimate)| {
        let source = p.sources.get(estimate.source)?.with_coefficient(estimate.coefficient);
        if source.effect.is_linear() {
            return Some(source);
        }
        let c = outcome.results.equivalent.overall.get(k).copied().unwrap_or(0.0);
        let dashpot = source.unit_dashpot();
        Some(dashpot.with_coefficient(c))
    };
    outcome.sources.iter().enumerate().filter_map(source_of).collect()
}

/// The known sources of a project that are linear in the motion: what a frequency response of the model as it stands has.
pub fn known(p: &Project) -> Vec<Source> {
    let acts = |s: &&Source| s.state == State::Known && s.effect.is_linear();
    p.sources.iter().filter(acts).cloned().collect()
}

/// Frequencies for a model with its known sources alone, as [`frequencies`].
pub fn frequencies_of_modes(p: &Project) -> Vec<f64> {
    let Ok(modes) = p.structure.modes() else { return spread(p, std::iter::empty()) };
    let stiffness = DynamicStiffness::new(&p.structure, &known(p)).ok();
    let damped = |r: usize| {
        let ratio = stiffness.as_ref().map(|z| damping_ratio(&modes, r, z));
        (modes.omega[r], ratio.filter(|ratio| *ratio > 0.0 && ratio.is_finite()).unwrap_or(0.01))
    };
    spread(p, (0..modes.len()).map(damped))
}

/// Damping ratio of a mode from its undamped shape, `Im (phi^T Z phi) / (2 omega^2)` of the mass-normalised `phi`: near enough for
/// where a curve is to be drawn.
fn damping_ratio(modes: &Modes, r: usize, stiffness: &DynamicStiffness<'_>) -> f64 {
    let (omega, shape) = (modes.omega[r], modes.shapes.col(r));
    let z = stiffness.matrix(omega);
    let along: f64 =
        (0..shape.nrows()).map(|j| shape[j] * (0..shape.nrows()).map(|i| shape[i] * z[(i, j)].im).sum::<f64>()).sum();
    along / (2.0 * omega * omega)
}

/// Frequencies from a little below the lowest run to a little above the highest, closer together near the modes.
pub fn frequencies(p: &Project, outcome: &Outcome) -> Vec<f64> {
    let modes = outcome.results.modes.iter();
    spread(p, modes.map(|m| (std::f64::consts::TAU * m.frequency_hz, m.damping_ratio)))
}

/// Over the range of the runs, closer together near modes of a circular frequency and a damping ratio.
fn spread(p: &Project, modes: impl Iterator<Item = (f64, f64)>) -> Vec<f64> {
    let runs = || p.runs.iter().map(|r| r.fit.omega);
    let low = 0.5 * runs().fold(f64::INFINITY, f64::min);
    let high = 1.6 * runs().fold(0.0, f64::max);
    let mut omega: Vec<f64> = (0..=400).map(|k| low * (high / low).powf(f64::from(k) / 400.0)).collect();
    for (centre, ratio) in modes {
        let width = (ratio * centre).max(1e-5 * centre);
        omega.extend(half_widths().into_iter().flat_map(|x| [centre - width * x, centre + width * x]));
    }
    omega.retain(|w| (low..=high).contains(w));
    omega.sort_by(f64::total_cmp);
    omega.dedup();
    omega
}

/// Distances from a resonance in half-power half-widths at which its circle is drawn: a receptance near it goes round by
/// twice the arctangent of the distance, so that the tangents of equal steps are equal arcs; far off they grow in ratio.
fn half_widths() -> Vec<f64> {
    const ARC: f64 = 1.8;
    let near = (0..=48).map(|k| (ARC * f64::from(k)).to_radians().tan());
    let far = (1..=12).map(|k| (48.0 * ARC).to_radians().tan() * 1.3_f64.powi(k));
    near.chain(far).collect()
}

/// The receptance between two DOFs at `omega` (rad/s).
///
/// # Errors
/// One line: an undamped resonance, or cancelled.
pub fn receptance(
    structure: &crate::structure::Structure,
    sources: &[Source],
    omega: Vec<f64>,
    [response, excitation]: [usize; 2],
    control: &crate::control::Control,
) -> Result<ReceptanceCurve, String> {
    let stiffness = DynamicStiffness::new(structure, sources).map_err(|e| e.to_string())?;
    let quantity = crate::response::frequency_response::ResponseForm::Receptance;
    let values =
        crate::response::frequency_response::direct(&stiffness, response, excitation, &omega, quantity, control)
            .map_err(|e| e.to_string())?;
    Ok(ReceptanceCurve { response, excitation, omega, receptance: values })
}

/// The motion of every DOF in every run at its fundamental, m or rad, expanded with the damping that was identified.
///
/// # Errors
/// One line: the structure has no modes.
pub fn motions(p: &Project, outcome: Option<&Outcome>) -> Result<Vec<Vec<c64>>, String> {
    let measured: Vec<Option<Measured>> = p.runs.iter().map(|run| Measured::new(run).ok()).collect();
    let usable: Vec<Measured> = measured.iter().flatten().cloned().collect();
    let expander = Expander::new(&p.structure, p.settings.expansion, &usable).map_err(|e| e.to_string())?;
    let damping = outcome.map_or_else(Vec::new, |outcome| acting(p, outcome));
    let motion_of = |measured: &Measured| {
        let acting = Acting { sources: &damping, motion: None, model_error: outcome.map_or(1.0, |o| o.model_error) };
        let expanded = expander.expand(measured, acting).ok()?;
        Some((0..p.structure.len()).map(|d| expanded.x[(d, 0)]).collect())
    };
    Ok(measured.iter().map(|run| run.as_ref().and_then(motion_of).unwrap_or_default()).collect())
}

/// Loops at the model's steady state under the measured force's fundamental.
///
/// # Errors
/// One line: no matrices, or an undamped resonance.
pub fn run_loops(p: &Project, outcome: &Outcome, run: usize) -> Result<Vec<HysteresisPlot>, String> {
    let r = p.runs.get(run).ok_or("there is no such run")?;
    let stiffness = DynamicStiffness::new(&p.structure, &acting(p, outcome)).map_err(|e| e.to_string())?;
    let mut force = vec![c64::new(0.0, 0.0); p.structure.len()];
    for channel in r.fit.channels.iter().filter(|c| c.channel.quantity == Quantity::Force) {
        force[channel.channel.dof] += channel.amplitudes.first().copied().unwrap_or_default();
    }
    let x = stiffness.solve(r.fit.omega, &force).map_err(|e| e.to_string())?;
    let sources: Vec<Source> =
        outcome.sources.iter().filter_map(|e| Some(p.sources.get(e.source)?.with_coefficient(e.coefficient))).collect();
    Ok(hysteresis::loops(p, run, &x, &sources))
}

#[cfg(test)]
mod tests {
    use super::half_widths;
    use faer::c64;

    /// Of one mass, `H = 1 / (1 + i x)` near resonance: a circle whose points lie close together all round.
    #[test]
    fn a_circle_is_drawn_in_steps_of_a_few_degrees() {
        let on_circle = |x: f64| c64::new(1.0, 0.0) / c64::new(1.0, x);
        let around: Vec<c64> = half_widths().into_iter().map(on_circle).collect();
        let centre = c64::new(0.5, 0.0);
        let turn = |z: c64| (z - centre).im.atan2((z - centre).re);
        for pair in around.windows(2) {
            let step = (turn(pair[0]) - turn(pair[1])).rem_euclid(std::f64::consts::TAU).to_degrees();
            assert!(step < 3.7, "a step of {step} degrees");
        }
        assert!(around.last().is_some_and(|z| z.norm() < 0.01), "the circle closes");
    }
}

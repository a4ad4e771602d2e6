//! All methods on one set of runs of the five masses: sweeps under five exciters, noise-free.

use super::support::*;
use dashpot::classical::FrequencyResponses;
use dashpot::classical::measured_ratios::{circle_ratios, half_power_ratios};
use dashpot::classical::method::Method;
use dashpot::classical::side_by_side::{Applied, SideBySide, side_by_side};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::measurement::{
    Channel, ChannelFit, HarmonicFit, MeasuredRatio, Quantity, Run, WholeFunction, WholeFunctions,
};
use dashpot::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;
use std::sync::Arc;

fn channel(structure: &Structure, quantity: Quantity, dof: usize, amplitude: c64) -> ChannelFit {
    ChannelFit {
        channel: Channel { quantity, dof, label: structure.label(dof).to_string() },
        offset: 0.0,
        slope: 0.0,
        amplitudes: vec![amplitude],
        covariance: Mat::zeros(2, 2),
        noise: 0.0,
    }
}

/// Grounded dashpots and two between masses, fit for a pattern of candidates.
const DASHPOTS: [(&[usize], f64); 7] =
    [(&[0], 9.0), (&[1], 9.0), (&[2], 9.0), (&[3], 9.0), (&[4], 9.0), (&[1, 2], 15.0), (&[3, 4], 4.0)];

fn sources() -> Vec<Source> {
    let place = |dofs: &[usize]| Place::Dofs(dofs.to_vec());
    let truth = DASHPOTS
        .iter()
        .map(|&(dofs, c)| Source { state: State::Reference, ..Source::known(Effect::Viscous, place(dofs), &[c]) });
    let candidates = (0..5).map(|i| vec![i]).chain((0..4).map(|i| vec![i, i + 1]));
    truth.chain(candidates.map(|dofs| Source::candidate(Effect::Viscous, Place::Dofs(dofs)))).collect()
}

fn truth() -> Mat<f64> {
    let mut c = Mat::zeros(5, 5);
    for (dofs, value) in DASHPOTS {
        c[(dofs[0], dofs[0])] += value;
        if let [i, j] = *dofs {
            c[(j, j)] += value;
            c[(i, j)] -= value;
            c[(j, i)] -= value;
        }
    }
    c
}

/// Thirty lines across each resonance, eight in each gap, every drive.
fn sweep(structure: &Structure) -> Vec<Run> {
    let around = [21.876, 32.130, 42.481, 52.443, 64.361];
    let mut hz: Vec<f64> =
        around.iter().flat_map(|f| (0..60).map(move |k| f * (0.955 + 0.0015 * f64::from(k)))).collect();
    hz.extend(
        around
            .windows(2)
            .flat_map(|w| (1..8).map(move |k| w[0] * 1.045 + (w[1] * 0.955 - w[0] * 1.045) * f64::from(k) / 8.0)),
    );
    hz.sort_by(f64::total_cmp);
    let h = receptance(structure, &truth(), &Mat::zeros(5, 5), &hz);
    let mut runs = Vec::new();
    for drive in 0..5 {
        for (k, f) in hz.iter().enumerate() {
            let mut channels = vec![channel(structure, Quantity::Force, drive, c64::new(2.0, 0.5))];
            channels.extend((0..5).map(|dof| {
                let x = h.matrices[k][(dof, drive)] * c64::new(2.0, 0.5);
                channel(structure, Quantity::Displacement, dof, x)
            }));
            runs.push(Run {
                file: format!("{drive} {k}"),
                level: None,
                session: None,
                insisted: false,
                enabled: true,
                record: None,
                fit: HarmonicFit { omega: TAU * f, omega_deviation: 0.0, channels },
                noise_ratio: 0.0,
                findings: vec![],
                per_unit_force: false,
                functions: None,
                on_moving_base: false,
            });
        }
    }
    runs
}

fn of(found: &SideBySide, method: Method) -> Result<&Applied, &String> {
    found.entries.iter().find(|entry| entry.method == method).unwrap().outcome.as_ref()
}

/// Every method but those that look at one mode at a time or neglect terms by design is exact; the others err as they must.
#[test]
fn complete_data_without_noise() {
    let structure = five_masses();
    let found = side_by_side(&structure, &sources(), &sweep(&structure), &[], &Control::unattended()).unwrap();
    assert_eq!(found.modes_from, "5 modes by the poly-reference estimator");
    let exact = found.reference_ratios.clone();
    let modal = found.modal.as_ref().unwrap();
    for (p, known) in exact.iter().enumerate() {
        let off = modal.damping_ratio(p) / known.ratio - 1.0;
        assert!(off.abs() < 1e-6, "mode {}: {off:.1e}", p + 1);
    }
    // In per cent: of the matrix, and of the ratios.
    let allowed = |method: Method| match method {
        // Only one reason: a free decay, two levels.
        Method::LogDecrement | Method::EnergySingle => None,
        // Other modes are constant over the lines; a viscous peak; one mode a run, beside the resonance.
        Method::HalfPower | Method::CircleFit | Method::HysteresisLoop => Some((f64::NAN, 10.0)),
        // Terms of second order in C.
        Method::AdhikariWoodhouse | Method::AdhikariWoodhouseSymmetric => Some((3.0, 1.0)),
        // The first term of a series.
        Method::PhaniWoodhouse => Some((25.0, 1.0)),
        _ => Some((1e-4, 1e-4)),
    };
    for method in Method::ALL {
        match (allowed(method), of(&found, method)) {
            (None, Err(_)) => {}
            (Some((matrix, ratios)), Ok(applied)) => {
                if let Some(errors) = applied.errors {
                    assert!(errors.eps_c < matrix, "{method:?}: eps_C {:.2e} %", errors.eps_c);
                }
                for ratio in &applied.ratios {
                    let off = 100.0 * (ratio.ratio / exact[ratio.mode].ratio - 1.0).abs();
                    assert!(off < ratios, "{method:?}, mode {}: {off:.2e} %", ratio.mode + 1);
                }
            }
            (expected, outcome) => panic!("{method:?}: {expected:?} {outcome:?}"),
        }
    }
    for (mode, spread) in &found.spread {
        assert!(*spread < 1e-4, "mode {}: {spread:.1e}", mode + 1);
    }
}

/// A method that looks past what it needs says so in one line.
#[test]
fn reasons_are_one_line_each() {
    let structure = five_masses();
    let runs: Vec<Run> = sweep(&structure).into_iter().take(3).collect();
    let found = side_by_side(&structure, &sources(), &runs, &[], &Control::unattended()).unwrap();
    let reasons: Vec<String> = found.entries.iter().filter_map(|e| e.outcome.clone().err()).collect();
    assert!(reasons.len() > 15, "{reasons:?}");
    for reason in reasons {
        assert!(reason.lines().count() == 1 && reason.len() < 160, "{reason}");
    }
    assert!(found.modal.is_none() && found.spread.is_empty());
}

/// Ratios for use beside the energies: near the truth by what they say of themselves.
#[test]
fn measured_ratios_know_their_deviation() {
    let structure = five_masses();
    let (runs, model) = (sweep(&structure), structure.modes().unwrap());
    let responses = FrequencyResponses::from_runs(&runs).unwrap();
    let exact = modal(&structure, &truth(), 5);
    let found: [Vec<MeasuredRatio>; 2] =
        [half_power_ratios(&model, &responses, &[]), circle_ratios(&model, &responses, &[])];
    for ratios in found {
        assert_eq!(ratios.len(), 5);
        for (p, r) in ratios.iter().enumerate() {
            let known = exact.damping_ratio(p);
            let off = (r.ratio - known).abs();
            assert!(off < 3.0 * r.deviation + 1e-3 * known, "mode {}: {r:?} {known}", p + 1);
            assert!(r.deviation < 0.2 * known, "mode {}: {r:?} {known}", p + 1);
        }
    }
}

/// Of frequency responses all lines count, not only those few that are runs: one line under one force does not fix nine dashpots.
#[test]
fn liang_works_on_whole_responses() {
    let structure = five_masses();
    let all = FrequencyResponses::from_runs(&sweep(&structure)).unwrap();
    let pairs = (0..5).flat_map(|j| (0..5).map(move |i| (i, j)));
    let function = |(response, reference)| WholeFunction {
        response,
        reference,
        receptance: all.series(response, reference),
        deviation: vec![1e-12; all.omega.len()],
    };
    let whole = Arc::new(WholeFunctions { omega: all.omega.clone(), functions: pairs.map(function).collect() });
    let liang = |functions: Option<Arc<WholeFunctions>>| {
        let line = Run { functions, ..sweep(&structure).swap_remove(40) };
        let found = side_by_side(&structure, &sources(), &[line], &[], &Control::unattended()).unwrap();
        of(&found, Method::Liang).unwrap().clone()
    };
    assert!(liang(None).errors.unwrap().eps_c > 1.0);
    let found = liang(Some(whole));
    assert!(found.errors.unwrap().eps_c < 1e-4, "{:?}", found.errors);
    assert!(found.damping.unwrap().notes.is_empty());
}

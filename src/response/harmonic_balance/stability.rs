//! Stability of a periodic response by Floquet's multipliers.
//!
//! A small disturbance `y` obeys `M y'' + C y' + K y + sum_l L_l (k_l(t) L_l^T y + c_l(t) L_l^T y') = 0` with the slopes
//! of the laws along the period. Its map over one period is stepped exactly in the linear rest, implicit in the slopes;
//! the multipliers are its eigenvalues, and the response is stable when none is above 1 in magnitude. Laws that are
//! defined harmonic by harmonic enter with their stiffness and damping at the fundamental. Where friction sticks, it
//! holds the disturbance by a stiff damping. The cost grows with the cube of the degrees of freedom.

use super::excitation::Excitation;
use super::fourier::{Fourier, differentiate};
use super::law_evaluation::sampled;
use super::linear_leg::stiffness_of;
use super::model::RunModel;
use super::nonlinear_leg::NonlinearLeg;
use super::outcome::Response;
use super::prepared::Prepared;
use crate::effects::{Constant, Leg, Manner, Source};
use crate::response::time_integration::propagator::Propagator;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Slack for rounding in the largest multiplier.
const MARGIN: f64 = 1e-6;

/// Floquet's multipliers of `response` of `run` with `sources`; `None` where the mass is not positive definite.
pub fn multipliers(
    run: &RunModel,
    sources: &[Source],
    excitation: &Excitation,
    response: &Response,
) -> Option<Vec<c64>> {
    let run = run.fitting(sources);
    let prepared = Prepared::new(&run, sources, excitation, response.order()).ok()?;
    let condensed = &prepared.condensed;
    if condensed.legs.len() != response.legs {
        return None;
    }
    let mut motion = condensed.motion_of(|h| run.compliance(h), &response.displacements());
    let width = condensed.width();
    for (i, leg) in condensed.legs.iter().enumerate() {
        let part = motion.iter_mut().zip(&response.unknowns).skip(i * width).take(width);
        part.for_each(|(d, f)| *d -= leg.flexibility * f);
    }
    let slopes: Vec<Vec<[f64; 2]>> = (condensed.legs.iter().enumerate())
        .map(|(i, leg)| {
            let range = i * width..(i + 1) * width;
            slopes(leg, &prepared.fourier, excitation.omega, &response.unknowns[range.clone()], &motion[range])
        })
        .collect();
    let legs: Vec<Leg> = condensed.legs.iter().map(|l| l.leg).collect();
    let step = TAU / excitation.omega / prepared.fourier.samples() as f64;
    let propagator = propagator(&run, sources, excitation.omega, &legs, step)?;
    let map = period_map(&propagator, &legs, &slopes, step)?;
    dashpot_numerics::eigenvalues(map.as_ref())
}

/// Whether small disturbances of `response` die out.
pub fn is_stable(run: &RunModel, sources: &[Source], excitation: &Excitation, response: &Response) -> bool {
    let all = multipliers(run, sources, excitation, response);
    all.is_some_and(|all| all.iter().all(|m| m.norm() <= 1.0 + MARGIN))
}

/// Stiffness and damping of a leg's law at every sample.
fn slopes(leg: &NonlinearLeg, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> Vec<[f64; 2]> {
    if leg.manner() != Manner::Memory {
        return leg.slopes(fourier, omega, force, motion);
    }
    // The response shifted in time is a response: the force's rate is its derivative along the motion's rate.
    let mut rate = vec![0.0; motion.len()];
    differentiate(omega, motion, &mut rate);
    let (along, direction) = (sampled(fourier, omega, motion), sampled(fourier, omega, &rate));
    let mut tangent = vec![0.0; fourier.samples()];
    leg.law.tangent(&leg.parameters, &along, &direction, &mut tangent);
    let slope = |(t, v): (&f64, &f64)| if *v == 0.0 { [0.0; 2] } else { [(t / v).max(0.0), 0.0] };
    tangent.iter().zip(&direction.displacement).map(slope).collect()
}

/// The linear rest over one step, each law with its stiffness and damping at the fundamental.
fn propagator(run: &RunModel, sources: &[Source], omega: f64, legs: &[Leg], step: f64) -> Option<Propagator> {
    let n = run.len();
    let mut mass = run.linear().structure().matrices()?.mass.clone();
    let mut z = run.linear().dynamic_stiffness(omega);
    for source in sources {
        let value = stiffness_of(source, omega);
        for leg in source.place.legs() {
            spread(leg, |i, j, sign| z[(i, j)] += value * sign);
            if source.effect.adds_to(Constant::Mass) {
                spread(leg, |i, j, sign| mass[(i, j)] += source.parameters[0] * sign);
            }
        }
    }
    let stiffness = Mat::from_fn(n, n, |i, j| z[(i, j)].re + omega * omega * mass[(i, j)]);
    let damping = Mat::from_fn(n, n, |i, j| z[(i, j)].im / omega);
    let mut patterns = Mat::zeros(n, legs.len());
    for (j, leg) in legs.iter().enumerate() {
        patterns[(leg.first, j)] = 1.0;
        if let Some(second) = leg.second {
            patterns[(second, j)] = -1.0;
        }
    }
    Propagator::new(&mass, &damping, &stiffness, &patterns, step)
}

/// The entries of `L L^T`.
fn spread(leg: Leg, mut add: impl FnMut(usize, usize, f64)) {
    add(leg.first, leg.first, 1.0);
    if let Some(second) = leg.second {
        add(second, second, 1.0);
        add(leg.first, second, -1.0);
        add(second, leg.first, -1.0);
    }
}

/// Map of a disturbance over one period, 2n x 2n.
fn period_map(propagator: &Propagator, legs: &[Leg], slopes: &[Vec<[f64; 2]>], step: f64) -> Option<Mat<f64>> {
    let size = 2 * propagator.size;
    let count = legs.len();
    let samples = slopes.first().map_or(1, Vec::len);
    let relative = |leg: Leg, y: &[f64]| leg.relative(|i| y[i]) / propagator.scale;
    let receptance: Vec<f64> = (legs.iter())
        .flat_map(|leg| (0..count).map(move |j| leg.relative(|i| propagator.displacement(i, j))))
        .collect();
    let mut columns: Vec<Vec<f64>> =
        (0..size).map(|k| (0..size).map(|i| f64::from(u8::from(i == k))).collect()).collect();
    let mut next = vec![0.0; size];
    for n in 0..samples {
        // f = k (d_0 + x/2) + c x/h with x = x_free - W f: (1 + (k/2 + c/h) W) f = k d_0 + (k/2 + c/h) x_free.
        let gain = |i: usize| 0.5 * slopes[i][n][0] + slopes[i][n][1] / step;
        let system: Vec<f64> = (0..count * count)
            .map(|m| gain(m / count) * receptance[m] + f64::from(u8::from(m / count == m % count)))
            .collect();
        let lu = super::dense::Lu::new(count, system)?;
        for y in &mut columns {
            propagator.advance(y, &mut next);
            let mut forces: Vec<f64> = (0..count)
                .map(|i| {
                    let before = relative(legs[i], y);
                    slopes[i][n][0] * before + gain(i) * (relative(legs[i], &next) - before)
                })
                .collect();
            lu.solve(&mut forces);
            for (i, f) in forces.iter().enumerate() {
                propagator.push(i, -f, &mut next);
            }
            y.copy_from_slice(&next);
        }
    }
    Some(Mat::from_fn(size, size, |i, j| columns[j][i]))
}

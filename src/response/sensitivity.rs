//! Derivatives of a periodic response by parameters, by implicit differentiation of the converged balance.
//!
//! ```text
//! Z_h X_h + L F_h = F_ext,h,     F = Phi(F, D, p),     D_h = L^T X_h
//!
//! dX_lin,h = -A_h (dZ_h X_h),     J dF = Phi_p + Phi_D L^T dX_lin,     dX_h = dX_lin,h - A_h L dF_h
//! ```
//!
//! with `A_h` the receptance of the linear rest and `J = 1 - Phi_F + Phi_D C` the Jacobian of the balance, factorised once.
//! `A_h` is symmetric, so that its rows at the legs and at the DOFs asked for serve all unknowns (`observation`).
//! Where the response is extrapolated from two numbers of harmonics, so are its derivatives.

use super::harmonic_balance::{
    Balance, Excitation, LinearPart, Lu, Prepared, Response, ResponseError, RunModel, richardson,
};
use super::observation::{Observation, observations};
use crate::effects::{Kind, Source};
use crate::structure::Part;
use crate::structure::share::Share;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// What a response is differentiated by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// Parameter `parameter` of source `source` in the list of sources (linear, nonlinear or of the whole structure).
    Source {
        /// Index of the source.
        source: usize,
        /// Index of the parameter.
        parameter: usize,
    },
    /// Relative change of the stiffness matrix (of Young's modulus), by 1.
    Stiffness,
    /// Relative change of the mass matrix, lumped masses included, by 1.
    Mass,
    /// Relative change of the stiffness of one undamped mode by 1: `dK = omega_r^2 (M phi_r)(M phi_r)^T`.
    ModeStiffness(usize),
    /// Coupling of two undamped modes by stiffness: `dK = omega_r omega_s ((M phi_r)(M phi_s)^T + (M phi_s)(M phi_r)^T)`.
    ModeCoupling([usize; 2]),
    /// Relative change by 1 of the damping that laws of the whole structure give an undamped mode.
    ModeDamping(usize),
    /// Relative change by 1 of that an octave above the natural frequency, by a power of frequency.
    ModeDampingPerOctave(usize),
    /// Relative change by 1 of a part of the structure that has a share of its own in the matrices.
    Part(Part),
    /// Relative change by 1 of force number `.0` of the excitation at all its harmonics.
    ForceScale(usize),
}

/// Why derivatives cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SensitivityError {
    /// The unknown does not exist.
    #[error(
        "{unknown:?} is not in this model: it has {sources} sources, {forces} forces and {size} degrees of freedom"
    )]
    NoSuchUnknown {
        /// What was asked for.
        unknown: Unknown,
        /// Number of sources.
        sources: usize,
        /// Number of forces.
        forces: usize,
        /// Degrees of freedom.
        size: usize,
    },
    /// At a turning point the response is not differentiable.
    #[error(
        "the response at {frequency_hz:.6} Hz is at a turning point, where it has no derivatives: move the frequency or the force a little"
    )]
    TurningPoint {
        /// Fundamental frequency, Hz.
        frequency_hz: f64,
    },
    /// The response belongs to other sources.
    #[error("the response was computed with other sources: compute it anew with these")]
    OtherSources,
    /// The model itself.
    #[error(transparent)]
    Response(#[from] ResponseError),
}

/// Derivatives of the displacement amplitudes of `dofs`: for each unknown a matrix of one row a DOF and H columns (column
/// `h - 1` is harmonic `h`), m per unit of the unknown.
///
/// `response` is that of `run` with `sources` to `excitation`.
///
/// # Errors
/// [`SensitivityError`]: an unknown that is not in the model, a turning point, a response with other sources.
pub fn sensitivities(
    run: &RunModel,
    sources: &[Source],
    excitation: &Excitation,
    response: &Response,
    dofs: &[usize],
    unknowns: &[Unknown],
) -> Result<Vec<Mat<c64>>, SensitivityError> {
    for unknown in unknowns {
        check(*unknown, sources, run.len(), excitation.forces.len())?;
    }
    let run = run.fitting(sources);
    let derivatives_at = |u: &[f64], order: usize| at_order(&run, sources, excitation, u, order, dofs, unknowns);
    let mut fine = derivatives_at(&response.unknowns, response.order())?;
    if let Some((order, coarse)) = &response.coarse {
        let order = *order;
        let below = derivatives_at(coarse, order)?;
        let weight = richardson(order, response.order());
        for (fine, below) in fine.iter_mut().zip(&below) {
            for h in 0..order {
                for i in 0..fine.nrows() {
                    let correction = (fine[(i, h)] - below[(i, h)]) * weight;
                    fine[(i, h)] += correction;
                }
            }
        }
    }
    Ok(fine)
}

fn check(unknown: Unknown, sources: &[Source], size: usize, forces: usize) -> Result<(), SensitivityError> {
    let exists = match unknown {
        Unknown::Source { source, parameter } => {
            sources.get(source).is_some_and(|s| parameter < s.effect.parameters().len())
        }
        Unknown::Stiffness | Unknown::Mass | Unknown::Part(_) => true,
        Unknown::ForceScale(force) => force < forces,
        Unknown::ModeCoupling(pair) => pair.iter().all(|row| *row < size),
        Unknown::ModeStiffness(row) | Unknown::ModeDamping(row) | Unknown::ModeDampingPerOctave(row) => row < size,
    };
    let missing = SensitivityError::NoSuchUnknown { unknown, sources: sources.len(), forces, size };
    if exists { Ok(()) } else { Err(missing) }
}

/// The converged balance at one number of harmonics, differentiated.
struct Differentiated<'a> {
    run: &'a RunModel,
    sources: &'a [Source],
    excitation: &'a Excitation,
    prepared: &'a Prepared,
    balance: Balance<'a>,
    u: &'a [f64],
    motion: Vec<f64>,
    /// Displacements per harmonic, 0 first.
    displacements: Vec<Vec<c64>>,
}

/// The derivatives at the unknowns `u` of the balance with harmonics up to `order`.
fn at_order(
    run: &RunModel,
    sources: &[Source],
    excitation: &Excitation,
    u: &[f64],
    order: usize,
    dofs: &[usize],
    unknowns: &[Unknown],
) -> Result<Vec<Mat<c64>>, SensitivityError> {
    let prepared = Prepared::new(run, sources, excitation, order)?;
    if prepared.condensed.size() != u.len() {
        return Err(SensitivityError::OtherSources);
    }
    let balance = prepared.balance();
    let state = balance.state(u, 1.0);
    let turning = || SensitivityError::TurningPoint { frequency_hz: excitation.omega / TAU };
    let lu = Lu::new(u.len(), balance.jacobian(&state.evaluations)).ok_or_else(turning)?;
    let motion = prepared.condensed.motion(u, 1.0);
    let displacements = prepared.displacements(run, excitation, u);
    let observed = observations(&prepared.condensed, run, dofs);
    let at = Differentiated { run, sources, excitation, prepared: &prepared, balance, u, motion, displacements };
    let sensitivity_of = |&unknown: &Unknown| {
        let loads = at.loads(unknown);
        let mut motion = at.linear_motion(&observed, &loads);
        at.add_softening(unknown, &mut motion);
        let mut change = at.balance.force_change(&state.evaluations, &motion);
        at.add_parameter(unknown, &mut change);
        lu.solve(&mut change);
        let forces = |h: usize, j: usize| at.prepared.condensed.get(&change, h, j);
        Mat::from_fn(dofs.len(), order, |i, h| observed[h + 1].displacement(i, &loads[h + 1], |j| forces(h + 1, j)))
    };
    Ok(unknowns.iter().map(sensitivity_of).collect())
}

impl Differentiated<'_> {
    fn omega(&self, h: usize) -> f64 {
        h as f64 * self.prepared.condensed.omega
    }

    /// Pseudo-forces `-dZ_h X_h` at all DOFs per harmonic; empty where there is none.
    fn loads(&self, unknown: Unknown) -> Vec<Vec<c64>> {
        let linear = self.run.linear();
        let share = if let Unknown::Part(part) = unknown { linear.structure().share(part) } else { None };
        let load = |h: usize| -> Vec<c64> {
            let (x, w) = (&self.displacements[h], self.omega(h));
            if !matches!(unknown, Unknown::ForceScale(_)) && x.iter().all(|x| x.norm_sqr() == 0.0) {
                return Vec::new();
            }
            match (unknown, &share) {
                (Unknown::ForceScale(force), _) => {
                    let force = &self.excitation.forces[force];
                    single(x.len(), force.dof, force.amplitude(h))
                }
                (_, Some(share)) => share_force(linear, share, x, w),
                _ => pseudo_force(self.run, self.sources, unknown, x, w).unwrap_or_default(),
            }
        };
        (0..self.displacements.len()).map(load).collect()
    }

    /// Motion of what is kept, in the order of the unknowns, of the linear rest under the pseudo-forces.
    fn linear_motion(&self, observed: &[Observation], loads: &[Vec<c64>]) -> Vec<f64> {
        let mut motion = vec![0.0; self.prepared.condensed.size()];
        for (h, (observed, load)) in observed.iter().zip(loads).enumerate() {
            for (j, value) in observed.motions(load).enumerate() {
                self.prepared.condensed.add(&mut motion, h, j, value);
            }
        }
        motion
    }

    /// Adds what a slider moves on when the spring `k` before it gets stiffer: `F / k^2`.
    fn add_softening(&self, unknown: Unknown, motion: &mut [f64]) {
        let Unknown::Source { source, parameter: 0 } = unknown else { return };
        let (legs, width) = (&self.prepared.condensed.legs, self.prepared.condensed.width());
        for (i, leg) in legs.iter().enumerate().filter(|(_, leg)| leg.source == source) {
            let part = motion.iter_mut().zip(self.u).skip(i * width).take(width);
            part.for_each(|(m, f)| *m += f * leg.flexibility * leg.flexibility);
        }
    }

    /// Adds `Phi_p` of the legs that belong to the unknown.
    fn add_parameter(&self, unknown: Unknown, change: &mut [f64]) {
        let Unknown::Source { source, parameter } = unknown else { return };
        let (condensed, width) = (&self.prepared.condensed, self.prepared.condensed.width());
        for (i, leg) in condensed.legs.iter().enumerate().filter(|(_, leg)| leg.source == source) {
            let range = i * width..(i + 1) * width;
            let (force, motion) = (&self.u[range.clone()], &self.motion[range.clone()]);
            let direct = leg.by_parameter(&self.prepared.fourier, condensed.omega, parameter, force, motion);
            change[range].iter_mut().zip(direct).for_each(|(c, d)| *c += d);
        }
    }
}

/// Pseudo-force `-dZ x` (N per unit of `unknown`) of the motion `x` (m, by DOF) at circular frequency `w` (rad/s); `None`
/// where it is not that of a linear part of the model.
pub(crate) fn pseudo_force(
    run: &RunModel,
    sources: &[Source],
    unknown: Unknown,
    x: &[c64],
    w: f64,
) -> Option<Vec<c64>> {
    let linear = run.linear();
    let zero = c64::new(0.0, 0.0);
    match unknown {
        Unknown::Stiffness | Unknown::Mass => {
            let (of_mass, [fk, fm]) = (unknown == Unknown::Mass, linear.factors(w));
            let mut load =
                if of_mass { linear.apply_matrices(zero, -fm, x) } else { linear.apply_matrices(-fk, zero, x) };
            let damping = linear.apply_damping_of_modes(w, of_mass, c64::new(-1.0, 0.0), x);
            load.iter_mut().zip(damping).for_each(|(l, d)| *l += d);
            Some(load)
        }
        Unknown::ModeDamping(mode) => linear.apply_mode_damping(mode, w, x),
        Unknown::ModeDampingPerOctave(mode) => linear.apply_mode_damping_per_octave(mode, w, x),
        Unknown::ModeStiffness(mode) => linear.apply_modal_stiffness([mode; 2], x),
        Unknown::ModeCoupling(pair) => linear.apply_modal_stiffness(pair, x),
        Unknown::Part(part) => Some(share_force(linear, &linear.structure().share(part)?, x, w)),
        Unknown::Source { source, parameter } => source_force(linear, &sources[source], parameter, x, w),
        Unknown::ForceScale(_) => None,
    }
}

/// Pseudo-force of a part of the structure with this share in its matrices.
fn share_force(linear: &LinearPart, share: &Share, x: &[c64], w: f64) -> Vec<c64> {
    let [fk, fm] = linear.factors(w);
    let mut load = vec![c64::new(0.0, 0.0); x.len()];
    share.stiffness.iter().for_each(|&(i, j, value)| load[i] -= x[j] * (fk * value));
    share.mass.iter().for_each(|&(i, j, value)| load[i] -= x[j] * (fm * value));
    load
}

/// Pseudo-force of a linear source.
fn source_force(linear: &LinearPart, source: &Source, parameter: usize, x: &[c64], w: f64) -> Option<Vec<c64>> {
    match source.effect.kind() {
        // The force of a whole-structure law is proportional to its only parameter.
        Kind::Whole(law) => Some(linear.apply_whole(source, -law.factor(1.0, w), w, x)),
        Kind::Relative(_) if source.effect.is_linear() => {
            let mut load = vec![c64::new(0.0, 0.0); x.len()];
            for leg in source.place.legs() {
                let force = stiffness_by_parameter(source, parameter, w) * leg.relative(|i| x[i]);
                load[leg.first] -= force;
                if let Some(second) = leg.second {
                    load[second] += force;
                }
            }
            Some(load)
        }
        Kind::Relative(_) | Kind::Channel(_) => None,
    }
}

/// A force at one DOF of `size`.
fn single(size: usize, dof: usize, force: c64) -> Vec<c64> {
    let mut load = vec![c64::new(0.0, 0.0); size];
    load[dof] = force;
    load
}

/// Derivative of the dynamic stiffness of a linear law, N/m per unit of the parameter.
fn stiffness_by_parameter(source: &Source, parameter: usize, omega: f64) -> c64 {
    let law = source.effect.law();
    law.and_then(|law| law.dynamic_stiffness_by(&source.parameters, parameter, omega)).unwrap_or(c64::new(0.0, 0.0))
}

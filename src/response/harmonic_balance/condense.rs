//! Exact condensation of the linear rest to the relative motions of the nonlinear sources, harmonic by harmonic:
//!
//! ```text
//! D_h = D_lin,h - C_h F_h,      C_h = L_N^T Z(h w)^-1 L_N,      D_lin,h = L_N^T Z(h w)^-1 F_ext,h
//! ```
//!
//! Linear sources between single DOFs are eliminated by Woodbury's identity from the receptance `A_h` of the structure:
//! their forces are `g = S (d_l - G_lN F)`, `S = z (1 + G_ll z)^-1`, with `G = L^T A L` and `d = L^T A F_ext`. The legs of
//! modes at resonance (`resonant`) are kept beside the nonlinear ones, each at its one harmonic; so are linear legs where
//! they put the structure at resonance and `1 + z G` is almost singular.
//!
//! Unknowns: `2 H + 1` coefficients of each nonlinear leg, then cosine and sine of each of the others that are kept.

use super::compliance::Compliance;
use super::error::ModelError;
use super::excitation::Excitation;
use super::fourier::{add_amplitude, amplitude};
use super::harmonic_system::{HarmonicSystem, harmonic_system, multiply};
use super::linear_leg::{LinearLeg, push_leg};
use super::nonlinear_leg::NonlinearLeg;
use super::resonant::Pattern;
use crate::effects::{Leg, Source};
use faer::c64;

/// The system seen from its kept legs.
pub(crate) struct Condensed {
    pub omega: f64,
    pub harmonics: usize,
    pub legs: Vec<NonlinearLeg>,
    pub linear_legs: Vec<LinearLeg>,
    /// Harmonics 0..=H.
    pub systems: Vec<HarmonicSystem>,
    /// Modes at resonance and linear legs that are kept, over all harmonics.
    resonances: usize,
    /// Whether every law answers the opposite motion by the opposite force.
    pub mirrored: bool,
    /// Whether laws and forces allow motions whose second half period mirrors the first: odd harmonics alone.
    pub odd: bool,
}

/// Stiffness of the spring of an elastic slider, relative to that of the structure there at the fundamental, from which on
/// it is friction behind a spring: marched through the period it would be stiffer than Newton's method can follow.
const STIFF: f64 = 100.0;

/// Splits sources into linear and nonlinear legs; whole-structure and channel effects are not among them. `compliance` is
/// the receptance of the structure at the fundamental.
pub(crate) fn split(sources: &[Source], compliance: &Compliance) -> (Vec<NonlinearLeg>, Vec<LinearLeg>) {
    let (mut nonlinear, linear) = separated(sources);
    for leg in &mut nonlinear {
        let Some(stiffness) = leg.law.series_stiffness(&leg.parameters) else { continue };
        if stiffness * compliance.between(Pattern::Leg(leg.leg), Pattern::Leg(leg.leg)).norm() > STIFF {
            leg.flexibility = 1.0 / stiffness;
        }
    }
    (nonlinear, linear)
}

fn separated(sources: &[Source]) -> (Vec<NonlinearLeg>, Vec<LinearLeg>) {
    let (mut nonlinear, mut linear) = (Vec::new(), Vec::new());
    for (index, source) in sources.iter().enumerate() {
        let Some(law) = source.effect.law() else { continue };
        for leg in source.place.legs() {
            if law.is_linear() {
                linear.push(LinearLeg { source: index, leg });
            } else {
                let parameters = source.parameters.clone();
                nonlinear.push(NonlinearLeg { source: index, leg, parameters, law, weight: 1.0, flexibility: 0.0 });
            }
        }
    }
    (nonlinear, linear)
}

impl Condensed {
    /// Condenses for harmonics 0..=`harmonics`; `compliance(h)` is the receptance of the structure.
    pub(crate) fn new<'a>(
        compliance: impl Fn(usize) -> &'a Compliance,
        sources: &[Source],
        excitation: &Excitation,
        harmonics: usize,
    ) -> Result<Self, ModelError> {
        let (mut legs, linear_legs) = split(sources, compliance(1));
        let mut systems: Vec<HarmonicSystem> = Vec::with_capacity(harmonics + 1);
        let mut resonances = 0;
        for h in 0..=harmonics {
            let mut system = harmonic_system(compliance(h), sources, &legs, &linear_legs, excitation, h)?;
            system.resonant_before = resonances;
            resonances += system.resonant.len();
            systems.push(system);
        }
        for (i, leg) in legs.iter_mut().enumerate() {
            leg.weight = velocity_weight(&systems, excitation.omega, i);
        }
        let mirrored = legs.iter().all(NonlinearLeg::is_odd);
        let odd = mirrored && excitation.is_odd();
        Ok(Self { omega: excitation.omega, harmonics, legs, linear_legs, systems, resonances, mirrored, odd })
    }

    /// Number of real coefficients of a leg, `2 H + 1`.
    pub(crate) fn width(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Number of unknowns of nonlinear legs.
    pub(crate) fn leg_size(&self) -> usize {
        self.width() * self.legs.len()
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        self.leg_size() + 2 * self.resonances
    }

    /// Index of the cosine of mode number `r` at resonance with harmonic `h`; its sine follows.
    pub(crate) fn resonant_index(&self, h: usize, r: usize) -> usize {
        self.leg_size() + 2 * (self.systems[h].resonant_before + r)
    }

    /// Index of the cosine of kept leg `j` at harmonic `h >= 1`; its sine follows.
    pub(crate) fn index(&self, h: usize, j: usize) -> usize {
        let count = self.legs.len();
        if j < count { j * self.width() + 2 * h - 1 } else { self.resonant_index(h, j - count) }
    }

    /// Complex amplitude of kept leg `j` at harmonic `h` in coefficients laid out as the unknowns.
    pub(crate) fn get(&self, u: &[f64], h: usize, j: usize) -> c64 {
        let (count, width) = (self.legs.len(), self.width());
        if j < count {
            return amplitude(&u[j * width..(j + 1) * width], h);
        }
        let k = self.resonant_index(h, j - count);
        c64::new(u[k], -u[k + 1])
    }

    /// Adds to it.
    pub(crate) fn add(&self, u: &mut [f64], h: usize, j: usize, value: c64) {
        let (count, width) = (self.legs.len(), self.width());
        if j < count {
            return add_amplitude(&mut u[j * width..(j + 1) * width], h, value);
        }
        let k = self.resonant_index(h, j - count);
        u[k] += value.re;
        u[k + 1] -= value.im;
    }

    /// Coefficients of the motions of the kept legs under `level` times the excitation and the forces `u`.
    pub(crate) fn motion(&self, u: &[f64], level: f64) -> Vec<f64> {
        let mut motion = vec![0.0; u.len()];
        for (h, at) in self.systems.iter().enumerate() {
            for i in 0..at.count() {
                let pull = |j: usize| at.coupling(i, j) * self.get(u, h, j);
                let d = (0..at.count()).fold(at.free[i] * level, |d, j| d - pull(j));
                self.add(&mut motion, h, i, d);
            }
        }
        motion
    }

    /// Motions of the kept legs in displacements `x` of all DOFs per harmonic (empty: at rest).
    pub(crate) fn motion_of<'a>(&self, compliance: impl Fn(usize) -> &'a Compliance, x: &[Vec<c64>]) -> Vec<f64> {
        let mut motion = vec![0.0; self.size()];
        for (h, x) in x.iter().enumerate().filter(|(_, x)| !x.is_empty()) {
            for (i, leg) in self.legs.iter().enumerate() {
                self.add(&mut motion, h, i, leg.leg.relative(|i| x[i]));
            }
            for (r, mode) in compliance(h).resonant.iter().enumerate() {
                self.add(&mut motion, h, self.legs.len() + r, mode.motion(x));
            }
            for (j, leg) in self.kept_linear(h) {
                self.add(&mut motion, h, j, leg.relative(|i| x[i]));
            }
        }
        motion
    }

    /// Numbers of the linear legs among those kept at harmonic `h`.
    pub(crate) fn kept_linear(&self, h: usize) -> impl Iterator<Item = (usize, Leg)> {
        let first = self.systems[h].count().saturating_sub(self.linear_legs.len());
        let kept = if self.systems[h].keeps_linear { &self.linear_legs[..] } else { &[] };
        kept.iter().enumerate().map(move |(l, linear)| (first + l, linear.leg))
    }

    /// Forces of the linear legs at harmonic `h` when the kept ones have the coefficients `u`.
    pub(crate) fn linear_forces(&self, h: usize, u: &[f64], level: f64) -> Vec<c64> {
        let at = &self.systems[h];
        if at.keeps_linear {
            return self.kept_linear(h).map(|(j, _)| self.get(u, h, j)).collect();
        }
        let motion: Vec<c64> = (0..self.linear_legs.len())
            .map(|l| {
                let pull = |j: usize| at.mixed[l * at.count() + j] * self.get(u, h, j);
                (0..at.count()).fold(at.linear_free[l] * level, |d, j| d - pull(j))
            })
            .collect();
        multiply(&at.elimination, &motion)
    }

    /// Displacements of all DOFs at harmonic `h` under the external forces and the kept ones, `u`.
    pub(crate) fn displacements(
        &self,
        compliance: &Compliance,
        h: usize,
        size: usize,
        excitation: &Excitation,
        u: &[f64],
    ) -> Vec<c64> {
        let mut loads: Vec<(usize, c64)> = excitation.forces.iter().map(|f| (f.dof, f.amplitude(h))).collect();
        for (j, leg) in self.legs.iter().enumerate() {
            push_leg(&mut loads, leg.leg, self.get(u, h, j));
        }
        for (leg, force) in self.linear_legs.iter().zip(self.linear_forces(h, u, 1.0)) {
            push_leg(&mut loads, leg.leg, force);
        }
        let mut x = vec![c64::new(0.0, 0.0); size];
        compliance.apply_at(&loads, &mut x);
        self.subtract_resonant(compliance, h, u, &mut x);
        x
    }

    /// Takes away what the forces of the modes at resonance do.
    fn subtract_resonant(&self, compliance: &Compliance, h: usize, u: &[f64], x: &mut [c64]) {
        for (r, mode) in compliance.resonant.iter().enumerate() {
            let p = self.get(u, h, self.legs.len() + r);
            x.iter_mut().zip(&mode.column).for_each(|(x, a)| *x -= *a * p);
        }
    }

    /// Response of the linear rest (kept forces held) to forces at every DOF, at harmonic `h`: displacements of all DOFs.
    pub(crate) fn linear_response(&self, compliance: &Compliance, h: usize, force: &[c64]) -> Vec<c64> {
        let mut x = vec![c64::new(0.0, 0.0); force.len()];
        compliance.apply(force, &mut x);
        let motion: Vec<c64> = self.linear_legs.iter().map(|l| l.leg.relative(|i| x[i])).collect();
        self.subtract_linear(compliance, h, &motion, &mut x);
        x
    }

    /// Takes away what the linear legs do when they would move by `motion` without their forces.
    fn subtract_linear(&self, compliance: &Compliance, h: usize, motion: &[c64], x: &mut [c64]) {
        if motion.is_empty() || self.systems[h].keeps_linear {
            return;
        }
        let forces = multiply(&self.systems[h].elimination, motion);
        let mut loads = Vec::with_capacity(2 * forces.len());
        for (leg, force) in self.linear_legs.iter().zip(forces) {
            push_leg(&mut loads, leg.leg, force);
        }
        let mut change = vec![c64::new(0.0, 0.0); x.len()];
        compliance.apply_at(&loads, &mut change);
        x.iter_mut().zip(change).for_each(|(x, c)| *x += c);
    }
}

/// Velocity weight of friction: the leg's own impedance, between the extremes over the harmonics.
fn velocity_weight(systems: &[HarmonicSystem], omega: f64, leg: usize) -> f64 {
    let logs: Vec<f64> = systems
        .iter()
        .enumerate()
        .skip(1)
        .map(|(h, at)| (h as f64 * omega * at.coupling(leg, leg).norm()).ln())
        .filter(|x| x.is_finite())
        .collect();
    if logs.is_empty() { 1.0 } else { 2.0 * (-logs.iter().sum::<f64>() / logs.len() as f64).exp() }
}

//! Exact condensation of the linear rest to the relative motions of the nonlinear sources, harmonic by harmonic:
//!
//! ```text
//! D_h = D_lin,h - C_h F_h,      C_h = L_N^T Z(h w)^-1 L_N,      D_lin,h = L_N^T Z(h w)^-1 F_ext,h
//! ```
//!
//! Linear sources between single DOFs are eliminated by Woodbury's identity from the receptance `A_h` of the structure:
//! their forces are `g = S (d_l - G_lN F)`, `S = z (1 + G_ll z)^-1`, with `G = L^T A L` and `d = L^T A F_ext`.

use super::compliance::Compliance;
use super::dense::invert;
use super::fourier::{add_amplitude, amplitude};
use super::legs::NonlinearLeg;
use super::model::{Excitation, ModelError};
use crate::effects::{Leg, Source};
use faer::c64;

/// A linear source at one leg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearLeg {
    /// Index of the source in the list given.
    pub source: usize,
    pub leg: Leg,
}

/// Quantities of one harmonic. `m` nonlinear and `k` linear legs.
pub(crate) struct Level {
    /// `C_h`, m x m row by row, m/N.
    pub coupling: Vec<c64>,
    /// `D_lin,h`, m.
    pub free: Vec<c64>,
    /// `S`, k x k.
    elimination: Vec<c64>,
    /// `G_lN`, k x m.
    mixed: Vec<c64>,
    /// `d_l`, k.
    linear_free: Vec<c64>,
}

/// The system seen from its nonlinear legs.
pub(crate) struct Condensed {
    pub omega: f64,
    pub harmonics: usize,
    pub legs: Vec<NonlinearLeg>,
    pub linear_legs: Vec<LinearLeg>,
    /// Harmonics 0..=H.
    pub levels: Vec<Level>,
}

/// Splits sources into linear and nonlinear legs; whole-structure and channel effects are not among them.
pub(crate) fn split(sources: &[Source]) -> (Vec<NonlinearLeg>, Vec<LinearLeg>) {
    let (mut nonlinear, mut linear) = (Vec::new(), Vec::new());
    for (index, source) in sources.iter().enumerate() {
        let Some(law) = source.effect.law() else { continue };
        for leg in source.place.legs() {
            if law.dynamic_stiffness(&source.parameters, 1.0).is_some() {
                linear.push(LinearLeg { source: index, leg });
            } else {
                let parameters = source.parameters.clone();
                nonlinear.push(NonlinearLeg {
                    source: index,
                    leg,
                    effect: source.effect,
                    parameters,
                    law,
                    weight: 1.0,
                });
            }
        }
    }
    (nonlinear, linear)
}

impl Condensed {
    /// Condenses for harmonics 0..=`harmonics`; `compliance(h)` is the receptance of the structure.
    pub fn new<'a>(
        compliance: impl Fn(usize) -> &'a Compliance,
        sources: &[Source],
        excitation: &Excitation,
        harmonics: usize,
    ) -> Result<Self, ModelError> {
        let (mut legs, linear_legs) = split(sources);
        let mut levels = Vec::with_capacity(harmonics + 1);
        for h in 0..=harmonics {
            levels.push(level(compliance(h), sources, &legs, &linear_legs, excitation, h)?);
        }
        let count = legs.len();
        for (i, leg) in legs.iter_mut().enumerate() {
            leg.weight = velocity_weight(&levels, excitation.omega, i * count + i);
        }
        Ok(Self { omega: excitation.omega, harmonics, legs, linear_legs, levels })
    }

    /// Number of real coefficients of a leg, `2 H + 1`.
    pub fn width(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.width() * self.legs.len()
    }

    /// Coefficients of the relative motions under `level` times the excitation and the leg forces `u`.
    pub fn motion(&self, u: &[f64], level: f64) -> Vec<f64> {
        let (width, count) = (self.width(), self.legs.len());
        let mut motion = vec![0.0; u.len()];
        for (h, at) in self.levels.iter().enumerate() {
            for i in 0..count {
                let mut d = at.free[i] * level;
                for j in 0..count {
                    d -= at.coupling[i * count + j] * amplitude(&u[j * width..(j + 1) * width], h);
                }
                add_amplitude(&mut motion[i * width..(i + 1) * width], h, d);
            }
        }
        motion
    }

    /// Forces of the linear legs at harmonic `h` when the nonlinear ones have the coefficients `u`.
    pub fn linear_forces(&self, h: usize, u: &[f64], level: f64) -> Vec<c64> {
        let (width, count, k) = (self.width(), self.legs.len(), self.linear_legs.len());
        let at = &self.levels[h];
        let motion: Vec<c64> = (0..k)
            .map(|l| {
                let pull = |j: usize| at.mixed[l * count + j] * amplitude(&u[j * width..(j + 1) * width], h);
                (0..count).fold(at.linear_free[l] * level, |d, j| d - pull(j))
            })
            .collect();
        multiply(&at.elimination, &motion)
    }

    /// Response of the linear rest to forces at every DOF, at harmonic `h`: displacements of all DOFs.
    pub fn linear_response(&self, compliance: &Compliance, h: usize, force: &[c64]) -> Vec<c64> {
        let mut x = vec![c64::new(0.0, 0.0); force.len()];
        compliance.apply(force, &mut x);
        let motion: Vec<c64> = self.linear_legs.iter().map(|l| l.leg.relative(|i| x[i])).collect();
        self.subtract_linear(compliance, h, &motion, &mut x);
        x
    }

    /// Takes away what the linear legs do when they would move by `motion` without their forces.
    fn subtract_linear(&self, compliance: &Compliance, h: usize, motion: &[c64], x: &mut [c64]) {
        if motion.is_empty() {
            return;
        }
        let forces = multiply(&self.levels[h].elimination, motion);
        let mut loads = Vec::with_capacity(2 * forces.len());
        for (leg, force) in self.linear_legs.iter().zip(forces) {
            push_leg(&mut loads, leg.leg, force);
        }
        let mut change = vec![c64::new(0.0, 0.0); x.len()];
        compliance.apply_at(&loads, &mut change);
        x.iter_mut().zip(change).for_each(|(x, c)| *x += c);
    }
}

/// Adds the load `-force L` of a leg.
pub(crate) fn push_leg(loads: &mut Vec<(usize, c64)>, leg: Leg, force: c64) {
    loads.push((leg.first, -force));
    if let Some(second) = leg.second {
        loads.push((second, force));
    }
}

/// Velocity weight of friction: the leg's own impedance, between the extremes over the harmonics.
fn velocity_weight(levels: &[Level], omega: f64, index: usize) -> f64 {
    let logs: Vec<f64> = levels
        .iter()
        .enumerate()
        .skip(1)
        .map(|(h, at)| (h as f64 * omega * at.coupling[index].norm()).ln())
        .filter(|x| x.is_finite())
        .collect();
    if logs.is_empty() { 1.0 } else { 2.0 * (-logs.iter().sum::<f64>() / logs.len() as f64).exp() }
}

fn level(
    compliance: &Compliance,
    sources: &[Source],
    legs: &[NonlinearLeg],
    linear: &[LinearLeg],
    excitation: &Excitation,
    h: usize,
) -> Result<Level, ModelError> {
    let omega = h as f64 * excitation.omega;
    let (m, k) = (legs.len(), linear.len());
    let free = |leg: Leg| {
        excitation.forces.iter().fold(c64::new(0.0, 0.0), |sum, force| {
            let value = force.amplitude(h);
            if value.norm_sqr() == 0.0 { sum } else { sum + compliance.between(leg, force.leg()) * value }
        })
    };
    let table = |rows: &[Leg], columns: &[Leg]| -> Vec<c64> {
        rows.iter().flat_map(|&a| columns.iter().map(move |&b| compliance.between(a, b))).collect()
    };
    let nonlinear_legs: Vec<Leg> = legs.iter().map(|l| l.leg).collect();
    let linear_legs: Vec<Leg> = linear.iter().map(|l| l.leg).collect();
    let mut coupling = table(&nonlinear_legs, &nonlinear_legs);
    let mut free_motion: Vec<c64> = nonlinear_legs.iter().map(|&l| free(l)).collect();
    let mixed = table(&linear_legs, &nonlinear_legs);
    let linear_free: Vec<c64> = linear_legs.iter().map(|&l| free(l)).collect();
    let stiffness: Vec<c64> = linear.iter().map(|l| stiffness_of(&sources[l.source], omega)).collect();
    let elimination = eliminate(&table(&linear_legs, &linear_legs), &stiffness)
        .ok_or(ModelError::SingularSources { frequency_hz: omega / std::f64::consts::TAU })?;
    if k > 0 {
        let pulled = multiply(&elimination, &linear_free);
        for i in 0..m {
            free_motion[i] -= (0..k).fold(c64::new(0.0, 0.0), |s, l| s + mixed[l * m + i] * pulled[l]);
        }
        for j in 0..m {
            let column: Vec<c64> = (0..k).map(|l| mixed[l * m + j]).collect();
            let pulled = multiply(&elimination, &column);
            for i in 0..m {
                coupling[i * m + j] -= (0..k).fold(c64::new(0.0, 0.0), |s, l| s + mixed[l * m + i] * pulled[l]);
            }
        }
    }
    Ok(Level { coupling, free: free_motion, elimination, mixed, linear_free })
}

/// Dynamic stiffness of a linear source between DOFs, N/m.
pub(crate) fn stiffness_of(source: &Source, omega: f64) -> c64 {
    let law = source.effect.law();
    law.and_then(|law| law.dynamic_stiffness(&source.parameters, omega)).unwrap_or(c64::new(0.0, 0.0))
}

/// `S = z (1 + G z)^-1`, k x k.
fn eliminate(g: &[c64], z: &[c64]) -> Option<Vec<c64>> {
    let k = z.len();
    let one = |i: usize, j: usize| c64::new(if i == j { 1.0 } else { 0.0 }, 0.0);
    let system: Vec<c64> = (0..k * k).map(|n| one(n / k, n % k) + g[n] * z[n % k]).collect();
    let inverse = invert(k, system)?;
    Some((0..k * k).map(|n| z[n / k] * inverse[n]).collect())
}

/// Square matrix, row by row, times a vector.
fn multiply(matrix: &[c64], x: &[c64]) -> Vec<c64> {
    let row = |row: &[c64]| row.iter().zip(x).fold(c64::new(0.0, 0.0), |s, (a, b)| s + *a * *b);
    matrix.chunks_exact(x.len().max(1)).map(row).collect()
}

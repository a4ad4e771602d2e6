//! What one source does to a periodic motion: its energy per period, its force harmonics, its secant stiffness.
//!
//! For a relative displacement `D = L^T X` and a linear law of dynamic stiffness `Z`
//! `G = pi sum_h h Im Z(h omega) |D_h|^2`, which is `(T/2) sum_h |h omega D_h|^2` for a unit dashpot (5.11), `pi |D|^2`
//! for a unit loss stiffness; Coulomb with one harmonic `4 |D|` (5.38 with `D` the relative amplitude). Every other law by
//! sampling one period. Over the whole structure `pi sum_h h X_h^H Im(factor) B X_h`.

use crate::effects::{Basis, Kind, Law, Leg, Motion, Source, WholeLaw};
use crate::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::{PI, TAU};

/// Samples of one period for laws without a closed form.
const SAMPLES: usize = 1024;
/// Step of the amplitude for the derivative of a sampled energy.
const STEP: f64 = 1e-4;

/// Harmonics of the displacement of all DOFs.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Harmonic number of each column of `x`.
    pub numbers: &'a [usize],
    /// Displacement, n x harmonics, m.
    pub x: &'a Mat<c64>,
}

impl Field<'_> {
    /// Displacement of a leg, one value a harmonic, m.
    pub(crate) fn relative(&self, leg: Leg) -> Vec<c64> {
        (0..self.numbers.len()).map(|k| leg.relative(|dof| self.x[(dof, k)])).collect()
    }

    fn motion(&self, d: &[c64], scale: f64) -> Motion {
        let mut harmonics = vec![c64::new(0.0, 0.0); self.numbers.last().copied().unwrap_or(1)];
        for (&h, &value) in self.numbers.iter().zip(d) {
            harmonics[h - 1] = value * scale;
        }
        let samples = SAMPLES.max(64 * harmonics.len()).next_power_of_two();
        Motion::new(self.omega, 0.0, &harmonics, samples)
    }

    fn frequency(&self, k: usize) -> f64 {
        self.numbers[k] as f64 * self.omega
    }

    /// Work of a force (N, one value a harmonic) at a DOF over one period, J.
    pub(crate) fn work(&self, dof: usize, force: &[c64]) -> f64 {
        work(force.iter().enumerate().map(|(k, f)| (self.numbers[k], self.x[(dof, k)], *f)))
    }
}

/// Work of a force on its motion over one period, J: `pi sum_h h Im(conj(X_h) F_h)` (4.5) of numbers `h`, displacements (m) and forces (N).
pub(crate) fn work(harmonics: impl IntoIterator<Item = (usize, c64, c64)>) -> f64 {
    PI * harmonics.into_iter().map(|(h, x, f)| h as f64 * (x.conj() * f).im).sum::<f64>()
}

/// A force on one DOF, one value a harmonic.
pub(crate) type DofForce = (usize, Vec<c64>);

/// A linear complex stiffness that stands for a source at one harmonic.
#[derive(Debug, Clone, PartialEq)]
pub enum Secant {
    /// On relative displacements, N/m.
    Legs(Vec<(Leg, c64)>),
    /// A factor of a matrix of the structure.
    Whole(Basis, Option<[usize; 2]>, c64),
}

/// Energy in J that `source` takes out over one period, at its own parameters.
pub(crate) fn energy(source: &Source, structure: &Structure, field: Field<'_>) -> f64 {
    match source.effect.kind() {
        Kind::Relative(_) => relative_energy(source, field),
        Kind::Whole(law) => whole_energy(law, source, structure, field),
        Kind::Channel(_) => 0.0,
    }
}

/// The same of a law on relative motions, which needs no structure.
pub(crate) fn relative_energy(source: &Source, field: Field<'_>) -> f64 {
    let Some(law) = source.effect.law().filter(|_| source.effect.dissipates()) else { return 0.0 };
    let of_leg = |leg: Leg| leg_energy(law, &source.parameters, field, &field.relative(leg), 1.0);
    source.place.legs().into_iter().map(of_leg).sum()
}

/// Energy of one law on the relative motion `scale d`.
fn leg_energy(law: &dyn Law, p: &[f64], field: Field<'_>, d: &[c64], scale: f64) -> f64 {
    if law.dynamic_stiffness(p, field.omega).is_some() {
        let term = |k: usize, z: c64| PI * field.numbers[k] as f64 * z.im * d[k].norm_sqr() * scale * scale;
        return (0..d.len()).filter_map(|k| law.dynamic_stiffness(p, field.frequency(k)).map(|z| term(k, z))).sum();
    }
    if field.numbers == [1]
        && let Some(exact) = law.energy_per_cycle(p, d[0].norm() * scale, field.omega)
    {
        return exact;
    }
    if d.iter().all(|v| v.norm_sqr() == 0.0) {
        return 0.0;
    }
    law.energy(p, &field.motion(d, scale))
}

fn whole_energy(law: &dyn WholeLaw, source: &Source, structure: &Structure, field: Field<'_>) -> f64 {
    (0..field.numbers.len())
        .map(|k| {
            let bx = basis_times(law, source, structure, field, k);
            let factor = law.factor(source.coefficient(), field.frequency(k)).im;
            let form: f64 = (0..bx.len()).map(|i| (field.x[(i, k)].conj() * bx[i]).re).sum();
            PI * field.numbers[k] as f64 * factor * form
        })
        .sum()
}

/// `B x_k` of a law of the whole structure, with `B` the matrix on which it acts.
fn basis_times(law: &dyn WholeLaw, source: &Source, structure: &Structure, field: Field<'_>, k: usize) -> Vec<c64> {
    let (range, x) = (source.place.elements(), field.x.col_as_slice(k));
    law.basis().times(structure, range, field.frequency(k), c64::new(1.0, 0.0), x)
}

/// Adds `weight` times the gradient of [`energy`] to `gradient` (n x harmonics): a change `dX` of the motion changes the
/// energy by `Re sum conj(gradient) dX`. Sampled laws: along the amplitude of the fundamental.
pub(crate) fn add_energy_gradient(
    source: &Source,
    structure: &Structure,
    field: Field<'_>,
    weight: f64,
    gradient: &mut Mat<c64>,
) {
    match source.effect.kind() {
        Kind::Relative(law) => {
            for leg in source.place.legs() {
                let d = field.relative(leg);
                let by_d = leg_gradient(law, &source.parameters, field, &d);
                for (k, value) in by_d.into_iter().enumerate() {
                    gradient[(leg.first, k)] += value * weight;
                    if let Some(second) = leg.second {
                        gradient[(second, k)] -= value * weight;
                    }
                }
            }
        }
        Kind::Whole(law) => {
            for k in 0..field.numbers.len() {
                let factor = law.factor(source.coefficient(), field.frequency(k)).im;
                let scale = weight * 2.0 * PI * field.numbers[k] as f64 * factor;
                let bx = basis_times(law, source, structure, field, k);
                for (i, value) in bx.into_iter().enumerate() {
                    gradient[(i, k)] += value * scale;
                }
            }
        }
        Kind::Channel(_) => {}
    }
}

fn leg_gradient(law: &dyn Law, p: &[f64], field: Field<'_>, d: &[c64]) -> Vec<c64> {
    if law.dynamic_stiffness(p, field.omega).is_some() {
        let z = |k: usize| law.dynamic_stiffness(p, field.frequency(k)).map_or(0.0, |z| z.im);
        return (0..d.len()).map(|k| d[k] * (2.0 * PI * field.numbers[k] as f64 * z(k))).collect();
    }
    let mut gradient = vec![c64::new(0.0, 0.0); d.len()];
    if d[0].norm_sqr() > 0.0 {
        let change = leg_energy(law, p, field, d, 1.0 + STEP) - leg_energy(law, p, field, d, 1.0 - STEP);
        gradient[0] = d[0] * (change / (2.0 * STEP) / d[0].norm_sqr());
    }
    gradient
}

/// Force of the source on the structure with its sign turned, `L F(L^T X)`, as harmonics at the DOFs it touches:
/// `Z X + force = F`.
pub(crate) fn force(source: &Source, structure: &Structure, field: Field<'_>) -> Vec<DofForce> {
    match source.effect.kind() {
        Kind::Relative(law) => source
            .place
            .legs()
            .into_iter()
            .flat_map(|leg| {
                let f = leg_force(law, &source.parameters, field, &field.relative(leg));
                let opposite = leg.second.map(|second| (second, f.iter().map(|v| -v).collect()));
                std::iter::once((leg.first, f)).chain(opposite)
            })
            .collect(),
        Kind::Whole(law) => whole_force(law, source, structure, field),
        Kind::Channel(_) => Vec::new(),
    }
}

/// The force of a law of the whole structure, at every DOF.
fn whole_force(law: &dyn WholeLaw, source: &Source, structure: &Structure, field: Field<'_>) -> Vec<DofForce> {
    let at_harmonic = |k: usize| -> Vec<c64> {
        let factor = law.factor(source.coefficient(), field.frequency(k));
        let bx = basis_times(law, source, structure, field, k);
        bx.into_iter().map(|v| v * factor).collect()
    };
    let columns: Vec<Vec<c64>> = (0..field.numbers.len()).map(at_harmonic).collect();
    (0..structure.len()).map(|i| (i, columns.iter().map(|c| c[i]).collect())).collect()
}

fn leg_force(law: &dyn Law, p: &[f64], field: Field<'_>, d: &[c64]) -> Vec<c64> {
    if law.dynamic_stiffness(p, field.omega).is_some() {
        let z = |k: usize| law.dynamic_stiffness(p, field.frequency(k)).unwrap_or(c64::new(0.0, 0.0));
        return (0..d.len()).map(|k| z(k) * d[k]).collect();
    }
    if d.iter().all(|v| v.norm_sqr() == 0.0) {
        return vec![c64::new(0.0, 0.0); d.len()];
    }
    let motion = field.motion(d, 1.0);
    let mut samples = vec![0.0; motion.len()];
    law.force(p, &motion, &mut samples);
    let mut force: Vec<c64> = field.numbers.iter().map(|&h| harmonic(&samples, h)).collect();
    if d.len() == 1 {
        // The part in phase with the velocity from the exact energy: jumps are sampled only to 1/N^2.
        let ratio = force[0] / d[0];
        let quadrature = leg_energy(law, p, field, d, 1.0) / (PI * field.numbers[0] as f64 * d[0].norm_sqr());
        force[0] = c64::new(ratio.re, quadrature) * d[0];
    }
    force
}

/// Complex amplitude of harmonic `h` of one sampled period.
fn harmonic(samples: &[f64], h: usize) -> c64 {
    let n = samples.len();
    let sum: c64 = samples
        .iter()
        .enumerate()
        .map(|(i, &value)| {
            let (sin, cos) = (TAU * ((h * i) % n) as f64 / n as f64).sin_cos();
            c64::new(value * cos, -value * sin)
        })
        .sum();
    sum * (2.0 / n as f64)
}

/// The linear stiffness that stands for the source at kept harmonic `k`: exact for linear laws; for others the secant of the
/// fundamental, its loss growing with frequency like a dashpot's.
pub(crate) fn secant(source: &Source, field: Field<'_>, k: usize) -> Option<Secant> {
    match source.effect.kind() {
        Kind::Relative(law) => {
            let legs = source.place.legs().into_iter().map(|leg| {
                let z = law.dynamic_stiffness(&source.parameters, field.frequency(k)).unwrap_or_else(|| {
                    let d = field.relative(leg);
                    if d[0].norm_sqr() == 0.0 {
                        return c64::new(0.0, 0.0);
                    }
                    let z = leg_force(law, &source.parameters, field, &d)[0] / d[0];
                    c64::new(z.re, z.im * field.numbers[k] as f64)
                });
                (leg, z)
            });
            Some(Secant::Legs(legs.collect()))
        }
        Kind::Whole(law) => {
            let factor = law.factor(source.coefficient(), field.frequency(k));
            Some(Secant::Whole(law.basis(), source.place.elements(), factor))
        }
        Kind::Channel(_) => None,
    }
}

/// `D X` of one source whose stand-in stiffnesses lie between DOFs: forces on DOFs, one value a harmonic of `field`, N.
pub(crate) fn secant_force(source: &Source, field: Field<'_>) -> Vec<DofForce> {
    let harmonics = field.numbers.len();
    let mut list = Vec::new();
    for k in 0..harmonics {
        let Some(Secant::Legs(legs)) = secant(source, field, k) else { continue };
        for (leg, z) in legs {
            let mut force = vec![c64::new(0.0, 0.0); harmonics];
            force[k] = z * leg.relative(|dof| field.x[(dof, k)]);
            if let Some(second) = leg.second {
                list.push((second, force.iter().map(|f| -f).collect()));
            }
            list.push((leg.first, force));
        }
    }
    list
}

#[cfg(test)]
mod tests;

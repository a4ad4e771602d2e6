//! Minimum dynamic residual expansion: the motion that fits the sensors and the model, each as far as it is to be trusted.
//!
//! `min |Y - S X|^2 / sigma_Y^2 + |F_meas - F|^2 / sigma_F^2 + r^T (K + w^2 M)^-1 r / (eps^2 e)`, `Z X = F + r`, with `Z` the
//! dynamic stiffness and the known and identified sources in it. With `P` the covariance of `Z^-1 (F + r)` the solution is
//! `X = X0 + G (Y - S X0)`, `X0 = Z^-1 F_meas`, `G = P S^T (S P S^T + sigma_Y^2)^-1`. The model's error `eps` is relative to
//! the motion's strain energy `e`; with `eps = 0` the model is exact and only the force is in doubt.

use super::expanded::{Acting, Expanded, state_misfit};
use super::map::Map;
use super::modal_model::ModalModel;
use crate::balance::action::{self, Field, Secant};
use crate::balance::measured::Measured;
use crate::effects::Basis;
use crate::structure::Structure;
use dashpot_numerics::ComplexLu;
use faer::{Mat, c64};

/// Loss factor assumed where no damping is known yet, and in the model's error.
const ASSUMED_LOSS: f64 = 1e-3;

pub(super) fn expand(structure: &Structure, model: &ModalModel, measured: &Measured, acting: Acting<'_>) -> Expanded {
    let (n, harmonics) = (structure.len(), measured.harmonics());
    let mut expanded = Expanded {
        x: Mat::zeros(n, harmonics),
        deviation: Mat::zeros(n, harmonics),
        from_sensors: Vec::new(),
        from_forces: Vec::new(),
        receptance: Vec::new(),
        known: vec![true; n],
        misfit: 0.0,
        relative_misfit: 0.0,
    };
    let corrections = pseudo_forces(structure, measured, acting);
    for k in 0..harmonics {
        let one = Harmonic::new(structure, model, measured, acting, &corrections, k);
        for i in 0..n {
            expanded.x[(i, k)] = one.x[i];
            expanded.deviation[(i, k)] = one.deviation[i];
        }
        expanded.from_sensors.push(Map::Full(one.gain));
        expanded.from_forces.push(Map::Full(one.from_forces));
        expanded.receptance.push(one.receptance);
    }
    state_misfit(measured, &mut expanded);
    expanded
}

/// What the nonlinear sources' stand-in stiffness misses at the motion found before, per DOF and kept harmonic: forces on
/// the structure beside the exciters.
pub(super) fn pseudo_forces(structure: &Structure, measured: &Measured, acting: Acting<'_>) -> Vec<(usize, Vec<c64>)> {
    let Some(x) = acting.motion else { return Vec::new() };
    let field = Field { omega: measured.omega, numbers: &measured.numbers, x };
    let mut sum: Vec<(usize, Vec<c64>)> = Vec::new();
    for source in acting.sources.iter().filter(|s| !s.effect.is_linear()) {
        for (dof, force) in action::force(source, structure, field) {
            sum.push((dof, force.iter().map(|f| -f).collect()));
        }
        sum.extend(action::secant_force(source, field));
    }
    sum
}

/// The expansion of one harmonic.
struct Harmonic {
    x: Vec<c64>,
    deviation: Vec<f64>,
    gain: Mat<c64>,
    from_forces: Mat<c64>,
    receptance: Mat<c64>,
}

impl Harmonic {
    fn new(
        structure: &Structure,
        model: &ModalModel,
        measured: &Measured,
        acting: Acting<'_>,
        corrections: &[(usize, Vec<c64>)],
        k: usize,
    ) -> Self {
        let (n, omega) = (structure.len(), measured.frequency(k));
        let mut secants = acting.secants(measured, k, n);
        if !dissipates(&secants) {
            secants.push(Secant::Whole(Basis::Stiffness, None, c64::new(0.0, ASSUMED_LOSS)));
        }
        let (p, s) = (measured.forces.len(), measured.sensors.len());
        let extra = corrections.iter().map(|(dof, _)| *dof);
        let dofs: Vec<usize> =
            measured.forces.dofs.iter().chain(&measured.sensors.dofs).copied().chain(extra).collect();
        let columns = model.receptance(structure, omega, &secants, &dofs);
        let driven = columns.subcols(0, p).to_owned();
        let receptance = columns.subcols(p, s).to_owned();
        let x0: Vec<c64> = (0..n)
            .map(|i| {
                let forced: c64 = (0..p).map(|j| driven[(i, j)] * measured.forces.values[(j, k)]).sum();
                forced + corrections.iter().enumerate().map(|(j, (_, f))| columns[(i, p + s + j)] * f[k]).sum::<c64>()
            })
            .collect();
        let prior = Prior::new(model, measured, &driven, acting.model_error, k);
        prior.update(measured, k, &driven, receptance, &x0)
    }
}

fn dissipates(secants: &[Secant]) -> bool {
    secants.iter().any(|secant| match secant {
        Secant::Legs(legs) => legs.iter().any(|(_, z)| z.im > 0.0),
        Secant::Whole(_, _, z) => z.im > 0.0,
    })
}

/// Covariance of the motion before the sensors are read, per real part.
struct Prior {
    /// `P S^T`, n x sensors.
    to_sensors: Mat<c64>,
    /// Diagonal of `P`.
    variance: Vec<f64>,
}

impl Prior {
    fn new(model: &ModalModel, measured: &Measured, driven: &Mat<c64>, model_error: f64, k: usize) -> Self {
        let omega = measured.frequency(k);
        let sensors = &measured.sensors.dofs;
        let mut v = model.residual_variances(omega, ASSUMED_LOSS);
        let scale = model_error.powi(2) * strain_energy(model, measured, k);
        for value in &mut v {
            *value *= scale;
        }
        let noise: Vec<f64> = (0..driven.ncols()).map(|j| measured.forces.deviations[(j, k)].powi(2)).collect();
        let force = |i: usize, other: usize| -> c64 {
            (0..driven.ncols()).map(|j| driven[(i, j)] * driven[(other, j)].conj() * noise[j]).sum()
        };
        let (n, s) = (model.size(), sensors.len());
        let mut to_sensors = Mat::from_fn(n, s, |i, b| force(i, sensors[b]));
        let mut variance: Vec<f64> = (0..n).map(|i| force(i, i).re).collect();
        if scale > 0.0 {
            let residual = model.residual_covariance(&v, sensors);
            (0..s).for_each(|b| (0..n).for_each(|i| to_sensors[(i, b)] += residual[(i, b)]));
            variance.iter_mut().zip(model.residual_diagonal(&v)).for_each(|(sum, own)| *sum += own);
        }
        Self { to_sensors, variance }
    }

    fn update(self, measured: &Measured, k: usize, driven: &Mat<c64>, receptance: Mat<c64>, x0: &[c64]) -> Harmonic {
        let (n, sensors) = (x0.len(), &measured.sensors.dofs);
        let s = sensors.len();
        // Scaled by the sensors' deviations so that amplitudes of very different size do not hurt.
        let sigma: Vec<f64> = (0..s).map(|a| measured.sensors.deviations[(a, k)]).collect();
        let innovation = Mat::from_fn(s, s, |a, b| {
            let own = if a == b { 1.0 } else { 0.0 };
            self.to_sensors[(sensors[a], b)] / (sigma[a] * sigma[b]) + own
        });
        let scaled = Mat::from_fn(s, n, |b, i| (self.to_sensors[(i, b)] / sigma[b]).conj());
        let solved = ComplexLu::new(innovation.as_ref()).solve(scaled.as_ref());
        let gain = Mat::from_fn(n, s, |i, b| solved[(b, i)].conj() / sigma[b]);
        let residual: Vec<c64> = (0..s).map(|b| measured.sensors.values[(b, k)] - x0[sensors[b]]).collect();
        let x = (0..n).map(|i| x0[i] + (0..s).map(|b| gain[(i, b)] * residual[b]).sum::<c64>()).collect();
        let deviation = (0..n)
            .map(|i| {
                let gained: f64 = (0..s).map(|b| (gain[(i, b)] * self.to_sensors[(i, b)].conj()).re).sum();
                (self.variance[i] - gained).max(0.0).sqrt()
            })
            .collect();
        let from_forces = Mat::from_fn(n, driven.ncols(), |i, j| {
            driven[(i, j)] - (0..s).map(|b| gain[(i, b)] * driven[(sensors[b], j)]).sum::<c64>()
        });
        Harmonic { x, deviation, gain, from_forces, receptance }
    }
}

/// Strain energy per real part of the motion as the nearest mode sees it, J: the scale of the model's error.
fn strain_energy(model: &ModalModel, measured: &Measured, k: usize) -> f64 {
    let omega = measured.frequency(k);
    let Some(&mode) = model.by_distance(omega).first() else { return 0.0 };
    let (mut product, mut square) = (c64::new(0.0, 0.0), 0.0);
    for (s, &dof) in measured.sensors.dofs.iter().enumerate() {
        product += measured.sensors.values[(s, k)] * model.shape(mode, dof);
        square += model.shape(mode, dof).powi(2);
    }
    if square > 0.0 { 0.5 * omega * omega * (product / square).norm_sqr() } else { 0.0 }
}

//! Energy of a run at its measured motion: what the exciters put in and what the known sources take out.
//!
//! ```text
//! input = pi sum_h h Im( X_h^* F_h )  over the force channels        (4.5)
//! taken = sum over sources of integral d' F dt                       (4.22)
//! ```
//!
//! Where not every DOF is measured the field is that of the model, its harmonics each scaled by the complex factor that
//! fits the sensors best: near a resonance the shape of the motion is known far better than its size.

use crate::balance::measured::NOMINAL;
use crate::diagnosis::residual::data::{ChannelData, RunData};
use crate::diagnosis::residual::prediction::RunPrediction;
use crate::effects::{Kind, Place, Source};
use crate::measurement::Quantity;
use crate::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::PI;

/// Samples a period for laws without an exact formula.
pub(crate) const SAMPLES: usize = 512;

/// Displacement amplitudes of harmonics 1.. (m) of a DOF.
pub(crate) type Field<'a> = dyn Fn(usize) -> Vec<c64> + 'a;

/// Energy in J that the force channels of a run put in over one period, with the displacements `field`.
pub(crate) fn input(run: &RunData, field: &Field) -> f64 {
    let of_channel = |dof: usize, forces: &[c64]| -> f64 {
        let x = field(dof);
        x.iter().zip(forces).enumerate().map(|(i, (x, f))| PI * (i + 1) as f64 * (x.conj() * f).im).sum()
    };
    run.forces.iter().map(|f| of_channel(f.dof, &f.measured)).sum()
}

/// Energy in J that a source takes out over one period of `field`, from so many `samples` of it.
pub(crate) fn taken(structure: &Structure, source: &Source, omega: f64, field: &Field, samples: usize) -> f64 {
    let (Kind::Whole(law), Some(basis)) = (source.effect.kind(), whole_matrix(structure, source)) else {
        return source.energy(omega, field, samples).unwrap_or(0.0);
    };
    let all: Vec<Vec<c64>> = (0..structure.len()).map(field).collect();
    let order = all.first().map_or(0, Vec::len);
    let of_harmonic = |h: usize| {
        let x: Vec<c64> = all.iter().map(|d| d[h - 1]).collect();
        PI * h as f64 * law.factor(source.parameters[0], h as f64 * omega).im * quadratic(&basis, &x)
    };
    (1..=order).map(of_harmonic).sum()
}

/// The measured displacement amplitudes of a DOF, if a channel measures it: sensors there are averaged by the inverse of their
/// variances, as in identification.
pub(crate) fn measured_displacement(run: &RunData, dof: usize) -> Option<Vec<c64>> {
    let moves = |q: Quantity| matches!(q, Quantity::Displacement | Quantity::Velocity | Quantity::Acceleration);
    let sensors: Vec<&ChannelData> = run.responses.iter().filter(|c| c.dof == dof && moves(c.quantity)).collect();
    let average = |i: usize| {
        let (mut sum, mut weights) = (c64::new(0.0, 0.0), 0.0);
        for sensor in &sensors {
            let factor = sensor.from_displacement((i + 1) as f64 * run.omega);
            let least = NOMINAL * sensor.measured.iter().map(|y| y.norm()).fold(0.0, f64::max);
            let deviation = sensor.deviation[i].max(least) / factor.norm();
            let weight = deviation.max(f64::MIN_POSITIVE.sqrt()).powi(-2);
            sum += sensor.measured[i] / factor * weight;
            weights += weight;
        }
        sum / weights
    };
    let harmonics = sensors.first()?.measured.len();
    Some((0..harmonics).map(average).collect())
}

/// The field of a prediction scaled to the sensors, one complex factor a harmonic.
pub(crate) fn scaled_factors(run: &RunData, prediction: &RunPrediction) -> Vec<c64> {
    let factor = |h: usize| {
        let (mut product, mut square) = (c64::new(0.0, 0.0), 0.0);
        for &c in &run.alive {
            let weight = run.scale(c).powi(-2);
            let (m, y) = (prediction.channels[c][h - 1], run.responses[c].measured[h - 1]);
            product += m.conj() * y * weight;
            square += m.norm_sqr() * weight;
        }
        // Higher harmonics are often noise only: scaling the model by noise would invent energy.
        if h == 1 && square > 0.0 { product / square } else { c64::new(1.0, 0.0) }
    };
    (1..=run.harmonics).map(factor).collect()
}

/// `|input - taken| / |input|` of one run for a model with a prediction.
pub(crate) fn energy_error(
    structure: &Structure,
    sources: &[Source],
    run: &RunData,
    prediction: &RunPrediction,
) -> f64 {
    let factors = scaled_factors(run, prediction);
    let field = |dof: usize| -> Vec<c64> {
        factors.iter().enumerate().map(|(i, f)| f * prediction.response.amplitude(dof, i + 1)).collect()
    };
    let driven = |dof: usize| measured_displacement(run, dof).unwrap_or_else(|| field(dof));
    let given = input(run, &driven);
    let lost: f64 = sources.iter().map(|s| taken(structure, s, run.omega, &field, SAMPLES)).sum();
    if given == 0.0 { if lost == 0.0 { 0.0 } else { 1.0 } } else { ((given - lost) / given).abs() }
}

/// Matrix on which a whole-structure law acts; `None` for other sources and structures without matrices.
pub(crate) fn whole_matrix(structure: &Structure, source: &Source) -> Option<Mat<f64>> {
    let (Kind::Whole(law), Place::Whole(range)) = (source.effect.kind(), &source.place) else { return None };
    let matrices = structure.matrices()?;
    Some(match *range {
        None => law.basis().of_structure(structure, matrices),
        Some(range) => law.basis().of_elements(structure, range),
    })
}

/// `x^H B x` for symmetric real `B`.
fn quadratic(b: &Mat<f64>, x: &[c64]) -> f64 {
    let row = |(j, xj): (usize, &c64)| {
        let product = b.col_as_slice(j).iter().zip(x).fold(c64::new(0.0, 0.0), |s, (b, xi)| s + xi.conj() * *b);
        (product * xj).re
    };
    x.iter().enumerate().map(row).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// An accelerometer and a displacement sensor of a fifth of its deviation (in m) at one DOF, and a velocity sensor at another.
    #[test]
    fn sensors_at_one_dof_are_averaged_by_the_inverse_of_their_variances() {
        let omega = 10.0;
        let sensor = |quantity, dof, value: f64, deviation: f64| ChannelData {
            name: String::new(),
            quantity,
            dof,
            measured: vec![c64::new(value, 0.0)],
            deviation: vec![deviation],
        };
        let responses = vec![
            sensor(Quantity::Acceleration, 0, -omega * omega * 1.26e-3, omega * omega * 5e-6),
            sensor(Quantity::Displacement, 0, 1e-3, 1e-6),
            sensor(Quantity::Velocity, 1, 3e-2, 1e-4),
        ];
        let (forces, alive) = (Vec::new(), vec![0, 1, 2]);
        let run = RunData { index: 0, omega, harmonics: 1, forces, responses, alive, on_moving_base: false };
        let displacement = |dof| measured_displacement(&run, dof);
        // Weights 1 and 25.
        assert!((displacement(0).unwrap()[0] - c64::new(1.01e-3, 0.0)).norm() < 1e-12);
        assert!((displacement(1).unwrap()[0] - c64::new(0.0, -3e-3)).norm() < 1e-12 && displacement(2).is_none());
    }
}

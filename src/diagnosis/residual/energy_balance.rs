//! Energy of a run at its measured motion: what the exciters put in and what the known sources take out.
//!
//! ```text
//! input = pi sum_h h Im( X_h^* F_h )  over the force channels        (4.5)
//! taken = sum over sources of integral d' F dt                       (4.22)
//! ```
//!
//! Where every DOF is measured, `points::energies` takes the measured motion; here it is that of the model, its harmonics each scaled by the complex factor that
//! fits the sensors best: near a resonance the shape of the motion is known far better than its size.

use crate::balance::action::{self, Field};
use crate::balance::measured::NOMINAL;
use crate::diagnosis::residual::data::{ChannelData, RunData};
use crate::diagnosis::residual::prediction::RunPrediction;
use crate::effects::Source;
use crate::math::fill::filled_complex;
use crate::measurement::Quantity;
use crate::structure::Structure;
use faer::c64;

/// Energy in J that the force channels of a run put in over one period, with the displacement amplitudes of harmonics 1.. (m) of a DOF.
pub(crate) fn input(run: &RunData, displacement: &dyn Fn(usize) -> Vec<c64>) -> f64 {
    let of_channel =
        |f: &ChannelData| action::work((1..).zip(displacement(f.dof)).zip(&f.measured).map(|((h, x), f)| (h, x, *f)));
    run.forces.iter().map(of_channel).sum()
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
    let x =
        filled_complex(structure.len(), factors.len(), |dof, k| factors[k] * prediction.response.amplitude(dof, k + 1));
    let numbers: Vec<usize> = (1..=factors.len()).collect();
    let field = Field { omega: run.omega, numbers: &numbers, x: &x };
    let model = |dof: usize| (0..factors.len()).map(|k| x[(dof, k)]).collect();
    let given = input(run, &|dof| measured_displacement(run, dof).unwrap_or_else(|| model(dof)));
    let lost: f64 = sources.iter().map(|source| action::energy(source, structure, field)).sum();
    if given == 0.0 { if lost == 0.0 { 0.0 } else { 1.0 } } else { ((given - lost) / given).abs() }
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

//! What derivatives by the model leave of its higher harmonics, being linear.
//!
//! Fundamentals are corrected at the measured motion, where they are linear in what the model states wrongly. What a law or the force
//! sends into modes above the band is not: a resonance that is off by more than its width answers with another amplitude altogether.
//! Where the parameters would change a harmonic by the share `s` of it within their priors, `s^2` of it is left, and no more than all of
//! it. (With what the data leave unknown of the parameters in place of the priors it was worse: what is known of them, linear as it is,
//! is itself wrong there.)

use super::noise_model::Linearisation;
use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::residual::prediction::RunPrediction;

/// `s^2` from which on a harmonic tells nothing of the model with or without an effect: modes off by twice their width.
const UNPREDICTABLE: f64 = 4.0;

/// Errors of the higher harmonics of all runs by the second order, `[run][channel][harmonic - 1]`, in units of the channels.
pub(crate) fn linearisation_error(
    data: &Data,
    linearisation: &Linearisation,
    predictions: &[RunPrediction],
) -> Vec<Vec<Vec<f64>>> {
    errors(data, linearisation, predictions, |square| square.min(1.0))
}

/// The same where a harmonic tells nothing, as none does where fundamentals alone count: all of it; elsewhere nothing.
pub(crate) fn unpredictable(
    data: &Data,
    linearisation: &Linearisation,
    predictions: &[RunPrediction],
) -> Vec<Vec<Vec<f64>>> {
    let unpredictable = |square: f64| square >= UNPREDICTABLE || linearisation.of_fundamentals;
    errors(data, linearisation, predictions, |square| f64::from(u8::from(unpredictable(square))))
}

/// Errors as shares of the amplitudes, each of `s^2`.
fn errors(
    data: &Data,
    linearisation: &Linearisation,
    predictions: &[RunPrediction],
    share: impl Fn(f64) -> f64,
) -> Vec<Vec<Vec<f64>>> {
    let of_run = |(r, (run, prediction)): (usize, (&RunData, &RunPrediction))| {
        let share_of = |h: usize| if h == 0 { 0.0 } else { share(square(linearisation, r, h, run, prediction)) };
        let shares: Vec<f64> = (0..run.harmonics).map(share_of).collect();
        let channel = |c: usize| shares.iter().enumerate().map(|(h, s)| s * size(run, prediction, c, h)).collect();
        (0..run.responses.len()).map(channel).collect()
    };
    data.runs.iter().zip(predictions).enumerate().map(of_run).collect()
}

/// Measured or predicted amplitude of harmonic index `h` of channel `c`, whichever is larger.
fn size(run: &RunData, prediction: &RunPrediction, c: usize, h: usize) -> f64 {
    run.responses[c].measured[h].norm().max(prediction.channels[c][h].norm())
}

/// `s^2` of harmonic index `h` of run `r`, over all its channels.
fn square(linearisation: &Linearisation, r: usize, h: usize, run: &RunData, prediction: &RunPrediction) -> f64 {
    let updating = &linearisation.updating;
    let [slopes, _] = linearisation.of_harmonic(r, h + 1);
    let by = |k: usize, c: usize| slopes[k][c].norm_sqr() / run.scale(c).powi(2);
    let of_model = (0..slopes.len()).filter(|&k| updating.parameters[k].is_of_model());
    let moved: f64 = of_model.flat_map(|k| run.alive.iter().map(move |&c| by(k, c))).sum();
    let total: f64 = run.alive.iter().map(|&c| (size(run, prediction, c, h) / run.scale(c)).powi(2)).sum();
    if total > 0.0 { moved / total } else { 0.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{source, three_masses};
    use crate::control::Control;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::prediction::Predictor;
    use crate::diagnosis::selection::reference_model::ReferenceModel;
    use crate::diagnosis::updating::parameters::Updating;
    use crate::effects::Effect;
    use crate::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
    use faer::{Mat, c64};
    use std::sync::Arc;

    /// A third harmonic in a resonance that is off by many of its widths tells nothing; one between resonances is left to the square of
    /// what models are wrong by.
    #[test]
    fn harmonics_in_narrow_resonances_tell_nothing() {
        let structure = three_masses([1.0; 3]);
        let matrices = structure.matrices().unwrap();
        let squares = matrices.stiffness.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let (first, last) = (squares[0].sqrt(), squares[2].sqrt());
        let channel_fit = |dof: usize, quantity, amplitudes: [f64; 3]| ChannelFit {
            channel: Channel { quantity, dof, label: format!("{}", dof + 1) },
            offset: 0.0,
            slope: 0.0,
            amplitudes: amplitudes.map(|a| c64::new(a, 0.0)).to_vec(),
            covariance: Mat::zeros(6, 6),
            noise: 0.0,
        };
        let run = |omega: f64| {
            let mut channels = vec![channel_fit(2, Quantity::Force, [1.0, 0.0, 0.0])];
            channels.extend((0..3).map(|d| channel_fit(d, Quantity::Displacement, [1e-3, 1e-6, 1e-5])));
            let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
            Run::from_harmonics(format!("{omega}"), None, true, fit, &[])
        };
        let runs: Vec<Run> = [last / 3.0, 0.7 * first, 0.72 * first, 0.74 * first].map(run).into();
        let sources = [source(Effect::Viscous, &[0], &[0.02])];
        let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Arc::new(Predictor::new(&structure, sources.to_vec(), &data).unwrap());
        let control = Control::unattended();
        let stated = ReferenceModel::new(predictor, &data, &control, &|_| {}).unwrap();
        let updating = Updating::all(&structure, &sources, &data);
        let reference = stated.doubting_harmonics().updated(&updating, &[], &Vec::new()).unwrap();
        let errors_by = |errors: fn(&Data, &Linearisation, &[RunPrediction]) -> Vec<Vec<Vec<f64>>>| {
            errors(&data, &reference.linearisation, &reference.predictions)
        };
        let (second_order, lost) = (errors_by(linearisation_error), errors_by(unpredictable));
        let fundamentals = Linearisation { of_fundamentals: true, ..(*reference.linearisation).clone() };
        let all_lost = unpredictable(&data, &fundamentals, &reference.predictions);
        for c in 0..3 {
            assert!(all_lost.iter().all(|run| run[c][0] == 0.0 && run[c][1] > 0.0 && run[c][2] > 0.0), "{all_lost:?}");
            assert!(second_order.iter().chain(&lost).all(|run| run[c][0] == 0.0));
            assert!((lost[0][c][2] - 1e-5).abs() < 1e-12 && (second_order[0][c][2] - 1e-5).abs() < 1e-12, "{lost:?}");
            assert!(lost[1][c][2] == 0.0 && second_order[1][c][2] < 0.3e-5, "{second_order:?}");
        }
    }
}

//! Errors of the mode shapes of a model of which no part is known by itself (imported, reduced matrices): a response channel `k`
//! shows mode `r` with `phi_r(k) + s_r e_rk` in place of `phi_r(k)`,
//!
//! ```text
//! dy_k / de_rk = s_r (phi_r^T M X) w_k,      s_r^2 = mean over the channels of phi_r(k)^2
//! ```
//!
//! with the motion `X` and the factor `w_k` from displacement to what is recorded (Friswell and Mottershead 1995, chapter 2:
//! modelling errors show in frequencies and in shapes).

use super::parameters::{Updating, UpdatingParameter};
use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use faer::c64;

/// What the shapes of the modes are wrong by, to be differentiated by.
pub(crate) struct ShapeErrors {
    modes: Vec<Mode>,
}

struct Mode {
    number: usize,
    /// `M phi`, kg^(1/2).
    weighted: Vec<f64>,
    /// `s`, kg^(-1/2).
    size: f64,
}

impl ShapeErrors {
    /// Of the modes of the model of `predictor` whose shapes are among the parameters of `updating`; none where no mode is.
    pub(crate) fn new(predictor: &Predictor, updating: &Updating, data: &Data) -> Self {
        let mut numbers: Vec<usize> = updating
            .parameters
            .iter()
            .filter_map(|p| if let UpdatingParameter::Shape { mode, .. } = p { Some(*mode) } else { None })
            .collect();
        numbers.dedup();
        let (Some(matrices), false) = (predictor.structure().matrices(), numbers.is_empty() || data.runs.is_empty())
        else {
            return Self { modes: Vec::new() };
        };
        let basis = predictor.run(0).linear().basis();
        let dofs: Vec<usize> = data.runs.iter().flat_map(|run| run.responses.iter().map(|c| c.dof)).collect();
        let mode = |number: usize| {
            let shape = basis.shape(number);
            let row = |i: usize| matrices.mass.col_as_slice(i).iter().zip(shape).map(|(m, x)| m * x).sum();
            let weighted = (0..shape.len()).map(row).collect();
            let square: f64 = dofs.iter().map(|&dof| shape[dof] * shape[dof]).sum();
            let size = (square / dofs.len().max(1) as f64).sqrt();
            Mode { number, weighted, size }
        };
        Self { modes: numbers.into_iter().filter(|&r| r < basis.len()).map(mode).collect() }
    }

    /// Derivatives of the recorded amplitudes of `run` by the error of mode `number` at `channel`, `[channel][harmonic - 1]`,
    /// at the predicted motion times the factor that fits the sensors best.
    pub(crate) fn slope(
        &self,
        number: usize,
        channel: &str,
        run: &RunData,
        prediction: &RunPrediction,
    ) -> Vec<Vec<c64>> {
        let mut slope = vec![vec![c64::new(0.0, 0.0); run.harmonics]; run.responses.len()];
        let Some(mode) = self.modes.iter().find(|mode| mode.number == number) else { return slope };
        let factors = scaled_factors(run, prediction);
        for (own, response) in slope.iter_mut().zip(&run.responses).filter(|(_, c)| c.name == channel) {
            for (i, value) in own.iter_mut().enumerate() {
                let amplitude = |dof: usize| prediction.response.amplitude(dof, i + 1);
                let modal: c64 = mode.weighted.iter().enumerate().map(|(dof, m)| amplitude(dof) * *m).sum();
                *value = modal * factors[i] * response.from_displacement((i + 1) as f64 * run.omega) * mode.size;
            }
        }
        slope
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::control::Control;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::prediction::FINAL;
    use crate::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
    use crate::structure::chain::ChainParameters;
    use faer::Mat;

    /// The derivatives of the modes add up to what the channel shows: `sum_r phi_r(k) / s_r dy_k / de_rk = y_k`.
    #[test]
    fn modes_add_up_to_the_response() {
        let ground_stiffness = vec![2e4, 0.0, 0.0];
        let chain =
            ChainParameters { masses: vec![1.0, 2.0, 1.5], ground_stiffness, coupling_stiffness: vec![1e4, 1.5e4] };
        let structure = chain.build(&[]).unwrap();
        let fit = |quantity, dof: usize, value: f64| ChannelFit {
            channel: Channel { quantity, dof, label: (dof + 1).to_string() },
            offset: 0.0,
            slope: 0.0,
            covariance: Mat::from_fn(2, 2, |i, j| if i == j { 1e-16 } else { 0.0 }),
            amplitudes: vec![c64::new(value, 0.0)],
            noise: 1e-8,
        };
        let channels = vec![fit(Quantity::Force, 0, 1.0), fit(Quantity::Displacement, 2, 1e-4)];
        let runs = [Run::from_harmonics(
            "1".into(),
            None,
            true,
            HarmonicFit { omega: 70.0, omega_deviation: 0.0, channels },
            &[],
        )];
        let data = Data::new(&Problem { structure: &structure, sources: &[], runs: &runs }).unwrap();
        let predictor = Predictor::new(&structure, Vec::new(), &data).unwrap();
        let run = &data.runs[0];
        let predicted = predictor.predict(0, run, &[], &FINAL, None, &Control::unattended()).unwrap();
        let channel = run.responses[0].name.clone();
        let shape = |mode| UpdatingParameter::Shape { mode, channel: channel.clone() };
        let updating = Updating { parameters: (0..3).map(shape).collect(), ..Updating::default() };
        let errors = ShapeErrors::new(&predictor, &updating, &data);
        let modes = structure.modes().unwrap();
        let dof = run.responses[0].dof;
        let sum: c64 = (0..3)
            .map(|r| {
                let slope = errors.slope(r, &channel, run, &predicted)[0][0];
                slope * (modes.shapes[(dof, r)] / errors.modes[r].size)
            })
            .sum();
        let expected = predicted.channels[0][0] * scaled_factors(run, &predicted)[0];
        assert!((sum - expected).norm() < 1e-9 * expected.norm(), "{sum} {expected}");
    }
}

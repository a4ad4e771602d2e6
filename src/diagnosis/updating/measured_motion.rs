//! Derivatives of the response by what the model states, taken at the measured motion rather than at the model's own:
//!
//! ```text
//! y - S A F = -S A dZ X - S A L f
//! ```
//!
//! holds exactly with the true motion `X`, however far off the model is; its own motion, off by a multiple near resonance,
//! would need small steps.

use super::modal_expansion::ModalExpansion;
use crate::control::Control;
use crate::diagnosis::localisation::location::Receptances;
use crate::diagnosis::residual::data::{ChannelData, Data};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::effects::Source;
use crate::response::sensitivity::{Unknown, pseudo_force};
use faer::c64;

/// Motion of all runs as the sensors show it, and the receptance of the model from every DOF to them.
pub(crate) struct MeasuredMotion<'a> {
    predictor: &'a Predictor,
    data: &'a Data,
    receptances: Receptances<'a>,
    /// Fundamental displacement by DOF, one list a run, m.
    fields: Vec<Vec<c64>>,
    /// What made them of the model's own motion.
    pub expansions: Vec<Option<ModalExpansion>>,
}

impl<'a> MeasuredMotion<'a> {
    /// Of the model of `predictor`, whose predictions without any effect these are; `None` where its receptance is singular.
    pub(crate) fn new(
        predictor: &'a Predictor,
        data: &'a Data,
        predictions: &[RunPrediction],
        control: &Control,
    ) -> Option<Self> {
        let mut receptances = Receptances::new(predictor, data, &[]);
        for channel in data.runs.iter().flat_map(|run| &run.responses) {
            receptances.need(channel.dof, control).ok()?;
        }
        let expansions = ModalExpansion::of_runs(predictor, data, predictions);
        let n = predictor.structure().len();
        let field = |(r, prediction): (usize, &RunPrediction)| {
            let mut field: Vec<c64> = (0..n).map(|dof| prediction.response.amplitude(dof, 1)).collect();
            if let Some(expansion) = &expansions[r] {
                expansion.correct(&data.runs[r], &mut field);
            }
            field
        };
        let fields = predictions.iter().enumerate().map(field).collect();
        Some(Self { predictor, data, receptances, fields, expansions })
    }

    /// Derivatives of the recorded fundamentals of run `r` by sums of unknowns with factors, `[sum][channel][harmonic - 1]`.
    pub(crate) fn slopes(&self, r: usize, sums: &[Vec<(Unknown, f64)>]) -> Vec<Vec<Vec<c64>>> {
        sums.iter().map(|sum| self.slope(r, self.predictor.known(), sum)).collect()
    }

    /// The same by one sum, whose sources are among `sources`, `[channel][harmonic - 1]`.
    pub(crate) fn slope(&self, r: usize, sources: &[Source], sum: &[(Unknown, f64)]) -> Vec<Vec<c64>> {
        let run = &self.data.runs[r];
        let (x, w) = (&self.fields[r], run.omega);
        let mut force = vec![c64::new(0.0, 0.0); x.len()];
        for (unknown, factor) in sum {
            if let Unknown::ForceScale(channel) = *unknown {
                let channel = &run.forces[channel];
                force[channel.dof] += channel.measured[0] * *factor;
                continue;
            }
            let own = pseudo_force(self.predictor.run(r), sources, *unknown, x, w);
            force.iter_mut().zip(own.unwrap_or_default()).for_each(|(f, own)| *f += own * *factor);
        }
        // A part of the structure acts at few of its DOFs.
        let acting: Vec<(usize, c64)> =
            force.into_iter().enumerate().filter(|(_, f)| *f != c64::new(0.0, 0.0)).collect();
        let channel = |channel: &ChannelData| {
            let moved = |&(dof, f): &(usize, c64)| self.receptances.entry(r, 1, dof, channel.dof) * f;
            let sum: c64 = acting.iter().map(moved).sum();
            let mut slope = vec![c64::new(0.0, 0.0); run.harmonics];
            slope[0] = sum * channel.from_displacement(w);
            slope
        };
        run.responses.iter().map(channel).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::prediction::FINAL;
    use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
    use crate::effects::{Effect, Place, Source};
    use crate::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
    use crate::response::harmonic_balance::{Excitation, ForwardModel};
    use crate::structure::chain::ChainParameters;
    use crate::structure::{Part, Structure};
    use faer::Mat;

    fn chain(factor: f64) -> Structure {
        let ground_stiffness = vec![2e4 * factor, 0.0, 0.0];
        ChainParameters { masses: vec![1.0; 3], ground_stiffness, coupling_stiffness: vec![1e4, 1.5e4] }
            .build(&[])
            .unwrap()
    }

    /// A light structure whose ground spring is 5 % stiffer than stated, driven through its first resonance: the change of
    /// the response is many times the response, yet the derivative at the measured motion gives it.
    #[test]
    fn the_change_of_the_response_is_linear_at_the_measured_motion() {
        let known = [Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[0.5])];
        let (stated, truth) = (chain(1.0), ForwardModel::new(&chain(1.05), &known).unwrap());
        let one = |name: usize, quantity, dof: usize, amplitude: c64| ChannelFit {
            channel: Channel { quantity, dof, label: format!("{}", name + 1) },
            offset: 0.0,
            slope: 0.0,
            amplitudes: vec![amplitude],
            covariance: Mat::zeros(2, 2),
            noise: 0.0,
        };
        let run = |omega: f64| {
            let excitation = Excitation::sine(omega, 2, c64::new(1.0, 0.0));
            let response = truth.at(omega).respond(&known, &excitation, &FINAL, None, &Control::unattended()).unwrap();
            let mut channels = vec![one(2, Quantity::Force, 2, c64::new(1.0, 0.0))];
            channels.extend((0..3).map(|d| one(d, Quantity::Displacement, d, response.amplitude(d, 1))));
            Run::from_harmonics(
                format!("{omega}"),
                None,
                true,
                HarmonicFit { omega, omega_deviation: 0.0, channels },
                &[],
            )
        };
        let runs: Vec<Run> = [40.0, 48.0, 49.0, 50.0, 60.0, 110.0].map(run).into();
        let problem = Problem { structure: &stated, sources: &known, runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Predictor::new(&stated, known.to_vec(), &data).unwrap();
        let control = Control::unattended();
        let predict = |(r, run)| predictor.predict_well(r, run, &[], None, &control).unwrap();
        let predictions: Vec<RunPrediction> = data.runs.iter().enumerate().map(predict).collect();
        let seen = MeasuredMotion::new(&predictor, &data, &predictions, &control).unwrap();
        let updating = Updating::all(&stated, &known, &data);
        let spring = UpdatingParameter::Structure(Part::GroundSpring(0));
        let k = updating.parameters.iter().position(|p| *p == spring).unwrap();
        let sum = updating.unknowns(k, &known, &data.runs[0]);
        for (r, run) in data.runs.iter().enumerate() {
            let slope = seen.slope(r, &known, &sum);
            for c in 0..3 {
                let change = run.responses[c].measured[0] - predictions[r].channels[c][0];
                let off = (change - slope[c][0] * 0.05).norm();
                assert!(off < 0.02 * change.norm(), "run {r} channel {c}: {off} of {}", change.norm());
            }
        }
    }
}

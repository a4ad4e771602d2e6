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
use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::effects::Source;
use crate::response::sensitivity::{Unknown, pseudo_force};
use faer::c64;

/// Motion of all runs as the sensors show it, and the receptance of the model from every DOF to them.
pub(crate) struct MeasuredMotion<'a> {
    predictor: &'a Predictor,
    data: &'a Data,
    receptances: Receptances<'a>,
    /// Displacement by DOF, `[run][harmonic - 1][dof]`, m.
    fields: Vec<Vec<Vec<c64>>>,
    /// What made them of the model's own motion, `[run][harmonic - 1]`.
    pub expansions: Vec<Vec<Option<ModalExpansion>>>,
}

impl<'a> MeasuredMotion<'a> {
    /// Of the model of `predictor`, whose predictions without any effect these are, up to the harmonic `highest`; `None` where its
    /// receptance is singular.
    pub(crate) fn new(
        predictor: &'a Predictor,
        data: &'a Data,
        predictions: &[RunPrediction],
        highest: usize,
        control: &Control,
    ) -> Option<Self> {
        let mut receptances = Receptances::new(predictor, data, &[]);
        for channel in data.runs.iter().flat_map(|run| &run.responses) {
            receptances.need(channel.dof, control).ok()?;
        }
        let expansions = ModalExpansion::of_runs(predictor, data, predictions, highest);
        let n = predictor.structure().len();
        let field = |r: usize, h: usize| {
            let mut field: Vec<c64> = (0..n).map(|dof| predictions[r].response.amplitude(dof, h)).collect();
            if let Some(expansion) = &expansions[r][h - 1] {
                expansion.correct(&data.runs[r], h, &mut field);
            }
            field
        };
        let of_run = |(r, run): (usize, &RunData)| (1..=run.harmonics.min(highest)).map(|h| field(r, h)).collect();
        let fields = data.runs.iter().enumerate().map(of_run).collect();
        Some(Self { predictor, data, receptances, fields, expansions })
    }

    /// Derivatives of the recorded amplitudes of run `r` by sums of unknowns with factors, `[sum][channel][harmonic - 1]`.
    pub(crate) fn slopes(&self, r: usize, sums: &[Vec<(Unknown, f64)>]) -> Vec<Vec<Vec<c64>>> {
        sums.iter().map(|sum| self.slope(r, self.predictor.known(), sum)).collect()
    }

    /// The same by one sum, whose sources are among `sources`, `[channel][harmonic - 1]`.
    pub(crate) fn slope(&self, r: usize, sources: &[Source], sum: &[(Unknown, f64)]) -> Vec<Vec<c64>> {
        let run = &self.data.runs[r];
        let mut slope = vec![vec![c64::new(0.0, 0.0); run.harmonics]; run.responses.len()];
        for h in 1..=self.fields[r].len() {
            let force = self.force(r, h, sources, sum);
            for (slope, channel) in slope.iter_mut().zip(&run.responses) {
                let moved = |&(dof, f): &(usize, c64)| self.receptances.entry(r, h, dof, channel.dof) * f;
                slope[h - 1] = force.iter().map(moved).sum::<c64>() * channel.from_displacement(h as f64 * run.omega);
            }
        }
        slope
    }

    /// The force `-dZ X` (N) of a sum at harmonic `h` of run `r`, at the DOFs at which it acts: a part of the structure acts at few.
    fn force(&self, r: usize, h: usize, sources: &[Source], sum: &[(Unknown, f64)]) -> Vec<(usize, c64)> {
        let run = &self.data.runs[r];
        let (x, w) = (&self.fields[r][h - 1], h as f64 * run.omega);
        let mut force = vec![c64::new(0.0, 0.0); x.len()];
        for (unknown, factor) in sum {
            if let Unknown::ForceScale(channel) = *unknown {
                let channel = &run.forces[channel];
                force[channel.dof] += channel.measured[h - 1] * *factor;
                continue;
            }
            let own = pseudo_force(self.predictor.run(r), sources, *unknown, x, w);
            force.iter_mut().zip(own.unwrap_or_default()).for_each(|(f, own)| *f += own * *factor);
        }
        force.into_iter().enumerate().filter(|(_, f)| *f != c64::new(0.0, 0.0)).collect()
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
    use crate::response::harmonic_balance::{Excitation, ForwardModel, HarmonicForce};
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
    /// the response is many times the response, yet the derivative at the measured motion gives it, also at the second harmonic.
    #[test]
    fn the_change_of_the_response_is_linear_at_the_measured_motion() {
        let known = [Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[0.5])];
        let (stated, truth) = (chain(1.0), ForwardModel::new(&chain(1.05), &known).unwrap());
        let force = [c64::new(1.0, 0.0), c64::new(0.2, 0.1)];
        let channel_fit = |name: usize, quantity, dof: usize, amplitudes: [c64; 2]| ChannelFit {
            channel: Channel { quantity, dof, label: format!("{}", name + 1) },
            offset: 0.0,
            slope: 0.0,
            amplitudes: amplitudes.to_vec(),
            covariance: Mat::zeros(4, 4),
            noise: 0.0,
        };
        let run = |omega: f64| {
            let forces = vec![HarmonicForce { dof: 2, mean: 0.0, harmonics: force.to_vec() }];
            let excitation = Excitation { omega, forces };
            let response = truth.at(omega).respond(&known, &excitation, &FINAL, None, &Control::unattended()).unwrap();
            let mut channels = vec![channel_fit(2, Quantity::Force, 2, force)];
            let motion = |d: usize| [1, 2].map(|h| response.amplitude(d, h));
            channels.extend((0..3).map(|d| channel_fit(d, Quantity::Displacement, d, motion(d))));
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
        let seen = MeasuredMotion::new(&predictor, &data, &predictions, 2, &control).unwrap();
        let updating = Updating::all(&stated, &known, &data);
        let spring = UpdatingParameter::Structure(Part::GroundSpring(0));
        let k = updating.parameters.iter().position(|p| *p == spring).unwrap();
        let sum = updating.unknowns(k, &known, &data.runs[0]);
        for (r, run) in data.runs.iter().enumerate() {
            let slope = seen.slope(r, &known, &sum);
            for (c, h) in (0..3).flat_map(|c| [(c, 0), (c, 1)]) {
                let change = run.responses[c].measured[h] - predictions[r].channels[c][h];
                let off = (change - slope[c][h] * 0.05).norm();
                assert!(off < 0.02 * change.norm(), "run {r} channel {c} {h}: {off} of {}", change.norm());
            }
        }
    }
}

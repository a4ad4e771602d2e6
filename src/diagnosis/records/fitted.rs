//! A model with the parameters that were fitted to some records, and what it predicts.

use super::data::{RecordDiagnosisError, Records};
use super::errors::channel_errors;
use super::steps::Steps;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::response::transient::{TransientParameter, TransientResponse};
use std::sync::Arc;

/// A model with the parameters that were fitted.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FittedRecords {
    /// Added effects.
    pub effects: Vec<Source>,
    /// Logarithm of the factor on all stiffness.
    pub stiffness: f64,
    /// Logarithms of the factors on the known sources.
    pub known: Vec<f64>,
    /// Logarithms of the factors on the damping that laws of the whole structure give the followed modes; empty where it is not
    /// corrected.
    pub damping: Vec<f64>,
    /// Logarithms of the factors on the stiffness of the followed modes.
    pub modes: Vec<f64>,
    /// Logarithm of the factor on all mass.
    pub mass: f64,
    /// Deviations of the parts of the structure along their directions ([`super::part_directions`]).
    pub parts: Vec<f64>,
    /// Errors of the shapes of the followed modes at every sensor, `[sensor][mode]` ([`super::shape_errors`]).
    pub shapes: Vec<Vec<f64>>,
    /// Offsets of the channels of each record over their largest samples, `[record][channel]`.
    pub offsets: Vec<Vec<f64>>,
    /// Logarithm of the factor on the stiffness of each record.
    pub shifts: Vec<f64>,
    /// Initial state of each record.
    pub initial: Vec<Vec<f64>>,
    /// Weighted squared residual without the priors.
    pub chi_square: f64,
    /// Squared corrections over their prior deviations.
    pub prior: f64,
    /// Number of samples in it.
    pub count: usize,
    /// Samples over which what a model leaves stays alike, because it is an error of the model ([`super::evidence`]); at least 1.
    pub alike: f64,
    /// Standard deviations of the parameters of the effects, then of stiffness, of the known sources, of the damping and
    /// the stiffness of the modes, of mass and of
    /// the shapes, in units of the noise that was stated.
    pub deviations: Vec<f64>,
    /// What is left, over the noise: `[record][channel][sample]`; shared, for a fit is copied at every step.
    pub residual: Arc<Vec<Vec<Vec<f64>>>>,
}

impl FittedRecords {
    /// The model as it is, at rest.
    pub(crate) fn start(records: &Records, effects: &[Source]) -> Self {
        Self {
            effects: effects.to_vec(),
            stiffness: 0.0,
            known: vec![0.0; records.known.len()],
            damping: vec![0.0; records.damped()],
            modes: vec![0.0; records.kept],
            mass: 0.0,
            parts: vec![0.0; records.parts.len()],
            shapes: records.no_shape_errors(),
            offsets: records.no_offsets(),
            shifts: vec![0.0; records.list.len()],
            initial: vec![vec![0.0; 2 * records.kept]; records.list.len()],
            chi_square: f64::INFINITY,
            prior: 0.0,
            count: 0,
            alike: 1.0,
            deviations: Vec::new(),
            residual: Arc::default(),
        }
    }

    /// Whether the last effect is a mass or a spring.
    pub(super) fn adds_constant(&self) -> bool {
        self.effects.last().is_some_and(|e| e.effect.is_mass_or_spring())
    }

    /// Known sources at their factors, then the effects.
    pub(crate) fn sources(&self, records: &Records) -> Vec<Source> {
        let sized = |(source, v): (&Source, &f64)| {
            let mut source = source.clone();
            source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= v.exp());
            source
        };
        records.known.iter().zip(&self.known).map(sized).chain(self.effects.iter().cloned()).collect()
    }

    /// Factors on all stiffness and on all mass in record `r`.
    pub(super) fn factors(&self, r: usize) -> [f64; 2] {
        [(self.stiffness + self.shifts[r]).exp(), self.mass.exp()]
    }

    /// The record of number `r` that the model gives over `samples` samples.
    pub(crate) fn predict(
        &self,
        records: &Records,
        r: usize,
        samples: usize,
        parameters: &[TransientParameter],
    ) -> Result<TransientResponse, RecordDiagnosisError> {
        self.predict_in(Steps::Fine, records, r, samples, parameters)
    }

    /// The same in steps of some length.
    pub(super) fn predict_in(
        &self,
        steps: Steps,
        records: &Records,
        r: usize,
        samples: usize,
        parameters: &[TransientParameter],
    ) -> Result<TransientResponse, RecordDiagnosisError> {
        let record = &records.list[r];
        let parts = records.parts.logarithms(&self.parts);
        let model = records.model(
            record,
            &self.sources(records),
            self.factors(r),
            [&self.modes, &self.damping],
            &parts,
            &self.shapes,
        )?;
        let forces = record.excitation_in(samples, model.is_linear(), steps);
        let mut response = model
            .predict(&forces, &self.initial[r], parameters)
            .map_err(|reason| RecordDiagnosisError::Model { file: record.file.clone(), reason })?;
        for (c, (channel, offset)) in response.channels.iter_mut().zip(&self.offsets[r]).enumerate() {
            let offset = offset * record.largest[c];
            channel.iter_mut().for_each(|y| *y += offset);
        }
        Ok(response)
    }

    /// The same without what no project states: errors of shapes, gains and offsets of channels, shifts of records.
    pub(super) fn stated(&self, records: &Records) -> Self {
        Self {
            shapes: records.no_shape_errors(),
            offsets: records.no_offsets(),
            shifts: vec![0.0; records.list.len()],
            ..self.clone()
        }
    }

    /// Relative error of the model over samples `from..to` (shares of the length of every record).
    pub(crate) fn error(&self, records: &Records, from: f64, to: f64) -> Result<f64, RecordDiagnosisError> {
        let mut errors = Vec::new();
        for (r, record) in records.list.iter().enumerate() {
            let last = (to * record.len() as f64) as usize;
            let first = (from * record.len() as f64) as usize;
            let response = self.predict(records, r, last.max(2), &[])?;
            errors.extend(channel_errors(record, &response.channels, first..last.max(2)));
        }
        Ok(root_mean_square(&errors))
    }

    /// A fit of nothing but effects, for tests of what is chosen among fits.
    #[cfg(test)]
    pub(super) fn of_effects(effects: Vec<Source>, chi_square: f64) -> Self {
        Self {
            effects,
            stiffness: 0.0,
            known: Vec::new(),
            damping: Vec::new(),
            modes: Vec::new(),
            mass: 0.0,
            parts: Vec::new(),
            shapes: Vec::new(),
            offsets: Vec::new(),
            shifts: Vec::new(),
            initial: Vec::new(),
            chi_square,
            prior: 0.0,
            count: 1,
            alike: 1.0,
            deviations: Vec::new(),
            residual: Arc::default(),
        }
    }
}

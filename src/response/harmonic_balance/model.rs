//! The model of a structure with its sources, prepared to be asked for its periodic response.

use super::compliance::{Compliance, LinearPart};
use super::error::ModelError;
use super::excitation::Excitation;
use super::fourier::Fourier;
use super::resonant::Pattern;
use crate::effects::{Leg, Source};
use crate::structure::Structure;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Mass, stiffness and sources of a structure, checked and prepared.
#[derive(Debug, Clone)]
pub struct ForwardModel {
    linear: Arc<LinearPart>,
    sources: Vec<Source>,
    tables: Arc<Tables>,
}

/// Sampled cosines and sines by number of harmonics and samples, made once.
#[derive(Debug, Default)]
pub(crate) struct Tables(Mutex<BTreeMap<(usize, usize), Arc<Fourier>>>);

impl Tables {
    pub(super) fn get(&self, harmonics: usize, samples: usize) -> Arc<Fourier> {
        let mut tables = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        tables.entry((harmonics, samples)).or_insert_with(|| Arc::new(Fourier::new(harmonics, samples))).clone()
    }
}

impl ForwardModel {
    /// Prepares `structure` with `sources`. Every source given acts with its parameters, whatever its state; effects of
    /// channels are left out.
    pub fn new(structure: &Structure, sources: &[Source]) -> Result<Self, ModelError> {
        check(sources, structure.len())?;
        let linear = LinearPart::new(Arc::new(structure.clone()), sources)?;
        Ok(Self { linear: Arc::new(linear), sources: sources.to_vec(), tables: Arc::default() })
    }

    /// Sources that act.
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        self.linear.structure()
    }

    /// The model at one fundamental frequency (rad/s), which keeps the structure's receptance for many sources.
    pub fn at(&self, omega: f64) -> RunModel {
        RunModel {
            omega,
            linear: self.linear.clone(),
            tables: self.tables.clone(),
            compliances: Arc::default(),
            apart: true,
            summed: false,
        }
    }

    /// As [`Self::at`], but no mode is set apart at resonance, so that the unknowns are the same at every frequency.
    pub(crate) fn plain_at(&self, omega: f64) -> RunModel {
        RunModel { apart: false, ..self.at(omega) }
    }
}

/// Most harmonics a response may have.
pub(crate) const MOST_HARMONICS: usize = 255;

/// The structure at one fundamental frequency: its receptance at every harmonic, computed when first asked for and kept.
/// Any sources may be put on it. Cloning shares what was computed.
#[derive(Debug, Clone)]
pub struct RunModel {
    omega: f64,
    linear: Arc<LinearPart>,
    tables: Arc<Tables>,
    compliances: Arc<Receptances>,
    /// Whether modes at resonance are set apart.
    apart: bool,
    /// Whether modes are summed rather than matrices inverted.
    summed: bool,
}

/// Receptance per harmonic, 0 first.
#[derive(Debug)]
struct Receptances(Vec<OnceLock<Compliance>>);

impl Default for Receptances {
    fn default() -> Self {
        Self((0..=MOST_HARMONICS).map(|_| OnceLock::new()).collect())
    }
}

impl RunModel {
    /// The same with all stiffness multiplied by `factor`: of one run alone, and asked for few entries.
    pub(crate) fn stiffened(&self, factor: f64) -> Self {
        let linear = Arc::new(self.linear.stiffened(factor));
        Self { linear, compliances: Arc::default(), summed: true, ..self.clone() }
    }

    /// Fundamental circular frequency, rad/s.
    pub fn omega(&self) -> f64 {
        self.omega
    }

    /// Number of degrees of freedom.
    pub fn len(&self) -> usize {
        self.linear.len()
    }

    /// Whether there is no degree of freedom; never true.
    pub fn is_empty(&self) -> bool {
        self.linear.len() == 0
    }

    pub(crate) fn compliance(&self, h: usize) -> &Compliance {
        self.compliances.0[h].get_or_init(|| self.linear.compliance(h as f64 * self.omega, self.apart, self.summed))
    }

    /// Static compliance of the linear structure between the DOFs of a leg, m/N; 0 where it is free to move there.
    pub(crate) fn static_compliance(&self, leg: Leg) -> f64 {
        let own = self.compliance(0).between(Pattern::Leg(leg), Pattern::Leg(leg)).re;
        if own.is_finite() { own.max(0.0) } else { 0.0 }
    }

    pub(crate) fn linear(&self) -> &LinearPart {
        &self.linear
    }

    pub(crate) fn table(&self, harmonics: usize, samples: usize) -> Arc<Fourier> {
        self.tables.get(harmonics, samples)
    }

    /// This model if its whole-structure laws are those of `sources`, else one with them.
    pub(crate) fn fitting(&self, sources: &[Source]) -> Self {
        if self.linear.has_whole(sources) {
            return self.clone();
        }
        let linear = Arc::new(self.linear.with_whole(sources));
        // Such a model is asked for one response or two before the laws change again.
        Self { linear, compliances: Arc::default(), summed: true, ..self.clone() }
    }

    /// This model at the excitation's frequency with the whole-structure laws of `sources`, all places checked.
    pub(super) fn ready(&self, sources: &[Source], excitation: &Excitation) -> Result<Self, ModelError> {
        check(sources, self.len())?;
        for force in &excitation.forces {
            check_dof(force.dof, self.len())?;
        }
        if excitation.omega == self.omega {
            return Ok(self.fitting(sources));
        }
        Ok(Self { omega: excitation.omega, compliances: Arc::default(), ..self.clone() }.fitting(sources))
    }
}

fn check_dof(dof: usize, size: usize) -> Result<(), ModelError> {
    if dof < size { Ok(()) } else { Err(ModelError::NoSuchDof { dof, size }) }
}

/// Sources within the structure, of finite parameters.
fn check(sources: &[Source], size: usize) -> Result<(), ModelError> {
    for (index, source) in sources.iter().enumerate() {
        for leg in source.place.legs() {
            check_dof(leg.first, size)?;
            leg.second.map_or(Ok(()), |dof| check_dof(dof, size))?;
        }
        for (parameter, &value) in source.effect.parameters().iter().zip(&source.parameters) {
            if !value.is_finite() {
                let effect = source.effect.name();
                return Err(ModelError::BadParameter { source_index: index, effect, parameter: parameter.name, value });
            }
        }
    }
    Ok(())
}

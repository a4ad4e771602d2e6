//! The model of a structure with its sources, prepared to be asked for its periodic response.

use super::compliance::{Compliance, LinearPart};
use super::fourier::Fourier;
use super::outcome::{Response, ResponseError};
use crate::control::Control;
use crate::effects::{Leg, Source};
use crate::structure::Structure;
use faer::c64;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Why a forward model cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// `points` structures have no equation of motion.
    #[error(
        "the structure has no mass and stiffness matrices, so its response cannot be predicted: give kind \"beam\", \"chain\" or \"matrices\""
    )]
    NoMatrices,
    /// Cholesky factors of the mass do not exist.
    #[error("the mass matrix is not positive definite: every degree of freedom needs mass")]
    MassNotPositive,
    /// Eigenvalues were not found.
    #[error("the natural modes were not found: {reason}")]
    NoModes {
        /// What went wrong.
        reason: String,
    },
    /// A DOF beyond the matrices.
    #[error("a source or force acts on row {dof} of {size} degrees of freedom (counted from zero)")]
    NoSuchDof {
        /// Row asked for.
        dof: usize,
        /// Rows there are.
        size: usize,
    },
    /// A parameter that is not a number.
    #[error("parameter `{parameter}` of source {source_index} ({effect}) is {value}: give a finite number")]
    BadParameter {
        /// Index in the list of sources.
        source_index: usize,
        /// Its law.
        effect: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// Value given.
        value: f64,
    },
    /// Negative stiffness or mass that makes the model resonate without damping.
    #[error(
        "the linear sources make the model singular at {frequency_hz:.6} Hz: a negative stiffness or mass balances the structure exactly"
    )]
    SingularSources {
        /// Frequency, Hz.
        frequency_hz: f64,
    },
}

/// A periodic force on one DOF.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicForce {
    /// Row of the matrices.
    pub dof: usize,
    /// Static part, N.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1, 2, ..., N.
    pub harmonics: Vec<c64>,
}

impl HarmonicForce {
    /// Complex amplitude of harmonic `h`, N; 0 is the static part.
    pub fn amplitude(&self, h: usize) -> c64 {
        match h {
            0 => c64::new(self.mean, 0.0),
            h => self.harmonics.get(h - 1).copied().unwrap_or(c64::new(0.0, 0.0)),
        }
    }

    pub(crate) fn leg(&self) -> Leg {
        Leg { first: self.dof, second: None }
    }
}

/// Forces below this share of all shape no motion.
const SMALL_SHARE: f64 = 0.05;

/// What drives the structure in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Forces.
    pub forces: Vec<HarmonicForce>,
}

impl Excitation {
    /// A sinusoidal force `Re amplitude exp(i omega t)` at one DOF; `omega` in rad/s, `amplitude` in N.
    pub fn sine(omega: f64, dof: usize, amplitude: c64) -> Self {
        Self { omega, forces: vec![HarmonicForce { dof, mean: 0.0, harmonics: vec![amplitude] }] }
    }

    /// Whether all forces have odd harmonics only.
    pub(crate) fn is_odd(&self) -> bool {
        let even = |force: &HarmonicForce| {
            force.mean == 0.0 && force.harmonics.iter().skip(1).step_by(2).all(|f| f.norm_sqr() == 0.0)
        };
        self.forces.iter().all(even)
    }

    /// Highest harmonic of the forces.
    pub fn order(&self) -> usize {
        self.forces.iter().map(|force| force.harmonics.len()).max().unwrap_or(0)
    }

    /// Highest harmonic above which there is only a small share of the forces.
    pub(crate) fn essential(&self) -> usize {
        let power = |h: usize| self.forces.iter().map(|force| force.amplitude(h).norm_sqr()).sum::<f64>();
        let powers: Vec<f64> = (1..=self.order()).map(power).collect();
        let small = SMALL_SHARE * SMALL_SHARE * powers.iter().sum::<f64>();
        let above = powers.iter().rev().scan(0.0, |sum, p| {
            *sum += p;
            Some(*sum)
        });
        self.order() - above.take_while(|&sum| sum <= small).count()
    }

    /// The same forces at another frequency (rad/s).
    #[must_use]
    pub fn at(&self, omega: f64) -> Self {
        Self { omega, forces: self.forces.clone() }
    }

    /// All forces multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        for force in &mut scaled.forces {
            force.mean *= factor;
            force.harmonics.iter_mut().for_each(|f| *f *= factor);
        }
        scaled
    }
}

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
    pub fn get(&self, harmonics: usize, samples: usize) -> Arc<Fourier> {
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

    /// The same structure with other sources; nothing of the structure is computed again.
    pub fn with_sources(&self, sources: &[Source]) -> Result<Self, ModelError> {
        check(sources, self.linear.len())?;
        let linear = if self.linear.has_whole(sources) {
            self.linear.clone()
        } else {
            Arc::new(self.linear.with_whole(sources))
        };
        Ok(Self { linear, sources: sources.to_vec(), tables: self.tables.clone() })
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

    /// Periodic response to `excitation`; `start` is a response nearby (other force, frequency or sources).
    pub fn respond(
        &self,
        excitation: &Excitation,
        settings: &super::Settings,
        start: Option<&Response>,
        control: &Control,
    ) -> Result<Response, ResponseError> {
        self.at(excitation.omega).respond(&self.sources, excitation, settings, start, control)
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
    /// The same with all stiffness multiplied by `factor`.
    pub(crate) fn stiffened(&self, factor: f64) -> Self {
        Self { linear: Arc::new(self.linear.stiffened(factor)), compliances: Arc::default(), ..self.clone() }
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

    /// Periodic response with `sources` (in place of those of the model) to `excitation`, whose frequency is that of
    /// this run; `start` is a response nearby.
    pub fn respond(
        &self,
        sources: &[Source],
        excitation: &Excitation,
        settings: &super::Settings,
        start: Option<&Response>,
        control: &Control,
    ) -> Result<Response, ResponseError> {
        let at = self.ready(sources, excitation)?;
        super::solve::respond(&at, sources, excitation, settings, start, control)
    }

    /// All periodic responses to `excitation` that lie on the curve of the response against the level of the force, up to
    /// three times the force, each with whether small disturbances die out; several where stiffness laws fold that curve.
    pub fn branches(
        &self,
        sources: &[Source],
        excitation: &Excitation,
        settings: &super::Settings,
        control: &Control,
    ) -> Result<Vec<(Response, bool)>, ResponseError> {
        let at = self.ready(sources, excitation)?;
        super::solve::branches(&at, sources, excitation, settings, control)
    }

    /// This model at the excitation's frequency with the whole-structure laws of `sources`, all places checked.
    fn ready(&self, sources: &[Source], excitation: &Excitation) -> Result<Self, ModelError> {
        check(sources, self.len())?;
        for force in &excitation.forces {
            check_dof(force.dof, self.len())?;
        }
        if excitation.omega == self.omega {
            return Ok(self.fitting(sources));
        }
        Ok(Self { omega: excitation.omega, compliances: Arc::default(), ..self.clone() }.fitting(sources))
    }

    /// Fundamental frequency, Hz.
    pub fn frequency_hz(&self) -> f64 {
        self.omega / TAU
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_of_noise_are_not_essential() {
        let real = |x: &f64| c64::new(*x, 0.0);
        let of = |values: &[f64]| {
            let harmonics = values.iter().map(real).collect();
            Excitation { omega: 1.0, forces: vec![HarmonicForce { dof: 0, mean: 0.0, harmonics }] }.essential()
        };
        assert_eq!(of(&[1.0]), 1);
        assert_eq!(of(&[1.0, 0.01, 0.02, 0.0]), 1);
        assert_eq!(of(&[1.0, 0.01, 0.2, 0.03]), 3);
        assert_eq!(of(&[0.0, 0.0]), 0);
    }
}

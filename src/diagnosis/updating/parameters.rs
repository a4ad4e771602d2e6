//! Updating parameters: what a model states wrongly and a measuring chain reads wrongly, with priors whose scales are
//! estimated from the data.
//!
//! Models are never exact: natural frequencies are off by some per cent, known damping by tens, gains by one. Every
//! parameter is the logarithm `v` of a factor (a delay: seconds; the size of a source at a place: `size_factor`) with the prior
//! `N(0, s^2)`; `s` belongs to its class ([`Scales`]), so that it moves only so far as the data ask for it (Friswell and
//! Mottershead 1995, chapter 8).

use super::parts::{damped_modes, mode_couplings, parts};
use super::scales::Scales;
use crate::diagnosis::residual::data::{Data, RunData};
use crate::effects::{Effect, Place, Source};
use crate::response::sensitivity::Unknown;
use crate::structure::{Part, Structure};

/// Prior deviation of a support in multiples of that of the size of a known source: of a clamp that is taken for rigid, half
/// may be left.
const SUPPORT: f64 = 2.0;
/// Logarithm of the factor of a support that gives way as much as the element beside it.
const GIVES_WAY: f64 = -std::f64::consts::LN_2;

/// One updating parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum UpdatingParameter {
    /// Factor on a part of the structure.
    Structure(Part),
    /// Factor on the size of one known source.
    Known(usize),
    /// Factor that a response channel reads too large.
    Gain(String),
    /// Factor that a force channel reads too large.
    ForceGain(String),
    /// Time that a channel is recorded late, s.
    Delay(String),
    /// Factor on all stiffness in one session (a joint that was re-seated, another day), by its number among those of the data.
    Session(usize),
}

impl UpdatingParameter {
    /// Place of its class in [`Scales::list`].
    pub fn class(&self) -> usize {
        match self {
            // A support is known about as well as the size of a source.
            Self::Structure(Part::Support(_)) | Self::Known(_) => 1,
            Self::Structure(Part::ModeDamping(_)) => 7,
            Self::Structure(Part::ModeDampingPerOctave(_)) => 8,
            Self::Structure(_) => 0,
            Self::Gain(_) | Self::ForceGain(_) => 2,
            Self::Delay(_) => 3,
            Self::Session(_) => 6,
        }
    }

    /// Whether predictions contain it; gains and delays of responses only multiply them.
    pub fn is_of_model(&self) -> bool {
        matches!(self, Self::Structure(_) | Self::Known(_) | Self::Session(_) | Self::ForceGain(_))
    }

    /// Whether it corrects what the model states, rather than telling how tests differ.
    pub fn is_stated(&self) -> bool {
        matches!(self, Self::Structure(_) | Self::Known(_))
    }
}

/// Updating parameters with their values and the scales of their priors.
#[derive(Debug, Clone, PartialEq)]
pub struct Updating {
    /// What is updated.
    pub parameters: Vec<UpdatingParameter>,
    /// Logarithm of the factor of each; of a delay its seconds, of the size of a known source that may be absent as `size_factor`
    /// says.
    pub values: Vec<f64>,
    /// Known sources that may be absent, by their numbers: those at a place. What damps the whole structure is there in some size.
    pub may_be_absent: Vec<usize>,
    /// Prior deviation of each as a multiple of the scale of its class; none: one.
    pub spreads: Vec<f64>,
    /// Relative stiffness of each run beyond that of all, where the model is linearised; none: all alike.
    pub shifts: Vec<f64>,
    /// Number of the session of each run.
    pub sessions: Vec<usize>,
    /// Prior deviations.
    pub scales: Scales,
    /// Geometric mean of the circular frequencies of the runs, rad/s: turns the scale of phases into one of delays.
    pub omega: f64,
    /// What each parameter does to the loads of a moving base, as degrees of freedom with slopes; none: no base moves.
    pub load_slopes: Vec<Vec<(usize, f64)>>,
}

impl Default for Updating {
    fn default() -> Self {
        Self {
            parameters: Vec::new(),
            values: Vec::new(),
            may_be_absent: Vec::new(),
            spreads: Vec::new(),
            shifts: Vec::new(),
            sessions: Vec::new(),
            scales: Scales::START,
            omega: 1.0,
            load_slopes: Vec::new(),
        }
    }
}

impl Updating {
    /// Everything that may be wrong, not wrong yet.
    pub fn all(structure: &Structure, known: &[Source], data: &Data) -> Self {
        let omegas: Vec<f64> = data.runs.iter().map(|run| run.omega).collect();
        let parts = parts(structure, &omegas);
        let couplings = mode_couplings(structure, &parts, data);
        let mut parameters: Vec<UpdatingParameter> = parts
            .into_iter()
            .chain(couplings)
            .chain(damped_modes(structure, known, data))
            .filter(|part| !data.is_ruled_out(*part))
            .map(UpdatingParameter::Structure)
            .collect();
        parameters.extend((0..known.len()).map(UpdatingParameter::Known));
        let [responses, forces] = data.channel_names();
        // One channel alone cannot be told from the force; of several, each may be off.
        if responses.len() > 1 {
            parameters.extend(responses.iter().cloned().map(UpdatingParameter::Gain));
            parameters.extend(responses.into_iter().map(UpdatingParameter::Delay));
        }
        // The sizes of laws that depend on the amplitude are known no better than the force; of frequency responses to one force its gain
        // is that of all sensors.
        if !data.per_unit_force || forces.len() > 1 {
            parameters.extend(forces.into_iter().map(UpdatingParameter::ForceGain));
        }
        let sessions = data.sessions.iter().max().map_or(0, |last| last + 1);
        if sessions > 1 {
            parameters.extend((0..sessions).map(UpdatingParameter::Session));
        }
        let logs = omegas.iter().map(|w| w.ln()).sum::<f64>() / omegas.len().max(1) as f64;
        let spreads = parameters.iter().map(spread).collect();
        let sessions = data.sessions.clone();
        let at_place = |j: &usize| !matches!(known[*j].place, Place::Whole(_));
        Self {
            values: vec![0.0; parameters.len()],
            parameters,
            may_be_absent: (0..known.len()).filter(at_place).collect(),
            spreads,
            sessions,
            omega: logs.exp(),
            ..Self::default()
        }
        .with_base_loads(structure, data)
        .with_scales(Scales::SEARCH)
    }

    /// Number of parameters.
    pub fn len(&self) -> usize {
        self.parameters.len()
    }

    /// Whether modes are corrected, for want of parts that are known.
    pub fn is_by_modes(&self) -> bool {
        self.parameters.iter().any(|p| matches!(p, UpdatingParameter::Structure(Part::Mode(_))))
    }

    /// These parameters with one support or several given way: half the stiffness at a held DOF is the support's, half the
    /// element's.
    pub(crate) fn giving_way(&self) -> Vec<Self> {
        let is_support = |k: &usize| matches!(self.parameters[*k], UpdatingParameter::Structure(Part::Support(_)));
        let supports: Vec<usize> = (0..self.len()).filter(is_support).collect();
        let with = |subset: usize| {
            let mut values = self.values.clone();
            for (bit, &k) in supports.iter().enumerate() {
                if subset >> bit & 1 == 1 {
                    values[k] = GIVES_WAY;
                }
            }
            Self { values, ..self.clone() }
        };
        (1..1 << supports.len().min(2)).rev().map(with).collect()
    }

    /// Whether nothing may be updated.
    pub fn is_empty(&self) -> bool {
        self.parameters.is_empty()
    }

    /// Prior deviation of parameter `k`.
    pub fn prior(&self, k: usize) -> f64 {
        let class = self.parameters[k].class();
        let scale = self.scales.list()[class] * self.spreads.get(k).copied().unwrap_or(1.0);
        if class == 3 { scale / self.omega } else { scale }
    }

    /// Values in units of their prior deviations.
    pub fn standardised(&self) -> Vec<f64> {
        (0..self.len()).map(|k| self.values[k] / self.prior(k)).collect()
    }

    /// The same parameters at the standardised values `u`.
    #[must_use]
    pub fn at(&self, u: &[f64]) -> Self {
        let values = u.iter().enumerate().map(|(k, u)| u * self.prior(k)).collect();
        Self { values, ..self.clone() }
    }

    /// The same with all parameters at nothing but those that are kept.
    fn kept(&self, is_kept: impl Fn(&UpdatingParameter) -> bool) -> Self {
        let value = |(parameter, v): (&UpdatingParameter, &f64)| if is_kept(parameter) { *v } else { 0.0 };
        Self { values: self.parameters.iter().zip(&self.values).map(value).collect(), ..self.clone() }
    }

    /// The same with the parameters of channels at nothing: predictions do not contain them, so that they are no reference.
    #[must_use]
    pub fn of_model(&self) -> Self {
        self.kept(UpdatingParameter::is_of_model)
    }

    /// The same with the gains of forces and the stiffness of single runs at nothing: where scales leave them no freedom they cannot be
    /// moved back.
    #[must_use]
    pub fn without_force_gains_and_shifts(&self) -> Self {
        let kept = self.kept(|parameter| !matches!(parameter, UpdatingParameter::ForceGain(_)));
        Self { shifts: Vec::new(), ..kept }
    }

    /// The same with the stiffness of each session at nothing.
    #[must_use]
    pub fn without_sessions(&self) -> Self {
        self.kept(|parameter| !matches!(parameter, UpdatingParameter::Session(_)))
    }

    /// The same with all runs alike: what holds of the structure, not of the records.
    #[must_use]
    pub fn of_structure(&self) -> Self {
        Self { shifts: Vec::new(), ..self.kept(UpdatingParameter::is_stated) }
    }

    /// Relative stiffness of run `r` beyond that of the structure: its session's and its own.
    pub fn shift(&self, r: usize) -> f64 {
        let own = self.shifts.get(r).copied().unwrap_or(0.0);
        let Some(&session) = self.sessions.get(r) else { return own };
        let of = self.parameters.iter().position(|p| *p == UpdatingParameter::Session(session));
        own + of.map_or(0.0, |k| self.factor(k) - 1.0)
    }

    /// Whether parameter `k` acts in run `r`.
    pub fn acts_in(&self, k: usize, r: usize) -> bool {
        match &self.parameters[k] {
            UpdatingParameter::Session(session) => self.sessions.get(r) == Some(session),
            _ => true,
        }
    }

    /// The same parameters and values with other scales.
    #[must_use]
    pub fn with_scales(&self, scales: Scales) -> Self {
        Self { scales, ..self.clone() }
    }

    /// The gains of force channels, as errors of these channels.
    pub fn force_gains(&self) -> Vec<Source> {
        let gain = |(k, parameter): (usize, &UpdatingParameter)| match parameter {
            UpdatingParameter::ForceGain(name) => {
                Some(Source::known(Effect::CHANNEL_GAIN, Place::Channel(name.clone()), &[self.factor(k)]))
            }
            _ => None,
        };
        self.parameters.iter().enumerate().filter_map(gain).collect()
    }

    /// The updated structure.
    pub fn structure(&self, structure: &Structure) -> Structure {
        let factor = |(k, parameter): (usize, &UpdatingParameter)| match parameter {
            UpdatingParameter::Structure(part) => Some((*part, self.factor(k))),
            _ => None,
        };
        structure.with_factors(&self.parameters.iter().enumerate().filter_map(factor).collect::<Vec<_>>())
    }

    /// The updated known sources.
    pub fn known(&self, known: &[Source]) -> Vec<Source> {
        let mut updated = known.to_vec();
        for (k, parameter) in self.parameters.iter().enumerate() {
            if let UpdatingParameter::Known(j) = parameter {
                let source = &mut updated[*j];
                source.effect.scaled().iter().for_each(|&p| source.parameters[p] *= self.factor(k));
            }
        }
        updated
    }

    /// What the response of `run` is differentiated by for parameter `k`, each with its factor; none for response channels.
    /// `known` are the updated sources.
    pub fn unknowns(&self, k: usize, known: &[Source], run: &RunData) -> Vec<(Unknown, f64)> {
        match &self.parameters[k] {
            UpdatingParameter::Structure(part) => {
                let mut unknowns = vec![(unknown(*part), 1.0)];
                unknowns.extend(self.by_base_load(k, run));
                unknowns
            }
            UpdatingParameter::Known(j) => {
                let (source, slope) = (&known[*j], self.relative_slope(k));
                let unknown_with_factor = |&parameter: &usize| {
                    (Unknown::Source { source: *j, parameter }, slope * source.parameters[parameter])
                };
                source.effect.scaled().iter().map(unknown_with_factor).collect()
            }
            UpdatingParameter::Session(_) => vec![(Unknown::Stiffness, 1.0)],
            UpdatingParameter::ForceGain(name) => {
                let force = run.forces.iter().position(|channel| channel.name == *name);
                force.map(|force| (Unknown::ForceScale(force), -1.0)).into_iter().collect()
            }
            UpdatingParameter::Gain(_) | UpdatingParameter::Delay(_) => Vec::new(),
        }
    }
}

/// Prior deviation of a parameter in multiples of the scale of its class.
fn spread(parameter: &UpdatingParameter) -> f64 {
    match parameter {
        UpdatingParameter::Structure(Part::Support(_)) => SUPPORT,
        _ => 1.0,
    }
}

fn unknown(part: Part) -> Unknown {
    match part {
        Part::Stiffness => Unknown::Stiffness,
        Part::Mass => Unknown::Mass,
        Part::Mode(r) => Unknown::ModeStiffness(r),
        Part::ModeCoupling(pair) => Unknown::ModeCoupling(pair),
        Part::ModeDamping(r) => Unknown::ModeDamping(r),
        Part::ModeDampingPerOctave(r) => Unknown::ModeDampingPerOctave(r),
        part => Unknown::Part(part),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::cantilever_parameters;
    use crate::structure::beam::{BeamParameters, Supports};
    use crate::structure::chain::ChainParameters;

    #[test]
    fn an_updated_model_has_its_parts_and_sources_multiplied() {
        let chain = ChainParameters {
            masses: vec![1.0, 2.0],
            ground_stiffness: vec![5.0, 0.0],
            coupling_stiffness: vec![11.0],
        };
        let structure = chain.build(&[]).unwrap();
        let known = [Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[3.0])];
        let parameters = vec![UpdatingParameter::Structure(Part::Coupling([0, 1])), UpdatingParameter::Known(0)];
        let updating = Updating { parameters, values: vec![0.5, 0.0], ..Updating::default() };
        let moved = updating.at(&[2.0_f64.ln() / 0.01, 1.5_f64.ln() / 0.2]);
        assert!((moved.structure(&structure).matrices().unwrap().stiffness[(0, 1)] + 22.0).abs() < 1e-9);
        assert!((moved.known(&known)[0].parameters[0] - 4.5).abs() < 1e-12);
        assert!((moved.standardised()[0] - 100.0 * 2.0_f64.ln()).abs() < 1e-9);
        // The factor that is told is that of the model, also where it is at its bound (7.39; the coupling is 11 N/m).
        let far = Updating { values: vec![5.0, 0.0], ..moved };
        let stiffness = far.structure(&structure).matrices().unwrap().stiffness[(0, 1)];
        assert!((stiffness + 11.0 * far.factor(0)).abs() < 1e-9 && (far.factor(0) - 2.0_f64.exp()).abs() < 1e-12);
    }

    /// Both supports of a beam, then one of them, each as soft as the element beside it; all else as it was.
    #[test]
    fn supports_give_way_together_and_each_alone() {
        let beam = BeamParameters { supports: Supports::ClampedClamped, ..cantilever_parameters(4) };
        let supports = beam.build(&[]).unwrap().supports();
        assert_eq!(supports.len(), 2);
        let held = |k: usize| UpdatingParameter::Structure(Part::Support(supports[k]));
        let parameters = vec![UpdatingParameter::Structure(Part::Mass), held(0), UpdatingParameter::Known(0), held(1)];
        let updating = Updating { parameters, values: vec![0.1, 0.0, 0.2, 0.0], ..Updating::default() };
        let values: Vec<Vec<f64>> = updating.giving_way().into_iter().map(|u| u.values).collect();
        let half = 0.5_f64.ln();
        assert_eq!(values, [[0.1, half, 0.2, half], [0.1, 0.0, 0.2, half], [0.1, half, 0.2, 0.0]]);
        let without = Updating { parameters: updating.parameters[..1].to_vec(), values: vec![0.1], ..updating };
        assert!(without.giving_way().is_empty());
    }
}

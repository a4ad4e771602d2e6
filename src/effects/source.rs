//! A source: a law at a place, what is known of it, and whether it may be selected.

use super::basis::Basis;
use super::effect::Effect;
use super::kind::Kind;
use super::limits::Limit;
use super::place::Place;
use super::range::Range;
use crate::math::GREATEST;
use crate::structure::Structure;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What is wrong with a source, in one line that says how to mend it.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message names every field")]
pub enum SourceError {
    #[error("law `{effect}` has no parameter `{name}`: it takes {known}")]
    UnknownParameter { effect: Effect, name: String, known: String },
    #[error("parameter `{name}` of law `{effect}` is given twice: leave one out")]
    RepeatedParameter { effect: Effect, name: String },
    #[error("law `{effect}` needs a value for `{name}`{unit} where it is known: add `{name} = ...`", unit = bracketed(unit))]
    MissingParameter { effect: Effect, name: &'static str, unit: &'static str },
    #[error("`{name} = {value}` of law `{effect}` is out of range: it must be {range}{unit}", unit = spaced(unit))]
    OutOfRange { effect: Effect, name: &'static str, value: f64, range: String, unit: &'static str },
    #[error("law `{effect}` has {found} values for its {expected} parameters")]
    WrongCount { effect: Effect, found: usize, expected: usize },
    #[error(
        "law `{effect}` acts on a relative motion: give `dofs`, one for the ground, two for a pair, more for a chain"
    )]
    NeedsDofs { effect: Effect },
    #[error("law `{effect}` acts on the whole structure: leave `dofs` out (`elements = [first, last]` restricts it)")]
    NeedsWhole { effect: Effect },
    #[error("`{effect}` is an error of a measuring channel: write it under [[sensor]] with `channel`")]
    NeedsChannel { effect: Effect },
    #[error("entries {first} and {second} of `dofs` of law `{effect}` are the same DOF: name two different ones", second = first + 1)]
    PairedWithItself { effect: Effect, first: usize },
    #[error("law `{effect}` names DOF number {dof} of a structure with {count}: use a DOF that exists")]
    NoSuchDof { effect: Effect, dof: usize, count: usize },
    #[error(
        "law `{effect}` multiplies mass or stiffness, which a `points` structure lacks: give matrices or leave it out"
    )]
    NeedsMatrices { effect: Effect },
    #[error(
        "`elements = [{first}, {last}]` of law `{effect}` is no range of the {count} beam elements: use 1 <= first <= last <= {count}"
    )]
    NoSuchElements { effect: Effect, first: usize, last: usize, count: usize },
}

/// A unit in brackets for messages.
fn bracketed(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" [{unit}]") }
}

/// A unit behind a number for messages.
fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// What identification may do with a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// In the model at its value.
    Known,
    /// May be selected.
    Candidate,
    /// Always selected, its value identified.
    Forced,
    /// Ignored.
    Off,
    /// Never used, only shown beside the result (a known truth).
    Reference,
}

impl State {
    /// Its one word, in files and for people.
    pub fn word(self) -> &'static str {
        match self {
            Self::Known => "known",
            Self::Candidate => "candidate",
            Self::Forced => "forced",
            Self::Off => "off",
            Self::Reference => "reference",
        }
    }

    /// Whether its value is to be identified.
    pub fn is_sought(self) -> bool {
        matches!(self, Self::Candidate | Self::Forced)
    }
}

/// A law at a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// The law.
    pub effect: Effect,
    /// Where it acts.
    pub place: Place,
    /// What identification may do with it.
    pub state: State,
    /// Values in the order of [`Effect::parameters`]; a candidate's linear coefficient is 1.
    pub parameters: Vec<f64>,
}

impl Source {
    /// A candidate of unit coefficient, its other parameters at their typical values.
    pub fn candidate(effect: Effect, place: Place) -> Self {
        let parameters = effect.parameters().iter().map(|p| p.typical).collect();
        Self { effect, place, state: State::Candidate, parameters }
    }

    /// A source in the model at its values.
    pub fn known(effect: Effect, place: Place, parameters: &[f64]) -> Self {
        Self { effect, place, state: State::Known, parameters: parameters.to_vec() }
    }

    /// A source of parameters given by name, checked. What is known or a reference needs every parameter; otherwise those
    /// left out are typical, and the linear coefficient is 1 whatever is given for it, since it is to be found.
    pub fn named(effect: Effect, place: Place, state: State, values: &[(&str, f64)]) -> Result<Self, SourceError> {
        let mut source = Self { state, ..Self::candidate(effect, place) };
        let list = effect.parameters();
        let mut given = vec![false; list.len()];
        for &(name, value) in values {
            let Some(k) = list.iter().position(|parameter| parameter.name == name) else {
                let known = list.iter().map(|p| format!("`{}`", p.name)).collect::<Vec<_>>().join(", ");
                return Err(SourceError::UnknownParameter { effect, name: name.to_string(), known });
            };
            if given[k] {
                return Err(SourceError::RepeatedParameter { effect, name: name.to_string() });
            }
            (given[k], source.parameters[k]) = (true, value);
        }
        if matches!(state, State::Known | State::Reference)
            && let Some(k) = given.iter().position(|given| !given)
        {
            return Err(SourceError::MissingParameter { effect, name: list[k].name, unit: list[k].unit });
        }
        source.check()?;
        let sought = state.is_sought();
        Ok(if sought { source.with_coefficient(1.0) } else { source })
    }

    /// Checks the values against their ranges and the kind of place against the law.
    pub fn check(&self) -> Result<(), SourceError> {
        let effect = self.effect;
        let list = effect.parameters();
        if list.len() != self.parameters.len() {
            return Err(SourceError::WrongCount { effect, found: self.parameters.len(), expected: list.len() });
        }
        for (parameter, &value) in list.iter().zip(&self.parameters) {
            if !parameter.allows(value) {
                let beyond = value.abs() > GREATEST;
                let range = if beyond { "from -1e30 to 1e30".to_owned() } else { parameter.range() };
                let (name, unit) = (parameter.name, parameter.unit);
                return Err(SourceError::OutOfRange { effect, name, value, range, unit });
            }
        }
        match (effect.kind(), &self.place) {
            (Kind::Relative(_), Place::Dofs(dofs)) if !dofs.is_empty() => {
                match dofs.windows(2).position(|pair| pair[0] == pair[1]) {
                    Some(at) => Err(SourceError::PairedWithItself { effect, first: at + 1 }),
                    None => Ok(()),
                }
            }
            (Kind::Whole(_), Place::Whole(_)) | (Kind::Channel(_), Place::Channel(_)) => Ok(()),
            (Kind::Relative(_), _) => Err(SourceError::NeedsDofs { effect }),
            (Kind::Whole(_), _) => Err(SourceError::NeedsWhole { effect }),
            (Kind::Channel(_), _) => Err(SourceError::NeedsChannel { effect }),
        }
    }

    /// [`Source::check`], and that the place exists on `structure`.
    pub fn check_on(&self, structure: &Structure) -> Result<(), SourceError> {
        self.check()?;
        let effect = self.effect;
        match &self.place {
            Place::Dofs(dofs) => match dofs.iter().find(|&&dof| dof >= structure.len()) {
                Some(&dof) => Err(SourceError::NoSuchDof { effect, dof: dof + 1, count: structure.len() }),
                None => Ok(()),
            },
            Place::Whole(range) => {
                if structure.matrices().is_none() {
                    return Err(SourceError::NeedsMatrices { effect });
                }
                let count = structure.elements().len();
                match *range {
                    Some([first, last]) if first > last || last >= count => {
                        Err(SourceError::NoSuchElements { effect, first: first + 1, last: last + 1, count })
                    }
                    _ => Ok(()),
                }
            }
            Place::Channel(_) => Ok(()),
        }
    }

    /// Whether both are the same law at the same place, whatever their values and states.
    pub fn is_same(&self, other: &Self) -> bool {
        self.effect == other.effect && self.place.is_same(&other.place)
    }

    /// The linear coefficient; 0 for a law that has none.
    pub fn coefficient(&self) -> f64 {
        self.effect.coefficient().map_or(0.0, |k| self.parameters[k])
    }

    /// The viscous law at the same place, of unit coefficient: a dashpot, or velocity times the same matrix.
    #[must_use]
    pub fn unit_dashpot(&self) -> Self {
        let effect = match self.effect.kind() {
            Kind::Whole(law) if law.basis() == Basis::Mass => Effect::MassProportional,
            Kind::Whole(_) => Effect::StiffnessProportional,
            Kind::Relative(_) | Kind::Channel(_) => Effect::DASHPOT,
        };
        Self::known(effect, self.place.clone(), &[1.0])
    }

    /// A dashpot of `c` N s/m between or at the DOFs.
    pub fn dashpot(dofs: Vec<usize>, c: f64) -> Self {
        Self::known(Effect::DASHPOT, Place::Dofs(dofs), &[c])
    }

    /// The simpler law at this place that the source is all but on motions of this range ([`Range::UNKNOWN`]: on any
    /// motion); none if it is no such.
    pub fn simpler(&self, range: &Range) -> Option<Self> {
        let limit = self.effect.description().limits.iter().find(|limit| (limit.holds)(&self.parameters, range))?;
        Some(Self { effect: limit.law, parameters: (limit.parameters)(&self.parameters), ..self.clone() })
    }

    /// The simpler laws at this place that the law contains, with the parameters that this source has of them.
    pub fn limits(&self) -> impl Iterator<Item = Self> {
        let limits = self.effect.description().limits;
        let law_at = |limit: &Limit| (limit.law, (limit.parameters)(&self.parameters));
        let fresh = move |k: &usize| !limits[..*k].iter().any(|other| law_at(other) == law_at(&limits[*k]));
        let simpler = move |k: usize| {
            let (effect, parameters) = law_at(&limits[k]);
            Self { effect, parameters, ..self.clone() }
        };
        (0..limits.len()).filter(fresh).map(simpler)
    }

    /// Whether the source is a simpler law by another name that is looked at beside it anyway: a force that knows no
    /// speed, or friction that does not fall from rest to sliding.
    pub fn is_disguised(&self) -> bool {
        (self.effect.description().disguised)(&self.parameters)
    }

    /// The same source with another value of its linear coefficient.
    #[must_use]
    pub fn with_coefficient(&self, value: f64) -> Self {
        let mut source = self.clone();
        if let Some(k) = self.effect.coefficient() {
            source.parameters[k] = value;
        }
        source
    }
}

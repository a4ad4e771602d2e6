//! The names of all effects and the law behind each.

use super::laws;
use super::{ChannelLaw, Law, Parameter, WholeLaw};
use serde::{Deserialize, Serialize};
use std::fmt;

/// What a law acts on.
#[derive(Clone, Copy)]
pub enum Kind {
    /// On one relative motion.
    Relative(&'static dyn Law),
    /// On the whole structure.
    Whole(&'static dyn WholeLaw),
    /// On a channel of the measuring chain.
    Channel(&'static dyn ChannelLaw),
}

/// Every effect the program knows, by its name in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "each law documents itself in its file under effects/laws")]
pub enum Effect {
    Viscous,
    Coulomb,
    Quadratic,
    Power,
    Hysteretic,
    Stribeck,
    ElasticSlider,
    Maxwell,
    Iwan,
    Fractional,
    Stiffness,
    CubicStiffness,
    QuadraticStiffness,
    Gap,
    Mass,
    LossFactor,
    StiffnessProportional,
    MassProportional,
    Delay,
    Gain,
}

impl Effect {
    /// All effects, in the order of the documentation.
    pub const ALL: [Self; 20] = [
        Self::Viscous,
        Self::Coulomb,
        Self::Quadratic,
        Self::Power,
        Self::Hysteretic,
        Self::Stribeck,
        Self::ElasticSlider,
        Self::Maxwell,
        Self::Iwan,
        Self::Fractional,
        Self::Stiffness,
        Self::CubicStiffness,
        Self::QuadraticStiffness,
        Self::Gap,
        Self::Mass,
        Self::LossFactor,
        Self::StiffnessProportional,
        Self::MassProportional,
        Self::Delay,
        Self::Gain,
    ];

    /// Name in project files, such as `elastic_slider`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Viscous => "viscous",
            Self::Coulomb => "coulomb",
            Self::Quadratic => "quadratic",
            Self::Power => "power",
            Self::Hysteretic => "hysteretic",
            Self::Stribeck => "stribeck",
            Self::ElasticSlider => "elastic_slider",
            Self::Maxwell => "maxwell",
            Self::Iwan => "iwan",
            Self::Fractional => "fractional",
            Self::Stiffness => "stiffness",
            Self::CubicStiffness => "cubic_stiffness",
            Self::QuadraticStiffness => "quadratic_stiffness",
            Self::Gap => "gap",
            Self::Mass => "mass",
            Self::LossFactor => "loss_factor",
            Self::StiffnessProportional => "stiffness_proportional",
            Self::MassProportional => "mass_proportional",
            Self::Delay => "delay",
            Self::Gain => "gain",
        }
    }

    /// The effect of that name in project files.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effect| effect.name() == name)
    }

    /// The law behind the name.
    pub fn kind(self) -> Kind {
        match self {
            Self::Viscous => Kind::Relative(&laws::viscous::Viscous),
            Self::Coulomb => Kind::Relative(&laws::coulomb::Coulomb),
            Self::Quadratic => Kind::Relative(&laws::quadratic::Quadratic),
            Self::Power => Kind::Relative(&laws::power::Power),
            Self::Hysteretic => Kind::Relative(&laws::hysteretic::Hysteretic),
            Self::Stribeck => Kind::Relative(&laws::stribeck::Stribeck),
            Self::ElasticSlider => Kind::Relative(&laws::elastic_slider::ElasticSlider),
            Self::Maxwell => Kind::Relative(&laws::maxwell::Maxwell),
            Self::Iwan => Kind::Relative(&laws::iwan::Iwan),
            Self::Fractional => Kind::Relative(&laws::fractional::Fractional),
            Self::Stiffness => Kind::Relative(&laws::stiffness::Stiffness),
            Self::CubicStiffness => Kind::Relative(&laws::cubic_stiffness::CubicStiffness),
            Self::QuadraticStiffness => Kind::Relative(&laws::quadratic_stiffness::QuadraticStiffness),
            Self::Gap => Kind::Relative(&laws::gap::Gap),
            Self::Mass => Kind::Relative(&laws::mass::Mass),
            Self::LossFactor => Kind::Whole(&laws::loss_factor::LossFactor),
            Self::StiffnessProportional => Kind::Whole(&laws::stiffness_proportional::StiffnessProportional),
            Self::MassProportional => Kind::Whole(&laws::mass_proportional::MassProportional),
            Self::Delay => Kind::Channel(&laws::delay::Delay),
            Self::Gain => Kind::Channel(&laws::gain::Gain),
        }
    }

    /// The scalar law, for effects on a relative motion.
    pub fn law(self) -> Option<&'static dyn Law> {
        match self.kind() {
            Kind::Relative(law) => Some(law),
            Kind::Whole(_) | Kind::Channel(_) => None,
        }
    }

    /// Parameters in the order in which all laws take them.
    pub fn parameters(self) -> &'static [Parameter] {
        match self.kind() {
            Kind::Relative(law) => law.parameters(),
            Kind::Whole(law) => std::slice::from_ref(law.parameter()),
            Kind::Channel(law) => std::slice::from_ref(law.parameter()),
        }
    }

    /// Index of the parameter to which the force is proportional, if there is one.
    pub fn coefficient(self) -> Option<usize> {
        self.parameters().iter().position(|p| p.linear)
    }

    /// Whether the effect can take energy out of the structure, so that the energy balance sees it.
    pub fn dissipates(self) -> bool {
        match self.kind() {
            Kind::Relative(law) => law.dissipates(),
            Kind::Whole(_) => true,
            Kind::Channel(_) => false,
        }
    }

    /// Whether the force is a linear function of the motion, harmonic by harmonic.
    pub fn is_linear(self) -> bool {
        match self.kind() {
            Kind::Relative(law) => {
                // On the stack: the energy balance asks this for every source and run.
                let mut p = [0.0; 4];
                for (value, parameter) in p.iter_mut().zip(law.parameters()) {
                    *value = parameter.typical;
                }
                law.dynamic_stiffness(&p, 1.0).is_some()
            }
            Kind::Whole(_) | Kind::Channel(_) => true,
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

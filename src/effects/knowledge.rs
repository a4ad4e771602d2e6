//! What may be asked of an effect by its name alone: its law and what is known of it.

use super::description::{Constant, Description, Exponents, ForcePart};
use super::effect::Effect;
use super::kind::Kind;
use super::law::{Law, WholeLaw};
use super::parameter::Parameter;
use super::range::Range;

impl Effect {
    /// The scalar law, for effects on a relative motion.
    pub fn law(self) -> Option<&'static dyn Law> {
        match self.kind() {
            Kind::Relative(law) => Some(law),
            Kind::Whole(_) | Kind::Channel(_) => None,
        }
    }

    /// What is known of the law beside its force.
    pub fn description(self) -> &'static Description {
        match self.kind() {
            Kind::Relative(law) => law.description(),
            Kind::Whole(law) => law.description(),
            Kind::Channel(law) => law.description(),
        }
    }

    /// Parameters in the order in which all laws take them.
    pub fn parameters(self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// Index of the parameter to which the force is proportional, if there is one.
    pub fn coefficient(self) -> Option<usize> {
        self.parameters().iter().position(|p| p.linear)
    }

    /// Parameters that share the factor to which the force is proportional.
    pub fn scaled(self) -> &'static [usize] {
        self.description().scaled
    }

    /// Parameters of unit scale from which a fit to motions of this range starts; one set at least.
    pub fn shapes(self, range: &Range) -> Vec<Vec<f64>> {
        let shapes = (self.description().shapes)(range);
        if shapes.is_empty() { vec![vec![1.0; self.parameters().len()]] } else { shapes }
    }

    /// Whether the effect can take energy out of the structure, so that the energy balance sees it.
    pub fn dissipates(self) -> bool {
        self.description().dissipates
    }

    /// Whether the force is a linear function of the motion, harmonic by harmonic.
    pub fn is_linear(self) -> bool {
        self.law().is_none_or(Law::is_linear)
    }

    /// The constant matrix of the equation of motion to which it adds, if there is one.
    pub fn constant(self) -> Option<Constant> {
        self.description().constant
    }

    /// Whether it adds to a constant matrix of this kind.
    pub fn adds_to(self, constant: Constant) -> bool {
        self.constant() == Some(constant)
    }

    /// Whether it is a point mass or a spring: it adds to what corrections of the model multiply.
    pub fn is_mass_or_spring(self) -> bool {
        matches!(self.constant(), Some(Constant::Mass | Constant::Stiffness))
    }

    /// Powers of amplitude and frequency of its equivalent coefficient at the parameters `p`, if they are constant.
    ///
    /// ```
    /// use dashpot::effects::Effect;
    /// let drag = Effect::Quadratic.exponents(&[2.0]).expect("drag is a power of the velocity");
    /// assert_eq!((drag.amplitude, drag.frequency), (1.0, 1.0));
    /// ```
    pub fn exponents(self, p: &[f64]) -> Option<Exponents> {
        (self.description().exponents)(p)
    }

    /// Laws of one parameter whose equivalent coefficient goes with a power of the amplitude, and that power, in rising order; of
    /// laws that share a power the first. Measured powers are compared with them.
    pub fn amplitude_powers(part: ForcePart) -> Vec<(Self, f64)> {
        let mut powers: Vec<(Self, f64)> = Vec::new();
        for (effect, _) in Self::relative().filter(|(effect, _)| effect.parameters().len() == 1) {
            let exponents = effect.exponents(effect.description().example).filter(|exponents| exponents.part == part);
            if let Some(power) = exponents.map(|exponents| exponents.amplitude)
                && powers.iter().all(|(_, other)| *other != power)
            {
                powers.push((effect, power));
            }
        }
        powers.sort_by(|a, b| a.1.total_cmp(&b.1));
        powers
    }

    /// The effects on a relative motion with their laws.
    pub fn relative() -> impl Iterator<Item = (Self, &'static dyn Law)> {
        Self::ALL.into_iter().filter_map(|effect| Some((effect, effect.law()?)))
    }

    /// The effects on the whole structure with their laws.
    pub fn of_whole_structures() -> impl Iterator<Item = (Self, &'static dyn WholeLaw)> {
        Self::ALL.into_iter().filter_map(|effect| match effect.kind() {
            Kind::Whole(law) => Some((effect, law)),
            _ => None,
        })
    }

    /// What finite-element programs hold it as between two DOFs: a dashpot, a spring or a point mass of its coefficient;
    /// none for a law that such an element cannot express.
    pub fn element(self) -> Option<Constant> {
        self.constant().filter(|constant| self.law().is_some() && *constant != Constant::Hysteretic)
    }

    /// Whether it is a dashpot between two DOFs.
    pub fn is_dashpot(self) -> bool {
        self.element() == Some(Constant::Viscous)
    }

    /// Whether it is an error of a measuring channel.
    pub fn is_of_channel(self) -> bool {
        matches!(self.kind(), Kind::Channel(_))
    }

    /// Simpler laws that this one contains as limits of its parameters.
    pub fn limits(self) -> impl Iterator<Item = Self> {
        self.description().limits.iter().map(|limit| limit.law)
    }

    /// Whether `simple` is a limit of this law.
    pub fn contains(self, simple: Self) -> bool {
        self.limits().any(|limit| limit == simple)
    }

    /// Laws of several parameters that this one may have been taken for: those that contain it or one of its limits, and
    /// itself if it has several parameters.
    pub fn generalisations(self) -> Vec<Self> {
        let common = |other: Self| other.limits().any(|limit| limit == self || self.contains(limit));
        let kept = |&other: &Self| other.parameters().len() > 1 && (other == self || common(other));
        Self::ALL.into_iter().filter(kept).collect()
    }
}

//! What is looked at on the page of laws: a small structure, a law at a place, a force.

use crate::effects::{Effect, Parameter, Place, Source};
use crate::response::portrait::Setup;
use crate::structure::StructureError;
use crate::structure::chain::ChainParameters;
use std::ops::RangeInclusive;

/// A small structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// One mass on a spring: figures 2.2 to 2.13 of the source.
    OneMass,
    /// Three masses in a row: figures 2.17 to 2.19.
    ThreeMasses,
}

impl System {
    /// Both.
    pub const ALL: [Self; 2] = [Self::OneMass, Self::ThreeMasses];

    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Self::OneMass => "one mass",
            Self::ThreeMasses => "three masses",
        }
    }

    /// Its values in words.
    pub fn values(self) -> &'static str {
        match self {
            Self::OneMass => "2 kg on a spring of 1000 N/m",
            Self::ThreeMasses => {
                "3, 5 and 8 kg; springs of 5000 N/m to the ground, then 2000 and 1000 N/m between them"
            }
        }
    }

    fn chain(self) -> ChainParameters {
        let (masses, ground, coupling): (&[f64], &[f64], &[f64]) = match self {
            Self::OneMass => (&[2.0], &[1000.0], &[]),
            Self::ThreeMasses => (&[3.0, 5.0, 8.0], &[5000.0, 0.0, 0.0], &[2000.0, 1000.0]),
        };
        ChainParameters {
            masses: masses.to_vec(),
            ground_stiffness: ground.to_vec(),
            coupling_stiffness: coupling.to_vec(),
        }
    }

    /// Places at which a law may act.
    pub fn places(self) -> &'static [At] {
        match self {
            Self::OneMass => &At::ALL[..1],
            Self::ThreeMasses => &At::ALL,
        }
    }
}

/// Where the law acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// Between a mass and the ground.
    Ground(usize),
    /// Between a mass and the next.
    Next(usize),
}

impl At {
    const ALL: [Self; 5] = [Self::Ground(0), Self::Ground(1), Self::Ground(2), Self::Next(0), Self::Next(1)];

    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ground(0) => "1 to the ground",
            Self::Ground(1) => "2 to the ground",
            Self::Ground(_) => "3 to the ground",
            Self::Next(0) => "between 1 and 2",
            Self::Next(_) => "between 2 and 3",
        }
    }

    fn place(self) -> Place {
        match self {
            Self::Ground(d) => Place::Dofs(vec![d]),
            Self::Next(d) => Place::Dofs(vec![d, d + 1]),
        }
    }
}

/// Everything that can be chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Lesson {
    /// The structure.
    pub system: System,
    /// The law.
    pub effect: Effect,
    /// Where it acts.
    pub at: At,
    /// Parameters of the law, SI.
    pub parameters: Vec<f64>,
    /// Amplitude of the force, N.
    pub force: f64,
    /// Frequency of the loops, Hz.
    pub frequency_hz: f64,
    /// Displacement from which the free motion starts, m.
    pub displacement: f64,
    /// Dashpot from every mass to the ground, N s/m.
    pub background: f64,
}

impl Default for Lesson {
    fn default() -> Self {
        Self::new(System::OneMass, Effect::DASHPOT)
    }
}

impl Lesson {
    /// A law with values at which its character shows.
    pub fn new(system: System, effect: Effect) -> Self {
        let frequency_hz = if system == System::OneMass { 3.4 } else { 1.2 };
        let background = if effect.is_dashpot() { 0.0 } else { 1.0 };
        let (force, displacement) = (1.0, 0.01);
        let (at, parameters) = (At::Ground(0), effect.description().example.to_vec());
        Self { system, effect, at, parameters, force, frequency_hz, displacement, background }
    }

    /// The laws of the page.
    pub fn laws() -> Vec<Effect> {
        Effect::relative().map(|(effect, _)| effect).collect()
    }

    /// Least and greatest value of a parameter on its slider, and whether the slider is logarithmic.
    pub fn range(effect: Effect, k: usize, parameter: &Parameter) -> (RangeInclusive<f64>, bool) {
        if parameter.least.is_finite() && parameter.greatest.is_finite() {
            let margin = 0.02 * (parameter.greatest - parameter.least);
            return (parameter.least + margin..=parameter.greatest - margin, false);
        }
        let value = effect.description().example.get(k).copied().unwrap_or(1.0);
        (0.02 * value..=50.0 * value, true)
    }

    /// What is to be computed.
    ///
    /// # Errors
    /// Those of [`ChainParameters::build`].
    pub fn setup(&self) -> Result<Setup, StructureError> {
        Ok(Setup {
            structure: self.system.chain().build(&[])?,
            source: Source::known(self.effect, self.at.place(), &self.parameters),
            background: self.background,
            drive: 0,
            force: self.force,
            frequency_hz: self.frequency_hz,
            displacement: self.displacement,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Lesson, System};
    use crate::control::Control;
    use crate::response::portrait::portrait;

    /// Every second law, beginning with that number, has a lesson on a structure.
    fn laws_have_lessons(system: System, first: usize) {
        for effect in Lesson::laws().into_iter().skip(first).step_by(2) {
            let lesson = Lesson::new(system, effect);
            assert_eq!(lesson.parameters.len(), effect.parameters().len(), "{effect}");
            for (k, p) in effect.parameters().iter().enumerate() {
                let (range, _) = Lesson::range(effect, k, p);
                assert!(range.contains(&lesson.parameters[k]), "{effect} {}", p.name);
                assert!(p.allows(*range.start()) && p.allows(*range.end()), "{effect} {}", p.name);
            }
            let setup = lesson.setup().expect("a structure");
            let found = portrait(&setup, &Control::unattended()).expect("a portrait");
            for curve in &found.curves {
                let is_drawn = curve.found.as_ref().is_ok_and(|c| c.len() > 20);
                assert!(is_drawn, "{effect} on {system:?}: {:?}", curve.found);
            }
            assert!(found.loops.iter().all(|l| l.found.is_ok()), "{effect} on {system:?}");
        }
    }

    /// One test a structure and half of the laws, so that they run side by side.
    macro_rules! lessons {
        ($($name:ident: $system:ident, $first:literal);*) => {
            $(#[test]
            fn $name() {
                laws_have_lessons(System::$system, $first);
            })*
        };
    }

    lessons!(
        every_law_has_a_lesson_on_one_mass: OneMass, 0;
        every_other_law_has_a_lesson_on_one_mass: OneMass, 1;
        every_law_has_a_lesson_on_three_masses: ThreeMasses, 0;
        every_other_law_has_a_lesson_on_three_masses: ThreeMasses, 1
    );

    #[test]
    fn no_structure_is_without_lessons() {
        assert_eq!(System::ALL, [System::OneMass, System::ThreeMasses]);
    }
}

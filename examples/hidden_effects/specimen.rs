//! The structures that effects are hidden in: beams and chains of random sizes, with their known damping.

use super::random::Random;
use dashpot::effects::{Effect, Place, Source};
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::chain::ChainParameters;
use dashpot::structure::{LumpedMass, Structure};

#[derive(Clone)]
pub(crate) enum Specimen {
    Beam(BeamParameters),
    Chain(ChainParameters),
}

impl Specimen {
    pub(crate) fn random(beam: bool, random: &mut Random) -> Self {
        if beam {
            let elements = [6, 8, 8, 10][random.below(4)];
            let supports =
                [Supports::ClampedFree, Supports::ClampedFree, Supports::ClampedFree, Supports::PinnedPinned];
            return Self::Beam(BeamParameters {
                length: random.within(0.4, 0.8),
                breadth: 0.04,
                depth: random.within(0.004, 0.006),
                youngs_modulus: 69e9,
                density: 2700.0,
                elements,
                supports: supports[random.below(4)],
            });
        }
        let n = 3 + random.below(4);
        let mut ground: Vec<f64> = (0..n).map(|_| if random.uniform() < 0.4 { 9e4 } else { 0.0 }).collect();
        ground[0] = 9e4;
        Self::Chain(ChainParameters {
            masses: (0..n).map(|_| random.within(1.0, 8.0)).collect(),
            ground_stiffness: ground,
            coupling_stiffness: (1..n).map(|_| random.within(5e4, 1.2e5)).collect(),
        })
    }

    /// The same with frequencies off by `detuning` (relative), in one of several ways.
    pub(crate) fn detuned(&self, detuning: f64, random: &mut Random) -> Self {
        let factor = (1.0 + detuning).powi(2);
        let way = random.below(3);
        match self.clone() {
            Self::Beam(mut beam) => {
                match way {
                    0 => beam.density /= factor,
                    _ => beam.youngs_modulus *= factor,
                }
                Self::Beam(beam)
            }
            Self::Chain(mut chain) => {
                let springs = chain.ground_stiffness.iter_mut().chain(&mut chain.coupling_stiffness);
                springs
                    .for_each(|k| *k *= if way == 2 { 1.0 + (factor - 1.0) * random.within(0.5, 1.5) } else { factor });
                Self::Chain(chain)
            }
        }
    }

    pub(crate) fn build(&self) -> Structure {
        self.build_with(&[])
    }

    pub(crate) fn build_with(&self, lumped: &[LumpedMass]) -> Structure {
        match self {
            Self::Beam(beam) => beam.build(lumped).unwrap(),
            Self::Chain(chain) => chain.build(lumped).unwrap(),
        }
    }

    pub(crate) fn toml(&self) -> String {
        match self {
            Self::Beam(beam) => format!("kind = \"beam\"\n{}", toml::to_string(beam).unwrap()),
            Self::Chain(chain) => format!("kind = \"chain\"\n{}", toml::to_string(chain).unwrap()),
        }
    }

    /// Known damping: about 0.5 to 1.5 % in the lowest modes.
    pub(crate) fn known(&self, structure: &Structure, random: &mut Random) -> Vec<Source> {
        let omega = structure.modes().unwrap().omega;
        let known_law = |effect, dofs: &[usize], c| Source::known(effect, Place::Dofs(dofs.to_vec()), &[c]);
        match self {
            Self::Beam(beam) => {
                let mass = beam.length * beam.breadth * beam.depth * beam.density;
                let rows = structure.translations();
                let beta = random.within(0.001, 0.003) / omega[1];
                let c = random.within(0.005, 0.02) * mass * omega[0];
                vec![
                    Source::known(Effect::StiffnessProportional, Place::Whole(None), &[beta]),
                    known_law(Effect::Viscous, &[rows[rows.len() / 2]], c),
                ]
            }
            Self::Chain(chain) => {
                let mut list = Vec::new();
                for (i, m) in chain.masses.iter().enumerate() {
                    if i % 2 == 0 {
                        list.push(known_law(Effect::Viscous, &[i], random.within(0.01, 0.04) * m * omega[0]));
                    }
                }
                let i = random.below(chain.masses.len() - 1);
                list.push(known_law(Effect::Viscous, &[i, i + 1], 0.02 * chain.masses[i] * omega[0]));
                list
            }
        }
    }
}

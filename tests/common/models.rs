//! Structures with answers in closed form.

use dashpot::effects::{Effect, Place, Source};
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::chain::ChainParameters;
use faer::c64;

/// A chain of `masses` (kg) with springs to the ground and between neighbours (N/m).
pub fn chain(masses: &[f64], ground_stiffness: &[f64], coupling_stiffness: &[f64]) -> Structure {
    let chain = ChainParameters {
        masses: masses.to_vec(),
        ground_stiffness: ground_stiffness.to_vec(),
        coupling_stiffness: coupling_stiffness.to_vec(),
    };
    chain.build(&[]).unwrap()
}

/// A mass (kg) on a spring (N/m).
pub fn oscillator(mass: f64, stiffness: f64) -> Structure {
    chain(&[mass], &[stiffness], &[])
}

/// Its displacement under a unit force, a dashpot (N s/m) beside the spring: `1 / (k - m w^2 + i w c)`, m/N.
pub fn receptance(mass: f64, stiffness: f64, dashpot: f64, omega: f64) -> c64 {
    c64::new(1.0, 0.0) / c64::new(stiffness - mass * omega * omega, omega * dashpot)
}

/// `n` equal masses, the first on a spring to the ground: `w_r = 2 sqrt(k/m) sin((2 r - 1) pi / (2 (2 n + 1)))`.
pub fn uniform_chain(n: usize, mass: f64, stiffness: f64) -> Structure {
    let mut ground = vec![0.0; n];
    ground[0] = stiffness;
    chain(&vec![mass; n], &ground, &vec![stiffness; n - 1])
}

/// The five masses of the thesis' experiment (6.2), each on a spring to the ground.
pub fn five_masses() -> Structure {
    five_masses_on([94263.0; 5])
}

/// The same on these springs.
pub fn five_masses_on(ground: [f64; 5]) -> Structure {
    chain(&[1.727, 5.122, 8.213, 2.609, 1.339], &ground, &[75136.0, 67744.0, 75466.0, 83396.0])
}

/// Three masses of 1 kg on one spring to the ground, whose springs are `factors` times 20, 10 and 15 kN/m.
pub fn three_masses(factors: [f64; 3]) -> Structure {
    chain(&[1.0; 3], &[2e4 * factors[0], 0.0, 0.0], &[1e4 * factors[1], 1.5e4 * factors[2]])
}

/// The aluminium cantilever of the thesis (3.3.6).
pub fn cantilever_parameters(elements: usize) -> BeamParameters {
    BeamParameters {
        length: 0.56,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: 69e9,
        density: 2700.0,
        elements,
        supports: Supports::ClampedFree,
    }
}

/// That cantilever; translations are the even rows, the last but one that of the tip.
pub fn cantilever(elements: usize) -> Structure {
    cantilever_parameters(elements).build(&[]).unwrap()
}

/// The same, 0.5 m long and of 70 GPa.
pub fn short_cantilever(elements: usize) -> Structure {
    let beam = BeamParameters { length: 0.5, youngs_modulus: 70e9, ..cantilever_parameters(elements) };
    beam.build(&[]).unwrap()
}

/// A source between DOFs that acts.
pub fn source(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
}

/// A source of the whole structure.
pub fn whole(effect: Effect, value: f64) -> Source {
    Source::known(effect, Place::Whole(None), &[value])
}

/// A source between DOFs that may be identified.
pub fn candidate(effect: Effect, dofs: &[usize]) -> Source {
    Source::candidate(effect, Place::Dofs(dofs.to_vec()))
}

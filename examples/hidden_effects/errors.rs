//! What is wrong with every laboratory's model and measurement, drawn at random: springs and masses, supports and length,
//! known damping, gains of channels, drift of the frequencies, level of the force.

use super::random::Random;
use super::specimen::Specimen;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::imported::{ImportedDof, ImportedParameters};
use dashpot::structure::{LumpedMass, Structure, SystemMatrices};
use faer::Mat;
use serde::Serialize;

/// Standard deviations, relative: known damping, gains, gains of a careless laboratory, drift of the frequencies from run
/// to run, level of the force.
pub(crate) const KNOWN: f64 = 0.2;
const GAINS: f64 = 0.01;
const LARGE_GAINS: f64 = 0.03;
pub(crate) const DRIFT: f64 = 0.0005;
const FORCE_LEVEL: f64 = 0.003;

/// Factors from what the project states to what is true.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct ModelErrors {
    /// Springs and masses of a chain (ground springs first), or of element groups of a beam.
    pub springs: Vec<f64>,
    pub masses: Vec<f64>,
    /// First and last element of each group, from 1.
    pub element_groups: Vec<[usize; 2]>,
    pub youngs_modulus: Option<f64>,
    pub density: Option<f64>,
    pub lumped_mass: Option<f64>,
    pub ground_spring: Option<f64>,
    pub length: Option<f64>,
    /// Stiffness of a support that the model takes for rigid, N m/rad or N/m; of a chain, the factor of its first ground
    /// spring.
    pub support: Option<f64>,
}

/// What is wrong with the measurement.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct ChannelErrors {
    /// Factor of every channel, the force last.
    pub gains: Vec<(String, f64)>,
    /// Relative shift of all frequencies, run by run.
    pub drift: Vec<f64>,
    /// Recorded over true level of the force, run by run.
    pub force_level: Vec<f64>,
    pub bad_sensor: Option<BadSensor>,
}

/// One sensor that is mounted or set wrongly.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct BadSensor {
    pub channel: String,
    /// `gain`, `delay` (s) or `loose` (a gain that changes from run to run by `value`).
    pub kind: &'static str,
    pub value: f64,
    /// Gains of a loose sensor, run by run.
    pub by_run: Vec<f64>,
}

/// A normal deviate that never lies far out: models that are 1 % off are not 5 % off.
pub(crate) fn factor(deviation: f64, random: &mut Random) -> f64 {
    1.0 + deviation * random.normal().clamp(-2.0, 2.0)
}

/// A structure as it truly is, and where each DOF of the model is in it.
pub(crate) struct Truth {
    pub structure: Structure,
    pub row: Vec<usize>,
}

/// The true structure behind what `specimen` states with `lumped` masses, `percent` off.
pub(crate) fn perturbed(
    specimen: &Specimen,
    lumped: &[LumpedMass],
    percent: f64,
    random: &mut Random,
) -> (Truth, ModelErrors) {
    let deviation = percent / 100.0;
    match specimen {
        Specimen::Beam(beam) => perturbed_beam(beam, lumped, deviation, random),
        Specimen::Chain(chain) => {
            let mut errors = ModelErrors::default();
            let mut chain = chain.clone();
            for k in chain.ground_stiffness.iter_mut().chain(&mut chain.coupling_stiffness) {
                errors.springs.push(factor(deviation, random));
                *k *= errors.springs[errors.springs.len() - 1];
            }
            for m in &mut chain.masses {
                errors.masses.push(factor(deviation, random));
                *m *= errors.masses[errors.masses.len() - 1];
            }
            if random.uniform() < 0.15 {
                let support = 1.0 - random.within(0.05, 0.1);
                chain.ground_stiffness[0] *= support;
                errors.support = Some(support);
            }
            let structure = chain.build(&[]).unwrap();
            (Truth { row: (0..structure.len()).collect(), structure }, errors)
        }
    }
}

fn perturbed_beam(
    beam: &BeamParameters,
    lumped: &[LumpedMass],
    deviation: f64,
    random: &mut Random,
) -> (Truth, ModelErrors) {
    let mut errors = ModelErrors::default();
    let mut beam = beam.clone();
    let (mut ei, mut mass) = (vec![1.0; beam.elements], vec![1.0; beam.elements]);
    if lumped.is_empty() {
        let groups = 3 + random.below(2);
        let bounds: Vec<usize> = (0..=groups).map(|g| g * beam.elements / groups).collect();
        for pair in bounds.windows(2) {
            errors.springs.push(factor(deviation, random));
            errors.masses.push(factor(deviation, random));
            errors.element_groups.push([pair[0] + 1, pair[1]]);
            ei[pair[0]..pair[1]].fill(errors.springs[errors.springs.len() - 1]);
            mass[pair[0]..pair[1]].fill(errors.masses[errors.masses.len() - 1]);
        }
    } else {
        let (e, rho) = (factor(deviation, random), factor(deviation, random));
        beam.youngs_modulus *= e;
        beam.density *= rho;
        (errors.youngs_modulus, errors.density) = (Some(e), Some(rho));
        errors.lumped_mass = Some(factor(deviation, random));
    }
    if random.uniform() < 0.15 {
        let length = 1.0 + random.within(0.005, 0.01) * random.sign();
        beam.length *= length;
        errors.length = Some(length);
    }
    let flexible = random.uniform() < 0.15;
    let bending = beam.youngs_modulus * beam.breadth * beam.depth.powi(3) / 12.0;
    let clamped = beam.supports != Supports::PinnedPinned;
    if flexible {
        errors.support = Some(if clamped {
            bending / beam.length * random.within(40.0, 200.0)
        } else {
            bending / beam.length.powi(3) * random.within(700.0, 4000.0)
        });
    }
    let lumped: Vec<LumpedMass> = lumped
        .iter()
        .map(|l| LumpedMass { dof: l.dof.clone(), mass: l.mass * errors.lumped_mass.unwrap_or(1.0) })
        .collect();
    (held(&beam, &ei, &mass, errors.support, &lumped), errors)
}

/// A beam of elements with their own factors, on supports that give way where `support` is their stiffness: the rotation
/// of a clamp, the translation of a pin.
fn held(beam: &BeamParameters, ei: &[f64], mass: &[f64], support: Option<f64>, lumped: &[LumpedMass]) -> Truth {
    let free = BeamParameters { supports: Supports::FreeFree, ..beam.clone() }.build(&[]).unwrap();
    let model = beam.build(&[]).unwrap();
    let n = free.len();
    let (mut m, mut k) = (Mat::<f64>::zeros(n, n), Mat::<f64>::zeros(n, n));
    for (e, element) in free.elements().iter().enumerate() {
        element.entries(&element.mass).for_each(|(i, j, value)| m[(i, j)] += mass[e] * value);
        element.entries(&element.stiffness).for_each(|(i, j, value)| k[(i, j)] += ei[e] * value);
    }
    let in_model = |i: usize| {
        model.dofs().iter().position(|d| (d.node, d.direction) == (free.dofs()[i].node, free.dofs()[i].direction))
    };
    let gives = |i: usize| {
        let rotation = free.dofs()[i].direction.is_rotation();
        support.filter(|_| in_model(i).is_none() && rotation == (beam.supports != Supports::PinnedPinned))
    };
    let kept: Vec<usize> = (0..n).filter(|&i| in_model(i).is_some() || gives(i).is_some()).collect();
    for &i in &kept {
        k[(i, i)] += gives(i).unwrap_or(0.0);
    }
    let label = |i: usize| match in_model(i) {
        Some(row) => model.label(row).to_string(),
        None => format!("s{i}"),
    };
    let node = |i: usize| free.nodes()[free.dofs()[i].node].label.clone();
    let dof = |&i: &usize| ImportedDof { label: label(i), node: node(i), direction: free.dofs()[i].direction };
    let parameters = ImportedParameters {
        mass: Mat::from_fn(kept.len(), kept.len(), |i, j| m[(kept[i], kept[j])]),
        stiffness: Mat::from_fn(kept.len(), kept.len(), |i, j| k[(kept[i], kept[j])]),
        nodes: Some(free.nodes().to_vec()),
        dofs: Some(kept.iter().map(dof).collect()),
        lines: lines(&free),
    };
    let structure = parameters.build(lumped).unwrap();
    let row = (0..model.len()).map(|i| structure.dof(model.label(i)).unwrap()).collect();
    Truth { structure, row }
}

fn lines(structure: &Structure) -> Vec<[String; 2]> {
    let label = |k: usize| structure.nodes()[k].label.clone();
    structure.lines().iter().map(|&[a, b]| [label(a), label(b)]).collect()
}

/// The matrices and tables of a structure, all stiffness times `stiffness`.
pub(crate) fn imported(structure: &Structure, stiffness: f64) -> ImportedParameters {
    let SystemMatrices { mass, stiffness: k } = structure.matrices().unwrap().clone();
    let dof = |d: &dashpot::structure::Dof| ImportedDof {
        label: d.label.clone(),
        node: structure.nodes()[d.node].label.clone(),
        direction: d.direction,
    };
    ImportedParameters {
        mass,
        stiffness: k * faer::Scale(stiffness),
        nodes: Some(structure.nodes().to_vec()),
        dofs: Some(structure.dofs().iter().map(dof).collect()),
        lines: lines(structure),
    }
}

impl ChannelErrors {
    /// Errors of `channels` (the force last) over `runs` runs; `careful` laboratories have no larger gains and no bad
    /// sensor, which the error of a channel that is looked for would be lost among.
    pub(crate) fn random(channels: &[String], runs: usize, careful: bool, random: &mut Random) -> Self {
        let large = random.uniform() < 0.15 && !careful;
        let gains = if large { LARGE_GAINS } else { GAINS };
        let gains = channels.iter().map(|c| (c.clone(), factor(gains, random))).collect();
        // Half of the laboratories drift slowly (temperature), the others scatter (joints that re-seat).
        let slow = random.uniform() < 0.5;
        let mut drift: Vec<f64> = Vec::new();
        for r in 0..runs {
            let step = DRIFT * random.normal().clamp(-2.0, 2.0);
            let last = if slow && r > 0 { drift[r - 1] } else { 0.0 };
            let remembered: f64 = if slow { 0.9 } else { 0.0 };
            drift.push(remembered * last + (1.0 - remembered * remembered).sqrt() * step);
        }
        let force_level = (0..runs).map(|_| factor(FORCE_LEVEL, random)).collect();
        let bad = random.uniform() < 0.1 && !careful;
        let bad_sensor = bad.then(|| BadSensor::random(&channels[random.below(channels.len() - 1)], runs, random));
        Self { gains, drift, force_level, bad_sensor }
    }
}

impl BadSensor {
    fn random(channel: &str, runs: usize, random: &mut Random) -> Self {
        let (kind, value) = match random.below(3) {
            0 => ("gain", 1.0 + random.within(0.1, 0.3) * random.sign()),
            1 => ("delay", random.within(3e-4, 8e-4)),
            _ => ("loose", random.within(0.03, 0.08)),
        };
        let by_run = if kind == "loose" { (0..runs).map(|_| factor(value, random)).collect() } else { Vec::new() };
        Self { channel: channel.to_string(), kind, value, by_run }
    }
}

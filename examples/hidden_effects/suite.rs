//! Projects with a hidden effect, their records made by time integration: never by the model that judges.

use super::random::Random;
use super::records::{Chain, steady};
use super::sizing::{place, size};
use super::specimen::Specimen;
use dashpot::diagnosis::Problem;
use dashpot::effects::{Effect, Source};
use dashpot::measurement::{Record, Run};
use dashpot::response::harmonic_balance::Excitation;
use dashpot::structure::Structure;
use dashpot::structure::points::PointParameters;
use faer::c64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// What a project is like.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kindness {
    pub beam: bool,
    /// No mass and stiffness in the project: energies only, every mass measured.
    pub points: bool,
    pub sensors: usize,
    pub runs: usize,
    pub levels: usize,
    pub noise: f64,
    /// Change of the response that the effect makes.
    pub size: f64,
    /// Relative error of the model's frequencies; known damping is 5 to 20 % off then.
    pub detuned: f64,
    /// One record more that has not settled.
    pub unsettled: bool,
}

/// A project whose hidden effects are known to us only.
pub(crate) struct Hidden {
    /// Structure of the model (detuned or not).
    pub structure: Structure,
    /// Its table in a project file.
    pub structure_toml: String,
    pub known: Vec<Source>,
    pub truth: Vec<Source>,
    pub records: Vec<Record>,
    pub omegas: Vec<f64>,
    pub runs: Vec<Run>,
}

impl Hidden {
    pub(crate) fn problem(&self) -> Problem<'_> {
        Problem { structure: &self.structure, sources: &self.known, runs: &self.runs }
    }
}

/// A project with `effects` hidden at places and of sizes that `random` chooses.
pub(crate) fn hidden(effects: &[Effect], kindness: Kindness, random: &mut Random) -> Option<Hidden> {
    let specimen = Specimen::random(kindness.beam, random);
    let exact = specimen.build();
    let known = specimen.known(&exact, random);
    let model = if kindness.detuned == 0.0 { specimen.clone() } else { specimen.detuned(kindness.detuned, random) };
    let mut stated = known.clone();
    if kindness.detuned != 0.0 {
        let off = 1.0 + random.within(0.05, 0.2) * random.sign();
        stated.iter_mut().for_each(|s| s.parameters[0] *= off);
    }
    let omega = exact.modes().unwrap().omega;
    let excitations = excitations(&exact, &omega, kindness, random);
    let sensors = sensors(&exact, kindness, random);
    let mut truth: Vec<Source> = Vec::new();
    for &effect in effects {
        let source = place(effect, &exact, &sensors, excitations[0].forces[0].dof, random);
        truth.push(size(source, &exact, &known, &excitations, &sensors, kindness.size, random)?);
    }
    let all: Vec<Source> = known.iter().chain(&truth).cloned().collect();
    let mut chain =
        Chain { structure: &exact, sensors: &sensors, truth: &truth, noise: kindness.noise, transient: 0.0 };
    let mut records = Vec::new();
    for (r, excitation) in excitations.iter().enumerate() {
        chain.transient = if kindness.unsettled && r == 1 { 0.2 } else { 0.0 };
        records.push(chain.record(excitation, &steady(&exact, &all, excitation)?, random));
    }
    let omegas: Vec<f64> = excitations.iter().map(|e| e.omega).collect();
    let runs = records.iter().zip(&omegas).enumerate().map(|(r, (record, &omega))| run(r, record, omega)).collect();
    let (structure, structure_toml) = structure(&model, kindness.points);
    Some(Hidden { structure, structure_toml, known: stated, truth, records, omegas, runs })
}

fn structure(model: &Specimen, points: bool) -> (Structure, String) {
    let built = model.build();
    if !points {
        return (built, model.toml());
    }
    let labels: Vec<String> = (0..built.len()).map(|i| built.label(i).to_string()).collect();
    let toml = format!("kind = \"points\"\ndofs = {labels:?}\n");
    (PointParameters { dofs: labels, positions: None }.build().unwrap(), toml)
}

pub(crate) fn file(index: usize) -> String {
    format!("run-{:02}.csv", index + 1)
}

fn run(index: usize, record: &Record, omega: f64) -> Run {
    Run::from_record(file(index), None, true, Arc::new(record.clone()), Some(omega / TAU), 7, &[]).unwrap()
}

/// Sines near the natural frequencies `natural` (rad/s), at several levels of force.
pub(crate) fn excitations(
    structure: &Structure,
    natural: &[f64],
    kindness: Kindness,
    random: &mut Random,
) -> Vec<Excitation> {
    let rows = structure.translations();
    let dof = rows[random.below(rows.len().min(4)) + rows.len() - rows.len().min(4)];
    let force = if kindness.beam { 2.0 } else { 30.0 };
    let ratios = [0.985, 1.02, 0.93, 1.005, 1.08, 0.995];
    let first = (0..natural.len()).find(|&r| natural[r] > 0.0).unwrap_or(0);
    let count = 3.min(structure.len());
    let per_mode = kindness.runs.div_ceil(count * kindness.levels);
    let mut list = Vec::new();
    for mode in first..first + count {
        for ratio in ratios.iter().cycle().take(per_mode) {
            let omega = natural[mode] * (ratio + random.within(-0.004, 0.004));
            for level in 0..kindness.levels {
                let f = force * [0.3, 1.0, 2.5, 4.0][level] * random.within(0.9, 1.1);
                let turn = c64::new(0.0, random.within(0.0, TAU)).exp();
                let mut excitation = Excitation::sine(omega, dof, turn * f);
                // An exciter is never pure.
                let harmonics = [c64::new(0.002 * f, 0.001 * f), c64::new(-0.004 * f, 0.003 * f)];
                excitation.forces[0].harmonics.extend(harmonics);
                list.push(excitation);
            }
        }
    }
    while list.len() > kindness.runs {
        list.remove(random.below(list.len()));
    }
    list
}

pub(crate) fn sensors(structure: &Structure, kindness: Kindness, random: &mut Random) -> Vec<usize> {
    let mut all = structure.translations();
    while all.len() > kindness.sensors && !kindness.points {
        all.remove(random.below(all.len()));
    }
    all
}

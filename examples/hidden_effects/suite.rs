//! Projects with a hidden effect, their records made by time integration: never by the model that judges. Laws that are
//! defined harmonic by harmonic (hysteretic, fractional, loss factor) have no force in time; they are linear, and their
//! steady state is exact.

use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source, effect::Kind};
use dashpot::explain::Problem;
use dashpot::measurement::{Channel, Quantity, Record, Run, fit::fit};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use dashpot::response::time_integration::{Settling, TimeModel};
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::chain::ChainParameters;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Steps of a period in time integration.
const STEPS: usize = 1024;
/// Samples of a period in the record.
const SAMPLES: usize = 64;
/// Periods recorded.
const PERIODS: usize = 20;

/// A small generator of random numbers: the same on every machine.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(0x1234_5678_9ABC_DEF1))
    }

    /// Uniform in 0..1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n - 1)
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().max(1e-300).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// What a project is like.
#[derive(Debug, Clone, Copy)]
pub struct Kindness {
    pub beam: bool,
    pub sensors: usize,
    pub runs: usize,
    pub noise: f64,
    /// Change of the response that the effect makes.
    pub size: f64,
    /// Relative error of the model's frequencies.
    pub detuned: f64,
}

/// A project whose hidden effects are known to us only.
pub struct Hidden {
    /// Structure of the model (detuned or not).
    pub structure: Structure,
    pub known: Vec<Source>,
    pub truth: Vec<Source>,
    pub runs: Vec<Run>,
}

impl Hidden {
    pub fn problem(&self) -> Problem<'_> {
        Problem { structure: &self.structure, sources: &self.known, runs: &self.runs }
    }
}

pub fn beam(modulus: f64) -> Structure {
    let parameters = BeamParameters {
        length: 0.56,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: modulus,
        density: 2700.0,
        elements: 8,
        supports: Supports::ClampedFree,
    };
    parameters.build(&[]).unwrap()
}

pub fn chain(factor: f64) -> Structure {
    let chain = ChainParameters {
        masses: vec![1.727, 5.122, 8.213, 2.609, 1.339],
        ground_stiffness: [94263.0, 0.0, 0.0, 0.0, 0.0].map(|k| k * factor).to_vec(),
        coupling_stiffness: [75136.0, 67744.0, 75466.0, 83396.0].map(|k| k * factor).to_vec(),
    };
    chain.build(&[]).unwrap()
}

fn at(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
}

fn known(beam: bool, factor: f64) -> Vec<Source> {
    if beam {
        let whole = Source::known(Effect::StiffnessProportional, Place::Whole(None), &[4e-5 * factor]);
        vec![whole, at(Effect::Viscous, &[6], &[0.25 * factor])]
    } else {
        vec![
            at(Effect::Viscous, &[0], &[8.0 * factor]),
            at(Effect::Viscous, &[2, 3], &[9.0 * factor]),
            at(Effect::Viscous, &[4], &[3.0 * factor]),
        ]
    }
}

/// A project with `effects` hidden at places and of sizes that `random` chooses.
pub fn hidden(effects: &[Effect], kindness: Kindness, random: &mut Random) -> Option<Hidden> {
    let build = |factor: f64| if kindness.beam { beam(69e9 * factor) } else { chain(factor) };
    let truth_structure = build(1.0);
    let detuned = kindness.detuned != 0.0;
    let damping = if detuned { 1.0 + random.within(0.05, 0.2) * (random.uniform() - 0.5).signum() } else { 1.0 };
    let structure = build((1.0 + kindness.detuned).powi(2));
    let exact = known(kindness.beam, 1.0);
    let excitations = excitations(&truth_structure, kindness, random);
    let sensors = sensors(&truth_structure, kindness, random);
    let mut truth = Vec::new();
    for &effect in effects {
        let hidden = place(effect, &truth_structure, &sensors, excitations[0].forces[0].dof, random);
        truth.push(size(hidden, &truth_structure, &exact, &excitations, &sensors, kindness.size, random)?);
    }
    let all: Vec<Source> = exact.iter().chain(&truth).cloned().collect();
    let runs = excitations.iter().enumerate().map(|(r, excitation)| {
        let (harmonics, mean) = steady(&truth_structure, &all, excitation)?;
        Some(record(r, &truth_structure, excitation, &harmonics, &mean, &sensors, &truth, kindness.noise, random))
    });
    let runs = runs.collect::<Option<Vec<_>>>()?;
    Some(Hidden { structure, known: known(kindness.beam, damping), truth, runs })
}

fn excitations(structure: &Structure, kindness: Kindness, random: &mut Random) -> Vec<Excitation> {
    let modes = structure.modes().unwrap();
    let dof = if kindness.beam { [14, 10, 8][random.below(3)] } else { random.below(5) };
    let force = if kindness.beam { 2.0 } else { 30.0 };
    let ratios = [0.985, 1.02, 0.93, 1.005, 1.08, 0.995];
    let mut list = Vec::new();
    let levels = if kindness.runs > 12 { 3 } else { 2 };
    let per_mode = kindness.runs.div_ceil(3 * levels);
    for mode in 0..3 {
        for ratio in ratios.iter().take(per_mode) {
            for level in 0..levels {
                let omega = modes.omega[mode] * (ratio + random.within(-0.004, 0.004));
                // An exciter is never pure.
                let f = force * [0.3, 1.0, 2.5][level] * random.within(0.9, 1.1);
                let turn = c64::new(0.0, random.within(0.0, TAU)).exp();
                let mut excitation = Excitation::sine(omega, dof, turn * f);
                excitation.forces[0]
                    .harmonics
                    .extend([c64::new(0.002 * f, 0.001 * f), c64::new(-0.004 * f, 0.003 * f)]);
                list.push(excitation);
            }
        }
    }
    list.truncate(kindness.runs);
    list
}

fn sensors(structure: &Structure, kindness: Kindness, random: &mut Random) -> Vec<usize> {
    let mut all = structure.translations();
    while all.len() > kindness.sensors {
        all.remove(random.below(all.len()));
    }
    all
}

/// A place for an effect, its parameters to be sized.
fn place(effect: Effect, structure: &Structure, sensors: &[usize], force: usize, random: &mut Random) -> Source {
    let place = match effect.kind() {
        Kind::Whole(_) => Place::Whole(None),
        Kind::Channel(_) => {
            let n = random.below(sensors.len() + 1);
            let name = sensors
                .get(n)
                .map_or(format!("force@{}", structure.label(force)), |&s| format!("acc@{}", structure.label(s)));
            Place::Channel(name)
        }
        Kind::Relative(_) => {
            let pairs = structure.neighbours();
            let translations = structure.translations();
            if random.uniform() < 0.3 {
                Place::Dofs(pairs[random.below(pairs.len())].to_vec())
            } else {
                Place::Dofs(vec![translations[random.below(translations.len())]])
            }
        }
    };
    Source::candidate(effect, place)
}

/// Parameters such that the response changes by `target`.
fn size(
    mut source: Source,
    structure: &Structure,
    known: &[Source],
    excitations: &[Excitation],
    sensors: &[usize],
    target: f64,
    random: &mut Random,
) -> Option<Source> {
    match source.effect {
        Effect::Delay => source.parameters = vec![random.within(2e-4, 8e-4) * target / 0.3],
        Effect::Gain => {
            source.parameters = vec![1.0 + target * random.within(0.4, 0.8) * (random.uniform() - 0.5).signum()];
        }
        _ => {}
    }
    if matches!(source.effect.kind(), Kind::Channel(_)) {
        return Some(source);
    }
    let base = ForwardModel::new(structure, known).unwrap();
    let control = Control::unattended();
    let settings = Settings::fixed(7);
    let respond = |model: &ForwardModel, e: &Excitation| model.respond(e, &settings, None, &control).ok();
    let before: Vec<_> = excitations.iter().map(|e| respond(&base, e)).collect::<Option<Vec<_>>>()?;
    let leg = source.place.legs().first().copied();
    let largest = |weight: &dyn Fn(f64) -> f64| -> f64 {
        let at = |r: &dashpot::response::harmonic_balance::Response| {
            leg.map_or(1.0, |l| l.relative(|i| r.amplitude(i, 1)).norm())
        };
        before.iter().map(|r| weight(r.omega) * at(r)).fold(0.0, f64::max)
    };
    let (d, v) = (largest(&|_| 1.0), largest(&|w| w));
    let omega = excitations.iter().map(|e| e.omega.ln()).sum::<f64>() / excitations.len() as f64;
    let shaped = |s: f64| -> Vec<f64> {
        match source.effect {
            Effect::Power => vec![s / v, 1.6],
            Effect::Fractional => vec![s / d, 0.4],
            Effect::ElasticSlider => vec![s / (0.25 * d), s],
            Effect::Maxwell => vec![s / d, s / d / omega.exp()],
            Effect::Iwan => vec![s / (0.3 * d), s, -0.5, 1.0],
            Effect::Stribeck => vec![s, 2.0 * s, 0.1 * v],
            Effect::Gap => vec![s / d, 0.4 * d],
            Effect::Coulomb => vec![s],
            Effect::Viscous => vec![s / v],
            Effect::Quadratic => vec![s / (v * v)],
            Effect::CubicStiffness => vec![s / d.powi(3)],
            Effect::QuadraticStiffness => vec![s / (d * d)],
            Effect::Mass => vec![s / (d * (2.0 * omega).exp())],
            Effect::LossFactor => vec![1e-2 * s],
            Effect::StiffnessProportional => vec![1e-2 * s / omega.exp()],
            Effect::MassProportional => vec![1e-2 * s * omega.exp()],
            _ => vec![s / d],
        }
    };
    let mut s = 0.05;
    for _ in 0..14 {
        source.parameters = shaped(s);
        let model = base.with_sources(&[known, std::slice::from_ref(&source)].concat()).ok()?;
        let mut errors = Vec::new();
        for (e, b) in excitations.iter().zip(&before) {
            let after = respond(&model, e)?;
            let size = sensors.iter().map(|&i| after.amplitude(i, 1).norm()).fold(0.0, f64::max);
            for &i in sensors {
                let a = after.amplitude(i, 1);
                errors.push(((a - b.amplitude(i, 1)).norm() / a.norm().max(size / 20.0)).powi(2));
            }
        }
        let error = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
        let ratio = (target / error).clamp(0.2, 5.0);
        if (ratio - 1.0).abs() < 0.15 {
            break;
        }
        s *= ratio.powf(0.8);
    }
    Some(source)
}

/// Harmonics of displacement (n x 15) and its mean in steady state, by time integration where there is a force in time.
fn steady(structure: &Structure, sources: &[Source], excitation: &Excitation) -> Option<(Mat<c64>, Vec<f64>)> {
    let control = Control::unattended();
    let acting: Vec<Source> =
        sources.iter().filter(|s| !matches!(s.effect.kind(), Kind::Channel(_))).cloned().collect();
    let harmonic = |s: &Source| matches!(s.effect, Effect::Hysteretic | Effect::Fractional | Effect::LossFactor);
    if acting.iter().any(harmonic) || acting.iter().all(|s| s.effect.is_linear()) {
        let model = ForwardModel::new(structure, &acting).ok()?;
        let response = model.respond(excitation, &Settings::fixed(31), None, &control).ok()?;
        return Some((response.harmonics.clone(), response.mean.clone()));
    }
    let mut model = TimeModel::new(structure, &acting, excitation, STEPS).ok()?;
    model.settle(&Settling { tolerance: 1e-6, most_periods: 600, accelerate: true }, &control).ok()?;
    Some((model.harmonics(15).ok()?, vec![0.0; structure.len()]))
}

#[expect(clippy::too_many_arguments, reason = "a record is made of all of these")]
fn record(
    index: usize,
    structure: &Structure,
    excitation: &Excitation,
    harmonics: &Mat<c64>,
    mean: &[f64],
    sensors: &[usize],
    truth: &[Source],
    noise: f64,
    random: &mut Random,
) -> Run {
    let _ = mean;
    let omega = excitation.omega;
    let count = SAMPLES * PERIODS;
    let time: Vec<f64> = (0..count).map(|n| n as f64 * TAU / omega / SAMPLES as f64).collect();
    let mut channels = Vec::new();
    let mut samples = Vec::new();
    let mut add = |channel: Channel, amplitudes: Vec<c64>, random: &mut Random| {
        let name = channel.to_string();
        let mut amplitudes = amplitudes;
        for source in truth {
            if let (Kind::Channel(law), Place::Channel(faulty)) = (source.effect.kind(), &source.place)
                && *faulty == name
            {
                for (i, a) in amplitudes.iter_mut().enumerate() {
                    *a *= law.transfer(source.parameters[0], (i + 1) as f64 * omega);
                }
            }
        }
        let rms = (0.5 * amplitudes.iter().map(c64::norm_sqr).sum::<f64>()).sqrt();
        let at = |t: f64| -> f64 {
            amplitudes.iter().enumerate().map(|(i, a)| (*a * c64::new(0.0, (i + 1) as f64 * omega * t).exp()).re).sum()
        };
        samples.push(time.iter().map(|&t| at(t) + noise * rms * random.normal()).collect::<Vec<f64>>());
        channels.push(channel);
    };
    for force in &excitation.forces {
        let label = structure.label(force.dof).to_string();
        add(Channel { quantity: Quantity::Force, dof: force.dof, label }, force.harmonics.clone(), random);
    }
    for &dof in sensors {
        let label = structure.label(dof).to_string();
        let acceleration = |i: usize| harmonics[(dof, i)] * -((i + 1) as f64 * omega).powi(2);
        let amplitudes = (0..harmonics.ncols()).map(acceleration).collect();
        add(Channel { quantity: Quantity::Acceleration, dof, label }, amplitudes, random);
    }
    let record = Record::new(time, channels, samples).unwrap();
    let fit = fit(&record, omega, 7).unwrap();
    Run {
        file: format!("run-{:02}.csv", index + 1),
        level: None,
        enabled: true,
        record: None,
        fit,
        noise_ratio: noise,
        findings: Vec::new(),
    }
}

//! Projects whose records are not steady: a decay after a release, hammer tests, sweeps, noise. The records come from stepping
//! the whole structure through time in sixteenths of a sample, never from the model that judges.

use super::files::{Written, document};
use super::random::Random;
use super::sizing::shaped;
use super::specimen::Specimen;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, Quantity, Record};
use dashpot::response::recording::{Loading, TestSetup, record_test};
use dashpot::response::synthesis::{Noise, record};
use dashpot::structure::Structure;
use serde_json::{Value, json};

/// Classes, each a kind of test.
pub(crate) const CLASSES: [&str; 4] = ["decay", "hammer", "sweep", "noise"];
/// Laws that are hidden.
pub(crate) const LAWS: [Effect; 12] = [
    Effect::Viscous,
    Effect::Coulomb,
    Effect::Quadratic,
    Effect::Power,
    Effect::Stribeck,
    Effect::ElasticSlider,
    Effect::Iwan,
    Effect::Maxwell,
    Effect::Gap,
    Effect::CubicStiffness,
    Effect::QuadraticStiffness,
    Effect::Mass,
];
/// Tests of a project.
const TESTS: usize = 2;

/// What a project is like.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unsteady {
    pub class: &'static str,
    /// None for a model that lacks nothing.
    pub effect: Option<Effect>,
    pub beam: bool,
}

/// One test: what is done, where, and how it is sampled.
pub(crate) struct Test {
    pub loading: Loading,
    pub dof: usize,
    pub rate_hz: f64,
    pub samples: usize,
}

/// What an effect is sized in: the structure with what is known of it, the tests, the rows that are measured.
pub(crate) struct Setup<'a> {
    pub structure: &'a Structure,
    pub known: &'a [Source],
    pub tests: &'a [Test],
    pub sensors: &'a [usize],
}

/// A project; `None` where the effect cannot be made as large as wanted.
pub(crate) fn project(plan: Unsteady, random: &mut Random) -> Option<Written> {
    let specimen = Specimen::random(plan.beam, random);
    let exact = specimen.build();
    let known = specimen.known(&exact, random);
    let detuned = if random.uniform() < 0.5 { 0.0 } else { random.within(0.002, 0.02) * random.sign() };
    let model = if detuned == 0.0 { specimen.clone() } else { specimen.detuned(detuned, random) };
    let tests: Vec<Test> = (0..TESTS).map(|k| test(plan, &exact, k, random)).collect();
    let sensors = sensors(&exact, plan.beam);
    let mut truth = Vec::new();
    if let Some(effect) = plan.effect {
        let source = Source::candidate(effect, Place::Dofs(place(&exact, random)));
        let setup = Setup { structure: &exact, known: &known, tests: &tests, sensors: &sensors };
        truth.push(sized(source, &setup, random.within(0.1, 0.4))?);
    }
    let all: Vec<Source> = known.iter().chain(&truth).cloned().collect();
    let (noise, seed) = (random.within(0.002, 0.01), random.below(1_000_000) as u64);
    let made = |(k, test): (usize, &Test)| -> Option<Record> {
        let channels = channels(plan, &exact, test, &sensors);
        let samples = recorded(&exact, &all, test, &channels)?;
        let time: Vec<f64> = (0..test.samples).map(|n| n as f64 / test.rate_hz).collect();
        record(&time, channels, samples, Some(Noise { ratio: noise, seed, stream: k as u64 })).ok()
    };
    let records: Vec<Record> = tests.iter().enumerate().map(made).collect::<Option<_>>()?;
    let hidden: Vec<Value> = truth.iter().map(|s| document(s, &exact)).collect();
    Some(Written {
        truth: json!({"hidden": hidden, "detuned": detuned}),
        omegas: vec![0.0; records.len()],
        recorded: exact,
        model: model.build(),
        structure_toml: model.toml(),
        matrices: None,
        known,
        records,
        levels: None,
        kind: Some(if plan.class == "decay" { "decay" } else { "transient" }),
    })
}

fn test(plan: Unsteady, structure: &Structure, index: usize, random: &mut Random) -> Test {
    let modes = structure.modes().unwrap();
    let top = modes.len().min(if plan.beam { 3 } else { 6 });
    let [first, second, last] = [0, 1, top - 1].map(|r| modes.frequency_hz(r));
    let rows = structure.translations();
    let dof = if index == 0 { rows[rows.len() - 1] } else { rows[random.below(rows.len())] };
    let force = if plan.beam { 10.0 } else { 200.0 } * random.within(0.5, 2.0);
    let (loading, cycles) = match plan.class {
        "decay" => (Loading::Release { displacement_m: random.within(5e-4, 3e-3), mode: None }, 40.0),
        "hammer" => (Loading::Impulse { peak_n: force, width_s: 0.4 / last, at_s: 0.5 / first, again_s: None }, 40.0),
        "sweep" => {
            let (from_hz, to_hz) = (0.7 * first, 1.2 * second);
            (Loading::Sweep { force_n: 0.1 * force, from_hz, to_hz, logarithmic: index == 1 }, 80.0)
        }
        _ => {
            let seed = random.below(1_000_000) as u64;
            (Loading::Random { rms_n: 0.1 * force, from_hz: 0.5 * first, to_hz: 1.2 * last, seed }, 60.0)
        }
    };
    let rate_hz = (7.0 * last).ceil();
    Test { loading, dof, rate_hz, samples: (rate_hz * cycles / first) as usize }
}

/// All masses of a chain; three places of a beam.
fn sensors(structure: &Structure, beam: bool) -> Vec<usize> {
    let rows = structure.translations();
    if !beam {
        return rows;
    }
    [1, 2, 3].map(|k| rows[k * rows.len() / 3 - 1]).to_vec()
}

pub(crate) fn place(structure: &Structure, random: &mut Random) -> Vec<usize> {
    let (pairs, rows) = (structure.neighbours(), structure.translations());
    if random.uniform() < 0.3 {
        pairs[random.below(pairs.len())].to_vec()
    } else {
        vec![rows[random.below(rows.len())]]
    }
}

fn channels(plan: Unsteady, structure: &Structure, test: &Test, sensors: &[usize]) -> Vec<Channel> {
    let channel = |quantity, dof: usize| Channel { quantity, dof, label: structure.label(dof).to_string() };
    let force = (plan.class != "decay").then(|| channel(Quantity::Force, test.dof));
    force.into_iter().chain(sensors.iter().map(|&dof| channel(Quantity::Acceleration, dof))).collect()
}

pub(crate) fn recorded(
    structure: &Structure,
    sources: &[Source],
    test: &Test,
    channels: &[Channel],
) -> Option<Vec<Vec<f64>>> {
    let setup = TestSetup {
        loading: &test.loading,
        dof: test.dof,
        channels,
        sensors: &[],
        rate_hz: test.rate_hz,
        samples: test.samples,
        filter: true,
    };
    Some(record_test(structure, sources, &setup, &Control::unattended()).ok()?.samples)
}

/// Parameters such that the motion changes by `target`.
pub(crate) fn sized(mut source: Source, setup: &Setup, target: f64) -> Option<Source> {
    let Setup { structure, known, tests, sensors } = *setup;
    let leg = source.place.legs().first().copied()?;
    let channel = |quantity, dof: usize| Channel { quantity, dof, label: structure.label(dof).to_string() };
    let dofs: Vec<usize> = [Some(leg.first), leg.second].into_iter().flatten().collect();
    let both = [Quantity::Displacement, Quantity::Velocity];
    let watched: Vec<Channel> = both.iter().flat_map(|&q| dofs.iter().map(move |&d| channel(q, d))).collect();
    let seen: Vec<Channel> = sensors.iter().map(|&d| channel(Quantity::Acceleration, d)).collect();
    let relative = |y: &[Vec<f64>], k: usize| {
        let relative_sample =
            |n: usize| y[k * dofs.len()][n] - if dofs.len() > 1 { y[k * dofs.len() + 1][n] } else { 0.0 };
        (0..y[0].len()).map(|n| relative_sample(n).abs()).fold(0.0, f64::max)
    };
    let (mut d, mut v) = (0.0_f64, 0.0_f64);
    let mut before = Vec::new();
    for test in tests {
        let motion = recorded(structure, known, test, &watched)?;
        (d, v) = (d.max(relative(&motion, 0)), v.max(relative(&motion, 1)));
        before.push(recorded(structure, known, test, &seen)?);
    }
    let stiffness = 1e-2 * structure.matrices()?.stiffness[(leg.first, leg.first)];
    let mut s = stiffness * d;
    for _ in 0..12 {
        source.parameters = shaped(source.effect, [d, v, v / d], s);
        let all: Vec<Source> = known.iter().cloned().chain([source.clone()]).collect();
        let mut change = 0.0;
        for (test, before) in tests.iter().zip(&before) {
            let after = recorded(structure, &all, test, &seen)?;
            let square = |f: &dyn Fn(usize, usize) -> f64| -> f64 {
                (0..seen.len()).flat_map(|c| (0..test.samples).map(move |n| (c, n))).map(|(c, n)| f(c, n).powi(2)).sum()
            };
            let moved = square(&|c, n| after[c][n] - before[c][n]);
            change += moved / square(&|c, n| before[c][n]) / tests.len() as f64;
        }
        let ratio = (target / change.sqrt().max(1e-9)).clamp(0.2, 5.0);
        if (0.7..1.4).contains(&ratio) {
            return Some(source);
        }
        s *= ratio;
    }
    None
}

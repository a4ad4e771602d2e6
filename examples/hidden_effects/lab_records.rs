//! Decays, hammer tests, sweeps and noise as laboratories record them: a model that is 1 to 3 % off, force and sensors with
//! gains that nobody knows, natural frequencies that scatter from record to record, a pre-trigger, decays that begin long
//! after whatever set them off, and often no sensor where the effect acts. A quarter of the projects lacks nothing. The
//! records come from stepping the true structure through time.

use super::errors::{DRIFT, Truth, factor, perturbed};
use super::files::{Written, document};
use super::random::Random;
use super::specimen::Specimen;
use super::unsteady::{LAWS, Setup, Test, place, recorded, sized};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, Quantity, Record};
use dashpot::response::recording::Loading;
use dashpot::response::synthesis::{Noise, record};
use dashpot::structure::{Part, Structure};
use serde_json::{Value, json};

/// Classes, each a kind of test.
pub(crate) const CLASSES: [&str; 4] = ["rdecay", "rhammer", "rsweep", "rnoise"];
/// Standard deviations, relative: known damping, gains of sensors and of the force.
const KNOWN: f64 = 0.1;
const SENSORS: f64 = 0.01;
const FORCE: f64 = 0.02;
/// Share of the zero of a channel of its largest signal, where it has one: from drifting amplifiers to accelerometers that show gravity.
const ZEROS: [f64; 2] = [0.003, 0.5];

/// What a project of a seed is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    class: &'static str,
    /// Nothing in a quarter of them.
    effect: Option<Effect>,
    percent: u8,
    beam: bool,
}

impl Plan {
    /// The project of a seed and class number `c`.
    pub(crate) fn of(seed: u64, c: usize, random: &mut Random) -> Self {
        let turn = seed + c as u64;
        let law = (turn / 4 * 3 + turn % 4 + 5 * c as u64) % LAWS.len() as u64;
        let effect = (turn % 4 != 3).then(|| LAWS[law as usize]);
        Self { class: CLASSES[c], effect, percent: 1 + random.below(3) as u8, beam: random.uniform() < 0.5 }
    }

    pub(crate) fn name(self, seed: u64) -> String {
        let structure = if self.beam { "beam" } else { "chain" };
        format!("{}-{structure}-{}-{}-{seed}", self.class, self.effect.map_or("none", Effect::name), self.percent)
    }
}

/// A project of a plan; `None` where the effect cannot be made as large as wanted or would be lost among the errors.
pub(crate) fn project(plan: Plan, random: &mut Random) -> Option<Written> {
    let specimen = Specimen::random(plan.beam, random);
    let model = specimen.build();
    let percent = f64::from(plan.percent);
    let (truth, errors) = perturbed(&specimen, &[], percent, random);
    let known = specimen.known(&model, random);
    let factors: Vec<f64> = known.iter().map(|_| factor(KNOWN, random)).collect();
    let true_known: Vec<Source> =
        known.iter().zip(&factors).map(|(s, f)| mapped(s, &truth, &[s.parameters[0] * f])).collect();
    let hidden = plan.effect.map(|effect| Source::candidate(effect, Place::Dofs(place(&model, random))));
    let sensors = sensors(&model, hidden.as_ref(), random);
    let rows: Vec<usize> = sensors.iter().map(|&s| truth.row[s]).collect();
    let tests: Vec<Test> = (0..=random.below(3)).map(|k| test(plan, &model, &truth, k, random)).collect();
    let quantity = match random.uniform() {
        x if x < 0.7 => Quantity::Acceleration,
        x if x < 0.85 => Quantity::Velocity,
        _ => Quantity::Displacement,
    };
    let mut hidden_true = Vec::new();
    if let Some(source) = &hidden {
        let source = mapped(source, &truth, &source.parameters);
        let large = source.effect.is_linear();
        let target = if large { random.within(0.3, 0.6) } else { random.within(0.15, 0.5) };
        let setup = Setup { structure: &truth.structure, known: &true_known, tests: &tests, sensors: &rows };
        let sized = sized(source, &setup, target)?;
        let own = truth.structure.matrices()?.mass[(sized.place.legs()[0].first, sized.place.legs()[0].first)];
        if sized.effect == Effect::Mass && sized.parameters[0] < 0.05 * percent * own {
            return None;
        }
        hidden_true.push(sized);
    }
    let all: Vec<Source> = true_known.iter().chain(&hidden_true).cloned().collect();
    let gains: Vec<f64> = (0..=rows.len()).map(|k| factor(if k == 0 { FORCE } else { SENSORS }, random)).collect();
    let chances: Vec<f64> = rows.iter().map(|_| random.uniform()).collect();
    // The force cell has one of its own, of the digits that the chance of the first sensor leaves.
    let offsets: Vec<f64> = std::iter::once((10.0 * chances[0]).fract()).chain(chances).map(zero).collect();
    let noise = random.within(0.002, 0.01);
    let chain =
        Measuring { quantity, rows: &rows, gains: &gains, offsets: &offsets, noise, decay: plan.class == "rdecay" };
    // Natural frequencies scatter from record to record.
    let drift: Vec<f64> = tests.iter().map(|_| factor(DRIFT, random)).collect();
    let drifted = |factor: &f64| truth.structure.with_factors(&[(Part::Stiffness, factor.powi(2))]);
    let records: Vec<Record> = tests
        .iter()
        .zip(&drift)
        .map(|(test, f)| chain.record(&drifted(f), &all, test, random))
        .collect::<Option<_>>()?;
    let documents: Vec<Value> = hidden_true.iter().map(|s| document(s, &truth.structure)).collect();
    Some(Written {
        truth: json!({
            "hidden": documents,
            "percent": plan.percent,
            "model": errors,
            "known": factors,
            "gains": gains,
            "offsets": offsets,
            "drift": drift,
            "noise": noise,
        }),
        omegas: vec![0.0; records.len()],
        recorded: truth.structure,
        structure_toml: specimen.toml(),
        model,
        matrices: None,
        known,
        records,
        levels: None,
        kind: Some(if plan.class == "rdecay" { "decay" } else { "transient" }),
    })
}

/// The zero of a channel, of a uniform chance: a fifth of the channels has one, its logarithm uniform.
fn zero(chance: f64) -> f64 {
    let among = chance / 0.2;
    if among < 1.0 { ZEROS[0] * (ZEROS[1] / ZEROS[0]).powf(among) } else { 0.0 }
}

/// A source of the model in the true structure.
fn mapped(source: &Source, truth: &Truth, parameters: &[f64]) -> Source {
    let place = match &source.place {
        Place::Dofs(dofs) => Place::Dofs(dofs.iter().map(|&d| truth.row[d]).collect()),
        place => place.clone(),
    };
    Source { place, parameters: parameters.to_vec(), ..source.clone() }
}

/// A few places that are measured; half of the laboratories has no sensor where the effect acts.
fn sensors(model: &Structure, hidden: Option<&Source>, random: &mut Random) -> Vec<usize> {
    let mut rows = model.translations();
    if let Some(Place::Dofs(dofs)) = hidden.map(|s| &s.place)
        && random.uniform() < 0.5
    {
        rows.retain(|r| !dofs.contains(r));
    }
    let most = if random.uniform() < 0.5 { 3 } else { 5 };
    while rows.len() > most {
        rows.remove(random.below(rows.len()));
    }
    rows
}

fn test(plan: Plan, model: &Structure, truth: &Truth, index: usize, random: &mut Random) -> Test {
    let modes = truth.structure.modes().unwrap();
    let top = modes.len().min(if plan.beam { 3 } else { 6 });
    let [first, second, last] = [0, 1, top - 1].map(|r| modes.frequency_hz(r));
    let rows = model.translations();
    let dof = if index == 0 { rows[rows.len() - 1] } else { rows[random.below(rows.len())] };
    let force = if plan.beam { 10.0 } else { 200.0 } * random.within(0.5, 2.0);
    let at_s = random.within(0.3, 3.0) / first;
    let impulse = Loading::Impulse { peak_n: force, width_s: 0.4 / last, at_s, again_s: None };
    let (loading, cycles) = match plan.class {
        "rdecay" if random.uniform() < 0.6 => {
            (Loading::Release { displacement_m: random.within(5e-4, 3e-3), mode: None }, 50.0)
        }
        "rdecay" | "rhammer" => (impulse, 45.0),
        "rsweep" => {
            let (from_hz, to_hz) = (0.7 * first, 1.2 * second);
            (Loading::Sweep { force_n: 0.1 * force, from_hz, to_hz, logarithmic: index == 1 }, 80.0)
        }
        _ => {
            let seed = random.below(1_000_000) as u64;
            (Loading::Random { rms_n: 0.1 * force, from_hz: 0.5 * first, to_hz: 1.2 * last, seed }, 60.0)
        }
    };
    let rate_hz = (random.within(7.0, 14.0) * last).ceil();
    Test { loading, dof: truth.row[dof], rate_hz, samples: (rate_hz * cycles / first) as usize }
}

/// The measuring chain of a project.
struct Measuring<'a> {
    quantity: Quantity,
    rows: &'a [usize],
    /// Of the force, then of every sensor.
    gains: &'a [f64],
    /// Alike, over the largest signal.
    offsets: &'a [f64],
    noise: f64,
    decay: bool,
}

impl Measuring<'_> {
    fn record(&self, structure: &Structure, sources: &[Source], test: &Test, random: &mut Random) -> Option<Record> {
        let channel = |quantity, dof: usize| Channel { quantity, dof, label: structure.label(dof).to_string() };
        let force = (!self.decay).then(|| channel(Quantity::Force, test.dof));
        let channels: Vec<Channel> =
            force.into_iter().chain(self.rows.iter().map(|&dof| channel(self.quantity, dof))).collect();
        let mut samples = recorded(structure, sources, test, &channels)?;
        let first = self.first(test, random);
        let first_channel = usize::from(self.decay);
        let (gains, offsets) = (&self.gains[first_channel..], &self.offsets[first_channel..]);
        for (list, (gain, offset)) in samples.iter_mut().zip(gains.iter().zip(offsets)) {
            list.drain(..first);
            let largest = list.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
            list.iter_mut().for_each(|y| *y = gain * *y + offset * largest);
        }
        let time: Vec<f64> = (first..test.samples).map(|n| n as f64 / test.rate_hz).collect();
        let seed = random.below(1_000_000) as u64;
        record(&time, channels, samples, Some(Noise { ratio: self.noise, seed, stream: 0 })).ok()
    }

    /// First sample that is kept: a decay begins some time after the release or the blow.
    fn first(&self, test: &Test, random: &mut Random) -> usize {
        let after = match test.loading {
            _ if !self.decay => return 0,
            Loading::Impulse { at_s, width_s, .. } => at_s + 1.5 * width_s,
            _ if random.uniform() < 0.5 => return 0,
            _ => 0.0,
        };
        ((after + random.within(0.0, 0.04) * test.samples as f64 / test.rate_hz) * test.rate_hz) as usize
    }
}

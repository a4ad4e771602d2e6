//! Projects as laboratories have them: the file states a model that is 1, 2 or 3 % off, the records come from the true
//! structure through a measuring chain with its usual errors.

use super::errors::{ChannelErrors, KNOWN, Truth, factor, imported, perturbed};
use super::files::Written;
use super::random::Random;
use super::records::{Chain, steady};
use super::sizing::{place, size};
use super::specimen::Specimen;
use super::suite::{Kindness, excitations, sensors};
use dashpot::effects::{Effect, Kind, Place, Source};
use dashpot::measurement::Record;
use dashpot::response::harmonic_balance::Excitation;
use dashpot::structure::points::PointParameters;
use dashpot::structure::{LumpedMass, Part, Structure};
use serde_json::{Value, json};

/// What is hidden, in turn; the order is part of what a seed means, so laws are only ever added at the end.
pub(crate) const LAWS: [Effect; 20] = [
    Effect::Viscous,
    Effect::Coulomb,
    Effect::Quadratic,
    Effect::Power,
    Effect::Hysteretic,
    Effect::Stribeck,
    Effect::ElasticSlider,
    Effect::Maxwell,
    Effect::Iwan,
    Effect::Fractional,
    Effect::Stiffness,
    Effect::CubicStiffness,
    Effect::QuadraticStiffness,
    Effect::Gap,
    Effect::Mass,
    Effect::LossFactor,
    Effect::StiffnessProportional,
    Effect::MassProportional,
    Effect::Delay,
    Effect::Gain,
];

/// What a project of a seed is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    /// Nothing in a quarter of them.
    pub effect: Option<Effect>,
    /// How far springs and masses are off, %.
    pub percent: u8,
    pub form: Form,
    /// Whether the damping of the whole structure is stated as structural and is viscous.
    pub structural: bool,
}

/// What the project file gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    Beam,
    Chain,
    /// The same as matrices without lines.
    BeamMatrices,
    ChainMatrices,
    /// No matrices at all: energies.
    Points,
}

impl Form {
    fn word(self) -> &'static str {
        match self {
            Self::Beam => "beam",
            Self::Chain => "chain",
            Self::BeamMatrices => "matbeam",
            Self::ChainMatrices => "matchain",
            Self::Points => "points",
        }
    }

    fn is_beam(self) -> bool {
        matches!(self, Self::Beam | Self::BeamMatrices)
    }
}

impl Plan {
    pub(crate) fn of(seed: u64, random: &mut Random) -> Self {
        let hidden = (seed % 4 != 3).then(|| LAWS[((seed / 4 * 3 + seed % 4) % LAWS.len() as u64) as usize]);
        let percent = 1 + random.below(3) as u8;
        let dissipates = |e: Effect| matches!(e.kind(), Kind::Relative(_)) && e.dissipates() && e != Effect::Stiffness;
        let form = match random.uniform() {
            x if x < 0.40 => Form::Beam,
            x if x < 0.52 => Form::BeamMatrices,
            x if x < 0.64 => Form::ChainMatrices,
            x if x < 0.72 && hidden.is_none_or(dissipates) => Form::Points,
            _ => Form::Chain,
        };
        Self { effect: hidden, percent, form, structural: false }
    }

    /// Whether a loss factor is stated where damping is viscous: not without matrices, nor where a law of the whole structure is hidden.
    fn states_structural(self) -> bool {
        let whole = self.effect.is_some_and(|e| matches!(e.kind(), Kind::Whole(_)));
        self.structural && self.form != Form::Points && !whole
    }

    pub(crate) fn name(self, seed: u64) -> String {
        let effect = self.effect.map_or("none", Effect::name);
        let class = if self.structural { "structural" } else { "lab" };
        format!("{class}{}-{}-{effect}-{seed}", self.percent, self.form.word())
    }
}

/// A project of a plan; none where no periodic motion was found or the effect would be lost among the errors.
pub(crate) fn project(plan: Plan, random: &mut Random) -> Option<Written> {
    let specimen = Specimen::random(plan.form.is_beam(), random);
    let lumped = lumped(&specimen, random);
    let model = specimen.build_with(&lumped);
    let percent = f64::from(plan.percent);
    let (mut truth, mut errors) = perturbed(&specimen, &lumped, percent, random);
    let kindness = kindness(plan, random);
    let known = known(plan, &specimen, &model, random);
    let factors: Vec<f64> = known.iter().map(|s| known_factor(s, percent, random)).collect();
    if known.last().is_some_and(|s| s.effect == Effect::Stiffness) {
        errors.ground_spring = factors.last().copied();
    }
    let stated = known.clone();
    let true_known: Vec<Source> = known
        .iter()
        .zip(&factors)
        .map(|(s, f)| truth.mapped(s, &[&[s.parameters[0] * f], &s.parameters[1..]].concat()))
        .map(|s| if s.effect == Effect::LossFactor { viscous_instead_of(&s, &truth) } else { s })
        .collect();
    if plan.states_structural() {
        truth.structure = damped_alike(&truth.structure, random);
    }
    let modes = truth.structure.modes().unwrap();
    let mut excitations = excitations(&model, &modes.omega, kindness, random);
    let sensors = sensors(&model, kindness, random);
    let hidden =
        plan.effect.map(|effect| hidden_place(effect, &model, &known, &sensors, excitations[0].forces[0].dof, random));
    excitations.iter_mut().flat_map(|e| &mut e.forces).for_each(|f| f.dof = truth.row[f.dof]);
    let rows: Vec<usize> = sensors.iter().map(|&s| truth.row[s]).collect();
    let mut hidden_true = Vec::new();
    if let Some(source) = &hidden {
        let source = truth.mapped(source, &source.parameters);
        let sized = size(source, &truth.structure, &true_known, &excitations, &rows, kindness.size, random)?;
        if !stands_out(&sized, &truth.structure, percent) {
            return None;
        }
        hidden_true.push(sized);
    }
    let mut channels: Vec<String> = rows.iter().map(|&s| format!("acc@{}", truth.structure.label(s))).collect();
    channels.push(format!("force@{}", truth.structure.label(excitations[0].forces[0].dof)));
    let careful = plan.effect.is_some_and(|e| matches!(e.kind(), Kind::Channel(_)));
    let measured = ChannelErrors::random(&channels, excitations.len(), careful, random);
    let records = records(&truth, &true_known, &hidden_true, &excitations, &rows, &measured, kindness, random)?;
    let levels = (random.uniform() < 0.5).then(|| levels(&excitations));
    let documents = hidden_true.iter().map(|s| document(s, &truth.structure, &measured)).collect::<Vec<_>>();
    Some(Written {
        truth: json!({
            "hidden": documents,
            "percent": plan.percent,
            "structure": plan.form.word(),
            "size": plan.effect.map(|_| kindness.size),
            "noise": kindness.noise,
            "unsettled": kindness.unsettled.then_some(super::suite::file(1)),
            "model": errors,
            "known": factors,
            "measurement": measured,
        }),
        kind: None,
        structure_toml: toml(plan.form, &specimen, &lumped, &model),
        matrices: matches!(plan.form, Form::BeamMatrices | Form::ChainMatrices).then(|| imported(&model, 1.0)),
        model,
        recorded: truth.structure,
        known: stated,
        records,
        omegas: excitations.iter().map(|e| e.omega).collect(),
        levels,
    })
}

fn kindness(plan: Plan, random: &mut Random) -> Kindness {
    let r = random;
    Kindness {
        beam: plan.form.is_beam(),
        points: plan.form == Form::Points,
        sensors: 3 + r.below(5),
        runs: 12 + r.below(13),
        levels: 2 + r.below(3),
        noise: r.within(0.002, 0.015),
        size: size_of(plan.effect, r),
        detuned: 0.0,
        unsettled: r.uniform() < 0.1,
    }
}

/// Change of the response that is wanted: what the errors of the model do as well, linear damping beside known damping
/// that is 20 % off, springs and masses beside those that are 3 % off, must be larger to be there at all.
fn size_of(effect: Option<Effect>, random: &mut Random) -> f64 {
    match effect {
        Some(Effect::Stiffness | Effect::Mass) => random.within(0.4, 0.9),
        Some(e) if e.is_linear() && !matches!(e.kind(), Kind::Channel(_)) => random.within(0.25, 0.6),
        _ => random.within(0.12, 0.5),
    }
}

/// Half of the beams carry a mass that the project states.
fn lumped(specimen: &Specimen, random: &mut Random) -> Vec<LumpedMass> {
    let Specimen::Beam(beam) = specimen else { return Vec::new() };
    if random.uniform() < 0.5 {
        return Vec::new();
    }
    let structure = specimen.build();
    let rows = structure.translations();
    let mass = beam.length * beam.breadth * beam.depth * beam.density * random.within(0.05, 0.2);
    vec![LumpedMass { dof: structure.label(rows[random.below(rows.len())]).to_string(), mass }]
}

/// The viscous law that damps the first mode as a loss factor does.
fn viscous_instead_of(structural: &Source, truth: &Truth) -> Source {
    let beta = structural.parameters[0] / truth.structure.modes().unwrap().omega[0];
    Source::known(Effect::StiffnessProportional, Place::Whole(None), &[beta])
}

/// A structure in which damping in proportion to stiffness damps all modes about as much as the first, as a loss factor does at their
/// natural frequencies.
fn damped_alike(structure: &Structure, random: &mut Random) -> Structure {
    let omega = structure.modes().unwrap().omega;
    let of_mode = |(mode, w): (usize, &f64)| (Part::ModeDamping(mode), omega[0] / w * factor(KNOWN, random));
    structure.with_factors(&omega.iter().enumerate().map(of_mode).collect::<Vec<_>>())
}

/// What the project knows: damping, and on some beams a spring to the ground. Nothing that the hidden effect is a part of.
fn known(plan: Plan, specimen: &Specimen, model: &Structure, random: &mut Random) -> Vec<Source> {
    let mut known = specimen.known(model, random);
    if plan.effect.is_some_and(|e| matches!(e.kind(), Kind::Whole(_))) {
        known.retain(|s| !matches!(s.effect.kind(), Kind::Whole(_)));
    } else if plan.states_structural() {
        known = vec![Source::known(Effect::LossFactor, Place::Whole(None), &[random.within(0.006, 0.02)])];
    }
    if let Specimen::Beam(beam) = specimen
        && random.uniform() < 0.3
    {
        let rows = model.translations();
        let bending = beam.youngs_modulus * beam.breadth * beam.depth.powi(3) / 12.0;
        let k = 3.0 * bending / beam.length.powi(3) * random.within(0.1, 0.5);
        known.push(Source::known(Effect::Stiffness, Place::Dofs(vec![rows[rows.len() * 2 / 3]]), &[k]));
    }
    known
}

fn known_factor(source: &Source, percent: f64, random: &mut Random) -> f64 {
    factor(if source.effect == Effect::Stiffness { percent / 100.0 } else { KNOWN }, random)
}

/// A place where the project knows nothing of the same law.
fn hidden_place(
    effect: Effect,
    model: &Structure,
    known: &[Source],
    sensors: &[usize],
    force: usize,
    random: &mut Random,
) -> Source {
    loop {
        let source = place(effect, model, sensors, force, random);
        let on_rotation = |dofs: &[usize]| dofs.iter().any(|&d| model.dofs()[d].direction.is_rotation());
        let fits = match &source.place {
            // A mass is a body at a point.
            Place::Dofs(dofs) => effect != Effect::Mass || (dofs.len() == 1 && !on_rotation(dofs)),
            Place::Whole(_) | Place::Channel(_) => true,
        };
        if fits && !known.iter().any(|k| k.effect == effect && k.place.is_same(&source.place)) {
            return source;
        }
    }
}

/// Whether a spring or mass is more than what is there already may be off by.
fn stands_out(source: &Source, structure: &Structure, percent: f64) -> bool {
    let (Place::Dofs(dofs), Some(matrices)) = (&source.place, structure.matrices()) else { return true };
    let own = match (source.effect, dofs.as_slice()) {
        (Effect::Mass, [i]) => matrices.mass[(*i, *i)],
        (Effect::Stiffness, [i, j]) if structure.dofs()[*i].direction == dashpot::structure::Direction::X => {
            matrices.stiffness[(*i, *j)].abs()
        }
        (Effect::Stiffness, [i]) if structure.dofs()[*i].direction == dashpot::structure::Direction::X => {
            (0..structure.len()).map(|j| matrices.stiffness[(*i, j)]).sum::<f64>().abs()
        }
        _ => return true,
    };
    source.parameters[0].abs() >= 5.0 * percent / 100.0 * own
}

#[expect(clippy::too_many_arguments, reason = "all of a test")]
fn records(
    truth: &Truth,
    known: &[Source],
    hidden: &[Source],
    excitations: &[Excitation],
    sensors: &[usize],
    errors: &ChannelErrors,
    kindness: Kindness,
    random: &mut Random,
) -> Option<Vec<Record>> {
    let all: Vec<Source> = known.iter().chain(hidden).cloned().collect();
    let mut records = Vec::new();
    for (r, excitation) in excitations.iter().enumerate() {
        let drifted = imported(&truth.structure, (1.0 + errors.drift[r]).powi(2)).build(&[]).unwrap();
        let damping = truth.structure.damping_of_modes().iter().map(|d| (Part::ModeDamping(d.mode), d.factor));
        let structure = drifted.with_factors(&damping.collect::<Vec<_>>());
        let motion = steady(&structure, &all, excitation)?;
        let mut faults = errors.faults(r);
        faults.extend(hidden.iter().filter(|s| matches!(s.effect.kind(), Kind::Channel(_))).cloned());
        let transient = if kindness.unsettled && r == 1 { 0.2 } else { 0.0 };
        let chain = Chain { structure: &truth.structure, sensors, truth: &faults, noise: kindness.noise, transient };
        records.push(chain.record(excitation, &motion, random));
    }
    Some(records)
}

/// The number of each run's level of force, as an engineer numbers them.
fn levels(excitations: &[Excitation]) -> Vec<i64> {
    let force = |e: &Excitation| e.forces[0].harmonics[0].norm();
    let least = excitations.iter().map(force).fold(f64::INFINITY, f64::min);
    let number = |ratio: f64| [1.7, 5.0, 10.0].iter().filter(|&&bound| ratio > bound).count() as i64 + 1;
    excitations.iter().map(|e| number(force(e) / least)).collect()
}

fn toml(form: Form, specimen: &Specimen, lumped: &[LumpedMass], model: &Structure) -> String {
    match form {
        Form::Points => {
            let labels: Vec<String> = (0..model.len()).map(|i| model.label(i).to_string()).collect();
            assert!(PointParameters { dofs: labels.clone(), positions: None }.build().is_ok());
            format!("kind = \"points\"\ndofs = {labels:?}\n")
        }
        Form::ChainMatrices => "kind = \"matrices\"\nmass = \"mass.mtx\"\nstiffness = \"stiffness.mtx\"\n".to_string(),
        Form::BeamMatrices => "kind = \"matrices\"\nmass = \"mass.mtx\"\nstiffness = \"stiffness.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.csv\"\n".to_string(),
        Form::Beam | Form::Chain => {
            let mass = |l: &LumpedMass| format!("\n[[structure.lumped_mass]]\ndof = {:?}\nmass = {:?}\n", l.dof, l.mass);
            format!("{}{}", specimen.toml(), lumped.iter().map(mass).collect::<String>())
        }
    }
}

/// An effect in the words of `diagnose --json`. The gain of a channel is what it reads in all.
fn document(source: &Source, structure: &Structure, errors: &ChannelErrors) -> Value {
    let mut source = source.clone();
    if let (Effect::Gain, Place::Channel(channel)) = (source.effect, &source.place) {
        let own = errors.gains.iter().find(|(name, _)| name == channel);
        source.parameters[0] *= own.map_or(1.0, |(_, gain)| *gain);
    }
    super::files::document(&source, structure)
}

impl Truth {
    /// A source of the model at the same DOFs here.
    fn mapped(&self, source: &Source, parameters: &[f64]) -> Source {
        let place = match &source.place {
            Place::Dofs(dofs) => Place::Dofs(dofs.iter().map(|&d| self.row[d]).collect()),
            place => place.clone(),
        };
        Source { place, parameters: parameters.to_vec(), ..source.clone() }
    }
}

impl ChannelErrors {
    /// What each channel does to the amplitudes of a run, as effects.
    fn faults(&self, run: usize) -> Vec<Source> {
        let gain =
            |channel: &str, value: f64| Source::known(Effect::Gain, Place::Channel(channel.to_string()), &[value]);
        let mut list: Vec<Source> = self.gains.iter().map(|(channel, value)| gain(channel, *value)).collect();
        if let Some((force, _)) = self.gains.last() {
            list.push(gain(force, self.force_level[run]));
        }
        if let Some(bad) = &self.bad_sensor {
            list.push(match bad.kind {
                "delay" => Source::known(Effect::Delay, Place::Channel(bad.channel.clone()), &[bad.value]),
                "loose" => gain(&bad.channel, bad.by_run[run]),
                _ => gain(&bad.channel, bad.value),
            });
        }
        list
    }
}

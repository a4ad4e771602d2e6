//! `dashpot simulate`: records of the model of a project under its runs' excitations, steady ones and others.

use super::arguments::{Method, Records, Simulate};
use super::moving_base::{self, MovingBase};
use super::recorded_base::RecordedBase;
use super::simulate_component as component;
use super::simulate_write::{at_run, fit_record, write};
use crate::control::Control;
use crate::effects::{Source, State};
use crate::exchange::project::{Plan, PlannedBase, PlannedForce, PlannedTest, open};
use crate::measurement::base::AXES;
use crate::measurement::channel::ChannelName;
use crate::measurement::{Channel, ChannelFit, Quantity, Record};
use crate::response::harmonic_balance::{Excitation, HarmonicForce};
use crate::response::recording::{Loading, TestSetup, quantise, record_base_test, record_test};
use crate::response::simulation::{Simulator, recorded, transfer, usual_channels};
use crate::response::simulation_in_time::{InTime, Recorder, record_in_time};
use crate::response::synthesis::{self, Noise, sampling_times, synthesise};
use crate::structure::{Part, Structure, StructureKind};
use anyhow::{Context, anyhow, bail};
use faer::c64;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Makes the records and says what was written.
pub(super) fn run(arguments: &Simulate) -> anyhow::Result<String> {
    let plan = open(&arguments.file)?;
    if arguments.records == Records::Frf {
        return super::simulate_frf::run(&plan, arguments);
    }
    let name = arguments.file.display();
    let sources: Vec<Source> = plan.sources.iter().filter(|s| s.state == State::Known).cloned().collect();
    plan.records_stay_inside()?;
    if plan.structure.kind() == StructureKind::Component {
        return component::run(&plan, &sources, arguments);
    }
    let model = Simulator::new(&plan.structure, &sources).with_context(|| format!("{name}"))?;
    if plan.runs.is_empty() {
        bail!("{name}: there is no [[run]] to simulate; add runs with file, frequency, force_dof and force_n");
    }
    let mut simulated = Vec::new();
    for index in 0..plan.runs.len() {
        let noise = arguments.noise_of(index);
        if let Some(test) = plan.runs[index].test {
            let record = recorded_test(&plan, index, test, &shifted(&plan, index), &sources, noise);
            simulated.push(record.map_err(|error| at_run(&plan, index, error))?);
            continue;
        }
        let record = steady_record(&plan, index, &model, &sources, arguments, noise);
        simulated.push(record.map_err(|error| at_run(&plan, index, error))?);
    }
    write(&plan, &simulated, arguments)
}

/// The record of one steady run: by harmonic balance, or stepped through time.
fn steady_record(
    plan: &Plan,
    index: usize,
    model: &Simulator<'_>,
    sources: &[Source],
    arguments: &Simulate,
    noise: Option<Noise>,
) -> anyhow::Result<Record> {
    let (test, structure) = (test(plan, index)?, shifted(plan, index));
    let is_stepped = arguments.by == Method::Time || arguments.transient > 0.0 || plan.simulate().integrate;
    if is_stepped && !test.bases.is_empty() {
        bail!("a moving base is not stepped through time; leave out --by time, --transient and `integrate`");
    }
    if is_stepped {
        in_time(&structure, &plan.sensors, sources, &test, arguments, noise)
    } else if plan.runs[index].frequency_shift.is_some() {
        balanced(plan, &Simulator::new(&structure, sources)?, &test, noise)
    } else {
        balanced(plan, model, &test, noise)
    }
}

/// The structure as it is in one run: temperature and re-seating shift all its natural frequencies by `s`, so that its
/// stiffness is `(1 + s)^2` of what it was.
fn shifted(plan: &Plan, index: usize) -> Cow<'_, Structure> {
    match plan.runs[index].frequency_shift {
        Some(shift) => Cow::Owned(plan.structure.with_factors(&[(Part::Stiffness, (1.0 + shift).powi(2))])),
        None => Cow::Borrowed(&plan.structure),
    }
}

/// What drives a run, what is recorded and when: from the recipe, or from the record that is there.
struct Test {
    excitation: Excitation,
    /// How the base moves, where it does.
    bases: Vec<MovingBase>,
    channels: Vec<Channel>,
    time: Vec<f64>,
}

fn balanced(plan: &Plan, model: &Simulator<'_>, test: &Test, noise: Option<Noise>) -> anyhow::Result<Record> {
    let control = Control::unattended();
    let response = model.respond(&test.excitation, &control)?;
    let mut motions = recorded(&response, &test.excitation, &test.channels, &plan.sensors);
    test.bases.iter().for_each(|base| base.show(&mut motions, test.excitation.omega, &plan.sensors));
    Ok(synthesise(test.excitation.omega, &test.time, &motions, noise)?)
}

fn in_time(
    structure: &Structure,
    sensors: &[Source],
    sources: &[Source],
    test: &Test,
    arguments: &Simulate,
    noise: Option<Noise>,
) -> anyhow::Result<Record> {
    let recorder = Recorder { channels: &test.channels, sensors, time: &test.time };
    let settings = InTime { steps: arguments.steps as usize, transient: arguments.transient };
    let control = Control::unattended();
    let samples = record_in_time(structure, sources, &test.excitation, &recorder, &settings, &control)?;
    Ok(synthesis::record(&test.time, test.channels.clone(), samples, noise)?)
}

/// A test that is not steady, recorded with filter, noise and converter.
fn recorded_test(
    plan: &Plan,
    index: usize,
    test: PlannedTest,
    structure: &Structure,
    sources: &[Source],
    noise: Option<Noise>,
) -> anyhow::Result<Record> {
    let table = plan.simulate();
    let rate_hz = table.rate_hz.ok_or_else(|| anyhow!("the sampling rate is missing; add `rate_hz` to [simulate]"))?;
    let samples = (test.duration_s * rate_hz).round() as usize;
    if !(16..=100_000_000).contains(&samples) {
        bail!("{samples} samples come of duration_s and rate_hz; between 16 and 100000000 can be recorded");
    }
    if matches!(test.loading, Loading::Cycles { .. }) {
        bail!(
            "kind = \"cycles\" imposes a displacement, which only a component can bear: give a force, or [structure] kind = \"component\""
        );
    }
    let force = Excitation::sine(TAU, test.dof, c64::new(0.0, 0.0));
    let mut channels =
        if table.channels.is_empty() { usual_channels(&plan.structure, &force) } else { channels(plan)? };
    let base = if test.loading == Loading::Base { Some(RecordedBase::read(plan, index)?) } else { None };
    if matches!(test.loading, Loading::Release { .. } | Loading::Base) && table.channels.is_empty() {
        channels.retain(|channel| channel.quantity != Quantity::Force);
        channels.splice(0..0, base.as_ref().map(RecordedBase::channel));
    }
    let (sensors, filter) = (&plan.sensors, table.filter);
    let setup =
        TestSetup { loading: &test.loading, dof: test.dof, channels: &channels, sensors, rate_hz, samples, filter };
    let made = match &base {
        Some(base) => record_base_test(structure, sources, &setup, &base.motion(), &Control::unattended())?,
        None => record_test(structure, sources, &setup, &Control::unattended())?,
    };
    let record = synthesis::record(&made.time, channels, made.samples, noise)?;
    Ok(match table.bits {
        Some(bits) => record.quantised(|samples| quantise(samples, bits)),
        None => record,
    })
}

fn test(plan: &Plan, index: usize) -> anyhow::Result<Test> {
    let run = &plan.runs[index];
    match (run.force, run.base) {
        (None, None) => from_record(plan, index),
        (force, base) => from_recipe(plan, index, force, base),
    }
}

fn from_recipe(
    plan: &Plan,
    index: usize,
    force: Option<PlannedForce>,
    base: Option<PlannedBase>,
) -> anyhow::Result<Test> {
    let run = &plan.runs[index];
    let missing =
        || anyhow!("the frequency is not given and there is no record to take it from; add `frequency = ...` in Hz");
    let frequency = run.frequency_hz.ok_or_else(missing)?;
    let omega = TAU * frequency;
    let sine = |force: PlannedForce| Excitation::sine(omega, force.dof, c64::new(force.amplitude_n, 0.0));
    let mut excitation = force.map_or(Excitation { omega, forces: Vec::new() }, sine);
    let mut usual = usual_channels(&plan.structure, &excitation);
    let mut bases = Vec::new();
    if let Some(PlannedBase { axis, acceleration }) = base {
        let moving = MovingBase::new(plan, index, axis, vec![c64::new(acceleration, 0.0)])?;
        usual.insert(0, moving.channel());
        moving.drive(&mut excitation);
        bases.push(moving);
    }
    let table = plan.simulate();
    let channels = if table.channels.is_empty() { usual } else { channels(plan)? };
    Ok(Test { excitation, bases, channels, time: sampling_times(omega, table.periods as f64, table.samples) })
}

/// The measured force's harmonics, freed of the channel's known errors, drive the model; what was recorded is recorded
/// again.
fn from_record(plan: &Plan, index: usize) -> anyhow::Result<Test> {
    let record = plan.record(index, &Control::unattended())?;
    let fit = fit_record(plan, index, &record)?;
    let truth = |fitted: &ChannelFit| {
        let amplitude =
            |(h, y): (usize, &c64)| y / transfer(&plan.sensors, &fitted.channel, (h + 1) as f64 * fit.omega);
        let harmonics = fitted.amplitudes.iter().enumerate().map(amplitude).collect();
        HarmonicForce { dof: fitted.channel.dof, mean: 0.0, harmonics }
    };
    let forces = fit.channels.iter().filter(|fitted| fitted.channel.quantity == Quantity::Force).map(truth).collect();
    let mut excitation = Excitation { omega: fit.omega, forces };
    let mut bases = Vec::new();
    for moving in fit.channels.iter().filter(|fitted| fitted.channel.quantity == Quantity::Base) {
        let Some(axis) = AXES.iter().position(|&axis| axis == moving.channel.label) else { continue };
        let base = MovingBase::new(plan, index, axis, truth(moving).harmonics)?;
        base.drive(&mut excitation);
        bases.push(base);
    }
    Ok(Test { excitation, bases, channels: record.channels().to_vec(), time: record.time().to_vec() })
}

/// The channels named in `[simulate]`.
fn channels(plan: &Plan) -> anyhow::Result<Vec<Channel>> {
    let channel = |text: &String| {
        let name = ChannelName::parse(text)?;
        let axis = AXES.iter().position(|&axis| axis == name.label);
        if name.quantity == Quantity::Base
            && let Some(axis) = axis
        {
            return Ok(moving_base::channel(plan, axis));
        }
        let dof = plan.structure.require_dof(&name.label)?;
        Ok(Channel { quantity: name.quantity, dof, label: name.label })
    };
    plan.simulate().channels.iter().map(channel).collect()
}

//! `dashpot simulate --as frf`: a hammer test of the model, written as a Universal File.

use super::arguments::Simulate;
use crate::control::Control;
use crate::effects::{Source, State};
use crate::exchange::frf::{SimulatedSet, write_responses};
use crate::exchange::project::Plan;
use crate::exchange::project::frf::FrfTable;
use crate::measurement::channel::ChannelName;
use crate::measurement::frf::{FrequencyResponse, ResponseSet};
use crate::measurement::{Channel, Quantity};
use crate::response::hammer::HammerTest;
use crate::response::harmonic_balance::Excitation;
use crate::response::simulation::{Simulator, recorded};
use anyhow::{Context, bail};
use faer::c64;
use std::f64::consts::TAU;
use std::fs;

/// Hits averaged unless the table says otherwise.
const USUAL_AVERAGES: usize = 5;

/// Writes every `[[frf]]` of the recipe and says what was written.
pub(super) fn run(plan: &Plan, arguments: &Simulate) -> anyhow::Result<String> {
    let name = arguments.file.display();
    if plan.file.frf.is_empty() {
        bail!("{name}: there is no [[frf]] to simulate; add one with file, band and averages");
    }
    let sources: Vec<Source> = plan.sources.iter().filter(|s| s.state == State::Known).cloned().collect();
    if let Some(source) = sources.iter().find(|source| !source.effect.is_linear()) {
        bail!(
            "{name}: {} depends on the amplitude, which frequency responses do not have; set its state to \"off\"",
            source.effect
        );
    }
    let model = Simulator::new(&plan.structure, &sources).with_context(|| format!("{name}"))?;
    let (references, responses) = channels(plan)?;
    if references.is_empty() || responses.is_empty() {
        bail!("{name}: [simulate] channels must name forces (the hits) and motions (the sensors)");
    }
    fs::create_dir_all(&arguments.out)
        .with_context(|| format!("{}: the folder cannot be made", arguments.out.display()))?;
    let mut said = String::new();
    for table in &plan.file.frf {
        let simulated = simulated(plan, &model, table, [&references, &responses], arguments)?;
        let path = arguments.out.join(&table.file);
        write_responses(&path, &simulated, &plan.structure)?;
        let set = &simulated.set;
        said += &format!(
            "{} functions of {} lines are in {}\n",
            set.functions.len(),
            set.frequencies_hz.len(),
            path.display()
        );
    }
    Ok(said)
}

/// Forces and motions of `[simulate] channels`.
fn channels(plan: &Plan) -> anyhow::Result<(Vec<Channel>, Vec<Channel>)> {
    let mut all = Vec::new();
    for text in &plan.simulate().channels {
        let name = ChannelName::parse(text)?;
        let dof = plan.structure.require_dof(&name.label)?;
        all.push(Channel { quantity: name.quantity, dof, label: name.label });
    }
    Ok(all.into_iter().partition(|channel| channel.quantity == Quantity::Force))
}

fn simulated(
    plan: &Plan,
    model: &Simulator<'_>,
    table: &FrfTable,
    [references, responses]: [&[Channel]; 2],
    arguments: &Simulate,
) -> anyhow::Result<SimulatedSet> {
    let Some([from, to]) = table.band else { bail!("{}: the [[frf]] needs `band`, such as [0, 400]", table.file) };
    let lines = plan.simulate().samples.max(2);
    let step = (to - from) / (lines - 1) as f64;
    let frequencies: Vec<f64> = (0..lines).map(|i| from + i as f64 * step).collect();
    let averages = table.averages.unwrap_or(USUAL_AVERAGES);
    let test = HammerTest { averages, noise: arguments.noise, seed: arguments.seed };
    let mut functions = Vec::new();
    for reference in references {
        let truth = truth(plan, model, reference, responses, &frequencies)?;
        for (response, truth) in responses.iter().zip(truth) {
            let (values, coherence) = test.measure(&frequencies, &truth, functions.len() as u64);
            let (response, reference) = (response.clone(), reference.clone());
            functions.push(FrequencyResponse { response, reference, values, coherence: Some(coherence) });
        }
    }
    let set = ResponseSet {
        name: plan.file.project.title.clone(),
        frequencies_hz: frequencies,
        functions,
        averages: Some(averages),
    };
    Ok(SimulatedSet { set, start_hz: from, step_hz: step })
}

/// What every response shows per newton at a reference, a list a response.
fn truth(
    plan: &Plan,
    model: &Simulator<'_>,
    reference: &Channel,
    responses: &[Channel],
    frequencies: &[f64],
) -> anyhow::Result<Vec<Vec<c64>>> {
    let control = Control::unattended();
    let mut truth = vec![Vec::with_capacity(frequencies.len()); responses.len()];
    for f in frequencies {
        if *f == 0.0 {
            truth.iter_mut().for_each(|values| values.push(c64::new(0.0, 0.0)));
            continue;
        }
        let excitation = Excitation::sine(TAU * f, reference.dof, c64::new(1.0, 0.0));
        let motions = recorded(&model.respond(&excitation, &control)?, &excitation, responses, &plan.sensors);
        for (values, motion) in truth.iter_mut().zip(&motions) {
            values.push(motion.amplitudes.first().copied().unwrap_or_default());
        }
    }
    Ok(truth)
}

//! `dashpot simulate` of a component: its displacement is imposed, the force of its laws recorded.

use super::arguments::Simulate;
use super::simulate_write::{at_run, write};
use crate::effects::Source;
use crate::exchange::project::{Plan, PlannedTest};
use crate::measurement::{Channel, Quantity, Record};
use crate::response::recording::{Loading, component_force, quantise};
use crate::response::synthesis::{self, Noise};
use anyhow::{anyhow, bail};

/// Makes the records of all runs.
pub(super) fn run(plan: &Plan, sources: &[Source], arguments: &Simulate) -> anyhow::Result<String> {
    let mut records = Vec::new();
    for index in 0..plan.runs.len() {
        let noise = arguments.noise_of(index);
        records.push(recorded(plan, sources, index, noise).map_err(|error| at_run(plan, index, error))?);
    }
    write(plan, &records, arguments)
}

fn recorded(plan: &Plan, sources: &[Source], index: usize, noise: Option<Noise>) -> anyhow::Result<Record> {
    let table = plan.simulate();
    let test = plan.runs[index].test;
    let Some(PlannedTest { duration_s, loading: loading @ Loading::Cycles { .. }, .. }) = test else {
        bail!(
            "a component is moved, not driven: give the run excitation = {{ kind = \"cycles\", dof = 1, amplitude_m = 0.01, frequency_hz = 1.0, duration_s = 10.0 }}"
        );
    };
    let rate_hz = table.rate_hz.ok_or_else(|| anyhow!("the sampling rate is missing; add `rate_hz` to [simulate]"))?;
    let samples = (duration_s * rate_hz).round() as usize;
    if !(16..=100_000_000).contains(&samples) {
        bail!("{samples} samples come of duration_s and rate_hz; between 16 and 100000000 can be recorded");
    }
    let mass = plan.structure.origin().component_mass;
    let (displacement, force) = component_force(sources, mass, &loading, rate_hz, samples)?;
    let time: Vec<f64> = (0..samples).map(|n| n as f64 / rate_hz).collect();
    let channel = |quantity| Channel { quantity, dof: 0, label: plan.structure.label(0).to_owned() };
    let channels = vec![channel(Quantity::Displacement), channel(Quantity::Force)];
    let record = synthesis::record(&time, channels, vec![displacement, force], noise)?;
    Ok(match table.bits {
        Some(bits) => record.quantised(|samples| quantise(samples, bits)),
        None => record,
    })
}

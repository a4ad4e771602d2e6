//! Response of the channels of a run to its forces.

use crate::control::Control;
use crate::diagnosis::residual::data::{ChannelData, RunData};
use crate::diagnosis::residual::prediction::{FINAL, Predictor, transfer};
use crate::diagnosis::residual::whitening::Transfers;
use crate::effects::Source;
use crate::response::harmonic_balance::{Excitation, HarmonicForce, ResponseError};
use faer::c64;

/// Response of every channel to a unit of every force channel, `[harmonic][force][channel]`, by the linear sources of
/// the model; measured where a single force drives a fundamental.
pub(crate) fn transfers(
    predictor: &Predictor,
    r: usize,
    run: &RunData,
    effects: &[Source],
    control: &Control,
) -> Result<Transfers, ResponseError> {
    let mut sources = predictor.sources(effects);
    sources.retain(|s| s.effect.is_linear());
    let mut a: Transfers = vec![Vec::new(); run.harmonics];
    for force in &run.forces {
        let ones = vec![c64::new(1.0, 0.0); run.harmonics];
        let forces = vec![HarmonicForce { dof: force.dof, mean: 0.0, harmonics: ones }];
        let excitation = Excitation { omega: run.omega, forces };
        let unit = predictor.run(r).respond(&sources, &excitation, &FINAL, None, control)?;
        for (h, a) in a.iter_mut().enumerate() {
            let w = (h + 1) as f64 * run.omega;
            let response_to_unit =
                |c: &ChannelData| transfer(effects, &c.name, w) * c.from_displacement(w) * unit.amplitude(c.dof, h + 1);
            a.push(run.responses.iter().map(response_to_unit).collect());
        }
    }
    if let [force] = &run.forces[..]
        && force.measured.first().is_some_and(|f| f.norm() > 0.0)
    {
        a[0][0] = run.responses.iter().map(|c| c.measured[0] / force.measured[0]).collect();
    }
    Ok(a)
}

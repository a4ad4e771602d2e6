//! Derivatives of what the channels of a run record, by effects, known sources, the structure and the forces, against central
//! differences of whole predictions.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::{run_slopes, unknowns_of};
use crate::common::models::{cantilever_parameters, source, whole};
use crate::control::Control;
use crate::diagnosis::residual::data::{ChannelData, Data, RunData};
use crate::diagnosis::residual::prediction::Predictor;
use crate::effects::{Effect, Place, Source};
use crate::measurement::Quantity;
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::Unknown;
use crate::structure::LumpedMass;
use crate::structure::Part;
use crate::structure::beam::BeamParameters;
use faer::c64;
use std::f64::consts::TAU;

fn channel(name: &str, quantity: Quantity, dof: usize, amplitude: c64) -> ChannelData {
    let measured = vec![amplitude, amplitude * 0.1, amplitude * 0.02];
    ChannelData { name: name.to_owned(), quantity, dof, measured, deviation: vec![1e-3; 3] }
}

/// Two forces, the first times `force`, and a channel of every quantity.
fn run(force: f64) -> RunData {
    let one = c64::new(1.0, 0.0);
    RunData {
        index: 0,
        omega: TAU * 9.7,
        harmonics: 3,
        forces: vec![
            channel("force@11", Quantity::Force, 10, one * force),
            channel("force@5", Quantity::Force, 4, one * 0.2),
        ],
        responses: vec![
            channel("acc@11", Quantity::Acceleration, 10, one),
            channel("vel@7", Quantity::Velocity, 6, one),
            channel("disp@3", Quantity::Displacement, 2, one),
        ],
        alive: vec![0, 1, 2],
        on_moving_base: false,
    }
}

/// Everything that may be moved, in the order of the unknowns asked for.
#[derive(Clone, Copy)]
struct Values {
    drag: f64,
    dashpot: f64,
    known: f64,
    youngs_modulus: f64,
    density: f64,
    force: f64,
}

const AT: Values = Values { drag: 0.4, dashpot: 0.1, known: 2e-5, youngs_modulus: 69e9, density: 2700.0, force: 1.0 };

impl Values {
    /// The values with number `k` larger by a share.
    fn moved(k: usize, share: f64) -> Self {
        let mut x = AT;
        let value = match k {
            0 => &mut x.drag,
            1 => &mut x.dashpot,
            2 => &mut x.known,
            3 => &mut x.youngs_modulus,
            4 => &mut x.density,
            _ => &mut x.force,
        };
        *value *= 1.0 + share;
        x
    }

    /// Effects on the structure with errors of channels between them, which have no unknowns of their own.
    fn effects(&self) -> Vec<Source> {
        let channel_error = |effect, name: &str, value| Source::known(effect, Place::Channel(name.into()), &[value]);
        vec![
            source(Effect::Quadratic, &[8], &[self.drag]),
            channel_error(Effect::Delay, "acc@11", 1e-3),
            source(Effect::Viscous, &[4, 6], &[self.dashpot]),
            channel_error(Effect::Gain, "disp@3", 1.2),
            channel_error(Effect::Delay, "force@11", -2e-3),
            channel_error(Effect::Gain, "force@5", 0.9),
        ]
    }

    fn predictor(&self) -> Predictor {
        let beam =
            BeamParameters { youngs_modulus: self.youngs_modulus, density: self.density, ..cantilever_parameters(6) };
        let structure = beam.build(&[LumpedMass { dof: "7".into(), mass: 0.05 }]).unwrap();
        let known = vec![whole(Effect::StiffnessProportional, self.known)];
        Predictor::new(&structure, known, &Data { runs: vec![run(self.force)], ..Data::default() }).unwrap()
    }

    fn recorded(&self) -> Vec<Vec<c64>> {
        let (settings, control) = (settings(), Control::unattended());
        self.predictor().predict(0, &run(self.force), &self.effects(), &settings, None, &control).unwrap().channels
    }
}

fn settings() -> Settings {
    Settings { estimate: false, tolerance: 1e-13, ..Settings::fixed(7) }
}

#[test]
fn derivatives_of_recorded_amplitudes_are_those_of_differences() {
    let (predictor, effects, run) = (AT.predictor(), AT.effects(), run(AT.force));
    let prediction = predictor.predict(0, &run, &effects, &settings(), None, &Control::unattended()).unwrap();
    let of_effects = unknowns_of(&effects, 1);
    assert_eq!(of_effects.iter().map(Vec::len).collect::<Vec<_>>(), [1, 0, 1, 0, 0, 0]);
    // Relative changes, as those of the structure and of forces are.
    let relative = |unknowns: &[(Unknown, f64)], value: f64| vec![(unknowns[0].0, value * unknowns[0].1)];
    let sums = [
        relative(&of_effects[0], AT.drag),
        relative(&of_effects[2], AT.dashpot),
        vec![(Unknown::Source { source: 0, parameter: 0 }, AT.known)],
        vec![(Unknown::Stiffness, 1.0)],
        vec![(Unknown::Part(Part::ElementMass([0, 5])), 1.0)],
        vec![(Unknown::ForceScale(0), 1.0)],
    ];
    let slopes = run_slopes(&predictor, 0, &run, &effects, &prediction, &sums).unwrap();
    for (k, slope) in slopes.iter().enumerate() {
        let step = 1e-5;
        let (plus, minus) = (Values::moved(k, step).recorded(), Values::moved(k, -step).recorded());
        for c in 0..3 {
            for h in 0..3 {
                let central = (plus[c][h] - minus[c][h]) / (2.0 * step);
                let size = slope.iter().map(|d| d[h].norm()).fold(0.0, f64::max);
                let error = (slope[c][h] - central).norm();
                assert!(error <= 1e-4 * size + 1e-9 * plus[c][h].norm(), "{k} {c} {h}: {error:.1e} of {size:.1e}");
            }
        }
        assert!(slope.iter().flatten().any(|d| d.norm() > 0.0), "unknown {k} moves nothing");
    }
    assert!(run_slopes(&predictor, 0, &run, &effects, &prediction, &[vec![(Unknown::ForceScale(2), 1.0)]]).is_none());
}

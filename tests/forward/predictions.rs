//! What the channels of a run are predicted to record, and its derivatives by everything that may be fitted, against
//! central differences of whole predictions.

use super::support::{cantilever, source, whole};
use dashpot::control::Control;
use dashpot::diagnosis::residual::data::{ChannelData, Data, RunData};
use dashpot::diagnosis::residual::prediction::{By, Predictor};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::Quantity;
use dashpot::response::harmonic_balance::Settings;
use dashpot::response::sensitivity::Unknown;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::{LumpedMass, Structure};
use faer::c64;
use std::f64::consts::TAU;

fn beam(youngs_modulus: f64, density: f64, lumped: f64) -> Structure {
    let (elements, supports) = (6, Supports::ClampedFree);
    let beam =
        BeamParameters { length: 0.56, breadth: 0.04, depth: 0.004, youngs_modulus, density, elements, supports };
    beam.build(&[LumpedMass { dof: "7".into(), mass: lumped }]).unwrap()
}

fn channel(name: &str, quantity: Quantity, dof: usize, amplitude: c64) -> ChannelData {
    let measured = vec![amplitude, amplitude * 0.1, amplitude * 0.02];
    ChannelData { name: name.to_owned(), quantity, dof, measured, deviation: vec![1e-3; 3] }
}

fn run() -> RunData {
    let one = c64::new(1.0, 0.0);
    RunData {
        index: 0,
        omega: TAU * 9.7,
        harmonics: 3,
        forces: vec![channel("force@11", Quantity::Force, 10, one), channel("force@5", Quantity::Force, 4, one * 0.2)],
        responses: vec![
            channel("acc@11", Quantity::Acceleration, 10, one),
            channel("vel@7", Quantity::Velocity, 6, one),
            channel("disp@3", Quantity::Displacement, 2, one),
        ],
        alive: vec![0, 1, 2],
    }
}

/// Everything that may be moved, in the order of the unknowns asked for.
#[derive(Clone, Copy)]
struct Values {
    effects: [f64; 6],
    known: f64,
    youngs_modulus: f64,
    density: f64,
    lumped: f64,
}

const AT: Values = Values {
    effects: [0.4, 0.1, 1e-3, 1.2, -2e-3, 0.9],
    known: 2e-5,
    youngs_modulus: 69e9,
    density: 2700.0,
    lumped: 0.05,
};

fn effects(x: &Values) -> Vec<Source> {
    let on = |effect, name: &str, value| Source::known(effect, Place::Channel(name.into()), &[value]);
    vec![
        source(Effect::Quadratic, &[8], &[x.effects[0]]),
        on(Effect::Delay, "acc@11", x.effects[2]),
        source(Effect::Viscous, &[4, 6], &[x.effects[1]]),
        on(Effect::Gain, "disp@3", x.effects[3]),
        on(Effect::Delay, "force@11", x.effects[4]),
        on(Effect::Gain, "force@5", x.effects[5]),
    ]
}

fn predictor(x: &Values) -> Predictor {
    let structure = beam(x.youngs_modulus, x.density, x.lumped);
    let known = vec![whole(Effect::StiffnessProportional, x.known)];
    Predictor::new(&structure, known, &Data { runs: vec![run()], ..Data::default() }).unwrap()
}

fn settings() -> Settings {
    Settings { estimate: false, tolerance: 1e-13, ..Settings::fixed(7) }
}

fn recorded(x: &Values) -> Vec<Vec<c64>> {
    let control = Control::unattended();
    predictor(x).predict(0, &run(), &effects(x), &settings(), None, &control).unwrap().channels
}

#[test]
fn every_unknown_against_differences() {
    let effect = |effect| By::Effect { effect, parameter: 0 };
    let by = [
        effect(0),
        effect(2),
        effect(1),
        effect(3),
        effect(4),
        effect(5),
        By::Known { source: 0, parameter: 0 },
        By::Structure(Unknown::Stiffness),
        By::Structure(Unknown::Density),
        By::Structure(Unknown::LumpedMass(6)),
    ];
    let control = Control::unattended();
    let given = (&effects(&AT)[..], &by[..]);
    let found = predictor(&AT).predict_with_derivatives(0, &run(), given, &settings(), None, &control).unwrap();
    assert_eq!(found.derivatives.len(), by.len());
    for (k, derivative) in found.derivatives.iter().enumerate() {
        let step = 1e-5;
        let moved = |sign: f64| {
            let (mut x, s) = (AT, sign * step);
            match k {
                0..6 => x.effects[k] *= 1.0 + s,
                6 => x.known *= 1.0 + s,
                7 => x.youngs_modulus *= 1.0 + s,
                8 => x.density *= 1.0 + s,
                _ => x.lumped *= 1.0 + s,
            }
            recorded(&x)
        };
        // Unknowns of the structure are relative changes already.
        let unit = match k {
            0..6 => AT.effects[k],
            6 => AT.known,
            7 | 8 => 1.0,
            _ => AT.lumped,
        };
        let (plus, minus) = (moved(1.0), moved(-1.0));
        for c in 0..3 {
            for h in 0..3 {
                let central = (plus[c][h] - minus[c][h]) / (2.0 * step);
                let size = found.derivatives[k].iter().map(|d| d[h].norm()).fold(0.0, f64::max) * unit.abs();
                let error = (derivative[c][h] * unit - central).norm();
                assert!(error <= 1e-4 * size + 1e-9 * plus[c][h].norm(), "{k} {c} {h}: {error:.1e} of {size:.1e}");
            }
        }
        assert!(derivative.iter().flatten().any(|d| d.norm() > 0.0), "unknown {k} moves nothing");
    }
}

/// An error of one response channel moves that channel alone.
#[test]
fn a_channel_error_is_its_own() {
    let by = [By::Effect { effect: 3, parameter: 0 }];
    let given = (&effects(&AT)[..], &by[..]);
    let control = Control::unattended();
    let found = predictor(&AT).predict_with_derivatives(0, &run(), given, &settings(), None, &control).unwrap();
    let [acceleration, velocity, displacement] = &found.derivatives[0][..] else { panic!("three channels") };
    assert!(acceleration.iter().chain(velocity).all(|d| d.norm() == 0.0));
    assert!((displacement[0] - found.prediction.channels[2][0] / 1.2).norm() < 1e-15);
}

#[test]
fn what_is_not_there_is_named() {
    let by = [By::Known { source: 1, parameter: 0 }];
    let predictor = Predictor::new(&cantilever(6), vec![], &Data { runs: vec![run()], ..Data::default() }).unwrap();
    let control = Control::unattended();
    let refused = predictor.predict_with_derivatives(0, &run(), (&[], &by), &settings(), None, &control);
    assert!(refused.unwrap_err().to_string().contains("is not in this model: it has 0 sources, 2 forces"));
}

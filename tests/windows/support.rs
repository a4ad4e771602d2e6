//! Decays and hammer tests of the sample structures, by time integration in fine steps.

use crate::common::models::{cantilever, chain, five_masses};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::measurement::{Channel, Kind, Quantity, TransientLabel, TransientRun};
use dashpot::response::recording::{Loading, TestRecord, TestSetup, record_test};
use dashpot::response::synthesis::{Noise, record};
use dashpot::structure::Structure;
use std::sync::Arc;

/// A test and the truth behind it.
pub(crate) struct Case {
    pub name: &'static str,
    pub structure: Structure,
    pub truth: Vec<Source>,
    pub candidates: Vec<Source>,
    pub kind: Kind,
    pub loading: Loading,
    pub dof: usize,
    pub sensors: Vec<usize>,
    pub rate_hz: f64,
    pub samples: usize,
}

impl Case {
    pub(crate) fn channels(&self) -> Vec<Channel> {
        let channel = |quantity, dof: usize| Channel { quantity, dof, label: self.structure.label(dof).to_owned() };
        let force = (self.kind == Kind::Transient).then(|| channel(Quantity::Force, self.dof));
        force.into_iter().chain(self.sensors.iter().map(|&dof| channel(Quantity::Acceleration, dof))).collect()
    }

    pub(crate) fn clean(&self) -> TestRecord {
        let channels = self.channels();
        let setup = TestSetup {
            loading: &self.loading,
            dof: self.dof,
            channels: &channels,
            sensors: &[],
            rate_hz: self.rate_hz,
            samples: self.samples,
            filter: true,
        };
        record_test(&self.structure, &self.truth, &setup, &Control::unattended()).unwrap()
    }

    pub(crate) fn run(&self, clean: &TestRecord, noise: f64, seed: u64) -> TransientRun {
        let noise = (noise > 0.0).then_some(Noise { ratio: noise, seed, stream: 0 });
        let record = record(&clean.time, self.channels(), clean.samples.clone(), noise).unwrap();
        let label = TransientLabel { file: self.name.into(), kind: self.kind, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(record), &[]).unwrap()
    }
}

fn candidates(effects: &[Effect], dofs: &[usize]) -> Vec<Source> {
    let candidates_of = |&effect: &Effect| {
        dofs.iter().map(move |&dof| Source::candidate(effect, Place::Dofs(vec![dof]))).collect::<Vec<Source>>()
    };
    effects.iter().flat_map(candidates_of).collect()
}

fn forced(sources: Vec<Source>) -> Vec<Source> {
    sources.into_iter().map(|source| Source { state: State::Forced, ..source }).collect()
}

fn truth(effect: Effect, dof: usize, value: f64) -> Source {
    Source::known(effect, Place::Dofs(vec![dof]), &[value])
}

/// A decay and a hammer test of each sample structure.
pub(crate) fn cases() -> Vec<Case> {
    let masses = || Case {
        name: "five masses, decay",
        structure: five_masses(),
        truth: vec![truth(Effect::Viscous, 0, 12.0), truth(Effect::Viscous, 3, 20.0)],
        // One ring-down, mostly in one mode, does not tell all places apart; a hammer test does.
        candidates: forced(candidates(&[Effect::Viscous], &[0, 3])),
        kind: Kind::Decay,
        loading: Loading::Release { displacement_m: 0.002, mode: None },
        dof: 0,
        sensors: vec![0, 1, 2, 3, 4],
        rate_hz: 1024.0,
        samples: 3000,
    };
    let beam = || Case {
        name: "cantilever, decay",
        structure: cantilever(10),
        truth: vec![truth(Effect::Coulomb, 14, 0.01)],
        // A ring-down in one mode tells the law, not the place.
        candidates: candidates(&[Effect::Viscous, Effect::Coulomb], &[14]),
        kind: Kind::Decay,
        loading: Loading::Release { displacement_m: 0.003, mode: None },
        dof: 18,
        sensors: vec![6, 12, 18],
        rate_hz: 1024.0,
        samples: 2500,
    };
    let hammer = |peak_n, width_s| Loading::Impulse { peak_n, width_s, at_s: 0.2, again_s: None };
    vec![
        masses(),
        Case {
            name: "five masses, hammer",
            kind: Kind::Transient,
            loading: hammer(200.0, 0.004),
            candidates: candidates(&[Effect::Viscous], &[0, 1, 2, 3, 4]),
            ..masses()
        },
        beam(),
        Case {
            name: "cantilever, hammer",
            kind: Kind::Transient,
            loading: hammer(10.0, 0.006),
            truth: vec![truth(Effect::Viscous, 18, 0.1)],
            candidates: forced(candidates(&[Effect::Viscous], &[18])),
            ..beam()
        },
    ]
}

/// A slow sine sweep over two resonances of two masses, 20 and 100 Hz, that hardly move in between.
pub(crate) fn sweep() -> Case {
    let spring = |mass: f64, hz: f64| mass * (std::f64::consts::TAU * hz).powi(2);
    Case {
        name: "two masses, sweep",
        structure: chain(&[1.0, 0.5], &[spring(1.0, 20.0), spring(0.5, 100.0)], &[20_000.0]),
        truth: vec![truth(Effect::Viscous, 0, 2.0), truth(Effect::Viscous, 1, 3.0)],
        candidates: forced(candidates(&[Effect::Viscous], &[0, 1])),
        kind: Kind::Transient,
        loading: Loading::Sweep { force_n: 1.0, from_hz: 10.0, to_hz: 130.0, logarithmic: false },
        dof: 1,
        sensors: vec![0, 1],
        rate_hz: 1024.0,
        samples: 24_576,
    }
}

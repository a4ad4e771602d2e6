//! Records of models that lack nothing: what is left is noise, at the driven place as elsewhere.

use crate::common::models::{cantilever, chain, whole};
use dashpot::control::Control;
use dashpot::diagnosis::records::{Records, compare_records};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::transient_run::TransientLabel;
use dashpot::measurement::{Channel, Kind, Quantity, TransientRun};
use dashpot::response::recording::{Loading, TestSetup, record_test};
use dashpot::response::synthesis::{Noise, record};
use dashpot::structure::Structure;
use std::sync::Arc;

/// A test with the force and accelerations recorded.
pub(crate) struct Test<'a> {
    pub structure: &'a Structure,
    pub truth: &'a [Source],
    pub loading: Loading,
    pub driven: usize,
    pub sensors: &'a [usize],
    pub rate_hz: f64,
    pub samples: usize,
}

impl Test<'_> {
    fn channels(&self) -> Vec<Channel> {
        let channel = |quantity, dof: usize| Channel { quantity, dof, label: self.structure.label(dof).to_owned() };
        let force = std::iter::once(channel(Quantity::Force, self.driven));
        force.chain(self.sensors.iter().map(|&dof| channel(Quantity::Acceleration, dof))).collect()
    }

    /// Its records, one with each seed, of noise of this share of every channel.
    pub(crate) fn runs(&self, noise: f64, seeds: std::ops::Range<u64>) -> Vec<TransientRun> {
        let channels = self.channels();
        let setup = TestSetup {
            loading: &self.loading,
            dof: self.driven,
            channels: &channels,
            sensors: &[],
            rate_hz: self.rate_hz,
            samples: self.samples,
            filter: true,
        };
        let clean = record_test(self.structure, self.truth, &setup, &Control::unattended()).unwrap();
        let run = |seed: u64| {
            let noise = (noise > 0.0).then_some(Noise { ratio: noise, seed, stream: 0 });
            let record = record(&clean.time, channels.clone(), clean.samples.clone(), noise).unwrap();
            let label =
                TransientLabel { file: "test".into(), kind: Kind::Transient, enabled: true, ..Default::default() };
            TransientRun::new(label, Arc::new(record), &[]).unwrap()
        };
        seeds.map(run).collect()
    }
}

pub(crate) fn three_masses() -> Structure {
    chain(&[2.0, 3.0, 1.5], &[4e4, 0.0, 3e4], &[6e4, 5e4])
}

pub(crate) fn viscous(dof: usize, c: f64) -> Vec<Source> {
    vec![Source::known(Effect::Viscous, Place::Dofs(vec![dof]), &[c])]
}

/// Errors of every channel of an exact record beside the exact model.
fn errors(test: &Test) -> Vec<f64> {
    let runs = test.runs(0.0, 0..1);
    let records = Records::new(test.structure, test.truth, &runs).unwrap();
    let found = compare_records(&records, &[], &Control::unattended()).unwrap();
    found.records[0].channels.iter().map(|(_, [error, _])| *error).collect()
}

/// An accelerometer at the driven place feels the measured force at once.
#[test]
fn the_driven_place_of_a_chain_is_predicted_as_well_as_others() {
    let (structure, truth) = (three_masses(), viscous(0, 10.0));
    let random = Loading::Random { rms_n: 10.0, from_hz: 5.0, to_hz: 80.0, seed: 3 };
    let hammer = Loading::Impulse { peak_n: 100.0, width_s: 0.008, at_s: 0.1, again_s: None };
    for loading in [random, hammer] {
        let test = Test {
            structure: &structure,
            truth: &truth,
            loading,
            driven: 0,
            sensors: &[0, 1, 2],
            rate_hz: 512.0,
            samples: 2048,
        };
        let errors = errors(&test);
        assert!(errors.iter().all(|e| *e < 1e-3), "{loading:?}: {errors:.5?}");
    }
}

/// So it does on a beam, where the modes above those that are followed answer it too.
#[test]
fn the_driven_place_of_a_beam_is_predicted_as_well_as_others() {
    let structure = cantilever(8);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5)];
    let test = Test {
        structure: &structure,
        truth: &truth,
        loading: Loading::Random { rms_n: 5.0, from_hz: 5.0, to_hz: 300.0, seed: 3 },
        driven: 14,
        sensors: &[4, 10, 14],
        rate_hz: 2048.0,
        samples: 4096,
    };
    let errors = errors(&test);
    assert!(errors.iter().all(|e| *e < 3e-3), "{errors:.5?}");
}

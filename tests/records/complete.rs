//! Records of models that lack nothing: what is left is noise, at the driven place as elsewhere.

use crate::common::models::{cantilever, chain, whole};
use dashpot::control::Control;
use dashpot::diagnosis::records::{Records, compare_records, diagnose_records};
use dashpot::diagnosis::result::Verdict;
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::transient_run::TransientLabel;
use dashpot::measurement::{Channel, Flag, Kind, Quantity, Record, TransientRun};
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

fn beam(structure: &Structure, loading: Loading) -> Test<'_> {
    Test { structure, truth: &[], loading, driven: 14, sensors: &[4, 10, 14], rate_hz: 2048.0, samples: 4096 }
}

const BEAM_NOISE: Loading = Loading::Random { rms_n: 5.0, from_hz: 5.0, to_hz: 300.0, seed: 3 };
const BEAM_BLOW: Loading = Loading::Impulse { peak_n: 40.0, width_s: 0.003, at_s: 0.05, again_s: None };

/// So it does on a beam, where the modes above those that are followed answer it too.
#[test]
fn the_driven_place_of_a_beam_is_predicted_as_well_as_others() {
    let structure = cantilever(8);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5)];
    // Noise begins with a jump, which the filter against aliasing spreads over the first samples; a blow makes modes ring that are not
    // followed.
    for (loading, bound) in [(BEAM_NOISE, 9e-3), (BEAM_BLOW, 1.3e-2)] {
        let errors = errors(&Test { truth: &truth, ..beam(&structure, loading) });
        assert!(errors.iter().all(|e| *e < bound), "{loading:?}: {errors:.5?}");
    }
}

/// A record at many times the rate that its motion asks for is compared at a lower one, where there is as much to be seen.
#[test]
fn an_oversampled_record_is_compared_at_a_lower_rate() {
    let structure = cantilever(8);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5)];
    let test = Test { truth: &truth, rate_hz: 20_480.0, samples: 40_960, ..beam(&structure, BEAM_BLOW) };
    let runs = test.runs(0.01, 0..1);
    let records = Records::new(&structure, &truth, &runs).unwrap();
    let found = compare_records(&records, &[], &Control::unattended()).unwrap();
    let one = &found.records[0];
    assert!((2000..=20_480).contains(&one.time.len()), "{}", one.time.len());
    assert!(one.measured.iter().chain(&one.model).all(|list| list.len() == one.time.len()));
    assert!(found.error < 1.1 * found.noise_floor && found.error < 0.01, "{} {}", found.error, found.noise_floor);
}

/// A complete model of a beam lacks nothing beside a hundredth of noise.
#[test]
fn a_complete_beam_lacks_nothing() {
    let structure = cantilever(8);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5)];
    for loading in [BEAM_NOISE, BEAM_BLOW] {
        let run = Test { truth: &truth, ..beam(&structure, loading) }.runs(0.01, 0..1);
        let records = Records::new(&structure, &truth, &run).unwrap();
        let found = diagnose_records(&records, &[], &Control::unattended(), &|_| {}).unwrap();
        assert_eq!(found.verdict, Verdict::Adequate, "{loading:?}");
    }
}

/// The mean squared error of an exact model over its mean squared noise floor.
fn over_floor(test: &Test, noise: f64, seeds: std::ops::Range<u64>) -> f64 {
    let squared_errors = |run: &TransientRun| {
        let records = Records::new(test.structure, test.truth, std::slice::from_ref(run)).unwrap();
        let found = compare_records(&records, &[], &Control::unattended()).unwrap();
        [found.error.powi(2), found.noise_floor.powi(2)]
    };
    let all: Vec<[f64; 2]> = test.runs(noise, seeds).iter().map(squared_errors).collect();
    let mean = |k: usize| all.iter().map(|pair| pair[k]).sum::<f64>() / all.len() as f64;
    mean(0) / mean(1)
}

/// Noise of the measured force rings in the record that is predicted from it: over seeds an exact model leaves what is told to be its
/// noise floor, where twice a hammer strikes as where a force acts all along.
#[test]
fn an_exact_model_leaves_the_noise_floor_under_a_noisy_force() {
    let (structure, truth) = (three_masses(), viscous(0, 10.0));
    let hammer = Loading::Impulse { peak_n: 200.0, width_s: 0.006, at_s: 0.1, again_s: Some(0.2) };
    let random = Loading::Random { rms_n: 10.0, from_hz: 5.0, to_hz: 80.0, seed: 3 };
    for loading in [hammer, random] {
        let test = Test {
            structure: &structure,
            truth: &truth,
            loading,
            driven: 0,
            sensors: &[0, 1, 2],
            rate_hz: 512.0,
            samples: 2048,
        };
        let ratio = over_floor(&test, 0.02, 0..24);
        // Where a hammer strikes the floor is told a tenth too high (0.89 of its square over 100 seeds; not understood yet).
        assert!((0.8..1.15).contains(&ratio), "{loading:?}: {ratio}");
    }
}

/// A complete model is adequate on every seed of that noise.
#[test]
fn a_complete_model_under_a_double_hit_lacks_nothing() {
    let (structure, truth) = (three_masses(), viscous(0, 10.0));
    let test = Test {
        structure: &structure,
        truth: &truth,
        loading: Loading::Impulse { peak_n: 200.0, width_s: 0.006, at_s: 0.1, again_s: Some(0.2) },
        driven: 0,
        sensors: &[0, 1, 2],
        rate_hz: 512.0,
        samples: 2048,
    };
    let adequate = |run: &TransientRun| {
        let records = Records::new(&structure, &truth, std::slice::from_ref(run)).unwrap();
        diagnose_records(&records, &[], &Control::unattended(), &|_| {}).unwrap().verdict == Verdict::Adequate
    };
    let right = test.runs(0.02, 10..20).iter().filter(|run| adequate(run)).count();
    assert!(right >= 9, "{right} of 10");
}

/// A mode damped by 6 % rings for some milliseconds after a blow: it is followed, not counted as noise.
#[test]
fn a_mode_that_passes_at_once_is_no_noise() {
    let structure = cantilever(8);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5)];
    let test = Test { truth: &truth, ..beam(&structure, BEAM_BLOW) };
    let runs = test.runs(0.01, 0..1);
    let records = Records::new(&structure, &truth, &runs).unwrap();
    let found = compare_records(&records, &[], &Control::unattended()).unwrap();
    assert!(found.noise_floor < 0.03 && found.error < 0.03, "{} {}", found.error, found.noise_floor);
}

/// Whether a half sine of so many samples, cut at a share of its height, is said to be clipped.
fn is_clipped(samples: f64, cut: f64) -> bool {
    let time: Vec<f64> = (0..1000).map(|n| 1e-3 * f64::from(n)).collect();
    let blow = |n: u32| {
        let x = (f64::from(n) - 99.7) / samples;
        if x > 0.0 && x < 1.0 { (100.0 * (std::f64::consts::PI * x).sin()).min(100.0 * cut) } else { 0.0 }
    };
    let ring =
        |n: u32| if n < 100 { 0.0 } else { (0.3 * f64::from(n - 100)).sin() * (-0.01 * f64::from(n - 100)).exp() };
    let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
    let channels = vec![channel(Quantity::Force), channel(Quantity::Acceleration)];
    let rows = vec![(0..1000).map(blow).collect(), (0..1000).map(ring).collect()];
    let record = Record::new(time, channels, rows).unwrap();
    let label = TransientLabel { file: "hit".into(), kind: Kind::Transient, enabled: true, ..Default::default() };
    let run = TransientRun::new(label, Arc::new(record), &[]).unwrap();
    run.findings.iter().any(|f| f.flag == Flag::Clipped)
}

/// A contact of three samples, two of them at the end of the range, is clipped; round tops are not.
#[test]
fn a_short_blow_with_a_flat_top_is_clipped() {
    assert!(is_clipped(3.4, 0.6));
    for samples in [3.0, 3.4, 4.0, 6.0, 8.6] {
        assert!(!is_clipped(samples, 1.0), "{samples}");
    }
}

/// A blow bends what the linear part of a model shows of the start: a strong spring is followed from rest all the same.
#[test]
fn a_struck_beam_with_a_strong_cubic_spring_is_predicted() {
    let structure = cantilever(8);
    let spring = Source::known(Effect::CubicStiffness, Place::Dofs(vec![12]), &[1e8]);
    let truth = vec![whole(Effect::StiffnessProportional, 4e-5), spring];
    let runs = Test { truth: &truth, ..beam(&structure, BEAM_BLOW) }.runs(0.005, 0..1);
    let records = Records::new(&structure, &truth, &runs).unwrap();
    let found = compare_records(&records, &[], &Control::unattended()).unwrap();
    assert!(found.error < 0.03 && found.error < 3.0 * found.noise_floor, "{} {}", found.error, found.noise_floor);
}

//! Records that are not steady: a long decay compared, its window rows, and prediction with derivatives; what an adaptive
//! integrator needs for the same is measured by `scripts/integrator-speed.py`.

#[path = "../tests/common/mod.rs"]
mod common;

use common::models::{cantilever, oscillator as mass_on_spring};
use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::balance::windows::window_rows;
use dashpot::control::Control;
use dashpot::diagnosis::records::{Records, compare_records};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, ChannelCorrection, Kind, Quantity, Record, TransientLabel, TransientRun};
use dashpot::response::transient::{SampledForces, TransientModel, TransientParameter, TransientSetup};
use dashpot::structure::Structure;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

const SAMPLES: usize = 100_000;
const CHANNELS: usize = 8;

fn dashpot(dof: usize, c: f64) -> Source {
    Source::known(Effect::Viscous, Place::Dofs(vec![dof]), &[c])
}

/// A decay of two modes seen by eight accelerometers, with a little noise.
fn decay(structure: &Structure) -> TransientRun {
    let modes = structure.modes().unwrap_or_else(|error| panic!("{error}"));
    let rows = structure.translations();
    let step = 1.0 / 2000.0;
    let mut state = 7_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let dofs: Vec<usize> = rows.iter().rev().take(CHANNELS).copied().collect();
    let sample = |dof: usize, n: usize| -> f64 {
        let t = step * n as f64;
        let mode_acceleration = |r: usize| {
            let omega = modes.omega[r];
            -omega * omega * modes.shapes[(dof, r)] * 1e-4 * (-0.1 * t).exp() * (omega * t).cos()
        };
        mode_acceleration(0) + mode_acceleration(1)
    };
    let samples = dofs.iter().map(|&dof| (0..SAMPLES).map(|n| sample(dof, n) + 0.01 * uniform()).collect()).collect();
    let channel = |&dof: &usize| Channel { quantity: Quantity::Acceleration, dof, label: structure.label(dof).into() };
    let time = (0..SAMPLES).map(|n| step * n as f64).collect();
    let record = Record::new(time, dofs.iter().map(channel).collect(), samples);
    let record = record.unwrap_or_else(|error| panic!("{error}"));
    let label = TransientLabel { file: "decay".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
    TransientRun::new(label, Arc::new(record), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn long_decay(c: &mut Criterion) {
    faer::set_global_parallelism(faer::Par::Seq);
    let mut group = c.benchmark_group("decay of 100 000 samples x 8 channels");
    group.sample_size(10);
    let structure = cantilever(10);
    let run = decay(&structure);
    let known = vec![dashpot(18, 0.05)];
    let control = Control::unattended();
    group.bench_function("compared", |b| {
        b.iter(|| {
            let records = Records::new(&structure, &known, std::slice::from_ref(&run));
            let records = records.unwrap_or_else(|error| panic!("{error}"));
            compare_records(&records, &[], &control).map(black_box).map(|c| c.error)
        });
    });
    let candidates: Vec<Source> = structure.translations().into_iter().map(|dof| dashpot(dof, 1.0)).collect();
    group.bench_function("window rows of ten sources", |b| {
        b.iter(|| window_rows(&structure, &[], &candidates, &[&run], &control).map(black_box).map(|rows| rows.len()));
    });
}

/// The oscillator of `scripts/integrator-speed.py`: 1 kg on 400 N/m, a dashpot and a cubic spring, 200 s from 0.1 m.
fn oscillator(c: &mut Criterion) {
    let structure = mass_on_spring(1.0, 400.0);
    let modes = structure.modes().unwrap_or_else(|error| panic!("{error}"));
    let cubic = Source::known(Effect::CubicStiffness, Place::Dofs(vec![0]), &[8000.0]);
    let sources = [dashpot(0, 0.05), cubic];
    let channels = [Channel { quantity: Quantity::Displacement, dof: 0, label: "1".into() }];
    let setup = TransientSetup {
        structure: &structure,
        modes: &modes,
        kept: 1,
        sources: &sources,
        drives: &[],
        channels: &channels,
        factors: [1.0; 2],
        mode_stiffness: &[],
        mode_damping: &[],
        shape_errors: &[],
        parts: &[],
        directions: &[],
        step: [TAU / 20.0 / 24.0; 2],
    };
    let model = TransientModel::new(&setup).unwrap_or_else(|error| panic!("{error}"));
    let by = |source| TransientParameter::Source { source, parameter: 0 };
    let parameters = [by(0), by(1), TransientParameter::Initial(0), TransientParameter::Initial(1)];
    let predicted = |substeps: usize| {
        let forces = SampledForces {
            step: TAU / 20.0 / 24.0,
            samples: 15_279,
            forces: Vec::new(),
            substeps,
            every: 1,
            step_lengths: Vec::new(),
        };
        model.predict(&forces, &[0.1, 0.0], &parameters).unwrap_or_else(|error| panic!("{error}"))
    };
    let exact = predicted(256);
    let mut group = c.benchmark_group("oscillator with four derivatives");
    group.sample_size(10);
    for substeps in [1, 2, 4, 8] {
        let found = predicted(substeps);
        let pairs = found.channels[0].iter().zip(&exact.channels[0]);
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max) / 0.1;
        group.bench_function(format!("{substeps} steps a sample, off by {off:.1e} of the amplitude"), |b| {
            b.iter(|| black_box(predicted(substeps).channels[0][100]));
        });
    }
}

/// Channels recorded a third of a step late, read at the samples where they should have been.
fn late_channels(c: &mut Criterion) {
    let mut group = c.benchmark_group("channels a third of a step late");
    group.sample_size(10);
    let run = decay(&cantilever(10));
    let late = |channel: &Channel| ChannelCorrection { channel: channel.clone(), delay: run.step() / 3.0, gain: 1.0 };
    for channels in [1, 2, 4, CHANNELS] {
        let corrections: Vec<ChannelCorrection> = run.channels().iter().take(channels).map(late).collect();
        let label = || TransientLabel { file: "late".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        group.bench_function(format!("100 000 samples x {channels}"), |b| {
            b.iter(|| TransientRun::new(label(), run.record.clone(), &corrections).map(black_box).map(|run| run.len()));
        });
    }
}

criterion_group!(benches, long_decay, late_channels, oscillator);
criterion_main!(benches);

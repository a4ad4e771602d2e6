//! A cantilever with a friction pad that its project does not know.

use crate::common::models::cantilever_parameters;
use crate::support::Sample;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::exchange::records::write_record;
use dashpot::measurement::{Channel, Quantity};
use dashpot::response::harmonic_balance::Excitation;
use dashpot::response::simulation_in_time::{InTime, Recorder, record_in_time};
use dashpot::response::synthesis::{Noise, record, sampling_times};
use dashpot::structure::beam::BeamParameters;
use faer::c64;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Force of the pad at DOF 7, N.
pub(crate) const FORCE: f64 = 0.2;
/// Row of its DOF.
pub(crate) const ROW: usize = 6;
const NOISE: f64 = 0.01;

/// Six frequencies about two resonances at two force levels, three accelerometers, 1 % noise; the project knows the two
/// dashpots only.
pub(crate) fn friction() -> Sample {
    let head = "[project]\nformat = 1\ntitle = \"Cantilever with a friction pad somewhere\"\n[structure]\nkind = \"beam\"\n\
                length = 0.5\nbreadth = 0.04\ndepth = 0.004\nyoungs_modulus = 69e9\ndensity = 2700.0\nelements = 5\n\
                supports = \"clamped-free\"\n[[source]]\nlaw = \"viscous\"\ndofs = [3]\nstate = \"known\"\nc = 0.3\n\
                [[source]]\nlaw = \"viscous\"\ndofs = [9]\nstate = \"known\"\nc = 0.2\n";
    let parameters = BeamParameters { length: 0.5, ..cantilever_parameters(5) };
    let structure = parameters.build(&[]).unwrap();
    let source = |effect, dof, value| Source::known(effect, Place::Dofs(vec![dof]), &[value]);
    let truth = [source(Effect::Viscous, 2, 0.3), source(Effect::Viscous, 8, 0.2), source(Effect::Coulomb, ROW, FORCE)];
    let channel = |quantity, dof: usize| Channel { quantity, dof, label: structure.label(dof).to_owned() };
    let mut channels = vec![channel(Quantity::Force, 8)];
    channels.extend([2, 4, 8].map(|dof| channel(Quantity::Acceleration, dof)));
    let folder = tempfile::tempdir().unwrap();
    let mut text = head.to_owned();
    let mut number = 0;
    for (level, force) in [1.0, 2.5].into_iter().enumerate() {
        for frequency in [12.4, 13.1, 13.9, 80.0, 82.0, 84.5] {
            number += 1;
            let excitation = Excitation::sine(TAU * frequency, 8, c64::new(force, 0.0));
            let noise = Noise { ratio: NOISE, seed: 5, stream: number };
            let time = sampling_times(TAU * frequency, 12.0, 600);
            let recorder = Recorder { channels: &channels, sensors: &[], time: &time };
            // By time steps, not by the model that is to find the pad.
            let control = Control::unattended();
            let samples =
                record_in_time(&structure, &truth, &excitation, &recorder, &InTime::default(), &control).unwrap();
            let record = record(&time, channels.clone(), samples, Some(noise)).unwrap();
            let name = format!("run-{number:02}.csv");
            write_record(&folder.path().join(&name), &record, &structure, None).unwrap();
            let level = level + 1;
            write!(text, "[[run]]\nfile = \"{name}\"\nfrequency = {frequency}\nlevel = {level}\n").unwrap();
        }
    }
    let path = folder.path().join("project.toml");
    std::fs::write(&path, text).unwrap();
    Sample { _folder: folder, path }
}

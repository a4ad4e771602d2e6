//! Records in steady state, by time integration where there is a force in time. Laws that are defined harmonic by
//! harmonic (hysteretic, fractional, loss factor) have none; with linear laws their steady state is exact.

use super::random::Random;
use dashpot::control::Control;
use dashpot::effects::{Effect, Kind, Place, Source};
use dashpot::measurement::{Channel, Quantity, Record};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use dashpot::response::time_integration::{Settling, TimeModel};
use dashpot::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Steps of a period in time integration; friction jumps, which costs an order of accuracy.
const STEPS: usize = 1024;
const STEPS_OF_FRICTION: usize = 4096;
/// Samples of a period in the record, and periods.
const SAMPLES: usize = 64;
const PERIODS: usize = 12;

/// What is measured and how well.
pub(crate) struct Chain<'a> {
    pub structure: &'a Structure,
    pub sensors: &'a [usize],
    /// Faults of channels are among them.
    pub truth: &'a [Source],
    pub noise: f64,
    /// A transient that has not died out, as a share of the response; 0 for none.
    pub transient: f64,
}

/// Harmonics of displacement (n x H) in steady state.
pub(crate) fn steady(structure: &Structure, sources: &[Source], excitation: &Excitation) -> Option<Mat<c64>> {
    let control = Control::unattended();
    let acting: Vec<Source> =
        sources.iter().filter(|s| !matches!(s.effect.kind(), Kind::Channel(_))).cloned().collect();
    let harmonic = |s: &Source| matches!(s.effect, Effect::Hysteretic | Effect::Fractional | Effect::LossFactor);
    let balanced = || {
        let model = ForwardModel::new(structure, &acting).ok()?;
        model.respond(excitation, &Settings::default(), None, &control).ok()
    };
    if acting.iter().any(harmonic) || acting.iter().all(|s| s.effect.is_linear()) {
        return Some(balanced()?.harmonics.clone());
    }
    let jumps = acting.iter().any(|s| matches!(s.effect, Effect::Coulomb | Effect::Stribeck));
    let steps = if jumps { STEPS_OF_FRICTION } else { STEPS };
    let mut model = TimeModel::new(structure, &acting, excitation, steps).ok()?;
    // A start near the periodic motion saves most of the periods; time stepping alone decides where it ends.
    if let Some(start) = balanced() {
        model.start_from(&start);
    }
    model.settle(&Settling { tolerance: 1e-7, most_periods: 500, accelerate: true }, &control).ok()?;
    model.harmonics(25).ok()
}

impl Chain<'_> {
    pub(crate) fn record(&self, excitation: &Excitation, harmonics: &Mat<c64>, random: &mut Random) -> Record {
        let omega = excitation.omega;
        let time: Vec<f64> = (0..SAMPLES * PERIODS).map(|n| n as f64 * TAU / omega / SAMPLES as f64).collect();
        let mut channels = Vec::new();
        let mut samples = Vec::new();
        for force in &excitation.forces {
            channels.push(self.channel(Quantity::Force, force.dof));
            samples.push(self.samples(&channels[channels.len() - 1], force.harmonics.clone(), omega, &time, random));
        }
        for &dof in self.sensors {
            let acceleration = |i: usize| harmonics[(dof, i)] * -((i + 1) as f64 * omega).powi(2);
            channels.push(self.channel(Quantity::Acceleration, dof));
            let amplitudes = (0..harmonics.ncols()).map(acceleration).collect();
            samples.push(self.samples(&channels[channels.len() - 1], amplitudes, omega, &time, random));
        }
        Record::new(time, channels, samples).unwrap()
    }

    fn channel(&self, quantity: Quantity, dof: usize) -> Channel {
        Channel { quantity, dof, label: self.structure.label(dof).to_string() }
    }

    fn samples(&self, channel: &Channel, mut y: Vec<c64>, omega: f64, time: &[f64], random: &mut Random) -> Vec<f64> {
        let name = channel.to_string();
        for source in self.truth {
            if let (Kind::Channel(law), Place::Channel(faulty)) = (source.effect.kind(), &source.place)
                && *faulty == name
            {
                let transfer = |i: usize| law.transfer(source.parameters[0], (i + 1) as f64 * omega);
                y.iter_mut().enumerate().for_each(|(i, a)| *a *= transfer(i));
            }
        }
        let rms = (0.5 * y.iter().map(c64::norm_sqr).sum::<f64>()).sqrt();
        let last = time[time.len() - 1];
        let dying = if channel.quantity == Quantity::Force { 0.0 } else { self.transient };
        let sample_at = |t: f64| -> f64 {
            let turn = c64::new(0.0, omega * t).exp();
            let mut power = c64::new(1.0, 0.0);
            let mut sum = 0.0;
            for a in &y {
                power *= turn;
                sum += (*a * power).re;
            }
            sum + dying * rms * (-2.0 * t / last).exp() * (0.97 * omega * t).cos()
        };
        time.iter().map(|&t| sample_at(t) + self.noise * rms * random.normal()).collect()
    }
}

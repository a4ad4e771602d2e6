//! The test worth making next where effects cannot be told apart in the records: a release, the same blow weaker or harder, or
//! the same drive at another level, whichever separates the best two models most.
//!
//! ```text
//! separation^2 = sum_channels,samples ((y - y') / noise)^2 / samples over which what a model leaves stays alike
//! ```

use super::data::{RecordData, RecordDiagnosisError, Records};
use super::fitted::FittedRecords;
use super::search::Search;
use super::weights::in_band;
use crate::diagnosis::result::{NextTest, TestKind};
use crate::measurement::Kind;
use std::f64::consts::TAU;

/// Sizes of a test relative to the largest of its kind so far.
const SIZES: [f64; 2] = [0.3, 3.0];
/// Periods of the dominant motion over which two models are compared.
const PERIODS: f64 = 40.0;
/// Band about the dominant frequency whose motion a release gives again.
const NEAR: [f64; 2] = [0.7, 1.4];
/// Separation, in standard deviations, from which on a test tells anything.
const TELLS: f64 = 3.0;
/// Separation beyond which more of it tells no more; models that run away under a larger force are as far apart as one likes.
const PLAIN: f64 = 1000.0;

/// A test that could be made.
struct Trial {
    test: TestKind,
    record: RecordData,
    initial: Vec<f64>,
    dof: usize,
    force: f64,
}

impl Search<'_> {
    /// The test that tells the first of `fits` from the next that holds other effects; none where nothing would.
    pub(super) fn next_tests(&self, fits: &[FittedRecords]) -> Result<Vec<NextTest>, RecordDiagnosisError> {
        let Some(best) = fits.first() else { return Ok(Vec::new()) };
        let other = |f: &&FittedRecords| !f.effects.iter().all(|e| best.effects.iter().any(|b| b.is_same(e)));
        let Some(candidate) = fits.iter().skip(1).find(other) else { return Ok(Vec::new()) };
        let trials = trials(self.plain);
        let gain_of_trial = |k: usize| separation(self.plain, &trials[k], [best, candidate]).unwrap_or(0.0).min(PLAIN);
        let gains = self.control.map(trials.len(), gain_of_trial);
        self.control.check()?;
        let Some(most) = (0..trials.len()).rev().max_by(|&a, &b| gains[a].total_cmp(&gains[b])) else {
            return Ok(Vec::new());
        };
        let names = [best, candidate].map(|f| {
            let titles: Vec<&str> = f.effects.iter().map(|e| e.effect.title()).collect();
            titles.join(" and ")
        });
        let of_two = match names {
            [one, other] if one == other && best.effects.len() > 1 => format!("{one} at the one and the other places"),
            [one, other] if one == other => format!("{one} and {other} at these two places"),
            [one, other] => format!("{one} and {other}"),
        };
        let gain = if gains[most] < PLAIN { format!("{:.1}", gains[most]) } else { format!("more than {PLAIN}") };
        let why = format!("{of_two} would differ there by {gain} standard deviations of the measured channels");
        let Trial { test, record, dof, force, .. } = &trials[most];
        let test = NextTest { kind: *test, frequency_hz: record.dominant_hz, force_dof: *dof, force: *force, why };
        Ok(if gains[most] > TELLS { vec![test] } else { Vec::new() })
    }
}

/// Tests like those that were made, weaker and harder; releases besides.
fn trials(records: &Records) -> Vec<Trial> {
    let mut list = Vec::new();
    for record in &records.list {
        let samples = ((PERIODS / (record.dominant_hz * record.step)) as usize).clamp(64, record.len().max(64));
        let samples = samples.min(record.len());
        let rest = vec![0.0; 2 * records.kept];
        let size = |list: &[f64]| list.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        if let (Some(&dof), true) = (record.drives.first(), record.kind == Kind::Transient) {
            let force = record.forces.first().map_or(0.0, |list| size(list));
            list.extend(SIZES.map(|times| Trial {
                test: TestKind::Alike { times },
                record: resized(record, record.len(), times),
                initial: rest.clone(),
                dof,
                force: times * force,
            }));
        }
        let Some((dof, displacement)) = largest_displacement(records, record) else { continue };
        list.extend(SIZES.iter().filter_map(|times| {
            let (initial, force) = released(records, dof, times * displacement)?;
            let free = RecordData { drives: Vec::new(), forces: Vec::new(), ..resized(record, samples, 1.0) };
            let test = TestKind::Release { displacement_m: times * displacement };
            Some(Trial { test, record: free, initial, dof, force })
        }));
    }
    list
}

/// The first samples of a record with its forces `times` as large.
fn resized(record: &RecordData, samples: usize, times: f64) -> RecordData {
    let first_samples = |lists: &[Vec<f64>], times: f64| -> Vec<Vec<f64>> {
        lists.iter().map(|list| list[..samples].iter().map(|y| times * y).collect()).collect()
    };
    RecordData {
        samples: first_samples(&record.samples, 1.0),
        sigma: first_samples(&record.sigma, 1.0),
        forces: first_samples(&record.forces, times),
        ..record.clone()
    }
}

/// The DOF of the channel that moves most at the dominant frequency, and how far (m) it went there: a test may ask for [`SIZES`] of that,
/// and not for what a blow's high frequencies would be if they were slow.
fn largest_displacement(records: &Records, record: &RecordData) -> Option<(usize, f64)> {
    let omega = TAU * record.dominant_hz;
    let translations = records.structure.translations();
    let channel_displacement = |c: usize| {
        let channel = &record.channels[c];
        let order = channel.quantity.derivatives()?;
        let about = in_band(&record.samples[c], record.step, NEAR.map(|share| share * record.dominant_hz));
        let moved = about.iter().fold(0.0_f64, |m, y| m.max(y.abs())) / omega.powi(order);
        (translations.contains(&channel.dof) && moved > 0.0).then_some((channel.dof, moved))
    };
    (0..record.channels.len()).filter_map(channel_displacement).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// State that a static force at a DOF holds, with that displacement there, and the force (N).
fn released(records: &Records, dof: usize, displacement: f64) -> Option<(Vec<f64>, f64)> {
    let kept = records.kept;
    let unit: Vec<f64> = (0..kept).map(|r| records.modes.shapes[(dof, r)] / records.modes.omega[r].powi(2)).collect();
    let flexibility: f64 = unit.iter().enumerate().map(|(r, q)| records.modes.shapes[(dof, r)] * q).sum();
    let force = displacement / flexibility;
    let state = unit.iter().map(|q| q * force).chain(vec![0.0; kept]).collect();
    force.is_finite().then_some((state, force))
}

/// Difference of two models in a test, in standard deviations of the channels.
fn separation(records: &Records, trial: &Trial, models: [&FittedRecords; 2]) -> Option<f64> {
    let one = Records { list: vec![trial.record.clone()], ..records.clone() };
    let predicted = models.map(|model| {
        let own = FittedRecords {
            initial: vec![trial.initial.clone()],
            shifts: vec![0.0],
            offsets: one.no_offsets(),
            ..model.clone()
        };
        own.predict(&one, 0, trial.record.len(), &[]).ok().map(|r| r.channels)
    });
    let [Some(a), Some(b)] = predicted else { return None };
    let channel_separation = |c: usize| {
        let apart: f64 = a[c].iter().zip(&b[c]).map(|(a, b)| (a - b).powi(2)).sum();
        apart / trial.record.noise[c].powi(2)
    };
    let alike = models[0].alike.max(1.0);
    Some(((0..a.len()).map(channel_separation).sum::<f64>() / alike).sqrt()).filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::control::Control;
    use crate::effects::{Effect, Place, Source};
    use crate::measurement::transient_run::TransientLabel;
    use crate::measurement::{Channel, Quantity, Record, TransientRun};
    use crate::structure::Structure;
    use crate::structure::chain::ChainParameters;
    use std::sync::Arc;

    fn chain() -> Structure {
        let (masses, ground_stiffness) = (vec![1.0, 1.0], vec![800.0, 0.0]);
        ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1500.0] }.build(&[]).unwrap()
    }

    /// A decay of a lightly damped sine of 10 mm.
    fn decay() -> TransientRun {
        let step = 0.01;
        let sample = |n: usize| 0.01 * (-0.05 * step * n as f64).exp() * (17.0 * step * n as f64).cos();
        let noise = |n: usize| 1e-5 * ((n * 7919 % 1000) as f64 / 500.0 - 1.0);
        let time: Vec<f64> = (0..1200).map(|n| step * f64::from(n)).collect();
        let channel = Channel { quantity: Quantity::Displacement, dof: 1, label: "2".into() };
        let rows = vec![(0..1200).map(|n| sample(n) + noise(n)).collect()];
        let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(Record::new(time, vec![channel], rows).unwrap()), &[]).unwrap()
    }

    /// Friction and a dashpot that take out as much at 10 mm differ at other amplitudes, and a release is what this record can be
    /// asked for; a model is told from itself by nothing.
    #[test]
    fn friction_and_a_dashpot_are_told_apart_by_another_amplitude() {
        let (structure, run, control) = (chain(), decay(), Control::unattended());
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let c = 0.1;
        let force = std::f64::consts::FRAC_PI_4 * c * 17.0 * 0.01;
        let fit = |effect, value| {
            let source = Source::known(effect, Place::Dofs(vec![1]), &[value]);
            FittedRecords::start(&records, &[source])
        };
        let [dashpot, friction] = [fit(Effect::Viscous, c), fit(Effect::Coulomb, force)];
        let found = search.next_tests(&[dashpot.clone(), friction]).unwrap();
        let [test] = &found[..] else { panic!("{found:?}") };
        let TestKind::Release { displacement_m } = test.kind else { panic!("{test:?}") };
        assert!((displacement_m / 0.01).ln().abs() > 1.0, "{displacement_m}");
        assert_eq!(test.force_dof, 1);
        // The force that holds the second mass there, both springs in series; the second mode, which is not followed, gives 6 % of it.
        let stiffness = 1.0 / (1.0 / 800.0 + 1.0 / 1500.0);
        assert!((test.force / (stiffness * displacement_m) - 1.0).abs() < 0.08, "{}", test.force);
        assert!(search.next_tests(&[dashpot.clone(), dashpot]).unwrap().is_empty());
    }
}

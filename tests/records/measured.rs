//! Measured decays, where `DASHPOT_MEASURED` names the folder that holds them.

use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::diagnosis::records::amplitude::{AmplitudePoint, Band, amplitude_curve, line};
use dashpot::diagnosis::records::{Records, diagnose_records};
use dashpot::effects::Effect;
use dashpot::measurement::transient_run::TransientLabel;
use dashpot::measurement::{Channel, Kind, Quantity, Record, TransientRun};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Numbers of a column of a text file, from the row after the one that begins with `head`.
fn columns(name: &str, head: &str, separator: char, wanted: [usize; 2]) -> Vec<[f64; 2]> {
    #[allow(clippy::disallowed_methods, reason = "the measured files are not in the repository")]
    let folder = std::env::var("DASHPOT_MEASURED").expect("DASHPOT_MEASURED names the folder of the records");
    let text = std::fs::read_to_string(std::path::Path::new(&folder).join(name)).unwrap();
    let rows = text.lines().skip_while(|line| !line.starts_with(head)).skip(1);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(separator).collect();
        Some([cells.get(wanted[0])?.trim().parse().ok()?, cells.get(wanted[1])?.trim().parse().ok()?])
    };
    rows.filter_map(row).collect()
}

fn ratio_over_amplitude(points: &[AmplitudePoint]) -> [f64; 2] {
    let rows: Vec<[f64; 3]> = points.iter().map(|p| [p.amplitude, p.damping_ratio, 1e-4]).collect();
    let line = line(&rows).unwrap();
    [line.offset, line.slope]
}

fn roll() -> (Vec<f64>, f64) {
    let rows = columns("ship-model-roll-decay.csv", "time", ',', [0, 4]);
    let step = (rows[rows.len() - 1][0] - rows[0][0]) / (rows.len() - 1) as f64;
    // From the release: the largest angle.
    let largest = (0..rows.len()).max_by(|&a, &b| rows[a][1].abs().total_cmp(&rows[b][1].abs())).unwrap();
    (rows[largest..].iter().map(|r| r[1]).collect(), step)
}

/// `zeta = 0.0015 + 0.040 A`, period 2.544 s.
#[test]
#[ignore = "needs measured records"]
fn the_roll_of_a_ship_has_its_curve() {
    let (angle, step) = roll();
    let points = amplitude_curve(&angle, step, 0.0, Band { frequency_hz: 1.0 / 2.544, width: 0.0 });
    let large: Vec<AmplitudePoint> = points.iter().copied().filter(|p| p.amplitude > 3.0_f64.to_radians()).collect();
    for p in &points {
        println!("A {:.4} rad  T {:.4} s  zeta {:.5}", p.amplitude, 1.0 / p.frequency_hz, p.damping_ratio);
    }
    let [offset, slope] = ratio_over_amplitude(&large);
    println!("zeta = {offset:.5} + {slope:.4} A");
    assert!((slope - 0.040).abs() < 0.006 && (offset - 0.0015).abs() < 0.0008);
}

/// A linear model of the roll lacks a damping that grows with the speed; dry friction is the wrong answer.
#[test]
#[ignore = "needs measured records"]
fn the_roll_of_a_ship_lacks_drag() {
    let (angle, step) = roll();
    let count = (60.0 / step) as usize;
    let angle = angle[..count.min(angle.len())].to_vec();
    let stiffness = (TAU / 2.544).powi(2);
    let structure = oscillator(1.0, stiffness);
    let time = (0..angle.len()).map(|n| step * n as f64).collect();
    let channel = Channel { quantity: Quantity::Displacement, dof: 0, label: "1".into() };
    let record = Record::new(time, vec![channel], vec![angle]).unwrap();
    let label = TransientLabel { file: "roll".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
    let runs = [TransientRun::new(label, Arc::new(record), &[]).unwrap()];
    let records = Records::new(&structure, &[], &runs).unwrap();
    let diagnosis = diagnose_records(&records, &[], &Control::unattended(), &|_| {}).unwrap();
    println!("error before {:.4}, {:?}", diagnosis.error_before, diagnosis.verdict);
    for step in &diagnosis.steps {
        let names: Vec<String> =
            step.added.iter().map(|a| format!("{} {:?}", a.source.effect, a.source.parameters)).collect();
        println!("{:.4}  misfit {:.1}  {names:?}", step.error, step.misfit);
    }
    for s in &diagnosis.suggestions {
        println!(
            "{} {:?} +- {:?}: {:.3}, {:.4}",
            s.added.source.effect, s.added.source.parameters, s.added.deviations, s.probability, s.error_after
        );
    }
    let set = &diagnosis.steps.last().unwrap().added;
    let drag = |e: Effect| matches!(e, Effect::Quadratic | Effect::Power);
    assert!(set.iter().any(|a| drag(a.source.effect)) && set.iter().all(|a| a.source.effect != Effect::Coulomb));
}

/// `f^2 = 36.87^2 + 9.84e9 A^2`, damping ratio 0.6 to 0.7 % large and 0.2 to 0.3 % small.
#[test]
#[ignore = "needs measured records"]
fn the_ring_down_of_a_magneto_elastic_beam_hardens() {
    let rows = columns("magneto-elastic-beam-ring-down.lvm", "X_Value", '\t', [0, 2]);
    let free: Vec<f64> = rows.iter().filter(|r| r[0] > 12.3).map(|r| r[1]).collect();
    let points = amplitude_curve(&free, 1e-3, 12.3, Band { frequency_hz: 39.5, width: 0.0 });
    for p in points.iter().step_by(4) {
        println!("t {:.2} A {:.3e} f {:.3} Hz zeta {:.5}", p.time_s, p.amplitude, p.frequency_hz, p.damping_ratio);
    }
    let seen: Vec<&AmplitudePoint> = points.iter().filter(|p| p.amplitude > 1e-5).collect();
    let rows: Vec<[f64; 3]> = seen.iter().map(|p| [p.amplitude.powi(2), p.frequency_hz.powi(2), 1.0]).collect();
    let found = line(&rows).unwrap();
    println!("f^2 = {:.3}^2 + {:.3e} A^2", found.offset.sqrt(), found.slope);
    assert!((found.offset.sqrt() - 36.87).abs() < 0.1 && (found.slope / 9.84e9 - 1.0).abs() < 0.05);
    let mean = |low: f64, high: f64| {
        let list: Vec<f64> =
            seen.iter().filter(|p| p.amplitude > low && p.amplitude < high).map(|p| p.damping_ratio).collect();
        list.iter().sum::<f64>() / list.len() as f64
    };
    println!("zeta large {:.5}, small {:.5}", mean(1.2e-4, 1.0), mean(1e-5, 2.5e-5));
    assert!(mean(1.2e-4, 1.0) > 0.005 && mean(1e-5, 2.5e-5) < 0.004);
}

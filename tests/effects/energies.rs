//! Energy per period: closed form, exact formula for harmonics, and fine sampling.

use super::{assert_close, cases, rich, sampled};
use dashpot::effects::turning::{loop_ranges, total_variation, turning_points};
use dashpot::effects::{Effect, Motion};
use faer::c64;

/// The work of the sampled force meets the closed form at several amplitudes and frequencies, at any phase.
#[test]
fn the_sampled_work_of_one_harmonic_is_the_closed_form() {
    for (effect, law, p) in cases() {
        for (amplitude, omega) in [(1e-5, 20.0), (3e-4, 20.0), (3e-4, 300.0), (5e-3, 90.0)] {
            let Some(wanted) = law.energy_per_cycle(&p, amplitude, omega) else {
                assert!(matches!(effect, Effect::Stribeck | Effect::BoucWen | Effect::StiffeningBoucWen), "{effect}");
                continue;
            };
            let phase = c64::new(0.36_f64.cos(), 0.36_f64.sin()) * amplitude;
            let motion = Motion::new(omega, 0.0, &[phase], 8192);
            let what = format!("{effect} {p:?} at {amplitude} m, {omega} rad/s");
            let force = sampled(law, &p, &motion);
            let most = force.iter().fold(0.0_f64, |most, f| most.max(f.abs())) * amplitude;
            assert!((motion.work(&force) - wanted).abs() <= 2e-6 * wanted.abs() + 1e-6 * most, "sampled, {what}");
            assert!((law.energy(&p, &motion) - wanted).abs() <= 1e-8 * most, "energy, {what}");
        }
    }
}

/// Where a law has its own formula for several harmonics, the plain work of the force, finely sampled, agrees.
#[test]
fn the_energy_of_several_harmonics_is_the_finely_sampled_work() {
    let (coarse, fine) = (rich(96), rich(1 << 18));
    for (effect, law, p) in cases() {
        let wanted = fine.work(&sampled(law, &p, &fine));
        let found = law.energy(&p, &coarse);
        let scale = sampled(law, &p, &fine).iter().fold(0.0_f64, |most, f| most.max(f.abs())) * 1e-3;
        // Laws that are not smooth at rest and have no exact formula, with no more than 96 samples.
        let tolerance = match effect {
            Effect::Power | Effect::Quadratic | Effect::Stribeck | Effect::AsymmetricViscous => 2e-3,
            Effect::BoucWen | Effect::StiffeningBoucWen | Effect::Dahl => 1e-5,
            _ => 1e-7,
        };
        assert!((found - wanted).abs() < tolerance * scale, "{effect} {p:?}: {found} instead of {wanted}");
    }
}

#[test]
fn no_law_gives_energy_and_springs_take_none() {
    for (effect, law, p) in cases() {
        for motion in [rich(256), Motion::cosine(100.0, 2e-3, 64), Motion::cosine(100.0, 0.0, 64)] {
            let energy = law.energy(&p, &motion);
            assert!(energy >= 0.0, "{effect} {p:?} gives {energy} J");
            if !effect.dissipates() {
                // The kink of a stop costs the plain sum its accuracy.
                let rounding = if matches!(effect, Effect::Gap | Effect::Stop) { 2e-6 } else { 1e-12 };
                let work = motion.work(&sampled(law, &p, &motion));
                assert!(energy == 0.0 && work.abs() < rounding, "{effect} takes {work} J");
            }
        }
    }
}

/// Coulomb friction of several harmonics, by brute force: the way travelled on a very fine grid.
#[test]
fn friction_counts_the_way_travelled() {
    let fine = rich(1 << 20);
    let d = &fine.displacement;
    let way: f64 = (0..d.len()).map(|n| (d[(n + 1) % d.len()] - d[n]).abs()).sum();
    for samples in [32, 64, 500] {
        assert_close(total_variation(&rich(samples)), way, 1e-10, "way");
    }
    assert!(turning_points(&rich(64)).len() > 2, "the motion must have inner loops");
    assert_close(total_variation(&Motion::cosine(3.0, 0.2, 16)), 0.8, 1e-14, "one harmonic");
    assert_eq!(total_variation(&Motion::new(3.0, 1.0, &[c64::new(0.0, 0.0); 3], 16)), 0.0);
}

/// Two turning points a loop, one of them the whole range; together the loops are travelled there and back.
#[test]
fn closed_loops_are_counted_once() {
    let ranges = loop_ranges(&rich(256));
    let points = turning_points(&rich(256));
    let greatest = points.iter().fold(f64::MIN, |a, &b| a.max(b)) - points.iter().fold(f64::MAX, |a, &b| a.min(b));
    assert_eq!(2 * ranges.len(), points.len());
    assert!(ranges.iter().any(|r| (r - greatest).abs() < 1e-15));
    assert_close(2.0 * ranges.iter().sum::<f64>(), total_variation(&rich(256)), 1e-12, "ranges");
}

/// Stribeck friction against quadrature of its definition over a quarter period.
#[test]
fn stribeck_friction_is_its_integral() {
    let (p, amplitude, omega) = ([1.0, 1.8, 0.02], 4e-4, 90.0);
    let steps = 200_000;
    let quarter: f64 = (0..steps)
        .map(|n| {
            let v = omega * amplitude * (std::f64::consts::FRAC_PI_2 * (f64::from(n) + 0.5) / f64::from(steps)).sin();
            (p[0] + (p[1] - p[0]) * (-v / p[2]).exp()) * v
        })
        .sum();
    let wanted = 4.0 * quarter * std::f64::consts::FRAC_PI_2 / omega / f64::from(steps);
    let found = Effect::Stribeck.law().unwrap().energy(&p, &Motion::cosine(omega, amplitude, 512));
    assert_close(found, wanted, 1e-6, "stribeck");
}

/// Bouc-Wen loops of any exponent by quadrature of the way up from zero, `Psi(z)`, in a variable in which it is smooth.
#[test]
fn a_bouc_wen_loop_is_its_integral() {
    for (p, amplitude) in
        [([1e4, 1.0, 1.0], 2e-4), ([1e4, 1.0, 2.0], 3e-4), ([3e3, 2.0, 4.5], 1e-3), ([1e4, 1.0, 2.0], 4e-5)]
    {
        let [stiffness, force, n] = p;
        // Psi(z_m) and the area beside the curve, by the midpoint rule in q = -ln(1 - z).
        let integrals = |zm: f64| {
            let (count, end) = (4000, -(-zm).ln_1p());
            let q = |i: u32| end * (f64::from(i) + 0.5) / f64::from(count);
            (0..count).fold([0.0, 0.0], |[psi, area], i| {
                let z = -(-q(i)).exp_m1();
                let way = (1.0 - z) / (1.0 - z.powf(n)) * end / f64::from(count);
                [psi + way, area + z * way]
            })
        };
        let wanted = 2.0 * stiffness * amplitude / force;
        let (mut low, mut high) = (0.0, 1.0 - 1e-12);
        for _ in 0..45 {
            let zm = 0.5 * (low + high);
            if zm + integrals(zm)[0] > wanted { high = zm } else { low = zm }
        }
        let energy = 2.0 * force * force / stiffness * (integrals(low)[1] - 0.5 * low * low);
        let motion = Motion::cosine(70.0, amplitude, 16_384);
        let found = Effect::BoucWen.law().unwrap().energy(&p, &motion);
        assert_close(found, energy, 2e-5, &format!("{p:?}"));
        let turning = sampled(Effect::BoucWen.law().unwrap(), &p, &motion)[0];
        assert_close(turning, force * low, 1e-6, &format!("{p:?} where it turns"));
    }
}

/// Dahl friction against its own differential equation, marched by the midpoint rule from rest.
#[test]
fn a_dahl_loop_is_that_of_its_equation() {
    let (p, amplitude, steps) = ([5e3, 1.0], 3e-4, 200_000);
    let mut force = 0.0_f64;
    let mut energy = 0.0;
    for cycle in 0..8 {
        for n in 0..steps {
            let angle = |n: f64| std::f64::consts::TAU * n / f64::from(steps);
            let way = amplitude * (angle(f64::from(n) + 1.0).cos() - angle(f64::from(n)).cos());
            let rate = |f: f64| p[0] * (1.0 - f * way.signum() / p[1]);
            let middle = force + 0.5 * way * rate(force);
            if cycle == 7 {
                energy += middle * way;
            }
            force += way * rate(middle);
        }
    }
    let law = Effect::Dahl.law().unwrap();
    assert_close(law.energy_per_cycle(&p, amplitude, 9.0).unwrap(), energy, 1e-7, "energy");
    assert_close(sampled(law, &p, &Motion::cosine(9.0, amplitude, 4096))[0], force, 1e-6, "where it turns");
    // Small loops tend to 4/3 stiffness^2 X^3 / force.
    let small = law.energy_per_cycle(&p, 1e-7, 9.0).unwrap();
    assert_close(small, 4.0 / 3.0 * p[0] * p[0] * 1e-21 / p[1], 1e-6, "small loop");
}

/// The stiffening loop against its closed form: from where it turns, at `z_m`, it unloads over `u = ln(1 + z_m)` and loads over the rest `w`
/// of the way between the turns, `z_m = (exp(r w) - 1) / r`; one half takes out `(z_m - w) / r - (z_m - u)`.
#[test]
fn a_stiffening_loop_is_its_closed_form() {
    let (law, amplitude) = (Effect::StiffeningBoucWen.law().unwrap(), 1e-3);
    for p in [[1e4, 5.0, 0.3], [2e4, 1.5, 0.8], [5e3, 2.0, -0.6], [1e2, 2.0, 0.5]] {
        let (range, r) = (2.0 * p[0] * amplitude / p[1], p[2]);
        let turned = |w: f64| (r * w).exp_m1() / r;
        let (mut low, mut high) = (0.0, range);
        for _ in 0..200 {
            let w = 0.5 * (low + high);
            if w + turned(w).ln_1p() < range { low = w } else { high = w }
        }
        let (w, z) = (low, turned(low));
        let energy = 2.0 * p[1] * p[1] / p[0] * ((z - w) / r - (z - z.ln_1p()));
        let scale = p[1] * z * amplitude;
        let found = law.energy(&p, &Motion::cosine(9.0, amplitude, 64));
        assert!((found - energy).abs() < 1e-6 * scale, "{p:?}: {found} instead of {energy}");
        assert_close(sampled(law, &p, &Motion::cosine(9.0, amplitude, 64))[0], p[1] * z, 1e-10, "where it turns");
    }
}

/// The slider with backlash against its definition marched from rest: what it takes out is its force over the way that it slides.
#[test]
fn a_loop_with_backlash_is_that_of_its_definition() {
    let (p, steps) = ([5e3, 1.0, 3e-4], 100_000);
    let law = Effect::ElasticSliderBacklash.law().unwrap();
    for amplitude in [1e-4, 3e-4, 4e-4, 1e-3] {
        let reach = p[1] / p[0] + 0.5 * p[2];
        let (mut z, mut d, mut energy) = (0.0_f64, 0.0_f64, 0.0);
        for n in 1..=3 * steps {
            let next = amplitude * (std::f64::consts::TAU * f64::from(n) / f64::from(steps)).sin();
            let before = p[0] * (z.abs() - 0.5 * p[2]).max(0.0) * z.signum();
            z = (z + next - d).clamp(-reach, reach);
            let after = p[0] * (z.abs() - 0.5 * p[2]).max(0.0) * z.signum();
            if n > 2 * steps {
                energy += 0.5 * (before + after) * (next - d);
            }
            d = next;
        }
        let wanted = 4.0 * p[1] * (amplitude - reach).max(0.0);
        assert!((energy - wanted).abs() < 1e-6 * p[1] * amplitude, "{amplitude}: {energy} instead of {wanted}");
        assert_close(law.energy_per_cycle(&p, amplitude, 9.0).unwrap(), wanted, 1e-14, "closed form");
    }
}

/// What is not odd has a mean force: `(c_pull - c_push) omega X / pi` of the dashpot, the offset of the friction, that of the
/// contact of the stop.
#[test]
fn asymmetric_laws_have_a_mean_force() {
    let (omega, amplitude) = (70.0, 1e-3);
    let motion = Motion::cosine(omega, amplitude, 4096);
    let mean = |effect: Effect, p: &[f64]| {
        let force = sampled(effect.law().unwrap(), p, &motion);
        force.iter().sum::<f64>() / force.len() as f64
    };
    let wanted = 2.5 * omega * amplitude / std::f64::consts::PI;
    assert_close(mean(Effect::AsymmetricViscous, &[3.0, 0.5]), wanted, 1e-6, "dashpot");
    // Where the motion turns, a sample may fall to either side.
    assert_close(mean(Effect::AsymmetricCoulomb, &[0.9, 0.3]), 0.3, 2e-3, "friction");
    let angle = 0.4_f64.acos();
    let wanted = 4e3 * amplitude * (angle.sin() - angle * angle.cos()) / std::f64::consts::PI;
    assert_close(mean(Effect::Stop, &[4e3, 4e-4]), wanted, 1e-6, "stop");
    assert_close(mean(Effect::Stop, &[4e3, -4e-4]), -wanted, 1e-6, "stop on the other side");
}

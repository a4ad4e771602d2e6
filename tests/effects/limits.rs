//! Laws that contain others as limits, and the slip laws against marching with many discrete sliders.

use super::{assert_close, rich, sampled};
use dashpot::effects::{Effect, Motion};

fn same_force(one: (Effect, &[f64]), other: (Effect, &[f64]), tolerance: f64, motion: &Motion) {
    let (a, b) = (sampled(one.0.law().unwrap(), one.1, motion), sampled(other.0.law().unwrap(), other.1, motion));
    let size = b.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() <= tolerance * size, "{} {} : {a} instead of {b}", one.0, other.0);
    }
}

#[test]
fn laws_contain_their_limits() {
    let motion = rich(300);
    same_force((Effect::Power, &[3.0, 1.0]), (Effect::Viscous, &[3.0]), 1e-13, &motion);
    same_force((Effect::Power, &[3.0, 2.0]), (Effect::Quadratic, &[3.0]), 1e-13, &motion);
    same_force((Effect::Power, &[3.0, 0.0]), (Effect::Coulomb, &[3.0]), 1e-13, &motion);
    same_force((Effect::Stribeck, &[3.0, 3.0, 0.1]), (Effect::Coulomb, &[3.0]), 1e-13, &motion);
    same_force((Effect::Maxwell, &[1e12, 2.0]), (Effect::Viscous, &[2.0]), 1e-8, &motion);
    same_force((Effect::Maxwell, &[50.0, 1e12]), (Effect::Stiffness, &[50.0]), 0.1, &motion);
    same_force((Effect::Fractional, &[2.0, 1.0 - 1e-12]), (Effect::Viscous, &[2.0]), 1e-9, &motion);
    same_force((Effect::Gap, &[70.0, 0.0]), (Effect::Stiffness, &[70.0]), 1e-13, &motion);
    same_force((Effect::ElasticSliderBacklash, &[4e3, 1.0, 0.0]), (Effect::ElasticSlider, &[4e3, 1.0]), 1e-9, &motion);
    same_force((Effect::ElasticSlider, &[70.0, 1e9]), (Effect::Stiffness, &[70.0]), 1e-12, &motion);
    same_force((Effect::Iwan, &[70.0, 1e9, -0.5, 1.0]), (Effect::Stiffness, &[70.0]), 1e-4, &motion);
    same_force((Effect::Iwan, &[4e3, 1.0, -0.5, 1e9]), (Effect::ElasticSlider, &[4e3, 1.0]), 1e-8, &motion);
}

#[test]
fn a_stiff_slider_is_coulomb_friction() {
    let (slider, motion) = (Effect::ElasticSlider.law().unwrap(), rich(128));
    let wanted = Effect::Coulomb.law().unwrap().energy(&[2.0], &motion);
    let error = |stiffness: f64| (slider.energy(&[stiffness, 2.0], &motion) - wanted).abs() / wanted;
    assert!(error(1e10) < 1e-6, "{}", error(1e10));
    assert_close(error(1e8) / error(1e9), 10.0, 1e-3, "first order in 1 / stiffness");
}

/// One elastic slider marched from the virgin state, sample by sample, over two periods.
fn marched(stiffness: f64, force: f64, motion: &Motion) -> Vec<f64> {
    let mut out = vec![0.0; motion.len()];
    let (mut now, mut last) = (0.0_f64, 0.0);
    for _ in 0..2 {
        for (n, &d) in motion.displacement.iter().enumerate() {
            now = (now + stiffness * (d - last)).clamp(-force, force);
            last = d;
            out[n] = now;
        }
    }
    out
}

#[test]
fn the_slider_is_what_marching_gives() {
    let motion = rich(200);
    for (stiffness, force) in [(1e4, 1.0), (1e4, 3.0), (1e4, 5.5), (3e3, 2.5), (1e3, 50.0)] {
        let found = sampled(Effect::ElasticSlider.law().unwrap(), &[stiffness, force], &motion);
        for (n, (a, b)) in found.iter().zip(marched(stiffness, force, &motion)).enumerate() {
            assert!((a - b).abs() < 1e-10, "{stiffness} {force}, sample {n}: {a} instead of {b}");
        }
    }
}

/// Segalman's joint as many discrete sliders in parallel.
#[test]
fn the_joint_is_many_sliders_in_parallel() {
    let motion = rich(200);
    for p in [[1e4, 2.0, -0.5, 0.7], [4e3, 3.0, -0.8, 0.1], [1e4, 40.0, 0.0, 0.5], [1e4, 8.0, -0.2, 0.0]] {
        let [stiffness, force, chi, beta] = p;
        let longest = force * (1.0 + beta) / (stiffness * (beta + (chi + 1.0) / (chi + 2.0)));
        let count = 4000;
        let mut wanted = marched(stiffness * beta / (1.0 + beta), stiffness * beta / (1.0 + beta) * longest, &motion);
        for i in 0..count {
            // Equal shares of the distributed stiffness; its cumulative distribution is (phi / phi_max)^(chi+1).
            let phi = longest * ((f64::from(i) + 0.5) / f64::from(count)).powf(1.0 / (chi + 1.0));
            let share = stiffness / (1.0 + beta) / f64::from(count);
            for (sum, f) in wanted.iter_mut().zip(marched(share, share * phi, &motion)) {
                *sum += f;
            }
        }
        let found = sampled(Effect::Iwan.law().unwrap(), &p, &motion);
        for (n, (a, b)) in found.iter().zip(&wanted).enumerate() {
            assert!((a - b).abs() < 1e-3 * force.min(5.0), "{p:?}, sample {n}: {a} instead of {b}");
        }
    }
}

#[test]
fn the_joint_dissipates_with_the_power_law_of_partial_slip() {
    let (law, p) = (Effect::Iwan.law().unwrap(), [1e6, 100.0, -0.4, 0.5]);
    let work = |amplitude: f64| {
        let motion = Motion::cosine(50.0, amplitude, 16384);
        motion.work(&sampled(law, &p, &motion))
    };
    assert_close((work(2e-5) / work(1e-5)).log2(), 2.6, 1e-4, "exponent 3 + chi");
    let sliding = law.energy_per_cycle(&p, 2e-2, 1.0).unwrap() - law.energy_per_cycle(&p, 1e-2, 1.0).unwrap();
    assert_close(sliding, 4.0 * 100.0 * 1e-2, 1e-12, "full slip");
}

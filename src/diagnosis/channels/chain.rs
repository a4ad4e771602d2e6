//! What a measuring chain does to all motions together against the force, or to one channel against the others: a high-pass (AC
//! coupling), or a delay. Of all motions no shape shows it, and no modal mass.
//!
//! Beside a model that is corrected, the motion of run `r` at `w_r` is measured `rho_r` times as large as it is predicted, and
//!
//! ```text
//! rho = g / (1 - i w_c / w)        all motions pass a high-pass of first order, corner w_c: they lead by atan(w_c / w)
//! rho = g (1 - i w_c / w)          the force does
//! rho = g exp(-i w t)              all motions are recorded late by t
//! rho = g exp(i w t)               the force is
//! ```
//!
//! with one real `g`, the scale of the model; of one channel `rho_r` is its own ratio over that of the others, and `t` of either sign. `g` and `w_c` or `t` are fitted to all runs by least squares. A model that is wrong turns
//! each mode by an angle of its own, forth and back about its resonance; a law that is missing turns each level by one of its own.

use faer::c64;
use std::f64::consts::TAU;

/// Least angle, root mean square over the runs, rad: ten times what chains are off by where nothing is wrong with them.
const PLAIN: f64 = 0.03;
/// Share of the squared error beside `g` alone that is left where a chain explains it.
const EXPLAINS: f64 = 0.05;
/// Least runs, and the least ratio of their highest over their lowest frequency: at one frequency every angle is that of any chain.
const RUNS: usize = 4;
const APART: f64 = 1.5;
/// Steps of Gauss and Newton.
const STEPS: usize = 30;

/// What is in the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chain {
    /// A delay, s.
    Late,
    /// A high-pass of first order with this corner, Hz.
    HighPass,
}

/// A chain with its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainFault {
    /// What it is.
    pub chain: Chain,
    /// Delay, s, or corner, Hz.
    pub value: f64,
    /// Its standard deviation by the scatter of the runs, the same unit.
    pub deviation: f64,
    /// Lowest and highest frequency of the runs that say so, Hz.
    pub range_hz: [f64; 2],
}

impl ChainFault {
    /// What is recorded over what is true at circular frequency `w` (rad/s).
    pub fn transfer(&self, w: f64) -> c64 {
        transfer(self.chain, self.value, w)
    }

    /// Angle by which what is recorded leads what is true, degrees, at a frequency (Hz).
    pub fn lead_deg(&self, hz: f64) -> f64 {
        match self.chain {
            Chain::Late => -360.0 * hz * self.value,
            Chain::HighPass => (self.value / hz).atan().to_degrees(),
        }
    }
}

fn transfer(chain: Chain, value: f64, w: f64) -> c64 {
    let one = c64::new(1.0, 0.0);
    match chain {
        Chain::Late => c64::new((w * value).cos(), -(w * value).sin()),
        Chain::HighPass => one / c64::new(1.0, -TAU * value / w),
    }
}

/// One run: its circular frequency (rad/s) and its measured over its predicted motion.
pub(crate) type Ratio = (f64, c64);

/// A chain that explains the ratios.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Explained {
    pub fault: ChainFault,
    /// Whether it is that of the force.
    pub of_force: bool,
    /// Error of the ratios beside one scale, relative, root mean square: without and with it.
    pub error: [f64; 2],
    /// Runs that are nearer with it, of all.
    pub shown: [usize; 2],
}

/// The chain that explains the ratios of the motions best, where one does.
pub(crate) fn explained(ratios: &[Ratio]) -> Option<Explained> {
    let leads = ratios.iter().map(|(_, rho)| rho.arg()).sum::<f64>() > 0.0;
    best_of(ratios, [(Chain::Late, leads), (Chain::HighPass, !leads)])
}

/// The same of one channel against the others, a delay below zero where it is early.
pub(crate) fn explained_of_one(ratios: &[Ratio]) -> Option<Explained> {
    let early = ratios.iter().map(|(w, rho)| w * rho.arg()).sum::<f64>() > 0.0;
    let mut found = best_of(ratios, [(Chain::Late, early), (Chain::HighPass, false)])?;
    if found.of_force {
        (found.fault.value, found.of_force) = (-found.fault.value, false);
    }
    Some(found)
}

/// The best of chains, each of the force or not, where it explains the ratios.
fn best_of(ratios: &[Ratio], tried: [(Chain, bool); 2]) -> Option<Explained> {
    let lowest = ratios.iter().fold(f64::INFINITY, |m, (w, _)| m.min(*w));
    let highest = ratios.iter().fold(0.0_f64, |m, (w, _)| m.max(*w));
    let sound = ratios.iter().all(|(w, rho)| *w > 0.0 && rho.norm().is_finite() && rho.norm() > 0.0);
    if ratios.len() < RUNS || highest < APART * lowest || !sound {
        return None;
    }
    let fits = tried.into_iter().filter_map(|(chain, of_force)| Fit::new(ratios, chain, of_force));
    let best = fits.min_by(|a, b| a.left.total_cmp(&b.left))?;
    let without = beside_scale(ratios, |_| c64::new(1.0, 0.0));
    let angles = ratios.iter().map(|(w, _)| best.transfer(*w).arg().powi(2)).sum::<f64>() / ratios.len() as f64;
    if angles.sqrt() < PLAIN || best.left > EXPLAINS * without.1 {
        return None;
    }
    let count = ratios.len() as f64;
    let nearer = |(w, rho): &&Ratio| {
        (rho / best.scale - best.transfer(*w)).norm() < (rho / without.0 - c64::new(1.0, 0.0)).norm()
    };
    let fault = ChainFault {
        chain: best.chain,
        value: best.value,
        deviation: best.deviation,
        range_hz: [lowest / TAU, highest / TAU],
    };
    Some(Explained {
        fault,
        of_force: best.of_force,
        error: [(without.1 / count).sqrt() / without.0, (best.left / count).sqrt() / best.scale],
        shown: [ratios.iter().filter(nearer).count(), ratios.len()],
    })
}

/// The scale `g` that brings `g H(w)` nearest to the ratios, and the squared error that it leaves.
fn beside_scale(ratios: &[Ratio], shape: impl Fn(f64) -> c64) -> (f64, f64) {
    let (mut product, mut square) = (0.0, 0.0);
    for (w, rho) in ratios {
        product += (shape(*w).conj() * rho).re;
        square += shape(*w).norm_sqr();
    }
    let scale = product / square;
    (scale, ratios.iter().map(|(w, rho)| (rho - shape(*w) * scale).norm_sqr()).sum())
}

/// One chain fitted to the ratios.
struct Fit {
    chain: Chain,
    of_force: bool,
    value: f64,
    deviation: f64,
    scale: f64,
    left: f64,
}

impl Fit {
    /// None where no positive number fits.
    fn new(ratios: &[Ratio], chain: Chain, of_force: bool) -> Option<Self> {
        let first = guess(ratios, chain);
        let mut fit = Self { chain, of_force, value: first, deviation: 0.0, scale: 1.0, left: f64::INFINITY };
        for _ in 0..STEPS {
            let (scale, left) = beside_scale(ratios, |w| fit.transfer(w));
            (fit.scale, fit.left) = (scale, left);
            let [step, information] = fit.step(ratios);
            let freedom = (2 * ratios.len() - 2).max(1) as f64;
            fit.deviation = (left / freedom / information).sqrt();
            fit.value += step;
            if step.abs() < 1e-9 * fit.value.abs() {
                break;
            }
        }
        (fit.value > 0.0 && fit.left.is_finite() && fit.deviation.is_finite() && fit.scale > 0.0).then_some(fit)
    }

    /// Measured over true ratio of motion over force.
    fn transfer(&self, w: f64) -> c64 {
        let own = transfer(self.chain, self.value, w);
        if self.of_force { c64::new(1.0, 0.0) / own } else { own }
    }

    /// Step of the value, the scale being free, and the information on it.
    fn step(&self, ratios: &[Ratio]) -> [f64; 2] {
        let (mut scales, mut both, mut values, mut right) = (0.0, 0.0, 0.0, [0.0; 2]);
        for (w, rho) in ratios {
            let h = self.transfer(*w);
            let (slope, error) = (self.slope(*w) * self.scale, rho - h * self.scale);
            scales += h.norm_sqr();
            both += (h.conj() * slope).re;
            values += slope.norm_sqr();
            right[0] += (h.conj() * error).re;
            right[1] += (slope.conj() * error).re;
        }
        let information = values - both * both / scales;
        [(right[1] - both / scales * right[0]) / information, information]
    }

    /// Derivative of the transfer by the value.
    fn slope(&self, w: f64) -> c64 {
        let h = self.transfer(w);
        match (self.chain, self.of_force) {
            (Chain::Late, false) => h * c64::new(0.0, -w),
            (Chain::Late, true) => h * c64::new(0.0, w),
            (Chain::HighPass, false) => h * h * c64::new(0.0, TAU / w),
            (Chain::HighPass, true) => c64::new(0.0, -TAU / w),
        }
    }
}

/// Where a fit begins: the number by the angles, in proportion to the frequency or to its inverse.
fn guess(ratios: &[Ratio], chain: Chain) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for (w, rho) in ratios {
        let (angle, by) = match chain {
            Chain::Late => (rho.arg().abs(), *w),
            Chain::HighPass => (rho.arg().abs().tan().clamp(0.0, 10.0), TAU / w),
        };
        product += angle * by;
        square += by * by;
    }
    product / square
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// Runs about three modes whose ratios are this `shape` of their circular frequency, with a scatter of 0.2 %.
    fn ratios(shape: impl Fn(f64) -> c64) -> Vec<Ratio> {
        let about = |hz: f64| [0.95, 0.98, 1.0, 1.02, 1.05].map(|share| TAU * share * hz);
        let scatter = |k: usize| c64::new(1.0 + 2e-3 * (7.0 * k as f64).sin(), 2e-3 * (5.0 * k as f64).cos());
        let all = [1.84, 5.15, 7.44].into_iter().flat_map(about).enumerate();
        all.map(|(k, w)| (w, shape(w) * scatter(k) * 1.02)).collect()
    }

    #[test]
    fn a_high_pass_and_a_delay_are_told_with_their_numbers() {
        let i = |x: f64| c64::new(0.0, x);
        // An RC high-pass as circuits state it, and a motion that is recorded 3 ms late.
        let high_pass = |w: f64| i(w / (TAU * 0.5)) / (i(w / (TAU * 0.5)) + 1.0);
        let late = |w: f64| c64::new((3e-3 * w).cos(), -(3e-3 * w).sin());
        let cases: [(Vec<Ratio>, Chain, bool, f64); 4] = [
            (ratios(high_pass), Chain::HighPass, false, 0.5),
            (ratios(|w| c64::new(1.0, 0.0) / high_pass(w)), Chain::HighPass, true, 0.5),
            (ratios(late), Chain::Late, false, 3e-3),
            (ratios(|w| late(w).conj()), Chain::Late, true, 3e-3),
        ];
        for (ratios, chain, of_force, value) in cases {
            let found = explained(&ratios).unwrap();
            assert_eq!((found.fault.chain, found.of_force), (chain, of_force));
            let off = (found.fault.value - value).abs();
            assert!(off < 3.0 * found.fault.deviation && off < 0.01 * value, "{chain:?} {of_force}: {:?}", found.fault);
            assert!(found.error[1] < 3e-3 && found.error[0] > 0.05, "{:?}", found.error);
        }
    }

    #[test]
    fn of_one_channel_a_delay_has_either_sign() {
        for delay in [1.2e-3, -1.2e-3] {
            let found = explained_of_one(&ratios(|w| c64::from_polar(1.0, -w * delay))).unwrap();
            assert_eq!((found.fault.chain, found.of_force), (Chain::Late, false));
            assert!((found.fault.value / delay - 1.0).abs() < 0.02, "{:?}", found.fault);
            let recorded = found.fault.transfer(40.0).arg();
            assert!((recorded + 40.0 * delay).abs() < 1e-3, "{recorded}");
        }
    }

    /// Errors of a model turn modes forth and back, or one of them; a chain as good as chains are turns nothing.
    #[test]
    fn what_no_chain_does_is_none() {
        let turned = |angle: f64| c64::new(angle.cos(), angle.sin());
        assert_eq!(explained(&ratios(|w| turned(5e-3 / w))), None);
        assert_eq!(explained(&ratios(|w| turned(if w < 15.0 { 0.2 } else { 0.0 }))), None);
        assert_eq!(explained(&ratios(|w| turned(0.3 * (40.0 * w).sin()))), None);
        assert_eq!(explained(&ratios(|w| turned(2.0 / w))[..5]), None, "one mode alone");
    }
}

//! Fingerprints, free of any law: how the free force of a place grows with the motion.
//!
//! ```text
//! g / D = k_eq + i w c_eq,      ln |k_eq| or ln |c_eq| = const + p ln |D| + q ln w
//! ```
//!
//! `p` of `c_eq` is 0 for a viscous dashpot, -1 for Coulomb friction, +1 for quadratic damping; `q` is -1 for hysteretic
//! damping. `p` of `k_eq` is 0 for a spring, +2 for a cubic one; `q` is 2 for a mass.

use crate::diagnosis::candidates::identified_force::{PlaceData, Ratio};
use crate::math::least_squares::LeastSquares;
use faer::{Mat, c64};

/// An exponent with its standard deviation.
pub(crate) type Exponent = [f64; 2];

/// The powers that a free force follows over the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fingerprint {
    /// Whether most of the force is in phase with velocity rather than displacement.
    pub damping: bool,
    /// Power of the amplitude of the relative motion; none if all runs have the same.
    pub by_amplitude: Option<Exponent>,
    /// Power of the frequency; none if all runs have the same.
    pub by_frequency: Option<Exponent>,
    /// Number of runs that show the force.
    pub runs: usize,
}

/// Least spread (standard deviation of a logarithm) of a variable whose power is worth stating.
const SPREAD: f64 = 0.05;

/// The powers of the fundamental of a free force; none where too few runs show it.
pub(crate) fn fingerprint(data: &PlaceData) -> Option<Fingerprint> {
    of_ratios(&data.ratios())
}

/// The powers that the ratios of force to motion follow.
pub(crate) fn of_ratios(points: &[Ratio]) -> Option<Fingerprint> {
    let strength = |part: fn(c64) -> f64| points.iter().map(|p| (part(p.ratio) * p.weight).abs()).sum::<f64>();
    let damping = strength(|z| z.im) >= strength(|z| z.re);
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for p in points {
        let value = if damping { p.ratio.im / p.omega } else { p.ratio.re };
        let relative = p.deviation / if damping { p.ratio.im.abs() } else { p.ratio.re.abs() };
        if relative < 0.3 {
            rows.push([value.abs().ln(), p.amplitude.ln(), p.omega.ln()]);
        }
    }
    if rows.len() < 4 {
        return None;
    }
    let varied = [spread(&rows, 1) > SPREAD, spread(&rows, 2) > SPREAD];
    let columns: Vec<usize> = (1..3).filter(|&k| varied[k - 1]).collect();
    let design = Mat::from_fn(rows.len(), columns.len() + 1, |i, j| if j == 0 { 1.0 } else { rows[i][columns[j - 1]] });
    let fit = LeastSquares::new(design.as_ref()).ok()?;
    let solution = fit.solve(&rows.iter().map(|r| r[0]).collect::<Vec<_>>()).ok()?;
    let deviations = fit.standard_deviations(solution.variance);
    let exponent = |k: usize| columns.iter().position(|&c| c == k).map(|j| [solution.x[j + 1], deviations[j + 1]]);
    Some(Fingerprint { damping, by_amplitude: exponent(1), by_frequency: exponent(2), runs: rows.len() })
}

fn spread(rows: &[[f64; 3]], k: usize) -> f64 {
    crate::math::statistics::standard_deviation(&rows.iter().map(|r| r[k]).collect::<Vec<_>>())
}

impl Fingerprint {
    /// What the powers say, in words.
    pub(crate) fn sentences(&self) -> Vec<String> {
        let what = if self.damping { "equivalent viscous coefficient" } else { "equivalent stiffness" };
        let law = |p: f64| match (self.damping, p) {
            (true, p) if p < -0.7 => "Coulomb friction has -1",
            (true, p) if p > 0.7 => "quadratic damping has +1",
            (true, p) if p.abs() < 0.2 => "a viscous dashpot or hysteretic damping has 0",
            (false, p) if p > 1.4 => "a cubic spring has +2",
            (false, p) if p.abs() < 0.2 => "a spring or a mass has 0",
            _ => "between the simple laws",
        };
        let mut said = Vec::new();
        if let Some([p, d]) = self.by_amplitude {
            let runs = self.runs;
            said.push(format!(
                "Over {runs} runs the {what} goes with the amplitude to the power {p:.2} +- {d:.2}: {}.",
                law(p)
            ));
        }
        if let Some([q, d]) = self.by_frequency {
            let note = self.frequency_note(q);
            said.push(format!("With the frequency it goes to the power {q:.2} +- {d:.2}: {note}."));
        }
        said
    }
    /// What a power `q` of the frequency says beside that of the amplitude: at one amplitude of displacement, a law of
    /// velocity alone has the same power in both, one of displacement alone loses one power of frequency.
    fn frequency_note(&self, q: f64) -> &'static str {
        let p = self.by_amplitude.map(|[p, _]| p);
        let near = |x: f64, to: f64| (x - to).abs() < 0.3;
        let along = |to: f64| p.is_none_or(|p| near(p, to));
        match (self.damping, q) {
            (true, q) if near(q, -1.0) && p.is_none() => "Coulomb friction and hysteretic damping have -1",
            (true, q) if near(q, -1.0) && along(-1.0) => "Coulomb friction has -1 here too",
            (true, q) if near(q, -1.0) && along(0.0) => "hysteretic damping has -1",
            (true, q) if near(q, 0.0) && along(0.0) => "a viscous dashpot has 0",
            (true, q) if near(q, 1.0) && along(1.0) => "quadratic damping has +1 here too",
            (true, q) if q > -1.0 && q < 0.0 && along(0.0) => {
                "between hysteretic damping (-1) and a viscous dashpot (0), as fractional damping"
            }
            (true, q) if p.is_some_and(|p| near(q, p)) => {
                "the same power as of the amplitude, as of a force of velocity alone"
            }
            (false, q) if q > 1.4 => "a mass has +2",
            (false, q) if near(q, 0.0) => "a spring has 0",
            _ => "between the simple laws",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn said(damping: bool, p: Option<f64>, q: f64) -> String {
        let exponent = |x| [x, 0.02];
        let print = Fingerprint { damping, by_amplitude: p.map(exponent), by_frequency: Some(exponent(q)), runs: 12 };
        print.sentences().pop().unwrap_or_default()
    }

    #[test]
    fn the_frequency_is_read_beside_the_amplitude() {
        assert!(said(true, Some(-1.0), -1.0).contains("Coulomb friction"));
        assert!(!said(true, Some(-1.0), -1.0).contains("hysteretic"));
        assert!(said(true, Some(0.0), -1.0).contains("hysteretic damping has -1"));
        assert!(said(true, None, -1.0).contains("Coulomb friction and hysteretic"));
        assert!(said(true, Some(1.0), 1.0).contains("quadratic"));
        assert!(said(true, Some(0.0), -0.5).contains("fractional"));
        assert!(said(true, Some(0.5), 0.5).contains("velocity alone"));
        assert!(said(false, Some(0.0), 2.0).contains("mass"));
        assert!(said(true, Some(-1.0), 0.0).contains("between the simple laws"));
    }

    /// Runs of a law of force `law(d, v)` at amplitudes and frequencies of their own: fundamental of the force over that of
    /// `d = a cos w t`, by sums over one period.
    fn runs(law: impl Fn(f64, f64) -> f64) -> Vec<Ratio> {
        let of_run = |(amplitude, omega): (f64, f64)| {
            let samples = 20_000;
            let mut force = c64::new(0.0, 0.0);
            for n in 0..samples {
                let (sin, cos) = (TAU * (f64::from(n) + 0.5) / f64::from(samples)).sin_cos();
                let weight = c64::new(cos, -sin) * (2.0 / f64::from(samples));
                force += weight * law(amplitude * cos, -amplitude * omega * sin);
            }
            let ratio = force / amplitude;
            Ratio { ratio, deviation: 1e-3 * ratio.norm(), weight: (1e-3 * ratio.norm()).powi(-2), amplitude, omega }
        };
        let amplitudes = [1e-4, 3e-4, 5e-4, 1e-3, 2e-3];
        amplitudes.into_iter().flat_map(|a| [60.0, 75.0, 110.0].map(|w| (a, w))).map(of_run).collect()
    }

    /// `c_eq` of `|v|^n sign v` goes with `(w D)^(n - 1)`, of a loss that knows no speed with `D^0 w^-1`; `k_eq` of `d^n` with
    /// `D^(n - 1)`.
    #[test]
    fn loops_have_the_exponents_of_their_laws() {
        let power = |v: f64, n: f64| v.abs().powf(n) * v.signum();
        let check = |law: &dyn Fn(f64, f64) -> f64, damping: bool, exponents: [f64; 2]| {
            let Some(found) = of_ratios(&runs(law)) else { panic!("fifteen runs") };
            assert_eq!((found.damping, found.runs), (damping, 15));
            for (exponent, expected) in [found.by_amplitude, found.by_frequency].into_iter().zip(exponents) {
                let Some([value, deviation]) = exponent else { panic!("amplitudes and frequencies vary") };
                assert!((value - expected).abs() < 1e-3 && deviation < 1e-3, "{value} +- {deviation} for {expected}");
            }
        };
        for n in [0.0, 0.5, 1.0, 1.7, 2.0] {
            check(&|_, v| 3.0 * power(v, n), true, [n - 1.0; 2]);
        }
        for n in [1.0, 1.5, 3.0] {
            check(&|d, _| 4e4 * power(d, n), false, [n - 1.0, 0.0]);
        }
        // A force in phase with velocity of the size of a displacement: hysteretic damping is that of one frequency each.
        let hysteretic: Vec<Ratio> = runs(|d, _| 50.0 * d)
            .into_iter()
            .map(|run| Ratio { ratio: run.ratio * c64::new(0.0, 1.0), ..run })
            .collect();
        let Some(found) = of_ratios(&hysteretic) else { panic!("fifteen runs") };
        let Some([q, _]) = found.by_frequency else { panic!("frequencies vary") };
        assert!(found.damping && (q + 1.0).abs() < 1e-6, "{found:?}");
    }

    /// One amplitude in all runs says nothing of its power, and three runs nothing at all.
    #[test]
    fn what_does_not_vary_has_no_exponent() {
        let alike: Vec<Ratio> = runs(|_, v| 2.0 * v).into_iter().filter(|run| run.amplitude == 1e-3).collect();
        assert!(of_ratios(&alike).is_none(), "three runs");
        let many: Vec<Ratio> = alike.iter().chain(&alike).copied().collect();
        let Some(found) = of_ratios(&many) else { panic!("six runs") };
        assert!(found.by_amplitude.is_none() && found.by_frequency.is_some());
    }
}

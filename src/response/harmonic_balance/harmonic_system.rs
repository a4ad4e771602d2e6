//! One harmonic of the condensed system: what its kept legs do to each other, and the elimination of the others.

use super::compliance::Compliance;
use super::dense::invert;
use super::error::ModelError;
use super::excitation::Excitation;
use super::linear_leg::{LinearLeg, stiffness_of};
use super::nonlinear_leg::NonlinearLeg;
use super::resonant::Pattern;
use crate::effects::Source;
use faer::c64;

/// Growth of rounding in the elimination of linear legs from which on they are kept.
const AT_RESONANCE: f64 = 1e4;
/// Stiffness of a leg, relative to that of the structure there, from which on it is rigid.
const RIGID: f64 = 1e4;

/// Quantities of one harmonic. `m` kept legs (nonlinear ones, then those of [`HarmonicSystem::resonant`]) and `k` eliminated ones.
pub(crate) struct HarmonicSystem {
    /// `C_h`, m x m row by row, m/N.
    coupling: Vec<c64>,
    /// `D_lin,h`, m.
    pub free: Vec<c64>,
    /// `S`, k x k.
    pub elimination: Vec<c64>,
    /// `G_lN`, k x m.
    pub mixed: Vec<c64>,
    /// `d_l`, k.
    pub linear_free: Vec<c64>,
    /// Dynamic stiffness of the modes at resonance, then of the linear legs where they are kept, N/m.
    pub resonant: Vec<c64>,
    /// Number of those at lower harmonics.
    pub resonant_before: usize,
    /// Whether the linear legs are kept.
    pub keeps_linear: bool,
}

impl HarmonicSystem {
    /// Number of kept legs.
    pub(crate) fn count(&self) -> usize {
        self.free.len()
    }

    /// Motion of kept leg `i` under a unit force of leg `j`, m/N, with the sign turned.
    pub(crate) fn coupling(&self, i: usize, j: usize) -> c64 {
        self.coupling[i * self.count() + j]
    }
}

/// Condenses harmonic `h`, whose receptance is `compliance`.
pub(crate) fn harmonic_system(
    compliance: &Compliance,
    sources: &[Source],
    legs: &[NonlinearLeg],
    linear: &[LinearLeg],
    excitation: &Excitation,
    h: usize,
) -> Result<HarmonicSystem, ModelError> {
    let omega = h as f64 * excitation.omega;
    let table = |rows: &[Pattern], columns: &[Pattern]| -> Vec<c64> {
        rows.iter().flat_map(|&a| columns.iter().map(move |&b| compliance.between(a, b))).collect()
    };
    let mut kept: Vec<Pattern> = (legs.iter().map(|l| Pattern::Leg(l.leg)))
        .chain((0..compliance.resonant.len()).map(Pattern::Resonant))
        .collect();
    let mut eliminated: Vec<Pattern> = linear.iter().map(|l| Pattern::Leg(l.leg)).collect();
    let stiffness: Vec<c64> = linear.iter().map(|l| stiffness_of(&sources[l.source], omega)).collect();
    let own = table(&eliminated, &eliminated);
    let mut elimination = eliminate(&own, &stiffness);
    let mut resonant: Vec<c64> = compliance.resonant.iter().map(|mode| mode.stiffness).collect();
    let keeps_linear = h > 0 && compliance.apart && at_resonance(&own, &stiffness, elimination.as_ref());
    if keeps_linear {
        kept.append(&mut eliminated);
        resonant.extend(stiffness);
        elimination = Some(Elimination::default());
    }
    let singular = ModelError::SingularSources { frequency_hz: omega / std::f64::consts::TAU };
    let elimination = elimination.ok_or(singular)?.stiffness;
    let free = |at: &Pattern| {
        excitation.forces.iter().fold(c64::new(0.0, 0.0), |sum, force| {
            let value = force.amplitude(h);
            if value.norm_sqr() == 0.0 { sum } else { sum + compliance.between(*at, Pattern::Leg(force.leg())) * value }
        })
    };
    let mut system = HarmonicSystem {
        coupling: table(&kept, &kept),
        free: kept.iter().map(free).collect(),
        elimination,
        mixed: table(&eliminated, &kept),
        linear_free: eliminated.iter().map(free).collect(),
        resonant,
        resonant_before: 0,
        keeps_linear,
    };
    system.eliminate();
    for (i, leg) in legs.iter().enumerate() {
        // A slider behind a spring moves by less than its ends do.
        system.coupling[i * (kept.len() + 1)] += leg.flexibility;
    }
    Ok(system)
}

impl HarmonicSystem {
    /// Takes what the eliminated legs do into the coupling and the free motion of the kept ones.
    fn eliminate(&mut self) {
        let (m, k) = (self.free.len(), self.linear_free.len());
        if k == 0 {
            return;
        }
        let back = |pulled: &[c64], i: usize| {
            (0..k).fold(c64::new(0.0, 0.0), |sum, l| sum + self.mixed[l * m + i] * pulled[l])
        };
        let pulled = multiply(&self.elimination, &self.linear_free);
        let free: Vec<c64> = (0..m).map(|i| self.free[i] - back(&pulled, i)).collect();
        let mut coupling = self.coupling.clone();
        for j in 0..m {
            let column: Vec<c64> = (0..k).map(|l| self.mixed[l * m + j]).collect();
            let pulled = multiply(&self.elimination, &column);
            (0..m).for_each(|i| coupling[i * m + j] -= back(&pulled, i));
        }
        (self.free, self.coupling) = (free, coupling);
    }
}

/// What eliminates linear legs.
#[derive(Default)]
struct Elimination {
    /// `S = z (1 + G z)^-1`, k x k.
    stiffness: Vec<c64>,
    /// By how much its errors exceed rounding: the largest row sum of `|(1 + G z)^-1| (1 + |G| |z|)`.
    growth: f64,
}

fn eliminate(g: &[c64], z: &[c64]) -> Option<Elimination> {
    let k = z.len();
    let unit = |i: usize, j: usize| c64::new(if i == j { 1.0 } else { 0.0 }, 0.0);
    let system: Vec<c64> = (0..k * k).map(|n| unit(n / k, n % k) + g[n] * z[n % k]).collect();
    let inverse = invert(k, system)?;
    let terms = |i: usize| 1.0 + (0..k).map(|j| (g[i * k + j] * z[j]).norm_sqr().sqrt()).sum::<f64>();
    let growth = |i: usize| (0..k).map(|j| inverse[i * k + j].norm_sqr().sqrt() * terms(j)).sum::<f64>();
    let growth = (0..k).map(growth).fold(0.0, f64::max);
    Some(Elimination { stiffness: (0..k * k).map(|n| z[n / k] * inverse[n]).collect(), growth })
}

/// Whether the linear legs put the structure at resonance. Where they are all but rigid their forces cannot be unknowns:
/// their motion has no digits left.
fn at_resonance(g: &[c64], z: &[c64], elimination: Option<&Elimination>) -> bool {
    let k = z.len();
    let rigid = (0..k).any(|i| (g[i * k + i] * z[i]).norm() > RIGID);
    k > 0 && !rigid && elimination.is_none_or(|e| e.growth > AT_RESONANCE)
}

/// Square matrix, row by row, times a vector.
pub(crate) fn multiply(matrix: &[c64], x: &[c64]) -> Vec<c64> {
    let row = |row: &[c64]| row.iter().zip(x).fold(c64::new(0.0, 0.0), |s, (a, b)| s + *a * *b);
    matrix.chunks_exact(x.len().max(1)).map(row).collect()
}

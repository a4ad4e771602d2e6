//! What is known of a law apart from its force: words, parameters, symbol, character, limits. One constant a law, in its
//! own file; whoever wants to know something of a law asks here and names no law.

use super::limits::Limit;
use super::parameter::Parameter;
use super::range::Range;
use super::symbol::Mark;

/// Constant matrix of the equation of motion `M x'' + C x' + (K + i H) x = f` to which a law of constant coefficient adds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constant {
    /// `M`, kg.
    Mass,
    /// `C`, N s/m.
    Viscous,
    /// `K`, N/m.
    Stiffness,
    /// `H`, N/m: in quadrature with the displacement, without a force in time.
    Hysteretic,
}

/// Which part of the ratio of force to motion a law shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ForcePart {
    /// In phase with velocity: equivalent viscous coefficient `c_eq = Im (F_1 / D_1) / omega`.
    Damping,
    /// In phase with displacement: equivalent stiffness `k_eq = Re (F_1 / D_1)`.
    Stiffness,
}

/// Powers with which the equivalent coefficient of a law goes: `c_eq` or `k_eq` as `|D|^amplitude omega^frequency`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponents {
    /// Part of the force that has them.
    pub part: ForcePart,
    /// Power of the amplitude of the relative displacement.
    pub amplitude: f64,
    /// Power of the frequency.
    pub frequency: f64,
}

impl Exponents {
    /// Of a force in phase with velocity.
    pub const fn damping(amplitude: f64, frequency: f64) -> Option<Self> {
        Some(Self { part: ForcePart::Damping, amplitude, frequency })
    }

    /// Of a force in phase with displacement.
    pub const fn stiffness(amplitude: f64, frequency: f64) -> Option<Self> {
        Some(Self { part: ForcePart::Stiffness, amplitude, frequency })
    }
}

/// What is known of a law, whatever it acts on.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "independent answers to independent questions")]
pub struct Description {
    /// Its one name, as in the middle of a sentence: `viscous dashpot`.
    pub name: &'static str,
    /// The force as a short formula of plain characters for tables, such as `F_c sgn(d')`.
    pub formula: &'static str,
    /// What it is physically, in one sentence.
    pub sentence: &'static str,
    /// Parameters in the order in which the law takes them.
    pub parameters: &'static [Parameter],
    /// Parameters that share the factor to which the force is proportional, `F(s p) = s F(p)`; the first of them is 1 on
    /// the start grid.
    pub scaled: &'static [usize],
    /// Start grid of a fit: parameters of unit scale that shape the force, laid over the range of the motion.
    pub shapes: fn(&Range) -> Vec<Vec<f64>>,
    /// Whether the opposite motion is answered by the opposite force. A law that is not odd has a mean force and even
    /// harmonics.
    pub odd: bool,
    /// Whether one force may be answered by several motions, so that curves of the response fold.
    pub folds: bool,
    /// Whether the law can take out energy at all; a spring or a mass cannot, so the energy balance does not see it.
    pub dissipates: bool,
    /// The constant matrix it adds to, where its coefficient alone describes it.
    pub constant: Option<Constant>,
    /// Powers of amplitude and frequency at these parameters, where they are the same at every amplitude and frequency.
    pub exponents: fn(&[f64]) -> Option<Exponents>,
    /// Simpler laws that it becomes at the ends of its parameters, the plainest first where several hold.
    pub limits: &'static [Limit],
    /// Whether these parameters make it a simpler law by another name that is looked at anyway.
    pub disguised: fn(&[f64]) -> bool,
    /// Symbol in the schematic.
    pub symbol: &'static [Mark],
    /// Parameters at which its character shows on a structure of some kilograms and 1000 N/m under 1 N.
    pub example: &'static [f64],
    /// Whether it is among the few that are offered first.
    pub usual: bool,
}

impl Description {
    /// An odd law that takes out energy, is proportional to its first parameter and has no limits.
    pub const fn new(
        name: &'static str,
        formula: &'static str,
        sentence: &'static str,
        parameters: &'static [Parameter],
    ) -> Self {
        Self {
            name,
            formula,
            sentence,
            parameters,
            scaled: &[0],
            shapes: |_| Vec::new(),
            odd: true,
            folds: false,
            dissipates: true,
            constant: None,
            exponents: |_| None,
            limits: &[],
            disguised: |_| false,
            symbol: &[],
            example: &[],
            usual: false,
        }
    }
}

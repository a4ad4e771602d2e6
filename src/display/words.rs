//! Names for people of what has names in files.

use super::format;
use crate::balance::{Expansion, Weights};
use crate::effects::Source;
pub(crate) use crate::effects::wording::capital;
pub(crate) use crate::math::numerals::counted;
use crate::measurement::{Flag, Quantity, Run};
use crate::structure::StructureKind;
use crate::structure::beam::Supports;

/// The name of a parameter for readers: `Loss stiffness`; a single letter stays what it is.
pub fn parameter(name: &str) -> String {
    if name.len() == 1 { name.to_owned() } else { capital(&name.replace('_', " ")) }
}

/// A flag in words.
pub fn flag(flag: Flag) -> &'static str {
    match flag {
        Flag::NotSettled => "not settled",
        Flag::Noisy => "noisy",
        Flag::Clipped => "clipped",
        Flag::MissingSamples => "missing samples",
        Flag::DeadChannel => "dead channel",
        Flag::WrongFrequency => "wrong frequency",
        Flag::PhaseSensitive => "phase sensitive",
        Flag::NotPeriodic => "not periodic",
        Flag::OtherKind => "other kind of run",
        Flag::NoPreTrigger => "no pre-trigger",
        Flag::DoubleHit => "double hit",
        Flag::CutDecay => "decay cut off",
        Flag::OutOfBand => "beyond the band",
        Flag::TooShort => "too short",
        Flag::Drift => "drift",
        Flag::ExponentialWindow => "exponential window",
        Flag::UnevenSteps => "uneven steps",
        Flag::BeforeRelease => "begins before its release",
        Flag::Offset => "zero of a sensor",
    }
}

/// Noise over signal of a run; a dash where its amplitudes came without deviations, for then it is not known.
pub fn noise(run: &Run) -> String {
    if run.noise_ratio > 0.0 { format::percent(run.noise_ratio) } else { "–".to_owned() }
}

/// The name of an amplitude of a sine, or of something that is measured by one: all of them are peak values here.
pub fn peak(name: &str) -> String {
    format!("{name} (peak)")
}

/// A quantity with its SI unit, for an axis.
pub fn axis(quantity: Quantity, rotation: bool) -> &'static str {
    match (quantity, rotation) {
        (Quantity::Force, false) => "Force, N",
        (Quantity::Force, true) => "Moment, N·m",
        (Quantity::Acceleration, false) => "Acceleration, m/s²",
        (Quantity::Base, _) => "Acceleration of the base, m/s²",
        (Quantity::Acceleration, true) => "Angular acceleration, rad/s²",
        (Quantity::Velocity, false) => "Velocity, m/s",
        (Quantity::Velocity, true) => "Angular velocity, rad/s",
        (Quantity::Displacement, false) => "Displacement, m",
        (Quantity::Displacement, true) => "Rotation, rad",
    }
}

/// A way of expansion in words.
pub fn expansion(method: Expansion) -> &'static str {
    match method {
        Expansion::Auto => "automatic",
        Expansion::None => "none",
        Expansion::SingleMode => "nearest mode",
        Expansion::Modes => "mode shapes",
        Expansion::Dynamic => "dynamic model",
    }
}

/// Weights of the energy equation in words.
pub fn weights(weights: Weights) -> &'static str {
    match weights {
        Weights::Auto => "automatic",
        Weights::None => "none",
        Weights::Energy => "by energy",
        Weights::Noise => "by noise",
    }
}

/// How the ends of a beam are held, in words.
pub fn supports(supports: Supports) -> &'static str {
    match supports {
        Supports::ClampedFree => "clamped, free",
        Supports::FreeFree => "free, free",
        Supports::PinnedPinned => "pinned, pinned",
        Supports::ClampedClamped => "clamped, clamped",
        Supports::ClampedPinned => "clamped, pinned",
    }
}

/// A kind of structure in words.
pub fn kind(kind: StructureKind) -> &'static str {
    match kind {
        StructureKind::Beam => "Euler-Bernoulli beam",
        StructureKind::Chain => "chain of masses",
        StructureKind::Matrices => "imported matrices",
        StructureKind::Points => "points without a model",
        StructureKind::Component => "component in a testing machine",
    }
}

/// A coefficient with its deviation and unit.
pub fn coefficient(source: &Source, estimate: &crate::identify::Estimate) -> String {
    let parameter = source.effect.coefficient().map(|k| source.effect.parameters()[k]);
    format::with_deviation(estimate.coefficient, estimate.deviation, parameter.map_or("", |p| p.unit))
}

/// Coefficients of several sources to three digits, the unit once where all have the same: `0.300, 0.800 N·s/m`.
pub fn coefficients<'a>(all: impl Iterator<Item = (&'a Source, &'a crate::identify::Estimate)>) -> String {
    let parts: Vec<(String, String)> = all
        .map(|(source, estimate)| {
            let unit = source.effect.coefficient().map_or("", |k| source.effect.parameters()[k].unit);
            let (factor, unit) = super::units::shown(unit);
            (format::significant(factor * estimate.coefficient, 3), format::pretty_unit(&unit))
        })
        .collect();
    let same = parts.windows(2).all(|w| w[0].1 == w[1].1);
    let last = parts.len().saturating_sub(1);
    let said = |(k, (value, unit)): (usize, &(String, String))| {
        if same && k < last { value.clone() } else { format!("{value} {unit}").trim_end().to_owned() }
    };
    parts.iter().enumerate().map(said).collect::<Vec<_>>().join(", ")
}

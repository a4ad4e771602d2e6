//! Names for people of what has names in files.

use super::format;
use crate::balance::{Expansion, Weights};
use crate::effects::{Effect, Place, Source};
pub(crate) use crate::math::numerals::counted;
use crate::measurement::{Flag, Quantity, Run};
use crate::structure::beam::Supports;
use crate::structure::{Structure, StructureKind};

/// A law in words.
pub fn effect(effect: Effect) -> &'static str {
    effect.noun()
}

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

/// A place by the labels of its DOFs: `7 to ground`, `7–9`, `1–3–5`, `whole structure`, `acc@7`.
pub fn place(structure: &Structure, place: &Place) -> String {
    match place {
        Place::Dofs(dofs) if dofs.len() == 1 => format!("{} to ground", structure.label(dofs[0])),
        Place::Dofs(dofs) => dofs.iter().map(|&d| structure.label(d)).collect::<Vec<_>>().join("–"),
        Place::Whole(None) => "whole structure".to_owned(),
        Place::Whole(Some([first, last])) => format!("elements {}–{}", first + 1, last + 1),
        Place::Channel(channel) => channel.clone(),
    }
}

/// A place after the name of an effect: `at DOF 15`, `between DOF 3 and 5`, `of acc@7`.
pub fn at(structure: &Structure, place: &Place) -> String {
    let label = |d: &usize| structure.label(*d).to_owned();
    match place {
        Place::Dofs(dofs) => match &dofs[..] {
            [one] => format!("at DOF {}", label(one)),
            [a, b] => format!("between DOF {} and {}", label(a), label(b)),
            many => format!("along DOF {}", many.iter().map(label).collect::<Vec<_>>().join("–")),
        },
        Place::Whole(None) => "of the whole structure".to_owned(),
        Place::Whole(Some([first, last])) => format!("of elements {}–{}", first + 1, last + 1),
        Place::Channel(channel) => format!("of {channel}"),
    }
}

/// Law and place at the start of a sentence: `Dry friction at DOF 15`.
pub fn title(structure: &Structure, source: &Source) -> String {
    capital(&format!("{} {}", effect(source.effect), at(structure, &source.place)))
}

/// The same as [`place`], shorter: `7`, `7–9`.
pub fn short_place(structure: &Structure, at: &Place) -> String {
    match at {
        Place::Dofs(dofs) if dofs.len() == 1 => structure.label(dofs[0]).to_owned(),
        _ => place(structure, at),
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

/// With a capital letter at the start.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

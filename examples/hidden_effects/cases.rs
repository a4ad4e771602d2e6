//! The projects that can be made, by name: which class, structure and effect a seed stands for.

use super::files::Written;
use super::lab::{self, Plan};
use super::lab_records;
use super::random::Random;
use super::suite::{Kindness, hidden};
use super::unsteady::{self, Unsteady};
use dashpot::effects::{Effect, Kind};
use std::ops::Range;

/// Draws before a project is given up: some effects at some places cannot be made as large as wanted, or have no
/// periodic motion.
const DRAWS: usize = 12;

/// One project to be made.
pub(crate) struct Case {
    pub name: String,
    make: Recipe,
    random: Random,
}

enum Recipe {
    Exact(Vec<Effect>, Kindness),
    Laboratory(Plan),
    Unsteady(Unsteady),
    LaboratoryRecords(lab_records::Plan),
}

impl Case {
    /// The project, the first draw that works.
    pub(crate) fn make(&mut self) -> Option<Written> {
        let random = &mut self.random;
        (0..DRAWS).find_map(|_| match &self.make {
            Recipe::Exact(effects, kindness) => hidden(effects, *kindness, random).map(Written::from),
            Recipe::Laboratory(plan) => lab::project(*plan, random),
            Recipe::Unsteady(plan) => unsteady::project(*plan, random),
            Recipe::LaboratoryRecords(plan) => lab_records::project(*plan, random),
        })
    }
}

/// All projects of `seeds`: one of the laboratory and one of every other class, structure and effect a seed.
pub(crate) fn cases(seeds: Range<u64>) -> Vec<Case> {
    let mut cases = Vec::new();
    for seed in seeds {
        let mut random = Random::new(seed.wrapping_mul(0x00C0_FFEE).wrapping_add(0x1AB));
        let plan = Plan::of(seed, &mut random);
        cases.push(Case { name: plan.name(seed), make: Recipe::Laboratory(plan), random });
        for (c, class) in ["clean", "hard", "detuned", "two", "none", "points"].into_iter().enumerate() {
            for (k, &effect) in Effect::ALL.iter().enumerate() {
                for beam in [true, false] {
                    let number = seed * 10_000 + c as u64 * 1000 + k as u64 * 10 + u64::from(beam);
                    cases.extend(case(class, effect, beam, seed, Random::new(number)));
                }
            }
        }
        cases.push(structural(seed));
        cases.extend(unsteady(seed));
        cases.extend(laboratory_records(seed));
    }
    cases
}

/// A project of the laboratory whose damping is stated as structural and is viscous.
fn structural(seed: u64) -> Case {
    let mut random = Random::new(9_000_000_000 + seed);
    let plan = Plan { structural: true, ..Plan::of(seed, &mut random) };
    Case { name: plan.name(seed), make: Recipe::Laboratory(plan), random }
}

/// Every kind of test, law and structure, and each without a hidden effect.
fn unsteady(seed: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for (c, class) in unsteady::CLASSES.into_iter().enumerate() {
        for (k, effect) in unsteady::LAWS.into_iter().map(Some).chain([None]).enumerate() {
            for beam in [true, false] {
                let number = 7_000_000_000 + seed * 10_000 + c as u64 * 1000 + k as u64 * 10 + u64::from(beam);
                let structure = if beam { "beam" } else { "chain" };
                let name = format!("{class}-{structure}-{}-{seed}", effect.map_or("none", Effect::name));
                let make = Recipe::Unsteady(Unsteady { class, effect, beam });
                cases.push(Case { name, make, random: Random::new(number) });
            }
        }
    }
    cases
}

/// One laboratory project of every kind of test.
fn laboratory_records(seed: u64) -> impl Iterator<Item = Case> {
    (0..lab_records::CLASSES.len()).map(move |c| {
        let mut random = Random::new(8_000_000_000 + seed * 10 + c as u64);
        let plan = lab_records::Plan::of(seed, c, &mut random);
        Case { name: plan.name(seed), make: Recipe::LaboratoryRecords(plan), random }
    })
}

fn case(class: &str, effect: Effect, beam: bool, seed: u64, mut random: Random) -> Option<Case> {
    let relative = |e: Effect| matches!(e.kind(), Kind::Relative(_)) && e.dissipates();
    if class == "points" && (beam || !relative(effect)) {
        return None;
    }
    let r = &mut random;
    let clean = Kindness {
        beam,
        points: false,
        sensors: 3 + r.below(5),
        runs: 12 + r.below(13),
        levels: 2 + r.below(3),
        noise: r.within(0.002, 0.015),
        size: r.within(0.08, 0.4),
        detuned: 0.0,
        unsettled: r.uniform() < 0.15,
    };
    let kindness = match class {
        "hard" => {
            let (noise, size) = (r.within(0.02, 0.03), r.within(0.02, 0.06));
            Kindness { sensors: 3, runs: 8 + r.below(3), levels: 2, noise, size, ..clean }
        }
        "detuned" => Kindness { detuned: r.within(0.001, 0.02) * r.sign(), ..clean },
        "points" => Kindness { points: true, noise: r.within(0.002, 0.01), ..clean },
        "none" => Kindness { noise: r.within(0.002, 0.03), points: !beam && r.uniform() < 0.3, ..clean },
        _ => clean,
    };
    let effects = match class {
        "none" => vec![],
        "two" => vec![effect, Effect::ALL[r.below(Effect::ALL.len())]],
        _ => vec![effect],
    };
    let structure = if beam { "beam" } else { "chain" };
    let names: Vec<&str> = effects.iter().map(|e| e.name()).collect();
    let word = if names.is_empty() { effect.name().to_string() } else { names.join("+") };
    let name = format!("{class}-{structure}-{word}-{seed}");
    Some(Case { name, make: Recipe::Exact(effects, kindness), random })
}

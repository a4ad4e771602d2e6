//! Every export is read back by an independent reader and compared at full precision.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, missing_docs, reason = "tests")]

#[path = "../common/mod.rs"]
mod common;
mod formats;
mod mat5;

use common::models::cantilever;
use dashpot::effects::{Effect, Place, Source};
use dashpot::exchange::export::{Identified, IdentifiedMode, IdentifiedSource};
use dashpot::structure::Structure;
use faer::Mat;

/// A result with sources to the ground, between DOFs, over a chain, and of laws that are not viscous.
pub struct Sample {
    pub structure: Structure,
    pub sources: Vec<IdentifiedSource>,
    pub viscous: Mat<f64>,
    pub others: Vec<(Effect, Mat<f64>)>,
    pub energy: Vec<f64>,
    pub modes: Vec<IdentifiedMode>,
}

impl Sample {
    pub fn beam() -> Self {
        let structure = cantilever(3);
        let found = [
            (Effect::Viscous, vec![0], 1.0 / 3.0),
            (Effect::Viscous, vec![2, 4], 12_345.678_901_234_567),
            (Effect::Viscous, vec![0, 2, 4], 1e-7 / 7.0),
            (Effect::Coulomb, vec![4], 5.1),
            (Effect::Hysteretic, vec![2], 700.0),
        ];
        let sources: Vec<IdentifiedSource> = found
            .iter()
            .map(|(effect, dofs, value)| IdentifiedSource {
                source: Source::candidate(*effect, Place::Dofs(dofs.clone())).with_coefficient(*value),
                deviation: vec![value * 0.01],
                energy_percent: 20.0,
            })
            .collect();
        let matrix_of = |effect: Effect| {
            let mut sum = Mat::zeros(structure.len(), structure.len());
            for s in sources.iter().filter(|s| s.source.effect == effect) {
                for leg in s.source.place.legs() {
                    let c = s.source.coefficient();
                    sum[(leg.first, leg.first)] += c;
                    if let Some(j) = leg.second {
                        sum[(j, j)] += c;
                        sum[(leg.first, j)] -= c;
                        sum[(j, leg.first)] -= c;
                    }
                }
            }
            sum
        };
        let viscous = matrix_of(Effect::Viscous);
        let others =
            vec![(Effect::Coulomb, matrix_of(Effect::Coulomb)), (Effect::Hysteretic, matrix_of(Effect::Hysteretic))];
        let energy = (1..=structure.len()).map(|i| 100.0 / 21.0 * i as f64).collect();
        let modes = vec![IdentifiedMode { frequency_hz: 10.4, damping_ratio: 0.0141, deviation: 0.0003 }];
        Self { structure, sources, viscous, others, energy, modes }
    }

    pub fn identified(&self) -> Identified<'_> {
        Identified {
            title: "Beam, \"three\" elements",
            structure: &self.structure,
            sources: &self.sources,
            viscous: &self.viscous,
            others: &self.others,
            equivalent: &self.viscous,
            energy_percent: &self.energy,
            modes: &self.modes,
        }
    }
}

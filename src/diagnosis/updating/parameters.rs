//! Corrections of what the model states: its stiffness and mass, single modes or springs, the sizes of known sources.
//!
//! Models are never exact: natural frequencies are off by some per cent, known damping by tens. Each correction is the
//! logarithm `v` of a factor with a prior deviation, so that it moves only so far as the data ask for it:
//!
//! ```text
//! K' = e^v_K K + sum_r (e^v_r - 1) e^v_K omega_r^2 (M phi_r)(M phi_r)^T,    M' = e^v_M M,    p_j' = e^v_j p_j
//! ```

use crate::diagnosis::candidates::start_grids::scaled;
use crate::effects::{Effect, Place, Source};
use crate::response::sensitivity::Unknown;
use crate::structure::{Structure, StructureKind};

/// One correction.
#[derive(Debug, Clone, PartialEq)]
pub enum Knob {
    /// All stiffness (Young's modulus).
    Stiffness,
    /// All mass (density).
    Mass,
    /// Stiffness of one undamped mode.
    Mode(usize),
    /// Stiffness of one spring of a chain: its DOFs and its value in N/m.
    Spring(Vec<usize>, f64),
    /// Size of one known source.
    Known(usize),
}

impl Knob {
    /// Prior deviation of the logarithm of the factor.
    pub fn deviation(&self) -> f64 {
        match self {
            Self::Stiffness | Self::Mass | Self::Spring(..) => 0.03,
            Self::Mode(_) => 0.02,
            Self::Known(_) => 0.15,
        }
    }
}

/// Corrections with their values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tuning {
    /// What is corrected.
    pub knobs: Vec<Knob>,
    /// Logarithm of the factor of each.
    pub values: Vec<f64>,
}

impl Tuning {
    /// No correction yet, of all stiffness and mass and of every known source; with `each` also of the modes that the runs
    /// excite (for a chain, of its springs).
    pub fn free(structure: &Structure, known: &[Source], omegas: &[f64], each: bool) -> Self {
        let mut knobs = vec![Knob::Stiffness, Knob::Mass];
        if !each {
            // The few that most wrong models need.
        } else if structure.kind() == StructureKind::Chain {
            knobs.extend(springs(structure));
        } else {
            knobs.extend(modes_in_band(structure, omegas).into_iter().map(Knob::Mode));
        }
        knobs.extend((0..known.len()).map(Knob::Known));
        let values = vec![0.0; knobs.len()];
        Self { knobs, values }
    }

    /// Whether nothing may be corrected.
    pub fn is_empty(&self) -> bool {
        self.knobs.is_empty()
    }

    /// The same corrections with other values.
    #[must_use]
    pub fn with(&self, values: &[f64]) -> Self {
        Self { knobs: self.knobs.clone(), values: values.to_vec() }
    }

    /// Those of the corrections that are `wanted`.
    #[must_use]
    pub fn only(&self, wanted: impl Fn(&Knob) -> bool) -> Self {
        let kept = self.knobs.iter().zip(&self.values).filter(|(knob, _)| wanted(knob));
        let (knobs, values) = kept.map(|(knob, v)| (knob.clone(), *v)).unzip();
        Self { knobs, values }
    }

    /// All corrections of `all`, at these values where they are among these.
    #[must_use]
    pub fn within(&self, all: &Self) -> Self {
        let at = |(knob, v): (&Knob, &f64)| self.knobs.iter().position(|k| k == knob).map_or(*v, |k| self.values[k]);
        Self { knobs: all.knobs.clone(), values: all.knobs.iter().zip(&all.values).map(at).collect() }
    }

    fn factor(&self, knob: &Knob) -> f64 {
        let at = self.knobs.iter().position(|k| k == knob);
        at.map_or(1.0, |k| self.values[k].clamp(-2.0, 2.0).exp())
    }

    /// The corrected structure.
    pub fn structure(&self, structure: &Structure) -> Structure {
        let mut tuned = structure.clone();
        let (stiffness, mass) = (self.factor(&Knob::Stiffness), self.factor(&Knob::Mass));
        for element in &mut tuned.elements {
            element.stiffness *= faer::Scale(stiffness);
            element.mass *= faer::Scale(mass);
        }
        let Some(matrices) = &mut tuned.matrices else { return tuned };
        let own = matrices.mass.clone();
        matrices.stiffness *= faer::Scale(stiffness);
        matrices.mass *= faer::Scale(mass);
        let moved = |k: &Knob| matches!(k, Knob::Mode(_)) && self.factor(k) != 1.0;
        if self.knobs.iter().any(moved)
            && let Ok(modes) = structure.modes()
        {
            for knob in &self.knobs {
                if let Knob::Mode(r) = knob {
                    let shape = modes.shapes.col_as_slice(*r);
                    let row = |i: usize| own.col_as_slice(i).iter().zip(shape).map(|(m, x)| m * x).sum::<f64>();
                    let weighted: Vec<f64> = (0..own.ncols()).map(row).collect();
                    let size = (self.factor(knob) - 1.0) * stiffness * modes.omega[*r].powi(2);
                    for j in 0..own.ncols() {
                        for i in 0..own.nrows() {
                            matrices.stiffness[(i, j)] += size * weighted[i] * weighted[j];
                        }
                    }
                }
            }
        }
        tuned
    }

    /// The corrected known sources, those of corrected springs last.
    pub fn known(&self, known: &[Source]) -> Vec<Source> {
        let mut tuned = known.to_vec();
        for knob in &self.knobs {
            match knob {
                Knob::Known(j) => {
                    let source = &mut tuned[*j];
                    scaled(source.effect).iter().for_each(|&k| source.parameters[k] *= self.factor(knob));
                }
                Knob::Spring(dofs, k) => {
                    let change = k * (self.factor(knob) - 1.0);
                    tuned.push(Source::known(Effect::Stiffness, Place::Dofs(dofs.clone()), &[change]));
                }
                Knob::Stiffness | Knob::Mass | Knob::Mode(_) => {}
            }
        }
        tuned
    }

    /// What the response is differentiated by for correction `k`, each with its factor; `known` are the corrected sources.
    pub fn unknowns(&self, k: usize, known: &[Source]) -> Vec<(Unknown, f64)> {
        let springs = self.knobs.iter().filter(|k| matches!(k, Knob::Spring(..))).count();
        let knob = &self.knobs[k];
        match knob {
            Knob::Stiffness => vec![(Unknown::Stiffness, 1.0)],
            Knob::Mass => vec![(Unknown::Mass, 1.0)],
            Knob::Mode(r) => vec![(Unknown::ModeStiffness(*r), 1.0)],
            Knob::Spring(_, stiffness) => {
                let before = self.knobs[..k].iter().filter(|k| matches!(k, Knob::Spring(..))).count();
                let source = known.len() - springs + before;
                vec![(Unknown::Source { source, parameter: 0 }, stiffness * self.factor(knob))]
            }
            Knob::Known(j) => {
                let of =
                    |&parameter: &usize| (Unknown::Source { source: *j, parameter }, known[*j].parameters[parameter]);
                scaled(known[*j].effect).iter().map(of).collect()
            }
        }
    }
}

/// Modes whose frequencies the runs come near to.
fn modes_in_band(structure: &Structure, omegas: &[f64]) -> Vec<usize> {
    let Ok(modes) = structure.modes() else { return Vec::new() };
    let near = |w: f64| omegas.iter().any(|&o| w > 0.0 && (o / w).ln().abs() < 0.35);
    (0..modes.len()).filter(|&r| near(modes.omega[r])).take(8).collect()
}

/// Springs to the ground and between neighbours, as the stiffness matrix of a chain shows them.
fn springs(structure: &Structure) -> Vec<Knob> {
    let Some(matrices) = structure.matrices() else { return Vec::new() };
    let (k, n) = (&matrices.stiffness, structure.len());
    let mut found = Vec::new();
    for i in 0..n {
        let ground: f64 = (0..n).map(|j| k[(i, j)]).sum();
        if ground > 1e-9 * k[(i, i)] {
            found.push(Knob::Spring(vec![i], ground));
        }
        if i + 1 < n && k[(i, i + 1)] != 0.0 {
            found.push(Knob::Spring(vec![i, i + 1], -k[(i, i + 1)]));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::beam::{BeamParameters, Supports};
    use crate::structure::chain::ChainParameters;

    fn beam() -> Structure {
        let (length, breadth, depth) = (0.5, 0.04, 0.004);
        let (youngs_modulus, density, elements) = (7e10, 2700.0, 5);
        let supports = Supports::ClampedFree;
        BeamParameters { length, breadth, depth, youngs_modulus, density, elements, supports }.build(&[]).unwrap()
    }

    #[test]
    fn frequencies_move_as_the_factors_say() {
        let structure = beam();
        let knobs = vec![Knob::Stiffness, Knob::Mass, Knob::Mode(1)];
        let tuned = Tuning { knobs, values: vec![0.02, -0.01, 0.04] }.structure(&structure);
        let (before, after) = (structure.modes().unwrap().omega, tuned.modes().unwrap().omega);
        for r in 0..4 {
            let expected = 0.5 * (0.02 + 0.01 + if r == 1 { 0.04 } else { 0.0 });
            assert!(((after[r] / before[r]).ln() - expected).abs() < 1e-9, "mode {r}");
        }
    }

    #[test]
    fn corrections_left_out_come_back_as_they_were() {
        let all = Tuning { knobs: vec![Knob::Stiffness, Knob::Known(0), Knob::Mass], values: vec![0.1, 0.2, 0.3] };
        let some = all.only(|knob| !matches!(knob, Knob::Known(_)));
        assert_eq!(some.values, [0.1, 0.3]);
        assert_eq!(some.with(&[1.0, 3.0]).within(&all), all.with(&[1.0, 0.2, 3.0]));
    }

    #[test]
    fn springs_of_a_chain_are_those_it_was_built_from() {
        let chain = ChainParameters {
            masses: vec![1.0, 2.0, 3.0],
            ground_stiffness: vec![5.0, 0.0, 7.0],
            coupling_stiffness: vec![11.0, 13.0],
        };
        let found = springs(&chain.build(&[]).unwrap());
        let expected = [(vec![0], 5.0), (vec![0, 1], 11.0), (vec![1, 2], 13.0), (vec![2], 7.0)];
        assert_eq!(found.len(), expected.len());
        for (knob, (dofs, stiffness)) in found.iter().zip(&expected) {
            let Knob::Spring(at, k) = knob else { panic!() };
            assert!(at == dofs && (k - stiffness).abs() < 1e-12);
        }
    }
}

//! Energy share of each DOF (figure 6.13): the dissipation `v_i g_i` of DOF i over all runs, in per cent of all.
//!
//! A relative source's energy is shared by its two DOFs in proportion to `|v_i F_i|` over the period: a damper at a node that
//! hardly moves dissipates at the other end. Over the whole structure `v_i (B v)_i`, whose negative parts are shared out
//! likewise by their size.

use crate::balance::action::{self, Field};
use crate::balance::{Expanded, Measured};
use crate::effects::{Kind, Leg, Place, Source};
use crate::structure::Structure;

/// Per cent at each DOF; adds up to 100 unless nothing is dissipated.
pub(crate) fn by_dof(structure: &Structure, runs: &[(Measured, Expanded)], acting: &[Source]) -> Vec<f64> {
    let mut sum = vec![0.0; structure.len()];
    for (measured, expanded) in runs {
        let field = expanded.field(measured);
        for source in acting.iter().filter(|s| s.effect.dissipates()) {
            add(source, structure, field, &mut sum);
        }
    }
    let total: f64 = sum.iter().sum();
    if total > 0.0 {
        for value in &mut sum {
            *value *= 100.0 / total;
        }
    }
    sum
}

fn add(source: &Source, structure: &Structure, field: Field<'_>, sum: &mut [f64]) {
    match source.effect.kind() {
        Kind::Relative(_) => {
            for leg in source.place.legs() {
                let energy = action::energy(&on_leg(source, leg), structure, field);
                for (dof, part) in parts(leg, field) {
                    sum[dof] += energy * part;
                }
            }
        }
        Kind::Whole(_) => {
            let energy = action::energy(source, structure, field);
            let sizes: Vec<(usize, f64)> = action::force(source, structure, field)
                .into_iter()
                .map(|(dof, f)| (dof, field.work(dof, &f).abs()))
                .collect();
            let all: f64 = sizes.iter().map(|(_, s)| s).sum();
            for (dof, size) in sizes.into_iter().filter(|_| all > 0.0) {
                sum[dof] += energy * size / all;
            }
        }
        Kind::Channel(_) => {}
    }
}

/// The same law on one leg of a chain.
fn on_leg(source: &Source, leg: Leg) -> Source {
    let dofs = std::iter::once(leg.first).chain(leg.second).collect();
    Source { place: Place::Dofs(dofs), ..source.clone() }
}

/// Both ends feel the same force, so `|v_i F_i|` is as `|v_i|`: the root mean square velocity.
fn parts(leg: Leg, field: Field<'_>) -> Vec<(usize, f64)> {
    let Some(second) = leg.second else { return vec![(leg.first, 1.0)] };
    let speed = |dof: usize| {
        let square = |k: usize| (field.numbers[k] as f64).powi(2) * field.x[(dof, k)].norm_sqr();
        (0..field.numbers.len()).map(square).sum::<f64>().sqrt()
    };
    let (a, b) = (speed(leg.first), speed(second));
    if a + b > 0.0 {
        vec![(leg.first, a / (a + b)), (second, b / (a + b))]
    } else {
        vec![(leg.first, 0.5), (second, 0.5)]
    }
}

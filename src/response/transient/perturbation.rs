//! Forces of a law along a given motion, and what given forces do to a linear model: what a law would change, to first order.

use super::assembly::is_linear;
use super::element::{Element, Form};
use super::hold::{Hold, Polynomial};
use super::model::TransientModel;
use super::step::Step;
use crate::effects::{Constant, Source};
use dashpot_numerics::dot;

/// Force of a source, N, along a relative motion: displacement (m), velocity (m/s) and acceleration (m/s^2) at equal steps of
/// `step` s; a law with memory comes from rest to where the motion begins. `None` where the law has no force in time.
pub fn force_along(source: &Source, [d, v, a]: [&[f64]; 3], step: f64) -> Option<Vec<f64>> {
    let (law, parameters) = (source.effect.law()?, &source.parameters);
    if source.effect.constant() == Some(Constant::Mass) {
        return Some(a.iter().map(|a| parameters[0] * a).collect());
    }
    if is_linear(source.effect) {
        let z = law.dynamic_stiffness(parameters, 1.0)?;
        return Some(d.iter().zip(v).map(|(d, v)| z.re * d + z.im * v).collect());
    }
    let form = Form::of(law)?;
    let mut element = Element::new(0, form, law, parameters, 0);
    let mut forces = Vec::with_capacity(d.len());
    for (n, (d, v)) in d.iter().zip(v).enumerate() {
        element.commit(*d, if n == 0 { f64::INFINITY } else { step }, &[], &[]);
        let side = if *v < 0.0 { -1.0 } else { 1.0 };
        forces.push(element.instant(*d, *v, side, 0.0)[0]);
    }
    Some(forces)
}

impl TransientModel {
    /// What the channels show of `forces` (N, one list a drive, at equal steps of `step` s, held between them) that find the linear part
    /// of the model at rest, `[channel][sample]`, of every `every`-th sample from the first on.
    pub fn forced(&self, forces: &[Vec<f64>], hold: Hold, step: f64, every: usize) -> Vec<Vec<f64>> {
        let samples = forces.first().map_or(0, Vec::len);
        let first: Vec<[f64; 2]> = forces.iter().map(|list| [list.first().copied().unwrap_or(0.0), 0.0]).collect();
        let mut z = self.modes_of(&vec![0.0; 2 * self.kept()], &first);
        let stepped = Step::new(&self.system, step, step);
        let held: Vec<Vec<Polynomial>> = forces.iter().map(|force| hold.polynomials(force)).collect();
        let mut channels = vec![Vec::with_capacity(samples.div_ceil(every)); self.sensors.len()];
        // Drives stand behind the elements of the model, which are left at rest.
        let behind = self.legs.len();
        for n in 0..samples {
            if n > 0 {
                stepped.decay(&mut z);
                held.iter().enumerate().for_each(|(k, list)| stepped.drive(behind + k, &list[n - 1], &mut z));
            }
            if n % every != 0 {
                continue;
            }
            for (sensor, list) in self.sensors.iter().zip(&mut channels) {
                let direct: f64 =
                    sensor.functional.inputs.iter().skip(behind).zip(forces).map(|(c, list)| c * list[n]).sum();
                list.push(dot(&sensor.functional.row, &z) + direct);
            }
        }
        channels
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models;
    use crate::effects::{Effect, Place, State};
    use crate::measurement::{Channel, Quantity};
    use crate::response::transient::{SampledForces, TransientSetup};
    use crate::structure::Structure;

    const STEP: f64 = 2e-3;
    const SAMPLES: usize = 1500;

    fn chain() -> Structure {
        models::chain(&[2.0, 1.0, 1.5], &[800.0, 0.0, 0.0], &[1500.0, 900.0])
    }

    fn predicted(structure: &Structure, sources: &[Source], quantities: &[Quantity]) -> Vec<Vec<f64>> {
        let modes = structure.modes().unwrap();
        let channel = |q: &Quantity, dof: usize| Channel { quantity: *q, dof, label: String::new() };
        let channels: Vec<Channel> =
            quantities.iter().flat_map(|q| (0..3).map(move |dof| (q, dof))).map(|(q, dof)| channel(q, dof)).collect();
        let model = TransientModel::new(&TransientSetup::stated(structure, &modes, sources, &channels, STEP)).unwrap();
        let forces = SampledForces {
            step: STEP,
            samples: SAMPLES,
            forces: Vec::new(),
            substeps: 1,
            every: 1,
            step_lengths: Vec::new(),
        };
        model.predict(&forces, &[0.02, -0.01, 0.005, 0.0, 0.0, 0.0], &[]).unwrap().channels
    }

    /// A little of a law, stepped with the model, changes the record as its force along the motion without it does.
    #[test]
    fn a_small_force_changes_the_record_as_the_force_along_its_motion() {
        let structure = chain();
        let known =
            Source { effect: Effect::Viscous, place: Place::Dofs(vec![0]), state: State::Known, parameters: vec![1.0] };
        let laws: [(Effect, Vec<f64>); 6] = [
            (Effect::Viscous, vec![1e-4]),
            (Effect::Mass, vec![1e-5]),
            (Effect::Quadratic, vec![1e-4]),
            (Effect::CubicStiffness, vec![1e-1]),
            (Effect::Maxwell, vec![1e-2, 1e-3]),
            (Effect::ElasticSlider, vec![1e-4, 2e-2]),
        ];
        let quantities = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
        let before = predicted(&structure, std::slice::from_ref(&known), &quantities);
        for (effect, parameters) in laws {
            let source = Source { effect, place: Place::Dofs(vec![1]), state: State::Known, parameters };
            let with = predicted(&structure, &[known.clone(), source.clone()], &quantities);
            let motion = [&before[1][..], &before[4], &before[7]];
            let force: Vec<f64> = force_along(&source, motion, STEP).unwrap().iter().map(|f| -f).collect();
            let modes = structure.modes().unwrap();
            let channels: Vec<Channel> =
                (0..3).map(|dof| Channel { quantity: Quantity::Displacement, dof, label: String::new() }).collect();
            let sources = [known.clone()];
            let setup = TransientSetup::stated(&structure, &modes, &sources, &channels, STEP);
            let model = TransientModel::new(&TransientSetup { drives: &[1], ..setup }).unwrap();
            let change = model.forced(&[force], Hold::FirstOrder, STEP, 1);
            for c in 0..3 {
                let expected: Vec<f64> = with[c].iter().zip(&before[c]).map(|(w, b)| w - b).collect();
                let size = expected.iter().map(|x| x * x).sum::<f64>().sqrt();
                let off = expected.iter().zip(&change[c]).map(|(e, f)| (e - f).powi(2)).sum::<f64>().sqrt();
                assert!(off < 0.03 * size, "{effect:?} channel {c}: {:.3}", off / size);
            }
        }
    }
}

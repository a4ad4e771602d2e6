//! Where an effect may act, and the response of every channel to a unit force or error there.

use crate::control::Control;
use crate::diagnosis::residual::data::{ChannelData, Data, DiagnosisError, RunData};
use crate::diagnosis::residual::prediction::{FINAL, Predictor};
use crate::effects::{Leg, Place, Source};
use crate::response::harmonic_balance::{Excitation, HarmonicForce};
use crate::response::sensitivity::{Unknown, pseudo_force};
use crate::structure::Structure;
use faer::{Mat, c64};
use std::collections::BTreeMap;

/// A place at which one complex amplitude a harmonic, free in every run, may be added.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Spot {
    /// A force on a relative motion.
    Leg(Leg),
    /// An error of a response channel.
    Response(String),
    /// An error of a force channel.
    Force(String),
}

/// Whether a place is the rotation of a node that moves too. Along a structure a force and a moment of one node move the measured modes
/// alike, and what holds a node to the ground by its rotation alone is a support.
pub(crate) fn turns_a_moving_node(structure: &Structure, place: &Place) -> bool {
    let Place::Dofs(rows) = place else { return false };
    let [row] = rows[..] else { return false };
    let (dofs, turned) = (structure.dofs(), &structure.dofs()[row]);
    let moves = dofs.iter().any(|dof| dof.node == turned.node && !dof.direction.is_rotation());
    turned.direction.is_rotation() && moves
}

impl Spot {
    /// The place of an effect there.
    pub(crate) fn place(&self) -> Place {
        match self {
            Self::Leg(leg) => Place::Dofs(std::iter::once(leg.first).chain(leg.second).collect()),
            Self::Response(name) | Self::Force(name) => Place::Channel(name.clone()),
        }
    }

    /// Every DOF in space to the ground, every pair of neighbours, every channel.
    pub(crate) fn all(structure: &Structure, data: &Data) -> Vec<Self> {
        let [responses, forces] = data.channel_names();
        let mut spots = Self::on(structure);
        spots.extend(responses.into_iter().map(Self::Response));
        spots.extend(forces.into_iter().map(Self::Force));
        spots
    }

    /// Those on the structure.
    fn on(structure: &Structure) -> Vec<Self> {
        let ground = structure.in_space().into_iter().map(|first| Self::Leg(Leg { first, second: None }));
        let pair = |[first, second]: [usize; 2]| Self::Leg(Leg { first, second: Some(second) });
        ground.chain(structure.neighbours().into_iter().map(pair)).collect()
    }
}

/// Columns of the receptance of the linear model, computed when first needed.
pub(crate) struct Receptances<'a> {
    predictor: &'a Predictor,
    data: &'a Data,
    linear: Vec<Source>,
    /// By DOF: one n x H matrix a run.
    columns: BTreeMap<usize, Vec<Mat<c64>>>,
}

impl<'a> Receptances<'a> {
    /// For the known linear sources and the linear ones among `effects`.
    pub(crate) fn new(predictor: &'a Predictor, data: &'a Data, effects: &[Source]) -> Self {
        let mut linear = predictor.sources(effects);
        linear.retain(|s| s.effect.is_linear());
        Self { predictor, data, linear, columns: BTreeMap::new() }
    }

    /// Computes the column of `dof` in every run, if it is not there yet.
    pub(crate) fn need(&mut self, dof: usize, control: &Control) -> Result<(), DiagnosisError> {
        if self.columns.contains_key(&dof) {
            return Ok(());
        }
        let mut column = Vec::with_capacity(self.data.runs.len());
        for (r, run) in self.data.runs.iter().enumerate() {
            let harmonics = vec![c64::new(1.0, 0.0); run.harmonics];
            let forces = vec![HarmonicForce { dof, mean: 0.0, harmonics }];
            let excitation = Excitation { omega: run.omega, forces };
            let unit = self.predictor.run(r).respond(&self.linear, &excitation, &FINAL, None, control);
            let file = format!("number {}", run.index + 1);
            column.push(unit.map_err(|reason| DiagnosisError::of_response(file, reason))?.harmonics);
        }
        self.columns.insert(dof, column);
        Ok(())
    }

    /// Columns of the DOFs of a leg.
    pub(crate) fn need_leg(&mut self, leg: Leg, control: &Control) -> Result<(), DiagnosisError> {
        self.need(leg.first, control)?;
        leg.second.map_or(Ok(()), |second| self.need(second, control))
    }

    /// Displacement (m) of `row` under a unit force (N) on `dof`, whose column was needed before; by reciprocity also
    /// the other way round.
    pub(crate) fn entry(&self, r: usize, h: usize, row: usize, dof: usize) -> c64 {
        self.columns.get(&dof).map_or(c64::new(0.0, 0.0), |column| column[r][(row, h - 1)])
    }

    /// Impedance of the structure between the DOFs of `leg` in run `r`, whose columns were needed before: force over
    /// velocity, N s/m, the geometric mean over the harmonics.
    pub(crate) fn impedance(&self, r: usize, run: &RunData, leg: Leg) -> f64 {
        let mobility = |h: usize| {
            let own = leg.relative(|i| leg.relative(|j| self.entry(r, h, i, j)));
            (h as f64 * run.omega * own.norm()).ln()
        };
        let logs: Vec<f64> = (1..=run.harmonics).map(mobility).filter(|x| x.is_finite()).collect();
        if logs.is_empty() { 0.0 } else { (-logs.iter().sum::<f64>() / logs.len() as f64).exp() }
    }

    /// Relative change of the responses of run `r` at harmonic `h` to a force at `leg` for a relative change of all stiffness by 1: how
    /// much the response there depends on frequencies of modes that are known no better than the model.
    pub(crate) fn sensitivity_to_stiffness(&self, r: usize, run: &RunData, h: usize, leg: Leg) -> f64 {
        let omega = h as f64 * run.omega;
        let n = self.predictor.structure().len();
        let field: Vec<c64> = (0..n).map(|i| leg.relative(|j| self.entry(r, h, i, j))).collect();
        let force = pseudo_force(self.predictor.run(r), &[], Unknown::Stiffness, &field, omega).unwrap_or_default();
        let (mut moved, mut size) = (0.0, 0.0);
        for &c in &run.alive {
            let channel = &run.responses[c];
            let by: c64 = force.iter().enumerate().map(|(i, f)| *f * self.entry(r, h, i, channel.dof)).sum();
            let weight = (channel.from_displacement(omega).norm() / run.scale(c)).powi(2);
            moved += by.norm_sqr() * weight;
            size += field[channel.dof].norm_sqr() * weight;
        }
        if size > 0.0 { (moved / size).sqrt() } else { 0.0 }
    }

    /// Recorded amplitude of `channel` for a unit force on the structure at `leg` (its law feels `-1`).
    pub(crate) fn channel(&self, r: usize, run: &RunData, h: usize, channel: &ChannelData, leg: Leg) -> c64 {
        let displacement = leg.relative(|i| self.entry(r, h, i, channel.dof));
        displacement * channel.from_displacement(h as f64 * run.omega)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::Direction;
    use crate::structure::beam::{BeamParameters, Supports};
    use crate::structure::imported::{ImportedDof, ImportedParameters};

    /// The rotations of the ends of a pinned beam are those of supports, those between them are not.
    #[test]
    fn moments_act_at_supports() {
        let beam = BeamParameters {
            length: 1.0,
            breadth: 0.04,
            depth: 0.004,
            youngs_modulus: 69e9,
            density: 2700.0,
            elements: 3,
            supports: Supports::PinnedPinned,
        };
        let structure = beam.build(&[]).unwrap();
        let turns = |dofs: &[usize]| turns_a_moving_node(&structure, &Place::Dofs(dofs.to_vec()));
        let turning: Vec<usize> = (0..structure.len()).filter(|&dof| turns(&[dof])).collect();
        assert_eq!(turning, [2, 4]);
        assert!(!turns(&[1, 3]));
    }

    /// The amplitude of a fixed-interface mode of a reduced model is no place.
    #[test]
    fn nothing_acts_at_generalised_coordinates() {
        let dof =
            |label: &str, node: &str, direction| ImportedDof { label: label.into(), node: node.into(), direction };
        let parameters = ImportedParameters {
            mass: Mat::identity(3, 3),
            stiffness: Mat::from_fn(3, 3, |i, j| if i == j { 2.0 } else { -0.5 }),
            nodes: None,
            dofs: Some(vec![
                dof("1z", "1", Direction::Z),
                dof("mode1", "interior", Direction::Q),
                dof("2z", "2", Direction::Z),
            ]),
            lines: Vec::new(),
        };
        let structure = parameters.build(&[]).unwrap();
        let leg = |first, second| Spot::Leg(Leg { first, second });
        assert_eq!(Spot::on(&structure), [leg(0, None), leg(2, None), leg(0, Some(2))]);
    }
}

//! Loads of a moving base: `M x'' + K x = -M r a`, `x` relative to the base, `r` its motion carried rigidly (1 at the
//! translations along it, 0 elsewhere), `a` its acceleration.
//!
//! With consistent masses the columns of the held degrees of freedom load the free ones too; a beam knows its elements and
//! adds them. Imported matrices are taken as they are.

use super::system::{Structure, StructureKind};

impl Structure {
    /// Degrees of freedom that a base moving along axis 0, 1 or 2 (x, y, z) carries with it: the translations along it. The masses of a
    /// chain move in one direction that nobody states: whatever a base is said to move along, it carries them.
    pub fn carried_by_base(&self, axis: usize) -> Vec<usize> {
        let along = |i: &usize| self.dofs[*i].direction.axis() == Some(axis) || self.kind == StructureKind::Chain;
        (0..self.len()).filter(along).collect()
    }

    /// `M r` for a base that moves along axis 0, 1 or 2 (x, y, z): one value a degree of freedom, kg (kg m at rotations);
    /// `None` without a mass matrix.
    pub fn base_load(&self, axis: usize) -> Option<Vec<f64>> {
        if let Some(reduction) = &self.origin.reduction {
            return reduction.base_loads.get(axis).cloned();
        }
        let mass = &self.matrices.as_ref()?.mass;
        let along = self.carried_by_base(axis);
        let mut load: Vec<f64> = (0..self.len()).map(|i| along.iter().map(|&j| mass[(i, j)]).sum()).collect();
        // Elements are of beams, whose local translations are the first and the third of four DOFs, all along one axis.
        for element in self.elements.iter().filter(|_| !along.is_empty()) {
            for held in (0..element.dofs.len()).step_by(2).filter(|&j| element.dofs[j].is_none()) {
                for (i, row) in element.dofs.iter().enumerate() {
                    if let Some(row) = row {
                        load[*row] += element.mass[(i, held)];
                    }
                }
            }
        }
        Some(load)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::common::models::{cantilever_parameters, chain};
    use crate::structure::LumpedMass;

    /// A wall that shakes "along z" shakes the masses of a chain as one "along x" does.
    #[test]
    fn a_base_carries_a_chain_whatever_its_direction_is_called() {
        let chain = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        assert!((0..3).all(|axis| chain.base_load(axis).unwrap() == [2.0, 1.0]));
        let beam = cantilever_parameters(4).build(&[]).unwrap();
        assert_eq!(beam.carried_by_base(2), [0, 2, 4, 6]);
        assert!(beam.carried_by_base(0).is_empty());
    }

    /// The first modal participation mass of a cantilever is 61.3 % of its mass (Blevins, table 8-1: (2 * 0.7340955 / 1.8751)^2).
    #[test]
    fn participation_of_a_cantilever() {
        let p = cantilever_parameters(20);
        let beam = p.build(&[]).unwrap();
        let load = beam.base_load(2).unwrap();
        let modes = beam.modes().unwrap();
        let factor: f64 = (0..beam.len()).map(|i| modes.shapes[(i, 0)] * load[i]).sum();
        let mass = p.density * p.length * p.breadth * p.depth;
        assert!((factor * factor / mass - (2.0 * 0.734_095_5 / 1.875_104_07_f64).powi(2)).abs() < 1e-5);
        assert!(beam.base_load(0).unwrap().iter().all(|&v| v == 0.0));
        let heavy = p.build(&[LumpedMass { dof: "39".into(), mass: 0.3 }]).unwrap().base_load(2).unwrap();
        assert!((heavy[38] - load[38] - 0.3).abs() < 1e-12);
    }
}

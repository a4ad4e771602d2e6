//! Records on a moving base whose structure gets other masses: its load `-M r a` is that of these masses.

use super::data::RecordData;
use crate::structure::Structure;

impl RecordData {
    /// Whether forces were measured: those of a moving base are known as acceleration, and grow with the masses.
    pub(super) fn shows_mass(&self) -> bool {
        !self.forces.is_empty() && !self.run.on_moving_base
    }

    /// The record with the load of its base on another structure of the same DOFs, as it is where no base moves.
    pub(super) fn with_base_load(mut self, old: &Structure, new: &Structure) -> Self {
        if !self.run.on_moving_base {
            return self;
        }
        for (dof, force) in self.drives.iter().zip(&mut self.forces) {
            let load = |structure: &Structure, axis: usize| structure.base_load(axis).map_or(0.0, |load| load[*dof]);
            let loaded = (0..3).map(|axis| [old, new].map(|s| load(s, axis))).find(|[old, _]| *old != 0.0);
            if let Some([old, new]) = loaded {
                force.iter_mut().for_each(|f| *f *= new / old);
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::diagnosis::records::data::Records;

    /// Twice the mass of a floor takes twice the force of the base; measured forces stay.
    #[test]
    fn a_heavier_floor_takes_more_of_the_base() {
        let [light, heavy] = [1.0, 2.0].map(|m| chain(&[2.0, m], &[800.0, 0.0], &[1500.0]));
        let wave = |n: usize| (0.1 * n as f64).sin();
        let run = decay(1e-2, vec![(0..400).map(wave).collect(), (0..400).map(wave).collect()]);
        let mut records = Records::new(&light, &[], std::slice::from_ref(&run)).unwrap();
        (records.list[0].drives, records.list[0].forces) = (vec![0, 1], vec![vec![2.0; 400], vec![1.0; 400]]);
        let forces = |records: &Records| records.on(&heavy).unwrap().list[0].forces.concat();
        assert_eq!(forces(&records), records.list[0].forces.concat());
        records.list[0].run.on_moving_base = true;
        assert_eq!(forces(&records), [vec![2.0; 400], vec![2.0; 400]].concat());
    }
}

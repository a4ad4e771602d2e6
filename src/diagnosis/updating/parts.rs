//! Parts of a structure whose stiffness and mass a model may state wrongly.

use crate::diagnosis::residual::data::{Data, RunData};
use crate::effects::{Place, Source};
use crate::structure::{Part, Structure, StructureKind};
use std::collections::BTreeSet;

/// Groups of elements of a beam whose stiffness and mass are updated each on its own.
const ELEMENT_GROUPS: usize = 12;
/// Springs and masses of imported matrices that are updated one by one; above, modes are.
const MOST_SPRINGS: usize = 40;
/// Modes in the band that are updated where neither elements nor springs are known.
const MOST_MODES: usize = 8;
/// Most couplings of modes that are updated: with half as many, errors of the elements of larger models were told as masses.
const MOST_COUPLINGS: usize = 36;
/// What a coupling adds to a mode at the sensors, beside what the most important one adds, below which it is left out.
const LITTLE_COUPLING: f64 = 0.02;
/// Logarithm of a frequency ratio within which a mode counts as in the band of a run.
const NEAR_BAND: f64 = 0.35;
/// Deviations that a harmonic must stand out by to tell the damping of a mode, which is known to a tenth.
const CLEAR: f64 = 10.0;

/// Parts of a structure that are wrong independently of each other, as far as its kind shows them.
pub(crate) fn parts(structure: &Structure, omegas: &[f64]) -> Vec<Part> {
    let mut parts = vec![Part::Stiffness, Part::Mass];
    let chain = structure.elements().is_empty() && structure.kind() == StructureKind::Chain;
    parts.extend(structure.lumped().iter().filter(|_| !chain).map(|&row| Part::PointMass(row)));
    let count = structure.elements().len();
    if count > 0 {
        let groups = ELEMENT_GROUPS.min(count);
        let range = |g: usize| [g * count / groups, (g + 1) * count / groups - 1];
        parts.extend((0..groups).map(|g| Part::ElementStiffness(range(g))));
        parts.extend((0..groups).map(|g| Part::ElementMass(range(g))));
        parts.extend(structure.supports().into_iter().map(Part::Support));
        return parts;
    }
    let springs = structure.springs(MOST_SPRINGS);
    if springs.is_empty() || (structure.kind() != StructureKind::Chain && structure.len() > MOST_SPRINGS) {
        parts.extend(modes_in_band(structure, omegas).into_iter().map(Part::Mode));
        // Mass is where it is, however stiffness is spread: a wrong mass at a node shows in the shapes of all modes as no error at the
        // sensors does.
        if structure.len() <= MOST_SPRINGS {
            parts.extend(structure.translations().into_iter().map(Part::PointMass));
        }
    } else {
        parts.extend(springs);
        parts.extend((0..structure.len()).map(Part::PointMass));
    }
    parts
}

/// Modes whose damping by laws of the whole structure is known no better than those laws: no structure damps its modes in just
/// the proportion that they state. One mode alone is damped by their size. Nor is it known whether damping that is stated as
/// structural is viscous: it shows where a stiffening joint takes the response away from the natural frequency.
pub(crate) fn damped_modes(structure: &Structure, known: &[Source], data: &Data) -> Vec<Part> {
    if !known.iter().any(|source| source.place == Place::Whole(None)) {
        return Vec::new();
    }
    let omegas: Vec<f64> = data.runs.iter().map(|run| run.omega).collect();
    let modes = modes_in_band(structure, &omegas);
    let mut sizes = modes.clone();
    sizes.extend(modes_in_band(structure, &clear_harmonics(data)).into_iter().filter(|mode| !modes.contains(mode)));
    sizes.truncate(if sizes.len() > 1 { MOST_MODES } else { 0 });
    sizes.into_iter().map(Part::ModeDamping).chain(modes.into_iter().map(Part::ModeDampingPerOctave)).collect()
}

/// Couplings of the modes among `parts` with all modes, by stiffness: where no part of a structure is known by itself, errors of single
/// elements show in the shapes of its modes as they do in frequencies. A coupling `e` moves mode `r` by
///
/// ```text
/// e omega_r omega_s / (omega_s^2 - omega_r^2) phi_s
/// ```
///
/// Those come first that the sensors see most.
pub(crate) fn mode_couplings(structure: &Structure, parts: &[Part], data: &Data) -> Vec<Part> {
    let mode = |part: &Part| if let Part::Mode(mode) = part { Some(*mode) } else { None };
    let banded: Vec<usize> = parts.iter().filter_map(mode).collect();
    let (false, Ok(modes)) = (banded.is_empty(), structure.modes()) else { return Vec::new() };
    let rows: BTreeSet<usize> =
        data.runs.iter().flat_map(|run| run.responses.iter().map(|channel| channel.dof)).collect();
    let seen = |r: usize| rows.iter().map(|&row| modes.shapes[(row, r)].powi(2)).sum::<f64>().sqrt();
    let seen: Vec<f64> = (0..modes.len()).map(seen).collect();
    let moved = |r: usize, s: usize| {
        let [of_r, of_s] = [r, s].map(|mode| modes.omega[mode]);
        (of_r * of_s / (of_s * of_s - of_r * of_r)).abs() * seen[s] / seen[r]
    };
    let with_all = |&r: &usize| {
        let others = (0..modes.len()).filter(|s| *s != r && (*s > r || !banded.contains(s)));
        let size = |s: usize| if banded.contains(&s) { moved(r, s).max(moved(s, r)) } else { moved(r, s) };
        others.map(|s| ([r.min(s), r.max(s)], size(s))).collect::<Vec<_>>()
    };
    let mut couplings: Vec<([usize; 2], f64)> = banded.iter().flat_map(with_all).collect();
    couplings.retain(|(_, size)| size.is_finite() && *size > 0.0);
    couplings.sort_by(|a, b| b.1.total_cmp(&a.1));
    let least = couplings.first().map_or(0.0, |(_, size)| LITTLE_COUPLING * size);
    couplings.retain(|(_, size)| *size > least);
    couplings.into_iter().take(MOST_COUPLINGS).map(|(pair, _)| Part::ModeCoupling(pair)).collect()
}

/// Circular frequencies (rad/s) of the higher harmonics that a sensor reads well above its noise: the modes that they come near to
/// answer them by their damping.
fn clear_harmonics(data: &Data) -> Vec<f64> {
    let of_run = |run: &RunData| {
        let tells = |i: &usize| run.responses.iter().any(|c| c.measured[*i].norm() > CLEAR * c.deviation[*i]);
        (1..run.harmonics).filter(tells).map(|i| (i + 1) as f64 * run.omega).collect::<Vec<f64>>()
    };
    data.runs.iter().flat_map(of_run).collect()
}

/// Modes whose frequencies the runs come near to.
fn modes_in_band(structure: &Structure, omegas: &[f64]) -> Vec<usize> {
    let Ok(modes) = structure.modes() else { return Vec::new() };
    let near = |w: f64| omegas.iter().any(|&o| w > 0.0 && (o / w).ln().abs() < NEAR_BAND);
    (0..modes.len()).filter(|&r| near(modes.omega[r])).take(MOST_MODES).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::three_masses;
    use crate::common::runs::{channel, run};
    use crate::diagnosis::Problem;
    use crate::effects::Effect;
    use crate::measurement::Quantity;
    use crate::structure::imported::{ImportedDof, ImportedParameters};
    use crate::structure::{Direction, Part};
    use faer::{Mat, c64};

    /// The second harmonic falls on the second mode: where a sensor reads it, the damping of that mode is free.
    #[test]
    fn modes_that_higher_harmonics_show_are_damped_as_they_are() {
        let structure = three_masses([1.0; 3]);
        let known = [Source::known(Effect::LossFactor, Place::Whole(None), &[0.01])];
        let omega = 0.5 * structure.modes().unwrap().omega[1];
        let damped = |second: f64| {
            let motion = vec![c64::new(1.0, 0.0), c64::new(second, 0.0)];
            let force = channel(Quantity::Force, 2, vec![c64::new(1.0, 0.0), c64::new(0.0, 0.0)], 1e-3);
            let runs = [run("run".into(), omega, vec![force, channel(Quantity::Displacement, 2, motion, 1e-3)])];
            let data = Data::new(&Problem { structure: &structure, sources: &known, runs: &runs }).unwrap();
            damped_modes(&structure, &known, &data).contains(&Part::ModeDamping(1))
        };
        assert!(damped(0.02) && !damped(0.005));
    }

    /// All pairs but those of two modes out of the band; those that move the only sensor most come first.
    #[test]
    fn modes_in_the_band_are_coupled_with_all() {
        let structure = three_masses([1.0; 3]);
        let modes = structure.modes().unwrap();
        let force = channel(Quantity::Force, 2, vec![c64::new(1.0, 0.0)], 1e-3);
        let motion = channel(Quantity::Displacement, 0, vec![c64::new(1.0, 0.0)], 1e-3);
        let runs = [run("run".into(), modes.omega[0], vec![force, motion])];
        let data = Data::new(&Problem { structure: &structure, sources: &[], runs: &runs }).unwrap();
        let couplings = |banded: &[usize]| {
            let parts: Vec<Part> = banded.iter().copied().map(Part::Mode).collect();
            mode_couplings(&structure, &parts, &data)
        };
        let moved = |r: usize, s: usize| {
            let (wr, ws) = (modes.omega[r], modes.omega[s]);
            wr * ws / (ws * ws - wr * wr) * (modes.shapes[(0, s)] / modes.shapes[(0, r)]).abs()
        };
        let mut of_first = [([0, 1], moved(0, 1)), ([0, 2], moved(0, 2))];
        of_first.sort_by(|a, b| b.1.total_cmp(&a.1));
        assert_eq!(couplings(&[0]), of_first.map(|(pair, _)| Part::ModeCoupling(pair)));
        assert_eq!(couplings(&[0, 1]).len(), 3);
        assert!(couplings(&[]).is_empty());
    }

    /// Of imported matrices that are no springs, modes are wrong in stiffness and nodes in mass; a rotation has none of its own.
    #[test]
    fn matrices_are_wrong_by_modes_and_by_masses_at_their_nodes() {
        let dof = |label: &str, direction| ImportedDof { label: label.into(), node: label[..1].into(), direction };
        let parameters = ImportedParameters {
            mass: Mat::identity(2, 2),
            stiffness: Mat::from_fn(2, 2, |i, j| if i == j { 4.0 } else { -1.0 }),
            nodes: None,
            dofs: Some(vec![dof("1z", Direction::Z), dof("1ry", Direction::Ry)]),
            lines: Vec::new(),
        };
        let structure = parameters.build(&[]).unwrap();
        let found = parts(&structure, &[3.0_f64.sqrt(), 5.0_f64.sqrt()]);
        assert_eq!(found, [Part::Stiffness, Part::Mass, Part::Mode(0), Part::Mode(1), Part::PointMass(0)]);
    }
}

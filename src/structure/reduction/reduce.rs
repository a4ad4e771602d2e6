//! The reduction itself.

use super::check::check;
use super::mode_check::ModeCheck;
use super::outcome::Reduction;
use super::pencil::Shifted;
use super::request::{ReductionMethod, SparseSystem, Wanted};
use crate::math::eigen::symmetrised;
use crate::math::fill::filled;
use crate::structure::error::StructureError;
use crate::structure::geometry::Direction;
use crate::structure::matrices::SystemMatrices;
use crate::structure::modes::Modes;
use crate::structure::pencil::Pencil;
use dashpot_numerics::{SparseCholesky, SparseSymmetric, product, transposed_product};
use faer::Mat;

/// Steps from the shifted to the true static modes.
const STEPS: usize = 3;

/// How much further fixed-interface modes are kept where the error is above what was asked.
const FURTHER: f64 = 1.5;
/// Most times that they are kept further: 1.5^6 is 11 times the frequency.
const MOST_TIMES: usize = 6;

/// Reduces `system` to its rows `kept` (ascending); `directions` are those of all its rows.
///
/// Where frequencies in the band are off by more than `wanted.error`, fixed-interface modes are kept up to a higher frequency,
/// which the result says.
///
/// # Errors
/// [`StructureError`]: nothing kept, too many modes, a structure that is not stable or, for Guyan, not restrained by `kept`.
pub(crate) fn reduce(
    system: &SparseSystem,
    directions: &[Direction],
    kept: &[usize],
    wanted: Wanted,
) -> Result<(SystemMatrices, Reduction), StructureError> {
    let n = system.mass.size();
    if kept.is_empty() {
        return Err(StructureError::NothingKept);
    }
    if kept.len() >= n {
        return Err(StructureError::NothingReduced { kept: kept.len(), degrees: n });
    }
    let whole = |found: &Reduced| -> Result<(Modes, Vec<ModeCheck>), StructureError> {
        let modes = Shifted::new(system, wanted.band_hz).ok_or(StructureError::NotStable)?.modes(wanted.band_hz)?;
        let checks = check(&modes, &found.matrices, kept, wanted)?;
        Ok((modes, checks))
    };
    let mut best = once(system, directions, kept, wanted)?;
    let (modes, mut checks) = whole(&best)?;
    let mut next = wanted;
    for _ in 0..MOST_TIMES {
        if wanted.method == ReductionMethod::Guyan || worst(&checks) <= wanted.error || best.matrices.mass.nrows() >= n
        {
            break;
        }
        next.up_to_hz *= FURTHER;
        // What was asked for is there; a model that has too many modes further up keeps it.
        let Ok(more) = once(system, directions, kept, next) else { break };
        let better = check(&modes, &more.matrices, kept, wanted)?;
        if worst(&better) < worst(&checks) {
            (best, checks) = (more, better);
        }
    }
    let Reduced { matrices, base_loads, fixed_interface_modes, wanted } = best;
    let kept = kept.len();
    let reduction = Reduction { wanted, from_dofs: n, kept, fixed_interface_modes, modes: checks, base_loads };
    Ok((matrices, reduction))
}

/// Largest relative error of a frequency.
fn worst(checks: &[ModeCheck]) -> f64 {
    checks.iter().map(|check| check.frequency_error().abs()).fold(0.0, f64::max)
}

/// A reduction before it is checked.
struct Reduced {
    matrices: SystemMatrices,
    base_loads: [Vec<f64>; 3],
    fixed_interface_modes: usize,
    wanted: Wanted,
}

fn once(
    system: &SparseSystem,
    directions: &[Direction],
    kept: &[usize],
    wanted: Wanted,
) -> Result<Reduced, StructureError> {
    let n = system.mass.size();
    let (basis, fixed_interface_modes) = basis(system, kept, wanted)?;
    let loaded = system.mass.times(basis.as_ref());
    let mass = symmetrised(transposed_product(basis.as_ref(), loaded.as_ref()).as_ref());
    let strained = system.stiffness.times(basis.as_ref());
    let stiffness = symmetrised(transposed_product(basis.as_ref(), strained.as_ref()).as_ref());
    let matrices = SystemMatrices { mass, stiffness };
    let base_loads = [Direction::X, Direction::Y, Direction::Z].map(|direction| {
        let moved = |i: &usize| directions[*i] == direction;
        (0..basis.ncols()).map(|j| (0..n).filter(moved).map(|i| loaded[(i, j)]).sum()).collect()
    });
    Ok(Reduced { matrices, base_loads, fixed_interface_modes, wanted })
}

/// `T`, n x (kept + modes), and the number of modes.
fn basis(system: &SparseSystem, kept: &[usize], wanted: Wanted) -> Result<(Mat<f64>, usize), StructureError> {
    let (_, k_ib, k_ii) = system.stiffness.partition(kept);
    let (_, _, m_ii) = system.mass.partition(kept);
    let inner = SparseSystem { mass: m_ii, stiffness: k_ii };
    let (static_modes, shapes) = match wanted.method {
        ReductionMethod::Guyan => {
            let factor = SparseCholesky::new(&inner.stiffness).ok_or(StructureError::NotRestrained)?;
            (factor.solve(coupling(&inner.stiffness, kept.len(), &k_ib).as_ref()), Mat::zeros(0, 0))
        }
        ReductionMethod::CraigBampton => {
            let shifted = Shifted::new(&inner, wanted.up_to_hz).ok_or(StructureError::NotStable)?;
            let shapes = shifted.modes(wanted.up_to_hz)?.shapes;
            let load = coupling(&inner.stiffness, kept.len(), &k_ib);
            (beside_modes(&shifted, &load, &shapes), shapes)
        }
    };
    let (n, b, m) = (system.mass.size(), kept.len(), shapes.ncols());
    let mut t = Mat::zeros(n, b + m);
    let mut others = 0;
    let mut next = 0;
    for i in 0..n {
        if kept.get(next) == Some(&i) {
            t[(i, next)] = 1.0;
            next += 1;
            continue;
        }
        (0..b).for_each(|j| t[(i, j)] = static_modes[(others, j)]);
        (0..m).for_each(|j| t[(i, b + j)] = shapes[(others, j)]);
        others += 1;
    }
    Ok((t, m))
}

/// `K_ii^-1 B` less what the modes `Phi` hold of it, which is in the space of `T` anyway. On all other modes
/// `X := A^-1 (B + s M X)` converges by `s / (omega_r^2 + s)`, at most a thousandth a step, though `K_ii` may be singular.
fn beside_modes(shifted: &Shifted<'_>, load: &Mat<f64>, shapes: &Mat<f64>) -> Mat<f64> {
    let by_mass = shifted.by_mass(shapes.as_ref());
    let without = |mut x: Mat<f64>| {
        if shapes.ncols() > 0 {
            x -= product(shapes.as_ref(), transposed_product(by_mass.as_ref(), x.as_ref()).as_ref());
        }
        x
    };
    let mut x = without(shifted.solve(load.as_ref()));
    for _ in 0..STEPS {
        let inertia = shifted.by_mass(x.as_ref());
        let right = filled(load.nrows(), load.ncols(), |i, j| load[(i, j)] + shifted.shift * inertia[(i, j)]);
        x = without(shifted.solve(right.as_ref()));
    }
    x
}

/// `-K_ib`, inner x kept.
fn coupling(inner: &SparseSymmetric, kept: usize, stiffness: &[(usize, usize, f64)]) -> Mat<f64> {
    let mut load = Mat::zeros(inner.size(), kept);
    stiffness.iter().for_each(|&(i, j, value)| load[(i, j)] -= value);
    load
}

//! Receptance of the structure alone at one harmonic, `A_h = Z(h w)^-1`, ready to be asked for single entries.
//!
//! `Z(w) = (1 + 1e-14 i) K - w^2 M + sum of whole-structure laws`. Small structures keep the inverse itself; larger ones
//! their undamped modes, `A = sum_r phi_r phi_r^T / z_r`, where the laws are diagonal. Sources between single DOFs are
//! added afterwards (`condense`), so that one receptance serves every candidate. The loss factor 1e-14 keeps `Z`
//! regular at an undamped natural frequency and is far below any damping that can be measured; modes near resonance are
//! set apart (`resonant`).

use super::error::ModelError;
use super::modal_basis::{ModalBasis, modal_basis};
use super::resonant::{Pattern, Resonant, damping, near};
use crate::effects::basis::{Basis, add_along, multiply};
use crate::effects::{Kind, Leg, Source, place::Place};
use crate::structure::mode_damping::octaves;
use crate::structure::{DampingOfMode, Structure, SystemMatrices};
use dashpot_numerics::{Cholesky, ComplexLu};
use faer::{Mat, c64};
use std::sync::Arc;

/// Loss factor that keeps undamped structures regular at their natural frequencies.
const REGULARISING_LOSS: f64 = 1e-14;
/// Up to this many degrees of freedom the inverse is formed at every harmonic.
const DENSE: usize = 60;

/// The structure and its whole-structure laws.
#[derive(Debug, Clone)]
pub(crate) struct LinearPart {
    structure: Arc<Structure>,
    /// Whole-structure laws: source, and its own matrix where it is restricted to elements.
    whole: Vec<(Source, Option<Arc<Mat<f64>>>)>,
    basis: Arc<ModalBasis>,
    /// Shift of `K` by a multiple of `M` at rest, for structures that float.
    floating_shift: f64,
    /// Factor on `K`: a joint that re-seats or a temperature makes it another from run to run.
    stiffness: f64,
}

impl LinearPart {
    /// Takes matrices and the whole-structure laws of `sources`.
    pub(crate) fn new(structure: Arc<Structure>, sources: &[Source]) -> Result<Self, ModelError> {
        let matrices = structure.matrices().ok_or(ModelError::NoMatrices)?;
        let SystemMatrices { mass, stiffness } = matrices;
        Cholesky::new(mass.as_ref()).ok_or(ModelError::MassNotPositive)?;
        let basis = Arc::new(modal_basis(matrices)?);
        let floating_shift = floating_shift(mass, stiffness);
        let part = Self { structure, whole: Vec::new(), basis, floating_shift, stiffness: 1.0 };
        Ok(part.with_whole(sources))
    }

    /// The same structure with the whole-structure laws among `sources` in place of its own.
    pub(crate) fn with_whole(&self, sources: &[Source]) -> Self {
        let mut part = Self { whole: Vec::new(), ..self.clone() };
        for source in sources {
            if let (Kind::Whole(law), Place::Whole(range)) = (source.effect.kind(), &source.place) {
                let own = range.and_then(|_| law.basis().matrix(&self.structure, *range)).map(Arc::new);
                part.whole.push((source.clone(), own));
            }
        }
        part
    }

    /// Whether the whole-structure laws among `sources` are those of this part.
    pub(crate) fn has_whole(&self, sources: &[Source]) -> bool {
        let given = sources.iter().filter(|s| matches!(s.effect.kind(), Kind::Whole(_)));
        given.eq(self.whole.iter().map(|(source, _)| source))
    }

    /// Undamped modes of the structure.
    pub(crate) fn basis(&self) -> &ModalBasis {
        &self.basis
    }

    /// The structure without its laws.
    pub(crate) fn structure(&self) -> &Structure {
        &self.structure
    }

    fn matrices(&self) -> &SystemMatrices {
        self.structure.matrices().expect("checked when the part was made")
    }

    /// The same structure with all stiffness multiplied by `factor`.
    pub(crate) fn stiffened(&self, factor: f64) -> Self {
        Self { stiffness: factor, ..self.clone() }
    }

    /// Number of degrees of freedom.
    pub(crate) fn len(&self) -> usize {
        self.structure.len()
    }

    /// `factor B x`, where `B` is the matrix on which the whole-structure law `source` acts at `omega`.
    pub(crate) fn apply_whole(&self, source: &Source, factor: c64, omega: f64, x: &[c64]) -> Vec<c64> {
        let Kind::Whole(law) = source.effect.kind() else { return vec![c64::new(0.0, 0.0); x.len()] };
        law.basis().times(&self.structure, source.place.elements(), self.of_stated(omega), factor, x)
    }

    /// What laws of the whole structure add to the dynamic stiffness of the corrected damping of a mode, beyond what they give
    /// through `K` and `M`, N/(m kg): its shares by stiffness and by mass.
    fn damping_of(&self, mode: &DampingOfMode, omega: f64) -> [c64; 2] {
        let [by_stiffness, by_mass] = self.damping_factors(omega);
        let more_of = |basis: Basis| basis.more_of_at(mode, self.of_stated(omega));
        [by_stiffness * self.stiffness * more_of(Basis::Stiffness), by_mass * more_of(Basis::Mass)]
    }

    /// What changes of the damping of a mode by the octaves above its natural frequency, which go with the root of stiffness over mass.
    fn by_natural_frequency(&self, mode: &DampingOfMode, omega: f64, of_mass: bool) -> c64 {
        let [by_stiffness, by_mass] = self.damping_factors(omega);
        let damping = by_stiffness * (self.stiffness * mode.square) + by_mass;
        let octaves = if of_mass { 0.5 } else { -0.5 } * mode.per_octave.log2();
        damping * (mode.factor_at(self.of_stated(omega)) * octaves)
    }

    /// The frequency, rad/s, that is as many octaves above the modes as stated as `omega` is above those of this stiffness.
    fn of_stated(&self, omega: f64) -> f64 {
        omega / self.stiffness.sqrt()
    }

    /// What the corrected damping of modes adds to `Z x` and depends on all stiffness or, else, on all mass.
    pub(crate) fn apply_damping_of_modes(&self, omega: f64, of_mass: bool, factor: c64, x: &[c64]) -> Vec<c64> {
        let mut result = vec![c64::new(0.0, 0.0); x.len()];
        for mode in self.structure.damping_of_modes() {
            let size =
                self.damping_of(mode, omega)[usize::from(of_mass)] + self.by_natural_frequency(mode, omega, of_mass);
            add_along(&mode.pattern, factor * size, x, &mut result);
        }
        result
    }

    /// `-f_r z_r (M phi_r)(M phi_r)^T x`: the pseudo-force of a mode whose damping by laws of the whole structure grows; `None` without
    /// such a mode.
    pub(crate) fn apply_mode_damping(&self, mode: usize, omega: f64, x: &[c64]) -> Option<Vec<c64>> {
        let square = *self.basis.squares.get(mode)?;
        let [by_stiffness, by_mass] = self.damping_factors(omega);
        let size = (by_stiffness * (self.stiffness * square) + by_mass)
            * self.structure.mode_damping_at(mode, self.of_stated(omega));
        let mut result = vec![c64::new(0.0, 0.0); x.len()];
        add_along(&self.times_mass(self.basis.shape(mode)), -size, x, &mut result);
        Some(result)
    }

    /// The same of one whose damping grows with frequency, by the logarithm of its factor an octave above the natural frequency.
    pub(crate) fn apply_mode_damping_per_octave(&self, mode: usize, omega: f64, x: &[c64]) -> Option<Vec<c64>> {
        let octaves = octaves(self.of_stated(omega), *self.basis.squares.get(mode)?);
        let mut load = self.apply_mode_damping(mode, omega, x)?;
        load.iter_mut().for_each(|force| *force *= octaves);
        Some(load)
    }

    /// `(stiffness K + mass M) x` for the two given factors.
    pub(crate) fn apply_matrices(&self, stiffness: c64, mass: c64, x: &[c64]) -> Vec<c64> {
        let matrices = self.matrices();
        if mass.norm_sqr() == 0.0 {
            return multiply(&matrices.stiffness, stiffness, x);
        }
        let mut result = multiply(&matrices.mass, mass, x);
        if stiffness.norm_sqr() > 0.0 {
            let elastic = multiply(&matrices.stiffness, stiffness, x);
            result.iter_mut().zip(elastic).for_each(|(r, e)| *r += e);
        }
        result
    }

    /// `-dK x`: the pseudo-force of two modes that are coupled by stiffness, of one mode (twice the same) whose stiffness grows;
    /// `None` without such modes.
    ///
    /// ```text
    /// dK = omega_r omega_s ((M phi_r)(M phi_s)^T + (M phi_s)(M phi_r)^T),      of one mode omega_r^2 (M phi_r)(M phi_r)^T
    /// ```
    ///
    /// beside corrections of modes that are there by the modes before them.
    pub(crate) fn apply_modal_stiffness(&self, pair: [usize; 2], x: &[c64]) -> Option<Vec<c64>> {
        let [r, s] = pair;
        let squares = &self.basis.squares;
        let size = -(squares.get(r)? * squares.get(s)?).sqrt();
        if let Some(change) = self.structure.modal_stiffness().and_then(|corrected| corrected.change(pair, x)) {
            return Some(change.into_iter().map(|force| -force).collect());
        }
        let [first, second] = pair.map(|mode| self.times_mass(self.basis.shape(mode)));
        let along = |pattern: &[f64]| pattern.iter().zip(x).map(|(p, x)| *x * *p).sum::<c64>();
        let (by_first, by_second) = (along(&first), along(&second));
        let both = if r == s { 0.0 } else { 1.0 };
        let force = |(p, q): (&f64, &f64)| (by_second * *p + by_first * *q * both) * size;
        Some(first.iter().zip(&second).map(force).collect())
    }

    /// `M x`.
    pub(crate) fn times_mass(&self, x: &[f64]) -> Vec<f64> {
        let mass = &self.matrices().mass;
        let mut result = vec![0.0; x.len()];
        for (j, value) in x.iter().enumerate() {
            result.iter_mut().zip(mass.col_as_slice(j)).for_each(|(r, m)| *r += m * value);
        }
        result
    }

    /// Factors of `K` and `M` in `Z(omega)`, without laws restricted to elements.
    pub(crate) fn factors(&self, omega: f64) -> [c64; 2] {
        let shift = if omega == 0.0 { self.floating_shift } else { 0.0 };
        let mut factors = [c64::new(1.0, REGULARISING_LOSS), c64::new(shift - omega * omega, 0.0)];
        if omega == 0.0 {
            factors[0].im = 0.0;
        }
        factors.iter_mut().zip(self.damping_factors(omega)).for_each(|(f, damping)| *f += damping);
        factors[0] *= self.stiffness;
        factors
    }

    /// What laws of the whole structure add to the factors of `K` and `M`.
    fn damping_factors(&self, omega: f64) -> [c64; 2] {
        let mut factors = [c64::new(0.0, 0.0); 2];
        for (source, own) in &self.whole {
            if let (Kind::Whole(law), None) = (source.effect.kind(), own) {
                let index = usize::from(law.basis() == Basis::Mass);
                factors[index] += law.factor(source.parameters[0], omega);
            }
        }
        factors
    }

    /// `Z(omega)`, n x n.
    pub(crate) fn dynamic_stiffness(&self, omega: f64) -> Mat<c64> {
        let [fk, fm] = self.factors(omega);
        let SystemMatrices { mass, stiffness } = self.matrices();
        let mut z = Mat::from_fn(self.len(), self.len(), |i, j| fk * stiffness[(i, j)] + fm * mass[(i, j)]);
        for (source, own) in &self.whole {
            if let (Kind::Whole(law), Some(own)) = (source.effect.kind(), own) {
                let factor = law.factor(source.parameters[0], omega);
                z += Mat::from_fn(self.len(), self.len(), |i, j| factor * own[(i, j)]);
            }
        }
        for mode in self.structure.damping_of_modes() {
            let (v, size) = (&mode.pattern, self.damping_of(mode, omega).iter().sum::<c64>());
            z += Mat::from_fn(self.len(), self.len(), |i, j| size * (v[i] * v[j]));
        }
        z
    }

    /// Receptance at `omega` (rad/s; 0 is static); modes at resonance are set apart if `apart`. With `summed` modes are
    /// summed where that is exact, which is cheaper unless many entries are asked for.
    pub(crate) fn compliance(&self, omega: f64, apart: bool, summed: bool) -> Compliance {
        let factors = self.factors(omega);
        let modes = if apart && omega > 0.0 { near(&self.basis, factors) } else { Vec::new() };
        let mut resonant: Vec<Resonant> =
            modes.iter().map(|&r| Resonant::new(self.times_mass(self.basis.shape(r)), self.basis.square(r))).collect();
        // A sweep asks each frequency for a few entries only.
        let modal = self.len() > DENSE || !apart || summed;
        let inverse = if modal && self.whole.iter().all(|(_, own)| own.is_none()) {
            self.modal_inverse(omega, factors, &modes)
        } else {
            self.dense_inverse(omega, &modes)
        };
        for mode in &mut resonant {
            let force: Vec<c64> = mode.pattern.iter().map(|&v| c64::new(v, 0.0)).collect();
            let mut column = vec![c64::new(0.0, 0.0); self.len()];
            inverse.apply(&force, &mut column);
            mode.column = column;
        }
        Compliance { inverse, resonant, apart }
    }

    fn modal_inverse(&self, omega: f64, [fk, fm]: [c64; 2], damped: &[usize]) -> Inverse {
        let mut stiffness: Vec<c64> = self.basis.squares.iter().map(|&square| fk * square + fm).collect();
        for mode in self.structure.damping_of_modes() {
            stiffness[mode.mode] += self.damping_of(mode, omega).iter().sum::<c64>();
        }
        for &r in damped {
            stiffness[r] += damping(&self.basis, r);
        }
        let factors = stiffness.into_iter().map(|z| c64::new(1.0, 0.0) / z).collect();
        Inverse::Modal { factors, basis: self.basis.clone() }
    }

    fn dense_inverse(&self, omega: f64, damped: &[usize]) -> Inverse {
        let mut z = self.dynamic_stiffness(omega);
        for &r in damped {
            let weighted = self.times_mass(self.basis.shape(r));
            let loss = damping(&self.basis, r);
            z += Mat::from_fn(self.len(), self.len(), |i, j| loss * (weighted[i] * weighted[j]));
        }
        Inverse::Dense(ComplexLu::new(z.as_ref()).solve(Mat::<c64>::identity(self.len(), self.len()).as_ref()))
    }
}

/// Receptance at one frequency with the modes at resonance there.
#[derive(Debug)]
pub(crate) struct Compliance {
    inverse: Inverse,
    /// Modes damped in the receptance; each needs its leg.
    pub resonant: Vec<Resonant>,
    /// Whether what is at resonance is set apart.
    pub apart: bool,
}

/// Receptance matrix.
#[derive(Debug)]
enum Inverse {
    Dense(Mat<c64>),
    Modal { factors: Vec<c64>, basis: Arc<ModalBasis> },
}

impl Compliance {
    /// `v_a^T A v_b`, m/N.
    pub(crate) fn between(&self, a: Pattern, b: Pattern) -> c64 {
        match (a, b) {
            (Pattern::Leg(a), Pattern::Leg(b)) => self.inverse.between(a, b),
            (Pattern::Leg(leg), Pattern::Resonant(r)) | (Pattern::Resonant(r), Pattern::Leg(leg)) => {
                leg.relative(|i| self.resonant[r].column[i])
            }
            (Pattern::Resonant(p), Pattern::Resonant(q)) => self.resonant[p].motion(&self.resonant[q].column),
        }
    }

    /// Displacements of all DOFs (m) under forces (N) at single DOFs.
    pub(crate) fn apply_at(&self, forces: &[(usize, c64)], result: &mut [c64]) {
        self.inverse.apply_at(forces, result);
    }

    /// Displacements of all DOFs under a force at every DOF.
    pub(crate) fn apply(&self, force: &[c64], result: &mut [c64]) {
        self.inverse.apply(force, result);
    }
}

impl Inverse {
    fn between(&self, a: Leg, b: Leg) -> c64 {
        match self {
            Self::Dense(inverse) => a.relative(|i| b.relative(|j| inverse[(i, j)])),
            Self::Modal { factors, basis } => {
                let terms = factors.iter().enumerate().map(|(r, f)| {
                    let shape = |leg: Leg| leg.relative(|i| basis.shapes[(i, r)]);
                    *f * (shape(a) * shape(b))
                });
                terms.fold(c64::new(0.0, 0.0), |sum, term| sum + term)
            }
        }
    }

    fn apply_at(&self, forces: &[(usize, c64)], result: &mut [c64]) {
        result.fill(c64::new(0.0, 0.0));
        match self {
            Self::Dense(inverse) => {
                for &(dof, force) in forces {
                    for (x, a) in result.iter_mut().zip(inverse.col_as_slice(dof)) {
                        *x += *a * force;
                    }
                }
            }
            Self::Modal { factors, basis } => {
                let modal = factors.iter().enumerate().map(|(r, f)| {
                    let load = forces.iter().fold(c64::new(0.0, 0.0), |s, &(i, q)| s + q * basis.shapes[(i, r)]);
                    *f * load
                });
                basis.combine(modal, result);
            }
        }
    }

    fn apply(&self, force: &[c64], result: &mut [c64]) {
        let loads: Vec<(usize, c64)> = force.iter().copied().enumerate().filter(|(_, f)| f.norm_sqr() > 0.0).collect();
        self.apply_at(&loads, result);
    }
}

/// Zero for a structure that is held; for one that floats, a shift of `K` by `M` far below its stiffness.
fn floating_shift(mass: &Mat<f64>, stiffness: &Mat<f64>) -> f64 {
    let n = mass.nrows();
    let trace = |a: &Mat<f64>| (0..n).map(|i| a[(i, i)]).sum::<f64>();
    let held = Cholesky::new(stiffness.as_ref()).is_some_and(|llt| {
        let l = llt.factor();
        (0..n).all(|i| l[(i, i)] * l[(i, i)] > 1e-13 * stiffness[(i, i)])
    });
    match (held, trace(stiffness)) {
        (true, _) => 0.0,
        // Nothing but mass: any shift is as good, for nothing says where it rests.
        (false, 0.0) => 1.0,
        (false, stiffness) => 1e-12 * stiffness / trace(mass),
    }
}

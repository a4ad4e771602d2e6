//! Study of incompleteness (section 3.3.6, figures 3.6 to 3.13): how far each method that works on complex modes is from a known
//! damping, against the number of modes and of sensors measured.
//!
//! The modes are those of the structure with the damping `truth`, without noise: what is lost is lost by incompleteness
//! alone. With fewer sensors than DOFs the shapes are expanded by the model's lowest modes, as measured ones are
//! (`super::resonant::expanded`). Errors: `eps_C` (3.135), `eps_p` (3.117), the generalised MAC (3.134).

use super::adhikari_woodhouse::{original, projection_error, symmetric};
use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::errors::{generalised_mac, mac_error, matrix_error};
use super::linear::column;
use super::method::Method;
use super::resonant::{expanded, is_seen};
use super::{frf_inverse, ibrahim, lancaster, minas_inman, pilkey_inman};
use crate::control::Control;
use crate::effects::{Source, State};
use crate::math::eigen::symmetrised;
use crate::math::fill::filled_complex;
use crate::response::linear_matrices::LinearMatrices;
use crate::structure::damped_modes::{DampedMode, damped_modes_from};
use crate::structure::modes::Modes;
use crate::structure::{Structure, SystemMatrices};
use faer::{Mat, MatRef};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The methods that are compared, in the order of [`Case::methods`].
pub const METHODS: [Method; 7] = [
    Method::Lancaster,
    Method::PilkeyInmanDirect,
    Method::FrfInverse,
    Method::AdhikariWoodhouse,
    Method::AdhikariWoodhouseSymmetric,
    Method::Ibrahim,
    Method::MinasInman,
];

/// DOFs up to which [`Grid::new`] takes every number of modes; above as many numbers, each larger by the same part.
const MOST_COUNTS: usize = 20;
/// Most DOFs: every case needs several eigenvalue problems of full matrices.
const MOST_DEGREES: usize = 400;
/// DOFs up to which [`Grid::new`] asks for MAC errors: they need all modes of every identified matrix.
const MOST_WITH_MAC: usize = 60;

/// What is looked at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    /// Sets of sensors: DOFs by index, ascending. A set with all DOFs needs no expansion.
    pub sensors: Vec<Vec<usize>>,
    /// Numbers of lowest modes measured, ascending; with fewer sensors than DOFs those up to the number of sensors are
    /// taken, and only below the first mode that they do not see.
    pub modes: Vec<usize>,
    /// Whether MAC errors are wanted.
    pub mac: bool,
}

impl Grid {
    /// All DOFs, all translations, half and a quarter of them spread evenly from the last one, and `own`, the sensors of the
    /// user's runs (may be empty); all numbers of modes, or about 20
    /// of them, the low ones first, where DOFs are more.
    pub fn new(structure: &Structure, own: &[usize]) -> Self {
        let n = structure.len();
        let translations = structure.translations().len();
        let mut sensors = vec![(0..n).collect::<Vec<usize>>()];
        sensors.extend([1, 2, 4].map(|part| spread_sensors(structure, translations.div_ceil(part))));
        let mut own = own.to_vec();
        own.sort_unstable();
        own.dedup();
        sensors.push(own);
        let mut kept: Vec<Vec<usize>> = Vec::new();
        for set in sensors {
            if !set.is_empty() && !kept.contains(&set) {
                kept.push(set);
            }
        }
        let grown = |k: usize| (n as f64).powf(k as f64 / MOST_COUNTS as f64).round() as usize;
        let mut modes: Vec<usize> =
            if n <= MOST_COUNTS { (1..=n).collect() } else { (0..=MOST_COUNTS).map(grown).collect() };
        modes.dedup();
        Self { sensors: kept, modes, mac: n <= MOST_WITH_MAC }
    }
}

/// `C` (n x n, N s/m) of the reference and known sources, to be found again; `None` without matrices, where there is no viscous
/// one, or where one of them has no constant matrix, as friction.
pub fn known_damping(structure: &Structure, sources: &[Source]) -> Option<Mat<f64>> {
    let acting: Vec<Source> =
        sources.iter().filter(|s| matches!(s.state, State::Reference | State::Known)).cloned().collect();
    let all = LinearMatrices::new(structure, &acting).ok()?;
    (all.others.is_empty() && all.viscous.norm_max() > 0.0).then_some(all.viscous)
}

/// `count` translations, spread evenly over the structure from the last one.
pub fn spread_sensors(structure: &Structure, count: usize) -> Vec<usize> {
    let all = structure.translations();
    let count = count.min(all.len());
    (0..count).map(|k| all[all.len() - 1 - k * all.len() / count]).rev().collect()
}

/// Errors of one identified matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixErrors {
    /// `eps_C` (3.135), per cent.
    pub eps_c: f64,
    /// Largest entry of `|I - MAC|` (3.134); `None` unless asked for.
    pub mac: Option<f64>,
    /// The same among the measured modes only.
    pub mac_measured: Option<f64>,
}

/// One number of modes at one set of sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Index into [`Incompleteness::sensors`].
    pub sensors: usize,
    /// Number of the lowest modes measured.
    pub modes: usize,
    /// Part of the imaginary shapes outside the span of the real ones (3.117), per cent: what the perturbation must lose. A
    /// property of the measured modes, not of a method.
    pub eps_p: f64,
    /// Of each of [`METHODS`]: its errors, or in one line why it cannot run.
    pub methods: Vec<Result<MatrixErrors, String>>,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Incompleteness {
    /// Sets of sensors, as in [`Grid::sensors`].
    pub sensors: Vec<Vec<usize>>,
    /// All cases: set by set, modes ascending.
    pub cases: Vec<Case>,
}

impl Incompleteness {
    /// Curve of one method at one set of sensors: (modes, `eps_C` in per cent), modes ascending; without those where it cannot run.
    pub fn eps_c(&self, sensors: usize, method: Method) -> Vec<[f64; 2]> {
        let Some(k) = METHODS.iter().position(|&m| m == method) else { return Vec::new() };
        let point = |case: &Case| Some([case.modes as f64, case.methods[k].as_ref().ok()?.eps_c]);
        self.cases.iter().filter(|case| case.sensors == sensors).filter_map(point).collect()
    }
}

/// What all cases share.
struct Known<'a> {
    matrices: &'a SystemMatrices,
    model: Modes,
    truth: MatRef<'a, f64>,
    exact: Vec<DampedMode>,
    mac: bool,
}

/// Errors of each of [`METHODS`] at every case of `grid`, for `structure` with the viscous damping `truth` (n x n, N s/m). Cases
/// are shared among the workers of `control`.
///
/// # Errors
/// [`ClassicalError::Missing`] for a structure without matrices or without damping; [`ClassicalError::TooLarge`];
/// [`ClassicalError::Cancelled`]; those of the modes.
pub fn incompleteness(
    structure: &Structure,
    truth: MatRef<'_, f64>,
    grid: &Grid,
    control: &Control,
) -> Result<Incompleteness, ClassicalError> {
    let Some(matrices) = structure.matrices() else {
        let what = "mass and stiffness matrices: the classical methods work on a model".to_string();
        return Err(ClassicalError::Missing { what });
    };
    if structure.len() > MOST_DEGREES {
        return Err(ClassicalError::TooLarge { limit: MOST_DEGREES, found: structure.len() });
    }
    if truth.norm_max() == 0.0 {
        return Err(ClassicalError::Missing { what: "a damping to be found again".to_string() });
    }
    let model = structure.modes()?;
    let exact: Vec<DampedMode> =
        damped_modes_from(&model, truth)?.into_iter().filter(|mode| mode.lambda.im > 0.0).collect();
    let n = structure.len();
    let pairs: Vec<(usize, usize)> = grid
        .sensors
        .iter()
        .enumerate()
        .flat_map(|(s, set)| {
            // A mode that no sensor sees cannot be measured, nor those above it counted.
            let seen = (0..exact.len()).take_while(|&r| is_seen(&model, set, r)).count();
            let most = if set.len() == n { exact.len() } else { set.len().min(seen) };
            grid.modes.iter().filter(move |&&m| m >= 1 && m <= most).map(move |&m| (s, m))
        })
        .collect();
    let known = Known { matrices, model, truth, exact, mac: grid.mac };
    let done = AtomicUsize::new(0);
    let cases = control.map(pairs.len(), |k| {
        control.check()?;
        let (sensors, modes) = pairs[k];
        let case = known.case(sensors, &grid.sensors[sensors], modes);
        control.report((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / pairs.len() as f64);
        case
    });
    Ok(Incompleteness { sensors: grid.sensors.clone(), cases: cases.into_iter().collect::<Result<_, _>>()? })
}

impl Known<'_> {
    fn case(&self, index: usize, sensors: &[usize], modes: usize) -> Result<Case, ClassicalError> {
        let data = self.measured(sensors, modes)?;
        let (m, k) = (self.matrices.mass.as_ref(), self.matrices.stiffness.as_ref());
        let methods = METHODS.into_iter().map(|method| {
            let damping = self.apply(method, m, k, &data)?;
            self.errors(&damping, modes)
        });
        let methods = methods.map(|found| found.map_err(|error| error.to_string())).collect();
        Ok(Case { sensors: index, modes, eps_p: projection_error(m, &data)?, methods })
    }

    /// The lowest modes as the sensors show them, at all DOFs.
    fn measured(&self, sensors: &[usize], modes: usize) -> Result<ModalData, ClassicalError> {
        let whole = ModalData::from_modes(&self.exact, modes);
        let n = whole.degrees();
        if sensors.len() == n {
            return Ok(whole);
        }
        let mut shapes = Vec::new();
        for p in 0..modes {
            let all = column(whole.shapes.as_ref(), p);
            let values: Vec<_> = sensors.iter().map(|&dof| all[dof]).collect();
            shapes.push(expanded(&self.model, sensors, &values, p)?);
        }
        Ok(ModalData { shapes: filled_complex(n, modes, |i, p| shapes[p][i]), ..whole })
    }

    fn apply(
        &self,
        method: Method,
        m: MatRef<'_, f64>,
        k: MatRef<'_, f64>,
        data: &ModalData,
    ) -> Result<Damping, ClassicalError> {
        match method {
            Method::Lancaster => lancaster::lancaster(m, data),
            Method::PilkeyInmanDirect => pilkey_inman::direct(m, k, data),
            Method::FrfInverse => frf_inverse::frf_inverse(&self.model, data),
            Method::AdhikariWoodhouse => original(m, data),
            Method::AdhikariWoodhouseSymmetric => symmetric(m, data),
            Method::Ibrahim => ibrahim::ibrahim(m, &self.model, data),
            Method::MinasInman => minas_inman::minas_inman(m, k, data),
            other => Err(ClassicalError::Missing { what: format!("more than complex modes ({})", other.title()) }),
        }
    }

    fn errors(&self, found: &Damping, measured: usize) -> Result<MatrixErrors, ClassicalError> {
        let eps_c = matrix_error(self.truth, found.viscous.as_ref());
        if !self.mac {
            return Ok(MatrixErrors { eps_c, mac: None, mac_measured: None });
        }
        let c = symmetrised(found.viscous.as_ref());
        let own = damped_modes_from(&self.model, c.as_ref())?;
        let (m, k) = (self.matrices.mass.as_ref(), self.matrices.stiffness.as_ref());
        let error = mac_error(generalised_mac(m, k, (&own, c.as_ref()), (&self.exact, self.truth)).as_ref());
        let count = measured.min(error.nrows()).min(error.ncols());
        let mac_measured = error.submatrix(0, 0, count, count).norm_max();
        Ok(MatrixErrors { eps_c, mac: Some(error.norm_max()), mac_measured: Some(mac_measured) })
    }
}

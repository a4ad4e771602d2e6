//! Every method that the data allow, on the same runs; for each that cannot run, why.

use super::data::{Damping, ModalData, ReceptanceData};
use super::error::ClassicalError;
use super::extracted_mode::ExtractedMode;
use super::incompleteness::known_damping;
use super::liang::Period;
use super::method::Method;
use super::poly_reference::{Extraction, extract};
use super::reference_shapes::{Beside, ReferenceShape, beside};
use super::responses::FrequencyResponses;
use super::{errors, phases, resonant};
use crate::balance::expansion::Acting;
use crate::balance::{Expander, Expansion, Measured};
use crate::control::Control;
use crate::effects::{Source, State};
use crate::math::fill::filled_complex;
use crate::math::statistics::{median, robust_deviation};
use crate::measurement::Run;
use crate::structure::damped_modes::{DampedMode, damped_modes_from};
use crate::structure::modes::Modes;
use crate::structure::{Structure, SystemMatrices};
use faer::{Mat, c64};

/// A damping ratio that a method gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Mode of the model, from 0.
    pub mode: usize,
    /// Hz.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub ratio: f64,
}

/// Distance from a known truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// `eps_C` (3.135), per cent.
    pub eps_c: f64,
    /// Largest entry of `|I - MAC|` (3.134).
    pub mac: f64,
    /// Root mean square relative error of the ratios of the modes measured, per cent.
    pub ratios: f64,
}

/// What one method gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// The matrix; `None` for methods that give ratios only.
    pub damping: Option<Damping>,
    /// Ratios as measured, or of the model's modes with the matrix.
    pub ratios: Vec<Ratio>,
    /// `eps_p` (3.117), per cent, of the perturbation.
    pub eps_p: Option<f64>,
    /// Where a truth is known.
    pub errors: Option<Errors>,
}

/// One method and its outcome, or why it cannot run, in one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The method.
    pub method: Method,
    /// Its outcome.
    pub outcome: Result<Applied, String>,
}

/// All methods on one set of runs.
#[derive(Debug, Clone, PartialEq)]
pub struct SideBySide {
    /// How the complex modes were found, in words; empty where there are none.
    pub modes_from: String,
    /// The complex modes at all DOFs.
    pub modal: Option<ModalData>,
    /// The stabilisation diagram, where lines were enough.
    pub extraction: Option<Extraction>,
    /// Every method.
    pub entries: Vec<Entry>,
    /// The known truth, where sources of state reference or known are viscous.
    pub reference: Option<Mat<f64>>,
    /// Number of the lowest modes whose ratios the data show: by complex modes or by the methods that give ratios only.
    pub measured: usize,
    /// Ratios of the known truth.
    pub reference_ratios: Vec<Ratio>,
    /// Modes and operating shapes of other programs, each beside the same mode here.
    pub beside: Vec<Beside>,
    /// Deviation of each measured mode's ratio between the methods over their median, `(mode, spread)`.
    pub spread: Vec<(usize, f64)>,
}

/// What the methods work on.
pub(super) struct Data<'a> {
    pub(super) structure: &'a Structure,
    matrices: &'a SystemMatrices,
    pub(super) model: Modes,
    sources: &'a [Source],
    pub(super) runs: &'a [Run],
    pub(super) responses: Option<FrequencyResponses>,
    /// Modes that were extracted from the responses; none where lines are few.
    pub(super) extracted: &'a [ExtractedMode],
    receptance: Option<ReceptanceData>,
    modal: Result<ModalData, String>,
}

/// Applies every method, and lays the modes of other programs beside what was measured.
///
/// # Errors
/// [`ClassicalError::Missing`] for a structure without matrices; [`ClassicalError::Cancelled`].
pub fn side_by_side(
    structure: &Structure,
    sources: &[Source],
    runs: &[Run],
    references: &[ReferenceShape],
    control: &Control,
) -> Result<SideBySide, ClassicalError> {
    let Some(matrices) = structure.matrices() else {
        let what = "mass and stiffness matrices: the classical methods work on a model".to_string();
        return Err(ClassicalError::Missing { what });
    };
    let model = structure.modes()?;
    let responses = FrequencyResponses::from_runs(runs);
    let (extraction, modal, modes_from) = complex_modes(matrices, &model, responses.as_ref(), control)?;
    let receptance = responses.as_ref().and_then(|r| r.full(structure.len()));
    let extracted = extraction.as_ref().map_or(&[][..], |extraction| &extraction.modes);
    let data = Data { structure, matrices, model, sources, runs, responses, extracted, receptance, modal };
    let reference = reference(structure, sources);
    let truth = match &reference {
        Some(c) => Some((c, damped_modes_from(&data.model, c.as_ref())?)),
        None => None,
    };
    let mut entries = Vec::new();
    for (k, method) in Method::ALL.into_iter().enumerate() {
        control.check()?;
        control.report(0.5 + 0.5 * k as f64 / Method::ALL.len() as f64);
        let outcome = data.apply(method).and_then(|applied| data.judged(applied, truth.as_ref()));
        entries.push(Entry { method, outcome: outcome.map_err(|error| error.to_string()) });
    }
    let reference_ratios = truth.map_or_else(Vec::new, |(_, modes)| ratios(&modes));
    let measured = measured(&entries, data.modal.as_ref().map_or(0, ModalData::len));
    let spread = spread(&entries, measured);
    let beside = beside(references, data.modal.as_ref().ok(), &data.model);
    let modal = data.modal.ok();
    Ok(SideBySide { modes_from, modal, extraction, entries, reference, measured, reference_ratios, beside, spread })
}

/// Modes up to the highest that is seen.
fn measured(entries: &[Entry], complex: usize) -> usize {
    let only_ratios = entries.iter().filter_map(|e| e.outcome.as_ref().ok()).filter(|a| a.damping.is_none());
    only_ratios.flat_map(|a| &a.ratios).map(|r| r.mode + 1).fold(complex, usize::max)
}

/// Ratios of oscillating modes, ascending.
fn ratios(modes: &[DampedMode]) -> Vec<Ratio> {
    let oscillating = modes.iter().filter(|mode| mode.lambda.im > 0.0).enumerate();
    oscillating.map(|(mode, m)| Ratio { mode, frequency_hz: m.frequency_hz, ratio: m.damping_ratio }).collect()
}

/// `C` of the reference and known viscous sources; `None` without a reference.
fn reference(structure: &Structure, sources: &[Source]) -> Option<Mat<f64>> {
    sources.iter().any(|s| s.state == State::Reference).then(|| known_damping(structure, sources)).flatten()
}

/// Complex modes: from many lines by the poly-reference estimator; those it does not find from runs near the resonances.
type Found = (Option<Extraction>, Result<ModalData, String>, String);

fn complex_modes(
    matrices: &SystemMatrices,
    model: &Modes,
    responses: Option<&FrequencyResponses>,
    control: &Control,
) -> Result<Found, ClassicalError> {
    let Some(responses) = responses else {
        return Ok((None, Err("no run has exactly one exciter".to_string()), String::new()));
    };
    match extract(responses, control) {
        Ok(extraction) if !extraction.modes.is_empty() => {
            let at_sensors = extraction.modal_data(responses);
            let full = expanded(model, responses, &at_sensors)?;
            let (full, words) = completed(model, full, resonant::from_runs(matrices, model, responses).ok());
            return Ok((Some(extraction), Ok(full), words));
        }
        Err(ClassicalError::Cancelled) => return Err(ClassicalError::Cancelled),
        _ => {}
    }
    if let Ok(modal) = resonant::from_runs(matrices, model, responses) {
        let words = format!("{} from runs near the resonances, with the model's help", modes_in_words(modal.len()));
        return Ok((None, Ok(modal), words));
    }
    let why = format!(
        "no resonance has lines enough, and no run lies within {} % of {:.2} Hz, the lowest mode, with a sensor at its drive",
        100.0 * resonant::NEAR,
        model.frequency_hz(0)
    );
    Ok((None, Err(why), String::new()))
}

/// The modes of many lines, and of the modes of the model that are not among them those `from_runs`; how they were found.
fn completed(model: &Modes, own: ModalData, from_runs: Option<ModalData>) -> (ModalData, String) {
    let words = format!("{} by the poly-reference estimator", modes_in_words(own.len()));
    // Shapes of another scale do not belong together.
    let Some(other) = from_runs.filter(|_| own.scaled) else { return (own, words) };
    let mode = |pole: &c64| model.nearest(pole.norm());
    let found: Vec<Option<usize>> = own.poles.iter().map(mode).collect();
    let missing: Vec<usize> = (0..other.len()).filter(|&p| !found.contains(&mode(&other.poles[p]))).collect();
    if missing.is_empty() {
        return (own, words);
    }
    let mut columns: Vec<(c64, Vec<c64>)> =
        (0..own.len()).map(|p| (own.poles[p], super::linear::column(own.shapes.as_ref(), p))).collect();
    columns.extend(missing.iter().map(|&p| (other.poles[p], super::linear::column(other.shapes.as_ref(), p))));
    columns.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
    let shapes = filled_complex(own.shapes.nrows(), columns.len(), |i, p| columns[p].1[i]);
    let modal = ModalData { poles: columns.iter().map(|column| column.0).collect(), shapes, scaled: true };
    let more = "from runs near the resonances, with the model's help";
    (modal, format!("{words}, {} {more}", modes_in_words(missing.len())))
}

fn modes_in_words(count: usize) -> String {
    if count == 1 { "1 mode".to_owned() } else { format!("{count} modes") }
}

/// Shapes at all DOFs.
fn expanded(model: &Modes, responses: &FrequencyResponses, modal: &ModalData) -> Result<ModalData, ClassicalError> {
    let mut shapes = Vec::new();
    for (p, pole) in modal.poles.iter().enumerate() {
        let values = super::linear::column(modal.shapes.as_ref(), p);
        let r = model.nearest(pole.norm()).unwrap_or(p);
        shapes.push(resonant::expanded(model, &responses.sensors, &values, r)?);
    }
    let n = model.shapes.nrows();
    let full = filled_complex(n, shapes.len(), |i, p| shapes[p][i]);
    Ok(ModalData { poles: modal.poles.clone(), shapes: full, scaled: modal.scaled })
}

pub(super) fn missing<T>(what: impl Into<String>) -> Result<T, ClassicalError> {
    Err(ClassicalError::Missing { what: what.into() })
}

impl Data<'_> {
    fn apply(&self, method: Method) -> Result<Applied, ClassicalError> {
        let (m, k) = (self.matrices.mass.as_ref(), self.matrices.stiffness.as_ref());
        let damping = match method {
            Method::LogDecrement => return missing("a free decay; the runs are steady states"),
            Method::HalfPower => return self.half_power(),
            Method::CircleFit => return self.circle_fit(),
            Method::HysteresisLoop => return self.loops(),
            Method::EnergySingle => return self.energy_single(),
            Method::Chen => super::chen::chen(self.receptance()?)?,
            Method::LeeKim => super::lee_kim::lee_kim(self.receptance()?)?,
            Method::LeeKimViscous => super::lee_kim::lee_kim_viscous(self.receptance()?)?,
            Method::Instrumental => super::instrumental::instrumental(self.receptance()?)?.damping,
            Method::Fritzen => super::fritzen::fritzen(&self.loads()?)?.damping,
            Method::Lancaster => {
                let modal = self.modal()?;
                phases::remarked(super::lancaster::lancaster(m, modal)?, m, modal)
            }
            Method::PilkeyInmanIterative => super::pilkey_inman::iterative(m, self.modal()?)?,
            Method::PilkeyInmanDirect => super::pilkey_inman::direct(m, k, self.modal()?)?,
            Method::Ibrahim => super::ibrahim::ibrahim(m, &self.model, self.modal()?)?,
            Method::MinasInman => super::minas_inman::minas_inman(m, k, self.modal()?)?,
            Method::AdhikariWoodhouse => return self.perturbation(),
            Method::AdhikariWoodhouseSymmetric => super::adhikari_woodhouse::symmetric(m, self.modal()?)?,
            Method::FrfInverse => {
                let modal = self.modal()?;
                phases::remarked(super::frf_inverse::frf_inverse(&self.model, modal)?, m, modal)
            }
            Method::Liang => self.liang()?,
            Method::PhaniWoodhouse => self.phani_woodhouse()?,
        };
        Ok(Applied { damping: Some(damping), ratios: Vec::new(), eps_p: None, errors: None })
    }

    pub(super) fn modal(&self) -> Result<&ModalData, ClassicalError> {
        match &self.modal {
            Ok(modal) => Ok(modal),
            Err(why) => missing(format!("complex modes: {why}")),
        }
    }

    pub(super) fn responses(&self) -> Result<&FrequencyResponses, ClassicalError> {
        self.responses.as_ref().map_or_else(|| missing("runs with one exciter each"), Ok)
    }

    fn receptance(&self) -> Result<&ReceptanceData, ClassicalError> {
        let n = self.structure.len();
        let (sensors, drives) = self.responses.as_ref().map_or((0, 0), |r| (r.sensors.len(), r.drives.len()));
        self.receptance.as_ref().map_or_else(
            || missing(format!("the full receptance matrix: {drives} of {n} DOFs are driven, {sensors} measured")),
            Ok,
        )
    }

    fn loads(&self) -> Result<Vec<super::data::LoadCase>, ClassicalError> {
        let (n, responses) = (self.structure.len(), self.responses()?);
        let measured = responses.sensors.len();
        responses.loads(n).map_or_else(|| missing(format!("a sensor at every DOF: {measured} of {n} are measured")), Ok)
    }

    fn perturbation(&self) -> Result<Applied, ClassicalError> {
        let (m, modal) = (self.matrices.mass.as_ref(), self.modal()?);
        let damping = super::adhikari_woodhouse::original(m, modal)?;
        let eps_p = super::adhikari_woodhouse::projection_error(m, modal)?;
        Ok(Applied { damping: Some(damping), ratios: Vec::new(), eps_p: Some(eps_p), errors: None })
    }

    /// The motion of all DOFs as measured, and the candidates as the pattern.
    fn liang(&self) -> Result<Damping, ClassicalError> {
        let columns: Vec<Source> = self
            .sources
            .iter()
            .filter(|s| s.state.is_sought() && s.effect.dissipates())
            .filter(|s| s.effect.coefficient().is_some())
            .cloned()
            .collect();
        let complete = self.responses.as_ref().is_some_and(|r| r.sensors.len() == self.structure.len());
        if !complete {
            return missing("a sensor at every DOF: an expanded motion passes no energy between DOFs");
        }
        let known: Vec<Source> = self.sources.iter().filter(|s| s.state == State::Known).cloned().collect();
        Ok(super::liang::liang(self.structure, &self.periods()?, &columns, &known)?.damping)
    }

    /// Steady motions of all DOFs: every line of frequency responses under every force, and the runs that are not lines of them.
    fn periods(&self) -> Result<Vec<Period>, ClassicalError> {
        let wrong = |error: crate::balance::BalanceError| ClassicalError::Missing { what: error.to_string() };
        let expander = Expander::new(self.structure, Expansion::None, &[]).map_err(wrong)?;
        let (lines, others): (Vec<&Run>, Vec<&Run>) =
            self.runs.iter().filter(|run| run.enabled).partition(|run| run.functions.is_some());
        let loads = if lines.is_empty() { Vec::new() } else { self.loads()? };
        let mut periods: Vec<Period> = loads.iter().map(Period::of_load).collect();
        for run in others {
            let measured = Measured::new(run).map_err(wrong)?;
            let motion = expander.expand(&measured, Acting::NOTHING).map_err(wrong)?;
            periods.push(Period::of_run(&measured, &motion)?);
        }
        Ok(periods)
    }

    fn phani_woodhouse(&self) -> Result<Damping, ClassicalError> {
        let receptance = self.receptance()?;
        let modal = self.modal()?;
        let ratios: Vec<f64> = (0..modal.len()).map(|p| modal.damping_ratio(p)).collect();
        super::phani_woodhouse::phani_woodhouse(receptance, &self.model, &ratios)
    }

    /// Ratios of the matrix, and errors where the truth is known.
    fn judged(
        &self,
        mut applied: Applied,
        truth: Option<&(&Mat<f64>, Vec<DampedMode>)>,
    ) -> Result<Applied, ClassicalError> {
        let Some(damping) = &applied.damping else { return Ok(applied) };
        let c = crate::math::eigen::symmetrised(damping.viscous.as_ref());
        let modes = damped_modes_from(&self.model, c.as_ref())?;
        applied.ratios = ratios(&modes);
        if let Some((known, exact)) = truth {
            let (m, k) = (self.matrices.mass.as_ref(), self.matrices.stiffness.as_ref());
            let mac = errors::generalised_mac(m, k, (&modes, c.as_ref()), (exact, known.as_ref()));
            let count = self.modal.as_ref().map_or(exact.len(), ModalData::len).min(modes.len()).min(exact.len());
            let relative = |p: usize| (modes[p].damping_ratio / exact[p].damping_ratio - 1.0).powi(2);
            let mean = (0..count).filter(|&p| exact[p].damping_ratio > 1e-9).map(relative).sum::<f64>() / count as f64;
            applied.errors = Some(Errors {
                eps_c: errors::matrix_error(known.as_ref(), damping.viscous.as_ref()),
                mac: errors::mac_error(mac.as_ref()).norm_max(),
                ratios: 100.0 * mean.sqrt(),
            });
        }
        Ok(applied)
    }
}

/// Robust deviation over median of the ratio of each mode that was measured, where two methods or more give one: what a
/// method says of other modes is its own invention, and one that fails must not hide how well the others agree.
fn spread(entries: &[Entry], measured: usize) -> Vec<(usize, f64)> {
    let ratio = |entry: &Entry, mode: usize| -> Option<f64> {
        entry.outcome.as_ref().ok()?.ratios.iter().find(|r| r.mode == mode).map(|r| r.ratio)
    };
    (0..measured)
        .filter_map(|mode| {
            let values: Vec<f64> = entries.iter().filter_map(|entry| ratio(entry, mode)).collect();
            let middle = median(&values);
            (values.len() >= 2 && middle != 0.0).then(|| (mode, robust_deviation(&values) / middle.abs()))
        })
        .collect()
}

//! What a project says of a file of frequency responses.

use super::units::Form;
use dashpot_datafiles::Pairing;
use std::collections::BTreeMap;

/// How a file is to be read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrfSource {
    /// What the functions relate; from their units where it is not given.
    pub form: Option<Form>,
    /// Factor from the file's numbers to SI, negative to reverse; from the units where it is not given.
    pub scale: Option<f64>,
    /// Number of averages.
    pub averages: Option<usize>,
    /// Whether responses and references are exchanged: a roving hammer gives columns by reciprocity.
    pub reciprocity: bool,
    /// DOFs of the file by name, such as `12:+Z`, and their labels in the structure.
    pub dofs: BTreeMap<String, String>,
    /// The same of the DOFs where forces act, where these are elsewhere than a sensor of that name.
    pub reference_dofs: BTreeMap<String, String>,
    /// Labels of the responses, in the order of the columns of an array, responses first; `-` in front reverses.
    pub responses: Vec<String>,
    /// Labels of the references, in the order of the columns of an array.
    pub references: Vec<String>,
    /// Step of the frequencies from 0 Hz on, Hz, of a file that does not say them.
    pub step_hz: Option<f64>,
    /// How the columns are parts of complex numbers two by two, where their names do not say it.
    pub columns: Option<Pairing>,
    /// Functions of the same test in files before this one: the lists go on behind them.
    pub before: usize,
}

impl FrfSource {
    /// What the project calls a DOF that has one of these names in the file: where a force acts, that of forces goes first.
    pub(super) fn names(&self, of_force: bool, names: &[impl AsRef<str>]) -> &BTreeMap<String, String> {
        let own = of_force && names.iter().any(|name| self.reference_dofs.contains_key(name.as_ref()));
        if own { &self.reference_dofs } else { &self.dofs }
    }

    /// Labels of response and reference of function number `k` of the file by the lists, where there are any: all responses to the first
    /// reference first.
    pub(super) fn listed(&self, k: usize) -> Result<Option<[String; 2]>, String> {
        if self.responses.is_empty() {
            return Ok(None);
        }
        let k = k + self.before;
        let reference = self.references.get(k / self.responses.len());
        let reference =
            reference.ok_or("`responses` and `references` name fewer functions than there are; name every one")?;
        Ok(Some([self.responses[k % self.responses.len()].clone(), reference.clone()]))
    }

    /// Number of functions that the lists name, where there are any.
    pub(super) fn stated(&self) -> Option<usize> {
        (!self.responses.is_empty()).then(|| self.responses.len() * self.references.len().max(1))
    }
}

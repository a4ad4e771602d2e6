//! Table `[structure.reduce]`.

use super::error::ProjectError;
use super::keys::above_zero;
use super::label::Label;
use super::reader::Table;
use crate::structure::reduction::ReductionMethod;
use serde::{Deserialize, Serialize};

/// Table `[structure.reduce]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReduceTable {
    /// `guyan` or `craig-bampton`.
    pub method: String,
    /// Fixed-interface modes are kept up to this frequency, Hz.
    pub up_to_hz: f64,
    /// The error is told up to this frequency, Hz; half of `up_to_hz` unless given.
    pub band_hz: Option<f64>,
    /// Largest relative error of a frequency in the band, 0.001 unless given.
    pub error: Option<f64>,
    /// DOFs that are kept beside those that the project names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
}

/// Table `[structure.reduce]`.
pub(super) fn parse(table: &Table<'_>) -> Result<ReduceTable, ProjectError> {
    table.only_in::<ReduceTable>(&[])?;
    let names = [ReductionMethod::CraigBampton, ReductionMethod::Guyan].map(ReductionMethod::name);
    let method = table.word("method", &names, ReductionMethod::from_name)?.unwrap_or(ReductionMethod::CraigBampton);
    let frequency = |key: &'static str| above_zero(table, key, "above 0 Hz");
    Ok(ReduceTable {
        method: method.name().to_owned(),
        up_to_hz: table.need("up_to_hz", "up_to_hz = 2000.0", frequency("up_to_hz")?)?,
        band_hz: frequency("band_hz")?,
        error: above_zero(table, "error", "above 0, such as 0.001 for 0.1 %")?,
        dofs: table.labels("dofs")?.unwrap_or_default().into_iter().map(Label).collect(),
    })
}

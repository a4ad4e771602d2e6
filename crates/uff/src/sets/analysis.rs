//! Data set 2414: analysis data at nodes, on elements, at nodes on elements or at points.

use super::elements::integers;
use super::function::identification;
use super::kinds::Kinds;
use super::rows::{Rows, read_rows};
use crate::body::Body;
use crate::error::{Error, Problem};
use crate::text::{decode, named};
use crate::values::Values;

/// Analysis data.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// What it says of itself.
    pub header: AnalysisHeader,
    /// The record before each row: node; or element and number of values; or element, expansion code, number of places,
    /// values a place (and order).
    pub labels: Vec<Vec<i64>>,
    /// Where the values of each row begin in [`Self::values`]; one entry more than rows.
    pub starts: Vec<usize>,
    /// All values, row after row.
    pub values: Values,
}

/// What analysis data says of itself before its values.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisHeader {
    /// Label of the data.
    pub label: i64,
    /// Name.
    pub name: String,
    /// 1 at nodes, 2 on elements, 3 at nodes on elements, 5 at points.
    pub location: i64,
    /// Five lines of text; empty where the file says `NONE`.
    pub id: [String; 5],
    /// 0 unknown, 1 structural, 2 heat transfer, 3 fluid flow.
    pub model: i64,
    /// As in [`crate::ShapeHeader::analysis`]; 9 static non-linear.
    pub analysis: i64,
    /// As in [`crate::ShapeHeader::characteristic`].
    pub characteristic: i64,
    /// Result type: 8 displacement, 11 velocity, 12 acceleration and others.
    pub quantity: i64,
    /// 1 whole numbers, 2 and 4 real, 5 and 6 complex.
    pub data_type: i64,
    /// Values at each node.
    pub per_node: usize,
    /// Whole numbers of the analysis: design set, iteration, solution set, boundary condition, load set, mode number, time
    /// step, frequency number, creation option, number retained.
    pub integers: Vec<i64>,
    /// Real numbers of the analysis: time, frequency, eigenvalue, modal mass, viscous and hysteretic damping ratio,
    /// eigenvalue (re, im), modal A (re, im), modal B (re, im).
    pub reals: Vec<f64>,
}

impl AnalysisHeader {
    /// Whether the values are complex.
    pub fn complex(&self) -> bool {
        matches!(self.data_type, 5 | 6)
    }

    /// Frequency, Hz, where it is stated.
    pub fn frequency(&self) -> Option<f64> {
        let stated = self.reals.get(1).copied().filter(|&f| f != 0.0);
        stated.or_else(|| self.eigenvalue().map(|[re, im]| re.hypot(im) / std::f64::consts::TAU))
    }

    /// Damping ratio: viscous, else half the hysteretic one, else that of the eigenvalue, where it is stated.
    pub fn damping_ratio(&self) -> Option<f64> {
        let stated_real = |i: usize| self.reals.get(i).copied().filter(|&x| x != 0.0);
        let of_eigenvalue = || self.eigenvalue().map(|[re, im]| -re / re.hypot(im));
        stated_real(4).or_else(|| stated_real(5).map(|hysteretic| hysteretic / 2.0)).or_else(of_eigenvalue)
    }

    /// Complex eigenvalue, rad/s, `[re, im]`, where it is stated.
    pub fn eigenvalue(&self) -> Option<[f64; 2]> {
        let value = [*self.reals.get(6)?, *self.reals.get(7)?];
        (value != [0.0, 0.0]).then_some(value)
    }

    /// Modal mass.
    pub fn modal_mass(&self) -> Option<f64> {
        self.reals.get(3).copied().filter(|&mass| mass != 0.0)
    }
}

impl Analysis {
    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        let header = read_header(body)?;
        let parts = 1 + usize::from(header.complex());
        let at_nodes = header.per_node * parts;
        let label = |labels: &[i64], i: usize| labels.get(i).and_then(|&n| usize::try_from(n).ok()).unwrap_or(0);
        let (location, width) = match header.location {
            1 => (1, 1),
            2 => (2, 2),
            location => (location, 4),
        };
        let Rows { labels, numbers, starts } = read_rows(body, width, |labels| match location {
            1 => at_nodes,
            2 => label(labels, 1).saturating_mul(parts),
            _ => {
                let places = if label(labels, 1) == 2 { 1 } else { label(labels, 2) };
                places.saturating_mul(label(labels, 3)).saturating_mul(parts)
            }
        })?;
        let starts = starts.into_iter().map(|start| start / parts).collect();
        Ok(Self { values: Values::from_numbers(numbers, header.complex()), header, labels, starts })
    }

    /// Values of row `i`, `[re, im]` each.
    pub fn row(&self, i: usize) -> Vec<[f64; 2]> {
        (self.starts[i]..self.starts[i + 1]).filter_map(|k| self.values.get(k)).collect()
    }
}

/// Reads records 1 to 13.
pub(crate) fn read_header(body: &mut Body<'_>) -> Result<AnalysisHeader, Error> {
    let label = first_integer(body, "record 1 (label)")?;
    let name = named(&decode(body.required("record 2 (name)")?.bytes));
    let location = first_integer(body, "record 3 (location)")?;
    let id = identification(body)?;
    let Kinds { model, analysis, characteristic, quantity, data_type, per_node } = Kinds::read(body, &[1, 2, 4, 5, 6])?;
    let mut numbers = Vec::new();
    for record in ["record 10 (whole numbers)", "record 11 (whole numbers)"] {
        let line = body.required(record)?;
        numbers.extend(integers(body, line)?);
    }
    let reals = body.reals(12)?;
    Ok(AnalysisHeader {
        label,
        name,
        location,
        id,
        model,
        analysis,
        characteristic,
        quantity,
        data_type,
        per_node,
        integers: numbers,
        reals,
    })
}

fn first_integer(body: &mut Body<'_>, record: &'static str) -> Result<i64, Error> {
    let line = body.required(record)?;
    integers(body, line)?
        .first()
        .copied()
        .ok_or_else(|| body.error(line, Problem::Short { record, needed: 1, found: 0 }))
}

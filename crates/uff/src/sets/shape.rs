//! Data set 55: data at nodes, such as mode shapes and operating shapes.

use super::function::identification;
use super::kinds::Kinds;
use super::rows::{Rows, read_rows};
use crate::body::Body;
use crate::error::{Error, Problem};
use crate::values::Values;

/// Data at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// What it says of itself.
    pub header: ShapeHeader,
    /// Labels of the nodes.
    pub nodes: Vec<i64>,
    /// `per_node` values a node, node after node.
    pub values: Values,
}

/// What a shape says of itself before its values.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeHeader {
    /// Five lines of text; empty where the file says `NONE`.
    pub id: [String; 5],
    /// 0 unknown, 1 structural, 2 heat transfer, 3 fluid flow.
    pub model: i64,
    /// 0 unknown, 1 static, 2 normal mode, 3 complex mode (first order), 4 transient, 5 frequency response, 6 buckling,
    /// 7 complex mode (second order).
    pub analysis: i64,
    /// 1 scalar, 2 three translations, 3 translations and rotations, 4 symmetric tensor, 5 general tensor.
    pub characteristic: i64,
    /// What the values are: 8 displacement, 11 velocity, 12 acceleration and others.
    pub quantity: i64,
    /// Whether the values are complex.
    pub complex: bool,
    /// Values at each node.
    pub per_node: usize,
    /// Whole numbers of the analysis: load case, and mode or step number.
    pub integers: Vec<i64>,
    /// Real numbers of the analysis: see [`Self::frequency`] and its neighbours.
    pub reals: Vec<f64>,
}

impl ShapeHeader {
    /// Frequency, Hz: of a normal mode or a line of a response as stated, of a complex mode `|eigenvalue| / 2 pi`.
    pub fn frequency(&self) -> Option<f64> {
        match self.analysis {
            2 | 5 => self.reals.first().copied(),
            3 | 7 => self.eigenvalue().map(|[re, im]| re.hypot(im) / std::f64::consts::TAU),
            _ => None,
        }
    }

    /// Damping ratio: of a normal mode as stated (viscous, else half the hysteretic one), of a complex mode
    /// `-re / |eigenvalue|`.
    pub fn damping_ratio(&self) -> Option<f64> {
        match self.analysis {
            2 => {
                let viscous = self.reals.get(2).copied().filter(|&ratio| ratio != 0.0);
                viscous.or_else(|| self.reals.get(3).map(|hysteretic| hysteretic / 2.0))
            }
            3 | 7 => self.eigenvalue().filter(|[re, im]| re.hypot(*im) > 0.0).map(|[re, im]| -re / re.hypot(im)),
            _ => None,
        }
    }

    /// Eigenvalue of a complex mode, rad/s, `[re, im]`.
    pub fn eigenvalue(&self) -> Option<[f64; 2]> {
        let complex = matches!(self.analysis, 3 | 7) && self.reals.len() >= 2;
        complex.then(|| [self.reals[0], self.reals[1]])
    }

    /// Modal mass of a normal mode.
    pub fn modal_mass(&self) -> Option<f64> {
        self.reals.get(1).copied().filter(|_| self.analysis == 2)
    }
}

impl Shape {
    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        let header = read_header(body)?;
        let row = header.per_node * (1 + usize::from(header.complex));
        let Rows { labels, numbers, .. } = read_rows(body, 1, |_| row)?;
        let nodes = labels.into_iter().map(|labels| labels[0]).collect();
        Ok(Self { nodes, values: Values::from_numbers(numbers, header.complex), header })
    }

    /// Values at node number `i` of [`Self::nodes`], `[re, im]` each.
    pub fn at(&self, i: usize) -> Vec<[f64; 2]> {
        let per_node = self.header.per_node;
        (i * per_node..(i + 1) * per_node).filter_map(|k| self.values.get(k)).collect()
    }
}

/// Reads records 1 to 8.
pub(crate) fn read_header(body: &mut Body<'_>) -> Result<ShapeHeader, Error> {
    let id = identification(body)?;
    let Kinds { model, analysis, characteristic, quantity, data_type, per_node } = Kinds::read(body, &[2, 4, 5, 6])?;
    let complex = matches!(data_type, 5 | 6);
    let (integers, reals) = parameters(body)?;
    Ok(ShapeHeader { id, model, analysis, characteristic, quantity, complex, per_node, integers, reals })
}

/// Records 7 and 8: how many whole and real numbers, the whole numbers, the real numbers.
fn parameters(body: &mut Body<'_>) -> Result<(Vec<i64>, Vec<f64>), Error> {
    let record = "record 7 (parameters of the analysis)";
    let line = body.required(record)?;
    let mut numbers = super::elements::integers(body, line)?;
    let counts: Vec<usize> = numbers.iter().take(2).filter_map(|&n| usize::try_from(n).ok()).collect();
    let [whole, real] = counts[..] else {
        return Err(body.error(line, Problem::Short { record, needed: 2, found: counts.len() }));
    };
    let mut numbers = numbers.split_off(2);
    while numbers.len() < whole {
        let Some(line) = body.line() else {
            return Err(body.error_here(Problem::Short { record, needed: 2 + whole, found: 2 + numbers.len() }));
        };
        numbers.extend(super::elements::integers(body, line)?);
    }
    let reals = body.reals(real)?;
    if reals.len() < real {
        let record = "record 8 (real parameters)";
        return Err(body.error_here(Problem::Short { record, needed: real, found: reals.len() }));
    }
    Ok((numbers, reals))
}

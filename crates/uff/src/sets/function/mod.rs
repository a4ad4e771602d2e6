//! Data set 58: functions at nodal DOFs, as text or binary.

mod data;
mod header;
mod kind;
mod named;

pub use header::{Axis, Binary, ByteOrder, FunctionHeader};
pub(crate) use header::{identification, read as read_header};
pub use kind::FunctionKind;

use crate::body::Body;
use crate::dof::Dof;
use crate::error::Error;
use crate::values::Values;

/// A function with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// All that it says of itself. `count` is what the header says; `values` are those that are there.
    pub header: FunctionHeader,
    /// Abscissas where they are uneven, one a value.
    pub uneven: Option<Vec<f64>>,
    /// Ordinates.
    pub values: Values,
}

impl Function {
    /// A function in double precision with abscissas `start + i step`, to be written as text.
    pub fn even(kind: FunctionKind, response: Dof, reference: Dof, start: f64, step: f64, values: Values) -> Self {
        let header = FunctionHeader {
            id: Default::default(),
            kind,
            number: 0,
            version: 0,
            load_case: 0,
            response,
            reference,
            complex: values.is_complex(),
            double: true,
            count: values.len() as u64,
            even: true,
            start,
            step,
            z: 0.0,
            abscissa: Axis::default(),
            ordinate: Axis::default(),
            denominator: Axis::default(),
            z_axis: Axis::default(),
            binary: None,
        };
        Self { header, uneven: None, values }
    }

    /// A function in double precision with an abscissa for each value, to be written as text.
    pub fn uneven(kind: FunctionKind, response: Dof, reference: Dof, abscissas: Vec<f64>, values: Values) -> Self {
        let mut function = Self::even(kind, response, reference, 0.0, 0.0, values);
        function.header.even = false;
        function.uneven = Some(abscissas);
        function
    }

    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        let header = header::read(body)?;
        let (uneven, values) =
            if header.binary.is_some() { data::binary(body, &header)? } else { data::text(body, &header)? };
        Ok(Self { header, uneven, values })
    }

    /// Abscissa of value `i`.
    pub fn abscissa(&self, i: usize) -> f64 {
        match &self.uneven {
            Some(abscissas) => abscissas.get(i).copied().unwrap_or(f64::NAN),
            None => self.header.start + i as f64 * self.header.step,
        }
    }

    /// Abscissas of all values.
    pub fn abscissas(&self) -> Vec<f64> {
        (0..self.values.len()).map(|i| self.abscissa(i)).collect()
    }
}

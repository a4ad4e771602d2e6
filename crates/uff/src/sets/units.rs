//! Data set 164: the units of a file.

use crate::body::Body;
use crate::error::{Error, Problem};
use crate::fields::{self, Kind, Layout};

/// Units: a value of the file divided by its factor is in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    /// 1 SI (m, N), 2 foot and pound, 3 m and kgf, 4 foot and poundal, 5 mm and mN, 6 cm and cN, 7 inch and pound,
    /// 8 mm and kgf, 9 of the user's own.
    pub code: i64,
    /// Name of the system.
    pub description: String,
    /// 1 absolute, 2 relative temperature; 0 if it is not said.
    pub temperature_mode: i64,
    /// Length factor: lengths of the file divided by it are m.
    pub length: f64,
    /// Force factor: forces of the file divided by it are N.
    pub force: f64,
    /// Temperature factor: differences of the file divided by it are K.
    pub temperature: f64,
    /// Offset of the temperature.
    pub temperature_offset: f64,
}

impl Units {
    /// SI units.
    pub fn si() -> Self {
        Self {
            code: 1,
            description: "SI: Meter (newton)".to_string(),
            temperature_mode: 2,
            length: 1.0,
            force: 1.0,
            temperature: 1.0,
            temperature_offset: 273.15,
        }
    }

    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        const UNITS: Layout = Layout {
            record: "record 1 (units)",
            columns: &[
                ("units code", 10, Kind::Integer),
                ("description", 20, Kind::Text),
                ("temperature mode", 10, Kind::Integer),
            ],
            required: 1,
        };
        const NEEDED: usize = 3;
        let line = body.required(UNITS.record)?;
        let fields = fields::read(body, line, &UNITS)?;
        let factors = body.reals(4)?;
        if factors.len() < NEEDED {
            let problem = Problem::Short { record: "record 2 (factors)", needed: NEEDED, found: factors.len() };
            return Err(body.error_here(problem));
        }
        Ok(Self {
            code: fields.integer(0),
            description: fields.text(1).to_string(),
            temperature_mode: fields.integer(2),
            length: factors[0],
            force: factors[1],
            temperature: factors[2],
            temperature_offset: factors.get(3).copied().unwrap_or(0.0),
        })
    }
}

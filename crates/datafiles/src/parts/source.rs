//! Reads complex channels out of two real ones.

use crate::error::{Fault, Read};
use crate::source::Source;
use uff::Values;

/// How two real numbers make a complex one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Conversion {
    Cartesian,
    /// `decibel`: the magnitude at 0 dB, where the magnitude is a level.
    Polar {
        decibel: Option<f64>,
        to_radians: f64,
    },
}

impl Conversion {
    pub(super) fn of(self, a: f64, b: f64) -> [f64; 2] {
        match self {
            Self::Cartesian => [a, b],
            Self::Polar { decibel, to_radians } => {
                let size = decibel.map_or(a, |reference| reference * 10_f64.powf(a / 20.0));
                let (sin, cos) = (b * to_radians).sin_cos();
                [size * cos, size * sin]
            }
        }
    }
}

/// A channel by those of the source below.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Column {
    Plain(usize),
    Pair([usize; 2], Conversion),
    /// A column whose abscissa is another.
    WithAxis(Box<Column>, usize),
}

/// A source some of whose columns are joined.
pub(crate) struct Joined {
    below: Box<dyn Source>,
    columns: Vec<Vec<Column>>,
}

impl Joined {
    pub(super) fn new(below: Box<dyn Source>, columns: Vec<Vec<Column>>) -> Self {
        Self { below, columns }
    }

    fn column(&self, set: usize, channel: usize) -> Read<&Column> {
        let column = self.columns.get(set).and_then(|set| set.get(channel));
        column.ok_or_else(|| Fault::new("there is no such column"))
    }

    fn real(&self, set: usize, column: usize) -> Read<Vec<f64>> {
        match self.below.read(set, column)? {
            Values::Real(values) => Ok(values),
            Values::Complex(_) => Err(Fault::new("is complex already, and cannot be a part of a complex number")),
        }
    }

    fn values(&self, set: usize, column: &Column) -> Read<Values> {
        match column {
            Column::Plain(at) => self.below.read(set, *at),
            Column::WithAxis(inner, _) => self.values(set, inner),
            Column::Pair([a, b], conversion) => {
                let (a, b) = (self.real(set, *a)?, self.real(set, *b)?);
                if a.len() != b.len() {
                    let problem =
                        format!("one part has {} values and the other {}; export both whole", a.len(), b.len());
                    return Err(Fault::new(problem));
                }
                Ok(Values::Complex(a.into_iter().zip(b).map(|(a, b)| conversion.of(a, b)).collect()))
            }
        }
    }
}

impl Source for Joined {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        self.values(set, self.column(set, channel)?)
    }

    fn together(&self, set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        let below = |&channel: &usize| {
            let mut column = self.column(set, channel).ok()?;
            while let Column::WithAxis(inner, _) = column {
                column = inner;
            }
            if let Column::Plain(at) = column { Some(*at) } else { None }
        };
        let below: Vec<usize> = channels.iter().map(below).collect::<Option<_>>()?;
        self.below.together(set, &below)
    }

    fn axis(&self, set: usize, channel: usize) -> Read<Vec<f64>> {
        match self.column(set, channel)? {
            Column::Plain(at) | Column::Pair([at, _], _) => self.below.axis(set, *at),
            Column::WithAxis(_, axis) => self.real(set, *axis),
        }
    }
}

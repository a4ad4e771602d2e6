//! A channel of a file as a small plot.

use crate::display::format::pretty_unit;
use crate::plots::figure::{Axis, Data, Figure, Look};
use crate::plots::pyramid::Pyramid;
use crate::plots::style::Palette;
use dashpot_datafiles::{DataFile, Kind, Values};
use std::sync::Arc;

/// Most values of a channel that are read for a picture of it.
const MOST: u64 = 1 << 24;

/// What is drawn.
#[derive(Debug, Clone)]
pub struct Preview {
    name: String,
    /// Name and unit of the abscissa.
    across: (String, String),
    unit: String,
    drawn: Drawn,
}

#[derive(Debug, Clone)]
enum Drawn {
    Samples(Arc<Pyramid>),
    /// Magnitudes over frequency.
    Magnitudes(Vec<[f64; 2]>),
}

impl Preview {
    /// Reads a channel; long work.
    ///
    /// # Errors
    /// One line, where it cannot be read or drawn.
    pub fn of(file: &DataFile, set: usize, channel: usize) -> Result<Self, String> {
        let (entry, of) = (&file.contents().sets[set].channels[channel], &file.contents().sets[set]);
        if entry.count > MOST {
            return Err(format!(
                "{} values are too many to be drawn here; they are imported all the same.",
                entry.count
            ));
        }
        let values = file.read(set, channel).map_err(|e| e.to_string())?;
        let axis = file.axis(set, channel).map_err(|e| e.to_string())?;
        let across = match (&axis, of.axis_unit.as_str()) {
            (None, _) => ("Number".to_owned(), String::new()),
            (_, "s") => ("Time".to_owned(), "s".to_owned()),
            (_, "Hz") => ("Frequency".to_owned(), "Hz".to_owned()),
            (_, unit) => ("Abscissa".to_owned(), unit.to_owned()),
        };
        let axis = axis.unwrap_or_else(|| (0..values.len()).map(|i| i as f64).collect());
        let drawn = match (values, of.kind) {
            (Values::Complex(values), _) => {
                let size = |(x, [re, im]): (&f64, &[f64; 2])| [*x, re.hypot(*im)];
                Drawn::Magnitudes(axis.iter().zip(&values).map(size).filter(|p| p[1] > 0.0).collect())
            }
            (Values::Real(values), Kind::Spectrum) if values.iter().all(|value| *value >= 0.0) => {
                Drawn::Magnitudes(axis.iter().zip(&values).map(|(x, y)| [*x, *y]).filter(|p| p[1] > 0.0).collect())
            }
            (Values::Real(values), _) => {
                let rising = axis.windows(2).all(|pair| pair[1] > pair[0]);
                if !rising || values.iter().any(|value| !value.is_finite()) {
                    return Err("Its values are not in the order of the abscissa, or not all are numbers.".to_owned());
                }
                Drawn::Samples(Arc::new(Pyramid::new(&axis, &values)))
            }
        };
        Ok(Self { name: entry.name.clone(), across, unit: pretty_unit(&entry.unit), drawn })
    }

    /// The plot.
    pub fn figure(&self, palette: &Palette) -> Figure {
        let x = Axis::new(&self.across.0, &self.across.1);
        let name = if self.name.chars().count() > 24 { "Value" } else { self.name.as_str() };
        match &self.drawn {
            Drawn::Samples(pyramid) => Figure::new(&self.name, x, Axis::new(name, &self.unit)).with(
                "",
                palette.measured,
                Look::Line(1.2),
                Data::Record(Arc::clone(pyramid)),
            ),
            Drawn::Magnitudes(points) => Figure::new(&self.name, x, Axis::log(name, &self.unit)).points(
                "",
                palette.measured,
                Look::Line(1.3),
                points.clone(),
            ),
        }
    }
}

//! Scalings that NI software keeps as properties: from raw values to those of the unit.

use super::objects::Property;
use crate::error::one_line;

/// Most scales of a channel.
const MOST: usize = 64;
const RAW: u32 = u32::MAX;

/// Scales, each on the raw values or on another's result; the last gives the values.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Scaling {
    scales: Vec<Scale>,
}

#[derive(Debug, Clone, PartialEq)]
enum Scale {
    /// Raw values.
    Raw,
    /// `sum c_k x^k` of another scale's result.
    Polynomial(u32, Vec<f64>),
    /// Between points of a table: scaled values over raw ones.
    Table(u32, Vec<[f64; 2]>),
    /// Sum or difference `right - left` of two results.
    Add(u32, u32),
    Subtract(u32, u32),
}

impl Scaling {
    /// The scaling among properties: none where there is none, or the values are scaled already.
    pub(super) fn read(properties: &[(String, Property)]) -> Option<Result<Self, String>> {
        let find = |name: &str| properties.iter().find(|(other, _)| other == name).map(|(_, value)| value);
        let stated = find("NI_Number_Of_Scales").and_then(Property::number);
        let count = stated.map_or(usize::from(find("NI_Scale[0]_Scale_Type").is_some()), |count| count as usize);
        if count == 0 || matches!(find("NI_Scaling_Status"), Some(Property::Text(status)) if status == "scaled") {
            return None;
        }
        if count > MOST {
            return Some(Err(format!("it states {count} scales; the file is damaged")));
        }
        let scales = (0..count).map(|i| scale(i, &find)).collect();
        Some(Result::map(scales, |scales| Self { scales }))
    }

    /// Scales raw values in place.
    pub(super) fn apply(&self, values: &mut [f64]) {
        if self.scales.is_empty() {
            return;
        }
        for value in values {
            *value = self.value(*value, self.scales.len() as u32 - 1, 0);
        }
    }

    fn value(&self, raw: f64, scale: u32, depth: usize) -> f64 {
        let Some(found) = self.scales.get(scale as usize).filter(|_| scale != RAW && depth <= MOST) else { return raw };
        match found {
            Scale::Raw => raw,
            Scale::Polynomial(source, coefficients) => {
                let x = self.value(raw, *source, depth + 1);
                coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
            }
            Scale::Table(source, points) => between(points, self.value(raw, *source, depth + 1)),
            Scale::Add(left, right) => self.value(raw, *left, depth + 1) + self.value(raw, *right, depth + 1),
            Scale::Subtract(left, right) => self.value(raw, *right, depth + 1) - self.value(raw, *left, depth + 1),
        }
    }
}

fn scale<'a>(i: usize, find: &impl Fn(&str) -> Option<&'a Property>) -> Result<Scale, String> {
    let number = |word: &str| find(&format!("NI_Scale[{i}]_{word}")).and_then(Property::number);
    let source = |word: &str| number(word).map_or(RAW, |source| source as u32);
    let missing = |word: &str| format!("its scale {i} has no {word}; export it again as scaled values");
    // Scales without a type are the raw channels of NI-DAQmx.
    let Some(Property::Text(kind)) = find(&format!("NI_Scale[{i}]_Scale_Type")) else { return Ok(Scale::Raw) };
    let list = |words: &str, size: &str| -> Result<Vec<f64>, String> {
        let count = number(size).ok_or_else(|| missing(size))? as usize;
        (0..count.min(100_000)).map(|k| number(&format!("{words}[{k}]")).ok_or_else(|| missing(words))).collect()
    };
    match kind.as_str() {
        "Linear" => {
            let slope = number("Linear_Slope").ok_or_else(|| missing("slope"))?;
            let offset = number("Linear_Y_Intercept").ok_or_else(|| missing("intercept"))?;
            Ok(Scale::Polynomial(source("Linear_Input_Source"), vec![offset, slope]))
        }
        "Polynomial" => {
            let coefficients = list("Polynomial_Coefficients", "Polynomial_Coefficients_Size")?;
            Ok(Scale::Polynomial(source("Polynomial_Input_Source"), coefficients))
        }
        "Table" => {
            let raw = list("Table_Pre_Scaled_Values", "Table_Pre_Scaled_Values_Size")?;
            let scaled = list("Table_Scaled_Values", "Table_Scaled_Values_Size")?;
            // The names are from the view of an output: what is scaled is the input here.
            let mut points: Vec<[f64; 2]> = scaled.into_iter().zip(raw).map(|(x, y)| [x, y]).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            Ok(Scale::Table(source("Table_Input_Source"), points))
        }
        "Add" => Ok(Scale::Add(source("Add_Left_Operand_Input_Source"), source("Add_Right_Operand_Input_Source"))),
        "Subtract" => Ok(Scale::Subtract(
            source("Subtract_Left_Operand_Input_Source"),
            source("Subtract_Right_Operand_Input_Source"),
        )),
        "AdvancedAPI" => Ok(Scale::Polynomial(source("AdvancedAPI_Input_Source"), vec![0.0, 1.0])),
        other => Err(format!("its scale \"{}\" is not known; export it again as scaled values", one_line(other, 40))),
    }
}

fn between(points: &[[f64; 2]], x: f64) -> f64 {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return f64::NAN };
    if x <= first[0] {
        return first[1];
    }
    let at = points.partition_point(|point| point[0] < x);
    match points.get(at) {
        None => last[1],
        Some(right) => {
            let left = points[at - 1];
            left[1] + (x - left[0]) / (right[0] - left[0]) * (right[1] - left[1])
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn scales_follow_each_other() {
        let text = |text: &str| Property::Text(text.to_owned());
        let number = Property::Number;
        let properties = [
            ("NI_Number_Of_Scales", number(3.0)),
            ("NI_Scale[1]_Scale_Type", text("Polynomial")),
            ("NI_Scale[1]_Polynomial_Coefficients_Size", number(3.0)),
            ("NI_Scale[1]_Polynomial_Coefficients[0]", number(1.0)),
            ("NI_Scale[1]_Polynomial_Coefficients[1]", number(2.0)),
            ("NI_Scale[1]_Polynomial_Coefficients[2]", number(0.5)),
            ("NI_Scale[1]_Polynomial_Input_Source", number(0.0)),
            ("NI_Scale[2]_Scale_Type", text("Linear")),
            ("NI_Scale[2]_Linear_Slope", number(10.0)),
            ("NI_Scale[2]_Linear_Y_Intercept", number(-1.0)),
            ("NI_Scale[2]_Linear_Input_Source", number(1.0)),
        ]
        .map(|(name, value)| (name.to_owned(), value));
        let mut values = [2.0];
        Scaling::read(&properties).unwrap().unwrap().apply(&mut values);
        assert_eq!(values, [10.0 * (1.0 + 4.0 + 2.0) - 1.0]);
    }
}

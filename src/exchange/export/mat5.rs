//! MATLAB level 5 files, uncompressed, as specified in The MathWorks' *MAT-File Format*: a 128-byte header, then tagged
//! elements padded to 8 bytes.
//!
//! Variables: `C` (N s/m), `C_equivalent`, one matrix for each other law (`C_coulomb`), `dof_labels`, `energy_percent`,
//! `frequency_hz`, `damping_ratio`, and the struct array `sources`.

use super::files::Export;
use super::identified::Identified;
use faer::Mat;
use std::path::Path;

const MI_INT8: u32 = 1;
const MI_UINT16: u32 = 4;
const MI_INT32: u32 = 5;
const MI_UINT32: u32 = 6;
const MI_DOUBLE: u32 = 9;
const MI_MATRIX: u32 = 14;

const CLASS_CELL: u32 = 1;
const CLASS_STRUCT: u32 = 2;
const CLASS_CHAR: u32 = 4;
const CLASS_DOUBLE: u32 = 6;

/// Longest field name with its closing zero.
const FIELD_NAME_LENGTH: usize = 32;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let mut bytes = header();
    bytes.extend(matrix("C", identified.viscous));
    bytes.extend(matrix("C_equivalent", identified.equivalent));
    for (effect, values) in identified.others {
        bytes.extend(matrix(&format!("C_{effect}"), values));
    }
    let labels: Vec<&str> = identified.structure.dofs().iter().map(|dof| dof.label.as_str()).collect();
    let cells: Vec<Vec<u8>> = labels.iter().map(|label| text("", label)).collect();
    bytes.extend(array(CLASS_CELL, [labels.len(), 1], "dof_labels", &cells.concat()));
    bytes.extend(column("energy_percent", identified.energy_percent));
    let frequencies: Vec<f64> = identified.modes.iter().map(|mode| mode.frequency_hz).collect();
    let ratios: Vec<f64> = identified.modes.iter().map(|mode| mode.damping_ratio).collect();
    bytes.extend(column("frequency_hz", &frequencies));
    bytes.extend(column("damping_ratio", &ratios));
    bytes.extend(sources(identified));
    let mut export = Export::default();
    export.add(path.to_owned(), bytes);
    export
}

/// 116 bytes of text without a date (the same result gives the same file), version 0x0100, little endian.
fn header() -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file, written by Dashpot".to_vec();
    bytes.resize(116, b' ');
    bytes.extend([0; 8]);
    bytes.extend([0x00, 0x01, b'I', b'M']);
    bytes
}

fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend(u32::try_from(data.len()).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn array(class: u32, size: [usize; 2], name: &str, contents: &[u8]) -> Vec<u8> {
    let flags: Vec<u8> = [class, 0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let dimensions: Vec<u8> = size.iter().flat_map(|&v| (v as u32).to_le_bytes()).collect();
    let mut body = element(MI_UINT32, &flags);
    body.extend(element(MI_INT32, &dimensions));
    body.extend(element(MI_INT8, name.as_bytes()));
    body.extend(contents);
    element(MI_MATRIX, &body)
}

fn doubles(values: impl Iterator<Item = f64>) -> Vec<u8> {
    let data: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
    element(MI_DOUBLE, &data)
}

/// Column-major, as MATLAB stores it.
fn matrix(name: &str, values: &Mat<f64>) -> Vec<u8> {
    let (rows, columns) = (values.nrows(), values.ncols());
    let data = (0..columns).flat_map(|j| (0..rows).map(move |i| values[(i, j)]));
    array(CLASS_DOUBLE, [rows, columns], name, &doubles(data))
}

fn column(name: &str, values: &[f64]) -> Vec<u8> {
    array(CLASS_DOUBLE, [values.len(), 1], name, &doubles(values.iter().copied()))
}

fn text(name: &str, value: &str) -> Vec<u8> {
    let units: Vec<u16> = value.encode_utf16().collect();
    let data: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
    array(CLASS_CHAR, [usize::from(!units.is_empty()), units.len()], name, &element(MI_UINT16, &data))
}

/// Struct array with the fields `law`, `place`, `parameters`, `values`, `standard_deviation`, `energy_percent`.
fn sources(identified: &Identified) -> Vec<u8> {
    const FIELDS: [&str; 6] = ["law", "place", "parameters", "values", "standard_deviation", "energy_percent"];
    let length = u32::try_from(FIELD_NAME_LENGTH).unwrap_or(u32::MAX).to_le_bytes();
    // A small element: its length in the upper half of the tag, its data in place of the padding.
    let mut contents: Vec<u8> = (4_u32 << 16 | MI_INT32).to_le_bytes().to_vec();
    contents.extend(length);
    let names: Vec<u8> = FIELDS
        .iter()
        .flat_map(|field| {
            let mut name = field.as_bytes().to_vec();
            name.resize(FIELD_NAME_LENGTH, 0);
            name
        })
        .collect();
    contents.extend(element(MI_INT8, &names));
    for found in identified.sources {
        let parameters: Vec<&str> = found.source.effect.parameters().iter().map(|p| p.name).collect();
        contents.extend(text("", found.source.effect.name()));
        contents.extend(text("", &found.source.place.exported(identified.structure)));
        contents.extend(text("", &parameters.join(" ")));
        contents.extend(column("", &found.source.parameters));
        contents.extend(column("", &found.deviation));
        contents.extend(column("", &[found.energy_percent]));
    }
    array(CLASS_STRUCT, [identified.sources.len(), 1], "sources", &contents)
}

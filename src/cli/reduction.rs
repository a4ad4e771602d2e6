//! What is told of an imported structure: notes of its files, and how a model was reduced.

use super::table::{significant, table};
use crate::structure::Structure;
use crate::structure::reduction::{ModeCheck, Reduction};
use serde_json::{Value, json};

/// Modes that are listed in text; `--json` has all.
const MOST_MODES: usize = 10;

/// Notes of the files, each a warning on standard error.
pub(super) fn warn(structure: &Structure) {
    for note in &structure.origin().notes {
        eprintln!("warning: {note}");
    }
}

/// Key `reduction`, null where nothing was reduced.
pub(super) fn document(structure: &Structure) -> Value {
    let Some(reduction) = &structure.origin().reduction else { return Value::Null };
    let Reduction { wanted, from_dofs, kept, fixed_interface_modes, modes, .. } = reduction;
    let mode = |check: &ModeCheck| {
        json!({"full_hz": check.full_hz, "reduced_hz": check.reduced_hz,
               "frequency_error": check.frequency_error(), "mac": check.mac})
    };
    json!({"method": wanted.method.name(), "from_dofs": from_dofs, "kept_dofs": kept,
           "fixed_interface_modes": fixed_interface_modes, "up_to_hz": wanted.up_to_hz, "band_hz": wanted.band_hz,
           "worst_frequency_error": reduction.worst().map(ModeCheck::frequency_error),
           "modes": modes.iter().map(mode).collect::<Vec<_>>()})
}

/// The reduction and its error, mode by mode; empty where nothing was reduced.
pub(super) fn text(structure: &Structure) -> String {
    let Some(reduction) = &structure.origin().reduction else { return String::new() };
    let head = ["mode", "whole model Hz", "reduced Hz", "error %", "MAC"].map(str::to_owned).to_vec();
    let row = |(r, check): (usize, &ModeCheck)| {
        let percent = format!("{:.1e}", 100.0 * check.frequency_error());
        vec![
            (r + 1).to_string(),
            significant(check.full_hz, 6),
            significant(check.reduced_hz, 6),
            percent,
            significant(check.mac, 5),
        ]
    };
    let rows: Vec<_> =
        std::iter::once(head).chain(reduction.modes.iter().take(MOST_MODES).enumerate().map(row)).collect();
    format!("Model {}\n{}", reduction.sentence(), table(&rows))
}

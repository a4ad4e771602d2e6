//! Comments on channels below their names; units that stand within names, or once for all functions.

use super::header::Header;
use super::header_line::{COMMENT_WORDS, HeaderLine, label};
use crate::axis::unit_of_time;
use crate::parts::unit_of_part;
use crate::units::{is_unit, suffix};

impl Header {
    /// Comments in the row below the names are put behind these: `CH1-1` is `CH1-1 Force`.
    pub(super) fn comments(&mut self, below: Option<&HeaderLine>) {
        let Some(line) = below.filter(|line| COMMENT_WORDS.contains(&label(&line.cells[0]).as_str())) else { return };
        for (name, comment) in
            self.names.iter_mut().zip(&line.cells).skip(1).filter(|(_, cell)| !cell.trim().is_empty())
        {
            *name = format!("{name} {}", comment.trim()).trim().to_owned();
        }
    }

    /// Units behind a stroke, as DIN 461 has them (`F/N`, `t/s`), where most names have one; units in the last part of a name
    /// (`acc_mg`), which keeps it.
    pub(super) fn units_behind_names(&mut self) {
        let stroke = |name: &str| {
            let (front, unit) = name.split_once('/')?;
            let symbol = !front.is_empty() && front.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | ' '));
            (symbol && is_unit(unit)).then(|| (front.trim().to_owned(), unit.trim().to_owned()))
        };
        let bare = |c: usize| self.units[c].is_empty() && !self.names[c].is_empty();
        let all = (0..self.names.len()).filter(|&c| bare(c)).count();
        let with = (0..self.names.len()).filter(|&c| bare(c) && stroke(&self.names[c]).is_some()).count();
        for c in 0..self.names.len() {
            if !self.units[c].is_empty() {
                continue;
            }
            if with > 1
                && 2 * with > all
                && let Some((name, unit)) = stroke(&self.names[c])
            {
                (self.names[c], self.units[c]) = (name, unit);
            } else if let Some(unit) =
                suffix(&self.names[c]).map(|(_, unit)| unit).or_else(|| unit_of_time(&self.names[c]))
            {
                unit.clone_into(&mut self.units[c]);
            }
        }
    }

    /// Gives levels and parts of functions without a unit that of all functions.
    pub(super) fn take_unit_of_functions(&mut self, stated: &str) {
        for (name, unit) in self.names.iter().zip(&mut self.units) {
            let level = unit.eq_ignore_ascii_case("dB");
            let own = if level { "dB" } else { name };
            if (level || unit.is_empty())
                && let Some(of_part) = unit_of_part(own, &[stated.to_owned()])
            {
                *unit = of_part;
            }
        }
    }
}

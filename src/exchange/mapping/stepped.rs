//! Whether a table is that of a stepped-sine test, one row a run, and what its columns are proposed to be.

use super::amplitudes::{AmplitudeColumns, amplitudes, frequencies};
use crate::exchange::records::columns::{Role, role};
use crate::exchange::records::is_stepped_table;
use crate::measurement::Quantity;
use crate::measurement::channel::parse_name;
use dashpot_datafiles::{Channel, DataFile, Kind, Set, Values};

/// Share of the rows whose phases must tell which quantity they are of.
const CLEAR: f64 = 0.9;

/// A stepped-sine table.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepped {
    /// Key `force` of `[[harmonics]]`; none where the columns name their channels.
    pub force: Option<String>,
    /// Key `response`.
    pub response: Option<String>,
    /// Key `phase_of`.
    pub phase_of: Option<Quantity>,
    /// Labels of the DOFs.
    pub dofs: Vec<String>,
    /// Number of runs.
    pub rows: usize,
    /// Number of levels.
    pub levels: usize,
    /// Lowest and highest frequency, Hz.
    pub band_hz: [f64; 2],
    /// What was assumed.
    pub assumed: Vec<String>,
    /// Mapping and phases of a table that is no CSV in the project's own words; none of one that is.
    pub amplitudes: Option<AmplitudeColumns>,
}

impl Stepped {
    /// The table in words.
    pub fn words(&self) -> String {
        let [from, to] = self.band_hz.map(|f| (1e6 * f).round() / 1e6);
        let levels = if self.levels == 1 { "one level".to_owned() } else { format!("{} levels", self.levels) };
        format!("stepped sine, {} runs at {levels} from {from} to {to} Hz", self.rows)
    }
}

/// The stepped-sine table of a file, if it is one: columns with frequencies, amplitudes of force and motion, and phases.
pub fn stepped(file: &DataFile) -> Option<Stepped> {
    let sets = file.contents().sets.iter().enumerate();
    let mut tables = sets.filter(|(_, set)| matches!(set.kind, Kind::Table | Kind::Spectrum));
    let own = is_stepped_table(file.path());
    tables.find_map(|(s, set)| {
        let found = if own { of_set(file, s, set) } else { None };
        found.or_else(|| of_amplitudes(file, s, set))
    })
}

/// Labels, each once, in their order.
fn distinct<'a>(labels: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for label in labels {
        if !found.contains(label) {
            found.push(label.clone());
        }
    }
    found
}

/// The table of a set by the mapping of its columns.
fn of_amplitudes(file: &DataFile, s: usize, set: &Set) -> Option<Stepped> {
    let found = amplitudes(file.contents(), set)?;
    let frequencies = frequencies(file, s)?;
    let dofs = distinct(found.mapping.channels.iter().map(|table| &table.dof));
    Some(Stepped {
        force: None,
        response: None,
        phase_of: None,
        dofs,
        rows: frequencies.len(),
        levels: 1,
        band_hz: [
            frequencies.iter().copied().fold(f64::INFINITY, f64::min),
            frequencies.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ],
        assumed: Vec::new(),
        amplitudes: Some(found),
    })
}

/// A column: name with its unit, as the reader of harmonics sees it.
fn full_name(channel: &Channel) -> String {
    if channel.unit.is_empty() { channel.name.clone() } else { format!("{} [{}]", channel.name, channel.unit) }
}

fn of_set(file: &DataFile, s: usize, set: &Set) -> Option<Stepped> {
    let roles: Vec<Role> = set.channels.iter().map(|channel| role(&full_name(channel))).collect();
    let column = |wanted: fn(&Role) -> bool| roles.iter().position(wanted);
    let values = |c: usize| match file.read(s, c) {
        Ok(Values::Real(values)) => Some(values),
        _ => None,
    };
    let (phase, radians) = roles.iter().enumerate().find_map(|(c, role)| match role {
        Role::Phase(radians, _) => Some((c, *radians)),
        _ => None,
    })?;
    let frequencies = match column(|role| matches!(role, Role::Frequency(_))) {
        Some(c) => {
            let Role::Frequency(to_hz) = roles[c] else { return None };
            values(c)?.into_iter().map(|f| f * to_hz).collect()
        }
        // Ascending frequencies are the abscissa of the table.
        None if set.kind == Kind::Spectrum && set.axis_unit.eq_ignore_ascii_case("hz") => {
            file.axis(s, phase).ok()??
        }
        None => return None,
    };
    let levels = column(|role| *role == Role::Level).and_then(values).unwrap_or_default();
    let levels: std::collections::BTreeSet<u64> = levels.iter().map(|level| level.to_bits()).collect();
    let finite = || frequencies.iter().copied().filter(|f: &f64| f.is_finite());
    let mut stepped = Stepped {
        force: None,
        response: None,
        phase_of: None,
        dofs: Vec::new(),
        rows: frequencies.len(),
        levels: levels.len().max(1),
        band_hz: [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)],
        assumed: Vec::new(),
        amplitudes: None,
    };
    let named: Vec<(Quantity, String)> =
        set.channels.iter().filter_map(|channel| parse_name(&channel.name).ok()).collect();
    stepped.dofs = distinct(named.iter().map(|(_, label)| label));
    let mut responses = (0..roles.len()).filter(|&c| matches!(roles[c], Role::Response(..)));
    let (response, None) = (responses.next(), responses.next()) else { return None };
    let force = column(|role| matches!(role, Role::Force(_)));
    if force.is_none() && named.iter().all(|(quantity, _)| *quantity != Quantity::Force)
        || response.is_none() && named.iter().all(|(quantity, _)| *quantity == Quantity::Force)
    {
        return None;
    }
    if let Some(Role::Force(unit)) = force.map(|c| &roles[c]) {
        let label = stepped.first_dof();
        stepped.force = Some(format!("force@{label} [{}]", stepped.unit(unit.as_deref(), Quantity::Force, "force")));
    }
    if let Some(Role::Response(quantity, unit)) = response.map(|c| &roles[c]) {
        let label = stepped.first_dof();
        let measured = quantity.unwrap_or(Quantity::Acceleration);
        if quantity.is_none() {
            stepped.assumed.push("the table does not say what its response is: an acceleration is assumed".to_owned());
        }
        let unit = stepped.unit(unit.as_deref(), measured, "response");
        stepped.response = Some(format!("{}@{label} [{unit}]", measured.word()));
        let phases: Vec<f64> = values(phase)?.into_iter().map(|phase| phase * radians).collect();
        stepped.phase_of = phase_of(measured, &phases).filter(|of| *of != measured);
        if let Some(of) = stepped.phase_of {
            stepped.assumed.push(format!(
                "at a driving point the phases can only be those of the {}: that is assumed",
                if of == Quantity::Displacement { "displacement" } else { "acceleration" }
            ));
        }
    }
    Some(stepped)
}

impl Stepped {
    /// The first DOF that is named, else DOF 1 as assumed.
    fn first_dof(&mut self) -> String {
        if self.dofs.is_empty() {
            self.dofs.push("1".to_owned());
            self.assumed
                .push("the table names no DOF: force and response are taken to be at one point, DOF 1".to_owned());
        }
        self.dofs[0].clone()
    }

    /// The unit of a column as records write it; SI, as assumed, where it says none.
    fn unit(&mut self, named: Option<&str>, quantity: Quantity, what: &str) -> String {
        let own = named.and_then(crate::measurement::channel::Unit::from_name);
        if let Some(unit) = own.filter(|unit| unit.quantity == quantity) {
            return unit.name.to_owned();
        }
        let si = quantity.si_unit(false);
        self.assumed.push(match named {
            Some(named) => {
                format!("the unit {named} of the {what} is none of those of records: convert it; {si} stands there")
            }
            None => format!("the table says no unit of the {what}: {si} is assumed"),
        });
        si.to_owned()
    }
}

/// Which quantity the phases are of, at a driving point: a displacement lags behind its force, an acceleration leads it. None
/// where they do not tell.
fn phase_of(measured: Quantity, phases: &[f64]) -> Option<Quantity> {
    let share = |lags: bool| {
        let alike = phases.iter().filter(|phase| phase.is_finite() && (phase.sin() < 0.0) == lags).count();
        alike as f64 / phases.len().max(1) as f64
    };
    match measured {
        Quantity::Acceleration if share(true) > CLEAR => Some(Quantity::Displacement),
        Quantity::Displacement if share(false) > CLEAR => Some(Quantity::Acceleration),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_say_what_they_are_of() {
        let lags = [-0.1, -1.5, -3.0];
        let leads = lags.map(|phase: f64| phase + std::f64::consts::PI);
        assert_eq!(phase_of(Quantity::Acceleration, &lags), Some(Quantity::Displacement));
        assert_eq!(phase_of(Quantity::Acceleration, &leads), None);
        assert_eq!(phase_of(Quantity::Displacement, &leads), Some(Quantity::Acceleration));
        assert_eq!(phase_of(Quantity::Acceleration, &[-0.1, 1.0]), None);
    }
}

//! From what is decided on the screen to what `dashpot import` is asked for.

use super::draft::{Decided, Draft, PlaceRow, Responses};
use crate::exchange::importing::Request;
use crate::exchange::mapping::ChannelTable;
use crate::exchange::mapping::units::LabUnit;
use crate::exchange::project::file::Label;
use crate::exchange::project::frf::FrfTable;
use crate::measurement::Quantity;
use std::collections::BTreeMap;

impl Draft {
    /// What is to be imported, as it stands on the screen.
    pub fn decided(&self) -> Request {
        let mut request = self.request.clone();
        match &self.decided {
            // What was only looked at is imported as it is proposed.
            decided if *decided == self.proposed => {}
            Decided::Channels(rows) => {
                request.channels = Some(rows.iter().filter(|row| row.used).map(|row| row.table.clone()).collect());
            }
            Decided::Responses(responses) => responses.ask(&mut request),
            Decided::Stepped(..) | Decided::Nothing(_) => {}
        }
        request
    }

    /// What keeps the files from being imported, in one sentence.
    pub fn fault(&self) -> Option<String> {
        if let Decided::Nothing(why) = &self.decided {
            return Some(why.clone());
        }
        if self.needs_sampling && self.request.sampling_hz.is_none() {
            return Some("The file does not say the time between samples: give the sampling rate.".to_owned());
        }
        if let Decided::Channels(rows) = &self.decided {
            let used: Vec<&ChannelTable> = rows.iter().filter(|row| row.used).map(|row| &row.table).collect();
            if used.is_empty() {
                return Some("Tick at least one channel, and say what it measures.".to_owned());
            }
            if let Some(fault) = used.iter().find_map(|table| wrong(table)) {
                return Some(fault);
            }
            let twice =
                |(i, table): (usize, &&ChannelTable)| used[..i].iter().any(|other| other.channel() == table.channel());
            if let Some((_, table)) = used.iter().enumerate().find(|&(i, table)| twice((i, table))) {
                return Some(format!("{} stands for two channels: give one another DOF.", table.channel()));
            }
        }
        if self.into_open()
            && let Some(label) = self.unknown_dof()
        {
            return Some(format!("The project has no DOF \"{label}\": correct it, or make a new project."));
        }
        None
    }

    /// The first label that the open project does not have.
    pub fn unknown_dof(&self) -> Option<String> {
        let known = self.open.as_ref().map(|project| &project.dofs)?;
        let labels: Vec<String> = match &self.decided {
            Decided::Channels(rows) => rows
                .iter()
                .filter(|row| row.used && row.table.quantity != Quantity::Base)
                .map(|row| row.table.dof.clone())
                .collect(),
            Decided::Responses(r) if r.places.is_empty() => split(&r.responses).chain(split(&r.references)).collect(),
            Decided::Responses(r) => r.places.iter().map(|place| place.label.clone()).collect(),
            Decided::Stepped(..) | Decided::Nothing(_) => Vec::new(),
        };
        labels.into_iter().find(|label| !known.contains(&label.trim_start_matches('-').to_owned()))
    }
}

/// What is wrong with the mapping of a channel.
fn wrong(table: &ChannelTable) -> Option<String> {
    let name = &table.name;
    if table.dof.trim().is_empty() {
        return Some(format!("{name}: say the DOF that it is at."));
    }
    if table.quantity == Quantity::Base && !matches!(table.dof.as_str(), "x" | "y" | "z") {
        return Some(format!("{name}: a base moves along x, y or z."));
    }
    let unit = table.unit.as_deref()?;
    match LabUnit::from_name(unit) {
        Some(known) if known.measures(table.quantity) => None,
        Some(_) => Some(format!("{name}: {unit} is no unit of {}.", table.quantity.word())),
        None => Some(format!("{name}: \"{unit}\" is no known unit; write {}.", LabUnit::names_of(table.quantity))),
    }
}

impl Responses {
    /// Takes what is decided into a request.
    fn ask(&self, request: &mut Request) {
        request.form = self.form.or(request.form);
        request.averages = (self.averages > 0).then_some(self.averages);
        if self.places.is_empty() {
            request.responses = split(&self.responses).collect();
            request.references = split(&self.references).collect();
            return;
        }
        let label = |place: &PlaceRow| {
            let sign = if place.reversed { "-" } else { "" };
            (place.name.clone(), Label(format!("{sign}{}", place.label.trim())))
        };
        let dofs: BTreeMap<String, Label> = self.places.iter().map(label).collect();
        request.frf = Some(Box::new(FrfTable { dofs, ..FrfTable::of(String::new()) }));
    }
}

/// Labels between commas.
fn split(text: &str) -> impl Iterator<Item = String> {
    text.split(',').map(|label| label.trim().to_owned()).filter(|label| !label.is_empty())
}

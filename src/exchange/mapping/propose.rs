//! Proposals for a mapping from names and metadata: `acc@7`, `12:+Z`, `Acc 7`, nodes and directions of Universal Files.
//!
//! What a file does not say is proposed with a note: DOFs numbered in the order of the channels, SI units. A channel that may
//! be a motion in a unit of its sensor (volts, strain) is kept apart, as [`Proposal::uncalibrated`].

use super::guess::{
    angle, are_directions, direction_of, in_g, is_sensor_unit, of_base, of_identification, of_moment, place_beside,
    place_of, quantity_of_type, spoken, symbol,
};
use super::table::ChannelTable;
use super::units::LabUnit;
use crate::measurement::Quantity;
use crate::measurement::channel::parse_name;
use dashpot_datafiles::units::{sensitivity, suffix};
use dashpot_datafiles::{Axis, Channel, Contents, Defect, Format, Kind, Set};

/// Names of channels that `dashpot_datafiles` found to be the times of others.
const TIMES: &str = "time of ";

/// How an assumption begins that a force acts at the first motion, whose DOF follows.
pub const FORCE_WITHOUT_PLACE: &str = "the file says no DOF: it is taken to act at DOF";

/// How an assumption ends that the base moves in a direction which the file does not say.
pub(crate) const DIRECTION_ASSUMED: &str = " is assumed";

/// Why a channel is not mapped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum NotMapped {
    #[error("it is sampled at another rate than the others")]
    OtherRate,
    #[error("it has {own} values where the others have {others}")]
    OtherLength { own: u64, others: u64 },
    #[error("{0}")]
    Other(String),
}

/// What is proposed for a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Proposal {
    /// Channels that are mapped.
    pub channels: Vec<ChannelTable>,
    /// What was assumed of mapped channels: the channel in the words of the project, such as `acc@7`, and the assumption.
    pub assumed: Vec<(String, String)>,
    /// Channels in the unit of their sensor, as displacements with factor 1 m a unit: nothing says what they measure.
    pub uncalibrated: Vec<ChannelTable>,
    /// Channels that are not mapped, each with the reason.
    pub left: Vec<(String, NotMapped)>,
    /// Whether the file does not say the time between samples.
    pub needs_sampling: bool,
    /// Further runs of a file in which every data set is one channel: their sets, one a mapped channel in their order.
    pub further_runs: Vec<Vec<String>>,
}

/// A channel on its way into the mapping.
struct Draft<'a> {
    channel: &'a Channel,
    table: ChannelTable,
    /// Whether a place was found in its name or metadata.
    placed: bool,
    calibrated: bool,
    assumed: Vec<String>,
}

/// Proposes a mapping for the time records of a file. `set` is stated where a name stands in several sets.
pub fn propose(contents: &Contents) -> Proposal {
    let mut proposal = Proposal::default();
    let mut drafts: Vec<Draft<'_>> = Vec::new();
    let moves = |channel: &Channel| {
        let quantity = LabUnit::from_name(&channel.unit).map(|unit| unit.quantity).or_else(|| spoken(&channel.name));
        angle(&channel.name) || quantity.is_some_and(|quantity| quantity != Quantity::Force)
    };
    let recorder = contents.format == Format::Wav;
    // Where another channel moves, `x` may be anything.
    let all = || contents.sets.iter().flat_map(|set| &set.channels);
    let moved = all().any(moves) || are_directions(all().map(|channel| channel.name.as_str()));
    let recorded: Vec<&Set> = contents.sets.iter().filter(|set| matches!(set.kind, Kind::Time | Kind::Table)).collect();
    // Sets of one layout are runs of one mapping, told by the first of them.
    let alike = of_one_layout(&recorded);
    for set in alike.map_or(recorded.clone(), |first| vec![first]) {
        for channel in set.channels.iter().filter(|channel| !channel.name.starts_with(TIMES)) {
            let same = |other: &&Channel| other.name == channel.name;
            let everywhere = contents.sets.iter().flat_map(|set| &set.channels).filter(same).count();
            let within = set.channels.iter().filter(same).count();
            let stated = (everywhere > within && alike.is_none()).then(|| set.name.clone());
            match draft(channel, stated, moved, recorder) {
                _ if within > 1 => proposal.leave(channel, "two channels of the set have that name"),
                _ if channel.count == 0 => proposal.leave(channel, "it has 0 samples"),
                _ if channel.complex => proposal.leave(channel, "it is complex"),
                Err(reason) => proposal.leave(channel, &reason),
                Ok(draft) => drafts.push(draft),
            }
        }
    }
    if let (true, Some(set)) = (drafts.is_empty(), alike.or_else(|| recorded.first().copied())) {
        drafts = inputs_and_outputs(set);
        drafts.extend(directions(set));
        proposal.left.retain(|(name, _)| drafts.iter().all(|draft| draft.channel.name != *name));
    }
    let mut drafts = proposal.of_one_length(drafts);
    take_for_base(&mut drafts);
    let again = proposal.number(drafts);
    let counted = recorded.iter().flat_map(|set| &set.notes).find(|note| note.tells(Defect::TimesCount));
    if let (Some(note), Some(first)) = (counted, proposal.channels.first()) {
        let what = format!("{note}, which is assumed; where they count milliseconds or samples, say so in the header");
        proposal.assumed.push((first.channel(), what));
    }
    proposal.take_further_runs(again);
    proposal
}

/// The channels of a set that are called as inputs and outputs of system identification, `u` and `y`.
fn inputs_and_outputs(set: &Set) -> Vec<Draft<'_>> {
    let names: Vec<&str> = set.channels.iter().map(|channel| channel.name.as_str()).collect();
    let bare = |channel: &&Channel| channel.unit.is_empty() && !channel.complex && channel.count > 0;
    let quantity = |channel: &Channel| of_identification(&channel.name, &names);
    let drafts = set.channels.iter().filter(bare).filter_map(|channel| Some((channel, quantity(channel)?)));
    drafts.map(|(channel, quantity)| assumed_draft(channel, quantity)).collect()
}

/// The channels of a set that are called as the three directions, as telephones and single sensors have them.
fn directions(set: &Set) -> Vec<Draft<'_>> {
    if !are_directions(set.channels.iter().map(|channel| channel.name.as_str())) {
        return Vec::new();
    }
    let own = |channel: &&Channel| matches!(channel.name.trim(), "x" | "y" | "z" | "X" | "Y" | "Z");
    let bare = |channel: &&Channel| channel.unit.is_empty() && !channel.complex && channel.count > 0;
    set.channels.iter().filter(own).filter(bare).map(|channel| assumed_draft(channel, Quantity::Acceleration)).collect()
}

/// A channel whose quantity is assumed by its name alone.
fn assumed_draft(channel: &Channel, quantity: Quantity) -> Draft<'_> {
    let assumed = vec![match quantity {
        Quantity::Acceleration => "called as a direction alone: an acceleration is assumed".to_owned(),
        Quantity::Force => "called as system identification calls inputs and outputs: a force is assumed".to_owned(),
        _ => "called as system identification calls inputs and outputs: a displacement is assumed".to_owned(),
    }];
    let table = table(channel, None, quantity, String::new());
    let mut draft = Draft { channel, table, placed: false, calibrated: true, assumed };
    draft.convert(None, quantity, "");
    draft
}

/// The first of the sets that are several of one layout, each with a name of its own.
fn of_one_layout<'a>(sets: &[&'a Set]) -> Option<&'a Set> {
    let layout = |set: &Set| set.channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>();
    let alike = |set: &Set| -> Vec<&String> {
        let own = layout(set);
        sets.iter().filter(|other| layout(other) == own).map(|other| &other.name).collect()
    };
    let found = sets.iter().copied().filter(|set| set.channels.len() > 1).find(|set| alike(set).len() > 1)?;
    let mut names = alike(found);
    names.sort_unstable();
    names.windows(2).all(|pair| pair[0] != pair[1]).then_some(found)
}

/// Takes the acceleration of a table or of the ground for the motion of the base, where no force is measured.
fn take_for_base(drafts: &mut [Draft<'_>]) {
    if drafts.iter().any(|draft| matches!(draft.table.quantity, Quantity::Force | Quantity::Base)) {
        return;
    }
    let of_table = |draft: &&mut Draft<'_>| {
        draft.calibrated && draft.table.quantity == Quantity::Acceleration && of_base(&draft.channel.name)
    };
    let [draft] = &mut drafts.iter_mut().filter(of_table).collect::<Vec<_>>()[..] else { return };
    let said = direction_of(&draft.channel.name);
    let direction = said.clone().unwrap_or_else(|| "z".to_owned());
    draft.table.quantity = Quantity::Base;
    draft.table.dof = direction;
    draft.placed = true;
    draft.assumed.push("by its name the motion of the base, and no force is measured".to_owned());
    if said.is_none() {
        draft.assumed.push(format!("the file says no direction: z{DIRECTION_ASSUMED}"));
    }
}

impl Proposal {
    fn leave(&mut self, channel: &Channel, reason: &str) {
        self.left.push((channel.name.clone(), NotMapped::Other(reason.to_owned())));
    }

    /// The channel of motion that is left out since it is not recorded at the rate of the forces, where they alone are mapped.
    pub(crate) fn motion_of_another_rate(&self) -> Option<&(String, NotMapped)> {
        let forces = !self.channels.is_empty() && self.channels.iter().all(|table| table.quantity == Quantity::Force);
        self.left.iter().find(|(_, why)| forces && !matches!(why, NotMapped::Other(_)))
    }

    /// Keeps the channels of the length and step that most of them have: those of a run share their times.
    fn of_one_length<'a>(&mut self, drafts: Vec<Draft<'a>>) -> Vec<Draft<'a>> {
        let times = |draft: &Draft<'_>| (draft.channel.count, draft.channel.axis.step().map(f64::to_bits));
        let alike = |draft: &Draft<'_>| {
            let calibrated = drafts.iter().filter(|other| other.calibrated && times(other) == times(draft)).count();
            (calibrated, drafts.iter().filter(|other| times(other) == times(draft)).count())
        };
        let Some(most) = drafts.iter().rev().max_by_key(|draft| alike(draft)).map(times) else { return drafts };
        let (kept, others): (Vec<_>, Vec<_>) = drafts.into_iter().partition(|draft| times(draft) == most);
        for draft in others {
            let (own, others) = (draft.channel.count, most.0);
            let reason = if own == others { NotMapped::OtherRate } else { NotMapped::OtherLength { own, others } };
            self.left.push((draft.channel.name.clone(), reason));
        }
        kept
    }

    /// Gives channels without a place the next number: motions in their order, forces that of the first motion.
    /// Returns those whose place is taken by a channel of the same name.
    fn number<'a>(&mut self, mut drafts: Vec<Draft<'a>>) -> Vec<Draft<'a>> {
        let mut taken: Vec<String> = drafts.iter().filter(|d| d.placed).map(|d| d.table.dof.clone()).collect();
        let is_motion = |draft: &&mut Draft<'_>| !matches!(draft.table.quantity, Quantity::Force | Quantity::Base);
        for draft in drafts.iter_mut().filter(is_motion).filter(|draft| !draft.placed) {
            let next = (1..=u32::MAX).map(|n| n.to_string()).find(|label| !taken.contains(label));
            draft.table.dof = next.unwrap_or_default();
            taken.push(draft.table.dof.clone());
            draft.assumed.push(format!("the file says no DOF: {} is its number in order", draft.table.dof));
        }
        let first = drafts.iter().find(|draft| draft.table.quantity != Quantity::Force && draft.calibrated);
        let first = first.or_else(|| drafts.iter().find(|draft| draft.table.quantity != Quantity::Force));
        let first = first.map_or_else(|| "1".to_owned(), |draft| draft.table.dof.clone());
        for draft in drafts.iter_mut().filter(|draft| !draft.placed && draft.table.quantity == Quantity::Force) {
            draft.table.dof.clone_from(&first);
            draft.assumed.push(format!("{FORCE_WITHOUT_PLACE} {first}"));
        }
        drafts.into_iter().filter_map(|draft| self.take(draft)).collect()
    }

    /// Runs that repeat every mapped channel in sets further behind, as Universal Files hold one run after the other.
    fn take_further_runs(&mut self, again: Vec<Draft<'_>>) {
        let same = |table: &ChannelTable, draft: &Draft<'_>| {
            table.channel() == draft.table.channel() && table.name == draft.table.name && table.unit == draft.table.unit
        };
        let sets_of = |table: &ChannelTable| -> Vec<String> {
            again.iter().filter(|draft| same(table, draft)).filter_map(|draft| draft.table.set.clone()).collect()
        };
        let sets: Vec<Vec<String>> = self.channels.iter().map(sets_of).collect();
        let runs = sets.iter().map(Vec::len).min().unwrap_or(0);
        if runs > 0 && self.uncalibrated.is_empty() && sets.iter().all(|own| own.len() == runs) {
            self.further_runs = (0..runs).map(|run| sets.iter().map(|own| own[run].clone()).collect()).collect();
            return;
        }
        for draft in again {
            let name = draft.table.channel();
            self.leave(draft.channel, &format!("{name} is proposed for another channel already"));
        }
    }

    /// Takes a channel into the mapping; returns it where its place there is taken.
    fn take<'a>(&mut self, draft: Draft<'a>) -> Option<Draft<'a>> {
        let name = draft.table.channel();
        if self.channels.iter().chain(&self.uncalibrated).any(|other| other.channel() == name) {
            return Some(draft);
        }
        self.needs_sampling |= draft.channel.axis == Axis::None;
        self.assumed.extend(draft.assumed.into_iter().map(|what| (name.clone(), what)));
        if draft.calibrated { &mut self.channels } else { &mut self.uncalibrated }.push(draft.table);
        None
    }
}

/// The table of a channel that is named as in the project's own files.
pub(super) fn own_name(set: &str, channel: &Channel) -> Option<ChannelTable> {
    let (quantity, label) = parse_name(&channel.name).ok()?;
    let unit = LabUnit::from_name(&channel.unit)?;
    unit.measures(quantity).then(|| ChannelTable { set: Some(set.to_owned()), ..table(channel, None, quantity, label) })
}

fn table(channel: &Channel, set: Option<String>, quantity: Quantity, label: String) -> ChannelTable {
    ChannelTable {
        name: channel.name.clone(),
        set,
        quantity,
        dof: label,
        unit: None,
        sign: None,
        factor: None,
        delay: None,
        optional: false,
    }
}

/// What is proposed for a channel: `moved` where another channel of the file moves, `recorder` where the numbers are shares of
/// full scale.
fn draft(channel: &Channel, set: Option<String>, moved: bool, recorder: bool) -> Result<Draft<'_>, String> {
    let new_draft =
        |table: ChannelTable, placed: bool| Draft { channel, table, placed, calibrated: true, assumed: Vec::new() };
    if let Ok((quantity, label)) = parse_name(&channel.name) {
        let unit = LabUnit::from_name(&channel.unit);
        let mut draft = new_draft(table(channel, set, quantity, label), true);
        draft.convert(unit, quantity, &channel.unit);
        return Ok(draft);
    }
    let moment = channel.unit == "nm" && of_moment(&channel.name);
    let unit = LabUnit::from_name(if moment { "Nm" } else { &channel.unit });
    let typed = channel.attribute("quantity").and_then(quantity_of_type);
    let symbol = symbol(&channel.name)
        .filter(|quantity| channel.unit.is_empty() && (!moved || *quantity != Quantity::Displacement));
    let spoken = spoken(&channel.name).or(typed).or(symbol);
    let turned = unit.is_none() && channel.unit.is_empty() && angle(&channel.name);
    let g = channel.unit.is_empty() && in_g(&channel.name);
    let quantity = unit.map(|unit| unit.quantity).or(spoken).or(turned.then_some(Quantity::Displacement));
    let quantity = quantity.or(g.then_some(Quantity::Acceleration));
    let name = suffix(&channel.name).map_or(channel.name.as_str(), |(front, _)| front);
    let place = place_beside(&channel.attributes).or_else(|| place_of(channel.attribute("response").unwrap_or(name)));
    if let Some(draft) = calibrated(channel, set.clone(), place.clone()) {
        return Ok(draft);
    }
    let (label, sign) = place.clone().unwrap_or_default();
    let Some(quantity) = quantity else {
        let share = recorder && channel.unit.is_empty();
        if !share && !is_sensor_unit(&channel.unit) {
            return Err(match channel.unit.as_str() {
                "" => "neither its unit nor its name says what it measures".to_owned(),
                unit => format!("{unit} is no unit of a force or of a motion"),
            });
        }
        let table = table(channel, set, Quantity::Displacement, label);
        let table = ChannelTable { sign, unit: Some("m".to_owned()), factor: Some(1.0), ..table };
        let one = if share { "full scale" } else { &channel.unit };
        let assumed = vec![format!("nothing says what it measures: factor is 1 m a {one}, fill in its own")];
        return Ok(Draft { channel, table, placed: place.is_some(), calibrated: false, assumed });
    };
    let mut draft = new_draft(ChannelTable { sign, ..table(channel, set, quantity, label) }, place.is_some());
    if let Some(scale) = channel.attribute("scale beside").and_then(|scale| scale.parse().ok()) {
        draft.table.factor = Some(scale);
        draft.assumed.push(format!("its whole numbers are taken times the scale beside them, {scale}"));
    }
    if g {
        draft.table.unit = Some("g".to_owned());
        draft.assumed.push("by its name in g".to_owned());
    } else if moment {
        draft.table.unit = Some("N m".to_owned());
        draft.assumed.push("by its name a moment; the file says nm: N m is assumed".to_owned());
    } else if turned {
        draft.table.unit = Some("rad".to_owned());
        draft.assumed.push("by its name an angle; the file says no unit: rad is assumed".to_owned());
    } else {
        draft.convert(unit, quantity, &channel.unit);
    }
    Ok(draft)
}

/// The sensitivity that an attribute states, however it is spelt: `Sensitivity` = `100 mV/g`, `sensitivity (mV/g)` = `100`.
fn stated_sensitivity(channel: &Channel) -> Option<(f64, String, String)> {
    let of_sensor = |name: &str| {
        let lower = name.trim().to_lowercase();
        ["sensitivity", "sensor sensitivity", "sensor_sensitivity", "empfindlichkeit"]
            .iter()
            .any(|w| lower.starts_with(w))
    };
    let read = |(name, value): &(String, String)| {
        let unit = name.split_once(['(', '[']).map_or("", |(_, unit)| unit);
        sensitivity(value).or_else(|| sensitivity(&format!("{} {unit}", value.trim())))
    };
    channel.attributes.iter().filter(|(name, _)| of_sensor(name)).find_map(read)
}

/// A channel in volts whose name or metadata state its sensitivity, such as 100 mV/g: its factor is the inverse.
fn calibrated(channel: &Channel, set: Option<String>, place: Option<(String, Option<i64>)>) -> Option<Draft<'_>> {
    let volts = |unit: &str| match unit.trim().to_lowercase().as_str() {
        "v" | "volt" | "volts" => Some(1.0),
        "mv" | "millivolt" | "millivolts" => Some(1e-3),
        "uv" | "µv" => Some(1e-6),
        _ => None,
    };
    let own = volts(&channel.unit)?;
    let (value, over, under) = stated_sensitivity(channel).or_else(|| sensitivity(&channel.name))?;
    let (unit, factor) = (LabUnit::from_name(&under)?, own / (value * volts(&over)?));
    let (label, sign) = place.filter(|_| sensitivity(&channel.name).is_none()).unwrap_or_else(|| {
        // The digits of the sensitivity are no place.
        place_of(channel.name.split(['(', '[', ',']).next().unwrap_or_default()).unwrap_or_default()
    });
    // Twelve digits: 0.1, not 0.10000000000000002.
    let factor = format!("{factor:.11e}").parse().unwrap_or(factor);
    let placed = !label.is_empty();
    let table = ChannelTable {
        sign,
        unit: Some(under.clone()),
        factor: Some(factor),
        ..table(channel, set, unit.quantity, label)
    };
    let assumed = vec![format!("calibrated by the sensitivity that the file states, {value} {over}/{under}")];
    Some(Draft { channel, table, placed, calibrated: true, assumed })
}

impl Draft<'_> {
    /// States a unit where the file says none that fits.
    fn convert(&mut self, unit: Option<LabUnit>, quantity: Quantity, named: &str) {
        if unit.is_some_and(|unit| unit.measures(quantity)) {
            return;
        }
        let si = quantity.si_unit(false);
        self.table.unit = Some(si.to_owned());
        if named.is_empty() {
            self.assumed.push(format!("the file says no unit: {si} is assumed"));
        } else {
            self.table.factor = Some(1.0);
            self.assumed.push(format!("the file says {named}: factor is 1 {si} a {named}, fill in the calibration"));
        }
    }
}

//! Tables `[[channel]]`: which channel of the laboratory files is which quantity, where.

use super::error::{ProjectError, TableProblem};
use super::file::Lines;
use super::reader::{Origin, Table, one_line};
use crate::exchange::mapping::{ChannelTable, units::LabUnit};
use crate::measurement::Quantity;
use crate::measurement::base::AXES;

const QUANTITIES: [&str; 5] = ["force", "acc", "vel", "disp", "base"];

/// Reads the tables of a project.
pub(super) fn parse(root: &Table<'_>, lines: &mut Lines) -> Result<Vec<ChannelTable>, ProjectError> {
    let mut channels: Vec<ChannelTable> = Vec::new();
    for table in root.tables("channel", "[[channel]]")? {
        let channel = one(&table)?;
        // One or the other, where both need not be there, and one in each of two sets.
        let apart = |other: &ChannelTable| (other.optional && channel.optional) || other.is_of_another_set(&channel);
        let same = |other: &ChannelTable| other.channel() == channel.channel() && !apart(other);
        if let Some(first) = channels.iter().position(same) {
            let what = format!("the channel {}", channel.channel());
            return Err(table.error("dof", TableProblem::Twice { what, first: lines.of(table.name, first, "") }));
        }
        channels.push(channel);
        lines.note(&table);
    }
    Ok(channels)
}

/// Reads the tables `[[channel]]` of a template or of a whole project, called `file` in messages.
///
/// # Errors
/// [`ProjectError`] with the line of the first thing that is wrong.
pub fn template(text: &str, file: &str) -> Result<Vec<ChannelTable>, ProjectError> {
    let origin = Origin { file, text };
    let document = origin.document()?;
    let channels = parse(&Table::root(origin, document.get_ref()), &mut Lines::default())?;
    if channels.is_empty() {
        let (what, example) = ("[[channel]]", "[[channel]] with `name`, `quantity` and `dof`");
        return Err(ProjectError::new(file, None, TableProblem::Empty { table: "the template".into(), what, example }));
    }
    Ok(channels)
}

fn one(table: &Table<'_>) -> Result<ChannelTable, ProjectError> {
    table.only_in::<ChannelTable>(&["direction"])?;
    let out =
        |key: &str, value: String, range| table.error(key, TableProblem::OutOfRange { key: key.into(), value, range });
    let sign = table.whole("sign")?;
    if let Some(value) = sign.filter(|sign| sign.abs() != 1) {
        return Err(out("sign", value.to_string(), "1 or -1"));
    }
    let factor = table.number("factor")?;
    if let Some(value) = factor.filter(|factor| *factor == 0.0) {
        return Err(out("factor", value.to_string(), "other than 0"));
    }
    let unit = table.text("unit")?;
    let quantity = table.word("quantity", &QUANTITIES, Quantity::from_word)?;
    let quantity = table.need("quantity", "quantity = \"acc\"", quantity)?;
    if let Some(value) =
        unit.as_deref().filter(|unit| LabUnit::from_name(unit).is_none_or(|unit| !unit.measures(quantity)))
    {
        let allowed = LabUnit::names_of(quantity).to_owned();
        return Err(
            table.error("unit", TableProblem::NotAllowed { key: "unit".into(), value: one_line(value), allowed })
        );
    }
    Ok(ChannelTable {
        name: table.need("name", "name = \"Acc 7\"", table.text("name")?)?,
        set: table.text("set")?,
        quantity,
        dof: place(table, quantity)?,
        unit,
        sign,
        factor,
        delay: super::keys::delay(table)?,
        optional: table.flag("optional")?.unwrap_or(false),
    })
}

/// Label of the DOF; of a base its direction, under `direction` or `dof`.
fn place(table: &Table<'_>, quantity: Quantity) -> Result<String, ProjectError> {
    if quantity != Quantity::Base {
        if let Some(value) = table.text("direction")? {
            let allowed = "`dof` in its place: a direction is that of quantity \"base\"".to_owned();
            return Err(table.error("direction", TableProblem::NotAllowed { key: "direction".into(), value, allowed }));
        }
        return table.need("dof", "dof = 7", table.label("dof")?);
    }
    let key = if table.text("direction")?.is_some() { "direction" } else { "dof" };
    let axis = table.word(key, &AXES, |word| AXES.iter().position(|axis| *axis == word))?;
    let axis = table.need("direction", "direction = \"z\" of a base", axis)?;
    Ok(AXES[axis].to_owned())
}

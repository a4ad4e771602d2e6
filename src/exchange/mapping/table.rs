//! Table `[[channel]]`: one channel of the laboratory files of a project.

use crate::measurement::Quantity;
use serde::{Deserialize, Serialize, Serializer};

/// Table `[[channel]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelTable {
    /// Name of the channel in the file.
    pub name: String,
    /// Name of the set in the file, where several have that channel.
    pub set: Option<String>,
    /// What it measures.
    #[serde(serialize_with = "word")]
    pub quantity: Quantity,
    /// DOF it is at.
    #[serde(serialize_with = "label")]
    pub dof: String,
    /// Unit of its numbers, where the file says none or a wrong one.
    pub unit: Option<String>,
    /// -1 where it is positive against the direction of its DOF.
    pub sign: Option<i64>,
    /// Calibration: units a number of the file.
    pub factor: Option<f64>,
    /// How late it is recorded, s.
    pub delay: Option<f64>,
    /// Whether files without it are read all the same: a hammer or sensor that moves from run to run.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub optional: bool,
}

#[allow(clippy::trivially_copy_pass_by_ref, clippy::ref_option, reason = "serde passes references to fields")]
fn word<S: Serializer>(quantity: &Quantity, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(quantity.word())
}

/// A label that is a number is written without quotes.
fn label<S: Serializer>(label: &str, serializer: S) -> Result<S::Ok, S::Error> {
    match label.parse::<i64>() {
        Ok(number) if number.to_string() == label => serializer.serialize_i64(number),
        _ => serializer.serialize_str(label),
    }
}

impl ChannelTable {
    /// Name of the channel in the project, such as `acc@7`.
    pub fn channel(&self) -> String {
        format!("{}@{}", self.quantity.word(), self.dof)
    }

    /// Whether both name a set and these differ.
    pub fn is_of_another_set(&self, other: &Self) -> bool {
        matches!((&self.set, &other.set), (Some(own), Some(other)) if own != other)
    }

    /// Whether it is meant for data of which `has` says the sets: of tables of one name, or of one channel, with different sets
    /// those whose set is there; every other table.
    pub fn is_meant(&self, all: &[Self], has: &dyn Fn(&str) -> bool) -> bool {
        let Some(set) = &self.set else { return true };
        let alike = |other: &&Self| other.name == self.name || other.channel() == self.channel();
        let others = all.iter().filter(alike).filter(|other| other.is_of_another_set(self));
        has(set) || !others.filter_map(|other| other.set.as_deref()).any(has)
    }
}

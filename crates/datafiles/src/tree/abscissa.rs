//! The abscissa of channels: times or frequencies.

use crate::contents::Kind;

/// The abscissa of a group, which is also that of groups below it.
#[derive(Clone)]
pub(super) struct Abscissa {
    /// Its place among the entries of the group; none where it is of a group above.
    pub entry: Option<usize>,
    pub id: usize,
    pub count: u64,
    pub step: Option<f64>,
    pub kind: Kind,
    pub unit: String,
}

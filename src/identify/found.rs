//! What the passes of search and refit end with.

use super::outcome::Form;
use super::{search::SizeRanking, state::IdentificationState, stopping::Decision, system::System};

/// What the passes end with.
pub(crate) struct Found {
    pub state: IdentificationState,
    pub system: System,
    pub rankings: Vec<SizeRanking>,
    pub decision: Decision,
    pub form: Form,
}

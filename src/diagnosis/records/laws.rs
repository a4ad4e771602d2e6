//! Laws that are looked for in records.

use crate::effects::Effect;
use crate::response::transient::has_force_in_time;
use std::sync::LazyLock;

/// Laws that have a force in time.
pub(super) static LAWS: LazyLock<Vec<Effect>> =
    LazyLock::new(|| Effect::ALL.into_iter().filter(|effect| has_force_in_time(*effect)).collect());

//! What a law acts on, with the law.

use super::law::{ChannelLaw, Law, WholeLaw};

/// What a law acts on.
#[derive(Clone, Copy)]
pub enum Kind {
    /// On one relative motion.
    Relative(&'static dyn Law),
    /// On the whole structure.
    Whole(&'static dyn WholeLaw),
    /// On a channel of the measuring chain.
    Channel(&'static dyn ChannelLaw),
}

//! What may act on a structure or on a measuring chain: one file a law, and where it acts.

pub mod effect;
pub mod family;
pub mod law;
pub mod laws;
pub mod masing;
pub mod memory;
pub mod memoryless;
pub mod motion;
pub mod place;
pub mod sampling;
pub mod source;
pub mod turning;
pub mod wording;

pub use effect::Effect;
pub use family::Family;
pub use law::{ChannelLaw, Law, Parameter, WholeLaw};
pub use memory::Memory;
pub use memoryless::Memoryless;
pub use motion::Motion;
pub use place::{Leg, Place};
pub use sampling::Sampling;
pub use source::{Source, SourceError, State};

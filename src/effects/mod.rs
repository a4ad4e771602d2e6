//! What may act on a structure or on a measuring chain: one file a law, and where it acts.

pub mod description;
pub mod effect;
pub mod family;
pub mod internal;
pub mod law;
pub mod laws;
pub mod limits;
pub mod linear;
pub mod masing;
pub mod memory;
pub mod memoryless;
pub mod motion;
pub mod parameter;
pub mod place;
pub mod range;
pub mod sampling;
pub mod set_valued;
pub mod source;
pub mod symbol;
pub mod turning;
pub mod wording;

pub use description::{Constant, Description, Exponents, Part};
pub use family::Family;
pub use law::{ByParameter, ChannelLaw, Law, Manner, WholeLaw};
pub use laws::Effect;
pub use linear::LinearLaw;
pub use memory::Memory;
pub use memoryless::MemorylessLaw;
pub use motion::Motion;
pub use parameter::Parameter;
pub use place::{Leg, Place};
pub use range::Range;
pub use sampling::Sampling;
pub use set_valued::{SetValued, Steep};
pub use source::{Source, SourceError, State};

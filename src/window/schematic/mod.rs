//! The schematic: model (what there is), layout (where it stands), hit (what is under the pointer), paint (how it looks),
//! view (the widget that joins them and turns gestures into intents).

pub mod gesture;
pub mod hit;
pub mod layout;
pub mod menu;
pub mod model;
pub mod paint;
pub mod symbols;
pub mod view;

#[cfg(test)]
pub(crate) mod samples;

pub use layout::{Camera, Layout};
pub use model::Scene;

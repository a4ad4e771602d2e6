//! The schematic: model (what there is), layout (where it stands), hit (what is under the pointer), paint (how it looks),
//! view (the widget that joins them and turns gestures into intents).

pub(crate) mod gesture;
pub(crate) mod hit;
pub(crate) mod layout;
pub(crate) mod menu;
pub(crate) mod model;
pub(crate) mod paint;
pub(crate) mod symbols;
pub(crate) mod view;

#[cfg(test)]
pub(crate) mod samples;

pub(crate) use layout::{Camera, Layout};
pub(crate) use model::Scene;

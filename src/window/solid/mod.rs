//! Solid pictures in space, drawn by a pipeline of our own: camera and projection, meshes, picking by a ray on the
//! processor, the pipeline with its depth buffer and multisampling, and what is built of them.
//!
//! egui's own pass has no depth. So each picture is drawn into a texture of its own first, multisampled and with depth,
//! and that texture is then laid into egui's pass. Text and rulers are egui's, placed by the same projection.

pub(crate) mod bars;
pub(crate) mod camera;
pub(crate) mod frame;
pub(crate) mod mesh;
pub(crate) mod paint;
pub(crate) mod pick;
mod pipeline;
pub(crate) mod turn;
pub(crate) mod wire;

pub(crate) use camera::{Camera, Projection};
pub(crate) use paint::{available, install};

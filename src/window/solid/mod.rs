//! Solid pictures in space, drawn by a pipeline of our own: camera and projection, meshes, picking by a ray on the
//! processor, the pipeline with its depth buffer and multisampling, and what is built of them.
//!
//! egui's own pass has no depth. So each picture is drawn into a texture of its own first, multisampled and with depth,
//! and that texture is then laid into egui's pass. Text and rulers are egui's, placed by the same projection.

pub mod bars;
pub mod camera;
pub mod frame;
pub mod mesh;
pub mod paint;
pub mod pick;
mod pipeline;
pub mod turn;
pub mod wire;

pub use camera::{Camera, Projection};
pub use mesh::Mesh;
pub use paint::{Solid, available, install};

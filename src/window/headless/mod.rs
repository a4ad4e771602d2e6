//! Frames without a display, and photographs of the window for tests on a real one.

pub mod offscreen;
pub(crate) mod photograph;
pub mod picture;

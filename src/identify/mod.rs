//! Which sources, how large, how certain.

pub mod settings;

pub use settings::Settings;

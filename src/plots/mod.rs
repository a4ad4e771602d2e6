//! Plots as data: figures with axes and units, drawings of lines, areas and words, and their SVG. Knows no window.

pub mod angle;
pub mod bars;
pub mod bode;
pub mod channel_response;
pub mod cycle;
pub mod drawing;
pub mod energy;
pub mod error_map;
pub mod figure;
pub mod fingerprint;
pub mod forward;
pub mod heatmap;
pub mod hysteresis;
pub mod log;
pub mod overview;
pub mod pyramid;
pub mod record;
pub mod response_curve;
pub mod restoring_force;
pub mod samples;
pub mod sheet;
pub mod spectrum;
pub mod style;
pub mod svg;
pub mod ticks;
pub mod trace;

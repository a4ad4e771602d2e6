//! One file a law.

pub mod coulomb;
pub mod cubic_stiffness;
pub mod delay;
pub mod elastic_slider;
pub mod fractional;
pub mod gain;
pub mod gap;
pub mod hysteretic;
pub mod iwan;
pub mod loss_factor;
pub mod mass;
pub mod mass_proportional;
pub mod maxwell;
pub mod power;
pub mod quadratic;
pub mod quadratic_stiffness;
pub mod stiffness;
pub mod stiffness_proportional;
pub mod stribeck;
pub mod viscous;

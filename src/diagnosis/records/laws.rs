//! Laws that are looked for in records.

use crate::effects::Effect;

/// Laws that have a force in time.
pub(super) const LAWS: [Effect; 16] = [
    Effect::Viscous,
    Effect::Coulomb,
    Effect::Quadratic,
    Effect::Stiffness,
    Effect::CubicStiffness,
    Effect::QuadraticStiffness,
    Effect::Mass,
    Effect::Power,
    Effect::ElasticSlider,
    Effect::Maxwell,
    Effect::Gap,
    Effect::Stribeck,
    Effect::Iwan,
    Effect::AsymmetricViscous,
    Effect::Dahl,
    Effect::BoucWen,
];

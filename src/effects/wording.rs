//! What the effects are called in tables, titles and sentences.

use super::Effect;

impl Effect {
    /// Human name, such as `Coulomb friction`.
    pub fn title(self) -> &'static str {
        match self {
            Self::Viscous => "Viscous dashpot",
            Self::Coulomb => "Coulomb friction",
            Self::Quadratic => "Quadratic damping",
            Self::Power => "Power-law damping",
            Self::Hysteretic => "Hysteretic damping",
            Self::Stribeck => "Stribeck friction",
            Self::ElasticSlider => "Elastic slider",
            Self::Maxwell => "Maxwell element",
            Self::Iwan => "Iwan joint",
            Self::Fractional => "Fractional damping",
            Self::Stiffness => "Spring",
            Self::CubicStiffness => "Cubic spring",
            Self::QuadraticStiffness => "Quadratic spring",
            Self::Gap => "Gap",
            Self::Mass => "Mass",
            Self::LossFactor => "Loss factor",
            Self::StiffnessProportional => "Stiffness-proportional damping",
            Self::MassProportional => "Mass-proportional damping",
            Self::Delay => "Channel delay",
            Self::Gain => "Channel gain",
        }
    }

    /// The law as a short formula of plain characters for tables, such as `F_c sgn(d')`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Viscous => "c d'",
            Self::Coulomb => "F_c sgn(d')",
            Self::Quadratic => "c_2 d' |d'|",
            Self::Power => "c_e |d'|^e sgn(d')",
            Self::Hysteretic => "i h d",
            Self::Stribeck => "F(|d'|) sgn(d')",
            Self::ElasticSlider => "k + slider F_y",
            Self::Maxwell => "k + dashpot c",
            Self::Iwan => "K_T + sliders F_S",
            Self::Fractional => "c_a D^a d",
            Self::Stiffness => "k d",
            Self::CubicStiffness => "k_3 d^3",
            Self::QuadraticStiffness => "k_2 d^2",
            Self::Gap => "k_g (|d| - g)",
            Self::Mass => "m d''",
            Self::LossFactor => "i eta K x",
            Self::StiffnessProportional => "beta K x'",
            Self::MassProportional => "alpha M x'",
            Self::Delay => "y(t - tau)",
            Self::Gain => "g y(t)",
        }
    }

    /// What it is physically, in one sentence.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Viscous => {
                "A force in proportion to velocity: a damper with laminar flow, eddy currents, some rubbers."
            }
            Self::Coulomb => "A constant force against the motion: dry friction between sliding surfaces.",
            Self::Quadratic => "A force that grows with velocity squared: turbulent flow, air or water drag.",
            Self::Power => "A force that grows with a power of velocity: orifices, seals, between friction and drag.",
            Self::Hysteretic => "A loss per cycle that does not depend on frequency: damping inside a material.",
            Self::Stribeck => "Friction that falls from a static to a sliding force with speed: lubricated contacts.",
            Self::ElasticSlider => "A contact that first gives elastically, then slips at its yield force.",
            Self::Maxwell => "A spring in series with a dashpot: a damper on a flexible mount.",
            Self::Iwan => "A bolted joint: slip that starts small and spreads over the contact until all of it slides.",
            Self::Fractional => "A force between elastic and viscous over a wide band of frequency: polymers.",
            Self::Stiffness => "A spring that the model lacks, or has too much of if negative.",
            Self::CubicStiffness => "A spring that stiffens, or softens if negative, alike in both directions.",
            Self::QuadraticStiffness => "A spring that is stiffer in one direction than in the other.",
            Self::Gap => "A clearance: nothing up to a displacement, a spring beyond it.",
            Self::Mass => "A mass that the model lacks, or has too much of if negative.",
            Self::LossFactor => "A loss in proportion to the strain energy of the whole structure.",
            Self::StiffnessProportional => {
                "Viscous damping in proportion to the stiffness matrix, greater in high modes."
            }
            Self::MassProportional => "Viscous damping in proportion to the mass matrix, greater in low modes.",
            Self::Delay => "A channel recorded late against the others: filters, multiplexing, cables.",
            Self::Gain => "A channel that reads too large or too small: a wrong sensitivity.",
        }
    }
}

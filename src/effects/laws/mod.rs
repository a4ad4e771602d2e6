//! The table of laws: one file and one line each. The line names the variant of [`Effect`], the family in which the law is
//! written, and its file, which is also its name in project files.

use super::effect::Kind;
use super::internal::Internal;
use super::linear::Linear;
use super::masing::Masing;
use super::memoryless::Memoryless;
use serde::{Deserialize, Serialize};

/// What a law of a family acts on.
macro_rules! kind {
    (Whole, $law:expr) => {
        Kind::Whole(&$law)
    };
    (Channel, $law:expr) => {
        Kind::Channel(&$law)
    };
    ($family:ident, $law:expr) => {
        Kind::Relative(&$family($law))
    };
}

macro_rules! laws {
    ($($effect:ident: $family:ident = $file:ident,)*) => {
        $(pub mod $file;)*

        /// Every effect the program knows, by its name in files.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[expect(missing_docs, reason = "each law documents itself in its file")]
        pub enum Effect {
            $($effect,)*
        }

        impl Effect {
            /// All effects, in the order of the documentation.
            pub const ALL: [Self; [$(stringify!($file)),*].len()] = [$(Self::$effect),*];

            /// Name in project files, such as `elastic_slider`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$effect => stringify!($file),)*
                }
            }

            /// The law behind the name.
            pub fn kind(self) -> Kind {
                match self {
                    $(Self::$effect => kind!($family, $file::$effect),)*
                }
            }
        }
    };
}

laws! {
    Viscous: Linear = viscous,
    Coulomb: Memoryless = coulomb,
    Quadratic: Memoryless = quadratic,
    Power: Memoryless = power,
    Hysteretic: Linear = hysteretic,
    Stribeck: Memoryless = stribeck,
    ElasticSlider: Masing = elastic_slider,
    Maxwell: Linear = maxwell,
    Iwan: Masing = iwan,
    Fractional: Linear = fractional,
    BoucWen: Internal = bouc_wen,
    Dahl: Internal = dahl,
    AsymmetricViscous: Memoryless = asymmetric_viscous,
    AsymmetricCoulomb: Memoryless = asymmetric_coulomb,
    Stiffness: Linear = stiffness,
    CubicStiffness: Memoryless = cubic_stiffness,
    QuadraticStiffness: Memoryless = quadratic_stiffness,
    Gap: Memoryless = gap,
    Mass: Linear = mass,
    LossFactor: Whole = loss_factor,
    StiffnessProportional: Whole = stiffness_proportional,
    MassProportional: Whole = mass_proportional,
    Delay: Channel = delay,
    Gain: Channel = gain,
}

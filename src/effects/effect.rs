//! Every effect the program knows, by its name in files.

use super::table::table_of_laws;
use serde::{Deserialize, Serialize};
use std::fmt;

macro_rules! effects {
    ($($effect:ident: $family:ident = $file:ident,)*) => {
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
        }
    };
}

table_of_laws!(effects);

impl Effect {
    /// The dashpot among the laws: that of constant viscous coefficient on a relative motion.
    pub const DASHPOT: Self = Self::Viscous;
    /// The spring among the laws.
    pub const SPRING: Self = Self::Stiffness;
    /// The law of a contact that slips in part, as in bolted joints.
    pub const MICROSLIP: Self = Self::Iwan;
    /// What stands in for the damping of a structure of which none is known: the same loss factor in every mode.
    pub const STAND_IN: Self = Self::LossFactor;
    /// The error of a channel that multiplies what it reads.
    pub const CHANNEL_GAIN: Self = Self::Gain;
    /// The error of a channel that reads late.
    pub const CHANNEL_DELAY: Self = Self::Delay;

    /// The effect of that name in project files.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effect| effect.name() == name)
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

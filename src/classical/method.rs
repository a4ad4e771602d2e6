//! The methods by name, what each needs and where it fails, in words.

use serde::{Deserialize, Serialize};

/// Every classical method that gives a matrix or ratios from measured runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "each method documents itself in its file")]
pub enum Method {
    LogDecrement,
    HalfPower,
    CircleFit,
    HysteresisLoop,
    EnergySingle,
    Chen,
    LeeKim,
    LeeKimViscous,
    Instrumental,
    Fritzen,
    Lancaster,
    PilkeyInmanIterative,
    PilkeyInmanDirect,
    Ibrahim,
    MinasInman,
    AdhikariWoodhouse,
    AdhikariWoodhouseSymmetric,
    FrfInverse,
    Liang,
    PhaniWoodhouse,
}

impl Method {
    /// All methods, in the order of chapter 3.
    pub const ALL: [Self; 20] = [
        Self::LogDecrement,
        Self::HalfPower,
        Self::CircleFit,
        Self::HysteresisLoop,
        Self::EnergySingle,
        Self::Chen,
        Self::LeeKim,
        Self::LeeKimViscous,
        Self::Instrumental,
        Self::Fritzen,
        Self::Lancaster,
        Self::PilkeyInmanIterative,
        Self::PilkeyInmanDirect,
        Self::Ibrahim,
        Self::MinasInman,
        Self::AdhikariWoodhouse,
        Self::AdhikariWoodhouseSymmetric,
        Self::FrfInverse,
        Self::Liang,
        Self::PhaniWoodhouse,
    ];

    /// Name for readers, what it needs, and its limits.
    pub fn words(self) -> [&'static str; 3] {
        match self {
            Self::LogDecrement => ["Logarithmic decrement", "a free decay of one mode", "one mode at a time"],
            Self::HalfPower => ["Half-power", "lines on both flanks of a peak", "modes well apart"],
            Self::CircleFit => ["Circle fit", "lines around a resonance", "other modes constant over the lines"],
            Self::HysteresisLoop => {
                ["Hysteresis loop", "force and motion at the drive, the model's stiffness", "one mode a run"]
            }
            Self::EnergySingle => {
                ["Energy, single degree", "runs of two levels or more at one mode", "equivalent at these amplitudes"]
            }
            Self::Chen => ["Chen et al.", "the full receptance matrix", "every mode must be in the data"],
            Self::LeeKim => {
                ["Lee and Kim", "the full receptance matrix at two lines", "every mode must be in the data"]
            }
            Self::LeeKimViscous => {
                ["Lee and Kim, viscous", "the full receptance matrix", "every mode must be in the data"]
            }
            Self::Instrumental => {
                ["Instrumental variable", "the full receptance matrix", "every mode must be in the data"]
            }
            Self::Fritzen => {
                ["Fritzen", "the motion of every DOF under known forces", "every mode must be brought out"]
            }
            Self::Lancaster => {
                ["Lancaster", "mass, scaled complex modes", "viscous damping; all modes; indefinite where truncated"]
            }
            Self::PilkeyInmanIterative => {
                ["Pilkey and Inman, iterative", "mass, complex modes", "all modes; light damping"]
            }
            Self::PilkeyInmanDirect => ["Pilkey and Inman, direct", "mass, stiffness, complex modes", "all modes"],
            Self::Ibrahim => ["Ibrahim", "mass, stiffness, complex modes", "modes not measured get the mean damping"],
            Self::MinasInman => {
                ["Minas and Inman", "mass, stiffness, complex modes", "shortest solution where modes are few"]
            }
            Self::AdhikariWoodhouse => {
                ["Adhikari and Woodhouse", "mass, complex modes", "light damping; invents ratios of modes not measured"]
            }
            Self::AdhikariWoodhouseSymmetric => {
                ["Adhikari and Woodhouse, symmetric", "mass, complex modes", "as the original"]
            }
            Self::FrfInverse => [
                "Inverse of completed receptance",
                "mass, stiffness, scaled complex modes",
                "viscous damping; other modes undamped",
            ],
            Self::Liang => [
                "Liang",
                "mass, stiffness, the motion of every DOF, a pattern",
                "small errors of phase ruin single rows",
            ],
            Self::PhaniWoodhouse => {
                ["Phani and Woodhouse", "the full receptance matrix, real modes", "first term of a series"]
            }
        }
    }

    /// Name for readers.
    pub fn title(self) -> &'static str {
        self.words()[0]
    }
}

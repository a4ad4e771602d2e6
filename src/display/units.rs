//! Units in which values are shown on the screen. Files, the command line and everything that is computed stay in SI units.
//!
//! The choice belongs to the thread that draws: work in the background, reports and exports of data among it, sees SI units.
//! 1 in = 0.0254 m, 1 lbf = 4.4482216152605 N, 1 g = 9.80665 m/s^2 (exact, NIST SP 811).

use serde::{Deserialize, Serialize};
use std::cell::Cell;
use std::f64::consts::{PI, TAU};

/// Standard acceleration of free fall, m/s^2.
const FREE_FALL: f64 = 9.806_65;

/// Lengths, and all that is made of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Length {
    #[default]
    Metre,
    Millimetre,
    Micrometre,
    Inch,
}

/// Accelerations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Acceleration {
    /// Made of the unit of length.
    #[default]
    OfLength,
    /// Multiples of the acceleration of free fall.
    FreeFall,
}

/// Forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Force {
    #[default]
    Newton,
    Kilonewton,
    PoundForce,
}

/// Frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Frequency {
    #[default]
    Hertz,
    RadianPerSecond,
}

/// Measures of the damping of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Damping {
    /// Share of the critical damping, zeta.
    #[default]
    Ratio,
    /// `Q = 1 / (2 zeta)`.
    Quality,
    /// `eta = 2 zeta`, at resonance.
    LossFactor,
    /// `delta = 2 pi zeta / sqrt(1 - zeta^2)`.
    Decrement,
}

impl Damping {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Ratio, Self::Quality, Self::LossFactor, Self::Decrement];

    /// Name and unit.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::Ratio => ["Damping ratio ζ", "%"],
            Self::Quality => ["Quality factor Q", ""],
            Self::LossFactor => ["Loss factor η", "%"],
            Self::Decrement => ["Log. decrement δ", ""],
        }
    }

    /// Name without its symbol, and unit.
    pub fn title(self) -> [&'static str; 2] {
        match self {
            Self::Ratio => ["Damping ratio", "%"],
            Self::Quality => ["Quality factor", ""],
            Self::LossFactor => ["Loss factor", "%"],
            Self::Decrement => ["Log. decrement", ""],
        }
    }

    /// Symbol and unit.
    pub fn symbol(self) -> [&'static str; 2] {
        match self {
            Self::Ratio => ["ζ", "%"],
            Self::Quality => ["Q", ""],
            Self::LossFactor => ["η", "%"],
            Self::Decrement => ["δ", ""],
        }
    }

    /// The measure of a damping ratio and its standard deviation, to first order.
    pub fn of(self, ratio: f64, deviation: f64) -> [f64; 2] {
        let rest = 1.0 - ratio * ratio;
        match self {
            Self::Ratio => [100.0 * ratio, 100.0 * deviation],
            Self::Quality => [0.5 / ratio, 0.5 * deviation / (ratio * ratio)],
            Self::LossFactor => [200.0 * ratio, 200.0 * deviation],
            Self::Decrement => [2.0 * PI * ratio / rest.sqrt(), 2.0 * PI * deviation / rest.powf(1.5)],
        }
    }
}

/// The units that are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Units {
    /// Of lengths.
    pub length: Length,
    /// Of accelerations.
    pub acceleration: Acceleration,
    /// Of forces.
    pub force: Force,
    /// Of frequencies.
    pub frequency: Frequency,
    /// Of the damping of modes.
    pub damping: Damping,
}

thread_local! {
    static NOW: Cell<Units> = const {
        Cell::new(Units {
            length: Length::Metre,
            acceleration: Acceleration::OfLength,
            force: Force::Newton,
            frequency: Frequency::Hertz,
            damping: Damping::Ratio,
        })
    };
}

/// The units of this thread.
pub fn now() -> Units {
    NOW.get()
}

/// Chooses the units of this thread.
pub fn choose(units: Units) {
    NOW.set(units);
}

/// What a value in an SI unit is multiplied by to be shown, and the unit that is shown beside it.
pub fn shown(unit: &str) -> (f64, String) {
    now().shown(unit)
}

impl Units {
    /// The same for these units.
    pub fn shown(self, unit: &str) -> (f64, String) {
        let same_si = Self { damping: self.damping, ..Self::default() };
        // Units of mass, pressure and energy are not taken apart.
        if self == same_si || unit.contains("kg") || unit.contains("Pa") || unit.contains("mol") {
            return (1.0, unit.to_owned());
        }
        let (mut factor, mut rest) = (1.0, unit.to_owned());
        if self.acceleration == Acceleration::FreeFall {
            for spelling in ["(m/s²)", "(m/s^2)", "m/s²", "m/s^2"] {
                if rest.contains(spelling) && !rest.contains("rad") {
                    rest = rest.replacen(spelling, "g", 1);
                    factor /= FREE_FALL;
                    break;
                }
            }
        }
        let mut text = String::new();
        let mut below = false;
        for token in tokens(&rest) {
            below |= token == "/";
            let (base, power) = powered(token);
            match self.replaced(base) {
                Some((scale, name)) => {
                    factor *= scale.powi(if below { -power } else { power });
                    text.push_str(name);
                    text.push_str(&token[base.len()..]);
                }
                None => text.push_str(token),
            }
        }
        (factor, text)
    }

    /// Factor and name of a base unit that is shown otherwise; prefixes of metre and newton are known.
    fn replaced(self, base: &str) -> Option<(f64, &'static str)> {
        let (prefix, plain) = match base {
            "mm" | "mN" => (1e-3, &base[1..]),
            "kN" => (1e3, "N"),
            "µm" => (1e-6, "m"),
            _ => (1.0, base),
        };
        let (scale, name) = match plain {
            "m" => self.length()?,
            "N" => self.force()?,
            "Hz" if self.frequency == Frequency::RadianPerSecond => (TAU, "rad/s"),
            _ => return None,
        };
        Some((prefix * scale, name))
    }

    fn length(self) -> Option<(f64, &'static str)> {
        match self.length {
            Length::Metre => None,
            Length::Millimetre => Some((1e3, "mm")),
            Length::Micrometre => Some((1e6, "µm")),
            Length::Inch => Some((1.0 / 0.0254, "in")),
        }
    }

    fn force(self) -> Option<(f64, &'static str)> {
        match self.force {
            Force::Newton => None,
            Force::Kilonewton => Some((1e-3, "kN")),
            Force::PoundForce => Some((1.0 / 4.448_221_615_260_5, "lbf")),
        }
    }
}

/// Base units with their powers, and what stands between them, in order.
fn tokens(unit: &str) -> Vec<&str> {
    let between = |c: char| matches!(c, '·' | ' ' | '/' | '(' | ')');
    let mut list = Vec::new();
    let mut start = 0;
    for (at, c) in unit.char_indices() {
        if between(c) {
            list.push(&unit[start..at]);
            list.push(&unit[at..at + c.len_utf8()]);
            start = at + c.len_utf8();
        }
    }
    list.push(&unit[start..]);
    list.retain(|t| !t.is_empty());
    list
}

/// A base unit and its power.
fn powered(token: &str) -> (&str, i32) {
    for (sign, power) in [("^2", 2), ("²", 2), ("^3", 3), ("³", 3)] {
        if let Some(base) = token.strip_suffix(sign) {
            return (base, power);
        }
    }
    (token, 1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "tests")]
    use super::{Acceleration, Damping, Force, Frequency, Length, Units, choose, now, shown};

    fn is(units: Units, unit: &str, factor: f64, text: &str) {
        let (own, name) = units.shown(unit);
        assert!((own / factor - 1.0).abs() < 1e-9, "{unit}: {own}, not {factor}");
        assert_eq!(name, text);
    }

    #[test]
    fn lengths_forces_and_frequencies() {
        let mm = Units { length: Length::Millimetre, ..Units::default() };
        is(mm, "m", 1e3, "mm");
        is(mm, "m/s²", 1e3, "mm/s²");
        is(mm, "mm", 1.0, "mm");
        is(mm, "rad/s^2", 1.0, "rad/s^2");
        is(mm, "ms", 1.0, "ms");
        is(mm, "kg/m^3", 1.0, "kg/m^3");
        let us = Units { length: Length::Inch, force: Force::PoundForce, ..Units::default() };
        // 1 N s/m = 0.224809 lbf s / 39.3701 in.
        is(us, "N s/m", 0.224_808_943_099_710_5 / 39.370_078_740_157_48, "lbf s/in");
        is(us, "N s^2/m^2", 0.224_808_943_099_710_5 / 1_550.003_100_006_2, "lbf s^2/in^2");
        is(us, "mN", 0.224_808_943_099_710_5e-3, "lbf");
        let rad = Units { frequency: Frequency::RadianPerSecond, ..Units::default() };
        is(rad, "Hz", std::f64::consts::TAU, "rad/s");
    }

    #[test]
    fn accelerations_in_multiples_of_free_fall() {
        let g = Units { acceleration: Acceleration::FreeFall, length: Length::Millimetre, ..Units::default() };
        is(g, "m/s²/N", 1.0 / 9.806_65, "g/N");
        is(g, "m/s^2", 1.0 / 9.806_65, "g");
        is(g, "m/N", 1e3, "mm/N");
    }

    #[test]
    fn measures_of_damping_agree() {
        let [q, dq] = Damping::Quality.of(0.02, 0.001);
        assert!((q - 25.0).abs() < 1e-12 && (dq - 1.25).abs() < 1e-12);
        let [eta, _] = Damping::LossFactor.of(0.02, 0.0);
        assert!((eta - 4.0).abs() < 1e-12);
        // The decrement of a free decay: the logarithm of the ratio of two maxima.
        let (zeta, omega) = (0.1_f64, 7.0_f64);
        let period = std::f64::consts::TAU / (omega * (1.0 - zeta * zeta).sqrt());
        let [delta, slope] = Damping::Decrement.of(zeta, 1e-6);
        assert!((delta - zeta * omega * period).abs() < 1e-12);
        let beside = Damping::Decrement.of(zeta + 1e-6, 0.0)[0];
        assert!(((beside - delta) / slope - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_thread_has_units_of_its_own() {
        choose(Units { length: Length::Inch, ..Units::default() });
        assert_eq!(shown("m").1, "in");
        assert_eq!(std::thread::spawn(|| shown("m").1).join().ok(), Some("m".to_owned()));
        choose(Units::default());
        assert_eq!(now(), Units::default());
    }
}

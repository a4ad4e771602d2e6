//! One parameter of a law: its name in files, unit, symbol, physical range and the variable in which it is fitted.

use crate::math::GREATEST;

/// One parameter of a law: its name in project files, its unit, its symbol in formulas and its physical range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files and on the command line, such as `loss_stiffness`.
    pub name: &'static str,
    /// SI unit in words of ASCII, such as `N s/m`; empty for a pure number.
    pub unit: &'static str,
    /// Symbol in formulas, such as `F_c`.
    pub symbol: &'static str,
    /// Least physical value (exclusive where the law is singular there).
    pub least: f64,
    /// Greatest physical value.
    pub greatest: f64,
    /// Whether the force is proportional to this parameter, all others fixed: the coefficient `c_j` of the energy equation.
    pub linear: bool,
    /// A sensible value for a candidate whose value is unknown; 1 for the linear one.
    pub typical: f64,
    /// Whether the limits themselves are allowed.
    pub ends: Ends,
}

/// Which limits of a range belong to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Both.
    Closed,
    /// Only the greatest.
    OpenBelow,
    /// Neither.
    Open,
}

impl Parameter {
    /// Powers of scale in the parameter: by what multiple of a common relative error of forces and motions it is wrong, as its unit
    /// has newtons and metres. `exponent` is that of a law of any power.
    pub fn powers_of_scale(&self, exponent: f64) -> f64 {
        match self.unit {
            "N" | "m" | "m/s" => 1.0,
            "N/m" | "N s/m" | "N s^a/m" | "kg" => 2.0,
            "N/m^2" | "N s^2/m^2" => 3.0,
            "N/m^3" => 4.0,
            "N (s/m)^e" => 1.0 + exponent,
            _ => 0.0,
        }
    }
}

impl Parameter {
    /// A parameter to which the force is proportional, from 0 upwards.
    pub const fn coefficient(name: &'static str, unit: &'static str, symbol: &'static str) -> Self {
        let (least, greatest) = (0.0, f64::INFINITY);
        Self { name, unit, symbol, least, greatest, linear: true, typical: 1.0, ends: Ends::Closed }
    }

    /// A parameter that shapes the force, from 0 upwards.
    pub const fn shape(name: &'static str, unit: &'static str, symbol: &'static str, typical: f64) -> Self {
        Self { linear: false, typical, ..Self::coefficient(name, unit, symbol) }
    }

    /// The same parameter within other limits.
    #[must_use]
    pub const fn within(self, least: f64, greatest: f64, ends: Ends) -> Self {
        Self { least, greatest, ends, ..self }
    }

    /// The same parameter without limits.
    #[must_use]
    pub const fn of_any_sign(self) -> Self {
        self.within(f64::NEG_INFINITY, f64::INFINITY, Ends::Closed)
    }

    /// The same parameter without its lower limit itself.
    #[must_use]
    pub const fn above(self, least: f64) -> Self {
        let greatest = self.greatest;
        self.within(least, greatest, Ends::OpenBelow)
    }

    /// Whether `value` is within the limits, and no number beyond physical quantities.
    pub fn allows(&self, value: f64) -> bool {
        let above = if self.ends == Ends::Closed { value >= self.least } else { value > self.least };
        let below = if self.ends == Ends::Open { value < self.greatest } else { value <= self.greatest };
        value.abs() <= GREATEST && above && below
    }

    /// The limits in words, such as `above 0 and at most 5`.
    pub fn range(&self) -> String {
        let above = if self.ends == Ends::Closed { "at least" } else { "above" };
        let below = if self.ends == Ends::Open { "below" } else { "at most" };
        match (self.least.is_finite(), self.greatest.is_finite()) {
            (true, true) => format!("{above} {} and {below} {}", self.least, self.greatest),
            (true, false) => format!("{above} {}", self.least),
            (false, true) => format!("{below} {}", self.greatest),
            (false, false) => "a finite number".to_string(),
        }
    }
}

//! Units as measuring systems write them, beside those of the project's own files.

use crate::measurement::Quantity;
use crate::measurement::channel::{POUND_FORCE, STANDARD_GRAVITY, Unit};

/// A unit of a laboratory file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LabUnit {
    /// Factor to SI.
    pub to_si: f64,
    /// Quantity that is measured in it.
    pub quantity: Quantity,
    /// Whether it is a unit of rotation.
    pub rotation: bool,
}

const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;

/// Spellings in lower case without blanks, brackets and carets, with their factor and quantity.
const SPELLINGS: [(&[&str], f64, Quantity); 26] = [
    (&["n", "newton", "newtons"], 1.0, Quantity::Force),
    (&["mn"], 1e-3, Quantity::Force),
    (&["kn"], 1e3, Quantity::Force),
    (&["lbf", "lb", "lbs", "pound"], POUND_FORCE, Quantity::Force),
    (&["kgf", "kp"], STANDARD_GRAVITY, Quantity::Force),
    (
        &["m/s2", "m/s²", "m/s**2", "ms-2", "m/(s2)", "m/s/s", "m*s-2", "m.s-2", "m/sec2", "m/sec²"],
        1.0,
        Quantity::Acceleration,
    ),
    (&["mm/s2", "mm/s²", "mm/s**2", "mm/sec2"], 1e-3, Quantity::Acceleration),
    (&["g", "gn", "g_n", "gs", "g's", "gravity"], STANDARD_GRAVITY, Quantity::Acceleration),
    (&["mg"], 1e-3 * STANDARD_GRAVITY, Quantity::Acceleration),
    (&["in/s2", "in/s²", "in/s**2"], INCH, Quantity::Acceleration),
    (&["ft/s2", "ft/s²", "ft/s**2"], FOOT, Quantity::Acceleration),
    (&["cm/s2", "cm/s²", "gal"], 1e-2, Quantity::Acceleration),
    (&["km/s2", "km/s²"], 1e3, Quantity::Acceleration),
    (&["ft/s"], FOOT, Quantity::Velocity),
    (&["m/s", "ms-1", "m/sec"], 1.0, Quantity::Velocity),
    (&["mm/s", "mm/sec"], 1e-3, Quantity::Velocity),
    (&["um/s", "µm/s", "μm/s"], 1e-6, Quantity::Velocity),
    (&["cm/s"], 1e-2, Quantity::Velocity),
    (&["in/s", "ips"], INCH, Quantity::Velocity),
    (&["m", "meter", "metre"], 1.0, Quantity::Displacement),
    (&["cm"], 1e-2, Quantity::Displacement),
    (&["mm"], 1e-3, Quantity::Displacement),
    (&["um", "µm", "μm", "micron", "microns"], 1e-6, Quantity::Displacement),
    (&["in", "inch", "inches"], INCH, Quantity::Displacement),
    (&["mil", "mils"], 1e-3 * INCH, Quantity::Displacement),
    (&["ft"], FOOT, Quantity::Displacement),
];

/// Units of rotation.
const ROTATIONS: [(&[&str], f64, Quantity); 13] = [
    (&["nm", "n*m", "n·m", "n-m", "n.m"], 1.0, Quantity::Force),
    (&["nmm", "n*mm", "n·mm", "n-mm", "n.mm"], 1e-3, Quantity::Force),
    (&["ncm", "n*cm", "n·cm", "n.cm"], 1e-2, Quantity::Force),
    (&["knm", "kn*m", "kn·m", "kn-m", "kn.m"], 1e3, Quantity::Force),
    (&["lbfin", "lbf*in", "lbf·in", "lbf-in", "in-lbf", "in-lb", "lb-in"], POUND_FORCE * INCH, Quantity::Force),
    (&["lbfft", "lbf*ft", "lbf·ft", "lbf-ft", "ft-lbf", "ft-lb", "lb-ft"], POUND_FORCE * FOOT, Quantity::Force),
    (&["rad/s2", "rad/s²", "rad/s**2"], 1.0, Quantity::Acceleration),
    (&["deg/s2", "deg/s²", "°/s2", "°/s²"], std::f64::consts::PI / 180.0, Quantity::Acceleration),
    (&["rad/s"], 1.0, Quantity::Velocity),
    (&["deg/s", "°/s"], std::f64::consts::PI / 180.0, Quantity::Velocity),
    (&["rad"], 1.0, Quantity::Displacement),
    (&["mrad"], 1e-3, Quantity::Displacement),
    (&["deg", "°", "degree", "degrees"], std::f64::consts::PI / 180.0, Quantity::Displacement),
];

impl LabUnit {
    /// The unit of that spelling.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        if let Some(unit) = Unit::from_name(name) {
            return Some(Self { to_si: unit.to_si, quantity: unit.quantity, rotation: unit.rotation });
        }
        let plain: String = name.chars().filter(|c| !c.is_whitespace() && !matches!(c, '^' | '[' | ']')).collect();
        // Capital letters matter in a few places: mN is a millinewton, MN is not read; Nm is a moment, nm a nanometre of a vibrometer.
        match plain.as_str() {
            "MN" | "Mg" => return None,
            "nm" => return Some(Self { to_si: 1e-9, quantity: Quantity::Displacement, rotation: false }),
            "nm/s" => return Some(Self { to_si: 1e-9, quantity: Quantity::Velocity, rotation: false }),
            _ => {}
        }
        let plain = plain.to_lowercase().replace('⁻', "-").replace("s-²", "s-2").replace("·s-", "*s-");
        let find = |list: &[(&[&str], f64, Quantity)], rotation| {
            let found = list.iter().find(|(spellings, ..)| spellings.contains(&plain.as_str()));
            found.map(|&(_, to_si, quantity)| Self { to_si, quantity, rotation })
        };
        find(&SPELLINGS, false).or_else(|| find(&ROTATIONS, true))
    }

    /// Whether a quantity is measured in it; that of a base is the acceleration along a direction.
    pub(crate) fn measures(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Base => self.quantity == Quantity::Acceleration && !self.rotation,
            other => self.quantity == other,
        }
    }

    /// Units of a quantity for a message.
    pub(crate) fn names_of(quantity: Quantity) -> &'static str {
        match quantity {
            Quantity::Force => "N, mN, kN, lbf, kgf, N m",
            Quantity::Base => "m/s^2, mm/s^2, g, mg, in/s^2, ft/s^2",
            Quantity::Acceleration => "m/s^2, mm/s^2, g, mg, in/s^2, ft/s^2, rad/s^2, deg/s^2",
            Quantity::Velocity => "m/s, mm/s, cm/s, in/s, rad/s, deg/s",
            Quantity::Displacement => "m, cm, mm, um, in, mil, ft, rad, mrad, deg",
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn spellings_of_laboratories() {
        let si = |name: &str| LabUnit::from_name(name).map(|unit| (unit.to_si, unit.quantity, unit.rotation));
        assert_eq!(si("g"), Some((9.806_65, Quantity::Acceleration, false)));
        assert_eq!(si("m/s²"), Some((1.0, Quantity::Acceleration, false)));
        assert_eq!(si("(m/s^2)"), None);
        assert_eq!(si("mm/s^2"), Some((1e-3, Quantity::Acceleration, false)));
        assert_eq!(si("mN"), Some((1e-3, Quantity::Force, false)));
        assert_eq!(si("MN"), None);
        assert_eq!(si("deg"), Some((std::f64::consts::PI / 180.0, Quantity::Displacement, true)));
        assert_eq!(si("Volts"), None);
        assert_eq!(si("m/sec^2"), Some((1.0, Quantity::Acceleration, false)));
        assert_eq!(si("µm/s"), Some((1e-6, Quantity::Velocity, false)));
        assert_eq!(si("Nm"), Some((1.0, Quantity::Force, true)));
        assert_eq!(si("N mm"), Some((1e-3, Quantity::Force, true)));
        assert_eq!(si("kN·m"), Some((1e3, Quantity::Force, true)));
        assert_eq!(si("nm"), Some((1e-9, Quantity::Displacement, false)));
        let along = |name: &str| LabUnit::from_name(name).unwrap().measures(Quantity::Base);
        assert!(along("g") && !along("rad/s^2") && !along("mm"));
    }
}

//! What can be wrong with a channel, in words.

use crate::effects::{Kind, Source};
use crate::math::numerals::compact;
use crate::measurement::Quantity;
use crate::measurement::channel::{POUND_FORCE, STANDARD_GRAVITY};

const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
/// Logarithm of a gain up to which it is one that measuring chains have.
const ORDINARY_GAIN: f64 = 0.08;

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// A channel reads that many times its true value; -1: it is reversed.
    Factor(f64),
    /// All motions together, or the force against all motions, read that many times their true value.
    Common(f64),
    /// Two channels are at each other's place.
    Exchanged,
    /// A sensor or a force is at another DOF than is said: at this row.
    Elsewhere(usize),
    /// A channel is recorded that many seconds after the others; early where it is negative.
    Late(f64),
    /// What a channel reads scatters by that much from run to run, relative: it is loose, or late, or its gain drifts. It is
    /// kept, with that as the deviation of what it reads.
    Unreliable(f64),
}

/// A fault of one channel, or of two that are exchanged.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelFault {
    /// What is wrong.
    pub fault: Fault,
    /// Names, such as `acc@7`: one, the two that are exchanged, all that have a fault in common, or that of a channel elsewhere
    /// and what it is called there.
    pub channels: Vec<String>,
    /// Error of the model over all channels before it is mended, relative, modes nearby free.
    pub error_before: f64,
    /// The same once it is mended.
    pub error_after: f64,
    /// Error of the channels concerned alone, before and after.
    pub own_error: [f64; 2],
    /// Frequencies that show it, of those at which the channels move enough.
    pub frequencies: [usize; 2],
}

impl ChannelFault {
    /// The fault in a sentence, such as `acc@3 looks reversed`.
    pub fn words(&self) -> String {
        let name = &self.channels[0];
        match self.fault {
            Fault::Exchanged => format!("{name} and {} look exchanged", self.channels[1]),
            Fault::Elsewhere(_) => {
                let place = self.channels[1].split('@').nth(1).unwrap_or_default();
                if name.starts_with("force@") {
                    format!("{name} fits the motion of the model at DOF {place}: was the force there?")
                } else {
                    format!("{name} fits the motion of the model at DOF {place}: is the sensor there?")
                }
            }
            Fault::Unreliable(scatter) => {
                format!(
                    "{name} does not fit the other channels by {} % from run to run: loose?",
                    compact(100.0 * scatter, 3)
                )
            }
            Fault::Common(factor) => common_words(&self.channels, factor),
            Fault::Late(delay) => {
                let size = compact(1e3 * delay.abs(), 3);
                if delay < 0.0 {
                    format!("{name} is recorded {size} ms early")
                } else {
                    format!("{name} is recorded {size} ms late")
                }
            }
            Fault::Factor(factor) => {
                let reads = if factor < 0.0 { " looks reversed and reads" } else { " reads" };
                if factor == -1.0 {
                    return format!("{name} looks reversed");
                }
                let size = factor.abs();
                let (times, which) = if size > 1.0 { (size, "large") } else { (1.0 / size, "small") };
                let why = reason(name, size).map_or_else(String::new, |why| format!(": {why}?"));
                format!("{name}{reads} {} times too {which}{why}", compact(times, 3))
            }
        }
    }

    /// Why, in a sentence with numbers.
    pub fn evidence(&self) -> String {
        let percent = |x: f64| compact(100.0 * x, 3);
        if let Fault::Unreliable(_) = self.fault {
            return "kept with that as its deviation; look at its mounting, its cable and its timing".to_owned();
        }
        let [before, after] = self.own_error.map(percent);
        let [shown, of] = self.frequencies;
        if let Fault::Late(_) = self.fault {
            return format!(
                "its phase against the other channels turns in proportion to the frequency, which no law does: what the best model \
                 leaves falls from {before} % to {after} %"
            );
        }
        if let Fault::Common(_) = self.fault {
            return format!(
                "the masses of {shown} of {of} modes with runs about them say so, whatever their frequencies and damping: the error \
                 of the masses falls from {before} % to {after} %"
            );
        }
        if let (Fault::Elsewhere(_), true) = (self.fault, self.channels[0].starts_with("force@")) {
            return format!(
                "the shapes of {shown} of {of} modes say so by force over modal amplitude next to them, whatever their frequencies \
                 and damping: their error falls from {before} % to {after} %"
            );
        }
        let what = if self.fault == Fault::Exchanged { "their" } else { "its" };
        format!(
            "{what} own error falls from {before} % to {after} %, at {shown} of {of} frequencies, whatever the amplitudes \
             of the modes nearby"
        )
    }
}

/// A fault that channels have in common, in a sentence.
fn common_words(channels: &[String], factor: f64) -> String {
    let name = &channels[0];
    let (who, look, read) = match channels.len() {
        1 => (name.clone(), "looks", "reads"),
        count => (format!("all {count} {} channels", name.split('@').next().unwrap_or_default()), "look", "read"),
    };
    let size = factor.abs();
    if size == 1.0 {
        return format!(
            "{who} {look} reversed against the {}",
            if name.starts_with("force@") { "motions" } else { "force" }
        );
    }
    let turned = if factor < 0.0 { format!(" {look} reversed and") } else { String::new() };
    let (times, which) = if size > 1.0 { (size, "large") } else { (1.0 / size, "small") };
    let why = reason(name, size).map_or_else(String::new, |why| format!(": {why}?"));
    format!("{who}{turned} {read} {} times too {which}{why}", compact(times, 3))
}

/// A factor by which channels are misread, and by what.
struct Misreading {
    factor: f64,
    quantity: Option<Quantity>,
    why: &'static str,
}

/// Largest relative distance of what is seen from the factor of a misreading.
const WITHIN: f64 = 0.1;
/// The same of what modal masses say.
const ROUGHLY: f64 = 0.25;

/// By how much nearer, relative, an amplifier must be than a unit: people mistake units more often, and a model that is off
/// shows a factor to some per cent, while 10 and the 9.81 of g are 2 % apart.
const RARER: f64 = 0.01;
/// Relative distance within which two factors are hardly told apart.
const ALIKE: f64 = 0.03;

const fn misreading(factor: f64, quantity: Option<Quantity>, why: &'static str) -> Misreading {
    Misreading { factor, quantity, why }
}

/// Factors on what is true, each also as its inverse. Smaller ones (peak read as rms: 1.41) are no plain faults: a wrong gain
/// of that size is left to the law `gain`, which estimates it.
fn misreadings() -> Vec<Misreading> {
    use Quantity::{Acceleration, Displacement, Force, Velocity};
    let both_ways = |quantity, factor, larger, smaller| {
        [misreading(factor, Some(quantity), larger), misreading(1.0 / factor, Some(quantity), smaller)]
    };
    let any = |factor, larger, smaller| [misreading(factor, None, larger), misreading(1.0 / factor, None, smaller)];
    [
        both_ways(Acceleration, STANDARD_GRAVITY, "m/s^2 read as g", "g read as m/s^2"),
        both_ways(Acceleration, STANDARD_GRAVITY / INCH, "in/s^2 read as g", "g read as in/s^2"),
        both_ways(Acceleration, STANDARD_GRAVITY / FOOT, "ft/s^2 read as g", "g read as ft/s^2"),
        both_ways(Acceleration, 1e3 * STANDARD_GRAVITY, "mm/s^2 read as g", "g read as mm/s^2"),
        both_ways(Acceleration, 1e3, "mm/s^2 read as m/s^2, or mg as g", "m/s^2 read as mm/s^2, or g as mg"),
        both_ways(Acceleration, 1.0 / INCH, "in/s^2 read as m/s^2", "m/s^2 read as in/s^2"),
        both_ways(Acceleration, 1.0 / FOOT, "ft/s^2 read as m/s^2", "m/s^2 read as ft/s^2"),
        both_ways(Force, POUND_FORCE, "N read as lbf", "lbf read as N"),
        both_ways(Force, STANDARD_GRAVITY, "N read as kgf", "kgf read as N"),
        both_ways(Force, 1e3, "N read as kN, or mN as N", "kN read as N, or N as mN"),
        both_ways(Velocity, 1e3, "mm/s read as m/s", "m/s read as mm/s"),
        both_ways(Velocity, 1.0 / INCH, "in/s read as m/s", "m/s read as in/s"),
        both_ways(Velocity, 1e3 * INCH, "mm/s read as in/s", "in/s read as mm/s"),
        both_ways(Displacement, 1e3, "mm read as m, or um as mm", "m read as mm, or mm as um"),
        both_ways(Displacement, 1e6, "um read as m", "m read as um"),
        both_ways(Displacement, 1.0 / INCH, "in read as m", "m read as in"),
        both_ways(Displacement, 1e3 * INCH, "mm read as in, or um as mil", "in read as mm, or mil as um"),
        any(180.0 / std::f64::consts::PI, "degrees read as radians", "radians read as degrees"),
        any(100.0, "cm read as m, or an amplifier at 100", "m read as cm, or an amplifier at 0.01"),
        any(10.0, "an amplifier set to 10", "an amplifier set to 0.1"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

pub(super) fn quantity_of(name: &str) -> Option<Quantity> {
    Quantity::from_word(name.split('@').next().unwrap_or_default())
}

/// The factor of a known misreading of a channel next to `seen` (positive), if one is near enough.
pub(super) fn known_factor(name: &str, seen: f64) -> Option<f64> {
    known(name, seen, WITHIN, true)
}

/// The same of its unit alone and of a rougher number: what all channels have in common is hardly an amplifier.
pub(super) fn known_unit(name: &str, seen: f64) -> Option<f64> {
    known(name, seen, ROUGHLY, false)
}

fn known(name: &str, seen: f64, within: f64, amplifiers: bool) -> Option<f64> {
    let quantity = quantity_of(name);
    let distance = |m: &Misreading| (seen / m.factor).ln().abs();
    misreadings()
        .iter()
        .filter(|m| (amplifiers && m.quantity.is_none()) || m.quantity == quantity)
        .filter(|m| distance(m) < within)
        .min_by(|a, b| weighed(distance(a), a).total_cmp(&weighed(distance(b), b)))
        .map(|m| m.factor)
}

/// The distance of what is seen from a misreading, further where it is no unit.
fn weighed(distance: f64, misreading: &Misreading) -> f64 {
    if misreading.quantity.is_some() { distance } else { distance + RARER }
}

fn reason(name: &str, size: f64) -> Option<String> {
    let quantity = quantity_of(name);
    let all = misreadings();
    let same = |m: &&Misreading| (m.quantity.is_none() || m.quantity == quantity) && m.factor == size;
    let found = all.iter().find(same)?;
    // A unit that no test tells from it.
    let alike =
        |m: &&Misreading| m.quantity.is_some() && m.quantity == quantity && (m.factor / size).ln().abs() < ALIKE;
    let unit = all.iter().filter(|_| found.quantity.is_none()).find(alike);
    Some(unit.map_or_else(|| found.why.to_owned(), |unit| format!("{}, or {}", found.why, unit.why)))
}

/// Whether an effect is a factor on a channel that measuring chains have.
pub(crate) fn is_ordinary_gain(source: &Source) -> bool {
    let Kind::Channel(law) = source.effect.kind() else { return false };
    law.neutral() != 0.0 && (source.parameters[0] / law.neutral()).ln().abs() < ORDINARY_GAIN
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(fault: Fault, channels: &[&str]) -> ChannelFault {
        let channels = channels.iter().map(|name| (*name).to_owned()).collect();
        let (own_error, frequencies) = ([1.0, 0.01], [6, 6]);
        ChannelFault { fault, channels, error_before: 0.5, error_after: 0.01, own_error, frequencies }
    }

    #[test]
    fn faults_are_said_in_the_words_of_the_laboratory() {
        assert_eq!(fault(Fault::Factor(-1.0), &["acc@3"]).words(), "acc@3 looks reversed");
        assert_eq!(fault(Fault::Exchanged, &["acc@7", "acc@11"]).words(), "acc@7 and acc@11 look exchanged");
        let g = fault(Fault::Factor(STANDARD_GRAVITY), &["acc@5"]).words();
        assert_eq!(g, "acc@5 reads 9.81 times too large: m/s^2 read as g?");
        let all = fault(Fault::Common(1.0 / STANDARD_GRAVITY), &["acc@3", "acc@5"]).words();
        assert_eq!(all, "all 2 acc channels read 9.81 times too small: g read as m/s^2?");
        assert_eq!(fault(Fault::Common(-1.0), &["force@19"]).words(), "force@19 looks reversed against the motions");
        let pounds = fault(Fault::Common(POUND_FORCE), &["force@19"]).words();
        assert_eq!(pounds, "force@19 reads 4.45 times too large: N read as lbf?");
        let amplifier = fault(Fault::Factor(0.1), &["acc@5"]).words();
        assert_eq!(amplifier, "acc@5 reads 10 times too small: an amplifier set to 0.1, or g read as m/s^2?");
        let laser = fault(Fault::Factor(0.1), &["vel@5"]).words();
        assert_eq!(laser, "vel@5 reads 10 times too small: an amplifier set to 0.1?");
        let small = fault(Fault::Factor(-1e-3), &["disp@5"]).words();
        assert_eq!(small, "disp@5 looks reversed and reads 1000 times too small: m read as mm, or mm as um?");
    }

    #[test]
    fn only_factors_that_somebody_misreads_are_known() {
        assert_eq!(known_factor("acc@5", 9.6), Some(STANDARD_GRAVITY));
        assert_eq!(known_factor("acc@5", 0.1007), Some(1.0 / STANDARD_GRAVITY));
        assert_eq!(known_factor("acc@5", 0.1), Some(0.1));
        assert_eq!(known_factor("disp@5", 1010.0), Some(1e3));
        assert_eq!(known_factor("vel@5", 1.42), None);
        assert_eq!(known_factor("acc@5", 1.2), None);
        assert_eq!(known_factor("disp@5", 386.0), None);
    }
}

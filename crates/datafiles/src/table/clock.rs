//! Clocks in several columns: a date, the time of day, parts of a second.

use super::block::{Block, Numbers};
use super::header::Header;

/// Seconds of a day.
const DAY: f64 = 86400.0;

/// Times of day that begin anew at midnight go on over it; says so.
pub(super) fn pass_midnight(block: &mut Block) -> Option<String> {
    let of_day = |column: &&mut Numbers| column.clock && column.re.iter().all(|value| (0.0..DAY).contains(value));
    let mut passed = false;
    for column in block.columns.iter_mut().take(2).filter(of_day) {
        let (mut days, mut before) = (0.0, f64::NEG_INFINITY);
        for value in &mut column.re {
            // Times in disorder stay what they are: only a fall by most of a day is midnight.
            days += if before - *value > 0.5 * DAY { DAY } else { 0.0 };
            before = *value;
            *value += days;
        }
        passed |= days > 0.0;
    }
    passed.then(|| "the clock passes midnight: the times go on over it".to_owned())
}

/// A column of dates and one of times of day behind it are one clock.
pub(super) fn join_date(header: &mut Header, block: &mut Block) {
    let [dates, times, ..] = &mut block.columns[..] else { return };
    let whole = |values: &[f64]| values.iter().all(|value| value % DAY == 0.0);
    let same = dates.re.len() == times.re.len() && dates.clock && times.clock;
    if same && whole(&dates.re) && !whole(&times.re) && times.re.iter().all(|value| (0.0..DAY).contains(value)) {
        times.re.iter_mut().zip(&dates.re).for_each(|(time, date)| *time += date);
        *dates = Numbers::default();
        header.names[0].clear();
        header.units[0].clear();
    }
}

/// A column of parts of a second behind a clock (`Date;Time;ms`) belongs to it.
pub(super) fn join_fractions(header: &mut Header, block: &mut Block) {
    for i in 1..block.columns.len().min(3) {
        let Some(part) = part_of_second(&header.names[i], &header.units[i]) else { continue };
        let (clock, fractions) = block.columns.split_at_mut(i);
        let (clock, fractions) = (&mut clock[i - 1], &mut fractions[0]);
        let within = |value: &f64| (0.0..1.0).contains(&(value * part));
        if clock.clock && clock.re.len() == fractions.re.len() && fractions.re.iter().all(within) {
            clock.re.iter_mut().zip(&fractions.re).for_each(|(time, fraction)| *time += fraction * part);
            *fractions = Numbers::default();
            header.names[i].clear();
            header.units[i].clear();
            return;
        }
    }
}

/// What one of a column of parts of a second is, s.
fn part_of_second(name: &str, unit: &str) -> Option<f64> {
    let word: String = name.chars().filter(|c| c.is_alphabetic()).collect::<String>().to_lowercase();
    let said = if word.is_empty() { unit.trim().to_lowercase() } else { word };
    let is = |list: &[&str]| list.contains(&said.as_str());
    if is(&["ms", "msec", "msecs", "millis", "milliseconds", "millisecond", "millisec", "millisekunden"]) {
        return Some(1e-3);
    }
    is(&["us", "µs", "usec", "micros", "microseconds", "microsecond", "microsec", "mikrosekunden"]).then_some(1e-6)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::text;
    use uff::Values;

    /// A date, a time of day in whole seconds and the milliseconds are one clock, over midnight.
    #[test]
    fn milliseconds_behind_a_clock_belong_to_it() {
        let mut table = "Datum;Zeit;ms;Kraft [N]\n".to_owned();
        for i in 0..2000 {
            let ms = 500 + 2 * i;
            let (day, second) = if ms < 2000 { ("04.05.2023", 58 + ms / 1000) } else { ("05.05.2023", ms / 1000 - 2) };
            let clock = if ms < 2000 { format!("23:59:{second}") } else { format!("00:00:{second:02}") };
            table.push_str(&format!("{day};{clock};{};{i},5\n", ms % 1000));
        }
        let (contents, source) = text::read(table.as_bytes()).unwrap();
        let set = &contents.sets[0];
        assert_eq!(set.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>(), ["Kraft"]);
        assert!(
            set.channels[0].axis.step().is_some_and(|step| (step - 0.002).abs() < 1e-6),
            "{:?}",
            set.channels[0].axis
        );
        let times = source.axis(0, 0).unwrap();
        assert!((times[1999] - times[0] - 1999.0 * 0.002).abs() < 1e-6);
        assert!(matches!(source.read(0, 0).unwrap(), Values::Real(values) if values[3] == 3.5));
    }
}

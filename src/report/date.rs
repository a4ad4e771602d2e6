//! The date of a report.

/// Days from 1 March 0000 to 1 January 1970.
const EPOCH: i64 = 719_468;
/// Days of 400 years.
const ERA: i64 = 146_097;

/// The day of an instant, seconds since the beginning of 1970 (UTC), as `2026-11-25`.
pub(super) fn day(since_1970_s: f64) -> String {
    let [year, month, day] = civil((since_1970_s / 86_400.0).floor() as i64);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Year, month and day of a day counted from 1 January 1970, Gregorian; years begin in March, so that the leap day is their last.
fn civil(days: i64) -> [i64; 3] {
    let shifted = days + EPOCH;
    let era = shifted.div_euclid(ERA);
    let of_era = shifted.rem_euclid(ERA);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / (ERA - 1)) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    [year + 400 * era + i64::from(month <= 2), month, day]
}

#[cfg(test)]
mod tests {
    use super::{civil, day};

    /// Against a calendar that is counted day by day.
    #[test]
    fn every_day_of_400_years_follows_the_one_before() {
        let [mut y, mut m, mut d] = [1900_i64, 1_i64, 1_i64];
        for k in -25_567..(-25_567 + super::ERA) {
            assert_eq!(civil(k), [y, m, d], "day {k}");
            let leap = y % 4 == 0 && (y % 100 != 0 || y % 400 == 0);
            let last = [31, 28 + i64::from(leap), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31][m as usize - 1];
            [y, m, d] = match (d == last, m) {
                (false, _) => [y, m, d + 1],
                (true, 12) => [y + 1, 1, 1],
                (true, _) => [y, m + 1, 1],
            };
        }
    }

    #[test]
    fn an_instant_has_its_day() {
        assert_eq!(day(0.0), "1970-01-01");
        assert_eq!(day(951_868_799.0), "2000-02-29");
        assert_eq!(day(-1.0), "1969-12-31");
    }
}

//! A limit to the time that a computation may take: then it answers with the best that it has.

use super::validation::has_records;
use crate::control::Control;
use crate::exchange::Project;
use std::time::Duration;

/// Share of a limit after which a search in which records take part ends: the fits of whole records by which it concludes take the rest.
const OF_RECORDS: f64 = 0.65;

/// Hurries the search of a project, so that it answers within about `limit`.
pub fn answer_within(control: &Control, project: &Project, limit: Duration) {
    hurry_after(control, if has_records(project) { limit.mul_f64(OF_RECORDS) } else { limit });
}

/// Hurries the work of `control` once `time` has passed.
#[expect(clippy::disallowed_methods, reason = "a clock, no work: it ends with its sleep or with the program")]
pub fn hurry_after(control: &Control, time: Duration) {
    let control = control.clone();
    std::thread::spawn(move || {
        std::thread::sleep(time);
        control.hurry();
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_hurried_when_its_time_is_up() {
        let control = Control::unattended();
        hurry_after(&control, Duration::from_millis(5));
        for _ in 0..2000 {
            if control.is_late() {
                return;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("ten seconds after a limit of five milliseconds");
    }
}

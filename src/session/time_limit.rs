//! A limit to the time that a computation may take: then it answers with the best that it has.

use crate::control::Control;
use std::time::Duration;

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

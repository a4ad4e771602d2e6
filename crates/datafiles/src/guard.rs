//! A last defence: a library that panics on a damaged file makes an error, as any other damage does.

use crate::error::{Fault, Read};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work`; a panic becomes a fault and prints nothing.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Read<T>) -> Read<T> {
    quiet_hook();
    let before = GUARDED.replace(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(before);
    done.unwrap_or_else(|_| Err(Fault::new("is damaged; its reader gave up on it: export it again")))
}

/// Keeps panics that are caught here off the screen; all others are shown as before.
fn quiet_hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                others(info);
            }
        }));
    });
}

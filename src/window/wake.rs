//! Waking the window from the thread of a job, without keeping the window alive.
//!
//! A context holds the graphics device. Were the last context dropped on the thread of a job, the device would be taken
//! down there, and the process crashes where it ends at the same moment.

use egui::mutex::Mutex;
use egui::{Context, Id};
use std::fmt;
use std::sync::Arc;

/// The window that jobs wake, until it is [silent](Guard).
#[derive(Clone, Default)]
pub struct Bell(Arc<Mutex<Option<Context>>>);

impl Bell {
    /// The one of this window.
    pub fn of(ctx: &Context) -> Self {
        let new = || Self(Arc::new(Mutex::new(Some(ctx.clone()))));
        ctx.data_mut(|d| d.get_temp_mut_or_insert_with(Id::NULL.with("bell"), new).clone())
    }

    /// Asks for a frame.
    pub fn ring(&self) {
        if let Some(ctx) = &*self.0.lock() {
            ctx.request_repaint();
        }
    }

    /// Forgets the window: no job holds anything of it after this.
    fn silence(&self) {
        *self.0.lock() = None;
    }
}

impl fmt::Debug for Bell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Bell")
    }
}

/// Silences the bell of a window where the state of the window ends.
#[derive(Debug, Default)]
pub struct Guard(Option<Bell>);

impl Guard {
    /// Guards the bell of this window.
    pub fn watch(&mut self, ctx: &Context) {
        self.0.get_or_insert_with(|| Bell::of(ctx));
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if let Some(bell) = &self.0 {
            bell.silence();
        }
    }
}

/// What a job calls once its result waits.
pub fn wake(ctx: &Context) -> impl FnOnce() + Send + use<> + 'static {
    let bell = Bell::of(ctx);
    move || bell.ring()
}

#[cfg(test)]
mod tests {
    use super::{Guard, wake};
    use egui::Context;
    use std::sync::Arc;

    #[test]
    fn a_job_asks_for_a_frame() {
        let ctx = Context::default();
        wake(&ctx)();
        assert!(ctx.has_requested_repaint());
    }

    #[test]
    fn a_job_does_not_keep_a_closed_window() {
        let ctx = Context::default();
        let witness = Arc::new(());
        ctx.data_mut(|d| d.insert_temp(egui::Id::NULL, Arc::clone(&witness)));
        let late = wake(&ctx);
        let mut guard = Guard::default();
        guard.watch(&ctx);
        drop((guard, ctx));
        assert_eq!(Arc::strong_count(&witness), 1, "what the window held is gone while the job lives");
        late();
    }
}

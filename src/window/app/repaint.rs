//! Asking for a frame of the window from the thread of a job, without keeping the window alive.
//!
//! A context holds the graphics device. Were the last context dropped on the thread of a job, the device would be taken
//! down there, and the process crashes where it ends at the same moment.

use egui::mutex::Mutex;
use egui::{Context, Id};
use std::fmt;
use std::sync::Arc;

/// The window that jobs ask for a frame, until the [guard](RepaintGuard) is dropped.
#[derive(Clone, Default)]
pub(crate) struct RepaintHandle(Arc<Mutex<Option<Context>>>);

impl RepaintHandle {
    /// The one of this window.
    pub(crate) fn of(ctx: &Context) -> Self {
        let new = || Self(Arc::new(Mutex::new(Some(ctx.clone()))));
        ctx.data_mut(|d| d.get_temp_mut_or_insert_with(Id::NULL.with("handle"), new).clone())
    }

    /// Asks for a frame.
    pub(crate) fn request(&self) {
        if let Some(ctx) = &*self.0.lock() {
            ctx.request_repaint();
        }
    }

    /// Forgets the window: no job holds anything of it after this.
    fn forget_window(&self) {
        *self.0.lock() = None;
    }
}

impl fmt::Debug for RepaintHandle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("RepaintHandle")
    }
}

/// Takes the window from the handle where the state of the window ends.
#[derive(Debug, Default)]
pub(crate) struct RepaintGuard(Option<RepaintHandle>);

impl RepaintGuard {
    /// Guards the handle of this window.
    pub(crate) fn watch(&mut self, ctx: &Context) {
        self.0.get_or_insert_with(|| RepaintHandle::of(ctx));
    }
}

impl Drop for RepaintGuard {
    fn drop(&mut self) {
        if let Some(handle) = &self.0 {
            handle.forget_window();
        }
    }
}

/// What a job calls once its result waits.
pub(crate) fn request_repaint(ctx: &Context) -> impl FnOnce() + Send + use<> + 'static {
    let handle = RepaintHandle::of(ctx);
    move || handle.request()
}

#[cfg(test)]
mod tests {
    use super::{RepaintGuard, request_repaint};
    use egui::Context;
    use std::sync::Arc;

    #[test]
    fn a_job_asks_for_a_frame() {
        let ctx = Context::default();
        request_repaint(&ctx)();
        assert!(ctx.has_requested_repaint());
    }

    #[test]
    fn a_job_does_not_keep_a_closed_window() {
        let ctx = Context::default();
        let witness = Arc::new(());
        ctx.data_mut(|d| d.insert_temp(egui::Id::NULL, Arc::clone(&witness)));
        let late = request_repaint(&ctx);
        let mut guard = RepaintGuard::default();
        guard.watch(&ctx);
        drop((guard, ctx));
        assert_eq!(Arc::strong_count(&witness), 1, "what the window held is gone while the job lives");
        late();
    }
}

//! What is chosen on the page of laws, and what was computed of it.

use super::lesson::Lesson;
use crate::control::Control;
use crate::response::portrait::{Portrait, portrait};
use crate::window::background::cache::{Background, Cache, Cached};
use egui::Context;

/// The page: what is chosen, and what was computed of it.
#[derive(Debug)]
pub struct Learn {
    /// Whether it is open.
    pub open: bool,
    /// What is looked at.
    pub lesson: Lesson,
    portraits: Cache<Lesson, Portrait>,
    /// The last one, shown while the next is computed.
    pub(super) last: Option<Cached<Portrait>>,
}

impl Default for Learn {
    fn default() -> Self {
        Self { open: false, lesson: Lesson::default(), portraits: Cache::of_last("Laws"), last: None }
    }
}

impl Learn {
    /// Name and progress of what runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.portraits.running()
    }

    /// Gives up what runs.
    pub fn cancel(&mut self) {
        self.portraits.cancel();
    }

    /// Asks for what is chosen, and takes over what was computed.
    pub(super) fn update(&mut self, ctx: &Context) {
        let lesson = self.lesson.clone();
        let work = || {
            move |control: &Control| {
                let setup = lesson.setup().map_err(|e| e.to_string())?;
                portrait(&setup, control).map_err(|e| e.to_string())
            }
        };
        if let Some(found) = self.portraits.obtain(ctx, &self.lesson, work) {
            self.last = Some(found);
        }
    }
}

//! Progress and cancellation of a long computation, passed down to every function that may take more than a frame.

use std::fmt::Debug;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The computation was asked to stop and did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Who does independent pieces of work, perhaps several at a time. The engine has no threads of its own; whoever calls it
/// may lend some.
pub trait Workers: Debug + Send + Sync {
    /// Calls `piece` once with every number below `count`, in any order, and returns when all are done.
    fn each(&self, count: usize, piece: &(dyn Fn(usize) + Sync));
}

/// A handle shared by whoever waits and whoever works. Cloning shares the same state.
#[derive(Debug, Clone)]
pub struct Control {
    cancelled: Arc<AtomicBool>,
    parts_per_million: Arc<AtomicU32>,
    workers: Option<Arc<dyn Workers>>,
    /// Whether what is asked for should be answered with the best so far.
    hurried: Arc<AtomicBool>,
    /// Whether something was left undone for that.
    cut_short: Arc<AtomicBool>,
    /// Where this part of the work starts and ends in the whole.
    span: [f64; 2],
}

impl Default for Control {
    fn default() -> Self {
        Self {
            cancelled: Arc::default(),
            parts_per_million: Arc::default(),
            workers: None,
            hurried: Arc::default(),
            cut_short: Arc::default(),
            span: [0.0, 1.0],
        }
    }
}

impl Control {
    /// A control that nobody watches and nobody cancels.
    pub fn unattended() -> Self {
        Self::default()
    }

    /// The same control with others to share independent work among.
    #[must_use]
    pub fn with_workers(self, workers: Arc<dyn Workers>) -> Self {
        Self { workers: Some(workers), ..self }
    }

    /// The same control without others to share work among: for what several pieces of work wait for, whose threads would else be lent to
    /// one another.
    #[must_use]
    pub fn alone(&self) -> Self {
        Self { workers: None, ..self.clone() }
    }

    /// The same control that is never late: for what an answer cannot do without.
    #[must_use]
    pub fn unhurried(&self) -> Self {
        Self { hurried: Arc::default(), ..self.clone() }
    }

    /// Asks the computation to answer with the best that it has so far.
    pub fn hurry(&self) {
        self.hurried.store(true, Ordering::Relaxed);
    }

    /// Whether [`Control::hurry`] was called; work that asks and hears yes leaves the rest undone, which
    /// [`Control::is_complete`] tells.
    pub fn is_late(&self) -> bool {
        let late = self.hurried.load(Ordering::Relaxed);
        if late {
            self.cut_short.store(true, Ordering::Relaxed);
        }
        late
    }

    /// Whether nothing was left undone for want of time.
    pub fn is_complete(&self) -> bool {
        !self.cut_short.load(Ordering::Relaxed)
    }

    /// `piece` of every number below `count`, in order; what it gives must not depend on the order in which it is asked.
    pub fn map<T: Send>(&self, count: usize, piece: impl Fn(usize) -> T + Sync) -> Vec<T> {
        let Some(workers) = self.workers.as_ref().filter(|_| count > 1) else { return (0..count).map(piece).collect() };
        let done: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
        workers.each(count, &|k| {
            let value = piece(k);
            *done[k].lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
        });
        let taken = done.into_iter().enumerate();
        // A piece that was left out is done here.
        let value = |(k, slot): (usize, Mutex<Option<T>>)| {
            slot.into_inner().unwrap_or_else(PoisonError::into_inner).unwrap_or_else(|| piece(k))
        };
        taken.map(value).collect()
    }

    /// The same control for piece number `index` of `count` pieces of this work: what the piece reports moves the progress
    /// of the whole through its share.
    #[must_use]
    pub fn piece(&self, index: usize, count: usize) -> Self {
        let [from, to] = self.span;
        let share = |k: usize| from + (to - from) * (k as f64 / count.max(1) as f64).min(1.0);
        Self { span: [share(index), share(index + 1)], ..self.clone() }
    }

    /// Moves the progress by this share of what remains: for searches whose length nobody knows beforehand.
    pub fn advance(&self, share: f64) {
        let [from, to] = self.span;
        let now = if to > from { (self.progress() - from) / (to - from) } else { 1.0 }.clamp(0.0, 1.0);
        self.report(now + (1.0 - now) * share.clamp(0.0, 1.0));
    }

    /// States the share of this work that is done, 0 to 1.
    pub fn report(&self, fraction: f64) {
        let [from, to] = self.span;
        let ppm = ((from + (to - from) * fraction.clamp(0.0, 1.0)) * 1e6) as u32;
        self.parts_per_million.store(ppm, Ordering::Relaxed);
    }

    /// The share of the whole work that is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        f64::from(self.parts_per_million.load(Ordering::Relaxed)) * 1e-6
    }

    /// Asks the computation to stop at its next check.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Fails with [`Cancelled`] once [`Control::cancel`] was called; call it in every outer loop.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Does the odd pieces first and forgets the last one.
    #[derive(Debug)]
    struct Unruly;

    impl Workers for Unruly {
        fn each(&self, count: usize, piece: &(dyn Fn(usize) + Sync)) {
            (0..count - 1).filter(|k| k % 2 == 1).chain((0..count - 1).filter(|k| k % 2 == 0)).for_each(piece);
        }
    }

    #[test]
    fn work_that_is_cut_short_says_so() {
        let control = Control::unattended();
        assert!(!control.is_late() && control.is_complete());
        control.hurry();
        assert!(control.is_complete() && control.is_late() && !control.clone().is_complete());
    }

    #[test]
    fn pieces_come_back_in_order_whoever_does_them() {
        let control = Control::unattended().with_workers(Arc::new(Unruly));
        assert_eq!(control.map(7, |k| k * k), Control::unattended().map(7, |k| k * k));
    }

    #[test]
    fn pieces_move_one_progress_on_and_are_cancelled_together() {
        let control = Control::unattended();
        let mut seen = Vec::new();
        for k in 0..3 {
            let piece = control.piece(k, 3);
            for part in 0..2 {
                let inner = piece.piece(part, 2);
                inner.advance(0.5);
                seen.push(control.progress());
                inner.report(1.0);
                seen.push(control.progress());
            }
        }
        assert!(seen.is_sorted() && seen[0] > 0.08 && seen[0] < 0.09, "{seen:?}");
        assert!((control.progress() - 1.0).abs() < 1e-5);
        control.piece(1, 3).cancel();
        assert!(control.check().is_err());
    }

    #[test]
    fn progress_that_advances_never_goes_back_nor_ends() {
        let control = Control::unattended();
        let mut last = 0.0;
        for _ in 0..40 {
            control.advance(0.1);
            assert!(control.progress() > last && control.progress() < 1.0);
            last = control.progress();
        }
    }
}

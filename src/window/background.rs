//! One result that is computed in the background and remembers what it was computed for.

use crate::control::Control;
use crate::session::jobs::{Job, JobError};
use crate::window::repaint::request_repaint;
use egui::Context;
use std::sync::Arc;

/// Why there is no result.
pub const CANCELLED: &str = "It was cancelled; the next change computes it again.";

/// A finished result and its key.
type Done<K, T> = (K, Result<Arc<T>, String>);

/// A result by its key, and the job that computes it. Asking for another key cancels the job.
#[derive(Debug)]
pub struct Slot<K, T> {
    name: &'static str,
    done: Option<Done<K, T>>,
    job: Option<Job<K, Result<T, String>>>,
}

impl<K: Clone + PartialEq, T: Send + 'static> Slot<K, T> {
    /// An empty one; the name is that of its job in the status bar.
    pub fn new(name: &'static str) -> Self {
        Self { name, done: None, job: None }
    }

    /// The result for `key`, if it is there and fresh; starts nothing.
    pub fn known(&self, key: &K) -> Option<&Result<Arc<T>, String>> {
        self.done.as_ref().filter(|(k, _)| k == key).map(|(_, result)| result)
    }

    /// The result for `key`; `None` while it is computed. `work` is made only where a job has to be started.
    pub fn get<W>(&mut self, ctx: &Context, key: &K, work: impl FnOnce() -> W) -> Option<Result<Arc<T>, String>>
    where
        W: FnOnce(&Control) -> Result<T, String> + Send + 'static,
    {
        if let Some(result) = self.known(key) {
            return Some(result.clone());
        }
        if self.job.as_ref().is_none_or(|job| job.key() != key) {
            match Job::start(self.name, key.clone(), request_repaint(ctx), work()) {
                Ok(job) => self.job = Some(job),
                Err(error) => self.done = Some((key.clone(), Err(error.to_string()))),
            }
        }
        let result = self.job.as_ref().and_then(Job::poll)?;
        self.job = None;
        self.done = Some((key.clone(), joined(result)));
        self.known(key).cloned()
    }

    /// Gives up the job; its result is then the reason why there is none.
    pub fn cancel(&mut self) {
        if let Some(job) = self.job.take() {
            self.done = Some((job.key().clone(), Err(CANCELLED.to_owned())));
        }
    }

    /// Name and progress of the job, if one runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.job.as_ref().and_then(Job::running)
    }
}

/// The two ways in which a job can fail, as one.
fn joined<T>(result: Result<Result<T, String>, JobError>) -> Result<Arc<T>, String> {
    result.map_err(|e| e.to_string())?.map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::Slot;
    use egui::Context;
    use std::time::{Duration, Instant};

    fn wait(slot: &mut Slot<u64, u64>, key: u64) -> Result<u64, String> {
        let start = Instant::now();
        loop {
            let ctx = Context::default();
            match slot.get(&ctx, &key, || {
                move |_: &crate::control::Control| if key > 0 { Ok(2 * key) } else { Err("zero".to_owned()) }
            }) {
                Some(result) => return result.map(|v| *v),
                None => assert!(start.elapsed() < Duration::from_secs(30), "the job has not ended"),
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// A pane may be hidden while its result is made: nothing runs for ever then.
    #[test]
    fn what_nobody_asks_for_any_more_ends_by_itself() {
        let mut slot = Slot::new("Doubling");
        let ctx = Context::default();
        assert!(slot.get(&ctx, &1_u64, || |_: &crate::control::Control| Ok(2_u64)).is_none_or(|r| r.is_ok()));
        let start = Instant::now();
        while slot.running().is_some() {
            assert!(start.elapsed() < Duration::from_secs(30), "the job has not ended");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_result_belongs_to_its_key() {
        let mut slot = Slot::new("Doubling");
        assert_eq!(wait(&mut slot, 4), Ok(8));
        assert!(slot.known(&4).is_some() && slot.known(&5).is_none(), "a stale result is never shown as fresh");
        assert_eq!(wait(&mut slot, 5), Ok(10));
        assert_eq!(wait(&mut slot, 0), Err("zero".to_owned()));
        assert!(slot.running().is_none());
    }
}

//! Results by what they were computed from: what was computed once is there at once when undo leads back to it.

use crate::control::Control;
use crate::session::jobs::Job;
use crate::window::repaint::request_repaint;
use std::sync::Arc;

/// Results kept; the oldest goes first.
const MOST: usize = 32;

/// A result or one line that says why there is none.
pub type Cached<T> = Result<Arc<T>, String>;

/// Results of one kind, and the job for one more.
#[derive(Debug)]
pub struct Cache<K, T> {
    name: &'static str,
    done: Vec<(K, Cached<T>)>,
    job: Option<Job<K, Result<T, String>>>,
    cancelled: Option<K>,
}

impl<K: Clone + PartialEq, T: Send + 'static> Cache<K, T> {
    /// An empty cache; `name` is that of its jobs in the status bar.
    pub fn new(name: &'static str) -> Self {
        Self { name, done: Vec::new(), job: None, cancelled: None }
    }

    /// Takes in a finished job and starts one for `key` unless its result is there, on its way, or cancelled; a job for
    /// another key is dropped, which cancels it. `make` collects what the job needs.
    pub fn want<W>(&mut self, ctx: &egui::Context, key: &K, make: impl FnOnce() -> W)
    where
        W: FnOnce(&Control) -> Result<T, String> + Send + 'static,
    {
        self.collect();
        let there = self.get(key).is_some() || self.cancelled.as_ref() == Some(key);
        if there || self.job.as_ref().is_some_and(|job| job.key() == key) {
            return;
        }
        match Job::start(self.name, key.clone(), request_repaint(ctx), make()) {
            Ok(job) => self.job = Some(job),
            Err(error) => self.keep(key.clone(), Err(error.to_string())),
        }
    }

    /// Takes in a finished job.
    pub fn collect(&mut self) {
        let Some(result) = self.job.as_ref().and_then(Job::poll) else { return };
        let Some(job) = self.job.take() else { return };
        let result = result.map_err(|e| e.to_string()).and_then(|value| value.map(Arc::new));
        self.keep(job.key().clone(), result);
    }

    fn keep(&mut self, key: K, result: Cached<T>) {
        if self.done.len() == MOST {
            drop(self.done.remove(0));
        }
        self.done.push((key, result));
    }

    /// Nothing is asked for any more: what runs is dropped.
    pub fn rest(&mut self) {
        self.collect();
        self.job = None;
    }

    /// The result for `key`, if it is there.
    pub fn get(&self, key: &K) -> Option<&Cached<T>> {
        self.done.iter().find(|(of, _)| of == key).map(|(_, result)| result)
    }

    /// The last good result, of whatever key.
    pub fn last(&self) -> Option<&Arc<T>> {
        self.done.iter().rev().find_map(|(_, result)| result.as_ref().ok())
    }

    /// The last good result of a key that `fits`.
    pub fn find(&self, fits: impl Fn(&K) -> bool) -> Option<&Arc<T>> {
        self.done.iter().rev().filter(|(key, _)| fits(key)).find_map(|(_, result)| result.as_ref().ok())
    }

    /// Name and progress of the running job.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.job.as_ref().and_then(Job::running)
    }

    /// Stops the running job; it is not started again for its key until [`Cache::retry`].
    pub fn cancel(&mut self) {
        if let Some(job) = self.job.take() {
            self.cancelled = Some(job.key().clone());
        }
    }

    /// The running job is to answer with the best that it has so far.
    pub fn hurry(&self) {
        if let Some(job) = &self.job {
            job.hurry();
        }
    }

    /// Forgets good results that `is_old` says are of no use any more.
    pub fn forget(&mut self, is_old: impl Fn(&T) -> bool) {
        self.done.retain(|(_, result)| result.as_ref().is_ok_and(|value| !is_old(value)) || result.is_err());
    }

    /// Whether the work for `key` was cancelled.
    pub fn is_cancelled(&self, key: &K) -> bool {
        self.cancelled.as_ref() == Some(key)
    }

    /// Forgets that work was cancelled and what failed.
    pub fn retry(&mut self) {
        self.cancelled = None;
        self.done.retain(|(_, result)| result.is_ok());
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::Cache;
    use crate::control::Control;
    use std::time::{Duration, Instant};

    fn wait(cache: &mut Cache<u32, u32>, key: u32) -> u32 {
        let start = Instant::now();
        loop {
            cache.want(&egui::Context::default(), &key, || move |_: &Control| Ok(10 * key));
            if let Some(result) = cache.get(&key) {
                return **result.as_ref().unwrap();
            }
            assert!(start.elapsed() < Duration::from_secs(20));
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_result_is_computed_once_and_is_there_when_asked_for_again() {
        let mut cache = Cache::new("Work");
        assert_eq!((wait(&mut cache, 1), wait(&mut cache, 2)), (10, 20));
        cache.want(&egui::Context::default(), &1, || |_: &Control| panic!("it is there already"));
        assert_eq!(**cache.get(&1).unwrap().as_ref().unwrap(), 10);
        assert!(cache.running().is_none());
    }

    #[test]
    fn what_was_cancelled_is_not_started_again_before_it_is_asked_for() {
        let mut cache: Cache<u32, u32> = Cache::new("Work");
        let slow = || {
            |control: &Control| {
                while control.check().is_ok() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                Err("cancelled".to_owned())
            }
        };
        cache.want(&egui::Context::default(), &1, slow);
        cache.cancel();
        cache.want(&egui::Context::default(), &1, slow);
        assert!(cache.is_cancelled(&1) && cache.running().is_none());
        cache.retry();
        assert_eq!(wait(&mut cache, 1), 10);
    }
}

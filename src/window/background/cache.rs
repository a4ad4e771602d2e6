//! Results of work in the background, by what they were computed from: what was computed once is there at once when undo leads
//! back to it.

use crate::control::Control;
use crate::session::jobs::Job;
use crate::window::app::repaint::request_repaint;
use egui::Context;
use std::sync::Arc;

/// Why there is no result.
pub(crate) const CANCELLED: &str = "It was cancelled; the next change computes it again.";

/// Results that a cache keeps unless it is told otherwise.
const KEPT: usize = 32;

/// A result or one line that says why there is none.
pub(crate) type Cached<T> = Result<Arc<T>, String>;

/// Work in the background, whatever its results and their keys.
pub(crate) trait Background {
    /// Takes in what has ended.
    fn collect(&mut self);
    /// Name and progress of what runs.
    fn running(&self) -> Option<(&str, f64)>;
    /// Stops what runs; it is not started again for its key until [`Background::retry`].
    fn cancel(&mut self);
    /// Forgets that work was cancelled and what failed.
    fn retry(&mut self);
}

/// Results of one kind by their key, and the jobs that compute more of them.
#[derive(Debug)]
pub struct Cache<K, T> {
    name: &'static str,
    kept: usize,
    at_once: usize,
    /// The one that was wanted longest ago comes first, and goes first.
    done: Vec<(K, Cached<T>)>,
    jobs: Vec<Job<K, Result<T, String>>>,
    cancelled: Vec<K>,
}

impl<K: Clone + PartialEq, T: Send + 'static> Cache<K, T> {
    /// One job at a time, for what was wanted last; `name` is that of its jobs in the status bar.
    pub fn new(name: &'static str) -> Self {
        Self { name, kept: KEPT, at_once: 1, done: Vec::new(), jobs: Vec::new(), cancelled: Vec::new() }
    }

    /// The same for a large result, or one that no undo leads back to: only the last one is kept.
    pub fn of_last(name: &'static str) -> Self {
        Self { kept: 1, ..Self::new(name) }
    }

    /// Up to `at_once` jobs beside each other, none of which another key ends; `kept` results.
    pub fn of_many(name: &'static str, at_once: usize, kept: usize) -> Self {
        Self { kept, at_once, ..Self::new(name) }
    }

    /// Takes in what has ended and starts a job for `key` unless its result is there, on its way or cancelled. Where one job runs
    /// at a time that for another key is dropped, which cancels it; of many, `key` waits for its turn. `make` collects what the
    /// job needs.
    pub fn want<W>(&mut self, ctx: &Context, key: &K, make: impl FnOnce() -> W)
    where
        W: FnOnce(&Control) -> Result<T, String> + Send + 'static,
    {
        self.collect();
        if let Some(place) = self.done.iter().position(|(of, _)| of == key) {
            return self.done[place..].rotate_left(1);
        }
        if self.is_cancelled(key) || self.jobs.iter().any(|job| job.key() == key) {
            return;
        }
        if self.at_once == 1 {
            self.jobs.clear();
        } else if self.jobs.len() >= self.at_once {
            return;
        }
        match Job::start(self.name, key.clone(), request_repaint(ctx), make()) {
            Ok(job) => self.jobs.push(job),
            Err(error) => self.keep(key.clone(), Err(error.to_string())),
        }
    }

    /// The result for `key`, which is asked for where it is not there; `None` while it is computed.
    pub fn obtain<W>(&mut self, ctx: &Context, key: &K, make: impl FnOnce() -> W) -> Option<Cached<T>>
    where
        W: FnOnce(&Control) -> Result<T, String> + Send + 'static,
    {
        self.want(ctx, key, make);
        self.collect();
        self.known(key)
    }

    fn keep(&mut self, key: K, result: Cached<T>) {
        if self.done.len() == self.kept {
            drop(self.done.remove(0));
        }
        self.done.push((key, result));
    }

    /// Nothing is asked for any more: what runs is dropped.
    pub fn rest(&mut self) {
        self.collect();
        self.jobs.clear();
    }

    /// The result for `key`, if it is there; starts nothing.
    pub fn get(&self, key: &K) -> Option<&Cached<T>> {
        self.done.iter().find(|(of, _)| of == key).map(|(_, result)| result)
    }

    /// The same, or the reason why it is not coming.
    pub fn known(&self, key: &K) -> Option<Cached<T>> {
        self.get(key).cloned().or_else(|| self.is_cancelled(key).then(|| Err(CANCELLED.to_owned())))
    }

    /// The last good result, of whatever key.
    pub fn last(&self) -> Option<&Arc<T>> {
        self.find(|_| true)
    }

    /// The last good result of a key that `fits`.
    pub fn find(&self, fits: impl Fn(&K) -> bool) -> Option<&Arc<T>> {
        self.done.iter().rev().filter(|(key, _)| fits(key)).find_map(|(_, result)| result.as_ref().ok())
    }

    /// How far the work for `key` has come, from 0 to 1.
    pub fn progress(&self, key: &K) -> f64 {
        let done = if self.get(key).is_some() { 1.0 } else { 0.0 };
        self.jobs.iter().find(|job| job.key() == key).map_or(done, Job::progress)
    }

    /// What runs is to answer with the best that it has so far.
    pub fn hurry(&self) {
        self.jobs.iter().for_each(Job::hurry);
    }

    /// Forgets good results that `is_old` says are of no use any more.
    pub fn forget(&mut self, is_old: impl Fn(&T) -> bool) {
        self.done.retain(|(_, result)| result.as_ref().is_ok_and(|value| !is_old(value)) || result.is_err());
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self { name: self.name, kept: self.kept, at_once: self.at_once, ..Self::new(self.name) };
    }

    /// Whether the work for `key` was cancelled.
    pub fn is_cancelled(&self, key: &K) -> bool {
        self.cancelled.contains(key)
    }
}

impl<K: Clone + PartialEq, T: Send + 'static> Background for Cache<K, T> {
    fn collect(&mut self) {
        while let Some((place, result)) = self.jobs.iter().enumerate().find_map(|(k, job)| Some((k, job.poll()?))) {
            let job = self.jobs.remove(place);
            let result = result.map_err(|e| e.to_string()).and_then(|value| value.map(Arc::new));
            self.keep(job.key().clone(), result);
        }
    }

    fn running(&self) -> Option<(&str, f64)> {
        self.jobs.iter().find_map(Job::running)
    }

    fn cancel(&mut self) {
        self.cancelled.extend(self.jobs.drain(..).map(|job| job.key().clone()));
    }

    fn retry(&mut self) {
        self.cancelled.clear();
        self.done.retain(|(_, result)| result.is_ok());
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Background, Cache};
    use crate::control::Control;
    use egui::Context;
    use std::time::{Duration, Instant};

    fn wait(cache: &mut Cache<u32, u32>, key: u32) -> Result<u32, String> {
        let start = Instant::now();
        loop {
            let work = move |_: &Control| if key > 0 { Ok(10 * key) } else { Err("zero".to_owned()) };
            if let Some(result) = cache.obtain(&Context::default(), &key, || work) {
                return result.map(|v| *v);
            }
            assert!(start.elapsed() < Duration::from_secs(30), "the job has not ended");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn slow() -> impl FnOnce(&Control) -> Result<u32, String> + Send {
        |control: &Control| {
            while control.check().is_ok() {
                std::thread::sleep(Duration::from_millis(1));
            }
            Err("cancelled".to_owned())
        }
    }

    #[test]
    fn a_result_is_computed_once_and_is_there_when_asked_for_again() {
        let mut cache = Cache::new("Work");
        assert_eq!((wait(&mut cache, 1), wait(&mut cache, 2)), (Ok(10), Ok(20)));
        cache.want(&Context::default(), &1, || |_: &Control| panic!("it is there already"));
        assert_eq!(**cache.get(&1).unwrap().as_ref().unwrap(), 10);
        assert_eq!(wait(&mut cache, 0), Err("zero".to_owned()));
        assert!(cache.running().is_none());
    }

    #[test]
    fn a_result_belongs_to_its_key() {
        let mut cache = Cache::of_last("Work");
        assert_eq!(wait(&mut cache, 4), Ok(40));
        assert!(cache.get(&4).is_some() && cache.get(&5).is_none(), "a stale result is never shown as fresh");
        assert_eq!(wait(&mut cache, 5), Ok(50));
        assert!(cache.get(&4).is_none(), "only the last one is kept");
    }

    /// A pane may be hidden while its result is made: nothing runs for ever then.
    #[test]
    fn what_nobody_asks_for_any_more_ends_by_itself() {
        let mut cache = Cache::new("Work");
        cache.want(&Context::default(), &1_u32, || |_: &Control| Ok(2_u32));
        let start = Instant::now();
        while cache.running().is_some() {
            assert!(start.elapsed() < Duration::from_secs(30), "the job has not ended");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn what_was_cancelled_is_not_started_again_before_it_is_asked_for() {
        let mut cache: Cache<u32, u32> = Cache::new("Work");
        cache.want(&Context::default(), &1, slow);
        cache.cancel();
        cache.want(&Context::default(), &1, slow);
        assert!(cache.is_cancelled(&1) && cache.get(&1).is_none() && cache.running().is_none());
        assert_eq!(cache.known(&1), Some(Err(super::CANCELLED.to_owned())));
        cache.retry();
        assert_eq!(wait(&mut cache, 1), Ok(10));
    }

    #[test]
    fn of_many_the_oldest_goes_and_no_job_ends_another() {
        let mut cache = Cache::of_many("Work", 2, 2);
        for key in [1, 2, 3] {
            cache.want(&Context::default(), &key, slow);
        }
        assert_eq!(cache.jobs.iter().map(|job| *job.key()).collect::<Vec<_>>(), [1, 2], "the third waits");
        cache.clear();
        assert!(cache.running().is_none());
        for key in [1, 2, 1, 3] {
            assert_eq!(wait(&mut cache, key), Ok(10 * key));
        }
        assert!(cache.get(&2).is_none() && cache.get(&1).is_some(), "1 was wanted after 2");
        assert!(cache.progress(&3) == 1.0 && cache.progress(&2) == 0.0);
    }
}

//! Results that know what they were computed from. A node holds the last result with its key and the job for a newer one;
//! a result whose key is not the document's is stale, and never handed out as fresh.

use super::jobs::{Job, JobError};
use crate::control::Control;
use std::sync::Arc;
use std::time::Duration;

/// What can be said of a result now.
#[derive(Debug, Clone, PartialEq)]
pub enum Freshness<T, E> {
    /// Computed from the document as it is.
    Fresh(Arc<T>),
    /// The computation failed on the document as it is.
    Failed(Arc<E>),
    /// The job broke down.
    Broken(JobError),
    /// Not computed yet; the last result of an earlier document, if there is one, may be shown as such.
    Stale(Option<Arc<T>>),
}

/// One computed result of the session.
#[derive(Debug)]
pub struct Node<K, T, E> {
    name: &'static str,
    done: Option<(K, Result<Result<Arc<T>, Arc<E>>, JobError>)>,
    /// Last result that was good, of whatever document.
    last: Option<Arc<T>>,
    job: Option<Job<K, Result<T, E>>>,
    /// Key whose computation the user cancelled.
    cancelled: Option<K>,
}

impl<K: Clone + PartialEq, T: Send + 'static, E: Send + 'static> Node<K, T, E> {
    /// A node without result; `name` is that of its jobs.
    pub fn new(name: &'static str) -> Self {
        Self { name, done: None, last: None, job: None, cancelled: None }
    }

    /// Takes in a finished job, and starts one if there is no result for `key` yet. A job for another key is cancelled.
    pub fn update(
        &mut self,
        key: &K,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Control) -> Result<T, E> + Send + 'static,
    ) {
        self.collect();
        let wanted = !self.is_current(key) && self.cancelled.as_ref() != Some(key);
        if !wanted || self.job.as_ref().is_some_and(|job| job.key() == key) {
            return;
        }
        self.job = None;
        match Job::start(self.name, key.clone(), wake, work) {
            Ok(job) => self.job = Some(job),
            Err(error) => self.done = Some((key.clone(), Err(error))),
        }
    }

    /// Takes in the result of a finished job.
    pub fn collect(&mut self) {
        let Some(result) = self.job.as_ref().and_then(Job::poll) else { return };
        self.take(result);
    }

    /// Waits for the running job, at most so long; for work without a window.
    pub fn wait(&mut self, most: Duration) {
        let Some(result) = self.job.as_ref().and_then(|job| job.wait(most)) else { return };
        self.take(result);
    }

    fn take(&mut self, result: Result<Result<T, E>, JobError>) {
        let Some(job) = self.job.take() else { return };
        let result = result.map(|value| value.map(Arc::new).map_err(Arc::new));
        if let Ok(Ok(value)) = &result {
            self.last = Some(value.clone());
        }
        self.done = Some((job.key().clone(), result));
    }

    /// Stops the running job and does not start it again for the same key until [`Node::retry`].
    pub fn cancel(&mut self) {
        self.cancelled = self.job.take().map(|job| job.key().clone());
    }

    /// Forgets that the work was cancelled or failed, so that the next update starts it.
    pub fn retry(&mut self) {
        self.cancelled = None;
        self.done = self.done.take().filter(|(_, result)| matches!(result, Ok(Ok(_))));
    }

    fn is_current(&self, key: &K) -> bool {
        self.done.as_ref().is_some_and(|(of, _)| of == key)
    }

    /// The result as seen from the document of `key`.
    pub fn get(&self, key: &K) -> Freshness<T, E> {
        match &self.done {
            Some((of, result)) if of == key => match result {
                Ok(Ok(value)) => Freshness::Fresh(value.clone()),
                Ok(Err(error)) => Freshness::Failed(error.clone()),
                Err(error) => Freshness::Broken(error.clone()),
            },
            _ => Freshness::Stale(self.last.clone()),
        }
    }

    /// The result, only if it was computed from the document of `key`.
    pub fn fresh(&self, key: &K) -> Option<Arc<T>> {
        match self.get(key) {
            Freshness::Fresh(value) => Some(value),
            _ => None,
        }
    }

    /// Name and progress of the running job.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.job.as_ref().map(|job| (job.name(), job.progress()))
    }
}

//! Long work in the background: a pure blocking function on a named thread, its progress and cancel in a [`Control`], its
//! result in a channel of one place. Dropping the job cancels it.

use super::workers::Threads;
use crate::control::Control;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// The job ended without a result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum JobError {
    /// Its thread could not be started.
    #[error("the work \"{name}\" could not be started: {reason}; close other programs and try again")]
    NotStarted {
        /// Name of the job.
        name: String,
        /// What the system says.
        reason: String,
    },
    /// It failed in a way that is an error of the program.
    #[error("the work \"{name}\" failed: {reason}; this is an error of dashpot, please report it")]
    Panicked {
        /// Name of the job.
        name: String,
        /// Message of the panic.
        reason: String,
    },
}

/// Work that is going on, keyed by what it was started for (usually a revision).
#[derive(Debug)]
pub struct Job<K, T> {
    name: String,
    key: K,
    control: Control,
    result: Receiver<Result<T, JobError>>,
    thread: JoinHandle<()>,
}

impl<K, T: Send + 'static> Job<K, T> {
    /// Starts `work` on a thread called `name`; `wake` is called from there once the result waits.
    ///
    /// # Errors
    /// [`JobError::NotStarted`].
    pub fn start(
        name: &str,
        key: K,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Control) -> T + Send + 'static,
    ) -> Result<Self, JobError> {
        let control = Control::default().with_workers(Arc::new(Threads));
        let (sender, result) = sync_channel(1);
        let (inside, title) = (control.clone(), name.to_owned());
        let body = move || {
            let outcome = catch_unwind(AssertUnwindSafe(|| work(&inside)));
            let outcome = outcome.map_err(|cause| JobError::Panicked { name: title, reason: reason(&*cause) });
            // Nobody may be waiting any more, which is no fault.
            if sender.send(outcome).is_ok() {
                wake();
            }
        };
        let failed = |error: std::io::Error| JobError::NotStarted { name: name.into(), reason: error.to_string() };
        let thread = std::thread::Builder::new().name(name.into()).spawn(body).map_err(failed)?;
        Ok(Self { name: name.into(), key, control, result, thread })
    }
}

impl<K, T> Job<K, T> {
    /// The result, once it is there; it is given out once.
    pub fn poll(&self) -> Option<Result<T, JobError>> {
        self.result.try_recv().ok()
    }

    /// Waits for the result, at most so long.
    pub fn wait(&self, most: Duration) -> Option<Result<T, JobError>> {
        self.result.recv_timeout(most).ok()
    }

    /// Name, for the status bar.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it was started for.
    pub fn key(&self) -> &K {
        &self.key
    }

    /// Share of the work that is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.control.progress()
    }

    /// Name and progress while it runs; `None` once it has ended, whether its result was asked for or not.
    pub fn running(&self) -> Option<(&str, f64)> {
        (!self.thread.is_finished()).then(|| (self.name(), self.progress()))
    }

    /// Asks it to answer with the best that it has so far.
    pub fn hurry(&self) {
        self.control.hurry();
    }

    /// Asks it to stop.
    pub fn cancel(&self) {
        self.control.cancel();
    }
}

impl<K, T> Drop for Job<K, T> {
    fn drop(&mut self) {
        self.control.cancel();
    }
}

fn reason(cause: &(dyn std::any::Any + Send)) -> String {
    let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| cause.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into())
}

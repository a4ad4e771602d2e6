//! Records, residuals and spectra ready to be drawn, computed in the background, a channel of a run each.

use crate::control::Control;
use crate::measurement::Run;
use crate::plots::trace::{Trace, trace};
use crate::window::background::cache::{Background, CANCELLED, Cache};
use egui::Context;
use std::cell::Cell;
use std::collections::HashSet;
use std::sync::Arc;

/// Jobs at a time.
const AT_ONCE: usize = 2;
/// PreparedRecords that are kept.
const KEPT: usize = 64;

/// What there is to draw of a channel.
#[derive(Debug, Clone)]
pub enum PreparedRecord {
    /// The run came without a time record.
    Absent,
    /// It is being computed.
    Coming,
    /// It was being computed and was given up.
    Cancelled,
    /// Here it is.
    Ready(Arc<Trace>),
}

/// Run, channel, and what its fit depends on: frequency and number of harmonics.
type Key = (usize, usize, u64, usize);

/// PreparedRecords and the jobs that compute them.
#[derive(Debug)]
pub(crate) struct PreparedRecords {
    traces: Cache<Key, Trace>,
    batch: Batch,
}

impl Default for PreparedRecords {
    fn default() -> Self {
        Self { traces: Cache::of_many("Preparing records", AT_ONCE, KEPT), batch: Batch::default() }
    }
}

/// What was asked for while jobs ran: one bar over all of it.
#[derive(Debug, Default)]
struct Batch {
    keys: HashSet<Key>,
    /// How far the bar has come; it never goes back, though more may be asked for on the way.
    reached: Cell<f64>,
}

impl Batch {
    /// One more; the first of a new batch where nothing is being done.
    fn ask(&mut self, key: Key, idle: bool) {
        if idle && !self.keys.contains(&key) {
            *self = Self::default();
        }
        self.keys.insert(key);
    }

    /// Place of the bar, where `share` of each is done.
    fn progress(&self, share: impl Fn(&Key) -> f64) -> f64 {
        let done = self.keys.iter().map(share).sum::<f64>() / self.keys.len().max(1) as f64;
        self.reached.set(self.reached.get().max(done));
        self.reached.get()
    }
}

impl PreparedRecords {
    /// A channel of a run, by its index in the fit.
    pub(crate) fn get(&mut self, ctx: &Context, runs: &[Run], run: usize, channel: usize) -> PreparedRecord {
        let Some(r) = runs.get(run) else { return PreparedRecord::Absent };
        let (Some(record), Some(fit)) = (&r.record, r.fit.channels.get(channel)) else { return PreparedRecord::Absent };
        let key = (run, channel, r.fit.omega.to_bits(), fit.amplitudes.len());
        let idle = self.traces.running().is_none();
        let found = self.traces.obtain(ctx, &key, || {
            let (record, fit, omega) = (Arc::clone(record), fit.clone(), r.fit.omega);
            move |control: &Control| trace(&record, &fit, omega, control).ok_or_else(|| CANCELLED.to_owned())
        });
        match found {
            Some(Ok(trace)) => PreparedRecord::Ready(trace),
            Some(Err(_)) => PreparedRecord::Cancelled,
            None => {
                self.batch.ask(key, idle);
                PreparedRecord::Coming
            }
        }
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

impl Background for PreparedRecords {
    fn collect(&mut self) {
        self.traces.collect();
    }

    /// All records together.
    fn running(&self) -> Option<(&str, f64)> {
        let (name, _) = self.traces.running()?;
        Some((name, self.batch.progress(|key| self.traces.progress(key))))
    }

    fn cancel(&mut self) {
        self.traces.cancel();
    }

    fn retry(&mut self) {
        self.traces.retry();
    }
}

#[cfg(test)]
mod tests {
    use super::Batch;

    #[test]
    fn one_bar_runs_over_all_records_and_never_back() {
        let mut batch = Batch::default();
        let keys = [0, 1, 2].map(|run| (run, 0, 0, 7));
        keys[..2].iter().for_each(|&key| batch.ask(key, true));
        let half = |key: &super::Key| if *key == keys[0] { 1.0 } else { 0.0 };
        batch.ask(keys[1], false);
        assert!(batch.progress(half) <= 0.5 + 1e-12);
        batch.ask(keys[2], false);
        let seen = [batch.progress(half), batch.progress(|_| 0.9), batch.progress(|_| 1.0)];
        assert!(seen.is_sorted() && seen[2] == 1.0, "{seen:?}");
        // Another batch starts anew.
        batch.ask((9, 0, 0, 7), true);
        assert!(batch.progress(|_| 0.0) == 0.0);
    }
}

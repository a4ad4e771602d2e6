//! Threads lent to the engine for independent pieces of work.

use crate::control::Workers;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{available_parallelism, scope};

/// As many threads as the machine has processors; they live as long as one heap of work.
#[derive(Debug, Clone, Copy)]
pub struct Threads {
    count: usize,
}

impl Default for Threads {
    fn default() -> Self {
        Self { count: available_parallelism().map_or(1, NonZeroUsize::get) }
    }
}

impl Workers for Threads {
    fn each(&self, count: usize, piece: &(dyn Fn(usize) + Sync)) {
        let next = AtomicUsize::new(0);
        let work = || {
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                if k >= count {
                    break;
                }
                piece(k);
            }
        };
        scope(|scope| {
            (1..self.count.min(count)).for_each(|_| drop(scope.spawn(work)));
            work();
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use std::sync::Arc;

    #[test]
    fn every_piece_is_done_once_and_in_its_place() {
        let threads = Threads { count: 3 };
        let done = AtomicUsize::new(0);
        let control = Control::unattended().with_workers(Arc::new(threads));
        let squares = control.map(1000, |k| {
            done.fetch_add(1, Ordering::Relaxed);
            k * k
        });
        assert_eq!(done.into_inner(), 1000);
        assert!(squares.iter().enumerate().all(|(k, &s)| s == k * k));
    }
}

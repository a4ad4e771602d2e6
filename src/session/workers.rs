//! Threads lent to the engine for independent pieces of work.

use crate::control::Workers;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

/// The threads of rayon's pool, as many as the machine has processors. Pieces that are divided themselves are shared with
/// whoever is idle, so that the last long piece of a heap of work has all threads.
#[derive(Debug, Clone, Copy, Default)]
pub struct Threads;

impl Workers for Threads {
    fn each(&self, count: usize, piece: &(dyn Fn(usize) + Sync)) {
        (0..count).into_par_iter().with_max_len(1).for_each(piece);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn every_piece_is_done_once_and_in_its_place() {
        let done = AtomicUsize::new(0);
        let control = Control::unattended().with_workers(Arc::new(Threads));
        let squares = control.map(1000, |k| {
            done.fetch_add(1, Ordering::Relaxed);
            control.map(3, |n| n * k).into_iter().sum::<usize>()
        });
        assert_eq!(done.into_inner(), 1000);
        assert!(squares.iter().enumerate().all(|(k, &s)| s == 3 * k));
    }
}

//! Three places at once: from the best pairs on, each of the three exchanged while that leaves less.

use super::{Placing, Screen, sorted};

/// Pairs that a third place is added to.
const BEGUN: usize = 16;
/// Triples whose places are exchanged.
const EXCHANGED: usize = 4;
/// Rounds of exchange, each of all three places.
const ROUNDS: usize = 3;

impl Screen {
    /// Triples of places, best first: not all of them, which would be the cube of the places, but those around the best that
    /// exchange finds.
    pub(crate) fn triples(&self, most: usize) -> Vec<Placing> {
        let mut seen: Vec<Placing> = Vec::new();
        for pair in self.pairs(BEGUN) {
            self.with_one_more(&pair.spots, &mut seen);
        }
        for k in 0..EXCHANGED.min(seen.len()) {
            for _ in 0..ROUNDS {
                let best = seen[k].clone();
                for out in 0..3 {
                    let mut two = best.spots.clone();
                    two.remove(out);
                    self.with_one_more(&two, &mut seen);
                }
                if seen[k].spots == best.spots {
                    break;
                }
            }
        }
        seen.truncate(most);
        seen
    }

    /// Adds `two` with every third place to the triples `seen`, which stay the best.
    fn with_one_more(&self, two: &[usize], seen: &mut Vec<Placing>) {
        let third = (0..self.spots.len()).filter(|s| !two.contains(s));
        let all = third.map(|s| {
            let mut spots = [two, &[s]].concat();
            spots.sort_unstable();
            let chi_square = self.left(&spots, |cell| cell.left_by_all(&spots));
            Placing { spots, chi_square }
        });
        seen.extend(all);
        *seen = sorted(std::mem::take(seen));
        seen.dedup_by(|a, b| a.spots == b.spots);
        seen.truncate(KEPT);
    }
}

/// Triples that are kept on the way.
const KEPT: usize = 96;

//! Branch and bound. A node is a set of chosen columns and the columns still free. Its bound is the residual of
//! non-negative least squares over all of them: no subset does better. The column of the relaxed solution that carries
//! most is chosen in one branch and discarded in the other; the last two columns are found by [`super::pairs`].
//!
//! If the relaxed solution uses chosen columns only, no set below the node gives a further column a positive
//! coefficient, and the node is closed.

use super::pairs::Schur;
use super::problem::{Ranking, SubsetError, SubsetProblem, combinations};
use super::relaxation::{Normal, Relaxed};
use super::unit_problem::{Best, Unit};
use crate::control::Control;

/// Squared residuals, relative to `|b|^2`, that the normal matrix cannot tell apart.
const SLACK: f64 = 1e-12;

/// The `keep` best sets of `size` columns, proved to be the best unless `node_limit` is reached. Sets that differ by less
/// than 1e-6 of `|b|` in their residual are ranked by an orthogonal factorisation, all others by exclusion.
///
/// # Errors
/// [`SubsetError`] for values that are not finite, forced columns that do not exist, an impossible size, or cancellation.
pub fn branch_and_bound(problem: &SubsetProblem<'_>, control: &Control) -> Result<Ranking, SubsetError> {
    let unit = Unit::new(problem)?;
    let normal = Normal::new(&unit);
    let free = unit.free();
    let total = combinations(free.len(), unit.chosen);
    let mut search = Search {
        unit: &unit,
        normal: &normal,
        control,
        best: Best::new(problem.keep),
        nodes: 0,
        limit: problem.node_limit.max(1),
        total,
        complete: true,
    };
    if free.len() < unit.chosen {
        return Ok(search.best.finish(&unit, true, 0));
    }
    if unit.chosen == 0 {
        unit.try_set(&[], &mut search.best)?;
        return Ok(search.best.finish(&unit, true, 1));
    }
    search.start(&free)?;
    let (complete, nodes) = (search.complete, search.nodes);
    Ok(search.best.finish(&unit, complete, nodes))
}

struct Search<'a> {
    unit: &'a Unit,
    normal: &'a Normal,
    control: &'a Control,
    best: Best,
    nodes: u64,
    limit: u64,
    /// Number of sets in all.
    total: f64,
    complete: bool,
}

/// What a node hands down.
#[derive(Clone)]
struct Node {
    chosen: Vec<usize>,
    free: Vec<usize>,
    schur: Schur,
    relaxed: Relaxed,
}

impl Search<'_> {
    fn start(&mut self, free: &[usize]) -> Result<(), SubsetError> {
        let columns: Vec<usize> = self.unit.forced.iter().chain(free).copied().collect();
        let mut schur = Schur::new(columns.clone(), self.normal.n, &self.normal.gram, &self.normal.h);
        for &column in &self.unit.forced {
            // A forced column that depends on other forced ones adds nothing and is left out of the projection.
            if let Some(p) = schur.position(column) {
                match schur.choose(p) {
                    Some(next) => schur = next,
                    None => schur.discard(p),
                }
            }
        }
        self.replace(&schur)?;
        let mut relaxed = Relaxed::default();
        relaxed.optimise(self.normal, self.unit, &columns)?;
        self.visit(Node { chosen: Vec::new(), free: free.to_vec(), schur, relaxed })
    }

    /// A good first answer: the best column after the best column, then two columns at a time replaced by the best two beside
    /// the others, as long as that helps (A. J. Miller, Subset Selection in Regression, 2nd ed. (2002) ch. 3). Two at once,
    /// because of two neighbours that are both one place off neither moves alone.
    fn replace(&mut self, root: &Schur) -> Result<(), SubsetError> {
        let mut set = forward(root, self.unit.chosen);
        // In the order of the sets that are kept, so that a round has every pair.
        set.sort_unstable();
        self.unit.try_set(&set, &mut self.best)?;
        loop {
            let before = self.best.least();
            for (p, q) in pairs_of_places(set.len()) {
                self.control.check()?;
                let others: Vec<usize> = (0..set.len()).filter(|k| *k != p && *k != q).map(|k| set[k]).collect();
                if let Some(schur) = without(root, &others) {
                    self.complete_set(&schur, &others, set.len() - others.len())?;
                }
                if let Some(best) = self.best.first() {
                    set = best.iter().copied().filter(|j| !self.unit.forced.contains(j)).collect();
                }
            }
            if self.best.least() >= before {
                return Ok(());
            }
        }
    }

    /// Squared residual down to which a set is of interest.
    fn goal(&self) -> f64 {
        self.best.threshold().powi(2) + SLACK
    }

    fn visit(&mut self, mut node: Node) -> Result<(), SubsetError> {
        let missing = self.unit.chosen - node.chosen.len();
        if missing <= 2 {
            return self.last(&node, missing);
        }
        while self.count()? && node.free.len() >= missing && node.relaxed.squared_residual <= self.goal() {
            let Some(column) = carries_most(&node) else {
                return Ok(());
            };
            node.free.retain(|&j| j != column);
            if let Some(p) = node.schur.position(column) {
                if let Some(schur) = node.schur.choose(p) {
                    let mut chosen = node.chosen.clone();
                    chosen.push(column);
                    let (free, relaxed) = (node.free.clone(), node.relaxed.clone());
                    self.visit(Node { chosen, free, schur, relaxed })?;
                }
                node.schur.discard(p);
            }
            self.exclude(&mut node, column)?;
            if node.chosen.is_empty() {
                self.control.report(1.0 - combinations(node.free.len(), missing) / self.total);
            }
        }
        Ok(())
    }

    fn exclude(&self, node: &mut Node, column: usize) -> Result<(), SubsetError> {
        let allowed: Vec<usize> = self.unit.forced.iter().chain(&node.chosen).chain(&node.free).copied().collect();
        node.relaxed.exclude(column);
        node.relaxed.optimise(self.normal, self.unit, &allowed)?;
        Ok(())
    }

    /// The last one or two columns.
    fn last(&mut self, node: &Node, missing: usize) -> Result<(), SubsetError> {
        if self.count()? { self.complete_set(&node.schur, &node.chosen, missing) } else { Ok(()) }
    }

    /// Offers every set of the chosen columns and one or two more that may be among the best.
    fn complete_set(&mut self, schur: &Schur, chosen: &[usize], missing: usize) -> Result<(), SubsetError> {
        // A forced column may be zero, and then the signs of unbounded least squares say nothing.
        let signs = self.unit.forced.is_empty();
        let mut set = chosen.to_vec();
        if missing == 1 {
            for column in schur.singles(self.goal(), signs) {
                set.push(column);
                self.unit.try_set(&set, &mut self.best)?;
                set.pop();
            }
            return Ok(());
        }
        let goal = self.goal();
        schur.pairs(goal, signs, |p, q| {
            set.extend([p, q]);
            if !(signs && self.normal.has_negative(&set)) {
                self.unit.try_set(&set, &mut self.best)?;
            }
            set.truncate(set.len() - 2);
            Ok(self.goal())
        })
    }

    /// Counts a node; false when the limit is reached.
    fn count(&mut self) -> Result<bool, SubsetError> {
        self.nodes += 1;
        if self.nodes.is_multiple_of(64) {
            self.control.check()?;
        }
        self.complete &= self.nodes <= self.limit;
        Ok(self.nodes <= self.limit)
    }
}

/// The free column with the largest coefficient in the relaxed solution (columns have unit norm).
fn carries_most(node: &Node) -> Option<usize> {
    let used = node.relaxed.passive.iter().zip(&node.relaxed.x).filter(|(j, _)| node.free.contains(j));
    used.max_by(|a, b| a.1.total_cmp(b.1)).map(|(&j, _)| j)
}

/// Columns chosen one after the other, each the one that lowers the residual most with a positive coefficient.
fn forward(root: &Schur, count: usize) -> Vec<usize> {
    let mut schur = root.clone();
    let mut set = Vec::new();
    while set.len() < count {
        let Some(p) = schur.best_single() else { break };
        set.push(schur.columns[p]);
        let Some(next) = schur.choose(p) else { break };
        schur = next;
    }
    set
}

/// The columns beside some that are chosen; `None` where these depend on each other.
fn without(root: &Schur, chosen: &[usize]) -> Option<Schur> {
    let mut schur = root.clone();
    for &column in chosen {
        schur = schur.choose(schur.position(column)?)?;
    }
    Some(schur)
}

/// Every pair of places of a set; of a set of one its place twice.
fn pairs_of_places(count: usize) -> Vec<(usize, usize)> {
    if count == 1 {
        return vec![(0, 0)];
    }
    (0..count).flat_map(|p| (p + 1..count).map(move |q| (p, q))).collect()
}

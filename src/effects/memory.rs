//! Laws with memory stepped through time, for integrators: from rest, not only in steady state.

/// The state of one law with memory, at the last committed instant.
pub trait Memory {
    /// Force in N and its derivative by the displacement in N/m if the displacement goes on, straight, to `d` (m) within
    /// the time `step` (s). The state stays as it is, so that an implicit integrator may try again.
    fn trial(&self, d: f64, step: f64) -> [f64; 2];

    /// Goes to `d` (m) within `step` (s) and returns the force there, N.
    fn advance(&mut self, d: f64, step: f64) -> f64;
}

/// How many of `count` reversals of Masing's law, at the displacements `place`, stay open on the way to the displacement `d`:
/// a loop that is closed is forgotten with both of its ends.
pub(crate) fn open_reversals(place: impl Fn(usize) -> f64, mut count: usize, d: f64) -> usize {
    loop {
        let closes = match count {
            0 => return 0,
            // The branch from the first reversal meets the backbone at its mirror image.
            1 => (d - place(0)).abs() >= 2.0 * place(0).abs(),
            _ => (d - place(count - 2)) * (place(count - 2) - place(count - 1)) >= 0.0,
        };
        if !closes {
            return count;
        }
        count = count.saturating_sub(2);
    }
}

/// Rate-independent hysteresis with the Masing branches of [`super::masing`], from the virgin state.
pub(crate) struct MasingMemory<B> {
    /// Force and slope of the backbone at a displacement.
    backbone: B,
    /// Displacement and force where the motion turned and whose loops are still open.
    reversals: Vec<[f64; 2]>,
    /// Displacement and force of the last instant.
    last: [f64; 2],
    /// Sign of the present direction, 0 at the start.
    direction: f64,
}

impl<B: Fn(f64) -> [f64; 2]> MasingMemory<B> {
    /// At rest at the origin. `backbone` gives force (N) and slope (N/m), odd in the displacement.
    pub(crate) fn new(backbone: B) -> Self {
        Self { backbone, reversals: Vec::new(), last: [0.0; 2], direction: 0.0 }
    }

    /// Whether the motion turns at the last instant if it goes on to `d`.
    fn turns(&self, d: f64) -> bool {
        (d - self.last[0]) * self.direction < 0.0
    }

    /// Number of open reversals that remain on the way to `d`, the last instant among them if `turned`.
    fn open(&self, d: f64, turned: bool) -> usize {
        let place = |i: usize| self.reversals.get(i).unwrap_or(&self.last)[0];
        open_reversals(place, self.reversals.len() + usize::from(turned), d)
    }

    /// Force and slope at `d` when `count` reversals are open.
    fn on_branch(&self, d: f64, count: usize) -> [f64; 2] {
        if count == 0 {
            return (self.backbone)(d);
        }
        let [from, force] = *self.reversals.get(count - 1).unwrap_or(&self.last);
        let [half, slope] = (self.backbone)(0.5 * (d - from));
        [force + 2.0 * half, slope]
    }
}

impl<B: Fn(f64) -> [f64; 2]> Memory for MasingMemory<B> {
    fn trial(&self, d: f64, _step: f64) -> [f64; 2] {
        self.on_branch(d, self.open(d, self.turns(d)))
    }

    fn advance(&mut self, d: f64, _step: f64) -> f64 {
        if self.turns(d) {
            self.reversals.push(self.last);
        }
        let count = self.open(d, false);
        self.reversals.truncate(count);
        let [force, _] = self.on_branch(d, count);
        if d != self.last[0] {
            self.direction = (d - self.last[0]).signum();
        }
        self.last = [d, force];
        force
    }
}

/// Maxwell element: `F' + F k / c = k d'`, solved exactly for a straight step.
pub(crate) struct MaxwellMemory {
    stiffness: f64,
    c: f64,
    last: [f64; 2],
}

impl MaxwellMemory {
    /// Without force at the origin; `stiffness` in N/m and `c` in N s/m.
    pub(crate) fn new(stiffness: f64, c: f64) -> Self {
        Self { stiffness, c, last: [0.0; 2] }
    }
}

impl Memory for MaxwellMemory {
    fn trial(&self, d: f64, step: f64) -> [f64; 2] {
        if self.c == 0.0 {
            return [0.0; 2];
        }
        let decay = -self.stiffness * step / self.c;
        let slope = -self.c * decay.exp_m1() / step;
        [self.last[1] * decay.exp() + slope * (d - self.last[0]), slope]
    }

    fn advance(&mut self, d: f64, step: f64) -> f64 {
        let [force, _] = self.trial(d, step);
        self.last = [d, force];
        force
    }
}

//! Sums and scalar products in eight lanes, which the compiler turns into vector instructions.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the wide instructions")]

use pulp::Arch;
pub(crate) use pulp::NullaryFnOnce as Wide;

/// Runs a loop in the widest vector instructions that the machine has; its `call` is to be inlined always, which a closure would not be.
pub(crate) fn widest<W: Wide>(work: W) -> W::Output {
    Arch::new().dispatch(work)
}

/// Lanes: enough to hide the latency of an addition.
pub const LANES: usize = 8;

/// Sum in eight lanes.
#[inline]
pub fn sum(x: &[f64]) -> f64 {
    let chunks = x.chunks_exact(LANES);
    let rest: f64 = chunks.remainder().iter().sum();
    let mut lanes = [0.0; LANES];
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    rest + lanes.iter().sum::<f64>()
}

/// Scalar product in eight lanes; of what both have.
#[inline(always)]
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (xs, ys) = (x.chunks_exact(LANES), y.chunks_exact(LANES));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(a, b)| a * b).sum();
    let mut lanes = [0.0; LANES];
    for (a, b) in xs.zip(ys) {
        for i in 0..LANES {
            lanes[i] += a[i] * b[i];
        }
    }
    rest + lanes.iter().sum::<f64>()
}

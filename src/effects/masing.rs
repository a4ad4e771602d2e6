//! Rate-independent hysteresis of Masing's kind, exact and without any discretisation of slip.
//!
//! Sliders in parallel, each in series with a spring, follow from rest the backbone `B(d)` (odd, concave for d > 0), and
//! after a reversal at `(d_r, F_r)`
//!
//! ```text
//! F = F_r + 2 B((d - d_r) / 2)
//! ```
//!
//! until the inner loop closes, where the branch interrupted before goes on (return-point memory). In steady state the
//! greatest |d| of the period lies on the backbone, so one period of marching that starts there is periodic at once,
//! whatever came before.

/// Marches a steady period: `out[n]` at every sample of `displacement` (m).
///
/// `start(n)` is the value at the sample of greatest displacement, `branch(r, n)` what is added on the way from the
/// reversal at sample `r` to sample `n`. With `B` these give the force, with derivatives of `B` its tangents.
pub fn march(
    displacement: &[f64],
    out: &mut [f64],
    start: impl Fn(usize) -> f64,
    branch: impl Fn(usize, usize) -> f64,
) {
    let count = displacement.len();
    let d = displacement;
    let Some(first) = (0..count).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())) else {
        return;
    };
    out[first] = start(first);
    let mut reversals = vec![first];
    let mut origin = first;
    let mut last = first;
    for n in (first + 1..count).chain(0..first) {
        if (d[n] - d[last]) * (d[last] - d[origin]) < 0.0 {
            reversals.push(last);
            origin = last;
        }
        while let [.., resumed, outer, inner] = reversals[..] {
            if (d[n] - d[outer]) * (d[outer] - d[inner]) < 0.0 {
                break;
            }
            reversals.truncate(reversals.len() - 2);
            origin = resumed;
        }
        out[n] = out[origin] + branch(origin, n);
        last = n;
    }
}

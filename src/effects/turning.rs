//! Turning points of a periodic motion, where `d' = 0`: rate-independent laws know nothing else of it.

use super::motion::Motion;

/// Displacements at the turning points of one period in order of time, each a true extreme; empty for a motion at rest.
/// Zeros of the velocity between samples are refined on the harmonics, so the extremes are exact to rounding.
pub fn turning_points(motion: &Motion) -> Vec<f64> {
    let mut points = Vec::with_capacity(2 * motion.harmonics.len() + 2);
    if let [single] = motion.harmonics[..] {
        // One harmonic turns at its amplitude, whatever the samples.
        if single.norm() > 0.0 {
            points.extend([motion.mean + single.norm(), motion.mean - single.norm()]);
        }
        return points;
    }
    let count = motion.len();
    for n in 0..count {
        let (now, next) = (motion.velocity[n], motion.velocity[(n + 1) % count]);
        if now == 0.0 {
            points.push(motion.displacement[n]);
        } else if now * next < 0.0 {
            points.push(extreme_between(motion, n));
        }
    }
    keep_extremes(&mut points);
    points
}

/// Sum of `|difference|` from each turning point to the next, around the period, m.
pub fn total_variation(motion: &Motion) -> f64 {
    let points = turning_points(motion);
    (0..points.len()).map(|i| (points[(i + 1) % points.len()] - points[i]).abs()).sum()
}

/// Ranges (m) of the closed hysteresis loops of one period by rainflow counting: a rate-independent law of Masing's kind
/// takes out, over the period, the sum of what it takes out in each loop alone.
pub fn loop_ranges(motion: &Motion) -> Vec<f64> {
    let points = turning_points(motion);
    let Some(start) = (0..points.len()).max_by(|&a, &b| points[a].total_cmp(&points[b])) else {
        return Vec::new();
    };
    let mut ranges = Vec::with_capacity(points.len() / 2);
    let mut stack: Vec<f64> = Vec::with_capacity(points.len() + 1);
    for i in 0..=points.len() {
        stack.push(points[(start + i) % points.len()]);
        while let [.., a, b, c] = stack[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            ranges.push((b - a).abs());
            stack.truncate(stack.len() - 3);
            stack.push(c);
        }
    }
    ranges
}

/// Displacement at the zero of the velocity between samples `n` and `n + 1`, by Newton's method kept in the bracket.
fn extreme_between(motion: &Motion, n: usize) -> f64 {
    let step = motion.step();
    let (mut low, mut high) = (n as f64 * step, (n + 1) as f64 * step);
    let rising = motion.velocity[n] < 0.0;
    let mut time = 0.5 * (low + high);
    for _ in 0..40 {
        let [_, velocity, acceleration] = motion.at(time);
        if (velocity < 0.0) == rising {
            low = time;
        } else {
            high = time;
        }
        let newton = time - velocity / acceleration;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        // The displacement is stationary here: an error of 1e-9 of a step is one of 1e-18 in it.
        if (next - time).abs() <= 1e-9 * step {
            time = next;
            break;
        }
        time = next;
    }
    motion.at(time)[0]
}

/// Drops points at which the motion rests but does not turn.
fn keep_extremes(points: &mut Vec<f64>) {
    loop {
        let count = points.len();
        let idle = (0..count).find(|&i| {
            let (before, here, after) = (points[(i + count - 1) % count], points[i], points[(i + 1) % count]);
            (here - before) * (after - here) >= 0.0
        });
        match idle {
            Some(i) if count > 0 => {
                points.remove(i);
            }
            _ => return,
        }
    }
}

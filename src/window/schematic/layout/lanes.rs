//! Packs intervals into as few lanes as possible, first come first served.

/// Lane of every interval so that intervals of one lane do not overlap (touching ends do not share a lane).
pub(super) fn assign(intervals: &[[f32; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..intervals.len()).collect();
    order.sort_by(|&a, &b| intervals[a][0].total_cmp(&intervals[b][0]).then(a.cmp(&b)));
    let mut ends: Vec<f32> = Vec::new();
    let mut lanes = vec![0; intervals.len()];
    for i in order {
        let [start, end] = intervals[i];
        let lane = ends.iter().position(|&e| e < start).unwrap_or(ends.len());
        if lane == ends.len() {
            ends.push(end);
        } else {
            ends[lane] = end;
        }
        lanes[i] = lane;
    }
    lanes
}

#[cfg(test)]
mod tests {
    use super::assign;

    #[test]
    fn intervals_that_overlap_take_different_lanes() {
        assert_eq!(assign(&[[0.0, 1.0], [0.5, 2.0], [1.5, 3.0], [4.0, 5.0]]), [0, 1, 0, 0]);
        assert_eq!(assign(&[[0.0, 1.0], [1.0, 2.0]]), [0, 1]);
        assert!(assign(&[]).is_empty());
    }
}

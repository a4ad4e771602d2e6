//! The most informative runs, where there are many: neighbours on a curve of response say the same again, and every candidate is
//! fitted to every run.
//!
//! Of each session, whose runs follow one another in frequency, those are taken that lie evenly along its curve in the plane of
//! Nyquist: the circle of a resonance is where the response says most of stiffness and damping (Ewins, *Modal Testing*,
//! section 4.4).

use super::data::{Data, RunData, size};
use faer::c64;

/// Runs that are searched at the most.
pub(crate) const MOST: usize = 40;
/// Fewest of a session.
const FEWEST: usize = 4;

/// The same data with the runs that tell most; none where there are no more than [`MOST`], and of frequency responses, whose
/// lines are chosen as they are read.
pub(crate) fn informative_runs(data: &Data) -> Option<Data> {
    if data.per_unit_force || data.runs.len() <= MOST {
        return None;
    }
    let session = |r: usize| data.sessions.get(r).copied().unwrap_or(0);
    let last = data.sessions.iter().max().copied().unwrap_or(0);
    let mut chosen: Vec<usize> = Vec::new();
    for number in 0..=last {
        let mut own: Vec<usize> = (0..data.runs.len()).filter(|&r| session(r) == number).collect();
        own.sort_by(|&a, &b| data.runs[a].omega.total_cmp(&data.runs[b].omega));
        let count = (MOST * own.len() / data.runs.len()).max(FEWEST);
        chosen.extend(evenly(&along(data, &own), count).into_iter().map(|k| own[k]));
    }
    chosen.sort_unstable();
    let sessions = if data.sessions.is_empty() { Vec::new() } else { chosen.iter().map(|&r| session(r)).collect() };
    let runs = chosen.iter().map(|&r| data.runs[r].clone()).collect();
    Some(Data { runs, sessions, chosen: true, ..data.clone() })
}

/// Length of the curve of the fundamentals up to each of the runs `own`.
fn along(data: &Data, own: &[usize]) -> Vec<f64> {
    let fundamentals = |run: &RunData| -> Vec<c64> {
        run.responses.iter().map(|c| c.measured.first().copied().unwrap_or_default()).collect()
    };
    let mut length = 0.0;
    let step = |pair: &[usize]| {
        let (a, b) = (fundamentals(&data.runs[pair[0]]), fundamentals(&data.runs[pair[1]]));
        length += size(&a.iter().zip(&b).map(|(a, b)| a - b).collect::<Vec<c64>>());
        length
    };
    std::iter::once(0.0).chain(own.windows(2).map(step).collect::<Vec<f64>>()).collect()
}

/// Numbers of `count` of the points at the growing `positions`, as evenly spread as these allow.
fn evenly(positions: &[f64], count: usize) -> Vec<usize> {
    let (n, total) = (positions.len(), positions.last().copied().unwrap_or(0.0));
    if n <= count {
        return (0..n).collect();
    }
    let mut free: Vec<usize> = (0..n).collect();
    let mut chosen: Vec<usize> = (0..count)
        .filter_map(|k| {
            let wanted = total * k as f64 / (count - 1) as f64;
            let away = |&at: &usize| (positions[free[at]] - wanted).abs();
            let nearest = (0..free.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
            Some(free.remove(nearest))
        })
        .collect();
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_spread_along_the_curve_and_each_is_taken_once() {
        let positions = [0.0, 0.1, 0.2, 1.0, 2.0, 3.0, 3.1, 3.15, 4.0];
        assert_eq!(evenly(&positions, 5), [0, 3, 4, 5, 8]);
        assert_eq!(evenly(&[0.0, 0.0, 0.0, 0.0], 2), [0, 1]);
        assert_eq!(evenly(&[0.0, 1.0], 5), [0, 1]);
    }

    /// A resonance at 10 rad/s with a damping ratio of 1 %, 101 lines from 9 to 11 rad/s.
    fn resonance() -> Data {
        let run = |k: usize| {
            let w = 9.0 + 0.02 * k as f64;
            let y = 1.0 / c64::new(100.0 - w * w, 0.2 * w);
            let channel = crate::diagnosis::residual::data::ChannelData {
                name: "disp@1".into(),
                quantity: crate::measurement::Quantity::Displacement,
                dof: 0,
                measured: vec![y],
                deviation: vec![1e-6],
            };
            let (forces, responses, on_moving_base) = (Vec::new(), vec![channel], false);
            RunData { index: k, omega: w, harmonics: 1, forces, responses, alive: vec![0], on_moving_base }
        };
        Data { runs: (0..101).map(run).collect(), ..Data::default() }
    }

    #[test]
    fn lines_of_a_resonance_are_taken_where_it_turns() {
        let all = resonance();
        let few = informative_runs(&all).map(|data| data.runs).unwrap_or_default();
        assert_eq!(few.len(), MOST);
        let within = |runs: &[RunData]| runs.iter().filter(|run| (run.omega - 10.0).abs() < 0.21).count();
        assert_eq!(within(&all.runs), 21);
        assert!(within(&few) >= 19, "of the half-power circle {}", within(&few));
        let lean = Data { runs: all.runs[..MOST].to_vec(), ..all };
        assert!(informative_runs(&lean).is_none());
    }
}

//! Which lines of a frequency response say most of the damping.
//!
//! A small dashpot `c` at DOF q changes the response at r to a force at p by `dH_rp = -i omega H_rq H_qp c`, so that a
//! line determines it with the Fisher information `omega^2 |H_rq|^2 |H_qp|^2 / var H_rp`. Where q is not known, the
//! measured responses stand for both factors: `I = omega^2 (sum_r |H_rp|^2 / var_r) (mean_r |H_rp|^2)`. It grows with
//! `|H|^4`, so that nearly all of it lies within the half-power bands of the resonances.
//!
//! Lines are dealt out in rounds: first the crest of every resonance, from the reference that shows it best, then its
//! flanks, then further references and lines, until the number asked for is reached.

/// What the lines of one reference say.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Density {
    /// Information of each line; 0 where it must not be chosen.
    pub information: Vec<f64>,
    /// Whether a response stands out of its noise on a line: none is chosen where noise alone looks like information.
    pub stands_out: Vec<bool>,
}

impl Density {
    /// Lines that may be chosen.
    fn usable(&self, line: usize) -> bool {
        self.information[line] > 0.0 && self.stands_out[line]
    }
}

/// How far the density must fall on both sides of a crest before that is a resonance and no ripple.
const PROMINENCE: f64 = 10.0;
/// Share of the density of the crest down to which lines of a resonance are taken: a third of the amplitude.
const FLANK: f64 = 0.01;
/// Share of the crest at the half-power points.
const HALF_POWER: f64 = 0.25;
/// Share of the crest of the outer lines.
const OUTER: f64 = 0.04;

/// A resonance in one reference.
struct Peak {
    reference: usize,
    crest: usize,
    /// Information at the crest.
    height: f64,
    /// Lines in the order in which they are taken.
    order: Vec<usize>,
}

/// The lines chosen for each reference, ascending; at most `most` altogether.
pub(crate) fn choose(densities: &[Density], most: usize) -> Vec<Vec<usize>> {
    let mut peaks: Vec<Peak> = densities.iter().enumerate().flat_map(|(r, density)| peaks(r, density)).collect();
    if peaks.is_empty() {
        peaks = densities.iter().enumerate().filter_map(|(r, density)| whole(r, density)).collect();
    }
    peaks.sort_by(|a, b| b.height.total_cmp(&a.height));
    let rank = ranks(&peaks);
    let mut deals: Vec<(usize, usize, usize)> = Vec::new();
    for (p, peak) in peaks.iter().enumerate() {
        deals.extend((0..peak.order.len()).map(|k| (k + ROUND * rank[p], p, k)));
    }
    deals.sort_unstable();
    let mut chosen = vec![Vec::new(); densities.len()];
    let mut left = most;
    for (_, p, k) in deals {
        let (peak, line) = (&peaks[p], peaks[p].order[k]);
        if left > 0 && !chosen[peak.reference].contains(&line) {
            chosen[peak.reference].push(line);
            left -= 1;
        }
    }
    chosen.iter_mut().for_each(|lines| lines.sort_unstable());
    chosen
}

/// Lines of a resonance that are taken from one reference before the next reference has its turn.
const ROUND: usize = 3;

/// The resonances of one reference: their lines down to a third of the amplitude of the crest, each ascending.
pub(crate) fn resonances(density: &Density) -> Vec<Vec<usize>> {
    let ascending = |peak: Peak| {
        let mut lines = peak.order;
        lines.sort_unstable();
        lines
    };
    peaks(0, density).into_iter().map(ascending).collect()
}

/// Place of each peak among those of other references at the same resonance, the best first; `peaks` by height.
fn ranks(peaks: &[Peak]) -> Vec<usize> {
    let overlaps = |a: &Peak, b: &Peak| a.order.contains(&b.crest) || b.order.contains(&a.crest);
    (0..peaks.len()).map(|p| peaks[..p].iter().filter(|better| overlaps(better, &peaks[p])).count()).collect()
}

/// The resonances of one reference.
fn peaks(reference: usize, density: &Density) -> Vec<Peak> {
    let d = &density.information;
    let is_crest =
        |i: usize| density.usable(i) && (i == 0 || d[i] > d[i - 1]) && (i + 1 == d.len() || d[i] >= d[i + 1]);
    let falls = |lines: &mut dyn Iterator<Item = usize>, height: f64| {
        for i in lines {
            if d[i] > height {
                return false;
            }
            if d[i] * PROMINENCE < height {
                return true;
            }
        }
        false
    };
    (0..d.len())
        .filter(|&i| is_crest(i) && falls(&mut (0..i).rev(), d[i]) && falls(&mut (i + 1..d.len()), d[i]))
        .map(|crest| Peak { reference, crest, height: d[crest], order: order(density, crest) })
        .collect()
}

/// Lines about a crest: itself, those at half power, those further out, then the others by their information.
fn order(density: &Density, crest: usize) -> Vec<usize> {
    let d = &density.information;
    let reaches = |i: &usize| d[*i] >= FLANK * d[crest];
    let left = (0..crest).rev().take_while(reaches).last().unwrap_or(crest);
    let right = (crest + 1..d.len()).take_while(reaches).last().unwrap_or(crest);
    let below = |mut lines: Box<dyn Iterator<Item = usize>>, share: f64| lines.find(|&i| d[i] <= share * d[crest]);
    let mut order = vec![crest];
    for share in [HALF_POWER, OUTER] {
        order.extend(below(Box::new((left..crest).rev()), share));
        order.extend(below(Box::new(crest + 1..=right), share));
    }
    let mut others: Vec<usize> = (left..=right).filter(|i| !order.contains(i)).collect();
    others.sort_by(|&a, &b| d[b].total_cmp(&d[a]));
    order.dedup();
    order.extend(others);
    order.retain(|&i| density.usable(i));
    order
}

/// All lines of a reference by their information, where it shows no resonance.
fn whole(reference: usize, density: &Density) -> Option<Peak> {
    let d = &density.information;
    let mut order: Vec<usize> = (0..d.len()).filter(|&i| density.usable(i)).collect();
    if order.is_empty() {
        // Where all is noise the runs say so.
        order = (0..d.len()).filter(|&i| d[i] > 0.0).collect();
    }
    order.sort_by(|&a, &b| d[b].total_cmp(&d[a]));
    let crest = *order.first()?;
    Some(Peak { reference, crest, height: d[crest], order })
}

/// Ascending lines (with repetitions) in groups with gaps of more than a few lines between them: first, last, how many.
pub(crate) fn groups(lines: &[usize]) -> Vec<(usize, usize, usize)> {
    const GAP: usize = 5;
    let mut groups: Vec<(usize, usize, usize)> = Vec::new();
    for &line in lines {
        match groups.last_mut() {
            Some(group) if line <= group.1 + GAP => (group.1, group.2) = (line, group.2 + 1),
            _ => groups.push((line, line, 1)),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Density of resonances at the given lines, each of the given height.
    fn density(peaks: &[(f64, f64)]) -> Density {
        let density_of_line =
            |i: usize| peaks.iter().map(|(f, height)| height / (1.0 + ((i as f64 - f) / 4.1).powi(2)).powi(2)).sum();
        of((0..400).map(density_of_line).collect())
    }

    fn of(information: Vec<f64>) -> Density {
        let stands_out = vec![true; information.len()];
        Density { information, stands_out }
    }

    #[test]
    fn noise_that_looks_like_a_resonance_is_not_chosen() {
        let mut density = density(&[(100.0, 1.0), (250.0, 50.0)]);
        density.stands_out = (0..400).map(|i| i > 200).collect();
        assert_eq!(choose(std::slice::from_ref(&density), 3), [vec![245, 250, 255]]);
        density.stands_out = vec![false; 400];
        assert_eq!(choose(&[density], 3)[0].len(), 3);
    }

    #[test]
    fn every_resonance_has_its_crest_and_flanks_before_another_reference_has_its_turn() {
        let densities = [density(&[(100.0, 1.0), (250.0, 50.0)]), density(&[(100.0, 9.0), (250.0, 1.0)])];
        let chosen = choose(&densities, 6);
        assert_eq!(chosen[0], [245, 250, 255]);
        assert_eq!(chosen[1], [95, 100, 105]);
        assert_eq!(choose(&densities, 2), [vec![250], vec![100]]);
        assert_eq!(choose(&densities, 12).iter().map(Vec::len).sum::<usize>(), 12);
    }

    #[test]
    fn ripples_are_no_resonances_and_smooth_responses_still_give_lines() {
        let rippled = of((0..100).map(|i| 2.0 + f64::from(i % 3)).collect());
        assert_eq!(choose(&[rippled], 4)[0].len(), 4);
        assert_eq!(choose(&[of(vec![0.0; 10])], 4), [Vec::<usize>::new()]);
        assert_eq!(groups(&[1, 2, 2, 5, 20]), [(1, 5, 4), (20, 20, 1)]);
    }
}

//! Probabilities of sets of effects: by evidence, as sure as it is alike over the parts of the records.
//!
//! What a model leaves beyond the noise is its own error, and differences of the squared residual between two laws are then known
//! no better than they scatter along the records: a law that is better while the motion is large and worse while it is small is not
//! sure, however many samples there are. Each record is cut into stretches, and the weights are means over the Bayesian bootstrap of
//! them ([`crate::math::bootstrap`]), as those of steady runs are over groups of runs.

use super::evidence::{AGREES, evidence, misfit, scale};
use super::fitted::FittedRecords;
use crate::math::bootstrap;

/// Odds that the truth is no law that was fitted: for every factor `e` of the misfit beyond that of a model that agrees; of a search whose
/// time was up; for every effect beyond the first. Of the development projects (laboratory records, seeds 340 to 358) half of those whose best fit left
/// more than 1.8 times the noise, a fifth of those that were cut off, and both with two effects had another law or place, of the others one in ten.
const UNSEEN: f64 = 0.25;
const CUT_OFF: f64 = 0.2;
const FURTHER: f64 = 0.25;

/// About as many stretches as all records are cut into: as many as groups of steady runs.
const STRETCHES: usize = 12;

/// Probabilities of fits to the same records, of which the first is the best, by a search that was `cut_off` or not. They are those of each among
/// the fitted, times that of the truth being among them.
pub(super) fn probabilities(found: &[FittedRecords], cut_off: bool) -> Vec<f64> {
    let unit = found.first().map_or(1.0, scale);
    let densities: Vec<Vec<f64>> =
        found.iter().map(|f| squares(f).into_iter().map(|square| -0.5 * square / unit).collect()).collect();
    let beside = |f: &FittedRecords| -0.5 * (evidence(f, unit) - f.chi_square / unit);
    let among = found.first().map_or(1.0, |best| among_fitted(best, cut_off));
    let of_each = bootstrap::probabilities(&densities, &found.iter().map(beside).collect::<Vec<f64>>());
    of_each.into_iter().map(|p| among * p).collect()
}

/// `found` with the likeliest first, the others in their order: a fit may owe its evidence to a few stretches of the records.
pub(super) fn likeliest_first(mut found: Vec<FittedRecords>, cut_off: bool) -> Vec<FittedRecords> {
    let weights = probabilities(&found, cut_off);
    let likeliest = (0..found.len()).rev().max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
    if let Some(k) = likeliest {
        found[..=k].rotate_right(1);
    }
    found
}

/// Probability that what is true is among the laws that were fitted, of which this is the best: what is left beyond noise is no proof against a
/// law, since search and corrections are never complete, but it is none for it.
fn among_fitted(best: &FittedRecords, cut_off: bool) -> f64 {
    let left = UNSEEN * (misfit(best) / AGREES).max(1.0).ln();
    let further = FURTHER * best.effects.len().saturating_sub(1) as f64;
    1.0 / (1.0 + left + further + if cut_off { CUT_OFF } else { 0.0 })
}

/// Squared residuals of the stretches of all records.
fn squares(fit: &FittedRecords) -> Vec<f64> {
    let each = STRETCHES.div_ceil(fit.residual.len().max(1));
    let squares_of_record = |channels: &Vec<Vec<f64>>| {
        let mut squares = vec![0.0; each];
        for channel in channels {
            let length = channel.len().max(1);
            channel.iter().enumerate().for_each(|(n, e)| squares[n * each / length] += e * e);
        }
        squares
    };
    fit.residual.iter().flat_map(squares_of_record).collect()
}

#[cfg(test)]
mod tests {
    use super::{likeliest_first, probabilities};
    use crate::diagnosis::records::fitted::FittedRecords;
    use std::sync::Arc;

    /// A fit of one channel whose squared residual in every stretch is this.
    fn fit(squares: &[f64; 12]) -> FittedRecords {
        let residual = vec![vec![squares.iter().flat_map(|s| vec![(s / 50.0).sqrt(); 50]).collect::<Vec<f64>>()]];
        let chi_square = squares.iter().sum();
        FittedRecords { residual: Arc::new(residual), count: 600, ..FittedRecords::of_effects(Vec::new(), chi_square) }
    }

    #[test]
    fn a_law_that_is_better_in_half_of_the_stretches_only_is_not_sure() {
        let best = fit(&[50.0; 12]);
        // As much as noise is left.
        let everywhere = fit(&[55.0; 12]);
        let mixed = fit(&[20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0]);
        assert!(probabilities(&[best.clone(), everywhere], false)[0] > 0.999);
        let open = probabilities(&[best, mixed], false);
        assert!(open[1] > 0.05 && (open[0] + open[1] - 1.0).abs() < 1e-12, "{open:?}");
    }

    /// One stretch in which it leaves nothing gives a fit the most evidence, and the other is likelier all the same.
    #[test]
    fn the_likeliest_comes_first() {
        let [steady, lucky] = [[50.0; 12], std::array::from_fn(|k| if k == 0 { 0.0 } else { 54.0 })].map(|s| fit(&s));
        assert!(lucky.chi_square < steady.chi_square);
        let first = likeliest_first(vec![lucky.clone(), steady.clone(), fit(&[60.0; 12])], false);
        assert_eq!(first.iter().map(|f| f.chi_square).collect::<Vec<_>>(), [600.0, lucky.chi_square, 720.0]);
    }

    /// A single fit is sure where it leaves noise, and the less so the more it leaves.
    #[test]
    fn what_leaves_more_than_noise_may_be_another_law() {
        let [noise, more, much] = [50.0, 500.0, 5000.0].map(|s| probabilities(&[fit(&[s; 12])], false)[0]);
        assert!((noise - 1.0).abs() < 1e-12, "{noise}");
        assert!(more < 0.9 && much < more && much > 0.3, "{more} {much}");
        // So is one whose search had no time for the others.
        assert!(probabilities(&[fit(&[50.0; 12])], true)[0] < 0.9);
    }
}

//! Probabilities of sets of effects: by evidence, as sure as it is alike over the parts of the records.
//!
//! What a model leaves beyond the noise is its own error, and differences of the squared residual between two laws are then known
//! no better than they scatter along the records: a law that is better while the motion is large and worse while it is small is not
//! sure, however many samples there are. Each record is cut into stretches, and the weights are means over the Bayesian bootstrap of
//! them ([`crate::math::bootstrap`]), as those of steady runs are over groups of runs.

use super::evidence::{evidence, scale};
use super::fitted::FittedRecords;
use crate::math::bootstrap;

/// About as many stretches as all records are cut into: as many as groups of steady runs.
const STRETCHES: usize = 12;

/// Probabilities of fits to the same records, of which the first is the best.
pub(super) fn probabilities(found: &[FittedRecords]) -> Vec<f64> {
    let unit = found.first().map_or(1.0, scale);
    let densities: Vec<Vec<f64>> =
        found.iter().map(|f| squares(f).into_iter().map(|square| -0.5 * square / unit).collect()).collect();
    let beside = |f: &FittedRecords| -0.5 * (evidence(f, unit) - f.chi_square / unit);
    bootstrap::probabilities(&densities, &found.iter().map(beside).collect::<Vec<f64>>())
}

/// Squared residuals of the stretches of all records.
fn squares(fit: &FittedRecords) -> Vec<f64> {
    let each = STRETCHES.div_ceil(fit.residual.len().max(1));
    let of = |channels: &Vec<Vec<f64>>| {
        let mut squares = vec![0.0; each];
        for channel in channels {
            let length = channel.len().max(1);
            channel.iter().enumerate().for_each(|(n, e)| squares[n * each / length] += e * e);
        }
        squares
    };
    fit.residual.iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::probabilities;
    use crate::diagnosis::records::fitted::FittedRecords;

    /// A fit of one channel whose squared residual in every stretch is this.
    fn fit(squares: &[f64; 12]) -> FittedRecords {
        let residual = vec![vec![squares.iter().flat_map(|s| vec![(s / 50.0).sqrt(); 50]).collect::<Vec<f64>>()]];
        let chi_square = squares.iter().sum();
        FittedRecords { residual, count: 600, ..FittedRecords::of_effects(Vec::new(), chi_square) }
    }

    #[test]
    fn a_law_that_is_better_in_half_of_the_stretches_only_is_not_sure() {
        let best = fit(&[50.0; 12]);
        let everywhere = fit(&[55.0; 12]);
        let mixed = fit(&[20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0, 20.0, 90.0]);
        assert!(probabilities(&[best.clone(), everywhere])[0] > 0.999);
        let open = probabilities(&[best, mixed]);
        assert!(open[1] > 0.05 && (open[0] + open[1] - 1.0).abs() < 1e-12, "{open:?}");
    }
}

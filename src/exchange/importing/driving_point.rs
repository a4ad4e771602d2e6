//! The function of the driving point among those of one reference that nothing names.
//!
//! A passive structure takes energy in where it is driven, `Re(v conj(F)) >= 0`, at every frequency: the imaginary part of a
//! receptance or accelerance of the driving point, the real part of a mobility, has one sign over the whole band, whatever its
//! modes are. Elsewhere modes move in and against the phase of the first, and the part changes its sign from one to the next.

use super::error::Result;
use dashpot_datafiles::{DataFile, Set, Values};

/// One-sidedness of a driving point, `|sum x| / sum |x|` of the part of one sign.
const ONE_SIGN: f64 = 0.97;
/// Largest one-sidedness of all others.
const BOTH_SIGNS: f64 = 0.9;
/// Most functions that are looked at.
const MOST: usize = 400;

/// Number, in their order, of the function that alone can be that of a driving point; none where several can, or none.
/// `is_function` says which channels of a set are functions.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn driving_point(files: &[DataFile], is_function: impl Fn(&Set, usize) -> bool) -> Result<Option<usize>> {
    let mut sided = Vec::new();
    for file in files {
        for (s, set) in file.contents().sets.iter().enumerate() {
            for c in (0..set.channels.len()).filter(|&c| is_function(set, c)) {
                sided.push(if sided.len() < MOST { most_sided(&file.read(s, c)?) } else { 1.0 });
            }
        }
    }
    let best = (0..sided.len()).max_by(|&a, &b| sided[a].total_cmp(&sided[b]));
    Ok(best.filter(|&best| {
        let others = sided.iter().enumerate().filter(|(k, _)| *k != best).map(|(_, value)| *value);
        sided.len() > 1 && sided[best] > ONE_SIGN && others.fold(0.0, f64::max) < BOTH_SIGNS
    }))
}

/// One-sidedness of the real or the imaginary part, whichever is greater.
fn most_sided(values: &Values) -> f64 {
    let Values::Complex(values) = values else { return 0.0 };
    let part = |part: usize| one_sided(&values.iter().map(|value| value[part]).collect::<Vec<f64>>());
    part(0).max(part(1))
}

/// `|sum x| / sum |x|` of finite numbers.
fn one_sided(part: &[f64]) -> f64 {
    let finite = || part.iter().filter(|x| x.is_finite());
    let (sum, size): (f64, f64) = (finite().sum(), finite().map(|x| x.abs()).sum());
    if size > 0.0 { sum.abs() / size } else { 0.0 }
}

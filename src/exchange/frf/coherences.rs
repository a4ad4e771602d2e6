//! Coherences in files that are no Universal Files: real columns with that word beside the responses of their set.

use super::checks::is_coherence;
use super::error::FrfProblem;
use crate::measurement::frf::ResponseSet;
use dashpot_datafiles::{DataFile, Error, Values, core_of, is_coherence as is_named};

/// Set and channel of every coherence in the sets that hold functions, with its values.
pub(super) fn coherences(
    file: &DataFile,
    functions: &[(usize, usize)],
) -> Result<Vec<((usize, usize), Vec<f64>)>, Error> {
    let mut found = Vec::new();
    for (s, set) in file.contents().sets.iter().enumerate().filter(|(s, _)| functions.iter().any(|at| at.0 == *s)) {
        for (c, channel) in set.channels.iter().enumerate() {
            if !channel.complex
                && is_named(&channel.name)
                && let Values::Real(values) = file.read(s, c)?
            {
                found.push(((s, c), values));
            }
        }
    }
    Ok(found)
}

/// Gives a coherence to the function of its name; where names do not tell, to the function in front of it, or to the one
/// at its place among the coherences of the set.
pub(super) fn attach(
    set: &mut ResponseSet,
    file: &DataFile,
    functions: &[(usize, usize)],
    at: (usize, usize),
    values: Vec<f64>,
) -> Result<(), FrfProblem> {
    let channels = &file.contents().sets[at.0].channels;
    let own = core_of(&channels[at.1].name);
    let here: Vec<usize> = (0..functions.len()).filter(|&k| functions[k].0 == at.0).collect();
    let name = |k: usize| core_of(&channels[functions[k].1].name);
    let named: Vec<usize> = here.iter().copied().filter(|&k| name(k) == own).collect();
    let among = |c: &usize| !channels[*c].complex && is_named(&channels[*c].name);
    let place = (0..at.1).filter(among).count();
    let count = (0..channels.len()).filter(among).count();
    let function = match (&named[..], &here[..]) {
        ([one], _) | ([], [one]) => Some(*one),
        _ if count == here.len() => here.get(place).copied(),
        _ => None,
    };
    let Some(function) = function.filter(|&k| set.functions[k].values.len() == values.len()) else { return Ok(()) };
    // Some programs write per cent.
    let values = if values.iter().all(|g2| *g2 >= 0.0 && *g2 <= 100.1) && values.iter().any(|g2| *g2 > 1.5) {
        values.iter().map(|g2| g2 / 100.0).collect()
    } else {
        values
    };
    if !is_coherence(&values) {
        return Err(FrfProblem::channel(file, at, "this coherence is not between 0 and 1; export it without a scale"));
    }
    set.functions[function].coherence = Some(values);
    Ok(())
}

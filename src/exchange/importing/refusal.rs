//! Why nothing of a file can be imported, in one line that says how to mend it.

use crate::exchange::mapping::samples::{cut_off, time_goes_back};
use crate::exchange::mapping::{NotMapped, Proposal};
use dashpot_datafiles::{Contents, Defect, Kind, Note, Set};

/// Most channels that are named.
const MOST_NAMED: usize = 3;

/// What is wrong with a file of which no channel could be mapped; `left` are its channels with the reasons.
pub(super) fn refusal(contents: &Contents, left: &[(String, NotMapped)]) -> String {
    let sets = |kind: Kind| contents.sets.iter().filter(move |set| set.kind == kind);
    let channels = |set: &Set| set.channels.len();
    let bare =
        sets(Kind::Table).flat_map(|set| &set.channels).filter(|channel| channel.complex && channel.count > 0).count();
    if bare > 0 {
        return format!(
            "its {bare} column{} complex values and no frequencies; give their step by --step-hz, and the DOFs by --responses and --references",
            if bare == 1 { " has" } else { "s have" }
        );
    }
    if sets(Kind::Time).chain(sets(Kind::Table)).map(channels).sum::<usize>() > 0 {
        let named = left.iter().take(MOST_NAMED).map(|(name, why)| format!("\"{}\" ({why})", name.trim()));
        let named = named.collect::<Vec<_>>().join(", ");
        let more =
            if left.len() > MOST_NAMED { format!(" and {} more", left.len() - MOST_NAMED) } else { String::new() };
        return format!(
            "no channel measures a force or a motion: {named}{more}; say by --map what they are, or export forces and motions"
        );
    }
    if sets(Kind::Spectrum).next().is_some() {
        return "holds spectra without phases (power spectra, coherences); export the time records, or frequency responses \
                with their phases"
            .to_owned();
    }
    if sets(Kind::Shape).next().is_some() {
        return "holds shapes and no record of a force and a motion; export the frequency responses or time records that \
                they came from"
            .to_owned();
    }
    if sets(Kind::Geometry).next().is_some() {
        return "holds geometry and no measurement; import it together with the file of the measurement, or name it by \
                --nodes beside --mass"
            .to_owned();
    }
    let skipped = |note: &&Note| note.tells(Defect::NotRead);
    if let Some(note) = contents.sets.iter().flat_map(|set| &set.notes).chain(&contents.notes).find(skipped) {
        return format!("holds nothing that is read: {note}");
    }
    "holds nothing that was measured; export time records or frequency responses (data set 58 of Universal Files)"
        .to_owned()
}

/// What is wrong with a file whose last row or recording was cut off, so that a channel of `mapping` is left out.
pub(super) fn cut_short(contents: &Contents, mapping: &Proposal) -> Option<String> {
    let shorter = mapping.left.iter().any(|(_, why)| matches!(why, NotMapped::OtherLength { .. }));
    (0..contents.sets.len()).find_map(|set| cut_off(contents, set)).filter(|_| shorter)
}

/// What is wrong with a file that does not say the time between samples.
pub(super) fn unsampled(contents: &Contents) -> String {
    let back = contents.sets.iter().find_map(time_goes_back);
    back.unwrap_or_else(|| "the file does not say the time between samples; give it by --sampling-hz".to_owned())
}
